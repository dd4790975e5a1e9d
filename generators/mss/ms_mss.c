/*
 * MSS. F. Buchele, T. Poeschel, P. Mueller, Multi-sphere shape generator for DEM simulations
 * of complex-shaped particles, arXiv:2603.05877 (2026), Powder Technology. Equation and
 * section numbers are of that paper; docs/methods/mss.md says what it leaves open and how it
 * was decided.
 */
#include "ms_mss.h"

#include <stdlib.h>

#include "ms_mss_run.h"

static const ms_option OPTIONS[] = {
    [MS_MSS_VARIANT] = {"variant", MS_OPTION_CHOICE, MS_MSS_BEST, 0, 0, "best|paper", NULL,
                        "best: the maxima that gain most, each with the radius that suits it best; paper: the text of "
                        "the paper"},
    [MS_MSS_SPACING] = {"spacing", MS_OPTION_REAL, 0, 0, 1000, NULL, "voxels",
                        "least distance between the centres of any two spheres (delta_min, section 3.4); 0: as large "
                        "as leaves maxima, halved from the largest radius down to 1 voxel (gain: from 2), spheres "
                        "smaller across waiting"},
    [MS_MSS_BOOST] = {"boost", MS_OPTION_INTEGER, 1, 1, 5, NULL, NULL,
                      "where no maximum is left, E* = E + w (E - E~) is tried with w up to this; the paper has w = 1 "
                      "(eq. 25)"},
    [MS_MSS_POLISH] = {"polish", MS_OPTION_FLAG, 0, 0, 1, NULL, NULL, "radii anew at the end"},
    [MS_MSS_OFFSET] = {"radius-offset", MS_OPTION_REAL, 0, -2, 2, NULL, "voxels",
                       "added to every radius; the paper adds nothing, 0.5 to 0.75 lowers the mismatch"},
    [MS_MSS_ORDER] = {"order", MS_OPTION_CHOICE, MS_MSS_BY_RADIUS, 0, 0, "radius|gain", NULL,
                      "radius: all maxima of a step, the largest spheres first (the paper); gain: one set of mirror "
                      "images a step, that of the largest (E - E~) E"},
    [MS_MSS_CONFINE] = {"confine", MS_OPTION_FLAG, 0, 0, 1, NULL, NULL,
                        "no sphere leaves the mesh: radii are at most the distance to the nearest face (section 3.5)"},
    [MS_MSS_PLANES] = {"plane", MS_OPTION_PLANE, 0, 0, 0, NULL, NULL,
                       "a,b,c,d: no sphere crosses the plane a x + b y + c z = d (section 3.5); may be repeated"},
    {0},
};

static ms_status generate_by_mss(ms_clump *clump, ms_stop_reason *reason, const ms_run *run, ms_error *err)
{
    ms_mss_run m = {.run = run};
    if (run->settings->value[MS_MSS_CONFINE] != 0 && (!run->target->closest || !run->target->closed)) {
        return ms_fail(err, MS_ERR_ARG, "confine needs a closed mesh; this shape is a volume or an open mesh");
    }
    ms_status status = ms_mss_field_init(&m.field, run->target, run->settings, err);
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
    .summary = "spheres at the maxima of the distance field, then of twice it less that of the spheres",
    .source = "F. Buchele, T. Poeschel, P. Mueller, Powder Technology (2026), arXiv:2603.05877",
    .nested = 1,
    .options = OPTIONS,
    .generate = generate_by_mss,
};
