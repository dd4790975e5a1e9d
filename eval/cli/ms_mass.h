/** Mass and inertia of the particle, and the masses of the spheres: flags, work and report. */
#ifndef MS_MASS_H
#define MS_MASS_H

#include <jansson.h>
#include <stdio.h>

#include "clump/ms_carriers.h"
#include "ms_flags.h"
#include "ms_input.h"

/* clang-format off */
#define MS_UNIT_FLAGS \
    {"density", 0, "RHO", "density of the particle, kg/m^3"}, \
    {"unit", 0, "m|mm|um", "unit of length of the shape and of the clump (m)"}, \
    {"scale", 0, "F", "metres in a unit of length, instead of --unit"}
#define MS_MASS_FLAGS \
    MS_UNIT_FLAGS, \
    {"properties", 0, "shape|union", "the particle is the shape, or the union of the spheres (shape)"}, \
    {"axes", 0, "principal|input", "axes of the equations (principal)"}, \
    {"least-mass", 0, "M", "least mass of a sphere / that of the particle (1/1000, or 1/2n for n > 500)"}, \
    {"most-mass", 0, "M", "greatest mass of a sphere / that of the particle (1)"}, \
    {"centre-tolerance", 0, "T", "how far the centre of mass may be off for better moments / gyration radius (1e-7)"}, \
    {"carriers", 0, NULL, "small spheres within others, of mass and without contact: exact mass, centre, inertia"}, \
    {"carrier-depth", 0, "D", "of carriers below the surface (1/10 of the radius around them, 1/100 of the body's)"}
/* clang-format on */

typedef struct ms_mass_flags {
    double density, scale; /* 0: not given */
    const char *unit;      /* NULL: not given */
    int of_union;
    int any; /* one of the flags was given */
    int carriers;
    ms_carriers_options options;
} ms_mass_flags;

/** Takes a flag if it is one of MS_MASS_FLAGS. @param[out] taken 0 if it is not */
ms_status ms_mass_flag(int *taken, ms_mass_flags *flags, const char *name, const char *value, ms_error *err);

/** What follows from the flags together: the scale, 1 by default. @return MS_OK; MS_ERR_ARG */
ms_status ms_mass_resolve(ms_mass_flags *flags, ms_error *err);

/** The particle, and how well the spheres stand for it. */
typedef struct ms_mass {
    ms_particle particle;
    ms_density_report report;
    int corrected;   /* the report holds */
    int all_at_once; /* moments and products, by --axes input */
    int n_carriers;  /* found with --carriers; -1 without */
    double seconds;
} ms_mass;

/** The particle from the body of the shape or from the union; then the masses of the spheres. */
ms_status ms_mass_correct(ms_mass *mass, ms_clump *clump, const ms_mass_flags *flags, const ms_body *body,
                          size_t max_voxels, ms_error *err);

/** A table of a few lines. */
void ms_mass_print(FILE *stream, const ms_mass *mass);

/** The same of ms_density_report; the caller owns it. */
json_t *ms_mass_json(const ms_mass *mass);

#endif
