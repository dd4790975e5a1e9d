#include "ms_render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "base/ms_file.h"
#include "base/ms_vector.h"
#include "clump/ms_particle.h"

ms_status ms_render_picture_alloc(ms_picture *picture, int width, int height, ms_error *err)
{
    const size_t pixels = (size_t)width * (size_t)height;
    *picture = (ms_picture){.width = width,
                            .height = height,
                            .grey = malloc(pixels),
                            .depth = malloc(pixels * sizeof(float)),
                            .part = calloc(pixels, sizeof(uint32_t))};
    if (!picture->grey || !picture->depth || !picture->part) {
        ms_render_picture_free(picture);
        return ms_fail(err, MS_ERR_NOMEM, "no memory for a picture of %dx%d pixels", width, height);
    }
    memset(picture->grey, 255, pixels);
    for (size_t p = 0; p < pixels; p++) {
        picture->depth[p] = -HUGE_VALF;
    }
    return MS_OK;
}

void ms_render_picture_free(ms_picture *picture)
{
    free(picture->grey);
    free(picture->depth);
    free(picture->part);
    *picture = (ms_picture){0};
}

/* Turns the plane of two of the axes. */
static void turn(double a[3], double b[3], double degrees)
{
    const double c = cos(degrees * acos(-1.0) / 180), s = sin(degrees * acos(-1.0) / 180);
    for (int k = 0; k < 3; k++) {
        const double first = a[k];
        a[k] = c * first + s * b[k];
        b[k] = c * b[k] - s * first;
    }
}

/* Right and up of a point from the centre, pixels, and its depth. */
static void project(double out[3], const ms_view *view, const double point[3])
{
    const double from[3] = {point[0] - view->centre[0], point[1] - view->centre[1], point[2] - view->centre[2]};
    for (int k = 0; k < 3; k++) {
        out[k] = view->scale * ms_dot(view->axis[k], from);
    }
}

/* Turned as the principal axes of a body are, about the middle of a box. */
static ms_status turn_view(ms_view *view, const ms_body *body, const double lo[3], const double hi[3], ms_error *err)
{
    ms_principal principal;
    const ms_status status = ms_inertia_principal(&principal, body, err);
    memcpy(view->axis, principal.axis, sizeof view->axis);
    turn(view->axis[0], view->axis[2], -25);
    turn(view->axis[1], view->axis[2], 30);
    for (int k = 0; k < 3; k++) {
        view->centre[k] = (lo[k] + hi[k]) / 2;
    }
    return status;
}

/* How far a ball reaches from the middle of a view of scale 1, to a side or up and down. */
static double find_reach(const ms_view *view, const double centre[3], double radius)
{
    double at[3];
    project(at, view, centre);
    return fmax(fabs(at[0]), fabs(at[1])) + radius;
}

ms_status ms_render_view(ms_view *view, const ms_target *target, int x, int y, int size, ms_error *err)
{
    const ms_grid *g = &target->grid;
    const ms_mesh *mesh = target->mesh;
    double lo[3], hi[3], reach = 0;
    *view = (ms_view){.scale = 1, .x = x, .y = y, .size = size};
    for (int k = 0; k < 3; k++) {
        lo[k] = g->origin[k];
        hi[k] = g->origin[k] + g->h * (g->n[k] - 1);
    }
    if (mesh) {
        ms_mesh_box(lo, hi, mesh);
    }
    const ms_status status = turn_view(view, &target->body, lo, hi, err);
    const size_t count = mesh ? mesh->n_vertices : 8; /* or the corners of the box */
    for (size_t v = 0; v < count; v++) {
        const double corner[3] = {v & 1 ? hi[0] : lo[0], v & 2 ? hi[1] : lo[1], v & 4 ? hi[2] : lo[2]};
        reach = fmax(reach, find_reach(view, mesh ? mesh->vertex[v] : corner, 0));
    }
    view->scale = 0.46 * size / reach;
    return status;
}

/* Sums of solid spheres, in which what overlaps counts more than once: that turns the axes but a little. */
static ms_status find_inertia(ms_body *body, const ms_clump *clump, ms_error *err)
{
    ms_particle sum;
    ms_clump solid = {.n_spheres = clump->n_spheres, .sphere = clump->sphere};
    ms_status status = ms_clump_alloc_masses(&solid, err);
    if (status != MS_OK) {
        return status;
    }
    for (size_t s = 0; s < clump->n_spheres; s++) {
        solid.mass[s] = pow(clump->sphere[s].radius, 3);
    }
    status = ms_particle_from_spheres(&sum, &solid, 1, err);
    memcpy(body->inertia, sum.inertia, sizeof body->inertia);
    free(solid.mass);
    return status;
}

ms_status ms_render_clump_view(ms_view *view, const ms_clump *clump, int x, int y, int size, ms_error *err)
{
    ms_body body = {0};
    double lo[3], hi[3], reach = 0;
    *view = (ms_view){.scale = 1, .x = x, .y = y, .size = size};
    ms_clump_box(lo, hi, clump);
    ms_status status = find_inertia(&body, clump, err);
    if (status == MS_OK) {
        status = turn_view(view, &body, lo, hi, err);
    }
    for (size_t s = 0; status == MS_OK && s < clump->n_spheres; s++) {
        reach = fmax(reach, find_reach(view, clump->sphere[s].centre, clump->sphere[s].radius));
    }
    view->scale = 0.46 * size / reach;
    return status;
}

/* Lit from the upper left, in front of whatever was there; what is turned from the light is darker still. */
static void put(ms_picture *picture, size_t at, double depth, const double normal[3], uint32_t part)
{
    static const double LIGHT[3] = {-0.42, 0.54, 0.73};
    if ((float)depth > picture->depth[at]) {
        picture->depth[at] = (float)depth;
        picture->grey[at] = (uint8_t)(145 + 100 * ms_dot(normal, LIGHT));
        picture->part[at] = part;
    }
}

/* Pixels of a square that a span of the view covers: lo to hi - 1. */
static void clip(int *lo, int *hi, double from, double to, int size)
{
    *lo = (int)fmax(0, ceil(fmin(from + 0.5 * size, size) - 0.5));
    *hi = (int)fmin(size, floor(fmax(to + 0.5 * size, -1) - 0.5) + 1);
}

/* Corners in the frame of the view; those that face away are left out. */
static void put_triangle(ms_picture *picture, const ms_view *view, double corner[3][3])
{
    const double *a = corner[0], *b = corner[1], *c = corner[2];
    const double ab[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, ac[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    double normal[3];
    int x0, x1, y0, y1;
    ms_cross(normal, ab, ac);
    const double length = sqrt(ms_dot(normal, normal)), area = normal[2];
    if (!(area > 0)) {
        return;
    }
    for (int k = 0; k < 3; k++) {
        normal[k] /= length;
    }
    clip(&x0, &x1, fmin(a[0], fmin(b[0], c[0])), fmax(a[0], fmax(b[0], c[0])), view->size);
    clip(&y0, &y1, -fmax(a[1], fmax(b[1], c[1])), -fmin(a[1], fmin(b[1], c[1])), view->size);
    for (int j = y0; j < y1; j++) {
        for (int i = x0; i < x1; i++) {
            const double x = i + 0.5 - 0.5 * view->size - a[0], y = 0.5 * view->size - j - 0.5 - a[1];
            const double u = (x * ac[1] - y * ac[0]) / area, v = (y * ab[0] - x * ab[1]) / area;
            if (u >= 0 && v >= 0 && u + v <= 1) {
                const size_t at = (size_t)(view->y + j) * (size_t)picture->width + (size_t)(view->x + i);
                put(picture, at, a[2] + u * ab[2] + v * ac[2], normal, MS_RENDER_SHAPE);
            }
        }
    }
}

static void render_mesh(ms_picture *picture, const ms_view *view, const ms_mesh *mesh)
{
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        double corner[3][3];
        for (int k = 0; k < 3; k++) {
            project(corner[k], view, mesh->vertex[mesh->triangle[t][k]]);
        }
        put_triangle(picture, view, corner);
    }
}

/* The face of a voxel on the side `sign` of an axis, as two triangles. */
static void put_face(ms_picture *picture, const ms_view *view, const ms_grid *grid, const int voxel[3], int axis,
                     int sign)
{
    static const int AROUND[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    double corner[4][3], half[3][3];
    for (int q = 0; q < 4; q++) {
        double point[3];
        for (int k = 0; k < 3; k++) {
            const int along = (k - axis + 3) % 3; /* 0: the axis itself */
            const double step = along == 0 ? sign : along == 1 ? AROUND[q][0] : sign * AROUND[q][1];
            point[k] = grid->origin[k] + grid->h * (voxel[k] + 0.5 * step);
        }
        project(corner[q], view, point);
    }
    memcpy(half, corner, sizeof half);
    put_triangle(picture, view, half);
    memcpy(half[1], corner[2], sizeof half[1]);
    memcpy(half[2], corner[3], sizeof half[2]);
    put_triangle(picture, view, half);
}

/* Those faces of voxels that have background before them; the hull keeps neighbours within the grid. */
static void render_grid(ms_picture *picture, const ms_view *view, const ms_grid *grid)
{
    const ptrdiff_t stride[3] = {1, grid->n[0], (ptrdiff_t)grid->n[0] * grid->n[1]};
    for (int k = 1; k < grid->n[2] - 1; k++) {
        for (int j = 1; j < grid->n[1] - 1; j++) {
            for (int i = 1; i < grid->n[0] - 1; i++) {
                const uint8_t *at = &grid->inside[ms_grid_index(grid, i, j, k)];
                for (int side = 0; *at && side < 6; side++) {
                    const int sign = side % 2 ? 1 : -1;
                    if (!at[sign * stride[side / 2]]) {
                        put_face(picture, view, grid, (int[3]){i, j, k}, side / 2, sign);
                    }
                }
            }
        }
    }
}

/* A dark line where one part ends and another or nothing begins. */
static void draw_edges(ms_picture *picture, const ms_view *view)
{
    for (int j = view->y; j < view->y + view->size - 1; j++) {
        for (int i = view->x; i < view->x + view->size - 1; i++) {
            const size_t at = (size_t)j * (size_t)picture->width + (size_t)i, below = at + (size_t)picture->width;
            if (picture->part[at] != picture->part[at + 1] || picture->part[at] != picture->part[below]) {
                picture->grey[at] = 40;
            }
        }
    }
}

void ms_render_target(ms_picture *picture, const ms_view *view, const ms_target *target)
{
    if (target->mesh) {
        render_mesh(picture, view, target->mesh);
    } else {
        render_grid(picture, view, &target->grid);
    }
    draw_edges(picture, view);
}

static void put_sphere(ms_picture *picture, const ms_view *view, const ms_sphere *sphere, uint32_t part)
{
    double c[3];
    int x0, x1, y0, y1;
    const double r = view->scale * sphere->radius;
    project(c, view, sphere->centre);
    clip(&x0, &x1, c[0] - r, c[0] + r, view->size);
    clip(&y0, &y1, -c[1] - r, -c[1] + r, view->size);
    for (int j = y0; j < y1; j++) {
        for (int i = x0; i < x1; i++) {
            const double x = i + 0.5 - 0.5 * view->size - c[0], y = 0.5 * view->size - j - 0.5 - c[1];
            const double square = r * r - x * x - y * y;
            if (square > 0) {
                const double normal[3] = {x / r, y / r, sqrt(square) / r};
                const size_t at = (size_t)(view->y + j) * (size_t)picture->width + (size_t)(view->x + i);
                put(picture, at, c[2] + sqrt(square), normal, part);
            }
        }
    }
}

void ms_render_clump(ms_picture *picture, const ms_view *view, const ms_clump *clump)
{
    for (size_t s = 0; s < clump->n_spheres; s++) {
        put_sphere(picture, view, &clump->sphere[s], (uint32_t)s + 1);
    }
    draw_edges(picture, view);
}

static void put_number(uint8_t out[4], uint32_t value)
{
    for (int k = 0; k < 4; k++) {
        out[k] = (uint8_t)(value >> (24 - 8 * k));
    }
}

/* Length, name, contents and checksum of a part of a PNG. */
static void put_chunk(FILE *stream, const char *name, const uint8_t *data, size_t size)
{
    uint8_t number[4];
    uLong sum = crc32(0, (const Bytef *)name, 4);
    put_number(number, (uint32_t)size);
    fwrite(number, 1, 4, stream);
    fwrite(name, 1, 4, stream);
    if (size > 0) {
        fwrite(data, 1, size, stream);
        sum = crc32(sum, data, (uInt)size);
    }
    put_number(number, (uint32_t)sum);
    fwrite(number, 1, 4, stream);
}

static void put_png(FILE *stream, const ms_picture *picture, const uint8_t *packed, size_t size)
{
    uint8_t head[13] = {[8] = 8}; /* 8 bits of grey */
    put_number(head, (uint32_t)picture->width);
    put_number(head + 4, (uint32_t)picture->height);
    fwrite("\x89PNG\r\n\x1a\n", 1, 8, stream);
    put_chunk(stream, "IHDR", head, sizeof head);
    put_chunk(stream, "IDAT", packed, size);
    put_chunk(stream, "IEND", NULL, 0);
}

ms_status ms_render_picture_put(FILE *stream, const ms_picture *picture, ms_error *err)
{
    const size_t width = (size_t)picture->width, height = (size_t)picture->height, raw_size = (width + 1) * height;
    uLongf size = compressBound((uLong)raw_size);
    uint8_t *raw = calloc(raw_size, 1), *packed = malloc(size);
    for (size_t j = 0; raw && j < height; j++) { /* each row begins with 0: it is not filtered */
        memcpy(raw + j * (width + 1) + 1, picture->grey + j * width, width);
    }
    const int done = raw && packed && compress(packed, &size, raw, (uLong)raw_size) == Z_OK;
    if (done) {
        put_png(stream, picture, packed, size);
    }
    free(raw);
    free(packed);
    return done ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for a picture");
}

ms_status ms_render_picture_write(const ms_picture *picture, const char *path, ms_error *err)
{
    ms_output output;
    const ms_status status = ms_output_open(&output, path, err);
    return status == MS_OK ? ms_output_close(&output, ms_render_picture_put(output.stream, picture, err), err) : status;
}
