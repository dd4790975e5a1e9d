#include "ms_grain_merge.h"

#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/ms_escape.h"
#include "base/ms_file.h"
#include "chart/ms_csv.h"
#include "cli/ms_files.h"
#include "ms_grain_row.h"

enum { MOST_COLUMNS = 64 + MS_MEASURES, RUN_LENGTH = 16 };

/* A table of a part. */
typedef struct merge_part {
    size_t word; /* of which it is, in `folder` of all */
    char *path;
    size_t part, parts;
    ms_csv csv;
} merge_part;

typedef struct merge_parts {
    const char *header;
    char **folder; /* of the words, from the folder of the whole; "" where they are one */
    merge_part *part;
    size_t count;
    char **row; /* by number of the grain; borrowed from the tables */
    const merge_part **of;
    size_t grains;
    char run[RUN_LENGTH + 1];
} merge_parts;

/* Nonzero for the name of a part's table. */
static int read_name(size_t *part, size_t *parts, const char *name)
{
    char rest[8] = "";
    return sscanf(name, "grains-%zu-of-%zu%7s", part, parts, rest) == 3 && strcmp(rest, ".csv") == 0 && *part >= 1 &&
           *part <= *parts;
}

/* The way from one folder to another, both without links and from the root on. It ends with a slash, or is empty. The
 * caller frees it; NULL without memory. */
static char *find_way(const char *from, const char *to)
{
    size_t same = 0, up = 0, k = 0;
    for (; from[k] && from[k] == to[k]; k++) {
        same = from[k] == '/' ? k + 1 : same;
    }
    if ((!from[k] || from[k] == '/') && (!to[k] || to[k] == '/')) { /* one of them ends with a whole name */
        same = k + (from[k] || to[k]);
    }
    for (const char *rest = strlen(from) > same ? from + same : ""; *rest; rest += strcspn(rest, "/")) {
        rest += *rest == '/';
        up++;
    }
    const char *down = strlen(to) > same ? to + same : "";
    char *way = malloc(3 * up + strlen(down) + 2);
    for (size_t u = 0; u < up && way; u++) {
        strcpy(way + 3 * u, "../");
    }
    if (way) {
        sprintf(way + 3 * up, "%s%s", down, down[0] ? "/" : "");
    }
    return way;
}

static ms_status resolve_folder(char *out, const char *folder, ms_error *err)
{
    return realpath(folder, out) ? MS_OK : ms_fail(err, MS_ERR_IO, "%s: %s", folder, strerror(errno));
}

/* Reads the table and closes it, since there may be more parts than files may be open. */
static ms_status add_part(merge_parts *m, const char *folder, const char *name, size_t word, ms_error *err)
{
    merge_part part = {.word = word, .csv = {.fd = -1}};
    if (!read_name(&part.part, &part.parts, name)) {
        return MS_OK;
    }
    const size_t size = strlen(folder) + strlen(name) + 2;
    merge_part *grown = realloc(m->part, (m->count + 1) * sizeof *grown);
    m->part = grown ? grown : m->part;
    part.path = grown ? malloc(size) : NULL;
    if (!part.path) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the parts");
    }
    snprintf(part.path, size, "%s/%s", folder, name);
    const ms_status status = ms_csv_read(&part.csv, part.path, m->header, err);
    m->part[m->count++] = part;
    return status;
}

static ms_status add_parts(merge_parts *m, const char *folder, size_t word, ms_error *err)
{
    struct dirent **entry;
    const int found = scandir(folder, &entry, NULL, alphasort);
    ms_status status = found < 0 ? ms_fail(err, MS_ERR_IO, "%s: %s", folder, strerror(errno)) : MS_OK;
    for (int e = 0; e < found; e++) {
        status = status == MS_OK ? add_part(m, folder, entry[e]->d_name, word, err) : status;
        free(entry[e]);
    }
    if (found >= 0) {
        free(entry);
    }
    return status;
}

/* The ways to all folders from that of the whole, which is there. */
static ms_status find_ways(merge_parts *m, const char *whole, char *const *folders, size_t count, ms_error *err)
{
    char from[PATH_MAX], to[PATH_MAX];
    ms_status status = resolve_folder(from, whole, err);
    m->folder = calloc(count + 1, sizeof *m->folder);
    for (size_t f = 0; f < count && status == MS_OK; f++) {
        status = resolve_folder(to, folders[f], err);
        if (status == MS_OK && (!m->folder || !(m->folder[f] = find_way(from, to)))) {
            status = ms_fail(err, MS_ERR_NOMEM, "no memory for the parts");
        }
    }
    return status;
}

static int compare_parts(const void *a, const void *b)
{
    const merge_part *x = a, *y = b;
    return (x->part > y->part) - (x->part < y->part);
}

/* Is each of the parts there, once? Sorts them. */
static ms_status check_parts(merge_parts *m, ms_error *err)
{
    if (m->count == 0) {
        return ms_fail(err, MS_ERR_ARG, "no table of a part, as grains-1-of-4.csv, is in these folders");
    }
    qsort(m->part, m->count, sizeof *m->part, compare_parts);
    const merge_part *first = m->part;
    for (size_t p = 1; p < m->count; p++) {
        const merge_part *part = &m->part[p];
        if (part->parts != first->parts) {
            return ms_fail(err, MS_ERR_ARG, "%s is one of %zu parts and %s one of %zu: they are of different runs",
                           first->path, first->parts, part->path, part->parts);
        }
        if (part->part == part[-1].part) {
            return ms_fail(err, MS_ERR_ARG, "%s and %s are the same part", part[-1].path, part->path);
        }
    }
    size_t missing = 1;
    while (missing <= m->count && m->part[missing - 1].part == missing) {
        missing++;
    }
    return m->count == first->parts
               ? MS_OK
               : ms_fail(err, MS_ERR_ARG,
                         "there are %zu of %zu parts, part %zu is the first that is not there; run "
                         "the others, too",
                         m->count, first->parts, missing);
}

/* The first three fields of a row: its grain, of how many, of which run. */
static int read_start(size_t *grain, size_t *grains, char run[RUN_LENGTH + 1], const char *row)
{
    return sscanf(row, "%zu,%zu,%16[0-9a-f],", grain, grains, run) == 3 && *grain >= 1 && *grain <= *grains;
}

static ms_status place_row(merge_parts *m, const merge_part *part, char *row, ms_error *err)
{
    size_t grain, grains;
    char run[RUN_LENGTH + 1];
    if (!read_start(&grain, &grains, run, row)) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: '%.60s' does not begin with the number of a grain", part->path, row);
    }
    if (!m->row) {
        m->grains = grains;
        strcpy(m->run, run);
        m->row = calloc(grains, sizeof *m->row);
        m->of = calloc(grains, sizeof(const merge_part *));
        if (!m->row || !m->of) {
            return ms_fail(err, MS_ERR_NOMEM, "no memory for the rows of %zu grains", grains);
        }
    }
    if (grains != m->grains || strcmp(run, m->run) != 0) {
        return ms_fail(err, MS_ERR_ARG,
                       "%s: is of another run than %s, its grains or flags were others; make all parts by one command",
                       part->path, m->part[0].path);
    }
    if (m->row[grain - 1]) {
        return ms_fail(err, MS_ERR_ARG, "%s: grain %zu of %zu is in %s, too", part->path, grain, grains,
                       m->of[grain - 1]->path);
    }
    m->row[grain - 1] = row;
    m->of[grain - 1] = part;
    return MS_OK;
}

/* Which grain lacks its row is known, of which part it is only roughly: all have about as many. */
static ms_status refuse_gaps(const merge_parts *m, size_t rows, ms_error *err)
{
    size_t missing = 0, least = 0;
    while (m->row[missing]) {
        missing++;
    }
    for (size_t p = 1; p < m->count; p++) {
        least = m->part[p].csv.n_rows < m->part[least].csv.n_rows ? p : least;
    }
    return ms_fail(
        err, MS_ERR_ARG,
        "%zu of %zu grains have no row, grain %zu the first of them: a part is not at its end, as %s with the "
        "fewest, %zu; go on with it by --resume",
        m->grains - rows, m->grains, missing + 1, m->part[least].path, m->part[least].csv.n_rows);
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
        status = refuse_gaps(m, rows, err);
    }
    return status == MS_OK && m->grains == 0 ? ms_fail(err, MS_ERR_ARG, "the tables of the parts have no rows")
                                             : status;
}

/* The number of the column "file". */
static size_t find_file_column(char *header)
{
    char *name[MOST_COLUMNS];
    const size_t columns = ms_csv_split(name, MOST_COLUMNS, header);
    size_t c = 0;
    while (c < columns && strcmp(name[c], "file") != 0) {
        c++;
    }
    return c;
}

/* A row, which is cut, its file with the folder in front. */
static void write_row(FILE *stream, char *row, const char *folder, size_t file_column)
{
    char *field[MOST_COLUMNS];
    const size_t count = ms_csv_split(field, MOST_COLUMNS, row);
    for (size_t c = 0; c < count; c++) {
        if (c > 0) {
            fputc(',', stream);
        }
        if (c == file_column && field[c][0]) {
            char path[PATH_MAX + 512];
            snprintf(path, sizeof path, "%s%s", folder, field[c]);
            ms_escape_csv_path(stream, path);
        } else {
            ms_escape_csv(stream, field[c]);
        }
    }
    fputc('\n', stream);
}

/* A table that is there may be replaced by one of the same run alone. */
static ms_status check_whole(const merge_parts *m, const char *path, ms_error *err)
{
    ms_csv csv = {.fd = -1};
    size_t grain, grains;
    char run[RUN_LENGTH + 1];
    ms_status status = access(path, F_OK) == 0 ? ms_csv_read(&csv, path, m->header, err) : MS_OK;
    if (status == MS_OK && csv.n_rows &&
        !(read_start(&grain, &grains, run, csv.row[0]) && grains == m->grains && strcmp(run, m->run) == 0)) {
        status =
            ms_fail(err, MS_ERR_ARG, "%s: is of another run than %s and would be replaced; name another folder by -o",
                    path, m->part[0].path);
    }
    ms_csv_close(&csv);
    return status;
}

static ms_status write_rows(const merge_parts *m, const char *path, ms_error *err)
{
    ms_output output;
    char *copy = strdup(m->header);
    ms_status status = copy ? ms_output_open(&output, path, err) : ms_fail(err, MS_ERR_NOMEM, "no memory to join");
    if (status == MS_OK) {
        const size_t file_column = find_file_column(copy);
        fprintf(output.stream, "%s\n", m->header);
        for (size_t g = 0; g < m->grains; g++) {
            const char *folder = m->folder[m->of[g]->word];
            if (folder[0]) {
                write_row(output.stream, m->row[g], folder, file_column);
            } else {
                fprintf(output.stream, "%s\n", m->row[g]);
            }
        }
        status = ms_output_close(&output, status, err); /* sees whether all was written */
    }
    free(copy);
    return status;
}

static void free_parts(merge_parts *m, size_t folders)
{
    for (size_t f = 0; f < folders && m->folder; f++) {
        free(m->folder[f]);
    }
    for (size_t p = 0; p < m->count; p++) {
        ms_csv_close(&m->part[p].csv);
        free(m->part[p].path);
    }
    free(m->folder);
    free(m->part);
    free(m->row);
    free(m->of);
}

ms_status ms_grain_merge(const char *folder, char *const *parts, size_t count, ms_error *err)
{
    char path[PATH_MAX];
    char *header = ms_grain_row_line(NULL);
    merge_parts m = {.header = header};
    ms_status status = header ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for the header");
    for (size_t f = 0; f < count && status == MS_OK; f++) {
        status = add_parts(&m, parts[f], f, err);
    }
    if (status == MS_OK) {
        status = check_parts(&m, err);
    }
    if (status == MS_OK) {
        status = place_rows(&m, err);
    }
    if (status == MS_OK) {
        snprintf(path, sizeof path, "%s/grains.csv", folder);
        status = check_whole(&m, path, err);
    }
    if (status == MS_OK) { /* not before: what is refused leaves none behind */
        status = ms_files_make_folder(folder, err);
    }
    if (status == MS_OK) {
        status = find_ways(&m, folder, parts, count, err);
    }
    if (status == MS_OK) {
        status = write_rows(&m, path, err);
    }
    if (status == MS_OK) {
        printf("wrote %s, %zu rows of %zu parts\n", path, m.grains, m.count);
    }
    free_parts(&m, count);
    free(header);
    return status;
}
