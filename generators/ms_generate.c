#include "ms_generate.h"

#include <string.h>

#include "mesh/formats/ms_mesh_read.h"
#include "ms_generator.h"
#include "volume/ms_volume.h"
#include "voxel/ms_target.h"

enum { DEFAULT_CELLS = 100, DEFAULT_SPHERES = 50 };

/* What was read, and what was made of it. */
typedef struct shape {
    ms_mesh mesh;     /* empty for a volume */
    ms_volume volume; /* empty for a mesh */
    ms_target target;
} shape;

static void free_shape(shape *s)
{
    ms_target_free(&s->target);
    ms_mesh_free(&s->mesh);
    ms_volume_free(&s->volume);
}

static ms_generate_request fill_in(const ms_generate_request *request)
{
    ms_generate_request all = request ? *request : (ms_generate_request){0};
    all.generator = all.generator ? all.generator : MS_GENERATOR_DEFAULT;
    all.cells = all.cells > 0 || all.max_voxels > 0 ? all.cells : DEFAULT_CELLS;
    all.seed = all.seed ? all.seed : 1;
    all.max_bytes = all.max_bytes > 0 ? all.max_bytes : ms_target_default_bytes();
    if (ms_stop_is_none(&all.stop)) {
        all.stop.spheres = DEFAULT_SPHERES;
    }
    return all;
}

static ms_status set_options(ms_settings *settings, const ms_generator *generator, const ms_generate_option *option,
                             ms_error *err)
{
    ms_status status = ms_option_settings_init(settings, generator->options, err);
    for (; status == MS_OK && option && option->name; option++) {
        status = ms_option_settings_set(settings, option->name, option->text, err);
    }
    return status;
}

/* What the method says that it takes; of an unknown one nothing is said. */
static ms_target_need find_need(const ms_generate_request *request)
{
    const ms_generator *generator = ms_generator_find(request->generator, NULL);
    ms_target_need need = {0};
    ms_settings settings;
    if (generator) {
        const ms_status status = set_options(&settings, generator, request->options, NULL);
        need = ms_generator_need(generator, status == MS_OK ? &settings : NULL, request->stop.coverage_cut > 0);
        ms_option_settings_free(&settings);
    }
    return need;
}

static size_t max_voxels(const ms_generate_request *request)
{
    const double one[3] = {1, 1, 1};
    const double most = request->max_bytes / ms_target_bytes(one, 0, find_need(request));
    return most < 1e18 ? (size_t)most : (size_t)1e18;
}

static ms_status check_bytes(const double n[3], double squares, const ms_generate_request *request, ms_error *err)
{
    const double bytes = ms_target_bytes(n, squares, find_need(request)), max_bytes = request->max_bytes;
    return bytes <= max_bytes ? MS_OK
                              : ms_fail(err, MS_ERR_LIMIT,
                                        "a grid of %.6gx%.6gx%.6g voxels takes about %.3g GB, more than the %.3g GB "
                                        "allowed; use fewer cells or allow more",
                                        n[0], n[1], n[2], bytes / 1e9, max_bytes / 1e9);
}

/* The finer of two bounds gives way. */
static ms_status choose_size(double *h, const ms_mesh *mesh, const ms_generate_request *request, ms_error *err)
{
    double least = 0;
    *h = 0;
    ms_status status = request->cells > 0 ? ms_voxelize_size(h, mesh, request->cells, err) : MS_OK;
    if (status == MS_OK && request->max_voxels > 0) {
        status = ms_voxelize_size_within(&least, mesh, request->max_voxels, err);
    }
    *h = least > *h ? least : *h;
    return status;
}

static ms_status target_from_mesh(shape *s, const ms_generate_request *request, ms_error *err)
{
    double h, n[3];
    ms_mesh_report report;
    const ms_mesh_mending usual = {.weld = MS_MESH_WELD};
    ms_status status = ms_mesh_mend(&s->mesh, &report, request->mending ? request->mending : &usual, err);
    if (status == MS_OK && !report.closed) {
        status = ms_fail(
            err, MS_ERR_SHAPE,
            "the mesh is open: %zu edges belong to one triangle only, %zu to an odd number; close it, or fill its "
            "%zu holes of at most %zu edges",
            report.open_edges, report.odd_edges, report.holes, report.largest_hole);
    }
    if (status == MS_OK) {
        status = choose_size(&h, &s->mesh, request, err);
    }
    if (status != MS_OK) {
        return status;
    }
    ms_voxelize_extents(n, &s->mesh, h);
    status = check_bytes(n, ms_mesh_area(&s->mesh) / (h * h), request, err);
    return status == MS_OK ? ms_target_from_mesh(&s->target, &s->mesh, 1, h, MS_VOXEL_HALF, err) : status;
}

static ms_status target_from_volume(shape *s, const ms_generate_request *request, ms_error *err)
{
    int lo[3], hi[3];
    uint32_t other;
    ms_status status = MS_OK;
    if (ms_target_label_box(lo, hi, &other, &s->volume, request->label)) { /* without voxels the target says why */
        const double n[3] = {hi[0] - lo[0] + 2 * MS_GRID_HULL, hi[1] - lo[1] + 2 * MS_GRID_HULL,
                             hi[2] - lo[2] + 2 * MS_GRID_HULL};
        status = check_bytes(n, ms_target_box_squares(n), request, err);
    }
    return status == MS_OK ? ms_target_from_volume(&s->target, &s->volume, request->label, err) : status;
}

/* Messages of reading name the file; those of what follows do not, and get it in front. */
static ms_status read_shape(shape *s, const char *path, const ms_generate_request *request, ms_error *err)
{
    ms_error cause;
    ms_status status;
    if (ms_volume_is_volume_path(path)) {
        status = ms_volume_read(&s->volume, path, max_voxels(request), err);
    } else if (ms_mesh_read_is_mesh_path(path)) {
        status = ms_mesh_read(&s->mesh, path, err);
    } else {
        return ms_fail(err, MS_ERR_FORMAT,
                       "%s: its ending names no shape; meshes are read from .stl, .obj, .ply and .off, volumes from %s",
                       path, ms_volume_endings());
    }
    if (status != MS_OK) {
        return status;
    }
    status = s->volume.label ? target_from_volume(s, request, &cause) : target_from_mesh(s, request, &cause);
    return status == MS_OK ? MS_OK : ms_fail(err, status, "%s: %s", path, cause.text);
}

static ms_status run_and_measure(ms_clump *clump, ms_metrics *metrics, const ms_generator *generator,
                                 const ms_settings *settings, const ms_target *target,
                                 const ms_generate_request *request, ms_error *err)
{
    ms_stop_reason reason;
    const ms_run run = {.target = target, .stop = request->stop, .settings = settings, .seed = request->seed};
    ms_status status = ms_generator_run(clump, &reason, generator, &run, err);
    if (status == MS_OK && metrics) {
        status = ms_metrics_compute(metrics, NULL, target, clump, max_voxels(request), err);
    }
    if (status != MS_OK) {
        ms_clump_free(clump);
    }
    return status;
}

ms_status ms_generate_file(ms_clump *clump, ms_metrics *metrics, const char *path, const ms_generate_request *request,
                           ms_error *err)
{
    const ms_generate_request all = fill_in(request);
    const ms_generator *generator = ms_generator_find(all.generator, err);
    shape s = {.mesh = {0}};
    ms_settings settings = {0};
    memset(clump, 0, sizeof *clump);
    ms_status status = generator ? set_options(&settings, generator, all.options, err) : MS_ERR_ARG;
    if (status == MS_OK) {
        status = read_shape(&s, path, &all, err);
    }
    if (status == MS_OK) {
        status = run_and_measure(clump, metrics, generator, &settings, &s.target, &all, err);
    }
    ms_option_settings_free(&settings);
    free_shape(&s);
    return status;
}
