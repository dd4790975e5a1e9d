/** Masses of the spheres of a clump such that their sums are mass, centre and inertia of the true particle. */
#ifndef MS_DENSITY_H
#define MS_DENSITY_H

#include "ms_particle.h"

MS_C_BEGIN

/** How far off the centre may be by default: no mesh knows its own any better. The corners of an STL are 24-bit
 * numbers, right to 6e-8 of their size, and so is the centre that follows from them. */
#define MS_DENSITY_CENTRE_TOLERANCE 1e-7

/** What is asked of the masses; a zeroed struct holds the defaults. */
typedef struct ms_density_options {
    int input_frame;         /* 0: moments along the principal axes first, then products (see below);
                                1: all six elements of the tensor along the clump's own axes at once */
    double least, most;      /* bounds of a mass / that of the particle; 0: 1/1000, or 1/2n above 500 spheres; 1 */
    double centre_tolerance; /* how far the centre of mass may be off along an axis, where that betters the moments, /
                                radius of gyration; 0: MS_DENSITY_CENTRE_TOLERANCE */
} ms_density_options;

/** The least share of a mass among n of them. */
MS_API double ms_density_least(const ms_density_options *options, size_t n);

/** What was reached. Errors are relative: of the mass and the moments to their own true values, of the products of
 * inertia to the mean moment, of the centre to the radius of gyration. */
typedef struct ms_density_report {
    double centre;   /* the least largest error along an axis that masses within the bounds can have; 0: none */
    double epsilon;  /* likewise of the moments about the true centre (eq. 8), with that centre or the tolerance */
    double products; /* likewise of the products of inertia, with that centre and these moments */
    int optimal; /* 0: the simplex method did not come to the end of some step. The masses are those of the step before,
                    or even ones, and the three errors above are those that they have */
    double least_mass, most_mass; /* kg */
    /* Recomputed from the masses, by other code than that which found them, along the axes of the programme: */
    double error_mass, error_centre, error_moment[3], error_product[3]; /* signed but the centre; products yz, zx, xy */
} ms_density_report;

/**
 * Finds the masses by linear programmes: first the least error of the centre of mass, then the least epsilon, then
 * the least error of the products of inertia, and of all masses that are left the ones whose smallest is greatest.
 * No error is too large: some masses there always are, and the report says how good they are.
 *
 * Yuan's seven equations (mass, centre, principal moments) leave the products of inertia open; he takes them to follow,
 * but they need not. Here they come third, so that his epsilon stays the least one, and the whole tensor is met
 * wherever some masses do so.
 *
 * @param[in,out] clump    its masses are set, of spheres and carriers alike; on failure it has none
 * @param[out]    report   zeros on failure
 * @param         particle what the clump stands for
 * @return MS_OK; MS_ERR_ARG for no spheres, a radius or place that is not finite, or bounds that no masses obey;
 *         MS_ERR_NOMEM
 *
 * GLPK runs in a thread that lives as long as the call: whatever befalls it, what the caller holds of GLPK, its
 * problems, error hook and terminal settings, is left alone; where GLPK would print and abort, a status comes back. It
 * must have been built with thread-local storage (glp_config("TLS")), as Debian's is; without it MS_ERR_LIMIT.
 *
 * Source: Yuan 2019, section 4, eqs. 2 to 5, 7, 8; GLPK's simplex method. Cost: 1000 spheres in hundredths of a second.
 */
MS_API ms_status ms_density_solve(ms_clump *clump, ms_density_report *report, const ms_particle *particle,
                                  const ms_density_options *options, ms_error *err);

MS_C_END

#endif
