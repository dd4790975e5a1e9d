/** Masses that are given and masses that are solved for. */
#ifndef DENSITY_SAMPLES_H
#define DENSITY_SAMPLES_H

#include <float.h>

#include "body_samples.h"
#include "clump/ms_density.h"
#include "clump_samples.h"

static const ms_density_options DEFAULTS = {0};
static const ms_density_options NO_TOLERANCE = {.centre_tolerance = DBL_MIN};

static inline void set_masses(ms_clump *clump, const double *mass)
{
    assert_int_equal(ms_clump_alloc_masses(clump, NULL), MS_OK);
    memcpy(clump->mass, mass, clump->n_spheres * sizeof *mass);
}

/** What the spheres sum to with these masses. */
static inline ms_particle particle_of(ms_clump *clump, const double *mass)
{
    ms_particle particle;
    set_masses(clump, mass);
    assert_int_equal(ms_particle_from_spheres(&particle, clump, 1, NULL), MS_OK);
    return particle;
}

static inline ms_density_report solve(ms_clump *clump, const ms_particle *particle, const ms_density_options *options)
{
    ms_density_report report;
    ms_error err = {{0}};
    if (ms_density_solve(clump, &report, particle, options, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
    return report;
}

#endif
