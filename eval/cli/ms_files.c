#include "ms_files.h"

#include <errno.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/ms_file.h"
#include "volume/ms_volume.h"

/* Where a file would stand that is not there: the real path of the nearest folder above that is, and what follows. */
static char *find_place(const char *path)
{
    const char *slash = strrchr(path, '/');
    char *folder = slash ? strndup(path, slash > path ? (size_t)(slash - path) : 1) : strdup(".");
    char *real = folder ? realpath(folder, NULL) : NULL, *place = NULL;
    if (folder && !real && strcmp(folder, path) != 0) {
        real = find_place(folder);
    }
    const char *name = ms_file_base_name(path);
    place = real ? malloc(strlen(real) + strlen(name) + 2) : NULL;
    if (place) {
        sprintf(place, "%s/%s", real, name);
    }
    free(folder);
    free(real);
    return place;
}

/* Device and inode of a file that is there, which no spelling changes; else its place. */
static char *make_key(const char *path)
{
    struct stat info;
    if (stat(path, &info) != 0) {
        return find_place(path);
    }
    char *key = malloc(64);
    if (key) {
        snprintf(key, 64, "%ju:%ju", (uintmax_t)info.st_dev, (uintmax_t)info.st_ino);
    }
    return key;
}

int ms_files_is_stream(const char *path)
{
    struct stat info;
    return strcmp(path, "-") == 0 || (stat(path, &info) == 0 && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode));
}

ms_status ms_files_take_page(const char **page, const char *flag, const char *path, ms_error *err)
{
    char ending[16];
    ms_file_ending(ending, path);
    if (strcmp(ending, "html") != 0 || ms_files_is_stream(path)) {
        return ms_fail(err, MS_ERR_ARG, "--%s '%.200s' is no name of a page; name a file that ends in .html", flag,
                       path);
    }
    *page = path;
    return MS_OK;
}

ms_status ms_files_check_standard(const char *const *path, size_t count, ms_error *err)
{
    size_t found = 0;
    for (size_t f = 0; f < count; f++) {
        found += path[f] && ms_file_is_standard(path[f]);
    }
    return found < 2 ? MS_OK
                     : ms_fail(err, MS_ERR_ARG,
                               "- is given for %zu inputs, and standard input can be read once; save the others and "
                               "name their files",
                               found);
}

static ms_status make_room(ms_files *files, ms_error *err)
{
    const size_t capacity = files->capacity ? 2 * files->capacity : 64;
    ms_file *grown = files->count < files->capacity ? files->file : realloc(files->file, capacity * sizeof *grown);
    if (!grown) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the names of %zu files", files->count + 1);
    }
    files->capacity = files->count < files->capacity ? files->capacity : capacity;
    files->file = grown;
    return MS_OK;
}

ms_status ms_files_add(ms_files *files, const char *path, ms_file_use use, ms_error *err)
{
    if (ms_files_is_stream(path)) {
        return MS_OK;
    }
    const ms_status status = make_room(files, err);
    if (status != MS_OK) {
        return status;
    }
    ms_file *file = &files->file[files->count++];
    *file = (ms_file){.path = strdup(path), .key = make_key(path), .use = use};
    return file->path && file->key ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "%s: no memory for its name", path);
}

ms_status ms_files_make_folder(const char *path, ms_error *err)
{
    struct stat info;
    const int made = mkdir(path, 0777) == 0, why = made ? 0 : errno;
    return made || (stat(path, &info) == 0 && S_ISDIR(info.st_mode))
               ? MS_OK
               : ms_fail(err, MS_ERR_IO, "the folder '%s' cannot be made: %s; name one within a folder that exists",
                         path, strerror(why));
}

ms_status ms_files_add_folder(ms_files *files, const char *path, ms_error *err)
{
    struct stat info;
    const int is_there = stat(path, &info) == 0;
    const ms_status status = ms_files_make_folder(path, err);
    return status == MS_OK && !is_there ? ms_files_add(files, path, MS_FILE_FOLDER, err) : status;
}

ms_status ms_files_add_charts(ms_files *files, const char *folder, const char *name, const char *const *endings,
                              ms_error *err)
{
    ms_status status = MS_OK;
    for (; *endings && status == MS_OK; endings++) {
        const size_t room = strlen(folder) + strlen(name) + strlen(*endings) + 2;
        char *path = malloc(room);
        if (!path) {
            return ms_fail(err, MS_ERR_NOMEM, "no memory for the names of charts");
        }
        snprintf(path, room, "%s/%s%s", folder, name, *endings);
        status = ms_files_add(files, path, MS_FILE_LATER, err);
        free(path);
    }
    return status;
}

ms_status ms_files_add_shape(ms_files *files, const char *path, ms_error *err)
{
    char *data;
    ms_status status = ms_files_add(files, path, MS_FILE_READ, err);
    if (status == MS_OK) {
        status = ms_volume_data_path(&data, path, err);
    }
    if (status == MS_OK && data) {
        status = ms_files_add(files, data, MS_FILE_READ, err);
        free(data);
    }
    return status;
}

ms_status ms_files_with_ending(const char ***path, size_t *count, const ms_files *files, const char *ending,
                               ms_error *err)
{
    *count = 0;
    *path = malloc((files->count + 1) * sizeof **path);
    if (!*path) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the names of %zu files", files->count);
    }
    for (size_t f = 0; f < files->count; f++) {
        const char *dot = strrchr(files->file[f].path, '.');
        if (dot && strcmp(dot, ending) == 0) {
            (*path)[(*count)++] = files->file[f].path;
        }
    }
    return MS_OK;
}

/* By file, and what is read first. */
static int by_key(const void *a, const void *b)
{
    const ms_file *f = a, *g = b;
    const int order = strcmp(f->key, g->key);
    return order ? order : (int)f->use - (int)g->use;
}

/* Two uses of one file, in the order of by_key. */
static ms_status check_pair(const ms_file *first, const ms_file *second, ms_error *err)
{
    if (second->use == MS_FILE_READ || (first->use == MS_FILE_FRAME && second->use == MS_FILE_FRAME)) {
        return MS_OK;
    }
    if (first->use == MS_FILE_READ) {
        return ms_fail(err, MS_ERR_ARG, "%s is the input itself; it is not overwritten", second->path);
    }
    if (strcmp(first->path, second->path) == 0) {
        return ms_fail(err, MS_ERR_ARG, "%s would be written twice, and what comes first be lost; name another file",
                       first->path);
    }
    return ms_fail(err, MS_ERR_ARG, "%s and %s are one file, and what comes first would be lost; name another",
                   first->path, second->path);
}

/* Writing it is begun and broken off. */
static ms_status try_file(const char *path, ms_error *err)
{
    ms_output output;
    ms_status status = ms_output_open(&output, path, err);
    if (status == MS_OK) {
        ms_output_close(&output, MS_ERR_IO, NULL); /* removes it */
    }
    return status;
}

ms_status ms_files_check(ms_files *files, ms_error *err)
{
    ms_status status = MS_OK;
    if (files->count > 0) { /* else there is no array */
        qsort(files->file, files->count, sizeof *files->file, by_key);
    }
    for (size_t f = 1; f < files->count && status == MS_OK; f++) {
        if (strcmp(files->file[f - 1].key, files->file[f].key) == 0) {
            status = check_pair(&files->file[f - 1], &files->file[f], err);
        }
    }
    for (size_t f = 0; f < files->count && status == MS_OK; f++) {
        status = files->file[f].use == MS_FILE_WRITTEN ? try_file(files->file[f].path, err) : MS_OK;
    }
    return status;
}

ms_status ms_files_remove(ms_files *files, ms_status status, ms_error *err)
{
    for (size_t f = 0; f < files->count && status == MS_OK; f++) {
        const char *path = files->file[f].path;
        if (unlink(path) != 0 && errno != ENOENT) {
            status =
                ms_fail(err, MS_ERR_IO, "%s: the file of a run before cannot be removed: %s", path, strerror(errno));
        }
    }
    ms_files_free(files);
    return status;
}

void ms_files_free(ms_files *files)
{
    for (size_t f = 0; f < files->count; f++) {
        if (files->file[f].use == MS_FILE_FOLDER && files->file[f].path) {
            rmdir(files->file[f].path); /* fails where something is in it */
        }
        free(files->file[f].path);
        free(files->file[f].key);
    }
    free(files->file);
    *files = (ms_files){0};
}
