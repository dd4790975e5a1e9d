#include "ms_fields.h"

#include <math.h>

void ms_fields_numbers(FILE *stream, const double *value, size_t count, const char *mark)
{
    for (size_t k = 0; k < count; k++) {
        fprintf(stream, "%s%s", k ? mark : "", ms_text_of_number(value[k]).text);
    }
}

void ms_fields_spheres(FILE *stream, const ms_clump *clump, const char *mark, const char *end)
{
    for (size_t s = 0; s < clump->n_spheres; s++) {
        const double *c = clump->sphere[s].centre;
        ms_fields_numbers(stream, (const double[]){c[0], c[1], c[2], clump->sphere[s].radius}, 4, mark);
        fputs(end, stream);
    }
}

void ms_fields_moments(FILE *stream, const ms_particle *particle, double over, const char *mark)
{
    double moment[3];
    for (int m = 0; m < 3; m++) {
        moment[m] = particle->inertia[m][m] / over;
    }
    ms_fields_numbers(stream, moment, 3, mark);
}

double ms_fields_density(const ms_content *content, size_t sphere)
{
    const double r = content->clump->sphere[sphere].radius * content->particle->scale;
    return content->clump->mass[sphere] / (4 * acos(-1.0) / 3 * r * r * r);
}

int ms_fields_has_masses(const ms_content *content)
{
    return content->clump->mass && content->particle;
}

size_t ms_fields_count(const ms_content *content)
{
    return ms_fields_has_masses(content) ? ms_clump_count_masses(content->clump) : content->clump->n_spheres;
}

ms_status ms_fields_add_sphere(ms_clump *clump, int is_carrier, const double v[4], const char *name, ms_error *err)
{
    const ms_sphere sphere = {.centre = {v[0], v[1], v[2]}, .radius = v[3]};
    if (!isfinite(v[0]) || !isfinite(v[1]) || !isfinite(v[2]) || !isfinite(v[3]) || !(v[3] > 0)) {
        return ms_fail(err, MS_ERR_FORMAT,
                       "%s: sphere %zu is (%g, %g, %g) with radius %g; centres must be finite and radii above 0", name,
                       ms_clump_count_masses(clump) + 1, v[0], v[1], v[2], v[3]);
    }
    return is_carrier ? ms_clump_add_carrier(clump, &sphere, err) : ms_clump_add(clump, &sphere, err);
}
