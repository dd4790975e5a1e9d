/*
 * Parallel thinning by critical kernels: F.-L. Yuan, Combined 3D thinning and greedy algorithm
 * to approximate realistic particles with corrected mechanical properties, Granular Matter 21
 * (2019) 19, algorithm 1; G. Bertrand, M. Couprie, J. Math. Imaging Vis. 48 (2014) 134.
 */
#include "ms_thinning.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "ms_clique.h"

/* What is known of a voxel. */
enum {
    END = 1,   /* of the skeleton: never removed (K of algorithm 1) */
    FREE = 2,  /* simple and not chosen so far: removed at the end of the step (X \ Y) */
    QUEUED = 4 /* in the next layer */
};

typedef struct voxel_list {
    size_t *voxel;
    size_t count, room;
} voxel_list;

typedef struct thinning {
    uint8_t *inside; /* X */
    uint8_t *state;
    const int *n;
    ptrdiff_t row[9];  /* where the rows of a neighbourhood begin, seen from its centre */
    ptrdiff_t face[6]; /* the neighbours at the faces */
    ms_skeleton kind;
    voxel_list layer; /* voxels whose fate may have changed; none of them an END */
    voxel_list next;
    size_t room;      /* of what follows */
    uint32_t *object; /* neighbourhood of each voxel of the layer */
    uint8_t *keep;    /* chosen to stay, by a critical clique of the rank at hand */
} thinning;

static ms_status push_voxel(voxel_list *l, size_t voxel, ms_error *err)
{
    if (l->count == l->room) {
        const size_t room = 2 * l->room + 4096;
        size_t *grown = realloc(l->voxel, room * sizeof *grown);
        if (!grown) {
            return ms_fail(err, MS_ERR_NOMEM, "no memory to thin a layer of %zu voxels; use fewer cells", room);
        }
        l->voxel = grown;
        l->room = room;
    }
    l->voxel[l->count++] = voxel;
    return MS_OK;
}

/* The neighbourhood of a voxel as a word (ms_clique.h): where `flag` is set. */
static uint32_t read_neighbourhood(const thinning *t, const uint8_t *field, size_t voxel, unsigned flag)
{
    uint32_t word = 0;
    for (int r = 8; r >= 0; r--) {
        const uint8_t *at = field + voxel + t->row[r];
        word = word << 3 | ((at[0] & flag) != 0) | (uint32_t)((at[1] & flag) != 0) << 1 |
               (uint32_t)((at[2] & flag) != 0) << 2;
    }
    return word;
}

/* Are all six voxels at the faces inside? */
static int is_interior(const thinning *t, size_t voxel)
{
    for (int f = 0; f < 6; f++) {
        if (!t->inside[voxel + t->face[f]]) {
            return 0;
        }
    }
    return 1;
}

/* The end of a surface or of a curve (2.2, 2.3)? `voxel` is on the border. */
static int is_end(const thinning *t, size_t voxel)
{
    if (t->kind == MS_SKELETON_CURVE) {
        const uint32_t others = read_neighbourhood(t, t->inside, voxel, 1) & ~(1u << MS_CLIQUE_CENTRE);
        return others && !(others & (others - 1));
    }
    for (int f = 0; f < 6; f++) {
        const size_t beside = voxel + t->face[f];
        if (t->inside[beside] && is_interior(t, beside)) {
            return 0;
        }
    }
    return 1;
}

static ms_status make_room_for_voxel(thinning *t, ms_error *err)
{
    if (t->layer.count > t->room) {
        free(t->object);
        free(t->keep);
        t->room = t->layer.count + t->layer.count / 2;
        t->object = malloc(t->room * sizeof *t->object);
        t->keep = malloc(t->room);
    }
    return t->object && t->keep
               ? MS_OK
               : ms_fail(err, MS_ERR_NOMEM, "no memory to thin a layer of %zu voxels; use fewer cells", t->room);
}

/* Finds the simple voxels of the layer, the critical 3-cliques being all others, and moves
 * them to its front. Returns how many there are. */
static size_t find_simple(thinning *t)
{
    const ptrdiff_t count = (ptrdiff_t)t->layer.count;
    size_t simple = 0;
#pragma omp parallel for schedule(static)
    for (ptrdiff_t i = 0; i < count; i++) {
        const size_t voxel = t->layer.voxel[i];
        t->object[i] = read_neighbourhood(t, t->inside, voxel, 1);
        if (ms_clique_is_simple(t->object[i])) {
            t->state[voxel] |= FREE;
        }
    }
    for (size_t i = 0; i < t->layer.count; i++) {
        const size_t voxel = t->layer.voxel[i];
        if (t->state[voxel] & FREE) {
            t->layer.voxel[i] = t->layer.voxel[simple];
            t->layer.voxel[simple] = voxel;
            t->object[simple++] = t->object[i]; /* those of the others are of no more use */
        }
    }
    return simple;
}

/* Keeps one voxel of each critical clique of a rank whose voxels are all free. */
static void keep_cliques(thinning *t, ptrdiff_t simple, int rank)
{
#pragma omp parallel for schedule(static)
    for (ptrdiff_t i = 0; i < simple; i++) {
        const size_t voxel = t->layer.voxel[i];
        t->keep[i] = (t->state[voxel] & FREE) &&
                     ms_clique_keeps(t->object[i], read_neighbourhood(t, t->state, voxel, FREE), rank);
    }
    for (ptrdiff_t i = 0; i < simple; i++) {
        if (t->keep[i]) {
            t->state[t->layer.voxel[i]] &= (uint8_t)~FREE;
        }
    }
}

/* Puts a voxel into the next layer if it may ever be removed. */
static ms_status queue_voxel(thinning *t, size_t voxel, ms_error *err)
{
    if (!t->inside[voxel] || (t->state[voxel] & (END | QUEUED)) || is_interior(t, voxel)) {
        return MS_OK;
    }
    t->state[voxel] |= QUEUED;
    return push_voxel(&t->next, voxel, err);
}

/* Queues the neighbours of a removed voxel, which may have become simple. */
static ms_status queue_around(thinning *t, size_t removed, ms_error *err)
{
    ms_status status = MS_OK;
    for (int r = 0; r < 9; r++) {
        for (int x = 0; x < 3 && status == MS_OK; x++) {
            status = queue_voxel(t, removed + t->row[r] + x, err);
        }
    }
    return status;
}

/* Removes what is still free and lists what depends on it; what was kept by a clique comes up
 * again. */
static ms_status remove_free(size_t *removed, thinning *t, size_t simple, ms_error *err)
{
    ms_status status = MS_OK;
    *removed = 0;
    for (size_t i = 0; i < simple; i++) {
        const size_t voxel = t->layer.voxel[i];
        if (t->state[voxel] & FREE) {
            t->state[voxel] = 0;
            t->inside[voxel] = 0;
            ++*removed;
        }
    }
    t->next.count = 0;
    for (size_t i = 0; i < simple && status == MS_OK; i++) {
        const size_t voxel = t->layer.voxel[i];
        status = t->inside[voxel] ? queue_voxel(t, voxel, err) : queue_around(t, voxel, err);
    }
    return status;
}

/* The next layer becomes the layer, without the ends, which stay for good. A voxel may become the
 * end of a surface without being looked at, by a change two voxels away; but it stays one, and is
 * looked at before it can be removed. */
static void keep_ends(thinning *t)
{
    const ptrdiff_t count = (ptrdiff_t)t->next.count;
    size_t left = 0;
#pragma omp parallel for schedule(static)
    for (ptrdiff_t i = 0; i < count; i++) {
        const size_t voxel = t->next.voxel[i];
        t->state[voxel] = is_end(t, voxel) ? END : 0;
    }
    for (size_t i = 0; i < t->next.count; i++) {
        const size_t voxel = t->next.voxel[i];
        if (!(t->state[voxel] & END)) {
            t->next.voxel[left++] = voxel;
        }
    }
    t->next.count = left;
    const voxel_list swap = t->layer;
    t->layer = t->next;
    t->next = swap;
}

/* One pass of algorithm 1, lines 4 to 13. */
static ms_status thin_layer(size_t *removed, thinning *t, ms_error *err)
{
    ms_status status = make_room_for_voxel(t, err);
    if (status != MS_OK) {
        return status;
    }
    const size_t simple = find_simple(t);
    for (int rank = 2; rank >= 0; rank--) {
        keep_cliques(t, (ptrdiff_t)simple, rank);
    }
    status = remove_free(removed, t, simple, err);
    if (status == MS_OK) {
        keep_ends(t);
    }
    return status;
}

static int is_outermost(const int n[3], int i, int j, int k)
{
    return i == 0 || j == 0 || k == 0 || i == n[0] - 1 || j == n[1] - 1 || k == n[2] - 1;
}

/* All voxels on the border of the set. */
static ms_status list_thinning_border(thinning *t, ms_error *err)
{
    size_t voxel = 0;
    ms_status status = MS_OK;
    for (int k = 0; k < t->n[2]; k++) {
        for (int j = 0; j < t->n[1]; j++) {
            for (int i = 0; i < t->n[0] && status == MS_OK; i++, voxel++) {
                if (!t->inside[voxel]) {
                    continue;
                }
                if (is_outermost(t->n, i, j, k)) {
                    return ms_fail(err, MS_ERR_ARG,
                                   "voxel %d,%d,%d on the rim of the grid is inside; thinning needs "
                                   "a layer of background around the shape",
                                   i, j, k);
                }
                status = is_interior(t, voxel) ? MS_OK : push_voxel(&t->layer, voxel, err);
            }
        }
    }
    return status;
}

ms_status ms_thinning(uint8_t *inside, const int n[3], ms_skeleton kind, ms_error *err)
{
    const ptrdiff_t row = n[0], plane = row * n[1];
    thinning t = {.inside = inside, .n = n, .kind = kind, .face = {-1, 1, -row, row, -plane, plane}};
    for (int r = 0; r < 9; r++) {
        t.row[r] = (r / 3 - 1) * plane + (r % 3 - 1) * row - 1;
    }
    t.state = calloc((size_t)plane * (size_t)n[2], 1);
    ms_status status =
        t.state ? list_thinning_border(&t, err)
                : ms_fail(err, MS_ERR_NOMEM, "no memory to thin %dx%dx%d voxels; use fewer cells", n[0], n[1], n[2]);
    size_t removed = 1;
    while (status == MS_OK && removed > 0 && t.layer.count > 0) {
        status = thin_layer(&removed, &t, err);
    }
    free(t.state);
    free(t.layer.voxel);
    free(t.next.voxel);
    free(t.object);
    free(t.keep);
    return status;
}
