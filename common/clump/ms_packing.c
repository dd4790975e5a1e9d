#include "ms_packing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_quaternion.h"
#include "base/ms_vector.h"

/* Of the largest box, the least edge of a cell: how many cells a box may lie in is bounded by that. */
static const double LEAST_CELL = 1.0 / 32;
static const double STEP = 0.99, LEAST_SCALE = 0.1;

/* A clump as the search sees it. */
typedef struct search_clump {
    const ms_sphere *sphere; /* in the packing */
    double lo[3], hi[3];     /* with half of what is near around it */
} search_clump;

/* A cell that a box lies in. */
typedef struct search_entry {
    double cell[3]; /* whole numbers */
    size_t clump;
} search_entry;

typedef struct packing_search {
    const ms_packing *packing;
    double near, edge;
    ms_sphere *sphere;
    search_clump *clump;
    search_entry *entry;
    size_t n_entries;
} packing_search;

ms_sphere ms_packing_sphere(const ms_placed *placed, size_t s)
{
    ms_sphere sphere;
    ms_quaternion_turn(sphere.centre, placed->turn, placed->clump.sphere[s].centre);
    for (int k = 0; k < 3; k++) {
        sphere.centre[k] = placed->centre[k] + placed->scale * sphere.centre[k];
    }
    sphere.radius = placed->scale * placed->clump.sphere[s].radius;
    return sphere;
}

static void take_in_sphere(double lo[3], double hi[3], const ms_sphere *sphere, double margin)
{
    for (int k = 0; k < 3; k++) {
        lo[k] = fmin(lo[k], sphere->centre[k] - sphere->radius - margin);
        hi[k] = fmax(hi[k], sphere->centre[k] + sphere->radius + margin);
    }
}

void ms_packing_box(double lo[3], double hi[3], const ms_packing *packing)
{
    for (int k = 0; k < 3; k++) {
        lo[k] = HUGE_VAL;
        hi[k] = -HUGE_VAL;
    }
    for (size_t p = 0; p < packing->count; p++) {
        for (size_t s = 0; s < packing->placed[p].clump.n_spheres; s++) {
            const ms_sphere sphere = ms_packing_sphere(&packing->placed[p], s);
            take_in_sphere(lo, hi, &sphere, 0);
        }
    }
}

/* The spheres in their places, and the boxes around them. */
static ms_status set_spheres(packing_search *all, ms_error *err)
{
    size_t spheres = 0, at = 0;
    for (size_t p = 0; p < all->packing->count; p++) {
        spheres += all->packing->placed[p].clump.n_spheres;
    }
    all->sphere = malloc((spheres + 1) * sizeof *all->sphere);
    all->clump = malloc((all->packing->count + 1) * sizeof *all->clump);
    if (!all->sphere || !all->clump) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the places of %zu spheres", spheres);
    }
    for (size_t p = 0; p < all->packing->count; p++) {
        const ms_placed *placed = &all->packing->placed[p];
        search_clump *clump = &all->clump[p];
        *clump = (search_clump){&all->sphere[at], {HUGE_VAL, HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};
        for (size_t s = 0; s < placed->clump.n_spheres; s++, at++) {
            all->sphere[at] = ms_packing_sphere(placed, s);
            take_in_sphere(clump->lo, clump->hi, &all->sphere[at], all->near * placed->size / 2);
        }
    }
    return MS_OK;
}

static void choose_edge(packing_search *all)
{
    double sum = 0, most = 0;
    for (size_t p = 0; p < all->packing->count; p++) {
        double longest = 0;
        for (int k = 0; k < 3; k++) {
            longest = fmax(longest, all->clump[p].hi[k] - all->clump[p].lo[k]);
        }
        sum += longest;
        most = fmax(most, longest);
    }
    all->edge = fmax(sum / (double)all->packing->count, LEAST_CELL * most);
}

static double cell_number(const packing_search *all, double x)
{
    return floor(x / all->edge);
}

/* Each box into the cells that it lies in; without room they are counted. */
static size_t enter_clumps(const packing_search *all, search_entry *entry)
{
    size_t n = 0;
    for (size_t p = 0; p < all->packing->count; p++) {
        const search_clump *c = &all->clump[p];
        for (double z = cell_number(all, c->lo[2]); z <= cell_number(all, c->hi[2]); z++) {
            for (double y = cell_number(all, c->lo[1]); y <= cell_number(all, c->hi[1]); y++) {
                for (double x = cell_number(all, c->lo[0]); x <= cell_number(all, c->hi[0]); x++, n++) {
                    if (entry) {
                        entry[n] = (search_entry){{x, y, z}, p};
                    }
                }
            }
        }
    }
    return n;
}

static int order_of_cells(const search_entry *a, const search_entry *b)
{
    int order = 0;
    for (int k = 2; k >= 0 && order == 0; k--) {
        order = (a->cell[k] > b->cell[k]) - (a->cell[k] < b->cell[k]);
    }
    return order;
}

static int order_of_entries(const void *a, const void *b)
{
    const search_entry *x = a, *y = b;
    const int order = order_of_cells(x, y);
    return order ? order : (x->clump > y->clump) - (x->clump < y->clump);
}

static int reaches_box(const ms_sphere *sphere, const search_clump *box)
{
    int is_in = 1;
    for (int k = 0; k < 3; k++) {
        is_in = is_in && sphere->centre[k] - sphere->radius <= box->hi[k] &&
                sphere->centre[k] + sphere->radius >= box->lo[k];
    }
    return is_in;
}

/* The overlap of two clumps; spheres out of reach do not matter to it. */
static ms_overlap measure_pair(const packing_search *all, size_t first, size_t second, double margin)
{
    const ms_placed *a = &all->packing->placed[first], *b = &all->packing->placed[second];
    ms_overlap overlap = {.first = first, .second = second, .depth = -HUGE_VAL};
    for (size_t i = 0; i < a->clump.n_spheres; i++) {
        ms_sphere near = all->clump[first].sphere[i];
        near.radius += margin;
        if (!reaches_box(&near, &all->clump[second])) {
            continue;
        }
        for (size_t j = 0; j < b->clump.n_spheres; j++) {
            const ms_sphere *s = &all->clump[first].sphere[i], *t = &all->clump[second].sphere[j];
            const double depth = s->radius + t->radius - sqrt(ms_squared_distance(s->centre, t->centre));
            overlap.depth = fmax(overlap.depth, depth);
            overlap.contacts += depth > 0;
        }
    }
    overlap.relative = overlap.depth / fmin(a->size, b->size);
    return overlap;
}

static ms_status append_overlap(ms_overlaps *overlaps, const ms_overlap *overlap, ms_error *err)
{
    if (overlaps->count == overlaps->capacity) {
        const size_t capacity = overlaps->capacity ? 2 * overlaps->capacity : 256;
        ms_overlap *grown = realloc(overlaps->pair, capacity * sizeof *grown);
        if (!grown) {
            return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu pairs of clumps", capacity);
        }
        overlaps->pair = grown;
        overlaps->capacity = capacity;
    }
    overlaps->pair[overlaps->count++] = *overlap;
    return MS_OK;
}

/* Two boxes of one cell. They meet in several; the pair is that of the lowest of these. */
static ms_status take_pair(ms_overlaps *overlaps, const packing_search *all, const search_entry *x,
                           const search_entry *y, ms_error *err)
{
    const search_clump *a = &all->clump[x->clump], *b = &all->clump[y->clump];
    for (int k = 0; k < 3; k++) {
        if (a->lo[k] > b->hi[k] || b->lo[k] > a->hi[k] || cell_number(all, fmax(a->lo[k], b->lo[k])) != x->cell[k]) {
            return MS_OK;
        }
    }
    const double least = fmin(all->packing->placed[x->clump].size, all->packing->placed[y->clump].size);
    const ms_overlap overlap = measure_pair(all, x->clump, y->clump, all->near * least);
    return overlap.relative > -all->near ? append_overlap(overlaps, &overlap, err) : MS_OK;
}

static ms_status walk_cells(ms_overlaps *overlaps, const packing_search *all, ms_error *err)
{
    ms_status status = MS_OK;
    for (size_t e = 0; e < all->n_entries; e++) {
        for (size_t f = e + 1; f < all->n_entries && status == MS_OK; f++) {
            if (order_of_cells(&all->entry[e], &all->entry[f]) != 0) {
                break;
            }
            status = take_pair(overlaps, all, &all->entry[e], &all->entry[f], err);
        }
    }
    return status;
}

static int order_of_pairs(const void *a, const void *b)
{
    const ms_overlap *x = a, *y = b;
    return x->first != y->first ? (x->first > y->first) - (x->first < y->first)
                                : (x->second > y->second) - (x->second < y->second);
}

ms_status ms_packing_overlaps(ms_overlaps *overlaps, const ms_packing *packing, double near, ms_error *err)
{
    packing_search all = {.packing = packing, .near = near};
    *overlaps = (ms_overlaps){0};
    if (packing->count == 0) {
        return MS_OK;
    }
    ms_status status = set_spheres(&all, err);
    if (status == MS_OK) {
        choose_edge(&all);
        all.n_entries = enter_clumps(&all, NULL);
        all.entry = malloc(all.n_entries * sizeof *all.entry);
        status = all.entry ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for %zu cells of clumps", all.n_entries);
    }
    if (status == MS_OK) {
        enter_clumps(&all, all.entry);
        qsort(all.entry, all.n_entries, sizeof *all.entry, order_of_entries);
        status = walk_cells(overlaps, &all, err);
    }
    if (status == MS_OK && overlaps->count) {
        qsort(overlaps->pair, overlaps->count, sizeof *overlaps->pair, order_of_pairs);
    }
    free(all.sphere);
    free(all.clump);
    free(all.entry);
    if (status != MS_OK) {
        ms_packing_overlaps_free(overlaps);
    }
    return status;
}

void ms_packing_overlaps_free(ms_overlaps *overlaps)
{
    free(overlaps->pair);
    *overlaps = (ms_overlaps){0};
}

/* Marks the clumps that are too deep in another one. @return how many pairs */
static size_t mark_deep(char *is_deep, const ms_overlaps *overlaps, double most)
{
    size_t deep = 0;
    for (size_t o = 0; o < overlaps->count; o++) {
        const ms_overlap *pair = &overlaps->pair[o];
        if (pair->relative > most) {
            is_deep[pair->first] = is_deep[pair->second] = 1;
            deep++;
        }
    }
    return deep;
}

static ms_status shrink_marked(ms_packing *packing, const char *is_deep, ms_error *err)
{
    for (size_t p = 0; p < packing->count; p++) {
        packing->placed[p].scale *= is_deep[p] ? STEP : 1;
        if (packing->placed[p].scale < LEAST_SCALE) {
            return ms_fail(err, MS_ERR_LIMIT,
                           "grain %zu would have to shrink to a tenth of its size to come free of another one; is one "
                           "of them there twice?",
                           packing->placed[p].number);
        }
    }
    return MS_OK;
}

ms_status ms_packing_shrink(ms_packing *packing, double most, ms_error *err)
{
    ms_status status = MS_OK;
    for (size_t deep = 1; deep > 0 && status == MS_OK;) {
        ms_overlaps overlaps;
        char *is_deep = calloc(packing->count + 1, 1);
        if (!is_deep) {
            return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu clumps", packing->count);
        }
        status = ms_packing_overlaps(&overlaps, packing, 0, err);
        deep = mark_deep(is_deep, &overlaps, most);
        if (status == MS_OK) {
            status = shrink_marked(packing, is_deep, err);
        }
        ms_packing_overlaps_free(&overlaps);
        free(is_deep);
    }
    return status;
}

void ms_packing_free(ms_packing *packing)
{
    for (size_t p = 0; p < packing->count; p++) {
        free(packing->placed[p].name);
        ms_clump_free(&packing->placed[p].clump);
    }
    free(packing->placed);
    *packing = (ms_packing){0};
}
