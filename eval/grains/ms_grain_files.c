#include "ms_grain_files.h"

#include "cli/ms_files.h"
#include "ms_grain_assembly.h"

/* The page, which may stand in the folder of the run. No table and no clump ends as it does. */
static ms_status add_page(ms_files *files, const ms_grains *g, const char *page, ms_error *err)
{
    const ms_status status = ms_files_add_folder(files, g->folder, err);
    return status == MS_OK ? ms_files_add(files, page, MS_FILE_WRITTEN, err) : status;
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
