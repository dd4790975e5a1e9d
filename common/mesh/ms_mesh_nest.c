#include <math.h>
#include <stdlib.h>

#include "base/ms_vector.h"
#include "ms_bvh.h"
#include "ms_mesh_orient.h"

enum { SAMPLES = 32, DIRECTIONS = 8 };

/* Oblique to the axes and to each other: a ray that grazes an edge along one passes clear of
   it along another. */
static const double direction[DIRECTIONS][3] = {{0.61803, 0.41421, 0.66811},   {-0.53172, 0.73205, 0.42603},
                                                {0.35355, -0.80171, 0.48179},  {0.27183, 0.31416, -0.90963},
                                                {-0.70711, -0.23607, 0.66657}, {0.81649, -0.35267, -0.45713},
                                                {-0.44949, 0.64575, -0.61723}, {-0.57735, -0.60553, -0.54772}};

/* A ray's meeting with a shell other than its own. */
typedef struct hit {
    uint32_t shell;
    int touches; /* the ray begins on the shell: it says nothing of the inside */
} hit;

typedef struct ray {
    const ms_bvh *bvh;
    const uint32_t *shell_of;
    uint32_t own_shell;
    double from[3];
    const double *along;
    hit *hits;
    size_t n_hits, capacity;
    int grazes; /* passes so close to an edge that the count is not to be trusted */
    int out_of_memory;
} ray;

static int meets_box(const ray *r, const ms_bvh_node *node, int c)
{
    double enter = 0;
    double leave = HUGE_VAL;
    double margin = 1e-9 * r->bvh->size;
    for (int k = 0; k < 3; k++) {
        double a = (node->lo[k][c] - margin - r->from[k]) / r->along[k];
        double b = (node->hi[k][c] + margin - r->from[k]) / r->along[k];
        enter = fmax(enter, fmin(a, b));
        leave = fmin(leave, fmax(a, b));
    }
    return enter <= leave;
}

static void add_hit(ray *r, uint32_t shell, int touches)
{
    if (r->n_hits == r->capacity) {
        size_t capacity = 2 * r->capacity + 64;
        hit *more = realloc(r->hits, capacity * sizeof *more);
        if (!more) {
            r->out_of_memory = 1;
            return;
        }
        r->hits = more;
        r->capacity = capacity;
    }
    r->hits[r->n_hits++] = (hit){shell, touches};
}

/* Moeller & Trumbore 1997. */
static void meet_triangle(ray *r, const ms_bvh_triangle *t)
{
    const double margin = 1e-7;
    double p[3], q[3], s[3];
    uint32_t shell = r->shell_of[t->id];
    if (shell == r->own_shell) {
        return;
    }
    ms_cross(p, r->along, t->ac);
    double det = ms_dot(t->ab, p);
    /* Seen edge-on: only its edges can be met, and its neighbours tell that. */
    if (fabs(det) <= 1e-12 * sqrt(ms_dot(t->ab, t->ab) * ms_dot(t->ac, t->ac))) {
        return;
    }
    for (int k = 0; k < 3; k++) {
        s[k] = r->from[k] - t->a[k];
    }
    ms_cross(q, s, t->ab);
    double u = ms_dot(s, p) / det;
    double v = ms_dot(r->along, q) / det;
    double distance = ms_dot(t->ac, q) / det;
    double inside = fmin(fmin(u, v), 1 - u - v);
    if (inside < -margin || distance < -1e-9 * r->bvh->size) {
        return;
    }
    int touches = distance <= 1e-9 * r->bvh->size;
    r->grazes |= inside <= margin && !touches;
    add_hit(r, shell, touches);
}

static void shoot_ray(ray *r)
{
    uint32_t stack[MS_BVH_STACK];
    int waiting = 0;
    stack[waiting++] = 0;
    r->n_hits = 0;
    r->grazes = 0;
    while (waiting > 0 && !r->grazes) {
        const ms_bvh_node *node = &r->bvh->node[stack[--waiting]];
        for (int c = 0; c < 2; c++) {
            if (!meets_box(r, node, c)) {
                continue;
            }
            if (node->count[c] == 0) {
                stack[waiting++] = node->first[c];
            }
            for (uint32_t k = 0; k < node->count[c]; k++) {
                meet_triangle(r, &r->bvh->triangle[node->first[c] + k]);
            }
        }
    }
}

static int compare_hits(const void *a, const void *b)
{
    const hit *x = a;
    const hit *y = b;
    return (x->shell > y->shell) - (x->shell < y->shell);
}

/* The shells met an odd number of times, or touched, in order; one hit stands for each. */
static void reduce_hits(ray *r)
{
    size_t kept = 0;
    if (r->n_hits > 1) {
        qsort(r->hits, r->n_hits, sizeof *r->hits, compare_hits);
    }
    for (size_t begin = 0, end; begin < r->n_hits; begin = end) {
        int touches = 0;
        for (end = begin; end < r->n_hits && r->hits[end].shell == r->hits[begin].shell; end++) {
            touches |= r->hits[end].touches;
        }
        if (touches || (end - begin) % 2) {
            r->hits[kept++] = (hit){r->hits[begin].shell, touches};
        }
    }
    r->n_hits = kept;
}

/* From the middle of a triangle of the shell. Returns 0 if no direction was clear. */
static int shoot_from(ray *r, const ms_mesh *mesh, uint32_t t)
{
    for (int k = 0; k < 3; k++) {
        r->from[k] = 0;
        for (int corner = 0; corner < 3; corner++) {
            r->from[k] += (mesh->vertex[mesh->triangle[t][corner]][k] - r->bvh->centre[k]) / 3;
        }
    }
    for (int d = 0; d < DIRECTIONS; d++) {
        r->along = direction[d];
        shoot_ray(r);
        if (!r->grazes) {
            reduce_hits(r);
            return 1;
        }
    }
    return 0;
}

static int may_hold(const ms_shell *outer, const ms_shell *inner)
{
    int holds = outer->volume > inner->volume;
    for (int k = 0; k < 3; k++) {
        holds = holds && outer->lo[k] <= inner->lo[k] && inner->hi[k] <= outer->hi[k];
    }
    return holds;
}

/* The shells that may hold shell s: in order, and not ruled out by any ray so far. */
typedef struct candidates {
    uint32_t *shell;
    uint8_t *sure; /* a ray from clear of its surface said inside */
    size_t n;
} candidates;

static void first_candidates(candidates *c, const ray *r, const ms_shells *shells, uint32_t s)
{
    c->n = 0;
    for (size_t k = 0; k < r->n_hits; k++) {
        if (may_hold(&shells->shell[r->hits[k].shell], &shells->shell[s])) {
            c->shell[c->n] = r->hits[k].shell;
            c->sure[c->n++] = !r->hits[k].touches;
        }
    }
}

static void narrow_candidates(candidates *c, const ray *r)
{
    size_t kept = 0;
    size_t at = 0;
    for (size_t k = 0; k < c->n; k++) {
        while (at < r->n_hits && r->hits[at].shell < c->shell[k]) {
            at++;
        }
        if (at < r->n_hits && r->hits[at].shell == c->shell[k]) {
            c->shell[kept] = c->shell[k];
            c->sure[kept++] = (uint8_t)(c->sure[k] | !r->hits[at].touches);
        }
    }
    c->n = kept;
}

static size_t depth_of(candidates *c, ray *r, const ms_shells *shells, const ms_mesh *mesh, uint32_t s)
{
    const ms_shell *shell = &shells->shell[s];
    int clear_rays = 0;
    r->own_shell = s;
    c->n = 0;
    for (uint64_t k = 0; k < SAMPLES && k < shell->n && (clear_rays == 0 || c->n > 0); k++) {
        uint64_t step = shell->n < SAMPLES ? k : k * shell->n / SAMPLES;
        if (shoot_from(r, mesh, shells->order[shell->first + step])) {
            if (clear_rays++ == 0) {
                first_candidates(c, r, shells, s);
            } else {
                narrow_candidates(c, r);
            }
        }
    }
    size_t depth = 0;
    for (size_t k = 0; k < c->n; k++) {
        depth += c->sure[k];
    }
    return depth;
}

ms_status ms_mesh_nest(ms_shells *shells, const ms_mesh *mesh, ms_error *err)
{
    if (shells->n < 2) {
        return MS_OK;
    }
    ms_bvh bvh = {0};
    ray r = {.bvh = &bvh, .shell_of = shells->shell_of};
    candidates c = {.shell = malloc(shells->n * sizeof *c.shell), .sure = malloc(shells->n)};
    ms_status status = ms_bvh_build(&bvh, mesh, MS_BVH_FOR_MANY_RAYS, err);
    if (status == MS_OK) {
        for (uint32_t s = 0; c.shell && c.sure && s < shells->n; s++) {
            shells->shell[s].depth = depth_of(&c, &r, shells, mesh, s);
        }
        if (!c.shell || !c.sure || r.out_of_memory) {
            status = ms_fail(err, MS_ERR_NOMEM, "no memory to nest %zu pieces of surface", shells->n);
        }
    }
    free(c.shell);
    free(c.sure);
    free(r.hits);
    ms_bvh_free(&bvh);
    return status;
}
