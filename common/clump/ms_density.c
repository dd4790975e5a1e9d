#include "ms_density.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_vector.h"
#include "ms_linear_program.h"
#include "ms_mass_equations.h"

/* Errors below this are rounding, and are said to be 0. */
static const double EXACT = 1e-9;

/* The goals in their order: each is a column that is made least and then held. */
enum goal { CENTRE, EPSILON, PRODUCTS, GOALS };

static ms_linear_program *make_programme(const ms_mass_equations *e, double least, double most, int input_frame,
                                         ms_error *err)
{
    const int goal[MS_MASS_EQUATIONS_KINDS] = {-1, CENTRE, EPSILON, input_frame ? EPSILON : PRODUCTS};
    double *row = malloc((e->n + 1) * sizeof *row);
    ms_linear_program *p = row ? ms_linear_program_new(e->n, GOALS, least, most, err) : NULL;
    if (!row) {
        ms_fail(err, MS_ERR_NOMEM, "no memory for the equations of %zu spheres", e->n);
        return NULL;
    }
    ms_status status = p ? MS_OK : MS_ERR_NOMEM;
    for (int k = 0; k < MS_MASS_EQUATIONS_COUNT && status == MS_OK; k++) {
        const ms_mass_equation q = ms_mass_equations_get(row, e, k);
        status = ms_linear_program_equation(p, row, q.right, goal[q.kind], q.scale, err);
    }
    free(row);
    if (status != MS_OK) {
        ms_linear_program_free(p);
        return NULL;
    }
    return p;
}

/* What the masses sum to, by other means than the rows of the programme. */
static ms_status judge_masses(ms_density_report *report, const ms_mass_equations *e, const ms_clump *clump,
                              const ms_particle *particle, ms_error *err)
{
    ms_particle sum;
    const double unit = ms_particle_gyration(particle), metres = unit * particle->scale;
    const double norm = particle->mass * metres * metres;
    ms_status status = ms_particle_from_spheres(&sum, clump, particle->scale, err);
    if (status != MS_OK) {
        return status;
    }
    report->error_mass = sum.mass / particle->mass - 1;
    report->error_centre = sqrt(ms_squared_distance(sum.centre, particle->centre)) / unit;
    for (int m = 0; m < 3; m++) {
        const double *one = e->axis[m], *two = e->axis[(m + 1) % 3], *three = e->axis[(m + 2) % 3];
        double moment = 0, product = 0;
        for (int k = 0; k < 9; k++) {
            const double element = sum.inertia[k / 3][k % 3] / norm;
            moment += one[k / 3] * element * one[k % 3];
            product += two[k / 3] * element * three[k % 3];
        }
        report->error_moment[m] = moment / e->moment[m] - 1;
        report->error_product[m] = (product - e->product[m]) / e->mean;
    }
    report->least_mass = report->most_mass = clump->mass[0];
    for (size_t s = 1; s < ms_clump_count_masses(clump); s++) {
        report->least_mass = fmin(report->least_mass, clump->mass[s]);
        report->most_mass = fmax(report->most_mass, clump->mass[s]);
    }
    return MS_OK;
}

/* What the programme is made of, and what it gives. */
typedef struct solution {
    const ms_mass_equations *e;
    double least, most, centre_tolerance;
    int input_frame;
    double *share; /* of the mass, one per sphere; those of the last step that came to an end */
    double reached[GOALS];
    int optimal;
} solution;

/* The steps in their order. The centre comes twice: what it was allowed to be off and is not needed is taken back. */
static ms_status make_steps(solution *s, ms_linear_program *p, ms_error *err)
{
    static const enum goal STEP[] = {CENTRE, EPSILON, PRODUCTS, CENTRE};
    double again;
    for (size_t k = 0; k < sizeof STEP / sizeof *STEP; k++) {
        const double allowed = k == 0 ? s->centre_tolerance : 0;
        ms_status status = ms_linear_program_minimise(p, STEP[k], allowed, k == 3 ? &again : &s->reached[STEP[k]], err);
        if (status != MS_OK) {
            return status;
        }
        ms_linear_program_shares(p, s->share);
    }
    ms_status status = ms_linear_program_spread(p, err);
    if (status == MS_OK) {
        ms_linear_program_shares(p, s->share);
    }
    return status;
}

/* Even masses obey the bounds: they stand where the simplex method does not come to the end of its first step. */
static ms_status solve_shares(void *context, ms_error *err)
{
    solution *s = context;
    for (size_t m = 0; m < s->e->n; m++) {
        s->share[m] = 1 / (double)s->e->n;
    }
    ms_linear_program *p = make_programme(s->e, s->least, s->most, s->input_frame, err);
    ms_status status = p ? make_steps(s, p, err) : MS_ERR_NOMEM;
    ms_linear_program_free(p);
    s->optimal = status == MS_OK;
    return status == MS_ERR_LIMIT ? MS_OK : status;
}

static double largest(const double v[3])
{
    return fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
}

/* The least errors that masses can have; of masses that may not be the best ones, those that they have. */
static void note_reached(ms_density_report *report, const solution *s)
{
    const double had[GOALS] = {report->error_centre, largest(report->error_moment), largest(report->error_product)};
    double *const out[GOALS] = {&report->centre, &report->epsilon, &report->products};
    for (int goal = 0; goal < GOALS; goal++) {
        const double error = s->optimal ? s->reached[goal] : had[goal];
        *out[goal] = error > EXACT ? error : 0;
    }
    report->optimal = s->optimal;
}

static ms_status check_clump(const ms_clump *clump, double least, double most, const ms_density_options *options,
                             ms_error *err)
{
    const double n = (double)ms_clump_count_masses(clump);
    if (clump->n_spheres == 0) {
        return ms_fail(err, MS_ERR_ARG, "a clump without spheres has no masses");
    }
    for (size_t s = 0; s < ms_clump_count_masses(clump); s++) {
        const ms_sphere *b = &clump->sphere[s];
        if (!isfinite(b->centre[0] + b->centre[1] + b->centre[2]) || !isfinite(b->radius) || !(b->radius > 0)) {
            return ms_fail(err, MS_ERR_ARG, "sphere %zu is not finite or its radius is not above 0", s + 1);
        }
    }
    if (!(least >= 0) || !(most >= least) || !(n * least <= 1 + EXACT) || !(n * most >= 1 - EXACT)) {
        return ms_fail(err, MS_ERR_ARG,
                       "no masses of %zu spheres, each from %g to %g of the whole, sum to the whole (Yuan's eq. 5); "
                       "lower the least or raise the greatest mass",
                       ms_clump_count_masses(clump), least, most);
    }
    if (!(options->centre_tolerance >= 0) || !isfinite(options->centre_tolerance)) {
        return ms_fail(err, MS_ERR_ARG, "the tolerance on the centre of mass, %g, is not 0 or more",
                       options->centre_tolerance);
    }
    return MS_OK;
}

double ms_density_least(const ms_density_options *options, size_t n)
{
    return options->least > 0 ? options->least : fmin(1e-3, 0.5 / (double)n);
}

ms_status ms_density_solve(ms_clump *clump, ms_density_report *report, const ms_particle *particle,
                           const ms_density_options *options, ms_error *err)
{
    const double least = ms_density_least(options, ms_clump_count_masses(clump));
    const double most = options->most > 0 ? options->most : 1;
    const double tolerance = options->centre_tolerance > 0 ? options->centre_tolerance : MS_DENSITY_CENTRE_TOLERANCE;
    ms_mass_equations e = {0};
    solution s = {&e, least, most, tolerance, options->input_frame, NULL, {0}, 0};
    memset(report, 0, sizeof *report);
    ms_status status = check_clump(clump, least, most, options, err);
    if (status == MS_OK) {
        status = ms_mass_equations_make(&e, clump, particle, options->input_frame, err);
    }
    if (status == MS_OK) {
        status = ms_clump_alloc_masses(clump, err);
        s.share = clump->mass;
    }
    if (status == MS_OK) {
        status = ms_linear_program_apart(solve_shares, &s, err);
    }
    if (status == MS_OK) {
        for (size_t m = 0; m < e.n; m++) {
            clump->mass[m] *= particle->mass;
        }
        status = judge_masses(report, &e, clump, particle, err);
        note_reached(report, &s);
    }
    if (status != MS_OK) {
        memset(report, 0, sizeof *report);
        free(clump->mass);
        clump->mass = NULL;
    }
    ms_mass_equations_free(&e);
    return status;
}
