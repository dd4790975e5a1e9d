/* What the headers of volume files share. */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ms_volume_formats.h"

ms_volume_header ms_volume_header_start(size_t max_voxels)
{
    return (ms_volume_header){.spacing = {1.0, 1.0, 1.0}, .axis = {0, 1, 2}, .slope = 1.0, .max_voxels = max_voxels};
}

int ms_volume_header_set_axes(ms_volume_header *header, const double direction[3][3])
{
    /* Turned by as much, the last of 1000 voxels is a tenth of a voxel aside. */
    static const double OBLIQUE = 1e-4;
    int taken = 0;
    for (int f = 0; f < 3; f++) {
        const double *d = direction[f];
        int a = fabs(d[1]) > fabs(d[0]) ? 1 : 0;
        a = fabs(d[2]) > fabs(d[a]) ? 2 : a;
        const double aside = fabs(d[(a + 1) % 3]) + fabs(d[(a + 2) % 3]);
        /* The negation also catches nan. */
        if (!(fabs(d[a]) > 0.0 && aside <= OBLIQUE * fabs(d[a]))) {
            return 0;
        }
        header->axis[f] = a;
        header->mirrored[f] = d[a] < 0;
        taken |= 1 << a;
    }
    return taken == 7;
}

ms_status ms_volume_data_file(ms_word *file, ms_text *value, ms_error *err)
{
    ms_text peek = *value;
    ms_word first;
    *file = ms_text_rest(value);
    if (file->length == 0) {
        return ms_text_fail(err, value, "no data file is named");
    }
    int is_list = ms_text_word(&first, &peek) && first.length == 4 && memcmp(first.start, "LIST", 4) == 0;
    if (is_list || memchr(file->start, '%', file->length)) {
        return ms_text_fail(err, value, "a volume in one file per slice is not read; save it in one file");
    }
    return MS_OK;
}

/* A header from elsewhere must not make any file of this machine a volume. */
static ms_status fail_outside(const ms_word *file, const ms_text *header, ms_error *err)
{
    return ms_text_fail(err, header, "the data file '%s' is not in the folder of the header; put both in one folder",
                        ms_text_quote(file).text);
}

/* Does a path with folders lead up, or begin at the root? */
static int leads_out(const ms_word *file)
{
    const char *at = file->start, *end = at + file->length;
    while (at < end) {
        const char *slash = memchr(at, '/', (size_t)(end - at));
        const size_t length = (size_t)((slash ? slash : end) - at);
        if ((length == 0 && at == file->start) || (length == 2 && memcmp(at, "..", 2) == 0)) {
            return 1;
        }
        at += length + 1;
    }
    return 0;
}

/* Refuses a symbolic link that leads out of the folder, which is the first characters of the path; a file that is
 * missing leads nowhere. */
static ms_status check_links(const char *path, size_t folder_length, const ms_word *file, const ms_text *header,
                             ms_error *err)
{
    char *folder = folder_length > 0 ? strndup(path, folder_length) : strdup(".");
    errno = 0;
    char *home = folder ? realpath(folder, NULL) : NULL, *real = folder ? realpath(path, NULL) : NULL;
    const size_t length = home ? strlen(home) : 0;
    ms_status status = MS_OK;
    if (!folder || errno == ENOMEM) {
        status = ms_fail(err, MS_ERR_NOMEM, "%s: no memory to read its data file", header->name);
    } else if (home && real && !(strncmp(real, home, length) == 0 && (length == 1 || real[length] == '/'))) {
        status = fail_outside(file, header, err);
    }
    free(folder);
    free(home);
    free(real);
    return status;
}

/* How many characters of a header's path are its folder. */
static size_t measure_folder(const char *header)
{
    return (size_t)(ms_file_base_name(header) - header);
}

ms_status ms_volume_read_beside(ms_bytes *bytes, const ms_word *file, const ms_text *header, ms_error *err)
{
    ms_error inner = {{0}};
    *bytes = (ms_bytes){0};
    if (leads_out(file)) {
        return fail_outside(file, header, err);
    }
    char *path = ms_file_beside(header->name, file->start, file->length);
    if (!path) {
        return ms_fail(err, MS_ERR_NOMEM, "%s: no memory to read its data file", header->name);
    }
    ms_status status = check_links(path, measure_folder(header->name), file, header, err);
    if (status) {
        free(path);
        return status;
    }
    status = ms_file_map(bytes, path, &inner);
    if (status) {
        ms_fail(err, status, "%s: line %zu: names a data file that cannot be used: %s", header->name, header->line,
                inner.text);
    }
    free(path);
    return status;
}

ms_text ms_volume_text_of_word(const ms_word *word, const ms_text *from)
{
    return (ms_text){.at = word->start, .end = word->start + word->length, .name = from->name, .line = from->line};
}

ms_status ms_volume_text_integers(int64_t *values, size_t n, ms_text *text, ms_error *err)
{
    ms_word word;
    for (size_t i = 0; i < n; i++) {
        if (!ms_text_word(&word, text)) {
            return ms_text_fail(err, text, "%zu integers are needed but there are %zu", n, i);
        }
        if (!ms_text_to_integer(&values[i], &word)) {
            return ms_text_fail(err, text, "'%s' stands where an integer belongs", ms_text_quote(&word).text);
        }
    }
    return ms_text_end_line(text, err);
}
