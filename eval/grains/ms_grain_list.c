#include "ms_grain_list.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/ms_escape.h"
#include "base/ms_file.h"
#include "cli/ms_files.h"
#include "cli/ms_paths.h"
#include "ms_grain_manifest.h"

/* A part of the memory allowed that volumes may keep from the listing on. */
static const double KEPT_PART = 0.25;

enum { LONGEST_NAME = 200 };

/* The name of a grain's files: that of its source without folder and ending, and the label. */
static char *make_name(const char *path, uint32_t label)
{
    size_t length;
    const char *stem = ms_file_stem(&length, path);
    char *name = malloc(LONGEST_NAME + 16);
    if (name) {
        length = length < LONGEST_NAME ? length : LONGEST_NAME;
        memcpy(name, stem, length);
        name[length] = '\0';
        if (label) {
            snprintf(name + length, 16, "-%lu", (unsigned long)label);
        }
        ms_escape_script_name(name);
    }
    char *fit = name ? realloc(name, strlen(name) + 1) : NULL; /* there may be a million */
    return fit ? fit : name;
}

static ms_status add_grain(ms_grain_list *list, ms_grain_source *source, uint32_t label, const ms_grain_how *how,
                           ms_error *err)
{
    if (list->count == list->capacity) {
        const size_t capacity = list->capacity ? 2 * list->capacity : 64;
        ms_grain *grown = realloc(list->grain, capacity * sizeof *grown);
        if (!grown) {
            return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu grains", capacity);
        }
        list->grain = grown;
        list->capacity = capacity;
    }
    const ms_label_entry *entry = ms_labels_entry(&source->labels, label);
    ms_grain *grain = &list->grain[list->count];
    *grain = (ms_grain){.source = source, .label = label, .name = make_name(source->path, label), .how = how};
    grain->size = entry ? (double)entry->voxels : source->bytes;
    if (!grain->name) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the name of a grain");
    }
    source->users++;
    list->count++;
    return MS_OK;
}

static double kept_bytes(const ms_grain_list *list)
{
    double bytes = 0;
    for (size_t s = 0; s < list->n_sources; s++) {
        bytes += (double)list->source[s]->scan.held;
    }
    return bytes;
}

/* The source of that path: rows of a manifest may name one volume several times, each time below the other. */
static ms_status need_source(ms_grain_source **source, ms_grain_list *list, const char *path, const ms_grain_how *how,
                             ms_error *err)
{
    if (list->n_sources && strcmp(list->source[list->n_sources - 1]->path, path) == 0) {
        *source = list->source[list->n_sources - 1];
        return MS_OK;
    }
    if (access(path, R_OK) != 0) {
        return ms_file_fail_open(err, path, errno);
    }
    ms_grain_source **grown = realloc(list->source, (list->n_sources + 1) * sizeof(ms_grain_source *));
    list->source = grown ? grown : list->source;
    *source = malloc(sizeof **source);
    if (!grown || !*source) {
        free(*source);
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu sources of grains", list->n_sources + 1);
    }
    const ms_status status = ms_grain_source_begin(*source, path, err);
    if (status != MS_OK) {
        free(*source);
        return status;
    }
    list->source[list->n_sources++] = *source;
    if ((*source)->is_volume) {
        ms_grain_source_list(*source, &how->input, KEPT_PART * how->input.max_memory - kept_bytes(list));
    }
    return MS_OK;
}

/* All grains of a file, or the one of that label. */
static ms_status add_file(ms_grain_list *list, const char *path, uint32_t row_label, const ms_grain_how *how,
                          ms_error *err)
{
    const uint32_t label = row_label ? row_label : how->input.label;
    ms_grain_source *source = NULL;
    ms_status status = need_source(&source, list, path, how, err);
    if (status != MS_OK || label || !source->is_volume || source->status != MS_OK) {
        return status == MS_OK ? add_grain(list, source, label, how, err) : status;
    }
    for (size_t l = 0; l < source->labels.count && status == MS_OK; l++) {
        status = add_grain(list, source, source->labels.entry[l].label, how, err);
    }
    return status;
}

/* A file, or those of a folder or a pattern. */
static ms_status add_files(ms_grain_list *list, const char *word, const ms_grain_how *how, ms_error *err)
{
    ms_paths paths = {0};
    ms_status status = ms_paths_add(&paths, word, ms_paths_is_shape, "mesh and no volume", err);
    for (size_t p = 0; p < paths.count && status == MS_OK; p++) {
        status = add_file(list, paths.path[p], 0, how, err);
    }
    ms_paths_free(&paths);
    return status;
}

/* Where a row of a manifest goes. */
typedef struct manifest_context {
    ms_grain_list *list;
    const ms_grain_how *how;
} manifest_context;

/* The row's own way, which is that of all and what the row says. */
static ms_status need_own(const ms_grain_how **how, const manifest_context *c, const ms_grain_manifest_row *row,
                          ms_error *err)
{
    ms_grain_list *list = c->list;
    *how = c->how;
    if (row->n_flags == 0) {
        return MS_OK;
    }
    ms_grain_how **grown = realloc(list->own, (list->n_own + 1) * sizeof(ms_grain_how *));
    list->own = grown ? grown : list->own;
    ms_grain_how *own = malloc(sizeof *own);
    if (!grown || !own) {
        free(own);
        return ms_fail(err, MS_ERR_NOMEM, "no memory for what rows of a manifest say");
    }
    list->own[list->n_own++] = own;
    *how = own;
    return ms_grain_manifest_apply(own, c->how, row, err);
}

static ms_status take_row(void *context, const ms_grain_manifest_row *row, ms_error *err)
{
    const manifest_context *c = context;
    const ms_grain_how *how;
    const ms_status status = need_own(&how, c, row, err);
    return status == MS_OK ? add_file(c->list, row->path, row->label, how, err) : status;
}

static ms_status add_manifest(ms_grain_list *list, const char *path, const ms_grain_how *how, ms_error *err)
{
    manifest_context context = {list, how};
    char **grown = realloc(list->text, (list->n_texts + 1) * sizeof *grown);
    if (!grown) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the manifest %s", path);
    }
    list->text = grown;
    return ms_grain_manifest_read(&list->text[list->n_texts++], path, take_row, &context, err);
}

static ms_status add_word(ms_grain_list *list, const char *word, const ms_grain_how *how, ms_error *err)
{
    struct stat info;
    char ending[16];
    ms_file_ending(ending, word);
    const int is_manifest = strcmp(ending, "csv") == 0 && stat(word, &info) == 0 && !S_ISDIR(info.st_mode);
    return is_manifest ? add_manifest(list, word, how, err) : add_files(list, word, how, err);
}

static int compare_grains(const void *a, const void *b)
{
    return strcmp((*(const ms_grain *const *)a)->name, (*(const ms_grain *const *)b)->name);
}

/* Two of one name would write the same files. */
static ms_status check_names(const ms_grain_list *list, ms_error *err)
{
    const ms_grain **sorted = malloc((list->count + 1) * sizeof(const ms_grain *));
    ms_status status = sorted ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for the names of the grains");
    for (size_t g = 0; g < list->count && sorted; g++) {
        sorted[g] = &list->grain[g];
    }
    if (sorted) {
        qsort(sorted, list->count, sizeof(const ms_grain *), compare_grains);
    }
    for (size_t g = 1; g < list->count && status == MS_OK; g++) {
        if (strcmp(sorted[g - 1]->name, sorted[g]->name) == 0) {
            status = ms_fail(err, MS_ERR_ARG,
                             "the files of two grains would be called %s, of %.300s and of %.300s; rename one, or run "
                             "them into folders of their own",
                             sorted[g]->name, sorted[g - 1]->source->path, sorted[g]->source->path);
        }
    }
    free(sorted);
    return status;
}

ms_status ms_grain_list_make(ms_grain_list *list, char *const *words, size_t count, const ms_grain_how *how,
                             ms_error *err)
{
    ms_status status = MS_OK;
    *list = (ms_grain_list){0};
    for (size_t w = 0; w < count && status == MS_OK; w++) {
        status = add_word(list, words[w], how, err);
    }
    if (status == MS_OK) {
        status = list->count ? check_names(list, err) : ms_fail(err, MS_ERR_IO, "no mesh and no volume was found");
    }
    if (status != MS_OK) {
        ms_grain_list_free(list);
    }
    return status;
}

uint64_t ms_grain_list_checksum(const ms_grain_list *list)
{
    char text[80];
    uint64_t sum = 0;
    for (size_t g = 0; g < list->count; g++) {
        const ms_grain *grain = &list->grain[g];
        snprintf(text, sizeof text, "%" PRIu32 " %.17g %" PRIx64, grain->label, grain->size, grain->how->given);
        sum = ms_grain_how_add_text(ms_grain_how_add_text(sum, grain->source->path), text);
    }
    return sum;
}

void ms_grain_list_free(ms_grain_list *list)
{
    for (size_t g = 0; g < list->count; g++) {
        free(list->grain[g].name);
    }
    for (size_t s = 0; s < list->n_sources; s++) {
        ms_grain_source_end(list->source[s]);
        free(list->source[s]);
    }
    for (size_t o = 0; o < list->n_own; o++) {
        ms_grain_how_free(list->own[o]);
        free(list->own[o]);
    }
    for (size_t t = 0; t < list->n_texts; t++) {
        free(list->text[t]);
    }
    free(list->text);
    free(list->grain);
    free(list->source);
    free(list->own);
    *list = (ms_grain_list){0};
}
