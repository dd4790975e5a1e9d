#include "ms_equal_volume.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/ms_fibonacci.h"
#include "base/ms_vector.h"
#include "ms_union.h"

double ms_equal_volume_width(const ms_clump *clump)
{
    enum { DIRECTIONS = 2048 };
    double sum = 0;
    for (int d = 0; d < DIRECTIONS; d++) {
        double u[3];
        ms_fibonacci(u, d, DIRECTIONS);
        double ahead = -HUGE_VAL, behind = -HUGE_VAL;
        for (size_t s = 0; s < clump->n_spheres; s++) {
            const double along = ms_dot(clump->sphere[s].centre, u);
            ahead = fmax(ahead, clump->sphere[s].radius + along);
            behind = fmax(behind, clump->sphere[s].radius - along);
        }
        sum += ahead + behind;
    }
    return sum / DIRECTIONS;
}

static void scale_spheres(ms_clump *clump, double scale, const double about[3])
{
    ms_clump_drop_masses(clump);
    for (size_t s = 0; s < clump->n_spheres; s++) {
        ms_sphere *sphere = &clump->sphere[s];
        for (int k = 0; k < 3; k++) {
            sphere->centre[k] = about[k] + scale * (sphere->centre[k] - about[k]);
        }
        sphere->radius *= scale;
    }
}

ms_status ms_equal_volume_scale(ms_clump *clump, ms_equal_volume *done, const ms_body *body, ms_error *err)
{
    double volume, area;
    memset(done, 0, sizeof *done);
    ms_status status = ms_union_measure(&volume, &area, clump, err);
    if (status != MS_OK) {
        return status;
    }
    const double scale = cbrt(body->volume / volume);
    if (!(volume > 0) || !(body->volume > 0) || !isfinite(scale)) {
        return ms_fail(err, MS_ERR_ARG, "no scale makes a clump of the volume %g one of the volume %g", volume,
                       body->volume);
    }
    scale_spheres(clump, scale, body->centroid);
    status = ms_union_measure(&volume, &area, clump, err);
    if (status == MS_OK) {
        *done = (ms_equal_volume){scale, volume, volume / body->volume - 1, ms_equal_volume_width(clump)};
    }
    return status;
}

void ms_equal_volume_remark(ms_error *remarks, const ms_equal_volume *done)
{
    const double far = 0.1;
    char sentence[256];
    if (done->scale > 0 && fabs(done->scale - 1) > far) {
        snprintf(sentence, sizeof sentence,
                 "the spheres held %.3g %% of the shape's volume; scaled by %.3g they lie beside it; take more "
                 "spheres, or a method that holds the volume while it fits (variational)",
                 100 * pow(done->scale, -3), done->scale);
        ms_error_add(remarks, sentence);
    }
}
