#include "ms_outputs.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/ms_file.h"

static ms_status take_format(ms_outputs *outputs, const char *name, ms_error *err)
{
    const ms_format *format = ms_write_format_find(name, err);
    if (!format) {
        return MS_ERR_ARG;
    }
    for (size_t f = 0; f < outputs->n_formats; f++) {
        if (outputs->format[f] == format) {
            return ms_fail(err, MS_ERR_ARG, "--format %s is given twice", name);
        }
    }
    outputs->format[outputs->n_formats++] = format; /* there are fewer formats than room */
    return MS_OK;
}

ms_status ms_outputs_flag(int *taken, ms_outputs *outputs, const char *name, const char *value, ms_error *err)
{
    *taken = 1;
    if (strcmp(name, "output") == 0) {
        if (outputs->n_asked == MS_OUTPUTS_MAX) {
            return ms_fail(err, MS_ERR_LIMIT, "more than %d outputs", MS_OUTPUTS_MAX);
        }
        outputs->asked[outputs->n_asked++] = value;
        return MS_OK;
    }
    if (strcmp(name, "format") == 0) {
        return take_format(outputs, value, err);
    }
    if (strcmp(name, "all-formats") == 0) {
        outputs->folder = value;
        return MS_OK;
    }
    *taken = 0;
    return MS_OK;
}

static ms_status check_need(const ms_format *format, ms_need need, ms_error *err)
{
    return format->need <= need ? MS_OK
                                : ms_fail(err, MS_ERR_ARG,
                                          "a %s template needs the mass of the particle%s: use mskit correct, or "
                                          "generate --correct --density RHO",
                                          format->name, format->need == MS_NEED_MASSES ? " and of each sphere" : "");
}

/* The format of an output that was asked for. */
static ms_status add_asked(ms_outputs *outputs, const char *path, ms_need need, ms_error *err)
{
    ms_error cause;
    const ms_format *format = outputs->n_formats ? outputs->format[0] : ms_write_format_of_path(path, &cause);
    if (path[0] == '\0') {
        return ms_fail(err, MS_ERR_ARG, "--output '' names no file; use - for standard output");
    }
    if (!format) {
        return ms_fail(err, MS_ERR_ARG,
                       "the ending of --output '%.200s' names no format, and --format is not given: %s", path,
                       cause.text);
    }
    outputs->file[outputs->n_files++] = (ms_output_file){path, NULL, format};
    return check_need(format, need, err);
}

/* FOLDER/NAME-BEHIND.ENDING, where NAME is that of the source without folder and ending. */
static ms_status add_default(ms_outputs *outputs, const char *source, const char *behind, const ms_format *format,
                             ms_error *err)
{
    const char *slash = strrchr(source, '/'), *base = slash ? slash + 1 : source, *dot = strrchr(base, '.');
    const int length = dot && dot > base ? (int)(dot - base) : (int)strlen(base);
    const char *folder = outputs->folder ? outputs->folder : "";
    const size_t room = strlen(folder) + strlen(base) + strlen(behind) + strlen(format->ending) + 3;
    char *path = malloc(room);
    if (!path) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the names of the outputs");
    }
    snprintf(path, room, "%s%s%.*s%s.%s", folder, folder[0] ? "/" : "", length, base, behind, format->ending);
    outputs->file[outputs->n_files++] = (ms_output_file){path, path, format};
    return MS_OK;
}

/* Is this one of the files by default names? */
static int is_default(const ms_outputs *outputs, const ms_format *format, ms_need need)
{
    for (size_t f = 0; f < outputs->n_formats; f++) {
        if (outputs->format[f] == format) {
            return 1;
        }
    }
    return outputs->n_formats == 0 && format->need <= (outputs->folder ? need : MS_NEED_SPHERES);
}

static void free_files(ms_outputs *outputs)
{
    for (size_t f = 0; f < outputs->n_files; f++) {
        free(outputs->file[f].owned);
    }
    outputs->n_files = 0;
}

ms_status ms_outputs_resolve(ms_outputs *outputs, const char *source, const char *behind, ms_need need, int defaults,
                             ms_error *err)
{
    ms_status status = MS_OK;
    free_files(outputs);
    if (outputs->folder && (outputs->folder[0] == '\0' || outputs->n_formats)) {
        return ms_fail(err, MS_ERR_ARG, "--all-formats takes the name of a folder, and no --format beside it");
    }
    if (outputs->n_formats > 1 && outputs->n_asked) {
        return ms_fail(err, MS_ERR_ARG, "with --output, --format can be given once");
    }
    for (size_t o = 0; o < outputs->n_asked && status == MS_OK; o++) {
        status = add_asked(outputs, outputs->asked[o], need, err);
    }
    if (status != MS_OK || (outputs->n_asked && !outputs->folder)) {
        return status;
    }
    if (!defaults && !outputs->folder && outputs->n_formats == 0) {
        return ms_fail(err, MS_ERR_ARG, "takes -o FILE, --format F or --all-formats DIR");
    }
    for (const ms_format *f = ms_formats; f->name && status == MS_OK; f++) {
        if (is_default(outputs, f, need)) {
            status = check_need(f, need, err);
            status = status == MS_OK ? add_default(outputs, source, behind, f, err) : status;
        }
    }
    return status;
}

int ms_outputs_to_stdout(const ms_outputs *outputs)
{
    int found = 0;
    for (size_t f = 0; f < outputs->n_files; f++) {
        found += strcmp(outputs->file[f].path, "-") == 0;
    }
    return found;
}

/* Are both the same file? */
static int same_file(const char *a, const char *b)
{
    struct stat first, second;
    return stat(a, &first) == 0 && stat(b, &second) == 0 && first.st_dev == second.st_dev &&
           first.st_ino == second.st_ino;
}

/* A device or a pipe is not tried, since that would be noticed at its other end. */
ms_status ms_outputs_try_file(const char *source, const char *path, ms_error *err)
{
    ms_output output;
    struct stat info;
    if (strcmp(path, "-") == 0 || (stat(path, &info) == 0 && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode))) {
        return MS_OK;
    }
    if (same_file(source, path)) {
        return ms_fail(err, MS_ERR_ARG, "%s is the input itself; it is not overwritten", path);
    }
    ms_status status = ms_output_open(&output, path, err);
    if (status == MS_OK) {
        ms_output_close(&output, MS_ERR_IO, NULL); /* removes it */
    }
    return status;
}

ms_status ms_outputs_make_folder(const char *path, ms_error *err)
{
    struct stat info;
    return mkdir(path, 0777) == 0 || (stat(path, &info) == 0 && S_ISDIR(info.st_mode))
               ? MS_OK
               : ms_fail(err, MS_ERR_IO, "%s: this folder cannot be made; does the one above it exist?", path);
}

ms_status ms_outputs_try(const ms_outputs *outputs, const char *source, ms_error *err)
{
    ms_status status = outputs->folder ? ms_outputs_make_folder(outputs->folder, err) : MS_OK;
    for (size_t f = 0; f < outputs->n_files && status == MS_OK; f++) {
        if (!ms_write_format_is_folder(outputs->file[f].format)) {
            status = ms_outputs_try_file(source, outputs->file[f].path, err);
        }
    }
    return status;
}

/* Of all formats, those that cannot hold this clump are passed over. */
static int pass_over(const ms_outputs *outputs, const ms_output_file *file, const ms_content *content)
{
    ms_error why;
    const int passed = outputs->folder && file->owned && ms_write_check(content, file->format, &why) != MS_OK;
    if (passed) {
        fprintf(stderr, "%s is not written: %s\n", file->path, why.text);
    }
    return passed;
}

static ms_status write_file(const ms_output_file *file, const ms_content *content, FILE *words, ms_error *err)
{
    char remark[MS_WRITE_REMARK];
    ms_status status = ms_write_clump(content, file->path, file->format, err);
    if (strcmp(file->path, "-") != 0 && status == MS_OK) {
        fprintf(words, "wrote %s\n", file->path);
    }
    if (status == MS_OK) {
        status = ms_write_remark(remark, content, file->format, err);
    }
    if (status == MS_OK && remark[0]) {
        fprintf(stderr, "%s: %s\n", file->path, remark);
    }
    return status;
}

ms_status ms_outputs_write(const ms_outputs *outputs, const ms_content *content, FILE *words, ms_error *err)
{
    ms_status first = MS_OK;
    for (size_t f = 0; f < outputs->n_files; f++) {
        ms_error cause;
        if (pass_over(outputs, &outputs->file[f], content)) {
            continue;
        }
        ms_status status = write_file(&outputs->file[f], content, words, &cause);
        if (status != MS_OK && first == MS_OK) {
            first = ms_fail(err, status, "%s", cause.text);
        } else if (status != MS_OK) {
            fprintf(stderr, "%s\n", cause.text);
        }
    }
    return first;
}

void ms_outputs_free(ms_outputs *outputs)
{
    free_files(outputs);
    memset(outputs, 0, sizeof *outputs);
}
