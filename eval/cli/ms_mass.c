#include "ms_mass.h"

#include <float.h>
#include <math.h>
#include <omp.h>
#include <string.h>

#include "base/ms_choice.h"
#include "ms_json_object.h"

/* Takes one of two words; 1 for the second. */
static ms_status take_choice(int *second, const char *name, const char *value, const char *const words[2],
                             ms_error *err)
{
    ms_choice choice = {.typed = value};
    *second = 0;
    if (ms_choice_offer(&choice, words[0])) {
        return MS_OK;
    }
    *second = ms_choice_offer(&choice, words[1]);
    return *second ? MS_OK : ms_choice_fail(&choice, err, "there are no --%s '%s'", name, value);
}

ms_status ms_mass_flag(int *taken, ms_mass_flags *flags, const char *name, const char *value, ms_error *err)
{
    static const char *const PROPERTIES[] = {"shape", "union"}, *const AXES[] = {"principal", "input"};
    const struct {
        const char *name;
        double *value, lo, hi;
    } numbers[] = {
        {"density", &flags->density, MS_PARTICLE_LEAST_DENSITY, MS_PARTICLE_MOST_DENSITY},
        {"scale", &flags->scale, DBL_MIN, DBL_MAX},
        {"least-mass", &flags->options.masses.least, DBL_MIN, 1},
        {"most-mass", &flags->options.masses.most, DBL_MIN, 1},
        {"centre-tolerance", &flags->options.masses.centre_tolerance, 0, DBL_MAX},
        {"carrier-depth", &flags->options.depth, DBL_MIN, DBL_MAX},
    };
    ms_status status;
    *taken = 1;
    for (size_t n = 0; n < sizeof numbers / sizeof *numbers; n++) {
        if (strcmp(name, numbers[n].name) == 0) {
            flags->any = 1;
            status = ms_flags_number(numbers[n].value, name, value, numbers[n].lo, numbers[n].hi, err);
            *numbers[n].value = fmax(*numbers[n].value, DBL_MIN); /* 0, where it is allowed, is not "not given" */
            return status;
        }
    }
    if (strcmp(name, "carriers") == 0) {
        flags->any = flags->carriers = 1;
        return MS_OK;
    }
    flags->any |= strcmp(name, "unit") == 0 || strcmp(name, "properties") == 0 || strcmp(name, "axes") == 0;
    if (strcmp(name, "unit") == 0) {
        flags->unit = value;
        return MS_OK;
    }
    if (strcmp(name, "properties") == 0) {
        return take_choice(&flags->of_union, name, value, PROPERTIES, err);
    }
    if (strcmp(name, "axes") == 0) {
        return take_choice(&flags->options.masses.input_frame, name, value, AXES, err);
    }
    *taken = 0;
    return MS_OK;
}

ms_status ms_mass_resolve(ms_mass_flags *flags, ms_error *err)
{
    static const struct {
        const char *name;
        double metres;
    } UNITS[] = {{"m", 1}, {"mm", 1e-3}, {"um", 1e-6}};
    if (flags->unit && flags->scale > 0) {
        return ms_fail(err, MS_ERR_ARG, "--unit and --scale exclude one another");
    }
    if (flags->options.depth > 0 && !flags->carriers) {
        return ms_fail(err, MS_ERR_ARG, "--carrier-depth takes --carriers beside it");
    }
    ms_choice choice = {.typed = flags->unit};
    for (size_t u = 0; flags->unit && u < 3; u++) {
        if (ms_choice_offer(&choice, UNITS[u].name)) {
            flags->scale = UNITS[u].metres;
        }
    }
    if (flags->unit && !(flags->scale > 0)) {
        return ms_choice_fail(&choice, err, "there is no --unit '%s' (--scale takes any number of metres)",
                              flags->unit);
    }
    flags->scale = flags->scale > 0 ? flags->scale : 1;
    return MS_OK;
}

ms_status ms_mass_correct(ms_mass *mass, ms_clump *clump, const ms_mass_flags *flags, const ms_body *body,
                          size_t max_voxels, ms_error *err)
{
    ms_body own;
    const double start = omp_get_wtime();
    ms_status status = MS_OK;
    memset(mass, 0, sizeof *mass);
    if (flags->of_union) {
        status = ms_particle_union(&own, clump, max_voxels, err);
        body = &own;
    }
    if (status == MS_OK) {
        status = ms_particle_from_body(&mass->particle, body, flags->density, flags->scale, err);
    }
    if (status == MS_OK) {
        ms_clump_drop_masses(clump);
        status = flags->carriers ? ms_carriers_solve(clump, &mass->report, &mass->particle, &flags->options, err)
                                 : ms_density_solve(clump, &mass->report, &mass->particle, &flags->options.masses, err);
    }
    mass->n_carriers = flags->carriers && status == MS_OK ? (int)clump->n_carriers : -1;
    mass->all_at_once = flags->options.masses.input_frame;
    mass->corrected = status == MS_OK;
    mass->seconds = omp_get_wtime() - start;
    return status;
}

static double largest(const double v[3])
{
    return fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
}

void ms_mass_print(FILE *stream, const ms_mass *mass)
{
    const ms_density_report *r = &mass->report;
    fprintf(stream, "  %-34s %.9g kg\n", "mass of the particle", mass->particle.mass);
    fprintf(stream, "  %-34s %.4g to %.4g kg\n", "masses of the spheres", r->least_mass, r->most_mass);
    fprintf(stream, "  %-34s %.3g %%\n", "epsilon of the moments", 100 * r->epsilon);
    fprintf(stream, "  %-34s %.3g %%\n", "products of inertia / mean moment", 100 * r->products);
    if (r->products > 0.01 && !mass->all_at_once) {
        fprintf(stream, "  %-34s --axes input meets them with the moments, at a larger epsilon\n", "");
    }
    fprintf(stream, "  %-34s %.3g\n", "centre of mass / radius of gyration", r->error_centre);
    if (r->centre > MS_DENSITY_CENTRE_TOLERANCE) {
        fprintf(stream, "  %-34s the least is %.3g along an axis; more spheres may help\n", "", r->centre);
    }
    if (mass->n_carriers >= 0) {
        fprintf(stream, "  %-34s %d%s\n", "carriers", mass->n_carriers, mass->n_carriers ? "" : ": none are needed");
    }
    if (!r->optimal) {
        fprintf(stream, "  %-34s the simplex method came to no end; better ones may exist\n", "masses of the spheres");
    }
    fprintf(stream, "  %-34s mass %.1e, centre %.1e, moments %.1e, products %.1e\n", "errors of the sums",
            r->error_mass, r->error_centre, largest(r->error_moment), largest(r->error_product));
}

static json_t *pack_mass_vector(const double v[3])
{
    return json_pack("[f,f,f]", v[0], v[1], v[2]);
}

json_t *ms_mass_json(const ms_mass *mass)
{
    const ms_density_report *r = &mass->report;
    json_t *json = json_pack("{s:f,s:f,s:f,s:b,s:f,s:f,s:f,s:f,s:o,s:o,s:f}", "epsilon", r->epsilon, "products_epsilon",
                             r->products, "centre_epsilon", r->centre, "optimal", r->optimal, "least", r->least_mass,
                             "most", r->most_mass, "error_mass", r->error_mass, "error_centre", r->error_centre,
                             "error_moments", pack_mass_vector(r->error_moment), "error_products",
                             pack_mass_vector(r->error_product), "seconds", mass->seconds);
    if (mass->n_carriers >= 0) {
        ms_json_object_set(&json, "carriers", json_integer(mass->n_carriers));
    }
    return json;
}
