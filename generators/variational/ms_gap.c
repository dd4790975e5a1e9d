#include "ms_gap.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_vector.h"

/* Places at most, about, and the least area that one stands for: what lies between is found by ms_gap_largest. */
static const double MOST = 30000, LEAST_AREA = 4;

void ms_gap_close(ms_gap *gap)
{
    free(gap->place);
    free(gap->away);
    free(gap->known);
    free(gap->nearest);
    free(gap->far);
    free(gap->first);
    *gap = (ms_gap){0};
}

/* Keeps what there is where there is no memory. */
static int widen_array(void *array, size_t size)
{
    void **to = array, *wider = realloc(*to, size);
    *to = wider ? wider : *to;
    return wider != NULL;
}

ms_status ms_gap_add(ms_gap *gap, const double place[3], const ms_mirror *mirror, ms_error *err)
{
    if (gap->count == gap->room) {
        const size_t room = 2 * gap->room + 64;
        if (!widen_array(&gap->place, room * sizeof *gap->place) ||
            !widen_array(&gap->away, room * sizeof *gap->away) ||
            !widen_array(&gap->known, room * sizeof *gap->known) ||
            !widen_array(&gap->nearest, room * sizeof *gap->nearest) ||
            !widen_array(&gap->far, room * sizeof *gap->far)) {
            return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu places of the surface", room);
        }
        gap->room = room;
    }
    for (int a = 0; a < 3; a++) {
        gap->place[gap->count][a] = mirror->across[a] ? mirror->at[a] + fabs(place[a] - mirror->at[a]) : place[a];
    }
    gap->known[gap->count++] = -1;
    return MS_OK;
}

/* The grid has a hull of background. */
int ms_gap_is_border(const ms_grid *grid, size_t v)
{
    const size_t nx = (size_t)grid->n[0], nxy = nx * (size_t)grid->n[1];
    return grid->inside[v] && !(grid->inside[v - 1] && grid->inside[v + 1] && grid->inside[v - nx] &&
                                grid->inside[v + nx] && grid->inside[v - nxy] && grid->inside[v + nxy]);
}

static ms_status add_border(ms_gap *gap, const ms_grid *grid, const ms_mirror *mirror, ms_error *err)
{
    const size_t voxels = ms_grid_voxels(grid);
    size_t all = 0, passed = 0;
    ms_status status = MS_OK;
    for (size_t v = 0; v < voxels; v++) {
        all += (size_t)ms_gap_is_border(grid, v);
    }
    const size_t each = (size_t)ceil((double)all / MOST);
    gap->area = (double)each;
    for (size_t v = 0; v < voxels && status == MS_OK; v++) {
        if (ms_gap_is_border(grid, v) && passed++ % each == 0) {
            int voxel[3];
            ms_grid_voxel(voxel, grid->n, v);
            const double at[3] = {voxel[0], voxel[1], voxel[2]};
            status = ms_gap_add(gap, at, mirror, err);
        }
    }
    return status;
}

/* By the R2 sequence, folded from the square; a place for each `area` of all triangles so far. */
static ms_status spread_over_triangles(ms_gap *gap, const ms_target *target, const ms_mirror *mirror, ms_error *err)
{
    double passed = 0.5, given = 0;
    ms_status status = MS_OK;
    for (size_t t = 0; t < target->mesh->n_triangles && status == MS_OK; t++) {
        double corner[3][3], u[3], v[3];
        ms_grid_corners(corner, &target->grid, target->mesh, t);
        for (int a = 0; a < 3; a++) {
            u[a] = corner[1][a] - corner[0][a];
            v[a] = corner[2][a] - corner[0][a];
        }
        const double uv = ms_dot(u, v);
        passed += 0.5 * sqrt(fmax(0, ms_dot(u, u) * ms_dot(v, v) - uv * uv)) / gap->area;
        for (; given + 1 <= passed && status == MS_OK; given++) {
            double s = fmod(1 / 3.0 + given * 0.75487766624669276, 1),
                   w = fmod(1 / 3.0 + given * 0.56984029099805327, 1);
            if (s + w > 1) {
                s = 1 - s;
                w = 1 - w;
            }
            const double at[3] = {corner[0][0] + s * u[0] + w * v[0], corner[0][1] + s * u[1] + w * v[1],
                                  corner[0][2] + s * u[2] + w * v[2]};
            status = ms_gap_add(gap, at, mirror, err);
        }
    }
    return status;
}

ms_status ms_gap_open(ms_gap *gap, const ms_target *target, const ms_mirror *mirror, double bound, size_t most,
                      ms_error *err)
{
    const double h = target->grid.h;
    *gap = (ms_gap){.bound = bound, .aim = bound, .first = malloc((most + 2) * sizeof *gap->first)};
    ms_status status = gap->first ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for %zu spheres", most);
    if (status == MS_OK && target->mesh) {
        gap->area = fmax(ms_mesh_area(target->mesh) / (h * h) / MOST, LEAST_AREA);
        status = spread_over_triangles(gap, target, mirror, err);
    } else if (status == MS_OK) {
        status = add_border(gap, &target->grid, mirror, err);
    }
    if (status != MS_OK) {
        ms_gap_close(gap);
    }
    return status;
}

/* Distance to the nearest sphere, and to the nearest but that one. */
static double measure_nearest(uint32_t *nearest, double *next, const double place[3], const ms_ball *ball, size_t count)
{
    double least = HUGE_VAL, second = HUGE_VAL;
    *nearest = 0;
    for (size_t b = 0; b < count; b++) {
        const double away = sqrt(ms_squared_distance(place, ball[b].centre)) - ball[b].radius;
        if (away < least) {
            second = least;
            least = away;
            *nearest = (uint32_t)b;
        } else if (away < second) {
            second = away;
        }
    }
    if (next) {
        *next = second;
    }
    return least;
}

static int is_far(const ms_gap *gap, size_t p)
{
    return gap->away[p] > gap->aim;
}

void ms_gap_find(ms_gap *gap, const ms_ball *ball, size_t count, double travel)
{
    const int afresh = !(travel < HUGE_VAL);
    gap->travelled = afresh ? 0 : gap->travelled + travel;
#pragma omp parallel for schedule(static)
    for (size_t p = 0; p < gap->count; p++) {
        if (afresh || !(gap->known[p] > gap->travelled)) {
            gap->away[p] = measure_nearest(&gap->nearest[p], NULL, gap->place[p], ball, count);
            gap->known[p] = gap->travelled + gap->aim - gap->away[p];
        }
    }
    memset(gap->first, 0, (count + 1) * sizeof *gap->first);
    for (size_t p = 0; p < gap->count; p++) {
        gap->first[gap->nearest[p]] += is_far(gap, p) != 0;
    }
    size_t sum = 0;
    for (size_t b = 0; b <= count; b++) { /* the ends; counted down below to the beginnings */
        sum += gap->first[b];
        gap->first[b] = sum;
    }
    for (size_t p = gap->count; p-- > 0;) {
        if (is_far(gap, p)) {
            gap->far[--gap->first[gap->nearest[p]]] = (uint32_t)p;
        }
    }
}

double ms_gap_excess(ms_gap *gap, const ms_ball *ball, size_t count)
{
    double sum = 0;
    ms_gap_find(gap, ball, count, HUGE_VAL);
    for (size_t p = 0; p < gap->count; p++) {
        sum += fmax(0, gap->away[p] - gap->aim);
    }
    return sum * gap->area;
}

void ms_gap_losses(double *loss, ms_gap *gap, const ms_ball *ball, size_t count)
{
    memset(loss, 0, count * sizeof *loss);
    for (size_t p = 0; p < gap->count; p++) {
        uint32_t nearest;
        double next;
        const double away = measure_nearest(&nearest, &next, gap->place[p], ball, count);
        loss[nearest] += gap->area * (fmax(0, next - gap->aim) - fmax(0, away - gap->aim));
    }
}
