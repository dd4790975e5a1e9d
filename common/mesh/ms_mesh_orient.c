#include "ms_mesh_orient.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Six times the signed volume of the tetrahedron from `origin` to triangle t. */
static double signed_volume(const ms_mesh *mesh, uint32_t t, const double origin[3])
{
    double p[3][3];
    for (int corner = 0; corner < 3; corner++) {
        for (int k = 0; k < 3; k++) {
            p[corner][k] = mesh->vertex[mesh->triangle[t][corner]][k] - origin[k];
        }
    }
    return p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) + p[0][1] * (p[1][2] * p[2][0] - p[1][0] * p[2][2]) +
           p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0]);
}

static int is_inside_out(const ms_mesh *mesh)
{
    double sum = 0;
    for (uint32_t t = 0; t < mesh->n_triangles; t++) {
        sum += signed_volume(mesh, t, mesh->vertex[0]);
    }
    return sum < 0;
}

/* The walk over the surface, from triangle to triangle across their sides. */
typedef struct shell_walk {
    const ms_mesh *mesh;
    const uint32_t *across;
    uint8_t *flip; /* relative to the shell's first triangle, then to the input */
    ms_shells shells;
    uint32_t queued;  /* in shells.order */
    uint32_t twisted; /* a triangle whose two ways round disagree */
    int is_twisted;
} shell_walk;

#define UNSEEN UINT32_MAX

static void visit_triangle(shell_walk *w, uint32_t t)
{
    for (uint32_t side = 3 * t; side < 3 * t + 3; side++) {
        uint32_t next_side = w->across[side];
        uint32_t next = next_side / 3;
        /* Neighbours agree if they run along their common edge in opposite directions. */
        int same_way = ms_side_rises(w->mesh, side) == ms_side_rises(w->mesh, next_side);
        uint8_t flip = (uint8_t)(w->flip[t] ^ same_way);
        if (w->shells.shell_of[next] == UNSEEN) {
            w->shells.shell_of[next] = w->shells.shell_of[t];
            w->shells.order[w->queued++] = next;
            w->flip[next] = flip;
        } else if (next != t && w->flip[next] != flip) {
            w->twisted = t;
            w->is_twisted = 1;
        }
    }
}

/* Numbers the shells and lists their triangles; w->flip makes each agree with itself. */
static ms_status walk_all(shell_walk *w, ms_error *err)
{
    uint32_t n = (uint32_t)w->mesh->n_triangles;
    ms_shells *shells = &w->shells;
    memset(shells->shell_of, 0xff, n * sizeof *shells->shell_of);
    size_t capacity = 0;
    for (uint32_t seed = 0; seed < n; seed++) {
        if (shells->shell_of[seed] != UNSEEN) {
            continue;
        }
        if (shells->n == capacity) {
            capacity = 2 * capacity + 16;
            ms_shell *more = realloc(shells->shell, capacity * sizeof *more);
            if (!more) {
                return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu pieces of surface", capacity);
            }
            shells->shell = more;
        }
        uint32_t first = w->queued;
        shells->shell_of[seed] = (uint32_t)shells->n;
        shells->order[w->queued++] = seed;
        for (uint32_t k = first; k < w->queued; k++) {
            visit_triangle(w, shells->order[k]);
        }
        shells->shell[shells->n++] = (ms_shell){.first = first, .n = w->queued - first};
    }
    return MS_OK;
}

static void measure_shell(ms_shell *shell, const shell_walk *w)
{
    const ms_mesh *mesh = w->mesh;
    const uint32_t *list = w->shells.order + shell->first;
    /* Any origin gives the same sum; one on the shell keeps it precise. */
    const double *origin = mesh->vertex[mesh->triangle[list[0]][0]];
    for (int k = 0; k < 3; k++) {
        shell->lo[k] = shell->hi[k] = origin[k];
    }
    for (uint32_t i = 0; i < shell->n; i++) {
        double volume = signed_volume(mesh, list[i], origin) / 6;
        shell->volume += w->flip[list[i]] ? -volume : volume;
        for (int corner = 0; corner < 3; corner++) {
            const double *v = mesh->vertex[mesh->triangle[list[i]][corner]];
            for (int k = 0; k < 3; k++) {
                shell->lo[k] = fmin(shell->lo[k], v[k]);
                shell->hi[k] = fmax(shell->hi[k], v[k]);
            }
        }
    }
}

/* Every shell outward first, for only its size matters to the nesting. */
static ms_status settle_nesting(shell_walk *w, ms_mesh_report *report, ms_error *err)
{
    ms_shells *shells = &w->shells;
    for (size_t s = 0; s < shells->n; s++) {
        ms_shell *shell = &shells->shell[s];
        measure_shell(shell, w);
        for (uint32_t i = 0; shell->volume < 0 && i < shell->n; i++) {
            w->flip[shells->order[shell->first + i]] ^= 1;
        }
        shell->volume = fabs(shell->volume);
    }
    ms_status status = ms_mesh_nest(shells, w->mesh, err);
    if (status != MS_OK) {
        return status;
    }
    for (size_t s = 0; s < shells->n; s++) {
        const ms_shell *shell = &shells->shell[s];
        report->cavities += shell->depth % 2;
        for (uint32_t i = 0; i < shell->n; i++) {
            w->flip[shells->order[shell->first + i]] ^= shell->depth % 2;
        }
    }
    return MS_OK;
}

static void apply_flips(ms_mesh *mesh, const uint8_t *flip, ms_mesh_report *report)
{
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        if (flip[t]) {
            uint32_t swap = mesh->triangle[t][1];
            mesh->triangle[t][1] = mesh->triangle[t][2];
            mesh->triangle[t][2] = swap;
            report->flipped++;
        }
    }
}

static ms_status orient_shells(ms_mesh *mesh, shell_walk *w, ms_mesh_report *report, ms_error *err)
{
    report->shells = report->bodies = w->shells.n;
    if (report->odd_edges > 0) {
        return MS_OK;
    }
    if (w->is_twisted) {
        const double *v = mesh->vertex[mesh->triangle[w->twisted][0]];
        return ms_fail(err, MS_ERR_SHAPE,
                       "the surface is one-sided, like a Klein bottle (near %g, %g, %g): it has no inside; mend it in "
                       "a mesh editor",
                       v[0], v[1], v[2]);
    }
    const ms_status status = settle_nesting(w, report, err);
    if (status == MS_OK) {
        apply_flips(mesh, w->flip, report);
        report->bodies = report->shells - report->cavities;
        report->closed = 1;
    }
    return status;
}

static int is_open_shell(const ms_shell *shell, const shell_walk *w, const ms_edges *edges)
{
    int open = 0;
    for (uint32_t i = 0; i < shell->n && !open; i++) {
        for (uint32_t side = 3 * w->shells.order[shell->first + i], k = 0; k < 3; k++) {
            const uint32_t e = edges->edge_of[side + k];
            open |= ms_mesh_edges_is_open(edges, e);
        }
    }
    return open;
}

/* What a shell encloses; of an open one the most that it could. */
static double shell_size(const ms_shell *shell, int open)
{
    const double *lo = shell->lo, *hi = shell->hi;
    return open ? (hi[0] - lo[0]) * (hi[1] - lo[1]) * (hi[2] - lo[2]) : fabs(shell->volume);
}

/* The mark of a shell that goes; its depth is not known yet. */
#define DROPPED SIZE_MAX

static void drop_shells(ms_mesh *mesh, shell_walk *w, const ms_edges *edges, double share, ms_mesh_report *report)
{
    ms_shells *shells = &w->shells;
    double largest = 0;
    for (size_t s = 0; s < shells->n; s++) {
        ms_shell *shell = &shells->shell[s];
        measure_shell(shell, w);
        largest = fmax(largest, shell_size(shell, is_open_shell(shell, w, edges)));
    }
    for (size_t s = 0; s < shells->n; s++) {
        ms_shell *shell = &shells->shell[s];
        const int open = is_open_shell(shell, w, edges);
        if (shell_size(shell, open) < share * largest) {
            shell->depth = DROPPED;
            report->dropped_bodies++;
            report->dropped_volume += open ? 0 : fabs(shell->volume);
        }
    }
    size_t kept = 0;
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        if (shells->shell[shells->shell_of[t]].depth != DROPPED) {
            memmove(mesh->triangle[kept++], mesh->triangle[t], sizeof *mesh->triangle);
        }
    }
    mesh->n_triangles = kept;
}

/* Finds the shells. free_walk in any case. */
static ms_status begin_walk(shell_walk *w, const ms_mesh *mesh, const ms_edges *edges, ms_error *err)
{
    const size_t n = mesh->n_triangles;
    uint32_t *across = malloc(3 * n * sizeof *across);
    *w = (shell_walk){.mesh = mesh, .across = across, .flip = calloc(n, 1)};
    w->shells.order = malloc(n * sizeof *w->shells.order);
    w->shells.shell_of = malloc(n * sizeof *w->shells.shell_of);
    ms_status status = across && w->flip && w->shells.order && w->shells.shell_of
                           ? ms_mesh_link(across, mesh, edges, is_inside_out(mesh), err)
                           : ms_fail(err, MS_ERR_NOMEM, "no memory to orient %zu triangles", n);
    if (status == MS_OK) {
        status = walk_all(w, err);
    }
    free(across);
    w->across = NULL;
    return status;
}

static void free_walk(shell_walk *w)
{
    free(w->flip);
    free(w->shells.order);
    free(w->shells.shell_of);
    free(w->shells.shell);
}

ms_status ms_mesh_orient(ms_mesh *mesh, const ms_edges *edges, ms_mesh_report *report, ms_error *err)
{
    shell_walk w;
    ms_status status = begin_walk(&w, mesh, edges, err);
    if (status == MS_OK) {
        status = orient_shells(mesh, &w, report, err);
    }
    free_walk(&w);
    return status;
}

ms_status ms_mesh_orient_drop(ms_mesh *mesh, const ms_edges *edges, double share, ms_mesh_report *report, ms_error *err)
{
    shell_walk w;
    const ms_status status = begin_walk(&w, mesh, edges, err);
    if (status == MS_OK) {
        drop_shells(mesh, &w, edges, share, report);
    }
    free_walk(&w);
    return status;
}
