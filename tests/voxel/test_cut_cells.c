/* Cells cut by the surface, and what balls cover of them, against formulas; one by one: test_cut_parts.c. */
#include "support/clump_samples.h"
#include "voxel/ms_cut_left.h"

#include <omp.h>

static ms_cut_cells *cut(const ms_grid *grid, const ms_mesh *mesh)
{
    ms_cut_cells *cells;
    ms_error err = {{0}};
    if (ms_cut_cells_build(&cells, grid, mesh, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
    return cells;
}

static ms_mesh default_body(const char *name)
{
    double value[MS_SHAPE_MAX_PARAMETERS];
    default_values(value, ms_shape_find(name, NULL));
    return make_body(name, value);
}

static double volume_in(const ms_cut_cells *cells, int64_t weight)
{
    return (double)weight / MS_CUT_WHOLE * cells->h * cells->h * cells->h;
}

/* All of the volume is in the cells, and its centre where it is, however coarse they are. */
static void cells_have_the_volume_and_the_centre(void **state)
{
    (void)state;
    static const char *const KINDS[] = {"ball", "torus", "grain", "box", "tablet"};
    for (size_t s = 0; s < sizeof KINDS / sizeof *KINDS; s++) {
        ms_mesh mesh = default_body(KINDS[s]);
        move_body(&mesh, 3.3, -7.1, 0.77);
        for (double h = 0.31; h > 0.1; h /= 2.9) {
            ms_target target = target_of(&mesh, h, MS_VOXEL_HALF);
            ms_cut_cells *cells = cut(&target.grid, &mesh);
            double moment[3] = {0}, volume = 0;
            for (size_t c = 0; c < cells->count; c++) {
                const ms_cut_cell *cell = &cells->cell[c];
                for (int a = 0; a < 3; a++) {
                    moment[a] += cell->weight * (cells->origin[a] + h * (double)cell->at[a]);
                }
                volume += cell->weight;
            }
            for (size_t v = 0; v < ms_grid_voxels(&target.grid); v++) {
                const size_t nx = (size_t)cells->n[0], ny = (size_t)cells->n[1];
                const size_t at[3] = {v % nx, v / nx % ny, v / nx / ny};
                for (int a = 0; a < 3 && cells->whole[v]; a++) {
                    moment[a] += MS_CUT_WHOLE * (cells->origin[a] + h * (double)at[a]);
                }
                volume += cells->whole[v] ? MS_CUT_WHOLE : 0;
            }
            assert_true(volume == (double)cells->total);
            expect_close(volume_in(cells, cells->total) / target.body.volume, 1, 1e-6);
            for (int a = 0; a < 3; a++) {
                expect_close(moment[a] / volume, target.body.centroid[a], 1e-6);
            }
            ms_cut_cells_free(cells);
            ms_target_free(&target);
        }
        ms_mesh_free(&mesh);
    }
}

static double covered_share(const ms_cut_cells *cells, const ms_ball *ball, size_t count)
{
    ms_cut_left *left = ms_cut_left_build(cells);
    int64_t sum = 0;
    assert_non_null(left);
    for (size_t b = 0; b < count; b++) {
        const int64_t would = ms_cut_left_count(left, &ball[b]);
        const int64_t does = ms_cut_left_cover(left, &ball[b], NULL);
        assert_true(would == does && ms_cut_left_count(left, &ball[b]) == 0);
        sum += does;
    }
    ms_cut_left_free(left);
    return (double)sum / (double)cells->total;
}

/* Balls of many radii near the centre, root mean square: the error falls as the square of h. */
static void balls_converge_at_second_order(void **state)
{
    (void)state;
    ms_mesh mesh = make_body("ball", (double[]){1, 160});
    double error[3] = {0};
    const double body = volume_of(&mesh);
    for (int level = 0; level < 3; level++) {
        const double h = 0.13 / (1 << level);
        ms_target target = target_of(&mesh, h, MS_VOXEL_CENTRE);
        ms_cut_cells *cells = cut(&target.grid, &mesh);
        int count = 0;
        uint64_t seed = 5;
        for (double radius = 0.5; radius < 0.7; radius += 0.0013, count++) {
            const ms_sphere sphere = {{0.1 * next_uniform(&seed), 0.1 * next_uniform(&seed), 0.1 * next_uniform(&seed)},
                                      radius};
            const ms_ball ball = ms_grid_ball(&target.grid, &sphere);
            error[level] += pow(covered_share(cells, &ball, 1) - ball_volume(radius) / body, 2);
        }
        error[level] = sqrt(error[level] / count);
        const ms_sphere all = {{0, 0, 0}, 1};
        const ms_ball ball = ms_grid_ball(&target.grid, &all);
        assert_true(covered_share(cells, &ball, 1) == 1);
        ms_cut_cells_free(cells);
        ms_target_free(&target);
    }
    assert_true(error[0] < 0.01 && error[0] > 3.5 * error[1] && error[1] > 3.5 * error[2]);
    ms_mesh_free(&mesh);
}

/* Two balls in a box: the volume of their union, by formula. */
static void two_balls_cover_their_union(void **state)
{
    (void)state;
    ms_mesh mesh = make_body("box", (double[]){4, 3, 2.5, 2});
    ms_target target = target_of(&mesh, 0.051, MS_VOXEL_CENTRE);
    ms_cut_cells *cells = cut(&target.grid, &mesh);
    for (double away = 0.11; away < 1.9; away += 0.237) {
        const double radius = 0.973, cap = radius - away / 2;
        const ms_sphere sphere[2] = {{{-away / 2, 0.1037, 0.2091}, radius}, {{away / 2, 0.1037, 0.2091}, radius}};
        const ms_ball ball[2] = {ms_grid_ball(&target.grid, &sphere[0]), ms_grid_ball(&target.grid, &sphere[1])};
        const double shared = 2 * pi * cap * cap * (3 * radius - cap) / 3;
        expect_close(covered_share(cells, ball, 2), (2 * ball_volume(radius) - shared) / 30, 6e-4);
    }
    ms_cut_cells_free(cells);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* Of a volume, or a mesh with holes, the voxels are the body. */
static void voxels_stand_whole_without_a_mesh(void **state)
{
    (void)state;
    ms_mesh mesh = default_body("grain");
    ms_target target = target_of(&mesh, 0.09, MS_VOXEL_CENTRE);
    ms_cut_cells *cells = cut(&target.grid, NULL);
    assert_true(cells->count == 0 && cells->total == (int64_t)target.voxels * MS_CUT_WHOLE);
    const ms_metrics m = measure_sphere(&target, 0.1, 0, 0, 0.6);
    const ms_sphere sphere = {{0.1, 0, 0}, 0.6};
    const ms_ball ball = ms_grid_ball(&target.grid, &sphere);
    expect_close(covered_share(cells, &ball, 1), m.score.coverage, 0);
    ms_cut_cells_free(cells);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

static void threads_change_nothing(void **state)
{
    (void)state;
    ms_mesh mesh = default_body("grain");
    ms_target target = target_of(&mesh, 0.02, MS_VOXEL_CENTRE);
    const int before = omp_get_max_threads();
    omp_set_num_threads(1);
    ms_cut_cells *one = cut(&target.grid, &mesh);
    omp_set_num_threads(5);
    ms_cut_cells *five = cut(&target.grid, &mesh);
    omp_set_num_threads(before);
    assert_true(one->count == five->count);
    assert_memory_equal(one->cell, five->cell, one->count * sizeof *one->cell);
    ms_cut_cells_free(one);
    ms_cut_cells_free(five);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cells_have_the_volume_and_the_centre),
        cmocka_unit_test(balls_converge_at_second_order),
        cmocka_unit_test(two_balls_cover_their_union),
        cmocka_unit_test(voxels_stand_whole_without_a_mesh),
        cmocka_unit_test(threads_change_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
