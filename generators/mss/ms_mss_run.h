/** What both variants of MSS work with: fields, candidates, the clump so far. Private to ms_mss. */
#ifndef MS_MSS_RUN_H
#define MS_MSS_RUN_H

#include "ms_generator.h"
#include "ms_mss_coarse.h"
#include "ms_mss_field.h"
#include "ms_mss_select.h"

/** The options, in the order of their table. */
enum {
    MS_MSS_VARIANT,
    MS_MSS_SPACING,
    MS_MSS_BOOST,
    MS_MSS_POLISH,
    MS_MSS_OFFSET,
    MS_MSS_ORDER,
    MS_MSS_CONFINE,
    MS_MSS_PLANES
};
enum { MS_MSS_BEST, MS_MSS_PAPER };
enum { MS_MSS_BY_RADIUS, MS_MSS_BY_GAIN };

typedef struct ms_mss_run {
    const ms_run *run;
    ms_mss_field field;
    ms_mss_candidate *candidates; /* maxima of E* where a sphere may be placed */
    size_t n_candidates;
    double spacing; /* delta_min, in voxels */
    int too_small;  /* a maximum was passed over because its sphere would be too small */
    ms_tally sum;   /* of the spheres so far */
    /* Of a run that sees a target coarsely: how, and the one on the target's own lattice, whose E counts. Else NULL. */
    const ms_mss_coarse *coarse;
    const struct ms_mss_run *own;
    /** The rank of a new candidate; `before`: the one that was at its voxel before E* changed, NULL if none was. */
    double (*rank)(const struct ms_mss_run *m, const ms_mss_candidate *c, const ms_mss_candidate *before);
} ms_mss_run;

static inline double ms_mss_run_option(const ms_mss_run *m, int which)
{
    return m->run->settings->value[which];
}

/** Shrinks a ball to what faces and planes allow (section 3.5); 0 if it becomes too small. */
int ms_mss_run_confine(ms_ball *ball, ms_mss_run *m);

/** E near a maximum of it, by straight lines along the axes; 0 if its voxel is outside. */
double ms_mss_run_e_at(const ms_mss_run *m, const double place[3]);

/** E anywhere, trilinear between the voxels of the target's own lattice; 0 beyond. In voxels of the run. */
double ms_mss_run_e_between(const ms_mss_run *m, const double place[3]);

/**
 * Finds the maxima anew where E* has changed, and keeps all of them away from new spheres.
 *
 * @param first_new the first sphere that was not there at the last call
 */
ms_status ms_mss_run_update(ms_mss_run *m, size_t first_new, ms_error *err);

/** Copies the new spheres to the clump until the stop rule holds. */
ms_status ms_mss_run_accept(ms_clump *clump, ms_stop_reason *reason, ms_mss_run *m, size_t first_new, ms_error *err);

/** Tells the run's listener how many spheres there are, `chosen` of them not yet added. For ms_mss_select_rule. */
void ms_mss_run_report(size_t chosen, void *context);

/** How many spheres the run may still place. */
size_t ms_mss_run_left(const ms_mss_run *m);

/** The variant of the paper: all maxima of a step, radii inscribed. Parameters: as of ms_generator's generate. */
ms_status ms_mss_paper_generate(ms_clump *clump, ms_stop_reason *reason, ms_mss_run *m, ms_error *err);

/** The variant of mskit: the maxima that gain most, each with the radius that suits it best. Parameters likewise. */
ms_status ms_mss_best_generate(ms_clump *clump, ms_stop_reason *reason, ms_mss_run *m, ms_error *err);

#endif
