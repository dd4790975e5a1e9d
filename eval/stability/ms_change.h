/** The table of perturbations: a row for each, with its levels and what it does. */
#ifndef MS_CHANGE_H
#define MS_CHANGE_H

#include <stdint.h>

#include "mesh/ms_mesh.h"
#include "ms_perturb.h"

struct ms_change;

/** What a change may change. It begins as the shape and the run are without it. */
typedef struct ms_changed {
    ms_mesh mesh;
    ms_motion motion;  /* of the mesh, after all else; undone on the spheres */
    double lattice[3]; /* how far the lattice is moved under the shape, voxels */
    uint64_t seed;     /* of the method */
    double voxel_size;
    int threads;
} ms_changed;

/** What a change is told. Everything is borrowed. */
typedef struct ms_change_order {
    double level;
    int number;      /* of the run, from 1 */
    uint64_t seed;   /* of all runs */
    double diameter; /* of the ball of the shape's volume, d_eq */
    int closed;      /* is the mesh? then it has to stay so */
} ms_change_order;

/** One perturbation. */
typedef struct ms_change {
    const char *name;  /* what --perturb takes */
    const char *level; /* what says how large it is */
    const char *axis;  /* what the chart of D over the level says at its axis; NULL: no chart */
    int most;          /* different levels there are; 0: any number */
    double lo, hi;     /* levels from lo to hi in equal ratios; 0: as level_of says */
    /** REQUIRED without lo and hi. @param seed of all runs @param runs as many levels as are asked for */
    double (*level_of)(uint64_t seed, int number, int runs);
    /**
     * REQUIRED. Changes something, or fails.
     * @return MS_OK; an error says why the shape cannot be changed so: no word on the method
     */
    ms_status (*apply)(ms_changed *changed, const ms_change_order *order, ms_error *err);
} ms_change;

/** The first one changes nothing: what the others are compared with. A row with a NULL name ends them. */
extern const ms_change ms_changes[];

/* Room for a word on each of them. */
enum { MS_CHANGE_MOST = 32 };

/** @return one of ms_changes but the first; NULL with a message that lists the names */
const ms_change *ms_change_find(const char *name, ms_error *err);

/** How many different levels there are, of so many asked for: not all changes have as many. */
int ms_change_runs(const ms_change *change, int runs);

/** The level of a run. @param number from 1 to ms_change_runs */
double ms_change_level(const ms_change *change, uint64_t seed, int number, int runs);

#endif
