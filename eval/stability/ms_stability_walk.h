/** All runs of `mskit stability`: every change of every shape by every method. */
#ifndef MS_STABILITY_WALK_H
#define MS_STABILITY_WALK_H

#include "chart/ms_csv.h"
#include "ms_stability.h"

/** What is tried. Everything is borrowed. */
typedef struct ms_stability_plan {
    const char *const *shape; /* built-in ones by name (ms_hard_shapes.h), or paths */
    size_t n_shapes;
    const ms_methods *methods;
    int wanted[MS_CHANGE_MOST]; /* of ms_changes; the first one is */
    size_t spheres;
    double min_radius, until_dice; /* 0: not asked for */
    uint64_t seed;
    int runs;         /* of each change */
    int keeps_clumps; /* nonzero: with the runs */
    const ms_input_flags *flags;
    ms_input_text said; /* these and the two above, as text */
} ms_stability_plan;

/** Where the rows go. */
typedef struct ms_stability_rows {
    FILE *stream; /* standard output, a device or a pipe, with its header; NULL: the table */
    ms_csv csv;   /* with the header of ms_stability_line */
} ms_stability_rows;

/** How many runs there are. */
size_t ms_stability_count(const ms_stability_plan *plan);

/**
 * Reads a built-in shape or a file, which is a mesh.
 * @param[in,out] flags get the voxel size of a built-in shape
 * @return MS_OK; as ms_hard_shapes_read, ms_input_read; MS_ERR_ARG for a volume
 */
ms_status ms_stability_read_shape(ms_input *input, const char *name, ms_input_flags *flags, ms_error *err);

/** Is every shape there, and a mesh? @return MS_OK; as ms_input_read; MS_ERR_ARG for a volume */
ms_status ms_stability_try_shapes(const ms_stability_plan *plan, ms_error *err);

/**
 * Does the runs side by side (ms_queue.h) and adds a row of each as soon as those before are there, so that a run that
 * is killed can be taken up: rows that the table has already must be the first ones of this plan, and are not run
 * again.
 *
 * @param[out] run ms_stability_count values, in the order of the rows
 * @return MS_OK, also where runs failed; MS_ERR_ARG for rows of another plan; of a shape, as ms_input_read and
 *         ms_input_target; MS_ERR_IO for rows that cannot be written; MS_ERR_NOMEM
 */
ms_status ms_stability_walk(ms_stability_run *run, const ms_stability_plan *plan, ms_stability_rows *rows,
                            ms_error *err);

#endif
