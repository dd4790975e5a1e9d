#include "ms_grains.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_file.h"
#include "base/ms_quaternion.h"
#include "cli/ms_files.h"
#include "cli/ms_mass.h"
#include "clump/ms_template.h"
#include "measure/ms_metrics.h"
#include "volume/ms_components.h"

/* The work of a part. */
typedef struct grains_work {
    const ms_grains *g;
    size_t *index; /* of the grains of this part, ascending */
    size_t count, there;
    char **line; /* of grains that are done and whose rows are not taken */
    ms_grain_status *status;
    char *remarked; /* nonzero: the method has a remark on its clump */
    double *spheres;
    int write; /* zero: only tried */
    double *seconds;
    ms_csv *csv;
    ms_grains_sum *sum;
} grains_work;

void ms_grains_table(char *out, size_t size, const ms_grains *g)
{
    if (g->parts > 1) {
        snprintf(out, size, "%s/grains-%zu-of-%zu.csv", g->folder, g->part, g->parts);
    } else {
        snprintf(out, size, "%s/grains.csv", g->folder);
    }
}

static int compare_numbers(const void *a, const void *b)
{
    const size_t x = *(const size_t *)a, y = *(const size_t *)b;
    return (x > y) - (x < y);
}

/* Where the sort finds its grains. */
typedef struct sized_grain {
    double size;
    size_t index;
} sized_grain;

/* Largest first; of one size the first of the list. */
static int compare_sizes(const void *a, const void *b)
{
    const sized_grain *x = a, *y = b;
    return x->size != y->size ? (x->size < y->size) - (x->size > y->size)
                              : (x->index > y->index) - (x->index < y->index);
}

/* Deals the grains out by size, to and fro. */
static ms_status deal(grains_work *w, ms_error *err)
{
    const ms_grains *g = w->g;
    const size_t count = g->list->count;
    sized_grain *sorted = malloc(count * sizeof *sorted);
    w->index = malloc(count * sizeof *w->index);
    if (!sorted || !w->index) {
        free(sorted);
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu grains", count);
    }
    for (size_t k = 0; k < count; k++) {
        sorted[k] = (sized_grain){g->list->grain[k].size, k};
    }
    qsort(sorted, count, sizeof *sorted, compare_sizes);
    for (size_t k = 0; k < count; k++) {
        const size_t round = k / g->parts, at = k % g->parts;
        if ((round % 2 ? g->parts - 1 - at : at) == g->part - 1) {
            w->index[w->count++] = sorted[k].index;
        }
    }
    free(sorted);
    qsort(w->index, w->count, sizeof *w->index, compare_numbers);
    return MS_OK;
}

static void free_work(grains_work *w)
{
    for (size_t k = 0; w->line && k < w->count; k++) {
        free(w->line[k]);
    }
    free(w->line);
    free(w->index);
    free(w->status);
    free(w->remarked);
    free(w->spheres);
    free(w->seconds);
}

/* Room for what the grains give. */
static ms_status make_room(grains_work *w, ms_error *err)
{
    w->line = calloc(w->count + 1, sizeof *w->line);
    w->status = calloc(w->count + 1, sizeof *w->status);
    w->remarked = calloc(w->count + 1, 1);
    w->spheres = calloc(w->count + 1, sizeof *w->spheres);
    w->seconds = calloc(w->count + 1, sizeof *w->seconds);
    return w->line && w->status && w->remarked && w->spheres && w->seconds
               ? MS_OK
               : ms_fail(err, MS_ERR_NOMEM, "no memory for the rows of %zu grains", w->count);
}

static ms_grain_row begin_row(const grains_work *w, size_t at)
{
    const ms_grain *grain = &w->g->list->grain[w->index[at]];
    const double nan = (double)NAN;
    return (ms_grain_row){.number = w->index[at] + 1,
                          .count = w->g->list->count,
                          .run = w->g->run,
                          .grain = grain,
                          .checksum = grain->source->checksum,
                          .ending = w->g->format[0]->ending,
                          .pieces = nan,
                          .voxel_size = nan,
                          .volume = nan,
                          .place = {nan, {nan, nan, nan}, {nan, nan, nan}, {nan, nan, nan, nan}}};
}

/* Where it is: the template's frame is that of any density. */
static ms_status find_place(ms_grain_place *place, const ms_mass *mass, const ms_body *body, ms_error *err)
{
    const ms_clump none = {0};
    const int has_mass = mass->particle.mass > 0;
    ms_particle particle = mass->particle;
    ms_template frame;
    ms_status status = has_mass ? MS_OK : ms_particle_from_body(&particle, body, 1, 1, err);
    if (status == MS_OK) {
        status = ms_template_make(&frame, &none, &particle, err);
    }
    if (status == MS_OK) {
        memcpy(place->centre, frame.centre, sizeof place->centre);
        ms_quaternion_from_axes(place->turn, frame.axis);
        place->mass = has_mass ? particle.mass : (double)NAN;
        for (int m = 0; m < 3; m++) {
            place->moment[m] = has_mass ? frame.particle.inertia[m][m] : (double)NAN;
        }
        ms_template_free(&frame);
    }
    return status;
}

/* Nonzero if a filter leaves the grain out; the row says which. */
static int leave_out(ms_grain_row *row, const ms_grains *g)
{
    const ms_label_entry *entry = ms_labels_entry(&row->grain->source->labels, row->grain->label);
    if (entry && g->skip_border && entry->cut) {
        snprintf(row->cause.text, sizeof row->cause.text, "the border of the volume cuts it (--skip-border)");
    } else if (entry && (double)entry->voxels < g->least_voxels) {
        snprintf(row->cause.text, sizeof row->cause.text, "%zu voxels are fewer than %.0f (--least-voxels)",
                 entry->voxels, g->least_voxels);
    } else {
        return 0;
    }
    row->status = MS_GRAIN_LEFT_OUT;
    return 1;
}

static ms_status write_format(const ms_grain_row *row, const ms_content *content, const ms_grains *g,
                              const ms_format *format, ms_error *err)
{
    char path[4096];
    ms_grain_row_path(path, sizeof path, g->folder, row);
    char *slash = strrchr(path, '/');
    *slash = '\0';
    ms_status status = ms_files_make_folder(path, err);
    *slash = '/';
    snprintf(path + strlen(path), sizeof path - strlen(path), ".%s", format->ending);
    if (status == MS_OK) {
        status = ms_write_check_path(path, format, err);
    }
    return status == MS_OK ? ms_write_clump(content, path, format, err) : status;
}

static ms_status write_grain(const ms_grain_row *row, const ms_input *input, const ms_grains *g, ms_error *err)
{
    const ms_grain_how *how = row->grain->how;
    const ms_result *r = row->result;
    json_t *json =
        ms_record_json(how->recipe.generator, &how->recipe.settings, &how->stop, (uint64_t)how->recipe.seed, input, r);
    char *record = json ? json_dumps(json, JSON_COMPACT) : NULL;
    const ms_content content = {
        .clump = &r->clump, .particle = r->mass.particle.mass > 0 ? &r->mass.particle : NULL, .record = record};
    ms_status status = record ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for the record of a grain");
    json_decref(json);
    for (size_t f = 0; f < g->n_formats && status == MS_OK; f++) {
        status = write_format(row, &content, g, g->format[f], err);
    }
    free(record);
    return status;
}

static ms_status make_clump(ms_result *r, const ms_input *input, const ms_grain_how *how, const ms_grains *g,
                            ms_error *err)
{
    ms_run run = {.target = &input->target, .stop = how->stop, .settings = &how->recipe.settings};
    run.seed = (uint64_t)how->recipe.seed;
    ms_generator_keep_remarks(&run, &r->remarks);
    const double start = omp_get_wtime();
    ms_status status = ms_generator_run(&r->clump, &r->reason, how->recipe.generator, &run, err);
    const double generated = omp_get_wtime();
    const size_t max_voxels = ms_input_max_voxels(&how->input);
    if (status == MS_OK && how->recipe.equal_volume) {
        status = ms_equal_volume_scale(&r->clump, &r->volume, &input->target.body, err);
        ms_equal_volume_remark(&r->remarks, &r->volume);
    }
    if (status == MS_OK) {
        status = ms_metrics_compute(&r->metrics, NULL, &input->target, &r->clump, max_voxels, err);
    }
    r->generate_seconds = generated - start;
    r->score_seconds = omp_get_wtime() - generated;
    return status == MS_OK && g->mass
               ? ms_mass_correct(&r->mass, &r->clump, g->mass, &input->target.body, max_voxels, err)
               : status;
}

/* Leaves the largest piece of a label alone, if that is wanted. */
static ms_status drop_pieces(ms_grain_row *row, ms_input *input, const ms_grains *g, int connectivity)
{
    size_t pieces;
    if (!g->largest_piece || !input->is_volume) {
        return MS_OK;
    }
    const ms_status status = ms_components_keep_largest(&input->volume, &pieces, connectivity, &row->cause);
    input->origin.largest_piece = 1;
    input->origin.connectivity = connectivity;
    row->pieces = (double)pieces;
    return status;
}

/* The grain from its shape to its files. */
static ms_status make_grain(ms_grain_row *row, ms_result *r, const grains_work *w, ms_queue_place *place)
{
    const ms_grain *grain = row->grain;
    ms_input_flags flags = grain->how->input;
    ms_input input;
    flags.threads = 0; /* those of the queue */
    flags.cut |= grain->how->stop.coverage_cut > 0;
    flags.need = ms_generator_need(grain->how->recipe.generator, &grain->how->recipe.settings, flags.cut);
    flags.label = grain->label;
    if (grain->source->is_volume) { /* has voxels of its own */
        flags.cells = flags.deq = flags.voxel_size = 0;
    } else {
        flags.scan = ms_scan_defaults();
    }
    ms_status status = ms_grain_source_read(grain->source, &input, grain->label, &flags, place, &row->cause);
    row->checksum = input.checksum;
    if (status == MS_OK) {
        status = drop_pieces(row, &input, w->g, flags.scan.connectivity);
    }
    if (status != MS_OK) {
        ms_input_free(&input);
        return status;
    }
    ms_queue_need_memory(place, ms_input_bytes(&input, &flags), flags.max_memory);
    status = ms_input_target(&input, &flags, &row->cause);
    if (status == MS_OK) {
        row->pieces = input.origin.largest_piece ? row->pieces
                      : input.target.pieces      ? (double)input.target.pieces
                                                 : (double)NAN;
        row->voxel_size = input.target.grid.h;
        row->volume = input.target.body.volume;
        status = make_clump(r, &input, grain->how, w->g, &row->cause);
    }
    if (status == MS_OK) {
        status = find_place(&row->place, &r->mass, &input.target.body, &row->cause);
    }
    if (status == MS_OK) {
        row->result = r;
        status = w->write ? write_grain(row, &input, w->g, &row->cause) : MS_OK;
    }
    ms_input_free(&input);
    return status;
}

static void work_grain(void *context, size_t k, ms_queue_place *place)
{
    grains_work *w = context;
    const size_t at = w->there + k;
    ms_grain_row row = begin_row(w, at);
    ms_result result;
    memset(&result, 0, sizeof result);
    const double start = omp_get_wtime();
    if (!leave_out(&row, w->g)) {
        row.status = make_grain(&row, &result, w, place) == MS_OK ? MS_GRAIN_OK : MS_GRAIN_FAILED;
    }
    if (row.status == MS_GRAIN_OK) {
        row.cause = result.remarks;
    } else {
        row.result = NULL;
    }
    row.seconds = w->seconds[at] = omp_get_wtime() - start;
    row.beside = ms_queue_beside(place);
    w->status[at] = row.status;
    w->remarked[at] = row.status == MS_GRAIN_OK && result.remarks.text[0];
    w->spheres[at] = row.result ? (double)result.clump.n_spheres : 0;
    w->line[at] = ms_grain_row_line(&row);
    ms_clump_free(&result.clump);
    if (w->write) {
        ms_grain_source_release(row.grain->source);
    }
}

static void add_to_sum(grains_work *w, ms_grain_status status, int is_remarked, double spheres)
{
    w->sum->grains++;
    w->sum->remarked += (size_t)is_remarked;
    w->sum->ok += status == MS_GRAIN_OK;
    w->sum->left_out += status == MS_GRAIN_LEFT_OUT;
    w->sum->failed += status == MS_GRAIN_FAILED;
    w->sum->spheres += spheres;
}

static ms_status take_grain(void *context, size_t k, size_t *failed, ms_error *err)
{
    grains_work *w = context;
    const size_t at = w->there + k;
    ms_status status =
        w->line[at] ? ms_csv_add(w->csv, w->line[at], err) : ms_fail(err, MS_ERR_NOMEM, "no memory for a row");
    free(w->line[at]);
    w->line[at] = NULL;
    if (status == MS_OK) {
        *failed = w->status[at] == MS_GRAIN_FAILED;
        add_to_sum(w, w->status[at], w->remarked[at], w->spheres[at]);
    }
    return status;
}

/* The checksum of a mesh, which is read when its turn comes. */
static uint64_t sum_file(const ms_grain_source *source)
{
    ms_bytes bytes;
    ms_error ignored;
    uint64_t sum = 0;
    if (source->is_volume || ms_file_read(&bytes, source->path, &ignored) != MS_OK) {
        return source->checksum;
    }
    sum = ms_file_checksum(&bytes);
    ms_file_free(&bytes);
    return sum;
}

static ms_status check_row(grains_work *w, size_t at, ms_error *err)
{
    ms_grain_row row = begin_row(w, at);
    ms_error cause;
    double spheres;
    int is_remarked;
    row.checksum = sum_file(row.grain->source);
    char *key = ms_grain_row_key(&row);
    if (!key) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for a row");
    }
    ms_status status = ms_grain_row_read(&row.status, &is_remarked, &spheres, w->csv->row[at], &cause);
    if (strncmp(w->csv->row[at], key, strlen(key)) != 0) {
        status = ms_fail(err, MS_ERR_ARG,
                         "%s: line %zu is of another run; it should begin with '%.300s'; --resume takes grains and "
                         "flags as they were",
                         w->csv->path, at + 2, key);
    } else if (status != MS_OK) {
        status = ms_fail(err, status, "%s: line %zu %s", w->csv->path, at + 2, cause.text);
    } else {
        add_to_sum(w, row.status, is_remarked, spheres);
    }
    free(key);
    return status;
}

static ms_status check_rows(grains_work *w, ms_error *err)
{
    ms_status status = MS_OK;
    if (w->csv->n_rows > w->count) {
        return ms_fail(err, MS_ERR_ARG, "%s: holds %zu rows of %zu grains; name another folder", w->csv->path,
                       w->csv->n_rows, w->count);
    }
    for (; w->there < w->csv->n_rows && status == MS_OK; w->there++) {
        status = check_row(w, w->there, err);
    }
    return status;
}

/* Grains that this run does not make do not need their sources. */
static void release_others(const grains_work *w)
{
    const ms_grain_list *list = w->g->list;
    size_t at = w->there;
    for (size_t k = 0; k < list->count; k++) {
        if (at < w->count && w->index[at] == k) {
            at++;
        } else {
            ms_grain_source_release(list->grain[k].source);
        }
    }
}

static int all_threads(const ms_grains *g)
{
    return g->threads ? g->threads : omp_get_max_threads();
}

ms_status ms_grains_make(ms_grains_sum *sum, ms_csv *csv, const ms_grains *g, ms_error *err)
{
    grains_work w = {.g = g, .write = 1, .csv = csv, .sum = sum};
    *sum = (ms_grains_sum){0};
    ms_status status = deal(&w, err);
    if (status == MS_OK) {
        status = make_room(&w, err);
    }
    if (status == MS_OK) {
        status = check_rows(&w, err);
    }
    if (status == MS_OK) {
        const ms_queue queue = {.count = w.count - w.there,
                                .done = w.there,
                                .threads = all_threads(g),
                                .context = &w,
                                .work = work_grain,
                                .take = take_grain};
        release_others(&w);
        status = ms_queue_run(&queue, err);
    }
    free_work(&w);
    return status;
}

static ms_status take_nothing(void *context, size_t k, size_t *failed, ms_error *err)
{
    (void)context;
    (void)k;
    (void)failed;
    (void)err;
    return MS_OK;
}

/* Of three sizes and times: the sum over all grains of the line between the two neighbours of each. */
static double sum_up(const grains_work *w, const ms_grain_list *list, const size_t *index, size_t count)
{
    double sum = 0, size[3];
    for (int t = 0; t < 3; t++) {
        size[t] = list->grain[w->index[t]].size;
    }
    for (size_t k = 0; k < count; k++) {
        const double own = list->grain[index[k]].size;
        const int t = own > size[1];
        const double width = size[t + 1] - size[t];
        const double part = width > 0 ? (own - size[t]) / width : 0;
        sum += w->seconds[t] + part * (w->seconds[t + 1] - w->seconds[t]);
    }
    return sum;
}

/* The smallest, the middle and the largest grain of a part. */
static ms_status choose_three(grains_work *three, const grains_work *all, ms_error *err)
{
    sized_grain *sorted = malloc((all->count + 1) * sizeof *sorted);
    three->index = malloc(3 * sizeof *three->index);
    three->count = 3;
    if (!sorted || !three->index) {
        free(sorted);
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu grains", all->count);
    }
    for (size_t k = 0; k < all->count; k++) {
        sorted[k] = (sized_grain){all->g->list->grain[all->index[k]].size, all->index[k]};
    }
    qsort(sorted, all->count, sizeof *sorted, compare_sizes);
    for (size_t t = 0; t < 3; t++) {
        three->index[t] = sorted[(all->count - 1) * (2 - t) / 2].index;
    }
    free(sorted);
    return make_room(three, err);
}

ms_status ms_grains_try(double *seconds, int *tried, const ms_grains *g, ms_error *err)
{
    grains_work all = {.g = g}, three = {.g = g};
    const ms_queue queue = {.count = 3, .threads = 1, .context = &three, .work = work_grain, .take = take_nothing};
    *seconds = 0;
    *tried = 0;
    ms_status status = deal(&all, err);
    if (status == MS_OK && all.count > 0) {
        status = choose_three(&three, &all, err);
        status = status == MS_OK ? ms_queue_run(&queue, err) : status;
        for (int t = 0; t < 3 && status == MS_OK; t++) {
            *tried += three.status[t] == MS_GRAIN_OK;
        }
        *seconds = status == MS_OK ? sum_up(&three, g->list, all.index, all.count) : 0;
    }
    free_work(&all);
    free_work(&three);
    return status;
}
