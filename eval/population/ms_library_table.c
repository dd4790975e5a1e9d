#include "ms_library_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "chart/ms_csv.h"

#define MS_LIBRARY_NAME(code, name) name,
const char *const ms_library_descriptors[MS_LIBRARY_DESCRIPTORS] = {MS_LIBRARY_DESCRIPTOR_LIST(MS_LIBRARY_NAME)};

static ms_status read_descriptors(ms_library_grain *grain, int *known, const char *line, ms_error *err)
{
    *known = 1;
    ms_status status = ms_grain_row_number(&grain->spheres, "n", line, err);
    for (int d = 0; d < MS_LIBRARY_DESCRIPTORS && status == MS_OK; d++) {
        char column[64];
        snprintf(column, sizeof column, "shape_%s", ms_library_descriptors[d]);
        status = ms_grain_row_number(&grain->shape[d], column, line, err);
        snprintf(column, sizeof column, "clump_%s", ms_library_descriptors[d]);
        if (status == MS_OK) {
            status = ms_grain_row_number(&grain->clump[d], column, line, err);
        }
        *known = *known && isfinite(grain->shape[d]) && isfinite(grain->clump[d]);
    }
    *known =
        *known && grain->shape[MS_LIBRARY_SIZE] > 0 && grain->clump[MS_LIBRARY_SIZE] > 0 && grain->found.volume > 0;
    return status;
}

static ms_status read_grain(ms_library_table *table, const char *line, ms_error *err)
{
    ms_library_grain *grain = &table->grain[table->count];
    int known = 0;
    ms_status status = ms_grain_row_find(&grain->found, line, err);
    if (status != MS_OK || grain->found.status != MS_GRAIN_OK) {
        table->without++;
        return status;
    }
    status = read_descriptors(grain, &known, line, err);
    table->count += known && status == MS_OK;
    table->unmeasured += !known;
    return status;
}

ms_status ms_library_table_read(ms_library_table *table, const char *folder, ms_error *err)
{
    char path[4096];
    ms_csv csv;
    char *header = ms_grain_row_line(NULL);
    *table = (ms_library_table){0};
    if (!header) {
        return ms_fail(err, MS_ERR_NOMEM, "%s: no memory to read its table", folder);
    }
    snprintf(path, sizeof path, "%s/grains.csv", folder);
    ms_status status = ms_csv_read(&csv, path, header, err);
    free(header);
    if (status != MS_OK) {
        ms_csv_close(&csv);
        return status;
    }
    table->grain = calloc(csv.n_rows + 1, sizeof *table->grain);
    status = table->grain ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "%s: no memory for %zu grains", path, csv.n_rows);
    for (size_t r = 0; r < csv.n_rows && status == MS_OK; r++) {
        status = read_grain(table, csv.row[r], err);
    }
    ms_csv_close(&csv);
    if (status == MS_OK && table->count == 0) {
        status = ms_fail(err, MS_ERR_SHAPE,
                         "%s: no grain has a clump and all of size, sphericity, elongation, flatness and convexity%s",
                         path, table->unmeasured ? "; convexity takes a build with qhull" : "");
    }
    if (status != MS_OK) {
        ms_library_table_free(table);
    }
    return status;
}

void ms_library_table_free(ms_library_table *table)
{
    free(table->grain);
    *table = (ms_library_table){0};
}
