/* What is off where an engine sums the spheres. */
#include <math.h>

#include "base/ms_vector.h"
#include "ms_write.h"

/* Errors of the sums below this are not worth a word. */
static const double WORTH = 1e-3;

/* Each sphere solid, of the particle's density, whatever overlaps. */
static ms_status fill_by_volume(ms_clump *clump, double density, ms_error *err)
{
    ms_clump_drop_masses(clump); /* the file has no carriers */
    ms_status status = ms_clump_alloc_masses(clump, err);
    for (size_t s = 0; s < clump->n_spheres && status == MS_OK; s++) {
        const double r = clump->sphere[s].radius;
        clump->mass[s] = density * (4 * acos(-1.0) / 3 * r * r * r);
    }
    return status;
}

/* What the engine finds, in the frame of the template. */
static ms_status sum_spheres(ms_particle *sum, ms_template *made, ms_sum kind, ms_error *err)
{
    ms_status status = kind == MS_SUM_VOLUMES ? fill_by_volume(&made->clump, made->particle.density, err) : MS_OK;
    return status == MS_OK ? ms_particle_from_spheres(sum, &made->clump, 1, err) : status;
}

static void put_errors(char text[MS_WRITE_REMARK], const ms_format *format, const ms_particle *sum,
                       const ms_particle *truth)
{
    const double mean = (truth->inertia[0][0] + truth->inertia[1][1] + truth->inertia[2][2]) / 3;
    const double mass = sum->mass / truth->mass - 1;
    const double centre = sqrt(ms_dot(sum->centre, sum->centre)) / ms_particle_gyration(truth);
    double moment = 0, product = 0;
    for (int m = 0; m < 3; m++) {
        const double error = sum->inertia[m][m] / truth->inertia[m][m] - 1;
        moment = fabs(error) > fabs(moment) ? error : moment;
        product = fmax(product, fabs(sum->inertia[m][(m + 1) % 3]) / mean);
    }
    if (fmax(fmax(fabs(mass), centre), fmax(fabs(moment), product)) < WORTH) {
        return;
    }
    snprintf(text, MS_WRITE_REMARK,
             "%s: mass %+.2g %%, centre off by %.2g radii of gyration, moments of inertia up to %+.2g %%, products up "
             "to %.2g %% of the mean moment",
             format->sums, 100 * mass, centre, 100 * moment, 100 * product);
}

ms_status ms_write_remark(char text[MS_WRITE_REMARK], const ms_content *content, const ms_format *format, ms_error *err)
{
    ms_template made;
    ms_particle sum;
    text[0] = '\0';
    if (format->sum == MS_SUM_NONE || !content->particle || (format->sum == MS_SUM_MASSES && !content->clump->mass)) {
        return MS_OK;
    }
    ms_status status = ms_template_make(&made, content->clump, content->particle, err);
    if (status != MS_OK) {
        return status;
    }
    status = sum_spheres(&sum, &made, format->sum, err);
    if (status == MS_OK) {
        put_errors(text, format, &sum, &made.particle);
    } else if (status == MS_ERR_ARG) { /* so small are the spheres: the template is no worse for it */
        snprintf(text, MS_WRITE_REMARK, "%s: what it finds has no mass or inertia", format->sums);
        status = MS_OK;
    }
    ms_template_free(&made);
    return status;
}
