#include "ms_change.h"

#include <math.h>

#include "base/ms_choice.h"

static double level_none(uint64_t seed, int number, int runs)
{
    (void)seed, (void)number, (void)runs;
    return 0;
}

static double level_number(uint64_t seed, int number, int runs)
{
    (void)seed, (void)runs;
    return number;
}

static double level_seed(uint64_t seed, int number, int runs)
{
    (void)runs;
    return (double)seed + number;
}

/* Spread over all the rotations but the one that leaves everything where it is. */
static double level_axes(uint64_t seed, int number, int runs)
{
    (void)seed;
    const int most = MS_MOTION_AXIS_TURNS - 1;
    return 1 + (number - 1) * most / (runs < most ? runs : most);
}

static ms_status change_nothing(ms_changed *c, const ms_change_order *order, ms_error *err)
{
    (void)c, (void)order, (void)err;
    return MS_OK;
}

static ms_status turn_axes(ms_changed *c, const ms_change_order *order, ms_error *err)
{
    (void)err;
    c->motion = ms_perturb_motion_axis_turn((int)order->level);
    return MS_OK;
}

static ms_status turn_randomly(ms_changed *c, const ms_change_order *order, ms_error *err)
{
    return ms_perturb_motion_random_turn(&c->motion, (uint64_t)order->level, err);
}

/* Parts of a voxel that fill the cube evenly: multiples of the powers of 1 / 1.2207, the root of x^4 = x + 1. */
static double find_part(double level, int axis)
{
    static const double STEP[3] = {0.81917251339616444, 0.67104360670378921, 0.54970047790197029};
    return fmod(level * STEP[axis], 1);
}

/* The grid is laid around the box of the shape, so that it goes with it: what is left is rounding. */
static ms_status shift_voxels(ms_changed *c, const ms_change_order *order, ms_error *err)
{
    (void)err;
    for (int a = 0; a < 3; a++) {
        c->motion.shift[a] = c->voxel_size * find_part(order->level, a);
    }
    return MS_OK;
}

static ms_status move_lattice(ms_changed *c, const ms_change_order *order, ms_error *err)
{
    (void)err;
    for (int a = 0; a < 3; a++) {
        c->lattice[a] = find_part(order->level, a);
    }
    return MS_OK;
}

static ms_status change_voxel_size(ms_changed *c, const ms_change_order *order, ms_error *err)
{
    (void)err;
    c->voxel_size /= order->level;
    return MS_OK;
}

static ms_status add_noise(ms_changed *c, const ms_change_order *order, ms_error *err)
{
    return ms_perturb_noise(&c->mesh, order->level * order->diameter, order->seed + (uint64_t)order->number, err);
}

static ms_status refine_mesh(ms_changed *c, const ms_change_order *order, ms_error *err)
{
    ms_status status = MS_OK;
    for (int k = 0; k < (int)order->level && status == MS_OK; k++) {
        ms_mesh finer;
        status = ms_perturb_refine(&finer, &c->mesh, err);
        if (status == MS_OK) {
            ms_mesh_free(&c->mesh);
            c->mesh = finer;
        }
    }
    return status;
}

static ms_status decimate_mesh(ms_changed *c, const ms_change_order *order, ms_error *err)
{
    ms_mesh coarser;
    ms_mesh_report report;
    const double cell = order->level * order->diameter;
    ms_status status = ms_perturb_decimate(&coarser, &report, &c->mesh, cell, err);
    if (status == MS_OK && order->closed && !report.closed) {
        ms_mesh_free(&coarser);
        return ms_fail(err, MS_ERR_SHAPE, "with its vertices joined in cells of %g the mesh is open: %zu odd edges",
                       cell, report.odd_edges);
    }
    if (status == MS_OK) {
        ms_mesh_free(&c->mesh);
        c->mesh = coarser;
    }
    return status;
}

static ms_status change_seed(ms_changed *c, const ms_change_order *order, ms_error *err)
{
    (void)err;
    c->seed = (uint64_t)order->level;
    return MS_OK;
}

static ms_status change_order(ms_changed *c, const ms_change_order *order, ms_error *err)
{
    return ms_perturb_order(&c->mesh, (uint64_t)order->level, err);
}

static ms_status change_threads(ms_changed *c, const ms_change_order *order, ms_error *err)
{
    (void)err;
    c->threads = (int)order->level;
    return MS_OK;
}

const ms_change ms_changes[] = {
    {.name = "none", .level = "0", .most = 1, .level_of = level_none, .apply = change_nothing},
    {.name = "axes",
     .level = "number of the rotation of the cube, 1 to 23",
     .most = MS_MOTION_AXIS_TURNS - 1,
     .level_of = level_axes,
     .apply = turn_axes},
    {.name = "rotation", .level = "seed of the random rotation", .level_of = level_seed, .apply = turn_randomly},
    {.name = "shift",
     .level = "number of the shift by parts of a voxel",
     .level_of = level_number,
     .apply = shift_voxels},
    {.name = "lattice",
     .level = "number of the shift of the lattice by parts of a voxel",
     .level_of = level_number,
     .apply = move_lattice},
    {.name = "resolution",
     .level = "cells over those asked for, 0.5 to 2",
     .axis = "cells / cells asked for",
     .lo = 0.5,
     .hi = 2,
     .apply = change_voxel_size},
    {.name = "noise",
     .level = "amplitude of the vertices' displacement, 0.001 to 0.03 d_eq",
     .axis = "amplitude of the noise / d_eq",
     .lo = 0.001,
     .hi = 0.03,
     .apply = add_noise},
    {.name = "refine",
     .level = "times that each triangle was cut in four, 1 or 2",
     .most = 2,
     .level_of = level_number,
     .apply = refine_mesh},
    {.name = "decimate",
     .level = "cell in which vertices were joined, 0.02 to 0.2 d_eq",
     .axis = "cell of joined vertices / d_eq",
     .lo = 0.02,
     .hi = 0.2,
     .apply = decimate_mesh},
    {.name = "seed", .level = "seed of the method", .level_of = level_seed, .apply = change_seed},
    {.name = "order",
     .level = "seed of the order of vertices and triangles",
     .level_of = level_seed,
     .apply = change_order},
    {.name = "threads", .level = "number of threads", .level_of = level_number, .apply = change_threads},
    {0},
};
_Static_assert(sizeof ms_changes / sizeof *ms_changes <= MS_CHANGE_MOST, "room for a word on each perturbation");

const ms_change *ms_change_find(const char *name, ms_error *err)
{
    ms_choice choice = {.typed = name};
    for (const ms_change *change = ms_changes + 1; change->name; change++) {
        if (ms_choice_offer(&choice, change->name)) {
            return change;
        }
    }
    ms_choice_fail(&choice, err, "there is no perturbation '%s'", name);
    return NULL;
}

int ms_change_runs(const ms_change *change, int runs)
{
    return change->most && change->most < runs ? change->most : runs;
}

/* Step `number` of `runs` from lo to hi, in equal ratios; of a single one the middle. */
static double climb_ladder(double lo, double hi, int number, int runs)
{
    return runs < 2 ? sqrt(lo * hi) : lo * pow(hi / lo, (double)(number - 1) / (runs - 1));
}

double ms_change_level(const ms_change *change, uint64_t seed, int number, int runs)
{
    return change->lo > 0 ? climb_ladder(change->lo, change->hi, number, runs)
                          : change->level_of(seed, number, ms_change_runs(change, runs));
}
