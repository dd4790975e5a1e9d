#include "ms_grain_merge.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_escape.h"
#include "base/ms_file.h"
#include "chart/ms_csv.h"
#include "ms_grain_row.h"

/* A table of a part. */
typedef struct merge_part {
    const char *folder; /* in front of its files; "" where that is the folder of the whole */
    char *path;
    size_t part, parts;
    ms_csv csv;
} merge_part;

typedef struct merge_parts {
    merge_part *part;
    size_t count;
    char **row; /* by number of the grain; borrowed from the tables */
    const merge_part **of;
    size_t grains;
} merge_parts;

/* Nonzero for the name of a part's table. */
static int read_name(size_t *part, size_t *parts, const char *name)
{
    char rest[8] = "";
    return sscanf(name, "grains-%zu-of-%zu%7s", part, parts, rest) == 3 && strcmp(rest, ".csv") == 0;
}

static ms_status add_part(merge_parts *m, const char *folder, const char *name, int is_own, ms_error *err)
{
    merge_part part = {.folder = is_own ? "" : folder, .csv = {.fd = -1}};
    if (!read_name(&part.part, &part.parts, name)) {
        return MS_OK;
    }
    const size_t size = strlen(folder) + strlen(name) + 2;
    merge_part *grown = realloc(m->part, (m->count + 1) * sizeof *grown);
    m->part = grown ? grown : m->part;
    part.path = malloc(size);
    char *header = ms_grain_row_line(NULL);
    ms_status status = grown && part.path && header ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for the parts");
    if (status == MS_OK) {
        snprintf(part.path, size, "%s/%s", folder, name);
        status = ms_csv_open(&part.csv, part.path, header, 1, err);
    }
    free(header);
    if (grown && part.path) {
        m->part[m->count++] = part;
    } else {
        free(part.path);
    }
    return status;
}

static ms_status add_parts(merge_parts *m, const char *folder, int is_own, ms_error *err)
{
    struct dirent **entry;
    const int found = scandir(folder, &entry, NULL, alphasort);
    ms_status status = found < 0 ? ms_fail(err, MS_ERR_IO, "%s: %s", folder, strerror(errno)) : MS_OK;
    for (int e = 0; e < found; e++) {
        status = status == MS_OK ? add_part(m, folder, entry[e]->d_name, is_own, err) : status;
        free(entry[e]);
    }
    if (found >= 0) {
        free(entry);
    }
    return status;
}

/* Is each of the parts there, once? */
static ms_status check_parts(const merge_parts *m, ms_error *err)
{
    if (m->count == 0) {
        return ms_fail(err, MS_ERR_ARG, "no table of a part, as grains-1-of-4.csv, is in these folders");
    }
    const size_t parts = m->part[0].parts;
    for (size_t p = 0; p < m->count; p++) {
        if (m->part[p].parts != parts) {
            return ms_fail(err, MS_ERR_ARG, "%s is one of %zu parts and %s one of %zu: they are of different runs",
                           m->part[0].path, parts, m->part[p].path, m->part[p].parts);
        }
        for (size_t q = 0; q < p; q++) {
            if (m->part[q].part == m->part[p].part) {
                return ms_fail(err, MS_ERR_ARG, "%s and %s are the same part", m->part[q].path, m->part[p].path);
            }
        }
    }
    if (m->count != parts) {
        return ms_fail(err, MS_ERR_ARG, "there are %zu of %zu parts; run the others, too", m->count, parts);
    }
    return MS_OK;
}

/* The first two fields of a row: its grain, of how many. */
static int read_numbers(size_t *grain, size_t *grains, const char *row)
{
    return sscanf(row, "%zu,%zu,", grain, grains) == 2 && *grain >= 1 && *grain <= *grains;
}

static ms_status place_row(merge_parts *m, const merge_part *part, char *row, ms_error *err)
{
    size_t grain, grains;
    if (!read_numbers(&grain, &grains, row)) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: '%.60s' does not begin with the number of a grain", part->path, row);
    }
    if (!m->row) {
        m->grains = grains;
        m->row = calloc(grains, sizeof *m->row);
        m->of = calloc(grains, sizeof *m->of);
        if (!m->row || !m->of) {
            return ms_fail(err, MS_ERR_NOMEM, "no memory for the rows of %zu grains", grains);
        }
    }
    if (grains != m->grains || m->row[grain - 1]) {
        return ms_fail(err, MS_ERR_ARG, "%s: grain %zu of %zu %s: the parts are of different runs", part->path, grain,
                       grains, grains != m->grains ? "is of another number of grains" : "is in another part, too");
    }
    m->row[grain - 1] = row;
    m->of[grain - 1] = part;
    return MS_OK;
}

static ms_status place_rows(merge_parts *m, ms_error *err)
{
    ms_status status = MS_OK;
    size_t rows = 0;
    for (size_t p = 0; p < m->count && status == MS_OK; p++) {
        for (size_t r = 0; r < m->part[p].csv.n_rows && status == MS_OK; r++, rows++) {
            status = place_row(m, &m->part[p], m->part[p].csv.row[r], err);
        }
    }
    if (status == MS_OK && rows < m->grains) {
        size_t missing = 0;
        while (m->row[missing]) {
            missing++;
        }
        status = ms_fail(err, MS_ERR_ARG,
                         "%zu of %zu grains have no row, grain %zu the first of them: a part is not at its end; go on "
                         "with it by --resume",
                         m->grains - rows, m->grains, missing + 1);
    }
    return status == MS_OK && m->grains == 0 ? ms_fail(err, MS_ERR_ARG, "the tables of the parts have no rows")
                                             : status;
}

/* A row, its file with the folder in front. @return 0 without memory */
static int write_row(FILE *stream, const char *row, const char *folder)
{
    static const char FILE_COLUMN[] = "file";
    char *field[64 + MS_MEASURES], *name[64 + MS_MEASURES];
    char *copy = strdup(row), *header = ms_grain_row_line(NULL);
    const int ok = copy && header;
    const size_t count = ok ? ms_csv_split(field, 64 + MS_MEASURES, copy) : 0;
    const size_t columns = ok ? ms_csv_split(name, 64 + MS_MEASURES, header) : 0;
    for (size_t c = 0; c < count && count == columns; c++) {
        if (c > 0) {
            fputc(',', stream);
        }
        if (folder[0] && field[c][0] && strcmp(name[c], FILE_COLUMN) == 0) {
            char path[4096];
            snprintf(path, sizeof path, "%s/%s", folder, field[c]);
            ms_escape_csv_path(stream, path);
        } else {
            ms_escape_csv(stream, field[c]);
        }
    }
    fputc('\n', stream);
    free(copy);
    free(header);
    return ok;
}

static ms_status write_rows(const merge_parts *m, const char *path, ms_error *err)
{
    ms_output output;
    char *header = ms_grain_row_line(NULL);
    ms_status status = header ? ms_output_open(&output, path, err) : ms_fail(err, MS_ERR_NOMEM, "no memory to join");
    if (status == MS_OK) {
        int ok = fprintf(output.stream, "%s\n", header) > 0;
        for (size_t g = 0; g < m->grains && ok; g++) {
            ok = m->of[g]->folder[0] ? write_row(output.stream, m->row[g], m->of[g]->folder)
                                     : fprintf(output.stream, "%s\n", m->row[g]) > 0;
        }
        status = ok ? MS_OK : ms_fail(err, MS_ERR_IO, "%s: could not be written; is the disk full?", path);
        status = ms_output_close(&output, status, err);
    }
    free(header);
    return status;
}

static void free_parts(merge_parts *m)
{
    for (size_t p = 0; p < m->count; p++) {
        ms_csv_close(&m->part[p].csv);
        free(m->part[p].path);
    }
    free(m->part);
    free(m->row);
    free(m->of);
}

/* Without what does not matter at its end. */
static int is_same_folder(const char *a, const char *b)
{
    size_t n = strlen(a), k = strlen(b);
    while (n > 1 && a[n - 1] == '/') {
        n--;
    }
    while (k > 1 && b[k - 1] == '/') {
        k--;
    }
    return n == k && memcmp(a, b, n) == 0;
}

ms_status ms_grain_merge(const char *folder, char *const *parts, size_t count, ms_error *err)
{
    char path[4096];
    merge_parts m = {0};
    ms_status status = MS_OK;
    for (size_t p = 0; p < count && status == MS_OK; p++) {
        status = add_parts(&m, parts[p], is_same_folder(folder, parts[p]), err);
    }
    if (status == MS_OK) {
        status = check_parts(&m, err);
    }
    if (status == MS_OK) {
        status = place_rows(&m, err);
    }
    if (status == MS_OK) {
        snprintf(path, sizeof path, "%s/grains.csv", folder);
        status = write_rows(&m, path, err);
    }
    if (status == MS_OK) {
        printf("wrote %s, %zu rows of %zu parts\n", path, m.grains, m.count);
    }
    free_parts(&m);
    return status;
}
