#include <gsl/gsl_math.h>
#include <math.h>
#include <stdlib.h>

#include "ms_shape_build.h"

ms_status ms_shape_profile_begin(ms_profile *profile, int capacity, double z_top, ms_error *err)
{
    *profile = (ms_profile){.point = malloc((size_t)capacity * sizeof *profile->point), .capacity = capacity};
    if (!profile->point) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for a section of %d points; use a smaller fineness", capacity);
    }
    profile->point[0][0] = 0;
    profile->point[0][1] = z_top;
    profile->n = 1;
    return MS_OK;
}

static void add_point(ms_profile *profile, double radius, double z)
{
    if (profile->n < profile->capacity) {
        profile->point[profile->n][0] = radius;
        profile->point[profile->n][1] = z;
        profile->n++;
    }
}

void ms_shape_profile_line(ms_profile *profile, double radius, double z, int segments)
{
    double radius0 = profile->point[profile->n - 1][0];
    double z0 = profile->point[profile->n - 1][1];
    for (int k = 1; k < segments; k++) {
        double part = (double)k / segments;
        add_point(profile, radius0 + part * (radius - radius0), z0 + part * (z - z0));
    }
    add_point(profile, radius, z);
}

void ms_shape_profile_arc(ms_profile *profile, ms_arc arc, double radius, double z, int segments)
{
    for (int k = 1; k < segments; k++) {
        double angle = arc.from + (arc.to - arc.from) * k / segments;
        add_point(profile, arc.radius * sin(angle), arc.centre_z + arc.radius * cos(angle));
    }
    add_point(profile, radius, z);
}

void ms_shape_profile_mirror(ms_profile *profile)
{
    for (int k = profile->n - 2; k >= 0; k--) {
        add_point(profile, profile->point[k][0], -profile->point[k][1]);
    }
}

void ms_shape_profile_free(ms_profile *profile)
{
    free(profile->point);
    *profile = (ms_profile){0};
}

/* Point q of n on the unit circle, n a multiple of 8. Only the first eighth is computed; the
   rest are its mirror images, so that the symmetries hold to the bit. */
static void circle_point(double out[2], int q, int n)
{
    int quadrant = q / (n / 4);
    int r = q % (n / 4);
    int k = r > n / 8 ? n / 4 - r : r;
    double c = k == n / 8 ? M_SQRT1_2 : cos(2 * M_PI * k / n);
    double s = k == n / 8 ? M_SQRT1_2 : sin(2 * M_PI * k / n);
    if ((r > n / 8) != (quadrant % 2)) {
        double swap = c;
        c = s;
        s = swap;
    }
    out[0] = quadrant == 1 || quadrant == 2 ? 0.0 - c : c;
    out[1] = quadrant >= 2 ? 0.0 - s : s;
}

static double (*make_circle(int n, ms_error *err))[2]
{
    double(*direction)[2] = malloc((size_t)n * sizeof *direction);
    if (!direction) {
        ms_fail(err, MS_ERR_NOMEM, "no memory for a circle of %d points; use a smaller fineness", n);
        return NULL;
    }
    for (int q = 0; q < n; q++) {
        circle_point(direction[q], q, n);
    }
    return direction;
}

/* The quad a b c d, counter-clockwise, as two triangles; `turned` picks the diagonal b-d. */
static void put_quad(uint32_t (*out)[3], const uint32_t quad[4], int turned)
{
    int start = turned ? 1 : 0;
    for (int half = 0; half < 2; half++) {
        out[half][0] = quad[start];
        out[half][1] = quad[(start + 1 + half) % 4];
        out[half][2] = quad[(start + 2 + half) % 4];
    }
}

/* Diagonals change direction from one eighth of the turn to the next: so they are mirror
   images of each other too. */
static int eighth_is_odd(int q, int around)
{
    return (q / (around / 8)) % 2;
}

static void put_revolved_vertices(ms_mesh *mesh, const ms_profile *profile, int around, double (*direction)[2])
{
    size_t at = 0;
    for (int k = 0; k < profile->n; k++) {
        int pole = k == 0 || k == profile->n - 1;
        for (int q = 0; q < (pole ? 1 : around); q++) {
            mesh->vertex[at][0] = pole ? 0 : profile->point[k][0] * direction[q][0];
            mesh->vertex[at][1] = pole ? 0 : profile->point[k][0] * direction[q][1];
            mesh->vertex[at][2] = profile->point[k][1];
            at++;
        }
    }
}

static void put_revolved_triangles(ms_mesh *mesh, int rings, int around)
{
    size_t at = 0;
    uint32_t bottom = (uint32_t)(1 + rings * around);
    for (int q = 0; q < around; q++) {
        int next = (q + 1) % around;
        for (int ring = 0; ring + 1 < rings; ring++) {
            uint32_t upper = (uint32_t)(1 + ring * around);
            uint32_t lower = upper + (uint32_t)around;
            const uint32_t quad[4] = {lower + q, lower + next, upper + next, upper + q};
            put_quad(mesh->triangle + at, quad, eighth_is_odd(q, around) ^ (2 * (ring + 1) > rings));
            at += 2;
        }
        const uint32_t cap[2][3] = {{0, 1 + q, 1 + next}, {bottom, bottom - around + next, bottom - around + q}};
        for (int end = 0; end < 2; end++, at++) {
            for (int corner = 0; corner < 3; corner++) {
                mesh->triangle[at][corner] = cap[end][corner];
            }
        }
    }
}

ms_status ms_shape_revolve(ms_mesh *mesh, const ms_profile *profile, int around, ms_error *err)
{
    *mesh = (ms_mesh){0};
    double(*direction)[2] = make_circle(around, err);
    if (!direction) {
        return MS_ERR_NOMEM;
    }
    int rings = profile->n - 2;
    size_t n_ring_points = (size_t)rings * (size_t)around;
    ms_status status = ms_mesh_alloc(mesh, n_ring_points + 2, 2 * n_ring_points, err);
    if (status == MS_OK) {
        put_revolved_vertices(mesh, profile, around, direction);
        put_revolved_triangles(mesh, rings, around);
    }
    free(direction);
    return status;
}

ms_status ms_shape_ring(ms_mesh *mesh, double ring, double tube, int around, ms_error *err)
{
    *mesh = (ms_mesh){0};
    double(*direction)[2] = make_circle(around, err);
    if (!direction) {
        return MS_ERR_NOMEM;
    }
    size_t points = (size_t)around * (size_t)around;
    ms_status status = ms_mesh_alloc(mesh, points, 2 * points, err);
    for (int q = 0; status == MS_OK && q < around; q++) {
        int next_q = (q + 1) % around;
        for (int j = 0; j < around; j++) {
            int next_j = (j + 1) % around;
            size_t at = (size_t)q * (size_t)around + (size_t)j;
            double reach = ring + tube * direction[j][0];
            mesh->vertex[at][0] = reach * direction[q][0];
            mesh->vertex[at][1] = reach * direction[q][1];
            mesh->vertex[at][2] = tube * direction[j][1];
            const uint32_t quad[4] = {(uint32_t)(q * around + j), (uint32_t)(next_q * around + j),
                                      (uint32_t)(next_q * around + next_j), (uint32_t)(q * around + next_j)};
            put_quad(mesh->triangle + 2 * at, quad, eighth_is_odd(q, around) ^ (2 * j >= around));
        }
    }
    free(direction);
    return status;
}

void ms_shape_z_to_x(ms_mesh *mesh)
{
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        double *p = mesh->vertex[v];
        double z = p[2];
        p[2] = p[1];
        p[1] = p[0];
        p[0] = z;
    }
}
