#include "ms_lattice.h"

#include <gsl/gsl_randist.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_fibonacci.h"
#include "base/ms_random.h"
#include "base/ms_vector.h"

/* Points of a fine group, and fine groups in a coarse one along either side, about. Of the time alone. */
enum { GROUP = 16, SIDE = 4 };

static const double PI = 3.14159265358979323846;

/* Coarse groups: bands of equal areas between parallels, cut into sectors about as wide as high. Fine ones: these cut
 * into so many bands and sectors each. */
typedef struct cells {
    int bands, side;
} cells;

static int count_sectors(int band, const cells *c)
{
    const double z = 1 - (2 * band + 1.0) / c->bands;
    return 1 + (int)(PI * c->bands * (1 - z * z));
}

static cells choose_cells(int points)
{
    const double bands = sqrt(points / (GROUP * 2.0 * PI / 3)); /* the sum of all sectors is 2 pi / 3 bands^2, about */
    cells c = {.bands = (int)ceil(bands / SIDE)};
    c.side = bands > c.bands ? (int)(bands / c.bands + 0.5) : 1;
    return c;
}

static int count_coarse(const cells *c)
{
    int sum = 0;
    for (int band = 0; band < c->bands; band++) {
        sum += count_sectors(band, c);
    }
    return sum;
}

static int limit_index(double at, int count)
{
    const int i = (int)at;
    return i < 0 ? 0 : i < count ? i : count - 1;
}

/* The fine group of a direction; those of a coarse one stand together. */
static int find_fine(const double direction[3], const cells *c)
{
    const double down = (1 - direction[2]) / 2 * c->bands, around = atan2(direction[1], direction[0]) / (2 * PI) + 0.5;
    const int band = limit_index(down, c->bands), sectors = count_sectors(band, c);
    const int sector = limit_index(around * sectors, sectors);
    const int row = limit_index((down - band) * c->side, c->side);
    const int column = limit_index((around * sectors - sector) * c->side, c->side);
    int coarse = sector;
    for (int b = 0; b < band; b++) {
        coarse += count_sectors(b, c);
    }
    return (coarse * c->side + row) * c->side + column;
}

/* The middle of some directions, and how far the farthest is from it. */
static void bound_group(ms_lattice_group *group, float (*direction)[3], int count)
{
    double sum[3] = {0}, least = 1;
    for (int p = 0; p < count; p++) {
        for (int c = 0; c < 3; c++) {
            sum[c] += (double)direction[p][c];
        }
    }
    const double length = sqrt(ms_dot(sum, sum));
    for (int c = 0; c < 3; c++) {
        sum[c] = length > 0 ? sum[c] / length : 0;
        group->centre[c] = (float)sum[c];
    }
    for (int p = 0; p < count; p++) {
        const double at[3] = {(double)direction[p][0], (double)direction[p][1], (double)direction[p][2]};
        least = fmin(least, ms_dot(sum, at));
    }
    least = fmax(-1, least - 1e-6); /* rounding to float */
    group->cosine = (float)least;
    group->sine = (float)sqrt(1 - least * least);
}

/* Puts directions in the order of their groups. */
static void fill_level(ms_lattice_level *level, const cells *c)
{
    const int fines = c->side * c->side;
    double at[3];
    for (int p = 0; p < level->points; p++) {
        ms_fibonacci(at, p, level->points);
        level->fine[find_fine(at, c)].count++;
    }
    for (int g = 0, first = 0; g < level->fines; g++) {
        level->fine[g].first = first;
        first += level->fine[g].count;
        level->fine[g].count = 0;
    }
    for (int p = 0; p < level->points; p++) {
        ms_fibonacci(at, p, level->points);
        ms_lattice_group *group = &level->fine[find_fine(at, c)];
        float *to = level->direction[group->first + group->count++];
        for (int k = 0; k < 3; k++) {
            to[k] = (float)at[k];
        }
    }
    for (int g = 0; g < level->fines; g++) {
        bound_group(&level->fine[g], level->direction + level->fine[g].first, level->fine[g].count);
    }
    for (int g = 0; g < level->coarses; g++) {
        const ms_lattice_group *first = &level->fine[g * fines], *last = first + fines - 1;
        level->coarse[g] = (ms_lattice_group){.first = g * fines, .count = fines};
        bound_group(&level->coarse[g], level->direction + first->first, last->first + last->count - first->first);
    }
}

static ms_status alloc_level(ms_lattice_level *level, int points, ms_error *err)
{
    const cells c = choose_cells(points);
    const int coarses = count_coarse(&c), fines = coarses * c.side * c.side;
    *level = (ms_lattice_level){.points = points,
                                .fines = fines,
                                .coarses = coarses,
                                .direction = malloc((size_t)points * sizeof *level->direction),
                                .fine = calloc((size_t)fines, sizeof *level->fine),
                                .coarse = calloc((size_t)coarses, sizeof *level->coarse)};
    if (!level->direction || !level->fine || !level->coarse) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %d points on each sphere", points);
    }
    fill_level(level, &c);
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

void ms_lattice_normal(double normal[3], const ms_lattice *lattice, const float direction[3])
{
    const double at[3] = {(double)direction[0], (double)direction[1], (double)direction[2]};
    for (int c = 0; c < 3; c++) {
        normal[c] = ms_dot(lattice->turn[c], at);
    }
}

void ms_lattice_free(ms_lattice *lattice)
{
    for (int l = 0; l < MS_LATTICE_LEVELS; l++) {
        free(lattice->level[l].direction);
        free(lattice->level[l].fine);
        free(lattice->level[l].coarse);
    }
    ms_random_free(lattice->rng);
    *lattice = (ms_lattice){0};
}
