#include "ms_clump_near.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_vector.h"

/* Level l has 2^l boxes along each axis. Those of the first are handed out to the threads; those of the last one needed
 * are the cells, at least so many for each sphere. */
enum { FIRST_LEVEL = 2, LAST_LEVEL = 6, LEVELS = LAST_LEVEL + 1, CELLS_OF_SPHERE = 2 };
enum { SIDE = 1 << FIRST_LEVEL, BOXES = SIDE * SIDE * SIDE };

/* More spheres than that a cell does not list: then all are looked at. */
enum { MOST = 512 };

/* More than rounding takes off a distance. */
static const double SURE = 1.0005;

struct ms_clump_near_cell {
    uint32_t first, count; /* in the list of the box of the first level that it lies in; 0: all spheres */
};

struct ms_clump_near_list {
    uint16_t *sphere;
    size_t count, room;
};

/* What a thread works with. */
typedef struct near_worker {
    const ms_clump_near *near;
    struct ms_clump_near_list *list; /* of the box of the first level at hand */
    double *away;                    /* of spheres from the centre of a box */
    uint16_t *sphere;                /* of each level n: those near the box at hand, ascending */
    size_t count[LEVELS];
    int out_of_memory;
} near_worker;

static size_t find_near_cell(const ms_clump_near *near, const size_t at[3])
{
    return at[0] + near->cells * (at[1] + near->cells * at[2]);
}

/* The list for a cell. */
static struct ms_clump_near_list *find_list(const ms_clump_near *near, const size_t at[3])
{
    const size_t side = near->cells / SIDE;
    return &near->list[at[0] / side + SIDE * (at[1] / side + SIDE * (at[2] / side))];
}

/* Of the spheres near the box around it those that may be nearest to a place in a box: half its diagonal from the
 * centre, distances differ by no more than that from those there. Of a box within a sphere that one will do. */
static void keep_near_spheres(near_worker *w, int level, const size_t at[3])
{
    const ms_clump_near *near = w->near;
    const uint16_t *from = w->sphere + (size_t)(level - 1) * near->clump->n_spheres;
    uint16_t *to = w->sphere + (size_t)level * near->clump->n_spheres;
    double centre[3], side[3], least = HUGE_VAL;
    for (int a = 0; a < 3; a++) {
        side[a] = near->side[a] * (double)(near->cells >> level);
        centre[a] = near->lo[a] + side[a] * ((double)at[a] + 0.5);
    }
    for (size_t s = 0; s < w->count[level - 1]; s++) {
        const ms_sphere *sphere = &near->clump->sphere[from[s]];
        w->away[s] = sqrt(ms_squared_distance(centre, sphere->centre)) - sphere->radius;
        least = w->away[s] < least ? w->away[s] : least;
    }
    const double reach = SURE * sqrt(ms_dot(side, side)) / 2, most = least < -reach ? least : least + 2 * reach;
    size_t kept = 0;
    for (size_t s = 0; s < w->count[level - 1]; s++) {
        to[kept] = from[s];
        kept += w->away[s] <= most;
    }
    w->count[level] = kept;
}

/* Lists the spheres of a cell. */
static void put_near_cell(near_worker *w, const size_t at[3], const uint16_t *sphere, size_t count)
{
    struct ms_clump_near_list *list = w->list;
    struct ms_clump_near_cell *cell = &w->near->cell[find_near_cell(w->near, at)];
    *cell = (struct ms_clump_near_cell){0, 0};
    if (count > MOST) {
        return;
    }
    if (list->count + count > list->room) {
        const size_t room = 2 * list->room + 4 * MOST;
        uint16_t *larger = realloc(list->sphere, room * sizeof *larger);
        if (!larger) {
            w->out_of_memory = 1;
            return;
        }
        list->sphere = larger;
        list->room = room;
    }
    *cell = (struct ms_clump_near_cell){(uint32_t)list->count, (uint32_t)count};
    memcpy(list->sphere + list->count, sphere, count * sizeof *sphere);
    list->count += count;
}

static void fill_near_box(near_worker *w, int level, const size_t at[3])
{
    keep_near_spheres(w, level, at);
    if (w->near->cells >> level == 1) {
        put_near_cell(w, at, w->sphere + (size_t)level * w->near->clump->n_spheres, w->count[level]);
        return;
    }
    for (size_t part = 0; part < 8; part++) {
        const size_t in[3] = {2 * at[0] + (part & 1), 2 * at[1] + (part >> 1 & 1), 2 * at[2] + (part >> 2)};
        fill_near_box(w, level + 1, in);
    }
}

/* Has all spheres in the list of the level before the first. */
static void open_worker(near_worker *w, const ms_clump_near *near)
{
    const size_t n = near->clump->n_spheres;
    *w = (near_worker){
        .near = near, .away = malloc(n * sizeof *w->away), .sphere = malloc(LEVELS * n * sizeof *w->sphere)};
    w->out_of_memory = !w->away || !w->sphere;
    w->count[FIRST_LEVEL - 1] = n;
    for (size_t s = 0; w->sphere && s < n; s++) {
        w->sphere[(FIRST_LEVEL - 1) * n + s] = (uint16_t)s;
    }
}

/* @return nonzero without memory */
static int fill_all_boxes(const ms_clump_near *near)
{
    int out_of_memory = 0;
#pragma omp parallel reduction(| : out_of_memory)
    {
        near_worker w;
        open_worker(&w, near);
#pragma omp for schedule(dynamic, 1)
        for (size_t box = 0; box < BOXES; box++) {
            const size_t at[3] = {box % SIDE, box / SIDE % SIDE, box / (SIDE * SIDE)};
            w.list = &near->list[box];
            if (!w.out_of_memory) {
                fill_near_box(&w, FIRST_LEVEL, at);
            }
        }
        out_of_memory = w.out_of_memory;
        free(w.away);
        free(w.sphere);
    }
    return out_of_memory;
}

static void find_whole_box(ms_clump_near *near, const ms_mesh *mesh)
{
    double lo[3], hi[3], low[3], high[3];
    ms_clump_box(lo, hi, near->clump);
    if (mesh) {
        ms_mesh_box(low, high, mesh);
    }
    for (int a = 0; a < 3; a++) {
        near->lo[a] = mesh ? fmin(lo[a], low[a]) : lo[a];
        near->side[a] = ((mesh ? fmax(hi[a], high[a]) : hi[a]) - near->lo[a]) / (double)near->cells;
        near->per_side[a] = 1 / near->side[a];
    }
}

ms_status ms_clump_near_build(ms_clump_near *near, const ms_clump *clump, const ms_mesh *mesh, ms_error *err)
{
    int level = FIRST_LEVEL;
    while (level < LAST_LEVEL && (size_t)1 << 3 * level < CELLS_OF_SPHERE * clump->n_spheres) {
        level++;
    }
    *near = (ms_clump_near){.clump = clump, .cells = (size_t)1 << level};
    near->cell = malloc(((size_t)1 << 3 * level) * sizeof *near->cell);
    near->list = calloc(BOXES, sizeof *near->list);
    find_whole_box(near, mesh);
    if (!near->cell || !near->list || fill_all_boxes(near)) {
        ms_clump_near_free(near);
        return ms_fail(err, MS_ERR_NOMEM, "no memory to measure %zu spheres", clump->n_spheres);
    }
    return MS_OK;
}

void ms_clump_near_free(ms_clump_near *near)
{
    for (int box = 0; near->list && box < BOXES; box++) {
        free(near->list[box].sphere);
    }
    free(near->list);
    free(near->cell);
    *near = (ms_clump_near){0};
}

/* The spheres to look at from a place: *count of them; NULL: all. */
static const uint16_t *see_spheres(size_t *count, const ms_clump_near *near, const double place[3])
{
    size_t at[3];
    *count = near->clump->n_spheres;
    for (int a = 0; a < 3; a++) {
        const double cell = (place[a] - near->lo[a]) * near->per_side[a];
        if (!(cell >= 0 && cell < (double)near->cells)) {
            return NULL;
        }
        at[a] = (size_t)cell;
    }
    const struct ms_clump_near_cell *cell = &near->cell[find_near_cell(near, at)];
    if (cell->count == 0) {
        return NULL;
    }
    *count = cell->count;
    return find_list(near, at)->sphere + cell->first;
}

double ms_clump_near_distance(const ms_clump_near *near, const double place[3])
{
    size_t count;
    const uint16_t *seen = see_spheres(&count, near, place);
    double least = HUGE_VAL;
    for (size_t s = 0; s < count && least > 0; s++) {
        const ms_sphere *sphere = &near->clump->sphere[seen ? seen[s] : s];
        const double reach = sphere->radius + least, away = ms_squared_distance(place, sphere->centre);
        if (away < reach * reach) {
            least = sqrt(away) - sphere->radius;
        }
    }
    return fmax(0, least);
}

int ms_clump_near_hides(const ms_clump_near *near, const double point[3], size_t s)
{
    size_t count;
    const uint16_t *seen = see_spheres(&count, near, point);
    for (size_t at = 0; at < count; at++) {
        const size_t other = seen ? seen[at] : at;
        const ms_sphere *sphere = &near->clump->sphere[other];
        const double square = sphere->radius * sphere->radius, away = ms_squared_distance(point, sphere->centre);
        if (away <= square * (1 + 1e-12) && other != s && (other < s || away < square * (1 - 1e-12))) {
            return 1;
        }
    }
    return 0;
}
