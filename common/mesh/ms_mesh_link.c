#include <math.h>
#include <stdlib.h>

#include "base/ms_vector.h"
#include "ms_mesh_orient.h"

/* A side of a crowded edge, by the angle of its triangle around the edge. */
typedef struct spoke {
    double angle;
    uint32_t side;
    int opens; /* matter lies on the side of larger angles */
} spoke;

static int compare_spokes(const void *a, const void *b)
{
    const spoke *x = a;
    const spoke *y = b;
    if (x->angle != y->angle) {
        return x->angle < y->angle ? -1 : 1;
    }
    return (x->side > y->side) - (x->side < y->side);
}

/* Two vectors across `axis` that make a right-handed frame with it, of equal length. */
static void frame_across(double u[3], double v[3], const double axis[3])
{
    int least = 0;
    for (int k = 1; k < 3; k++) {
        if (fabs(axis[k]) < fabs(axis[least])) {
            least = k;
        }
    }
    double helper[3] = {0};
    helper[least] = 1;
    double length = sqrt(ms_dot(axis, axis));
    ms_cross(u, helper, axis);
    ms_cross(v, axis, u);
    for (int k = 0; k < 3; k++) {
        u[k] *= length;
    }
}

/* Turning about the edge from its lower vertex to its higher, the outward normal of a
   triangle whose side rises points to larger angles: its matter lies at smaller ones. */
static void place_spokes(spoke *list, uint32_t n, const uint32_t *side, const ms_mesh *mesh, int inside_out)
{
    double axis[3], u[3], v[3];
    uint32_t a = ms_mesh_edges_side_from(mesh, side[0]);
    uint32_t b = ms_side_to(mesh, side[0]);
    const double *low = mesh->vertex[a < b ? a : b];
    const double *high = mesh->vertex[a < b ? b : a];
    for (int k = 0; k < 3; k++) {
        axis[k] = high[k] - low[k];
    }
    frame_across(u, v, axis);
    for (uint32_t s = 0; s < n; s++) {
        double arm[3];
        const double *opposite = mesh->vertex[ms_side_opposite(mesh, side[s])];
        for (int k = 0; k < 3; k++) {
            arm[k] = opposite[k] - low[k];
        }
        int rises = ms_side_rises(mesh, side[s]);
        list[s] = (spoke){atan2(ms_dot(arm, v), ms_dot(arm, u)), side[s], rises == (inside_out != 0)};
    }
    qsort(list, n, sizeof *list, compare_spokes);
}

static void join_edges(uint32_t *across, uint32_t a, uint32_t b)
{
    across[a] = b;
    across[b] = a;
}

/* As many spokes open matter as close it: they pair like brackets around the circle. The
   reading starts behind the point where most brackets are closed. */
static void pair_as_brackets(uint32_t *across, const spoke *list, uint32_t n, uint32_t *stack)
{
    long level = 0;
    long lowest = 0;
    uint32_t start = 0;
    for (uint32_t k = 0; k < n; k++) {
        level += list[k].opens ? 1 : -1;
        if (level < lowest) {
            lowest = level;
            start = k + 1;
        }
    }
    size_t depth = 0;
    for (uint32_t k = 0; k < n; k++) {
        const spoke *s = &list[(start + k) % n];
        if (s->opens) {
            stack[depth++] = s->side;
        } else {
            join_edges(across, stack[--depth], s->side);
        }
    }
}

/* Windings that contradict each other say nothing; the pairing with the narrower wedges is
   taken, as of bodies that touch along a sharp edge. */
static void pair_neighbours(uint32_t *across, const spoke *list, uint32_t n)
{
    double even = 0;
    for (uint32_t k = 0; k < n; k += 2) {
        even += list[k + 1].angle - list[k].angle;
    }
    uint32_t start = even <= 3.14159265358979 ? 0 : 1;
    for (uint32_t k = 0; k < n; k += 2) {
        join_edges(across, list[(start + k) % n].side, list[(start + k + 1) % n].side);
    }
}

static void link_crowd(uint32_t *across, const spoke *list, uint32_t n, uint32_t *stack)
{
    uint32_t opening = 0;
    for (uint32_t k = 0; k < n; k++) {
        opening += list[k].opens != 0;
    }
    if (2 * opening == n) {
        pair_as_brackets(across, list, n, stack);
    } else {
        pair_neighbours(across, list, n);
    }
}

ms_status ms_mesh_link(uint32_t *across, const ms_mesh *mesh, const ms_edges *edges, int inside_out, ms_error *err)
{
    uint32_t most = 2;
    for (size_t e = 0; e < edges->n; e++) {
        uint32_t n = edges->start[e + 1] - edges->start[e];
        most = n > most ? n : most;
    }
    spoke *list = malloc(most * sizeof *list);
    uint32_t *stack = malloc(most * sizeof *stack);
    ms_status status = MS_OK;
    if (!list || !stack) {
        status = ms_fail(err, MS_ERR_NOMEM, "no memory for an edge of %lu triangles", (unsigned long)most);
        goto cleanup;
    }
    for (size_t e = 0; e < edges->n; e++) {
        const uint32_t *side = edges->side + edges->start[e];
        uint32_t n = edges->start[e + 1] - edges->start[e];
        if (n == 2 || n % 2) {
            for (uint32_t k = 0; k < n; k++) {
                across[side[k]] = side[(k + 1) % n];
            }
        } else {
            place_spokes(list, n, side, mesh, inside_out);
            link_crowd(across, list, n, stack);
        }
    }
cleanup:
    free(list);
    free(stack);
    return status;
}
