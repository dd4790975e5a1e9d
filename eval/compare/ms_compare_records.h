/** Rows of a comparison, cut into their fields: what charts and tables are made of. */
#ifndef MS_COMPARE_RECORDS_H
#define MS_COMPARE_RECORDS_H

#include "chart/ms_chart_look.h"
#include "chart/ms_csv.h"
#include "ms_compare.h"

typedef struct ms_compare_record {
    char *line;
    char *field[MS_COLUMNS];
} ms_compare_record;

typedef struct ms_compare_records {
    size_t count;
    ms_compare_record *record;
} ms_compare_records;

/** @param csv rows of ms_compare_header. @return MS_OK; MS_ERR_NOMEM; ms_compare_records_free in any case */
ms_status ms_compare_records_cut(ms_compare_records *all, const ms_csv *csv, ms_error *err);

void ms_compare_records_free(ms_compare_records *all);

/** NAN where the field is empty or no number. */
double ms_compare_record_number(const ms_compare_record *r, ms_column column);

/** Nonzero of a clump of another tool, whose options are its file. */
int ms_compare_record_is_clump(const ms_compare_record *r);

/** The method with its options, for people; the caller frees it; NULL without memory. */
char *ms_compare_record_method(const ms_compare_record *r);

/** How it looks in every chart: the colour is the generator's, points and dashes go by the options, too; grey, by its
 * name, where it is another tool's. */
ms_chart_look ms_compare_record_look(const ms_compare_record *r);

int ms_compare_records_agree(const ms_compare_record *a, const ms_compare_record *b, ms_column column);
int ms_compare_records_same_shape(const ms_compare_record *a, const ms_compare_record *b);
int ms_compare_records_same_method(const ms_compare_record *a, const ms_compare_record *b);

#endif
