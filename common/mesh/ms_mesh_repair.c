#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ms_mesh_edges.h"
#include "ms_mesh_holes.h"
#include "ms_mesh_orient.h"
#include "ms_mesh_weld.h"

static ms_status check_corners(const ms_mesh *mesh, ms_error *err)
{
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        for (int k = 0; k < 3; k++) {
            if (mesh->triangle[t][k] >= mesh->n_vertices) {
                return ms_fail(err, MS_ERR_ARG, "triangle %zu has corner %lu, but there are only %zu vertices", t,
                               (unsigned long)mesh->triangle[t][k], mesh->n_vertices);
            }
        }
    }
    return MS_OK;
}

/* Removes the triangles with two equal corners (vertices are welded, so that no others have
   coinciding ones). A collinear triangle of three vertices stays: it may fill a gap between
   a long edge and two short ones, and without it the mesh would be open. */
static void drop_degenerate(ms_mesh *mesh, ms_mesh_report *report)
{
    size_t kept = 0;
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        const uint32_t *c = mesh->triangle[t];
        if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) {
            report->dropped_degenerate++;
        } else {
            memmove(mesh->triangle[kept++], c, sizeof *mesh->triangle);
        }
    }
    mesh->n_triangles = kept;
}

/* Which triangles stay, and how many of those meet at each edge. */
typedef struct pruning {
    const ms_mesh *mesh;
    const ms_edges *edges;
    uint8_t *keep;
    uint32_t *count;    /* per edge */
    uint32_t *doubtful; /* triangles of sets that cancelled, by one for each set */
    size_t n_doubtful;
} pruning;

static void set_kept(pruning *p, uint32_t triangle, int keep)
{
    if (p->keep[triangle] == keep) {
        return;
    }
    p->keep[triangle] = (uint8_t)keep;
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t *count = &p->count[p->edges->edge_of[3 * triangle + k]];
        *count = keep ? *count + 1 : *count - 1;
    }
}

/* Of triangles on the same corners, pairs of opposite winding enclose nothing and go; of what
   is then left one stays. */
static void prune_set(pruning *p, const uint32_t *side, uint32_t n, ms_mesh_report *report)
{
    long rising = 0;
    for (uint32_t k = 0; k < n; k++) {
        rising += ms_side_rises(p->mesh, side[k]) ? 1 : -1;
    }
    int wanted = rising != 0;
    for (uint32_t k = 0; k < n; k++) {
        int stays = wanted && ms_side_rises(p->mesh, side[k]) == (rising > 0);
        wanted = wanted && !stays;
        set_kept(p, side[k] / 3, stays);
        report->dropped_duplicate += !stays;
    }
    if (rising == 0) {
        p->doubtful[p->n_doubtful++] = side[0] / 3;
    }
}

static void prune_duplicates(pruning *p, ms_mesh_report *report)
{
    for (size_t e = 0; e < p->edges->n; e++) {
        uint32_t end = p->edges->start[e + 1];
        for (uint32_t begin = p->edges->start[e], next; begin < end; begin = next) {
            uint32_t side = p->edges->side[begin];
            uint32_t opposite = ms_side_opposite(p->mesh, side);
            next = begin + 1;
            while (next < end && ms_side_opposite(p->mesh, p->edges->side[next]) == opposite) {
                next++;
            }
            /* Every set shows at three edges; take it at the one across from its last vertex. */
            int last = opposite > ms_mesh_edges_side_from(p->mesh, side) && opposite > ms_side_to(p->mesh, side);
            if (last && next - begin > 1) {
                prune_set(p, p->edges->side + begin, next - begin, report);
            }
        }
    }
}

static int odd_edges_of(const pruning *p, uint32_t triangle)
{
    int odd = 0;
    for (uint32_t k = 0; k < 3; k++) {
        odd += p->count[p->edges->edge_of[3 * triangle + k]] % 2;
    }
    return odd;
}

/* A cancelled pair may have been one triangle of the surface and its copy with the wrong
   winding. Where the pair leaves a hole (two or three odd edges), one of it comes back. */
static void restore_needed(pruning *p, ms_mesh_report *report)
{
    int restored = 1;
    for (int pass = 0; restored && pass < 8; pass++) {
        restored = 0;
        for (size_t k = 0; k < p->n_doubtful; k++) {
            uint32_t t = p->doubtful[k];
            if (!p->keep[t] && odd_edges_of(p, t) >= 2) {
                set_kept(p, t, 1);
                report->dropped_duplicate--;
                restored = 1;
            }
        }
    }
}

/* Lists the cancelled sets that hang together by edges with `first`; each is listed once. @return how many */
static size_t gather_patch(uint32_t *patch, uint8_t *waiting, const pruning *p, uint32_t first)
{
    size_t n = 0;
    patch[n++] = first;
    waiting[first] = 0;
    for (size_t at = 0; at < n; at++) {
        for (uint32_t k = 0; k < 3; k++) {
            const uint32_t e = p->edges->edge_of[3 * patch[at] + k];
            for (uint32_t s = p->edges->start[e]; s < p->edges->start[e + 1]; s++) {
                const uint32_t t = p->edges->side[s] / 3;
                if (waiting[t]) {
                    waiting[t] = 0;
                    patch[n++] = t;
                }
            }
        }
    }
    return n;
}

static void set_patch_kept(pruning *p, const uint32_t *patch, size_t n, int keep)
{
    for (size_t i = 0; i < n; i++) {
        set_kept(p, patch[i], keep);
    }
}

static size_t odd_edges_of_patch(const pruning *p, const uint32_t *patch, size_t n)
{
    size_t odd = 0;
    for (size_t i = 0; i < n; i++) {
        odd += (size_t)odd_edges_of(p, patch[i]);
    }
    return odd;
}

/* The same with what cancelled as a whole, drawn from both sides: one side comes back where that closes more edges than
   it opens; and if nothing else is left, where it opens none. `patch` has room for all sets. */
static void restore_patches(pruning *p, uint32_t *patch, uint8_t *waiting, ms_mesh_report *report)
{
    int nothing_left = 1;
    for (size_t t = 0; t < p->mesh->n_triangles; t++) {
        nothing_left &= !p->keep[t];
        waiting[t] = 0;
    }
    for (size_t k = 0; k < p->n_doubtful; k++) {
        waiting[p->doubtful[k]] = !p->keep[p->doubtful[k]];
    }
    for (size_t k = 0; k < p->n_doubtful; k++) {
        if (waiting[p->doubtful[k]]) {
            const size_t n = gather_patch(patch, waiting, p, p->doubtful[k]);
            const size_t without = odd_edges_of_patch(p, patch, n);
            set_patch_kept(p, patch, n, 1);
            const size_t with = odd_edges_of_patch(p, patch, n);
            const int closes = with < without || (nothing_left && with == 0);
            set_patch_kept(p, patch, n, closes);
            report->dropped_duplicate -= closes ? n : 0;
        }
    }
}

/* A fin hangs by one edge on an edge of two or more others, its other two edges free: like
   the collinear triangles that some programs leave beside an edge. It bounds nothing. */
static void prune_fins(pruning *p, ms_mesh_report *report)
{
    for (uint32_t t = 0; t < p->mesh->n_triangles; t++) {
        int free_edges = 0;
        int joined_edges = 0;
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t count = p->count[p->edges->edge_of[3 * t + k]];
            free_edges += count == 1;
            joined_edges += count >= 3;
        }
        if (p->keep[t] && free_edges == 2 && joined_edges == 1) {
            set_kept(p, t, 0);
            report->dropped_degenerate++;
        }
    }
}

static void remove_unkept(ms_mesh *mesh, const uint8_t *keep)
{
    size_t kept = 0;
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        if (keep[t]) {
            memmove(mesh->triangle[kept++], mesh->triangle[t], sizeof *mesh->triangle);
        }
    }
    mesh->n_triangles = kept;
}

static ms_status prune_mesh(ms_mesh *mesh, const ms_edges *edges, ms_mesh_report *report, ms_error *err)
{
    size_t n = mesh->n_triangles;
    pruning p = {.mesh = mesh, .edges = edges};
    p.keep = malloc(n + 1);
    p.count = malloc((edges->n + 1) * sizeof *p.count);
    p.doubtful = malloc((n + 1) * sizeof *p.doubtful);
    uint32_t *patch = malloc((n + 1) * sizeof *patch);
    uint8_t *waiting = malloc(n + 1);
    ms_status status = MS_OK;
    if (p.keep && p.count && p.doubtful && patch && waiting) {
        memset(p.keep, 1, n);
        for (size_t e = 0; e < edges->n; e++) {
            p.count[e] = edges->start[e + 1] - edges->start[e];
        }
        prune_duplicates(&p, report);
        restore_needed(&p, report);
        restore_patches(&p, patch, waiting, report);
        prune_fins(&p, report);
        remove_unkept(mesh, p.keep);
    } else {
        status = ms_fail(err, MS_ERR_NOMEM, "no memory to check %zu triangles", n);
    }
    free(p.keep);
    free(p.count);
    free(p.doubtful);
    free(patch);
    free(waiting);
    return status;
}

/* Vertices that no triangle uses would still count in the box. The others keep their order. */
static ms_status drop_unused_vertices(ms_mesh *mesh, ms_error *err)
{
    uint32_t *number = calloc(mesh->n_vertices + 1, sizeof *number);
    if (!number) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory to check %zu vertices", mesh->n_vertices);
    }
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        for (int k = 0; k < 3; k++) {
            number[mesh->triangle[t][k]] = 1;
        }
    }
    size_t kept = 0;
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        if (number[v]) {
            number[v] = (uint32_t)kept;
            memmove(mesh->vertex[kept++], mesh->vertex[v], sizeof *mesh->vertex);
        }
    }
    mesh->n_vertices = kept;
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        for (int k = 0; k < 3; k++) {
            mesh->triangle[t][k] = number[mesh->triangle[t][k]];
        }
    }
    free(number);
    return MS_OK;
}

static void count_edges(ms_mesh_report *report, const ms_edges *edges)
{
    for (size_t e = 0; e < edges->n; e++) {
        uint32_t n = edges->start[e + 1] - edges->start[e];
        report->open_edges += n == 1;
        report->nonmanifold_edges += n > 2;
        report->odd_edges += n % 2;
    }
}

static ms_status check_mending(const ms_mesh_mending *how, ms_error *err)
{
    if (how->weld != 0 && !(how->weld >= MS_MESH_LEAST_WELD && how->weld <= MS_MESH_MOST_WELD)) {
        return ms_fail(err, MS_ERR_ARG, "corners cannot be joined within %g of the mesh's length; %g to %g is allowed",
                       how->weld, MS_MESH_LEAST_WELD, MS_MESH_MOST_WELD);
    }
    if (!(how->drop_bodies >= 0 && how->drop_bodies <= 1)) {
        return ms_fail(err, MS_ERR_ARG, "%g is no share of the largest body, from 0 to 1", how->drop_bodies);
    }
    return MS_OK;
}

/* Of what is used: a stray vertex does not count. */
static double longest_side(const ms_mesh *mesh)
{
    double side = 0;
    for (int k = 0; k < 3; k++) {
        double lo = HUGE_VAL, hi = -HUGE_VAL;
        for (size_t c = 0; c < 3 * mesh->n_triangles; c++) {
            const double x = mesh->vertex[mesh->triangle[c / 3][c % 3]][k];
            lo = fmin(lo, x);
            hi = fmax(hi, x);
        }
        side = fmax(side, hi - lo);
    }
    return side;
}

static int has_odd_edge(const ms_edges *edges)
{
    int odd = 0;
    for (size_t e = 0; e < edges->n && !odd; e++) {
        odd = ms_mesh_edges_is_open(edges, e);
    }
    return odd;
}

static ms_status rebuild_edges(ms_edges *edges, const ms_mesh *mesh, ms_error *err)
{
    ms_mesh_edges_free(edges);
    return ms_edges_build(edges, mesh, err);
}

static ms_status join_corners(ms_mesh *mesh, ms_edges *edges, const ms_mesh_mending *how, ms_mesh_report *report,
                              ms_error *err)
{
    const double tolerance = has_odd_edge(edges) ? how->weld * longest_side(mesh) : 0;
    if (!(tolerance > 0)) {
        return MS_OK;
    }
    ms_status status = ms_mesh_weld(mesh, &report->joined, edges, tolerance, err);
    return status == MS_OK && report->joined > 0 ? rebuild_edges(edges, mesh, err) : status;
}

/* The edges are those of the mesh before and after. */
static ms_status prune_and_rebuild(ms_mesh *mesh, ms_edges *edges, ms_mesh_report *report, ms_error *err)
{
    const size_t n_before = mesh->n_triangles, n_dropped = report->dropped_degenerate + report->dropped_duplicate;
    ms_status status = prune_mesh(mesh, edges, report, err);
    if (status == MS_OK && mesh->n_triangles < n_before) {
        status = rebuild_edges(edges, mesh, err);
    }
    if (status == MS_OK && mesh->n_triangles == 0) {
        status = ms_fail(err, MS_ERR_SHAPE, "no triangle is left: all %zu are degenerate or cancel in pairs",
                         n_before + n_dropped);
    }
    return status;
}

/* What fills a hole may cancel what was there: a single triangle is a hole around itself. */
static ms_status fill_holes(ms_mesh *mesh, ms_edges *edges, const ms_mesh_mending *how, ms_mesh_report *report,
                            ms_error *err)
{
    ms_status status = has_odd_edge(edges) ? ms_mesh_holes(mesh, report, edges, how->fill_holes, err) : MS_OK;
    if (status == MS_OK && report->filled > 0) {
        status = rebuild_edges(edges, mesh, err);
        status = status == MS_OK ? prune_and_rebuild(mesh, edges, report, err) : status;
    }
    return status;
}

static ms_status drop_bodies(ms_mesh *mesh, ms_edges *edges, const ms_mesh_mending *how, ms_mesh_report *report,
                             ms_error *err)
{
    if (!(how->drop_bodies > 0)) {
        return MS_OK;
    }
    ms_status status = ms_mesh_orient_drop(mesh, edges, how->drop_bodies, report, err);
    if (status == MS_OK && report->dropped_bodies > 0) {
        status = rebuild_edges(edges, mesh, err);
        status = status == MS_OK ? ms_mesh_holes(mesh, report, edges, 0, err) : status;
    }
    return status;
}

ms_status ms_mesh_mend(ms_mesh *mesh, ms_mesh_report *report, const ms_mesh_mending *how, ms_error *err)
{
    *report = (ms_mesh_report){0};
    ms_edges edges = {0};
    ms_status status = check_corners(mesh, err);
    if (status == MS_OK) {
        status = check_mending(how, err);
    }
    if (status != MS_OK) {
        return status;
    }
    drop_degenerate(mesh, report);
    status = ms_edges_build(&edges, mesh, err);
    if (status == MS_OK) {
        status = join_corners(mesh, &edges, how, report, err);
    }
    if (status == MS_OK) {
        status = prune_and_rebuild(mesh, &edges, report, err);
    }
    if (status == MS_OK) {
        status = fill_holes(mesh, &edges, how, report, err);
    }
    if (status == MS_OK) {
        status = drop_bodies(mesh, &edges, how, report, err);
    }
    if (status == MS_OK) {
        status = drop_unused_vertices(mesh, err);
    }
    if (status == MS_OK) {
        count_edges(report, &edges);
        status = ms_mesh_orient(mesh, &edges, report, err);
    }
    ms_mesh_edges_free(&edges);
    return status;
}

ms_status ms_mesh_repair(ms_mesh *mesh, ms_mesh_report *report, ms_error *err)
{
    return ms_mesh_mend(mesh, report, &(ms_mesh_mending){0}, err);
}
