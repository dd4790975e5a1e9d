#include "ms_clump_hull.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_fibonacci.h"
#include "base/ms_vector.h"
#include "mesh/ms_hull.h"

enum { DIRECTIONS = 2048 };

/* What a polyhedron with a corner in each direction lacks of the radius of its ball, on the average over volume. */
static const double SHORT_BY = 1.935 / DIRECTIONS;

static void find_farthest(double out[3], const ms_clump *clump, const double direction[3])
{
    const ms_sphere *farthest = clump->sphere;
    double most = -HUGE_VAL;
    for (size_t s = 0; s < clump->n_spheres; s++) {
        const double height = ms_dot(clump->sphere[s].centre, direction) + clump->sphere[s].radius;
        if (height > most) {
            most = height;
            farthest = &clump->sphere[s];
        }
    }
    for (int a = 0; a < 3; a++) {
        out[a] = farthest->centre[a] + farthest->radius * (1 + SHORT_BY) * direction[a];
    }
}

ms_status ms_clump_hull_build(ms_mesh *hull, const ms_clump *clump, ms_error *err)
{
    memset(hull, 0, sizeof *hull);
    if (clump->n_spheres == 0) {
        return ms_fail(err, MS_ERR_SHAPE, "a clump without spheres has no convex hull");
    }
    double(*point)[3] = malloc(DIRECTIONS * sizeof *point);
    if (!point) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the convex hull of the clump");
    }
#pragma omp parallel for schedule(static) if (clump->n_spheres >= 64)
    for (int d = 0; d < DIRECTIONS; d++) {
        double direction[3];
        ms_fibonacci(direction, d, DIRECTIONS);
        find_farthest(point[d], clump, direction);
    }
    const ms_status status = ms_hull_build(hull, (const double(*)[3])point, DIRECTIONS, err);
    free(point);
    return status;
}
