#include "ms_scene_files.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ms_scene_charts.h"
#include "ms_scene_engines.h"

/* The caller frees it; NULL without memory. */
static char *template_path(const char *folder, const ms_manifest_row *row, const ms_format *format)
{
    char size[32] = "";
    if (!isnan(row->size)) {
        snprintf(size, sizeof size, "-%.6g", row->size);
    }
    return ms_write_path(folder, row->path, size, format);
}

/* The shape before, if there is one, whose template would be the same file. */
static ms_status check_template(const ms_outputs *outputs, const ms_manifest *manifest, size_t r, size_t f,
                                ms_error *err)
{
    const char *path = outputs[r].file[f].path;
    for (size_t before = 0; before < r; before++) {
        if (strcmp(outputs[before].file[f].path, path) == 0) {
            return ms_fail(err, MS_ERR_ARG, "the templates of %s and %s would both be %s; rename one of the shapes",
                           manifest->row[before].path, manifest->row[r].path, path);
        }
    }
    return MS_OK;
}

ms_status ms_scene_files_plan(ms_outputs *outputs, const ms_scene_files *asked, const ms_manifest *manifest,
                              ms_error *err)
{
    ms_status status = MS_OK;
    for (size_t r = 0; asked->folder && r < manifest->count && status == MS_OK; r++) {
        outputs[r].folder = asked->folder;
        for (size_t f = 0; f < asked->n_formats && status == MS_OK; f++) {
            char *path = template_path(asked->folder, &manifest->row[r], asked->format[f]);
            if (!path) {
                return ms_fail(err, MS_ERR_NOMEM, "no memory for the names of %zu templates", manifest->count);
            }
            outputs[r].file[outputs[r].n_files++] = (ms_output_file){path, path, asked->format[f]};
            status = check_template(outputs, manifest, r, f, err);
        }
    }
    return status;
}

/* The scripts of the engines. */
static ms_status list_scripts(ms_files *files, const ms_scene_files *asked, ms_error *err)
{
    ms_status status = MS_OK;
    for (size_t f = 0; asked->folder && f < asked->n_formats && status == MS_OK; f++) {
        if (asked->format[f]->scene.suffix) {
            char *path = ms_scene_script_path(asked->folder, asked->format[f]);
            status = path ? ms_files_add(files, path, MS_FILE_WRITTEN, err)
                          : ms_fail(err, MS_ERR_NOMEM, "no memory for the names of the scripts");
            free(path);
        }
    }
    return status;
}

ms_status ms_scene_files_check(const ms_outputs *outputs, const ms_scene_files *asked, const ms_manifest *manifest,
                               ms_error *err)
{
    ms_files files = {0};
    ms_status status = MS_OK;
    for (int f = 0; f < MS_SCENE_FILES_READ && status == MS_OK; f++) {
        status = asked->read[f] ? ms_files_add(&files, asked->read[f], MS_FILE_READ, err) : MS_OK;
    }
    if (status == MS_OK && asked->charts) {
        status = ms_files_add_folder(&files, asked->charts, err);
    }
    for (size_t r = 0; r < manifest->count && status == MS_OK; r++) {
        status = ms_files_add_shape(&files, manifest->row[r].path, err);
        if (status == MS_OK) {
            status = ms_outputs_list(&files, &outputs[r], err);
        }
        if (status == MS_OK && asked->charts) {
            status = ms_scene_charts_list(&files, asked->charts, &manifest->row[r], r + 1, asked->goal, err);
        }
    }
    if (status == MS_OK) {
        status = list_scripts(&files, asked, err);
    }
    if (status == MS_OK && asked->report) {
        status = ms_files_add(&files, asked->report, MS_FILE_WRITTEN, err);
    }
    if (status == MS_OK) {
        status = ms_files_check(&files, err);
    }
    ms_files_free(&files);
    return status;
}
