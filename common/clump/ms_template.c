#include "ms_template.h"

#include <math.h>
#include <string.h>

#include "base/ms_vector.h"

static ms_status principal_of(ms_principal *principal, const ms_particle *particle, ms_error *err)
{
    ms_body body = {.volume = 1};
    memcpy(body.inertia, particle->inertia, sizeof body.inertia);
    return ms_inertia_principal(principal, &body, err);
}

static ms_status carry_spheres(ms_template *made, const ms_clump *clump, ms_error *err)
{
    ms_status status = MS_OK;
    const size_t n = ms_clump_count_masses(clump);
    for (size_t s = 0; s < n && status == MS_OK; s++) {
        ms_sphere sphere = {.radius = made->scale * clump->sphere[s].radius};
        double from_centre[3];
        for (int k = 0; k < 3; k++) {
            from_centre[k] = clump->sphere[s].centre[k] - made->centre[k];
        }
        for (int m = 0; m < 3; m++) {
            sphere.centre[m] = made->scale * ms_dot(made->axis[m], from_centre);
        }
        status = s < clump->n_spheres ? ms_clump_add(&made->clump, &sphere, err)
                                      : ms_clump_add_carrier(&made->clump, &sphere, err);
    }
    if (status == MS_OK && clump->mass) {
        status = ms_clump_alloc_masses(&made->clump, err);
    }
    if (status == MS_OK && clump->mass) {
        memcpy(made->clump.mass, clump->mass, n * sizeof *clump->mass);
    }
    return status;
}

ms_status ms_template_make(ms_template *made, const ms_clump *clump, const ms_particle *particle, ms_error *err)
{
    ms_principal principal;
    memset(made, 0, sizeof *made);
    ms_status status = principal_of(&principal, particle, err);
    if (status != MS_OK) {
        return status;
    }
    made->scale = particle->scale;
    memcpy(made->centre, particle->centre, sizeof made->centre);
    memcpy(made->axis, principal.axis, sizeof made->axis);
    made->particle = (ms_particle){.scale = 1, .density = particle->density, .mass = particle->mass};
    for (int m = 0; m < 3; m++) {
        made->particle.inertia[m][m] = principal.moment[m];
    }
    status = carry_spheres(made, clump, err);
    if (status != MS_OK) {
        ms_template_free(made);
    }
    return status;
}

ms_status ms_template_undo(ms_clump *clump, const ms_particle *particle, ms_error *err)
{
    ms_principal principal;
    ms_status status = principal_of(&principal, particle, err);
    for (size_t s = 0; s < ms_clump_count_masses(clump) && status == MS_OK; s++) {
        ms_sphere *sphere = &clump->sphere[s];
        double source[3];
        for (int k = 0; k < 3; k++) {
            source[k] = particle->centre[k];
            for (int m = 0; m < 3; m++) {
                source[k] += principal.axis[m][k] * sphere->centre[m] / particle->scale;
            }
        }
        memcpy(sphere->centre, source, sizeof source);
        sphere->radius /= particle->scale;
    }
    return status;
}

double ms_template_reach(const ms_clump *clump)
{
    double reach = 0;
    for (size_t s = 0; s < clump->n_spheres; s++) {
        const ms_sphere *b = &clump->sphere[s];
        reach = fmax(reach, sqrt(ms_dot(b->centre, b->centre)) + b->radius);
    }
    return reach;
}

void ms_template_free(ms_template *made)
{
    if (made) {
        ms_clump_free(&made->clump);
        memset(made, 0, sizeof *made);
    }
}
