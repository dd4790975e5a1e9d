#include "ms_lattice.h"

#include <gsl/gsl_randist.h>
#include <math.h>
#include <stdlib.h>

#include "base/ms_random.h"
#include "base/ms_vector.h"

/* Points of equal areas along a spiral. */
static void fill_directions(double (*direction)[3], int points)
{
    const double turn = acos(-1.0) * (3 - sqrt(5.0));
    for (int p = 0; p < points; p++) {
        const double z = 1 - (2 * p + 1.0) / points, r = sqrt(1 - z * z);
        direction[p][0] = r * cos(turn * p);
        direction[p][1] = r * sin(turn * p);
        direction[p][2] = z;
    }
}

ms_status ms_lattice_alloc(ms_lattice *lattice, int points, ms_error *err)
{
    const size_t n = (size_t)points;
    *lattice = (ms_lattice){.points = points,
                            .direction = malloc(n * sizeof *lattice->direction),
                            .turned = malloc(n * sizeof *lattice->turned),
                            .normal = malloc(n * sizeof *lattice->normal),
                            .rng = ms_random_new(0)};
    if (!lattice->direction || !lattice->turned || !lattice->normal || !lattice->rng) {
        ms_lattice_free(lattice);
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %d points on each sphere", points);
    }
    fill_directions(lattice->direction, points);
    return MS_OK;
}

void ms_lattice_turn(ms_lattice *lattice, unsigned long seed)
{
    double q[4], square = 0;
    gsl_rng_set(lattice->rng, seed);
    for (int i = 0; i < 4; i++) {
        q[i] = gsl_ran_gaussian(lattice->rng, 1);
        square += q[i] * q[i];
    }
    const double s = 2 / square, w = q[0], x = q[1], y = q[2], z = q[3];
    const double turn[3][3] = {{1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)},
                               {s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)},
                               {s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)}};
    for (int p = 0; p < lattice->points; p++) {
        for (int c = 0; c < 3; c++) {
            lattice->turned[p][c] = ms_dot(turn[c], lattice->direction[p]);
            lattice->normal[p][c] = (float)lattice->turned[p][c];
        }
    }
}

void ms_lattice_free(ms_lattice *lattice)
{
    free(lattice->direction);
    free(lattice->turned);
    free(lattice->normal);
    ms_random_free(lattice->rng);
    *lattice = (ms_lattice){0};
}
