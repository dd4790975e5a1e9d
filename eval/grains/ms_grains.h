/** A clump for every grain of a list: side by side, with a row for each. */
#ifndef MS_GRAINS_H
#define MS_GRAINS_H

#include "chart/ms_csv.h"
#include "clump/formats/ms_write.h"
#include "ms_grain_row.h"

enum { MS_GRAINS_FORMATS = 16 };

/** What is to be done. Everything is borrowed. */
typedef struct ms_grains {
    const ms_grain_list *list;
    uint64_t run;              /* its checksum */
    const char *folder;        /* of the table and of the clumps; exists */
    const ms_mass_flags *mass; /* resolved; NULL: no masses */
    const ms_format *format[MS_GRAINS_FORMATS];
    size_t n_formats;
    int skip_border;     /* grains that the border of their volume cuts are left out */
    double least_voxels; /* labels of fewer voxels are left out */
    int largest_piece;   /* of a label in several pieces the largest alone is taken */
    size_t part, parts;  /* 1 of 1: all grains */
    int threads;         /* 0: all */
} ms_grains;

/** What came of it, of the rows that were there before, too. */
typedef struct ms_grains_sum {
    size_t grains, ok, left_out, failed; /* of this part */
    size_t remarked;                     /* of those ok: the method has a remark */
    double spheres;
} ms_grains_sum;

/** The name of the table: grains.csv, of a part grains-K-of-N.csv. */
void ms_grains_table(char *out, size_t size, const ms_grains *grains);

/**
 * Makes the clumps of a part and adds their rows. Grains are dealt out by size, largest first, to and fro, so that
 * parts take about as long; rows of a part are in the order of the list. Rows that are there must be the first of this
 * part, and are not made again. A fault in one grain is its row, not the end.
 *
 * @param csv with the header of ms_grain_row_line
 * @return MS_OK; MS_ERR_ARG for rows of another run; MS_ERR_IO for rows that cannot be written; MS_ERR_NOMEM
 */
ms_status ms_grains_make(ms_grains_sum *sum, ms_csv *csv, const ms_grains *grains, ms_error *err);

/**
 * How long it would take: runs the smallest, the middle and the largest grain of the part, by size, and writes nothing.
 *
 * @param[out] seconds of one thread, for all grains
 * @param[out] tried   grains of the three that gave a clump
 * @return MS_OK; MS_ERR_NOMEM
 */
ms_status ms_grains_try(double *seconds, int *tried, const ms_grains *grains, ms_error *err);

#endif
