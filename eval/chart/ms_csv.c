#include "ms_csv.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

#include "base/ms_file.h"
#include "base/ms_text.h"

/* Moves a quoted field to where it begins; `at` is behind its first quote. NULL if it is not closed. */
static char *unquote(char *to, char *at)
{
    while (*at) {
        if (*at == '"' && *++at != '"') {
            *to = '\0';
            return at;
        }
        *to++ = *at++;
    }
    return NULL;
}

size_t ms_csv_split(char **field, size_t most, char *row)
{
    char *at = row;
    for (size_t count = 1;; count++) {
        char *start = at;
        at = *at == '"' ? unquote(start, at + 1) : at + strcspn(at, ",");
        if (!at || (*at && *at != ',')) {
            return 0;
        }
        if (count <= most) {
            field[count - 1] = start;
        }
        if (*at == '\0') {
            return count;
        }
        *at++ = '\0';
    }
}

void ms_csv_put_number(FILE *stream, double value)
{
    fprintf(stream, ",%s", isfinite(value) ? ms_text_of_number(value).text : "");
}

double ms_csv_number(const char *field)
{
    double value;
    const ms_word word = {field, strlen(field)};
    return word.length > 0 && ms_text_to_double(&value, &word) ? value : (double)NAN;
}

static ms_status keep_row(ms_csv *csv, const char *row, size_t length, ms_error *err)
{
    char **grown = realloc(csv->row, (csv->n_rows + 1) * sizeof *grown);
    if (grown) {
        csv->row = grown;
        grown[csv->n_rows] = strndup(row, length);
    }
    if (!grown || !grown[csv->n_rows]) {
        return ms_fail(err, MS_ERR_NOMEM, "%s: no memory for %zu rows", csv->path, csv->n_rows + 1);
    }
    csv->n_rows++;
    return MS_OK;
}

static size_t count_columns(const char *header)
{
    size_t count = 1;
    for (; *header; header++) {
        count += *header == ',';
    }
    return count;
}

static ms_status check_row(const ms_csv *csv, size_t columns, ms_error *err)
{
    char *copy = strdup(csv->row[csv->n_rows - 1]);
    const size_t found = copy ? ms_csv_split(NULL, 0, copy) : columns;
    free(copy);
    return found == columns ? MS_OK
                            : ms_fail(err, MS_ERR_FORMAT, "%s: line %zu has not the %zu fields of the header; mend it",
                                      csv->path, csv->n_rows + 1, columns);
}

/* Keeps the whole lines. A file that ends within its header has none. */
static ms_status take_rows(ms_csv *csv, const ms_bytes *bytes, const char *header, ms_error *err)
{
    const char *text = (const char *)bytes->data, *end = strchr(text, '\n');
    const size_t length = strlen(header);
    const size_t first = end ? (size_t)(end - text) : bytes->size;
    if (strncmp(text, header, first) != 0 || (end && first != length)) {
        return ms_fail(err, MS_ERR_FORMAT,
                       "%s: holds something else, its first line is not the header of these results; name another file",
                       csv->path);
    }
    ms_status status = MS_OK;
    for (const char *line = end; line && status == MS_OK; line = end) {
        csv->size = line + 1 - text;
        end = strchr(line + 1, '\n');
        if (end) {
            status = keep_row(csv, line + 1, (size_t)(end - line - 1), err);
            status = status == MS_OK ? check_row(csv, count_columns(header), err) : status;
        }
    }
    return status;
}

/* Nonzero if it is all on the disk. */
static int write_whole(int fd, const char *text, size_t length)
{
    while (length > 0) {
        const ssize_t written = write(fd, text, length);
        if (written < 0 && errno != EINTR) {
            return 0;
        }
        text += written > 0 ? written : 0;
        length -= written > 0 ? (size_t)written : 0;
    }
    return fsync(fd) == 0;
}

/* Appends a line, or leaves the file as it was. */
static ms_status add_line(ms_csv *csv, const char *line, ms_error *err)
{
    const size_t length = strlen(line) + 1;
    char *whole = malloc(length + 1);
    if (!whole) {
        return ms_fail(err, MS_ERR_NOMEM, "%s: no memory for a row", csv->path);
    }
    snprintf(whole, length + 1, "%s\n", line);
    const int written = write_whole(csv->fd, whole, length);
    const int why = errno;
    free(whole);
    if (written) {
        csv->size += (off_t)length;
        return MS_OK;
    }
    const int intact = ftruncate(csv->fd, csv->size) == 0;
    return ms_fail(err, MS_ERR_IO,
                   "%s: could not be written: %s; is the disk full, or the size of files limited? The %zu rows before "
                   "are intact%s",
                   csv->path, strerror(why), csv->n_rows, intact ? "" : ", behind them is half a row");
}

static ms_status read_rows(ms_csv *csv, const char *header, ms_error *err)
{
    ms_bytes bytes;
    ms_status status = ms_file_read(&bytes, csv->path, err);
    if (status == MS_OK) {
        status = take_rows(csv, &bytes, header, err);
        ms_file_free(&bytes);
    }
    return status;
}

/* Keeps others away, without waiting for them. */
static ms_status lock(const ms_csv *csv, int kind, ms_error *err)
{
    if (flock(csv->fd, kind | LOCK_NB) == 0) {
        return MS_OK;
    }
    return errno == EWOULDBLOCK
               ? ms_fail(err, MS_ERR_IO, "%s: another run is writing it; wait for its end, or name another file",
                         csv->path)
               : ms_fail(err, MS_ERR_IO,
                         "%s: cannot be locked against other runs: %s; name a file on a file system with locks",
                         csv->path, strerror(errno));
}

/* Opens the file and keeps every other run away from it. */
static ms_status open_locked(ms_csv *csv, int resume, ms_error *err)
{
    csv->fd = open(csv->path, O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC | (resume ? 0 : O_EXCL), 0666);
    if (csv->fd < 0 && errno == EEXIST) {
        return ms_fail(err, MS_ERR_IO,
                       "%s: exists already, and rows of results are not replaced; name another file (--resume goes "
                       "on with one)",
                       csv->path);
    }
    if (csv->fd < 0) {
        return ms_fail(err, MS_ERR_IO, "%s: cannot be written: %s; check that its folder exists and may be written to",
                       csv->path, strerror(errno));
    }
    return lock(csv, LOCK_EX, err);
}

ms_status ms_csv_open(ms_csv *csv, const char *path, const char *header, int resume, ms_error *err)
{
    *csv = (ms_csv){.path = path, .fd = -1};
    if (strcmp(path, "-") == 0) {
        return ms_fail(err, MS_ERR_IO, "-: these results go to a file, so that they can be taken up again; name one");
    }
    ms_status status = open_locked(csv, resume, err);
    if (status == MS_OK) {
        status = read_rows(csv, header, err);
    }
    if (status != MS_OK || csv->size > 0) {
        return status == MS_OK && ftruncate(csv->fd, csv->size) != 0
                   ? ms_fail(err, MS_ERR_IO, "%s: cannot be written: %s", path, strerror(errno))
                   : status;
    }
    status = ftruncate(csv->fd, 0) == 0 ? add_line(csv, header, err)
                                        : ms_fail(err, MS_ERR_IO, "%s: cannot be written: %s", path, strerror(errno));
    if (status != MS_OK) {
        unlink(path); /* there was no row in it */
    }
    return status;
}

ms_status ms_csv_read(ms_csv *csv, const char *path, const char *header, ms_error *err)
{
    *csv = (ms_csv){.path = path, .fd = open(path, O_RDONLY | O_CLOEXEC)};
    if (csv->fd < 0) {
        return ms_file_fail_open(err, path, errno);
    }
    ms_status status = lock(csv, LOCK_SH, err);
    if (status == MS_OK) {
        status = read_rows(csv, header, err);
    }
    close(csv->fd);
    csv->fd = -1;
    return status;
}

ms_status ms_csv_add(ms_csv *csv, const char *row, ms_error *err)
{
    const ms_status status = add_line(csv, row, err);
    return status == MS_OK ? keep_row(csv, row, strlen(row), err) : status;
}

void ms_csv_close(ms_csv *csv)
{
    for (size_t r = 0; r < csv->n_rows; r++) {
        free(csv->row[r]);
    }
    free(csv->row);
    if (csv->fd >= 0) {
        close(csv->fd);
    }
    *csv = (ms_csv){.fd = -1};
}
