/* What the headers of volume files share. */
#include <stdlib.h>
#include <string.h>

#include "ms_volume_formats.h"

ms_volume_header ms_volume_header_start(size_t max_voxels)
{
    return (ms_volume_header){.spacing = {1.0, 1.0, 1.0}, .max_voxels = max_voxels};
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

char *ms_volume_path_beside(const ms_word *file, const char *header)
{
    const char *slash = strrchr(header, '/');
    size_t folder = slash && file->start[0] != '/' ? (size_t)(slash + 1 - header) : 0;
    char *path = malloc(folder + file->length + 1);
    if (path) {
        memcpy(path, header, folder);
        memcpy(path + folder, file->start, file->length);
        path[folder + file->length] = '\0';
    }
    return path;
}

ms_status ms_volume_read_beside(ms_bytes *bytes, const ms_word *file, const ms_text *header, ms_error *err)
{
    ms_error inner = {{0}};
    char *path = ms_volume_path_beside(file, header->name);
    *bytes = (ms_bytes){0};
    if (!path) {
        return ms_fail(err, MS_ERR_NOMEM, "%s: no memory to read its data file", header->name);
    }
    ms_status status = ms_file_read(bytes, path, &inner);
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
