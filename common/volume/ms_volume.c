#include "ms_volume.h"

#include <string.h>

#include "ms_volume_formats.h"

typedef struct volume_reader {
    const char *ending;
    ms_status (*parse)(ms_volume *volume, const ms_bytes *bytes, const char *path, size_t max_voxels, ms_error *err);
    ms_status (*find_data)(ms_word *file, const ms_bytes *bytes, const char *path,
                           ms_error *err); /* NULL: never apart */
} volume_reader;

static const volume_reader *find_reader(const char *path)
{
    static const volume_reader formats[] = {
        {"npy", ms_volume_parse_npy, NULL},
        {"mhd", ms_volume_parse_mhd, ms_volume_find_data_mhd},
        {"mha", ms_volume_parse_mhd, ms_volume_find_data_mhd},
        {"nrrd", ms_volume_parse_nrrd, ms_volume_find_data_nrrd},
        {"nhdr", ms_volume_parse_nrrd, ms_volume_find_data_nrrd},
    };
    char ending[16];
    ms_file_ending(ending, path);
    for (size_t i = 0; i < sizeof formats / sizeof formats[0]; i++) {
        if (strcmp(ending, formats[i].ending) == 0) {
            return &formats[i];
        }
    }
    return NULL;
}

int ms_volume_is_volume_path(const char *path)
{
    return find_reader(path) != NULL;
}

ms_status ms_volume_parse(ms_volume *volume, const ms_bytes *bytes, const char *path, size_t max_voxels, ms_error *err)
{
    const volume_reader *found = find_reader(path);
    *volume = (ms_volume){0};
    if (!found) {
        return ms_fail(err, MS_ERR_FORMAT,
                       "%s: its ending names no volume format; volumes are read from .npy, .mhd, .mha, .nrrd and .nhdr",
                       path);
    }
    if (bytes->size == 0) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: is empty (0 bytes); save the volume again", path);
    }
    return found->parse(volume, bytes, path, max_voxels, err);
}

ms_status ms_volume_read(ms_volume *volume, const char *path, size_t max_voxels, ms_error *err)
{
    ms_bytes bytes = {0};
    *volume = (ms_volume){0};
    ms_status status = find_reader(path) ? ms_file_read(&bytes, path, err) : MS_OK; /* without one, parse says so */
    if (status == MS_OK) {
        status = ms_volume_parse(volume, &bytes, path, max_voxels, err);
    }
    ms_file_free(&bytes);
    return status;
}

ms_status ms_volume_data_path(char **data, const char *path, ms_error *err)
{
    enum { MOST = 1 << 20 }; /* a header is no longer */
    const volume_reader *found = find_reader(path);
    ms_bytes bytes = {0};
    ms_word file = {0};
    *data = NULL;
    if (!found || !found->find_data || ms_file_read_start(&bytes, path, MOST, NULL) != MS_OK) {
        return MS_OK;
    }
    if (found->find_data(&file, &bytes, path, NULL) == MS_OK && file.length > 0) {
        *data = ms_volume_path_beside(&file, path);
    }
    ms_file_free(&bytes);
    return file.length == 0 || *data ? MS_OK
                                     : ms_fail(err, MS_ERR_NOMEM, "%s: no memory for the name of its data", path);
}
