#include "ms_order.h"

#include <math.h>
#include <stdlib.h>

#include "ms_cover.h"

static ms_status add_sphere(ms_clump *clump, const ms_ball *ball, const ms_run *run, ms_error *err)
{
    ms_sphere sphere = ms_grid_sphere(&run->target->grid, ball);
    sphere.radius = fmax(sphere.radius, run->stop.radius);
    return ms_clump_add(clump, &sphere, err);
}

ms_status ms_order_by_gain(ms_clump *clump, const ms_ball *ball, size_t count, const ms_run *run, ms_error *err)
{
    ms_cover *cover = NULL;
    uint8_t *taken = calloc(count + 1, sizeof *taken);
    size_t which;
    ms_status status = taken ? ms_cover_build(&cover, &run->target->grid, ball, count, MS_COVER_ANY, err)
                             : ms_fail(err, MS_ERR_NOMEM, "no memory to order %zu spheres", count);
    while (status == MS_OK && ms_cover_next(&which, cover) > 0) {
        taken[which] = 1;
        status = add_sphere(clump, &ball[which], run, err);
    }
    for (size_t b = 0; status == MS_OK && b < count; b++) {
        if (!taken[b]) {
            status = add_sphere(clump, &ball[b], run, err);
        }
    }
    ms_cover_free(cover);
    free(taken);
    return status;
}
