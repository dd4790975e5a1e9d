/*
 * MSS. F. Buchele, T. Poeschel, P. Mueller, Multi-sphere shape generator for DEM simulations
 * of complex-shaped particles, arXiv:2603.05877 (2026), Powder Technology. Equation and
 * section numbers are of that paper; docs/methods/mss.md says what it leaves open and how it
 * was decided.
 */
#include "ms_generator_list.h"

#include <stdlib.h>

#include "ms_mss_run.h"

static const ms_option OPTIONS[] = {
    [MS_MSS_VARIANT] = {"variant", MS_OPTION_CHOICE, MS_MSS_BEST, 0, 0, "best|paper", NULL,
                        "best: the maxima whose spheres lower the mismatch most, radii fitted; paper: all maxima of a "
                        "step, radii inscribed, as published"},
    [MS_MSS_SPACING] = {"spacing", MS_OPTION_REAL, 0, 0, 1000, NULL, "voxels",
                        "least distance between the centres of any two spheres (delta_min, section 3.4); 0: from 3 "
                        "(paper: from the largest radius; by gain: from 2) halved down to 1 as maxima run out"},
    [MS_MSS_BOOST] = {"boost", MS_OPTION_INTEGER, 0, 0, 9, NULL, NULL,
                      "w of E* = E + w (E - E~), eq. 25 with w = 1; 0: 5. Paper: w rises up to this where no maximum "
                      "is left; 0: 1"},
    [MS_MSS_POLISH] = {"polish", MS_OPTION_FLAG, 0, 0, 1, NULL, NULL,
                       "at the end each radius anew, given all other spheres; then prefixes are no clumps of their "
                       "own; not with variant=paper"},
    [MS_MSS_OFFSET] = {"radius-offset", MS_OPTION_REAL, 0, -2, 2, NULL, "voxels",
                       "variant=paper alone: added to every radius; the paper adds nothing, 0.5 to 0.75 lowers the "
                       "mismatch"},
    [MS_MSS_ORDER] = {"order", MS_OPTION_CHOICE, MS_MSS_BY_RADIUS, 0, 0, "radius|gain", NULL,
                      "variant=paper alone. radius: all maxima of a step, the largest spheres first (the paper); "
                      "gain: one set of mirror images a step, that of the largest (E - E~) E"},
    [MS_MSS_CONFINE] = {"confine", MS_OPTION_FLAG, 0, 0, 1, NULL, NULL,
                        "no sphere leaves the mesh: radii are at most the distance to the nearest face (section 3.5)"},
    [MS_MSS_PLANES] = {"plane", MS_OPTION_PLANE, 0, 0, 0, NULL, NULL,
                       "a,b,c,d: no sphere crosses the plane a x + b y + c z = d (section 3.5); may be repeated"},
    {0},
};

/* Options that the variant does not have are refused. */
static ms_status check_options(const ms_mss_run *m, ms_error *err)
{
    const int paper = ms_mss_run_option(m, MS_MSS_VARIANT) == MS_MSS_PAPER;
    const ms_target *target = m->run->target;
    if (paper && ms_mss_run_option(m, MS_MSS_POLISH) != 0) {
        return ms_fail(err, MS_ERR_ARG, "polish is not of variant=paper; leave one of them out");
    }
    for (int o = MS_MSS_OFFSET; o <= MS_MSS_ORDER; o++) {
        if (!paper && ms_mss_run_option(m, o) != OPTIONS[o].fallback) {
            return ms_fail(err, MS_ERR_ARG, "%s is an option of variant=paper; add that, or leave it out",
                           OPTIONS[o].name);
        }
    }
    if (ms_mss_run_option(m, MS_MSS_CONFINE) != 0 && (!target->closest || !target->closed)) {
        return ms_fail(err, MS_ERR_ARG, "confine needs a closed mesh; this shape is a volume or an open mesh");
    }
    return MS_OK;
}

static ms_status generate_by_mss(ms_clump *clump, ms_stop_reason *reason, const ms_run *run, ms_error *err)
{
    ms_mss_run m = {.run = run};
    ms_status status = check_options(&m, err);
    if (status == MS_OK) {
        status = ms_mss_field_init(&m.field, run->target, run->settings, err);
    }
    if (status == MS_OK) {
        const int paper = ms_mss_run_option(&m, MS_MSS_VARIANT) == MS_MSS_PAPER;
        status = (paper ? ms_mss_paper_generate : ms_mss_best_generate)(clump, reason, &m, err);
    }
    ms_mss_field_free(&m.field);
    free(m.candidates);
    return status;
}

const ms_generator ms_generator_mss = {
    .name = "mss",
    .summary = "spheres at maxima of the distance field, then of that and how far the spheres fall short of it",
    .source = "F. Buchele, T. Poeschel, P. Mueller, Powder Technology (2026), arXiv:2603.05877",
    .nested = 1,
    .unnested_by = "polish",
    .bytes_per_voxel = 9,    /* E~ 4, first-cover index 2, covered 1, open voxels 1/4, blocks, columns, planes */
    .bytes_per_square = 120, /* the maxima of a sheet, on both lattices */
    .options = OPTIONS,
    .generate = generate_by_mss,
};
