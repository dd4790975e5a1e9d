/** What the stages of variational work with, and where it starts. Private to variational. */
#ifndef MS_VARIATIONAL_SOLVER_H
#define MS_VARIATIONAL_SOLVER_H

#include "ms_coarse_view.h"
#include "ms_variational_solve.h"

/** A run for one number of spheres. */
typedef struct ms_variational_solver {
    const ms_run *run;
    const ms_variational_settings *settings;
    float *walled; /* the target's distances, cut down to those to planes; NULL without planes */
    ms_coarse_view coarse;
    ms_signed_distance field;
    ms_lattice lattice;
    ms_surface_fit fit;
    double steps, planned; /* of the fit, done and in all: for who watches */
    size_t count, wanted;  /* spheres that are fitted; asked for, mirror images among them */
    ms_ball *ball, *best;  /* in voxels of the target's grid; room for `room` */
    ms_ball *all;          /* with mirror images: room for `room` times the planes' images */
    size_t room;
    ms_ball *given; /* copy of those that were given to start from; NULL: none */
    size_t n_given;
    ms_gap gap; /* the fit's, if it is bounded */
} ms_variational_solver;

/**
 * Takes the spheres that are given, or a cover of inscribed ones, a few more than are wanted.
 *
 * @param[out] s  the caller frees it; on failure, too. Not to be moved: the fit points into it
 * @param      n  spheres that are wanted
 * @return MS_OK; MS_ERR_NOMEM; MS_ERR_LIMIT
 */
ms_status ms_variational_solver_begin(ms_variational_solver *s, const ms_run *run,
                                      const ms_variational_settings *settings, size_t n, ms_error *err);

/** Fills in the mirror images. @return how many spheres there are in all */
size_t ms_variational_solver_expand(ms_variational_solver *s);

/** How many spheres there are in all. */
size_t ms_variational_solver_count(const ms_variational_solver *s);

/** The target at every step-th voxel, as this run sees it. @return as ms_coarse_view_make */
ms_status ms_variational_solver_view(ms_coarse_view *view, const ms_variational_solver *s, int step, ms_error *err);

/** Appends up to `most` inscribed spheres where the union leaves most, mirror images among them.
 * @return as ms_variational_start_cover */
ms_status ms_variational_solver_add_cover(ms_variational_solver *s, size_t most, ms_error *err);

void ms_variational_solver_free(ms_variational_solver *s);

#endif
