#include "ms_input.h"

#include <math.h>
#include <omp.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "base/ms_file.h"
#include "mesh/formats/ms_mesh_read.h"
#include "ms_progress.h"
#include "voxel/ms_cut_cells.h"

static void open_line(const ms_input *input, const char *stage)
{
    const ms_progress_line line = {.name = input->path};
    ms_progress_open(&line);
    ms_progress_stage(stage);
}

static void say_repairs(const char *path, const ms_mesh_report *r, const ms_mesh_mending *how)
{
    ms_progress_wipe();
    if (r->joined) {
        fprintf(stderr, "%s: joined %zu corners of open edges to others within %g of the length of the mesh (--weld)\n",
                path, r->joined, how->weld);
    }
    if (r->filled) {
        fprintf(stderr, "%s: filled %zu holes of at most %zu edges\n", path, r->filled, how->fill_holes);
    }
    if (r->dropped_bodies) {
        fprintf(stderr, "%s: dropped %zu pieces smaller than %g of the largest, of volume %.6g in all\n", path,
                r->dropped_bodies, how->drop_bodies, r->dropped_volume);
    }
    if (r->dropped_degenerate || r->dropped_duplicate) {
        fprintf(stderr, "%s: dropped %zu degenerate and %zu duplicate triangles\n", path, r->dropped_degenerate,
                r->dropped_duplicate);
    }
    if (r->flipped) {
        fprintf(stderr, "%s: turned %zu triangles that were wound the wrong way\n", path, r->flipped);
    }
}

/* Whether bodies are separate, and what their volume is if not. */
static void say_bodies(const ms_input *input)
{
    const ms_solid *solid = &input->solid;
    const size_t bodies = input->report.bodies;
    ms_progress_wipe();
    if (solid->overlapping) {
        const double whole = 0.01 * solid->body.volume;
        fprintf(
            stderr,
            "%s: its surface passes through itself (%zu shells); volume, centre and inertia are those of the union, to "
            "about 1e-4; the mesh holds %.3g %% of that volume more than once and %.3g %% inside out\n",
            input->path, input->report.shells, solid->more_often / whole, solid->inside_out / whole);
    } else if (bodies > 1) {
        fprintf(stderr, "%s: %zu %s; they are treated as one particle\n", input->path, bodies,
                solid->touches ? "bodies, of which some may touch and none overlap" : "separate bodies");
    }
}

/* Inertia goes with the fifth power of a length, which must neither overflow nor vanish. */
static ms_status check_size(const ms_input *input, ms_error *err)
{
    static const double SMALLEST = 1e-50, LARGEST = 1e50;
    double lo[3], hi[3], side = 0;
    ms_mesh_box(lo, hi, &input->mesh);
    for (int a = 0; a < 3; a++) {
        side = fmax(side, hi[a] - lo[a]);
    }
    if (!(side >= SMALLEST && side <= LARGEST)) {
        return ms_fail(err, MS_ERR_SHAPE, "%s: the mesh is %g long, and %g to %g is allowed; choose another unit",
                       input->path, side, SMALLEST, LARGEST);
    }
    return MS_OK;
}

/* Puts the file in front of a message that does not know it. */
static ms_status name_file(ms_error *err, ms_status status, const ms_input *input, const ms_error *cause)
{
    return status == MS_OK ? MS_OK : ms_fail(err, status, "%s: %s", input->path, cause->text);
}

static ms_status parse_mesh(ms_input *input, const ms_bytes *bytes, const char *path, const ms_mesh_mending *mending,
                            ms_error *err)
{
    ms_error cause, remark;
    ms_status status = ms_mesh_parse(&input->mesh, &remark, bytes, path, err);
    if (status == MS_OK && remark.text[0]) {
        fprintf(stderr, "%s\n", remark.text);
    }
    if (status == MS_OK) {
        status = check_size(input, err);
    }
    if (status == MS_OK) {
        status = name_file(err, ms_mesh_mend(&input->mesh, &input->report, mending, &cause), input, &cause);
    }
    if (status == MS_OK) {
        say_repairs(input->path, &input->report, mending);
    }
    if (status == MS_OK && input->report.closed) {
        status = name_file(err, ms_solid_mesh(&input->solid, &input->mesh, &cause), input, &cause);
        say_bodies(input);
    }
    return status;
}

/* The label that was asked for, or the only one; without it, or of several, the box stays empty. */
static ms_status read_volume(ms_input *input, const ms_input_flags *flags, ms_error *err)
{
    ms_error cause;
    ms_status status = ms_input_volume_open(&input->scan, &input->labels, &input->origin, input->path, &flags->scan,
                                            ms_input_max_voxels(flags), err);
    input->is_volume = 1;
    input->checksum = input->scan.checksum;
    if (status != MS_OK) {
        return status;
    }
    const ms_labels *labels = &input->labels;
    const ms_label_entry *entry = flags->label         ? ms_labels_entry(labels, flags->label)
                                  : labels->count == 1 ? labels->entry
                                                       : NULL;
    status = entry ? ms_labels_crop_scan(&input->volume, &input->scan, entry, &cause) : MS_OK;
    return name_file(err, status, input, &cause);
}

/* What never ends is given up where it is longer than the memory that is allowed. */
static ms_status read_standard_input(ms_bytes *bytes, const ms_input_flags *flags, ms_error *err)
{
    const double most = fmin(flags->max_memory, (double)PTRDIFF_MAX);
    return ms_file_read_standard(bytes, (size_t)most, err);
}

/* A mesh by its ending, or from standard input by its content. */
static ms_status read_mesh(ms_input *input, const char *path, const ms_input_flags *flags, ms_error *err)
{
    ms_bytes bytes;
    const int is_standard = ms_file_is_standard(path);
    ms_status status = is_standard ? read_standard_input(&bytes, flags, err) : ms_file_read(&bytes, path, err);
    if (status != MS_OK) {
        return status;
    }
    input->checksum = ms_file_checksum(&bytes);
    status =
        is_standard || ms_mesh_read_is_mesh_path(path)
            ? parse_mesh(input, &bytes, path, &flags->mending, err)
            : ms_fail(err, MS_ERR_FORMAT,
                      "%s: its ending names no shape; meshes are read from .stl, .obj, .ply and .off, volumes from "
                      "%s",
                      path, ms_volume_endings());
    ms_file_free(&bytes);
    return status;
}

ms_status ms_input_read(ms_input *input, const char *path, const ms_input_flags *flags, ms_error *err)
{
    const double start = omp_get_wtime();
    memset(input, 0, sizeof *input);
    input->path = ms_file_name(path);
    if (flags->threads) {
        omp_set_num_threads(flags->threads);
    }
    if (path[0] == '\0') {
        return ms_fail(err, MS_ERR_IO, "the name of the shape is empty; name a mesh or a volume");
    }
    open_line(input, "reading");
    const ms_status status =
        ms_volume_is_volume_path(path) ? read_volume(input, flags, err) : read_mesh(input, path, flags, err);
    ms_progress_close();
    input->read_seconds = omp_get_wtime() - start;
    if (status != MS_OK) {
        ms_input_free(input);
    }
    return status;
}

enum { DEFAULT_CELLS = 100 };

double ms_input_shortest_side(const ms_mesh *mesh)
{
    double lo[3], hi[3];
    ms_mesh_box(lo, hi, mesh);
    return fmin(hi[0] - lo[0], fmin(hi[1] - lo[1], hi[2] - lo[2]));
}

/* The lattice constant that the flags ask for, but for --max-voxels; 0 where that alone is given. */
static ms_status asked_voxel_size(double *h, const ms_input *input, const ms_input_flags *flags, ms_error *err)
{
    ms_error cause;
    *h = flags->voxel_size;
    if (flags->voxel_size > 0 || (flags->max_voxels > 0 && !(flags->cells > 0) && !(flags->deq > 0))) {
        return MS_OK;
    }
    if (flags->deq > 0) {
        if (!input->report.closed) {
            return ms_fail(err, MS_ERR_ARG, "--deq needs the volume of a closed mesh; use --cells or --voxel-size");
        }
        *h = cbrt(6 * input->solid.body.volume / acos(-1.0)) / flags->deq;
        return MS_OK;
    }
    return name_file(err, ms_voxelize_size(h, &input->mesh, flags->cells > 0 ? flags->cells : DEFAULT_CELLS, &cause),
                     input, &cause);
}

/* The lattice constant: what is asked for, or if that makes too many voxels, as fine as they allow. */
static ms_status choose_voxel_size(double *h, const ms_input *input, const ms_input_flags *flags, ms_error *err)
{
    double n[3], within;
    ms_error cause;
    ms_status status = asked_voxel_size(h, input, flags, err);
    if (status != MS_OK || !(flags->max_voxels > 0)) {
        return status;
    }
    if (*h > 0) {
        ms_voxelize_extents(n, &input->mesh, *h);
        if (n[0] * n[1] * n[2] <= flags->max_voxels) {
            return MS_OK;
        }
    }
    status = name_file(err, ms_voxelize_size_within(&within, &input->mesh, flags->max_voxels, &cause), input, &cause);
    *h = within;
    return status;
}

/* That --max-voxels acts, where anything else was asked for. */
static void say_coarser(const ms_input *input, const ms_input_flags *flags, double h)
{
    double asked;
    if (flags->max_voxels > 0 && asked_voxel_size(&asked, input, flags, NULL) == MS_OK && asked > 0 && asked < h) {
        const double side = ms_input_shortest_side(&input->mesh);
        fprintf(stderr, "%s: --max-voxels %.6g leaves %.0f cells along the shortest side, of %.4g asked for\n",
                input->path, flags->max_voxels, side / h, side / asked);
    }
}

/* What is taken beyond the target: without a method, by a score. */
static ms_target_need find_input_need(const ms_input_flags *flags)
{
    const ms_target_need score = {MS_TARGET_METHOD_BYTES + MS_CUT_VOXEL_BYTES, MS_CUT_SQUARE_BYTES};
    return flags->cut && !(flags->need.voxel > 0) ? score : flags->need;
}

static double find_mesh_bytes(const double n[3], double h, const ms_input *input, const ms_input_flags *flags)
{
    return ms_target_bytes(n, ms_mesh_area(&input->mesh) / (h * h), find_input_need(flags));
}

static double find_volume_bytes(const double n[3], const ms_input_flags *flags)
{
    return ms_target_bytes(n, ms_target_box_squares(n), find_input_need(flags));
}

static ms_status check_memory(const double n[3], double bytes, const ms_input_flags *flags, ms_error *err)
{
    if (bytes > flags->max_memory) {
        return ms_fail(err, MS_ERR_LIMIT,
                       "a grid of %.6gx%.6gx%.6g voxels takes about %.3g GB, more than the %.3g GB allowed; use fewer "
                       "cells, --max-voxels N, or raise --max-memory",
                       n[0], n[1], n[2], bytes / 1e9, flags->max_memory / 1e9);
    }
    if (!flags->quiet) {
        fprintf(stderr, "grid: %.0fx%.0fx%.0f voxels, about %.3g MB\n", n[0], n[1], n[2], bytes / 1e6);
    }
    return MS_OK;
}

/* Adds the distance field to the voxels, which were begun at `start`, and takes the times of both. */
static ms_status finish_target(ms_input *input, double start, ms_error *cause)
{
    const double voxels = omp_get_wtime();
    ms_progress_stage("distances");
    const ms_status status = ms_target_add_distance(&input->target, cause);
    input->voxelize_seconds = voxels - start;
    input->distance_seconds = omp_get_wtime() - voxels;
    return status;
}

/* Voxels miss the volume in proportion to their size or faster; far off, one step does not tell how much faster. */
static double cells_to_try(double cells, double misfit)
{
    static const double AIM = 0.005, MOST_TIMES = 4;
    return ceil(cells * fmin(MOST_TIMES, fabs(misfit) / AIM) - 1e-9);
}

void ms_input_say_misfit(const char *name, double misfit, double voxel_size, double shortest_side)
{
    if (!(fabs(misfit) >= MS_INPUT_MISFIT)) {
        return;
    }
    const double cells = shortest_side / voxel_size, more = cells_to_try(cells, misfit);
    fprintf(stderr,
            "%s: the voxels hold %.3g %% %s than the shape: they are too coarse for it, and measures on them are of "
            "another body; try --cells %.0f (now %.3g) or --voxel-size %.4g\n",
            name, 100 * fabs(misfit), misfit > 0 ? "more" : "less", more, cells, shortest_side / more);
}

static ms_status target_from_mesh(ms_input *input, const ms_input_flags *flags, ms_error *err)
{
    double h = 0, n[3];
    ms_error cause;
    if (!input->report.closed && !flags->allow_open) {
        const ms_mesh_report *r = &input->report;
        return ms_fail(err, MS_ERR_SHAPE,
                       "%s: the mesh is open: %zu edges belong to one triangle only, %zu to an odd number; close it, "
                       "fill its holes (%zu, the largest of %zu edges) with --fill-holes %zu, or use --allow-open",
                       input->path, r->open_edges, r->odd_edges, r->holes, r->largest_hole, r->largest_hole);
    }
    ms_status status = choose_voxel_size(&h, input, flags, err);
    if (status != MS_OK) {
        return status;
    }
    say_coarser(input, flags, h);
    ms_voxelize_extents(n, &input->mesh, h);
    status = check_memory(n, find_mesh_bytes(n, h, input, flags), flags, err);
    if (status == MS_OK) {
        const double start = omp_get_wtime();
        open_line(input, "voxels");
        status = ms_target_voxels_from_solid(&input->target, &input->mesh, input->report.closed ? &input->solid : NULL,
                                             h, flags->rule, &cause);
        status = status == MS_OK ? finish_target(input, start, &cause) : status;
        input->target.count_cut = status == MS_OK && flags->cut;
        ms_progress_close();
        status = name_file(err, status, input, &cause);
    }
    if (status == MS_OK && !input->report.closed) {
        fprintf(stderr,
                "%s: the mesh is open (%zu open edges); the three axes disagreed on %zu of %zu voxels, and volume and "
                "inertia are those of the voxels\n",
                input->path, input->report.open_edges, input->target.disagree, input->target.voxels);
    } else if (status == MS_OK) {
        ms_input_say_misfit(input->path, ms_target_misfit(&input->target), h, ms_input_shortest_side(&input->mesh));
    }
    return status;
}

/* A label that stands for a phase, or for what is left of several grains, is no grain. */
static void say_pieces(const ms_input *input)
{
    const ms_target *target = &input->target;
    if (target->pieces > 1) {
        fprintf(stderr,
                "%s: the label is in %zu pieces that touch nowhere, the largest of %zu of %zu voxels; they are treated "
                "as one particle\n",
                input->path, target->pieces, target->largest_piece, target->voxels);
    }
}

/* Voxels of the grid of a label along each axis; 0 if it has none. */
static int measure_label(double n[3], const ms_input *input, const ms_input_flags *flags)
{
    int lo[3], hi[3];
    uint32_t other;
    const int has_voxels = ms_target_label_box(lo, hi, &other, &input->volume, flags->label);
    for (int a = 0; a < 3 && has_voxels; a++) {
        n[a] = hi[a] - lo[a] + 2 * MS_GRID_HULL;
    }
    return has_voxels;
}

static ms_status target_from_volume(ms_input *input, const ms_input_flags *flags, ms_error *err)
{
    double n[3];
    ms_error cause;
    ms_status status = MS_OK;
    if (!flags->label && input->labels.count > 1) {
        return ms_fail(err, MS_ERR_SHAPE, "%s: the volume has several labels (%lu among them); choose one with --label",
                       input->path, (unsigned long)input->labels.entry[1].label);
    }
    if (measure_label(n, input, flags)) { /* without voxels the target says why */
        status = check_memory(n, find_volume_bytes(n, flags), flags, err);
    }
    if (status == MS_OK) {
        const double start = omp_get_wtime();
        open_line(input, "voxels");
        status = ms_target_voxels_from_volume(&input->target, &input->volume, flags->label, &cause);
        status = status == MS_OK ? finish_target(input, start, &cause) : status;
        input->target.count_cut = status == MS_OK && flags->cut;
        ms_progress_close();
        status = name_file(err, status, input, &cause);
        input->target.rule = flags->rule; /* for the union; the voxels of the shape are given */
        say_pieces(input);
    }
    return status;
}

double ms_input_bytes(const ms_input *input, const ms_input_flags *flags)
{
    double h, n[3];
    ms_error ignored;
    if (input->is_volume) {
        return measure_label(n, input, flags) ? find_volume_bytes(n, flags) : 0;
    }
    if (choose_voxel_size(&h, input, flags, &ignored) != MS_OK) {
        return 0;
    }
    ms_voxelize_extents(n, &input->mesh, h);
    return find_mesh_bytes(n, h, input, flags);
}

ms_status ms_input_target(ms_input *input, const ms_input_flags *flags, ms_error *err)
{
    if (flags->threads) {
        omp_set_num_threads(flags->threads);
    }
    input->label = flags->label;
    ms_status status = ms_input_check_flags(input, flags, err);
    if (status != MS_OK) {
        return status;
    }
    return input->is_volume ? target_from_volume(input, flags, err) : target_from_mesh(input, flags, err);
}

ms_status ms_input_show(ms_target *shown, ms_input *input, uint32_t label, ms_error *err)
{
    ms_error cause;
    ms_status status = MS_OK;
    *shown = (ms_target){.mesh = &input->mesh, .closed = input->report.closed};
    if (input->is_volume) {
        status = ms_target_voxels_from_volume(&input->target, &input->volume, label, &cause);
        *shown = input->target;
    }
    return name_file(err, status, input, &cause);
}

size_t ms_input_max_voxels(const ms_input_flags *flags)
{
    const double one[3] = {1, 1, 1};
    return (size_t)(flags->max_memory / ms_target_bytes(one, 0, find_input_need(flags)));
}

void ms_input_free(ms_input *input)
{
    ms_target_free(&input->target);
    ms_mesh_free(&input->mesh);
    ms_volume_free(&input->volume);
    ms_labels_free(&input->labels);
    ms_scan_close(&input->scan);
}
