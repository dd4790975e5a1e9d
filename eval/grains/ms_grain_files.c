#include "ms_grain_files.h"

#include <stdio.h>
#include <string.h>

#include "cli/ms_files.h"
#include "ms_grain_assembly.h"

/* The page and what it is held against. */
typedef struct page_files {
    ms_files *files;
    const char *page;
} page_files;

static const char *find_base(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/* A file of another name is another file, and there may be a million clumps. */
static ms_status add_namesake(void *context, const char *path, int is_frame, ms_error *err)
{
    const page_files *p = context;
    return strcmp(find_base(path), find_base(p->page)) == 0
               ? ms_files_add(p->files, path, is_frame ? MS_FILE_FRAME : MS_FILE_LATER, err)
               : MS_OK;
}

/* The tables of all parts, which may have one folder, and that of a run in one. */
static ms_status add_tables(page_files *p, const ms_grains *g, ms_error *err)
{
    char path[4096];
    ms_grains one = *g;
    ms_status status = MS_OK;
    for (one.part = 1; one.part <= g->parts && g->parts > 1 && status == MS_OK; one.part++) {
        ms_grains_table(path, sizeof path, &one);
        status = add_namesake(p, path, 0, err);
    }
    one.part = one.parts = 1;
    ms_grains_table(path, sizeof path, &one);
    return status == MS_OK ? add_namesake(p, path, 0, err) : status;
}

/* The clumps of all parts. */
static ms_status add_clumps(page_files *p, const ms_grains *g, ms_error *err)
{
    char path[4096];
    ms_status status = MS_OK;
    for (size_t k = 0; k < g->list->count && status == MS_OK; k++) {
        const ms_grain_row row = {.number = k + 1, .grain = &g->list->grain[k]};
        ms_grain_row_path(path, sizeof path, g->folder, &row);
        const size_t length = strlen(path);
        for (size_t f = 0; f < g->n_formats && status == MS_OK; f++) {
            snprintf(path + length, sizeof path - length, ".%s", g->format[f]->ending);
            status = ms_write_list(path, g->format[f], add_namesake, p, err);
        }
    }
    return status;
}

/* The page, which may stand in the folder of the run. */
static ms_status add_page(ms_files *files, const ms_grains *g, const char *page, ms_error *err)
{
    page_files p = {files, page};
    ms_status status = ms_files_add_folder(files, g->folder, err);
    if (status == MS_OK) {
        status = ms_files_add(files, page, MS_FILE_WRITTEN, err);
    }
    if (status == MS_OK) {
        status = add_tables(&p, g, err);
    }
    return status == MS_OK ? add_clumps(&p, g, err) : status;
}

/* The sources, and the words that name them. */
static ms_status add_sources(ms_files *files, const ms_grain_list *list, char *const *words, size_t count,
                             ms_error *err)
{
    ms_status status = MS_OK;
    for (size_t w = 0; w < count && status == MS_OK; w++) {
        status = ms_files_add(files, words[w], MS_FILE_READ, err);
    }
    for (size_t s = 0; s < list->n_sources && status == MS_OK; s++) {
        status = ms_files_add_shape(files, list->source[s]->path, err);
    }
    return status;
}

ms_status ms_grain_files_check(const ms_grains *g, char *const *words, size_t count, int has_assembly, const char *page,
                               ms_error *err)
{
    ms_files files = {0};
    ms_status status = page ? add_page(&files, g, page, err) : MS_OK;
    if (status == MS_OK && has_assembly) {
        status = ms_grain_assembly_list(&files, g, err);
    }
    if (status == MS_OK) {
        status = add_sources(&files, g->list, words, count, err);
    }
    if (status == MS_OK) {
        status = ms_files_check(&files, err);
    }
    ms_files_free(&files);
    return status;
}
