#include "ms_view_scene.h"

#include <jansson.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_escape.h"
#include "base/ms_fibonacci.h"
#include "base/ms_vector.h"
#include "clump/ms_clump_near.h"
#include "ms_view_base64.h"
#include "ms_view_shape.h"

/* Cells of the lattice of distances along its longest side, and points at which a sphere is looked at. */
enum { CELLS = 40, SAMPLES = 256 };

/* All that is shown lies in a ball: where it is, in the clump's unit. */
typedef struct placing {
    double centre[3], scale;
} placing;

/* @param each bytes of a value */
static void put_array(FILE *stream, const char *name, const void *values, size_t count, size_t each)
{
    fprintf(stream, ",\"%s\":\"", name);
    ms_view_base64_put(stream, values, count, each);
    putc('"', stream);
}

static void put_vector(FILE *stream, const char *name, const double v[3])
{
    fprintf(stream, ",\"%s\":[%.9g,%.9g,%.9g]", name, v[0], v[1], v[2]);
}

static ms_status put_name(FILE *stream, const char *name, ms_error *err)
{
    char *whole = ms_escape_utf8(name);
    json_t *json = whole ? json_string(whole) : NULL;
    char *text = json ? json_dumps(json, JSON_ENCODE_ANY | JSON_ENSURE_ASCII) : NULL;
    if (text) {
        fputs(",\"name\":", stream);
        ms_escape_html_json(stream, text);
    } else {
        ms_fail(err, MS_ERR_NOMEM, "no memory to show a clump");
    }
    free(whole);
    free(text);
    json_decref(json);
    return text ? MS_OK : MS_ERR_NOMEM;
}

static placing find_placing(const ms_clump *clump, const ms_mesh *mesh)
{
    placing f = {.scale = 0};
    double lo[3], hi[3];
    ms_clump_box(lo, hi, clump);
    if (mesh) {
        double low[3], high[3];
        ms_mesh_box(low, high, mesh);
        for (int k = 0; k < 3; k++) {
            lo[k] = fmin(lo[k], low[k]);
            hi[k] = fmax(hi[k], high[k]);
        }
    }
    for (int k = 0; k < 3; k++) {
        f.centre[k] = (lo[k] + hi[k]) / 2;
    }
    for (size_t s = 0; s < clump->n_spheres; s++) {
        const ms_sphere *sphere = &clump->sphere[s];
        f.scale = fmax(f.scale, sqrt(ms_squared_distance(sphere->centre, f.centre)) + sphere->radius);
    }
    for (size_t v = 0; mesh && v < mesh->n_vertices; v++) {
        f.scale = fmax(f.scale, sqrt(ms_squared_distance(mesh->vertex[v], f.centre)));
    }
    return f;
}

static void place_in(double out[3], const placing *f, const double place[3])
{
    for (int k = 0; k < 3; k++) {
        out[k] = (place[k] - f->centre[k]) / f->scale;
    }
}

static ms_status put_spheres(FILE *stream, const placing *f, const ms_clump *clump, ms_error *err)
{
    float *value = malloc(4 * clump->n_spheres * sizeof *value);
    if (!value) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory to show %zu spheres", clump->n_spheres);
    }
    for (size_t s = 0; s < clump->n_spheres; s++) {
        double at[3];
        place_in(at, f, clump->sphere[s].centre);
        for (int k = 0; k < 3; k++) {
            value[4 * s + (size_t)k] = (float)at[k];
        }
        value[4 * s + 3] = (float)(clump->sphere[s].radius / f->scale);
    }
    put_array(stream, "spheres", value, 4 * clump->n_spheres, sizeof *value);
    for (size_t s = 0; clump->mass && s < clump->n_spheres; s++) {
        value[s] = (float)clump->mass[s];
    }
    if (clump->mass) {
        put_array(stream, "mass", value, clump->n_spheres, sizeof *value);
    }
    free(value);
    return MS_OK;
}

/* At points of a Fibonacci lattice; 0 of a sphere that is inside. */
static double find_protrusion(const ms_view_shape *shape, const ms_clump_near *near, size_t s)
{
    const ms_sphere *sphere = &near->clump->sphere[s];
    double most = 0;
    if (ms_closest_signed_distance(shape->closest, sphere->centre) + sphere->radius <= 0) {
        return 0;
    }
    for (int m = 0; m < SAMPLES; m++) {
        double u[3], point[3];
        ms_fibonacci(u, m, SAMPLES);
        for (int k = 0; k < 3; k++) {
            point[k] = sphere->centre[k] + sphere->radius * u[k];
        }
        if (!ms_clump_near_hides(near, point, s)) {
            most = fmax(most, ms_closest_signed_distance(shape->closest, point));
        }
    }
    return most;
}

static ms_status put_protrusions(FILE *stream, const ms_view_shape *shape, const ms_clump *clump, ms_error *err)
{
    const size_t n = clump->n_spheres;
    ms_clump_near near;
    ms_status status = ms_clump_near_build(&near, clump, NULL, err);
    if (status != MS_OK) {
        return status;
    }
    float *value = malloc(n * sizeof *value);
    if (value) {
#pragma omp parallel for schedule(dynamic, 1)
        for (size_t s = 0; s < n; s++) {
            value[s] = (float)find_protrusion(shape, &near, s);
        }
        put_array(stream, "protrusion", value, n, sizeof *value);
    } else {
        status = ms_fail(err, MS_ERR_NOMEM, "no memory to show %zu spheres", n);
    }
    free(value);
    ms_clump_near_free(&near);
    return status;
}

/* Corners as parts of the box; faces in as few bits as number them. */
static ms_status put_mesh(FILE *stream, const placing *f, const ms_view_shape *shape, ms_error *err)
{
    const ms_mesh *mesh = shape->shown;
    const size_t corners = 3 * mesh->n_vertices, faces = 3 * mesh->n_triangles;
    const int is_wide = mesh->n_vertices > 65536;
    uint16_t *part = malloc((corners > faces ? corners : faces) * sizeof *part);
    double lo[3], hi[3], low[3], high[3];
    if (!part) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory to show %zu triangles", mesh->n_triangles);
    }
    ms_mesh_box(lo, hi, mesh);
    place_in(low, f, lo);
    place_in(high, f, hi);
    for (size_t c = 0; c < corners; c++) {
        const double span = hi[c % 3] - lo[c % 3];
        part[c] = (uint16_t)(span > 0 ? 65535 * (mesh->vertex[c / 3][c % 3] - lo[c % 3]) / span + 0.5 : 0);
    }
    fprintf(stream, ",\"mesh\":{\"of\":%zu", shape->mesh->n_triangles);
    put_vector(stream, "low", low);
    put_vector(stream, "high", high);
    put_array(stream, "corners", part, corners, sizeof *part);
    for (size_t c = 0; c < faces && !is_wide; c++) {
        part[c] = (uint16_t)mesh->triangle[c / 3][c % 3];
    }
    if (is_wide) {
        put_array(stream, "faces", mesh->triangle, faces, sizeof(uint32_t));
    } else {
        put_array(stream, "faces", part, faces, sizeof *part);
    }
    putc('}', stream);
    free(part);
    return MS_OK;
}

/* Distances at the points of a lattice. @return the largest */
static double fill_field(float *value, const int n[3], const double lo[3], double h, const ms_closest *closest)
{
    double most = 0;
#pragma omp parallel for schedule(dynamic, 1) reduction(max : most)
    for (int k = 0; k < n[2]; k++) {
        for (int row = 0; row < n[0] * n[1]; row++) {
            const int i = row % n[0], j = row / n[0];
            const double point[3] = {lo[0] + h * i, lo[1] + h * j, lo[2] + h * k};
            const double distance = ms_closest_signed_distance(closest, point);
            value[(size_t)row + (size_t)n[0] * (size_t)n[1] * (size_t)k] = (float)distance;
            most = fmax(most, distance);
        }
    }
    return most;
}

/* A cell around the clump; of what is inside, a cell's depth is enough to tell. */
static ms_status put_field(FILE *stream, const placing *f, const ms_view_shape *shape, const ms_clump *clump,
                           ms_error *err)
{
    double lo[3], hi[3], low[3], side = 0;
    int n[3];
    size_t points = 1;
    ms_clump_box(lo, hi, clump);
    for (int k = 0; k < 3; k++) {
        side = fmax(side, hi[k] - lo[k]);
    }
    const double h = side / CELLS;
    for (int k = 0; k < 3; k++) {
        n[k] = (int)ceil((hi[k] - lo[k]) / h) + 3;
        lo[k] -= h;
        points *= (size_t)n[k];
    }
    float *value = malloc(points * sizeof *value);
    uint8_t *part = malloc(points);
    if (value && part) {
        const double least = -1.8 * h, most = fill_field(value, n, lo, h, shape->closest);
        for (size_t p = 0; p < points; p++) {
            part[p] = (uint8_t)(255 * (fmax(least, (double)value[p]) - least) / (most - least) + 0.5);
        }
        place_in(low, f, lo);
        fprintf(stream, ",\"field\":{\"n\":[%d,%d,%d],\"h\":%.9g,\"range\":[%.9g,%.9g]", n[0], n[1], n[2], h / f->scale,
                least / f->scale, most / f->scale);
        put_vector(stream, "low", low);
        put_array(stream, "values", part, points, 1);
        putc('}', stream);
    }
    free(value);
    free(part);
    return value && part ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory to show distances");
}

static ms_status put_shape(FILE *stream, const ms_view_scene *scene, const placing *f, const ms_view_shape *shape,
                           ms_error *err)
{
    ms_status status = put_mesh(stream, f, shape, err);
    if (status == MS_OK && scene->target->closed) {
        status = put_protrusions(stream, shape, scene->clump, err);
    }
    return status == MS_OK && scene->target->closed && scene->with_field
               ? put_field(stream, f, shape, scene->clump, err)
               : status;
}

static ms_status put_scene(FILE *stream, const ms_view_scene *scene, const ms_view_shape *shape, ms_error *err)
{
    const placing f = find_placing(scene->clump, shape->mesh);
    if (!isfinite(f.scale)) {
        return ms_fail(err, MS_ERR_ARG, "what is to be shown reaches too far; choose another unit");
    }
    fprintf(stream, "{\"ordered\":%s,\"scale\":%.9g", scene->ordered ? "true" : "false", f.scale);
    put_vector(stream, "centre", f.centre);
    ms_status status = put_name(stream, scene->name, err);
    if (status == MS_OK) {
        status = put_spheres(stream, &f, scene->clump, err);
    }
    if (status == MS_OK && scene->target) {
        status = put_shape(stream, scene, &f, shape, err);
    }
    putc('}', stream);
    return status;
}

ms_status ms_view_scene_write(FILE *stream, const ms_view_scene *scene, ms_error *err)
{
    ms_view_shape shape = {0};
    ms_status status = scene->target ? ms_view_shape_make(&shape, scene->target, scene->most_triangles, err) : MS_OK;
    if (status == MS_OK) {
        status = put_scene(stream, scene, &shape, err);
    }
    ms_view_shape_free(&shape);
    return status;
}
