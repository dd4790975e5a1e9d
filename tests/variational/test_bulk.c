/* Shapes of which inscribed spheres cover next to nothing, and D of large spheres about them. */
#include "support/variational_samples.h"

#include <string.h>

#include "variational/ms_bulk.h"
#include "variational/ms_dice.h"

static const double PI = 3.14159265358979323846;

/* Two balls of radius 10, their centres 12 apart and one in a corner of the grid's box; the shape is the other. */
static void dice_counts_beyond_the_grid(void **state)
{
    (void)state;
    enum { SIDE = 60 };
    uint8_t *inside = calloc(SIDE * SIDE * SIDE, 1);
    assert_non_null(inside);
    ms_grid grid = {.n = {SIDE, SIDE, SIDE}, .h = 1, .inside = inside};
    const ms_ball ball[2] = {{{11.3, 29.7, 30.1}, 10}, {{-0.7, 29.7, 30.1}, 10}};
    for (int v = 0; v < SIDE * SIDE * SIDE; v++) {
        const double p[3] = {v % SIDE, v / SIDE % SIDE, v / SIDE / SIDE};
        inside[v] = ms_squared_distance(p, ball[0].centre) <= 100;
    }
    const double one = 4 * PI / 3 * 1000, lens = PI * (40 + 12) * (20 - 12) * (20 - 12) / 12; /* of equal balls */
    const size_t voxels = ms_grid_count(&grid);
    ms_error err;
    double dice;
    assert_int_equal(ms_dice_compute(&dice, &grid, voxels, ball, 1, &err), MS_OK);
    assert_true(fabs(dice) < 1e-3);
    assert_int_equal(ms_dice_compute(&dice, &grid, voxels, ball + 1, 1, &err), MS_OK);
    assert_true(fabs(dice - (1 - lens / one)) < 2e-3);
    assert_int_equal(ms_dice_compute(&dice, &grid, voxels, ball, 2, &err), MS_OK);
    assert_true(fabs(dice - (1 - 2 * one / (3 * one - lens))) < 1e-3);
    assert_int_equal(ms_dice_compute(&dice, &grid, voxels, ball, 0, &err), MS_OK);
    assert_true(dice == 1);
    free(inside);
}

/* Four boxes apart: a cluster is in each, with its second moment a^2 / 12 along each axis, 3/5 R^2 in all. */
static void clusters_are_found(void **state)
{
    (void)state;
    enum { SIDE = 80, BOX = 11 };
    static const int AT[4][3] = {{5, 5, 5}, {60, 10, 20}, {20, 62, 8}, {40, 40, 61}};
    uint8_t *inside = calloc(SIDE * SIDE * SIDE, 1);
    assert_non_null(inside);
    ms_coarse_view view = {.step = 2, .grid = {.n = {SIDE, SIDE, SIDE}, .h = 1, .inside = inside}};
    for (int b = 0; b < 4; b++) {
        for (int v = 0; v < BOX * BOX * BOX; v++) {
            inside[ms_grid_index(&view.grid, AT[b][0] + v % BOX, AT[b][1] + v / BOX % BOX, AT[b][2] + v / BOX / BOX)] =
                1;
        }
    }
    ms_ball ball[6];
    size_t count;
    ms_error err;
    int found = 0;
    assert_int_equal(ms_bulk_cluster(ball, &count, &view, 4, &err), MS_OK);
    assert_int_equal(count, 4);
    for (size_t c = 0; c < count; c++) {
        for (int b = 0; b < 4; b++) {
            double truth[3];
            for (int a = 0; a < 3; a++) {
                truth[a] = 2 * (AT[b][a] + (BOX - 1) / 2.0);
            }
            if (sqrt(ms_squared_distance(ball[c].centre, truth)) < 0.5) {
                const double radius = 2 * sqrt(5.0 / 3 * 3 * (BOX * BOX - 1) / 12.0);
                assert_true(fabs(ball[c].radius - radius) < 0.2);
                found |= 1 << b;
            }
        }
    }
    assert_int_equal(found, 15);
    memset(inside, 0, SIDE * SIDE * SIDE);
    inside[12345] = inside[54321] = 1; /* fewer places than spheres */
    assert_int_equal(ms_bulk_cluster(ball, &count, &view, 6, &err), MS_OK);
    assert_int_equal(count, 2);
    free(inside);
}

/* Of a wide plate of thickness h and area A one ball of radius R holds pi R^2 h - pi h^3 / 12. */
static double find_least_dice_of_plate(double side, double thick)
{
    double least = 1;
    for (double r = thick; 2 * r < side; r += thick / 100) {
        const double both = PI * r * r * thick - PI * thick * thick * thick / 12;
        least = fmin(least, 1 - 2 * both / (side * side * thick + 4 * PI / 3 * r * r * r));
    }
    return least;
}

static void thin_walls_take_thick_spheres(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target;
    make_shape(&mesh, "plate", "a=20 b=20 c=2 fineness=4");
    make_target(&target, &mesh, 6, MS_VOXEL_CENTRE);
    const double truth = find_least_dice_of_plate(20, 2);
    assert_true(fabs(truth - 0.7261) < 1e-4); /* what the formula gives; at 2 R = 14.6 */
    ms_clump clump = generate(&target, 1, NULL);
    const double dice = dice_of(&target, &clump);
    print_message("one ball on a plate: D = %.4f, least possible %.4f\n", dice, truth);
    assert_true(fabs(dice - truth) < 0.01);
    ms_clump_free(&clump);

    /* No inscribed sphere is as large; refining does not lose what is large. */
    ms_clump large = run_generator(&ms_generator_variational, &target, (ms_stop){.spheres = 5, .radius = 2}, "", NULL);
    const double before = dice_of(&target, &large);
    assert_int_equal(large.n_spheres, 5);
    for (size_t s = 0; s < 5; s++) {
        assert_true(large.sphere[s].radius >= 2);
    }
    write_clump("test_bulk.csv", &large);
    ms_clump refined =
        run_generator(&ms_generator_variational, &target, (ms_stop){.spheres = 5}, "refine=test_bulk.csv", NULL);
    assert_true(dice_of(&target, &refined) <= before + 1e-3);
    ms_clump fewer =
        run_generator(&ms_generator_variational, &target, (ms_stop){.spheres = 4}, "refine=test_bulk.csv", NULL);
    print_message("five %.4f, refined %.4f, four of them %.4f\n", before, dice_of(&target, &refined),
                  dice_of(&target, &fewer));
    assert_int_equal(fewer.n_spheres, 4);
    assert_true(dice_of(&target, &fewer) < truth);
    remove("test_bulk.csv");
    ms_clump_free(&fewer);
    ms_clump_free(&refined);
    ms_clump_free(&large);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(dice_counts_beyond_the_grid),
        cmocka_unit_test(clusters_are_found),
        cmocka_unit_test(thin_walls_take_thick_spheres),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
