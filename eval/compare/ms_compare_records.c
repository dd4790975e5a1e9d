#include "ms_compare_records.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ms_generator.h"

double ms_compare_record_number(const ms_compare_record *r, ms_column column)
{
    return ms_csv_number(r->field[column]);
}

int ms_compare_record_is_clump(const ms_compare_record *r)
{
    return r->field[MS_COLUMN_ASKED][0] == '\0';
}

int ms_compare_records_agree(const ms_compare_record *a, const ms_compare_record *b, ms_column column)
{
    return strcmp(a->field[column], b->field[column]) == 0;
}

int ms_compare_records_same_shape(const ms_compare_record *a, const ms_compare_record *b)
{
    return ms_compare_records_agree(a, b, MS_COLUMN_SHAPE) && ms_compare_records_agree(a, b, MS_COLUMN_LABEL);
}

int ms_compare_records_same_method(const ms_compare_record *a, const ms_compare_record *b)
{
    return ms_compare_records_agree(a, b, MS_COLUMN_GENERATOR) && ms_compare_records_agree(a, b, MS_COLUMN_OPTIONS);
}

void ms_compare_records_free(ms_compare_records *all)
{
    for (size_t r = 0; r < all->count; r++) {
        free(all->record[r].line);
    }
    free(all->record);
    *all = (ms_compare_records){0};
}

ms_status ms_compare_records_cut(ms_compare_records *all, const ms_csv *csv, ms_error *err)
{
    *all = (ms_compare_records){.record = calloc(csv->n_rows + 1, sizeof *all->record)};
    for (size_t r = 0; all->record && r < csv->n_rows; r++) {
        ms_compare_record *one = &all->record[all->count++];
        one->line = strdup(csv->row[r]);
        if (!one->line) {
            break;
        }
        ms_csv_split(one->field, MS_COLUMNS, one->line); /* as many as there are columns: ms_csv_open has seen to it */
    }
    return all->record && (all->count == 0 || all->record[all->count - 1].line)
               ? MS_OK
               : ms_fail(err, MS_ERR_NOMEM, "no memory for the fields of %zu rows", csv->n_rows);
}

char *ms_compare_record_method(const ms_compare_record *r)
{
    const char *options = ms_compare_record_is_clump(r) ? "" : r->field[MS_COLUMN_OPTIONS];
    const size_t room = strlen(r->field[MS_COLUMN_GENERATOR]) + strlen(options) + 2;
    char *name = malloc(room);
    if (name) {
        snprintf(name, room, "%s%s%s", r->field[MS_COLUMN_GENERATOR], options[0] ? ":" : "", options);
    }
    return name;
}

ms_chart_look ms_compare_record_look(const ms_compare_record *r)
{
    const char *name = r->field[MS_COLUMN_GENERATOR], *options = r->field[MS_COLUMN_OPTIONS];
    for (int g = 0; ms_generators[g] && !ms_compare_record_is_clump(r); g++) {
        if (strcmp(ms_generators[g]->name, name) == 0) {
            return (ms_chart_look){g + 1, options[0] ? ms_chart_look_variant(options) : 0};
        }
    }
    return (ms_chart_look){MS_CHART_LOOK_OTHER, ms_chart_look_variant(name)};
}
