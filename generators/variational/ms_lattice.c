#include "ms_lattice.h"

#include <gsl/gsl_randist.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_random.h"
#include "base/ms_vector.h"

/* Points of a group, about. Of the time alone. */
enum { GROUP = 24 };

static const double PI = 3.14159265358979323846;

/* Points of equal areas along a spiral. */
static void find_direction(double out[3], int p, int points)
{
    const double turn = PI * (3 - sqrt(5.0)) * p;
    const double z = 1 - (2 * p + 1.0) / points, r = sqrt(1 - z * z);
    out[0] = r * cos(turn);
    out[1] = r * sin(turn);
    out[2] = z;
}

/* Bands of equal areas between parallels, cut into sectors that are as wide as high about. */
static int count_bands(int points)
{
    return (int)ceil(sqrt((double)points / GROUP));
}

static int count_sectors(int band, int bands)
{
    const double z = 1 - (2 * band + 1.0) / bands;
    return 1 + (int)(PI * bands * (1 - z * z) * 0.5 * 2);
}

static int find_group(const double direction[3], int bands)
{
    int band = (int)((1 - direction[2]) / 2 * bands), group = 0;
    for (int b = 0; b < band; b++) {
        group += count_sectors(b, bands);
    }
    const int sectors = count_sectors(band, bands);
    const int sector = (int)((atan2(direction[1], direction[0]) / (2 * PI) + 0.5) * sectors);
    return group + (sector < sectors ? sector : sectors - 1);
}

/* The middle of a group and its size. */
static void bound_group(ms_lattice_group *group, float (*direction)[3])
{
    double sum[3] = {0}, least = 1;
    for (int p = group->first; p < group->first + group->count; p++) {
        for (int c = 0; c < 3; c++) {
            sum[c] += (double)direction[p][c];
        }
    }
    const double length = sqrt(ms_dot(sum, sum));
    for (int c = 0; c < 3; c++) {
        sum[c] = length > 0 ? sum[c] / length : 0;
        group->centre[c] = (float)sum[c];
    }
    for (int p = group->first; p < group->first + group->count; p++) {
        const double at[3] = {(double)direction[p][0], (double)direction[p][1], (double)direction[p][2]};
        least = fmin(least, ms_dot(sum, at));
    }
    least = fmax(-1, least - 1e-6); /* rounding to float */
    group->cosine = (float)least;
    group->sine = (float)sqrt(1 - least * least);
}

static ms_status alloc_level(ms_lattice_level *level, int points, ms_error *err)
{
    const int bands = count_bands(points);
    int groups = 0;
    for (int b = 0; b < bands; b++) {
        groups += count_sectors(b, bands);
    }
    *level = (ms_lattice_level){.points = points,
                                .groups = groups,
                                .direction = malloc((size_t)points * sizeof *level->direction),
                                .group = calloc((size_t)groups, sizeof *level->group)};
    if (!level->direction || !level->group) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %d points on each sphere", points);
    }
    double at[3];
    for (int p = 0; p < points; p++) {
        find_direction(at, p, points);
        level->group[find_group(at, bands)].count++;
    }
    for (int g = 1; g < groups; g++) {
        level->group[g].first = level->group[g - 1].first + level->group[g - 1].count;
        level->group[g - 1].count = 0;
    }
    level->group[groups - 1].count = 0;
    for (int p = 0; p < points; p++) {
        find_direction(at, p, points);
        ms_lattice_group *group = &level->group[find_group(at, bands)];
        float *to = level->direction[group->first + group->count++];
        for (int c = 0; c < 3; c++) {
            to[c] = (float)at[c];
        }
    }
    for (int g = 0; g < groups; g++) {
        bound_group(&level->group[g], level->direction);
    }
    return MS_OK;
}

ms_status ms_lattice_alloc(ms_lattice *lattice, int points, ms_error *err)
{
    *lattice = (ms_lattice){.turn = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, .rng = ms_random_new(0)};
    ms_status status =
        lattice->rng ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for %d points on each sphere", points);
    for (int l = 0; l < MS_LATTICE_LEVELS && status == MS_OK; l++) {
        status = alloc_level(&lattice->level[l], points << l, err);
    }
    if (status != MS_OK) {
        ms_lattice_free(lattice);
    }
    return status;
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
    memcpy(lattice->turn, turn, sizeof turn);
}

void ms_lattice_free(ms_lattice *lattice)
{
    for (int l = 0; l < MS_LATTICE_LEVELS; l++) {
        free(lattice->level[l].direction);
        free(lattice->level[l].group);
    }
    ms_random_free(lattice->rng);
    *lattice = (ms_lattice){0};
}
