/* Normals of voxels: of digitised planes and balls, whose own are known. */
#include "voxel/ms_voxel_normal.h"

#include "base/ms_vector.h"
#include "support/grid_samples.h"

enum { SIDE = 30, TURNS = 200 };

static void random_direction(double u[3], uint64_t *seed)
{
    const double z = 2 * next_uniform(seed) - 1, turn = 2 * pi * next_uniform(seed), ring = sqrt(1 - z * z);
    u[0] = ring * cos(turn);
    u[1] = ring * sin(turn);
    u[2] = z;
}

/* Voxels with their centre below a plane through a place, or, with a radius above 0, in the ball that touches it. */
static void digitise(ms_grid *grid, const double place[3], const double u[3], double radius)
{
    for (int k = 0; k < SIDE; k++) {
        for (int j = 0; j < SIDE; j++) {
            for (int i = 0; i < SIDE; i++) {
                const double from[3] = {i - place[0], j - place[1], k - place[2]};
                const double up = ms_dot(from, u);
                const double ball = ms_dot(from, from) + 2 * radius * up;
                grid->inside[ms_grid_index(grid, i, j, k)] = radius > 0 ? ball < 0 : up < 0;
            }
        }
    }
}

/* Turns a direction to the first axis, of which it is off by up to so much; 1: leaves it. */
static void tilt_to_axis(double u[3], double tilt)
{
    const double v[3] = {tilt < 1 ? copysign(1, u[0]) : u[0], tilt * u[1], tilt * u[2]}, length = sqrt(ms_dot(v, v));
    for (int a = 0; a < 3; a++) {
        u[a] = v[a] / length;
    }
}

/* At places up to so many voxels from the surface, which faces any way (tilt 1), or nearly along an axis. */
static void expect_errors(double radius, double reach, double tilt, double most_rms, double most, uint64_t *seed)
{
    double sum = 0;
    ms_grid grid = empty_grid(SIDE, SIDE, SIDE, 0.1);
    for (int turn = 0; turn < TURNS; turn++) {
        double u[3], place[3], normal[3];
        random_direction(u, seed);
        tilt_to_axis(u, tilt);
        for (int a = 0; a < 3; a++) {
            place[a] = SIDE / 2 + next_uniform(seed);
        }
        digitise(&grid, place, u, radius);
        const double away = reach * (2 * next_uniform(seed) - 1);
        for (int a = 0; a < 3; a++) {
            place[a] += away * u[a];
        }
        assert_true(ms_voxel_normal(normal, &grid, place));
        expect_close(ms_dot(normal, normal), 1, 1e-12);
        const double error = 180 / pi * acos(fmin(1, ms_dot(normal, u)));
        assert_true(error < most);
        sum += error * error;
    }
    assert_true(sqrt(sum / TURNS) < most_rms);
    ms_grid_free(&grid);
}

static void normals_are_those_of_planes_and_balls(void **state)
{
    uint64_t seed = 4;
    (void)state;
    expect_errors(0, 0, 1, 1.25, 5, &seed);
    expect_errors(0, 1, 1, 1.25, 5, &seed);
    expect_errors(10, 0, 1, 1.2, 4, &seed);
    expect_errors(10, 1, 1, 1.2, 4, &seed);
    expect_errors(0, 1, 0.02, 3, 12, &seed);
    expect_errors(0, 1, 0.1, 4.5, 12, &seed);
}

static void faces_along_the_axes_are_exact(void **state)
{
    (void)state;
    ms_grid grid = empty_grid(SIDE, SIDE, SIDE, 1);
    for (int axis = 0; axis < 3; axis++) {
        for (int side = -1; side <= 1; side += 2) {
            const double place[3] = {14.3, 15.6, 14.5};
            double u[3] = {0}, normal[3];
            u[axis] = side;
            digitise(&grid, place, u, 0);
            assert_true(ms_voxel_normal(normal, &grid, place));
            expect_close(normal[axis], side, 1e-3);
        }
    }
    ms_grid_free(&grid);
}

/* A body that fills the grid ends at its border. */
static void without_a_surface_there_is_none(void **state)
{
    uint64_t seed = 6;
    double normal[3];
    (void)state;
    ms_grid grid = empty_grid(SIDE, SIDE, SIDE, 1);
    for (int fill = 0; fill < 2; fill++) {
        memset(grid.inside, fill, ms_grid_voxels(&grid));
        for (int turn = 0; turn < 300; turn++) {
            double place[3];
            for (int a = 0; a < 3; a++) {
                place[a] = 7 + 15 * next_uniform(&seed);
            }
            assert_false(ms_voxel_normal(normal, &grid, place));
        }
        assert_false(ms_voxel_normal(normal, &grid, (double[]){-8, 10, 10}));
        assert_false(ms_voxel_normal(normal, &grid, (double[]){1e30, 10, 10}));
    }
    assert_true(ms_voxel_normal(normal, &grid, (double[]){-1.5, 14.2, 14.7}));
    expect_close(normal[0], -1, 1e-3);
    ms_grid_free(&grid);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(normals_are_those_of_planes_and_balls),
        cmocka_unit_test(faces_along_the_axes_are_exact),
        cmocka_unit_test(without_a_surface_there_is_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
