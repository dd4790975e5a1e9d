#include "ms_grain_assembly.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_escape.h"
#include "base/ms_file.h"
#include "base/ms_quaternion.h"
#include "base/ms_text.h"
#include "cli/ms_mass.h"
#include "clump/formats/ms_read.h"
#include "clump/formats/ms_write_packing.h"
#include "clump/ms_packing.h"

/* Clumps nearer than this part of the smaller radius are neighbours. */
static const double NEAR = 0.1;

/* The first format of the run that can be read back. */
static const ms_format *readable_format(const ms_grains *g, ms_error *err)
{
    for (size_t f = 0; f < g->n_formats; f++) {
        if (g->format[f]->read) {
            return g->format[f];
        }
    }
    ms_fail(err, MS_ERR_ARG,
            "--assembly reads the clumps back, and %s is a format that is only written; give --format csv beside it",
            g->format[0]->name);
    return NULL;
}

ms_status ms_grain_assembly_list(ms_files *files, const ms_grains *g, ms_error *err)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/assembly.csv", g->folder);
    ms_status status = ms_files_add(files, path, MS_FILE_LATER, err);
    for (size_t f = 0; f < g->n_formats; f++) {
        for (const ms_packing_part *part = g->format[f]->packing; part->suffix && status == MS_OK; part++) {
            snprintf(path, sizeof path, "%s/assembly.%s%s", g->folder, g->format[f]->ending, part->suffix);
            status = ms_files_add(files, path, MS_FILE_LATER, err);
        }
    }
    return status;
}

ms_status ms_grain_assembly_check(const ms_grains *g, ms_error *err)
{
    const ms_grain_list *list = g->list;
    for (size_t s = 0; s < list->n_sources && list->n_sources > 1; s++) {
        if (list->source[s]->is_volume) {
            return ms_fail(err, MS_ERR_ARG,
                           "%s: --assembly puts the grains of one frame together: one volume, or meshes that were "
                           "taken from one; run each volume into a folder of its own",
                           list->source[s]->path);
        }
    }
    return readable_format(g, err) ? MS_OK : MS_ERR_ARG;
}

/* Spheres of a file in the frame of the source become those of the template. */
static void carry_spheres(ms_placed *placed, const ms_grain_place *place, double scale)
{
    for (size_t s = 0; s < ms_clump_count_masses(&placed->clump); s++) {
        ms_sphere *sphere = &placed->clump.sphere[s];
        double from_centre[3];
        for (int k = 0; k < 3; k++) {
            from_centre[k] = scale * (sphere->centre[k] - place->centre[k]);
        }
        ms_quaternion_turn_back(sphere->centre, place->turn, from_centre);
        sphere->radius *= scale;
    }
}

static ms_status read_spheres(ms_placed *placed, const ms_grain_place *place, const ms_grains *g, double scale,
                              ms_error *err)
{
    const ms_format *format = readable_format(g, err);
    if (!format) {
        return MS_ERR_ARG;
    }
    const size_t size = strlen(g->folder) + strlen(placed->name) + strlen(format->ending) + 3;
    char *path = malloc(size);
    ms_particle ignored;
    if (!path) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for a path in %s", g->folder);
    }
    snprintf(path, size, "%s/%s.%s", g->folder, placed->name, format->ending);
    const ms_status status = ms_read_clump(&placed->clump, &ignored, path, err);
    if (status == MS_OK && format->need == MS_NEED_SPHERES) {
        carry_spheres(placed, place, scale);
    }
    free(path);
    return status;
}

/* Rows that were there may be of other masses: their columns are no part of what --resume compares. */
static ms_status check_masses(const ms_grain_found *found, const ms_mass_flags *mass, ms_error *err)
{
    const double asked = mass->density * pow(mass->scale, 3) * found->volume;
    if (!isfinite(found->place.mass)) {
        return ms_fail(err, MS_ERR_ARG, "grain %.0f was made without masses; make the table anew", found->number);
    }
    if (!mass->of_union && !(fabs(found->place.mass - asked) <= 1e-9 * asked)) {
        return ms_fail(
            err, MS_ERR_ARG,
            "grain %.0f was made with another density or unit: its mass is %g kg and not %g kg; give those of "
            "the table, or make it anew",
            found->number, found->place.mass, asked);
    }
    return MS_OK;
}

static ms_status add_placed(ms_packing *packing, const ms_grain_found *found, const ms_grains *g, ms_error *err)
{
    const double scale = g->mass ? g->mass->scale : 1;
    ms_placed *placed = &packing->placed[packing->count];
    const ms_status status = g->mass ? check_masses(found, g->mass, err) : MS_OK;
    if (status != MS_OK) {
        return status;
    }
    if (!ms_escape_fits_liggghts(found->file)) { /* into which it goes, and into lines of others */
        return ms_fail(err, MS_ERR_FORMAT,
                       "grain %.0f: its file '%.60s' has a name that no script can hold; mend the table", found->number,
                       found->file);
    }
    *placed = (ms_placed){.number = (size_t)found->number, .scale = 1};
    placed->name = ms_grain_row_stem(found, g->format[0]->ending);
    if (!placed->name) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the name of a template");
    }
    packing->count++;
    placed->size = scale * cbrt(0.75 * found->volume / acos(-1.0));
    memcpy(placed->turn, found->place.turn, sizeof placed->turn);
    for (int k = 0; k < 3; k++) {
        placed->centre[k] = scale * found->place.centre[k];
    }
    if (g->mass) {
        placed->particle = (ms_particle){.scale = 1, .density = g->mass->density, .mass = found->place.mass};
        for (int m = 0; m < 3; m++) {
            placed->particle.inertia[m][m] = found->place.moment[m];
        }
    }
    return read_spheres(placed, &found->place, g, scale, err);
}

static ms_status read_packing(ms_packing *packing, ms_grain_assembly *sum, const ms_csv *csv, const ms_grains *g,
                              ms_error *err)
{
    ms_status status = MS_OK;
    *packing = (ms_packing){.placed = calloc(csv->n_rows + 1, sizeof *packing->placed)};
    if (!packing->placed) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the places of %zu grains", csv->n_rows);
    }
    for (size_t r = 0; r < csv->n_rows && status == MS_OK; r++) {
        ms_grain_found found;
        status = ms_grain_row_find(&found, csv->row[r], err);
        if (status == MS_OK && found.status == MS_GRAIN_OK) {
            status = add_placed(packing, &found, g, err);
        } else {
            sum->without++;
        }
    }
    sum->clumps = packing->count;
    return status == MS_OK && packing->count == 0
               ? ms_fail(err, MS_ERR_SHAPE, "%s: no grain has a clump to put into its place", csv->path)
               : status;
}

/* Lengths in the unit of the source, as in grains.csv. */
static void print_overlaps(FILE *stream, const ms_packing *packing, const ms_overlaps *overlaps, double scale)
{
    fputs("grain,neighbour,template,neighbour_template,depth,relative_depth,contacts,scale,neighbour_scale\n", stream);
    for (size_t o = 0; o < overlaps->count; o++) {
        const ms_overlap *pair = &overlaps->pair[o];
        const ms_placed *a = &packing->placed[pair->first], *b = &packing->placed[pair->second];
        fprintf(stream, "%zu,%zu,", a->number, b->number);
        ms_escape_csv_path(stream, a->name);
        fputc(',', stream);
        ms_escape_csv_path(stream, b->name);
        fprintf(stream, ",%s", ms_text_of_number(pair->depth / scale).text);
        fprintf(stream, ",%s,%zu", ms_text_of_number(pair->relative).text, pair->contacts);
        fprintf(stream, ",%s", ms_text_of_number(a->scale).text);
        fprintf(stream, ",%s\n", ms_text_of_number(b->scale).text);
    }
}

static int compare_depths(const void *a, const void *b)
{
    const double x = ((const ms_overlap *)a)->relative, y = ((const ms_overlap *)b)->relative;
    return (x < y) - (x > y);
}

/* Sorts the overlaps, deepest first. */
static void sum_up(ms_grain_assembly *sum, ms_overlaps *overlaps, const ms_packing *packing)
{
    double before = 0, after = 0;
    sum->neighbours = overlaps->count;
    for (size_t o = 0; o < overlaps->count; o++) {
        sum->overlapping += overlaps->pair[o].depth > 0;
    }
    if (sum->overlapping) {
        qsort(overlaps->pair, overlaps->count, sizeof *overlaps->pair, compare_depths);
        sum->most = overlaps->pair[0].relative;
        sum->median =
            (overlaps->pair[(sum->overlapping - 1) / 2].relative + overlaps->pair[sum->overlapping / 2].relative) / 2;
    }
    for (size_t p = 0; p < packing->count; p++) {
        const ms_placed *placed = &packing->placed[p];
        before += pow(placed->size, 3);
        after += pow(placed->scale * placed->size, 3);
    }
    sum->volume = after / before;
}

static ms_status write_overlaps(ms_grain_assembly *sum, const ms_packing *packing, const ms_grains *g, ms_error *err)
{
    char path[4096];
    ms_overlaps overlaps;
    ms_output output;
    ms_status status = ms_packing_overlaps(&overlaps, packing, NEAR, err);
    if (status != MS_OK) {
        return status;
    }
    snprintf(path, sizeof path, "%s/assembly.csv", g->folder);
    status = ms_output_open(&output, path, err);
    if (status == MS_OK) {
        print_overlaps(output.stream, packing, &overlaps, g->mass ? g->mass->scale : 1);
        status = ms_output_close(&output, MS_OK, err);
        sum_up(sum, &overlaps, packing);
    }
    ms_packing_overlaps_free(&overlaps);
    return status;
}

ms_status ms_grain_assembly_write(ms_grain_assembly *sum, const ms_csv *csv, const ms_grains *g, double most_overlap,
                                  ms_error *err)
{
    char path[4096];
    ms_packing packing;
    *sum = (ms_grain_assembly){0};
    ms_status status = read_packing(&packing, sum, csv, g, err);
    if (status == MS_OK && most_overlap > 0) {
        status = ms_packing_shrink(&packing, most_overlap, err);
    }
    if (status == MS_OK) {
        status = write_overlaps(sum, &packing, g, err);
    }
    for (size_t f = 0; f < g->n_formats && status == MS_OK; f++) {
        snprintf(path, sizeof path, "%s/assembly.%s", g->folder, g->format[f]->ending);
        status = ms_write_packing_is(g->format[f]) ? ms_write_packing(&packing, path, g->format[f], err) : MS_OK;
    }
    ms_packing_free(&packing);
    return status;
}
