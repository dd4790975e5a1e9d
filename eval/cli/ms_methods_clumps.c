/* Clumps of other tools: which goes with which shape. */
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/ms_file.h"
#include "clump/formats/ms_read.h"
#include "ms_methods.h"
#include "ms_paths.h"

/* A pattern says itself what is hidden, and what it finds may begin with ./ or ../ */
static int is_any(const char *name, int in_folder)
{
    return !in_folder || name[0] != '.';
}

/* Length of the shape's name if the clump is called by it; 0 if not. */
static size_t match_name(const char *file, const char *shape)
{
    size_t of_file, of_shape;
    const char *a = ms_file_stem(&of_file, file), *b = ms_file_stem(&of_shape, shape);
    const int begins = of_shape <= of_file && memcmp(a, b, of_shape) == 0;
    return begins && (of_file == of_shape || a[of_shape] == '-' || a[of_shape] == '_') ? of_shape : 0;
}

/* The shape that a file goes with; n_shapes for none. */
static size_t find_shape(const char *file, char *const *shape, size_t n_shapes)
{
    size_t best = n_shapes, longest = 0;
    for (size_t s = 0; s < n_shapes; s++) {
        const size_t length = match_name(file, shape[s]);
        if (length > longest) {
            longest = length;
            best = s;
        }
    }
    return best;
}

/* Folders are passed over: templates that are folders are written and not read. */
static ms_status pair_file(ms_method *method, char *file, char *const *shape, ms_error *err)
{
    struct stat info;
    const size_t at = find_shape(file, shape, method->n_clumps);
    if (at == method->n_clumps || (stat(file, &info) == 0 && S_ISDIR(info.st_mode))) {
        return MS_OK;
    }
    if (method->clump[at].file) {
        return ms_fail(err, MS_ERR_ARG,
                       "--clump %s=%s: both %s and %s go with %s by their names; name one kind by a pattern, as "
                       "'%s=FOLDER/*.csv'",
                       method->name, method->options, method->clump[at].file, file, shape[at], method->name);
    }
    method->clump[at].file = strdup(file);
    return method->clump[at].file ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for the name of a clump");
}

/* Gives each shape its file. */
static ms_status pair_files(ms_method *method, const ms_paths *paths, char *const *shape, ms_error *err)
{
    ms_status status = MS_OK;
    const int is_file = paths->count == 1 && strcmp(paths->path[0], method->options) == 0;
    if (is_file && method->n_clumps > 1) {
        return ms_fail(err, MS_ERR_ARG,
                       "--clump %s=%s is a clump of one shape, and there are %zu; name a folder or a pattern of clumps",
                       method->name, method->options, method->n_clumps);
    }
    if (is_file) {
        method->clump[0].file = strdup(paths->path[0]);
        return method->clump[0].file ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for the name of a clump");
    }
    for (size_t p = 0; p < paths->count && status == MS_OK; p++) {
        status = pair_file(method, paths->path[p], shape, err);
    }
    for (size_t s = 0; s < method->n_clumps && status == MS_OK; s++) {
        if (!method->clump[s].file) {
            status = ms_fail(err, MS_ERR_ARG,
                             "--clump %s=%s: no clump goes with %s; its name without ending has to be the shape's, or "
                             "that and - or _ and more",
                             method->name, method->options, shape[s]);
        }
    }
    return status;
}

static ms_status read_clumps(ms_method *method, char *const *shape, size_t n_shapes, ms_error *err)
{
    ms_paths paths = {0};
    ms_particle unused;
    method->clump = calloc(n_shapes, sizeof *method->clump);
    if (!method->clump) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the clumps of %zu shapes", n_shapes);
    }
    method->n_clumps = n_shapes;
    ms_status status = ms_paths_add(&paths, method->options, is_any, "clump", err);
    if (status == MS_OK) {
        status = pair_files(method, &paths, shape, err);
    }
    for (size_t s = 0; s < n_shapes && status == MS_OK; s++) {
        status = ms_read_clump(&method->clump[s].clump, &unused, method->clump[s].file, err);
    }
    ms_paths_free(&paths);
    return status;
}

/* Of several shapes the name alone says which clumps belong together. */
static ms_status check_name(const ms_methods *methods, size_t at, ms_error *err)
{
    for (size_t m = 0; m < at; m++) {
        if (!methods->method[m].generator && strcmp(methods->method[m].name, methods->method[at].name) == 0) {
            return ms_fail(err, MS_ERR_ARG, "--clump %s is there twice; of several shapes each tool has one name",
                           methods->method[at].name);
        }
    }
    return MS_OK;
}

ms_status ms_methods_read_clumps(ms_methods *methods, char *const *shape, size_t n_shapes, ms_error *err)
{
    ms_status status = MS_OK;
    for (size_t m = 0; m < methods->count && status == MS_OK; m++) {
        if (!methods->method[m].generator) {
            status = n_shapes > 1 ? check_name(methods, m, err) : MS_OK;
            status = status == MS_OK ? read_clumps(&methods->method[m], shape, n_shapes, err) : status;
        }
    }
    return status;
}
