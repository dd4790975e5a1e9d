#include "ms_outputs.h"

#include <stdlib.h>
#include <string.h>

#include "base/ms_file.h"
#include "view/ms_view_formats.h"

static ms_status take_format(ms_outputs *outputs, const char *name, ms_error *err)
{
    const ms_format *format = ms_view_format_find(name, err);
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
    const ms_format *format = outputs->n_formats ? outputs->format[0] : ms_view_format_of_path(path, &cause);
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
    char *path = ms_write_path(outputs->folder ? outputs->folder : "", source, behind, format);
    if (!path) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the names of the outputs");
    }
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

static ms_status add_checked(ms_outputs *outputs, const char *source, const char *behind, const ms_format *format,
                             ms_need need, ms_error *err)
{
    const ms_status status = check_need(format, need, err);
    return status == MS_OK ? add_default(outputs, source, behind, format, err) : status;
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
        status = is_default(outputs, f, need) ? add_checked(outputs, source, behind, f, need, err) : MS_OK;
    }
    for (const ms_format *f = ms_view_formats; f->name && outputs->n_formats && status == MS_OK; f++) {
        status = is_default(outputs, f, need) ? add_checked(outputs, source, behind, f, need, err) : MS_OK;
    }
    return status;
}

int ms_outputs_shown(const ms_outputs *outputs)
{
    int found = 0;
    for (size_t f = 0; f < outputs->n_files; f++) {
        found += ms_view_format_is(outputs->file[f].format);
    }
    return found;
}

int ms_outputs_to_stdout(const ms_outputs *outputs)
{
    int found = 0;
    for (size_t f = 0; f < outputs->n_files; f++) {
        found += strcmp(outputs->file[f].path, "-") == 0;
    }
    return found;
}

/* Where the parts of a format go; its folders are made later. */
typedef struct part_list {
    ms_files *files;
    int in_folder;
} part_list;

static ms_status add_part(void *context, const char *path, int is_frame, ms_error *err)
{
    const part_list *list = context;
    return ms_files_add(list->files, path,
                        is_frame          ? MS_FILE_FRAME
                        : list->in_folder ? MS_FILE_LATER
                                          : MS_FILE_WRITTEN,
                        err);
}

ms_status ms_outputs_list(ms_files *files, const ms_outputs *outputs, ms_error *err)
{
    ms_status status = outputs->folder ? ms_files_add_folder(files, outputs->folder, err) : MS_OK;
    for (size_t f = 0; f < outputs->n_files && status == MS_OK; f++) {
        const ms_output_file *file = &outputs->file[f];
        part_list list = {files, ms_write_format_is_folder(file->format)};
        status = ms_write_check_path(file->path, file->format, err);
        if (status == MS_OK) {
            status = ms_write_list(file->path, file->format, add_part, &list, err);
        }
    }
    return status;
}

ms_status ms_outputs_check(const ms_outputs *outputs, const char *clump, const char *frame, const char *target,
                           ms_error *err)
{
    ms_files files = {0};
    ms_status status = ms_files_add(&files, clump, MS_FILE_READ, err);
    if (status == MS_OK && frame) {
        status = ms_files_add(&files, frame, MS_FILE_READ, err);
    }
    if (status == MS_OK && target) {
        status = ms_files_add_shape(&files, target, err);
    }
    if (status == MS_OK) {
        status = ms_outputs_list(&files, outputs, err);
    }
    if (status == MS_OK) {
        status = ms_files_check(&files, err);
    }
    ms_files_free(&files);
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

static ms_status write_file(const ms_content *content, const char *path, const ms_format *format, FILE *words,
                            ms_error *err)
{
    char remark[MS_WRITE_REMARK] = "";
    ms_view_about about = content->more ? *(const ms_view_about *)content->more : (ms_view_about){0};
    ms_content with_remark = *content;
    about.remark = remark;
    with_remark.more = &about;
    ms_status status = ms_write_clump(&with_remark, path, format, err);
    if (status == MS_OK && strcmp(path, "-") != 0) {
        fprintf(words, "wrote %s\n", path);
    }
    if (status == MS_OK && !ms_view_format_is(format)) {
        status = ms_write_remark(remark, content, format, err);
    }
    if (status == MS_OK && remark[0]) {
        fprintf(stderr, "%s: %s\n", path, remark);
    }
    return status;
}

static ms_need known_of(const ms_content *content)
{
    const ms_particle *p = content->particle;
    const int known = p && p->mass > 0 && p->density > 0;
    return !known ? MS_NEED_SPHERES : content->clump->mass ? MS_NEED_MASSES : MS_NEED_PARTICLE;
}

char *ms_outputs_spare(const ms_outputs *outputs, ms_error *err)
{
    const char *path = outputs->file[0].path;
    char *spare = malloc(strlen(path) + 5);
    if (spare) {
        sprintf(spare, "%s%s", path, strcmp(path, "-") == 0 ? "" : ".csv");
    } else {
        ms_fail(err, MS_ERR_NOMEM, "%s: no memory to write it", path);
    }
    return spare;
}

static ms_status write_spare(const ms_outputs *outputs, const ms_content *content, FILE *words, ms_error *err)
{
    char *spare = ms_outputs_spare(outputs, err);
    const ms_status status =
        spare ? write_file(content, spare, ms_write_format_find("csv", err), words, err) : MS_ERR_NOMEM;
    free(spare);
    return status;
}

ms_status ms_outputs_write(const ms_outputs *outputs, const ms_content *content, FILE *words, ms_error *err)
{
    ms_status first = outputs->folder ? ms_files_make_folder(outputs->folder, err) : MS_OK;
    size_t tried = 0;
    if (first != MS_OK) {
        return first;
    }
    for (size_t f = 0; f < outputs->n_files; f++) {
        const ms_output_file *file = &outputs->file[f];
        ms_error cause;
        if (pass_over(outputs, file, content)) {
            continue;
        }
        if (file->format->need > known_of(content)) {
            fprintf(stderr, "%s is not written: a %s template takes masses\n", file->path, file->format->name);
            continue;
        }
        const ms_status status = write_file(content, file->path, file->format, words, &cause);
        tried++;
        if (status != MS_OK && first == MS_OK) {
            first = ms_fail(err, status, "%s", cause.text);
        } else if (status != MS_OK) {
            fprintf(stderr, "%s\n", cause.text);
        }
    }
    return outputs->n_files > 0 && tried == 0 ? write_spare(outputs, content, words, err) : first;
}

void ms_outputs_free(ms_outputs *outputs)
{
    free_files(outputs);
    memset(outputs, 0, sizeof *outputs);
}
