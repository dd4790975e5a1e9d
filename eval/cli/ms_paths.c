#include "ms_paths.h"

#include <dirent.h>
#include <errno.h>
#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "mesh/formats/ms_mesh_read.h"
#include "volume/ms_scan.h"
#include "volume/ms_volume.h"

int ms_paths_is_shape(const char *name, int in_folder)
{
    return ms_mesh_read_is_mesh_path(name) || (in_folder ? ms_scan_has_header(name) : ms_volume_is_volume_path(name));
}

/* FOLDER/NAME, or NAME alone without a folder. */
static ms_status add_path(ms_paths *paths, const char *folder, const char *name, ms_error *err)
{
    const size_t capacity = paths->capacity ? 2 * paths->capacity : 64;
    char **grown = paths->count < paths->capacity ? paths->path : realloc(paths->path, capacity * sizeof *grown);
    const size_t length = folder ? strlen(folder) : 0, size = length + strlen(name) + 2;
    char *path = malloc(size);
    if (grown && paths->count == paths->capacity) {
        paths->path = grown;
        paths->capacity = capacity;
    }
    if (!grown || !path) {
        free(path);
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the names of %zu files", paths->count + 1);
    }
    const int ends = length == 0 || folder[length - 1] == '/';
    snprintf(path, size, "%s%s%s", folder ? folder : "", ends ? "" : "/", name);
    paths->path[paths->count++] = path;
    return MS_OK;
}

static int by_name(const struct dirent **a, const struct dirent **b)
{
    return strcmp((*a)->d_name, (*b)->d_name);
}

static ms_status add_folder(ms_paths *paths, const char *folder, ms_paths_choice choose, const char *what,
                            ms_error *err)
{
    struct dirent **entry;
    const size_t before = paths->count;
    const int count = scandir(folder, &entry, NULL, by_name);
    ms_status status = count >= 0 ? MS_OK : ms_fail(err, MS_ERR_IO, "%s: %s", folder, strerror(errno));
    for (int e = 0; e < count; e++) {
        if (status == MS_OK && choose(entry[e]->d_name, 1)) {
            status = add_path(paths, folder, entry[e]->d_name, err);
        }
        free(entry[e]);
    }
    if (count >= 0) {
        free(entry);
    }
    return status == MS_OK && paths->count == before
               ? ms_fail(err, MS_ERR_IO, "%s: no %s is in this folder", folder, what)
               : status;
}

static ms_status add_pattern(ms_paths *paths, const char *pattern, ms_paths_choice choose, const char *what,
                             ms_error *err)
{
    glob_t found;
    ms_status status = MS_OK;
    const size_t before = paths->count;
    const int failed = glob(pattern, 0, NULL, &found);
    if (failed == GLOB_NOSPACE) {
        return ms_fail(err, MS_ERR_NOMEM, "%s: no memory for the files that fit this pattern", pattern);
    }
    if (failed) {
        return ms_fail(err, MS_ERR_IO, "%s: no file has this name or fits this pattern", pattern);
    }
    for (size_t p = 0; p < found.gl_pathc && status == MS_OK; p++) {
        status = choose(found.gl_pathv[p], 0) ? add_path(paths, NULL, found.gl_pathv[p], err) : MS_OK;
    }
    globfree(&found);
    return status == MS_OK && paths->count == before
               ? ms_fail(err, MS_ERR_IO, "%s: no %s fits this pattern", pattern, what)
               : status;
}

ms_status ms_paths_add(ms_paths *paths, const char *word, ms_paths_choice choose, const char *what, ms_error *err)
{
    struct stat info;
    if (stat(word, &info) != 0) {
        return strcspn(word, "*?[") == strlen(word) ? add_path(paths, NULL, word, err)
                                                    : add_pattern(paths, word, choose, what, err);
    }
    if (S_ISDIR(info.st_mode) && !ms_volume_is_volume_path(word)) { /* of slices, it is a volume */
        return add_folder(paths, word, choose, what, err);
    }
    return add_path(paths, NULL, word, err);
}

void ms_paths_free(ms_paths *paths)
{
    for (size_t p = 0; p < paths->count; p++) {
        free(paths->path[p]);
    }
    free(paths->path);
    *paths = (ms_paths){0};
}
