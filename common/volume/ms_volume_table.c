#include "ms_volume_table.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

typedef struct volume_format {
    const char *ending;
    ms_volume_parser *parse; /* NULL: raw */
    ms_status (*find_data)(ms_word *file, const ms_bytes *bytes, const char *path,
                           ms_error *err); /* NULL: never apart */
    int may_be_packed;                     /* ENDING.gz */
} volume_format;

/* The format that the ending names, without .gz. */
static const volume_format *find_format(const char *path, int *is_packed)
{
    static const volume_format formats[] = {
        {"npy", ms_volume_parse_npy, NULL, 1},
        {"mhd", ms_volume_parse_mhd, ms_volume_find_data_mhd, 0},
        {"mha", ms_volume_parse_mhd, ms_volume_find_data_mhd, 0},
        {"nrrd", ms_volume_parse_nrrd, ms_volume_find_data_nrrd, 0},
        {"nhdr", ms_volume_parse_nrrd, ms_volume_find_data_nrrd, 0},
        {"tif", ms_volume_parse_tiff, NULL, 0},
        {"tiff", ms_volume_parse_tiff, NULL, 0},
        {"nii", ms_volume_parse_nifti, NULL, 1},
        {"raw", NULL, NULL, 1},
    };
    char ending[16], shorter[16] = "";
    const size_t length = strlen(path);
    ms_file_ending(ending, path);
    *is_packed = strcmp(ending, "gz") == 0 && length < 4096;
    if (*is_packed) {
        char inner[4096];
        snprintf(inner, sizeof inner, "%.*s", (int)(length - 3), path);
        ms_file_ending(shorter, inner);
    }
    for (size_t i = 0; i < sizeof formats / sizeof formats[0]; i++) {
        if (strcmp(*is_packed ? shorter : ending, formats[i].ending) == 0 &&
            (formats[i].may_be_packed || !*is_packed)) {
            return &formats[i];
        }
    }
    return NULL;
}

const char *ms_volume_endings(void)
{
    return ".npy, .mhd, .mha, .nrrd, .nhdr, .tif, .tiff, .nii and .raw, and .npy.gz, .nii.gz and .raw.gz";
}

int ms_scan_has_header(const char *path)
{
    int is_packed;
    const volume_format *format = find_format(path, &is_packed);
    return format && format->parse;
}

int ms_volume_is_volume_path(const char *path)
{
    int is_packed;
    return find_format(path, &is_packed) != NULL || ms_volume_table_is_folder(path);
}

static ms_status parse_plain(ms_stored *stored, const volume_format *format, const ms_bytes *bytes, const char *path,
                             const ms_scan_options *options, size_t max_voxels, ms_error *err)
{
    return format->parse ? format->parse(stored, bytes, path, max_voxels, err)
                         : ms_volume_parse_raw(stored, bytes, path, options, err);
}

/* What was unpacked stays with the voxels that lie in it. */
static ms_status parse_packed(ms_stored *stored, const volume_format *format, const ms_bytes *packed, const char *path,
                              const ms_scan_options *options, size_t max_voxels, ms_error *err)
{
    enum { HEADER = 1 << 20, LARGEST_SAMPLE = 8 };
    ms_bytes bytes;
    const size_t most =
        max_voxels < (SIZE_MAX - HEADER) / LARGEST_SAMPLE / 2 ? max_voxels * LARGEST_SAMPLE + HEADER : SIZE_MAX / 2;
    ms_status status = ms_volume_gunzip(&bytes, packed, most, path, err);
    if (status == MS_OK) {
        status = parse_plain(stored, format, &bytes, path, options, max_voxels, err);
        status = ms_volume_keep_beside(stored, &bytes, status);
    }
    return status;
}

ms_status ms_volume_table_parse(ms_stored *stored, const ms_bytes *bytes, const char *path,
                                const ms_scan_options *options, size_t max_voxels, ms_error *err)
{
    int is_packed;
    const volume_format *format = find_format(path, &is_packed);
    *stored = (ms_stored){0};
    if (!format) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: its ending names no volume format; volumes are read from %s", path,
                       ms_volume_endings());
    }
    if (bytes->size == 0) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: is empty (0 bytes); save the volume again", path);
    }
    return (is_packed ? parse_packed : parse_plain)(stored, format, bytes, path, options, max_voxels, err);
}

ms_status ms_volume_data_path(char **data, const char *path, ms_error *err)
{
    enum { MOST = 1 << 20 }; /* a header is no longer */
    int is_packed;
    const volume_format *found = find_format(path, &is_packed);
    ms_bytes bytes = {0};
    ms_word file = {0};
    *data = NULL;
    if (!found || !found->find_data || ms_file_read_start(&bytes, path, MOST, NULL) != MS_OK) {
        return MS_OK;
    }
    if (found->find_data(&file, &bytes, path, NULL) == MS_OK && file.length > 0) {
        *data = ms_file_beside(path, file.start, file.length);
    }
    ms_file_free(&bytes);
    return file.length == 0 || *data ? MS_OK
                                     : ms_fail(err, MS_ERR_NOMEM, "%s: no memory for the name of its data", path);
}

static int select_slice(const struct dirent *entry)
{
    char ending[16];
    ms_file_ending(ending, entry->d_name);
    return strcmp(ending, "tif") == 0 || strcmp(ending, "tiff") == 0;
}

static int is_decimal(char c)
{
    return c >= '0' && c <= '9';
}

/* Runs of digits as numbers, so that 9.tif is before 10.tif; equal but for leading zeros by bytes. */
static int compare_slices(const struct dirent **a, const struct dirent **b)
{
    const char *x = (*a)->d_name, *y = (*b)->d_name;
    while (*x && *y) {
        if (is_decimal(*x) && is_decimal(*y)) {
            x += strspn(x, "0");
            y += strspn(y, "0");
            const size_t lx = strspn(x, "0123456789"), ly = strspn(y, "0123456789");
            const int order = lx != ly ? (lx > ly) - (lx < ly) : strncmp(x, y, lx);
            if (order) {
                return order;
            }
            x += lx;
            y += ly;
        } else if (*x != *y) {
            break;
        } else {
            x++;
            y++;
        }
    }
    const int order = (unsigned char)*x - (unsigned char)*y;
    return order ? order : strcmp((*a)->d_name, (*b)->d_name);
}

static void free_names(struct dirent **name, int count)
{
    for (int k = 0; k < count; k++) {
        free(name[k]);
    }
    if (count >= 0) {
        free(name);
    }
}

/* The path of a file in a folder; the caller frees it; NULL without memory. */
static char *path_in(const char *folder, const char *name)
{
    const size_t size = strlen(folder) + strlen(name) + 2;
    const int slash = folder[0] && folder[strlen(folder) - 1] == '/';
    char *path = malloc(size);
    if (path) {
        snprintf(path, size, "%s%s%s", folder, slash ? "" : "/", name);
    }
    return path;
}

int ms_volume_table_is_folder(const char *path)
{
    struct stat info;
    struct dirent **name;
    ms_bytes bytes = {0};
    if (stat(path, &info) != 0 || !S_ISDIR(info.st_mode)) {
        return 0;
    }
    const int count = scandir(path, &name, select_slice, compare_slices);
    char *first = count > 0 ? path_in(path, name[0]->d_name) : NULL;
    const int is_slice = first && ms_file_map(&bytes, first, NULL) == MS_OK && ms_volume_tiff_is_slice(&bytes);
    ms_file_free(&bytes);
    free(first);
    free_names(name, count);
    return is_slice;
}

static ms_status add_slice(ms_stored *stored, uint64_t *checksum, const char *path, size_t max_voxels, ms_error *err)
{
    ms_bytes bytes;
    ms_status status = ms_file_map(&bytes, path, err);
    if (status == MS_OK) {
        *checksum = ms_file_checksum_add(*checksum, &bytes);
        status = ms_volume_tiff_add(stored, &bytes, path, max_voxels, err);
    }
    ms_file_free(&bytes);
    return status;
}

ms_status ms_volume_table_read_slices(ms_stored *stored, uint64_t *checksum, const char *path, size_t max_voxels,
                                      ms_error *err)
{
    struct dirent **name;
    const int count = scandir(path, &name, select_slice, compare_slices);
    ms_status status = count > 0 ? MS_OK : ms_fail(err, MS_ERR_IO, "%s: has no slice any more", path);
    *stored = (ms_stored){0};
    *checksum = MS_FILE_CHECKSUM;
    for (int k = 0; k < count && status == MS_OK; k++) {
        char *slice = path_in(path, name[k]->d_name);
        status = slice ? add_slice(stored, checksum, slice, max_voxels, err)
                       : ms_fail(err, MS_ERR_NOMEM, "%s: no memory for the name of a slice", path);
        free(slice);
    }
    free_names(name, count);
    if (status != MS_OK) {
        ms_volume_stored_free(stored);
    }
    return status;
}
