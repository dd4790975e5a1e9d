/* Cells cut by the surface: against formulas, and against points counted one by one. */
#include "support/clump_samples.h"
#include "voxel/ms_cut_cells.h"

#include <omp.h>

#include "mesh/ms_closest.h"

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

/* What lies below n.x = d of the unit cube; all n above 0. */
static double half_space_in_cube(const double n[3], double d)
{
    double sum = 0;
    for (int corner = 0; corner < 8; corner++) {
        double rest = d;
        int sign = 1;
        for (int a = 0; a < 3; a++) {
            rest -= corner >> a & 1 ? n[a] : 0;
            sign = corner >> a & 1 ? -sign : sign;
        }
        sum += sign * pow(fmax(0, rest), 3);
    }
    return sum / (6 * n[0] * n[1] * n[2]);
}

/* A tetrahedron x, y, z >= 0, n.x <= d: cells away from its other faces are cubes cut by a half-space. */
static void half_spaces_cut_cubes(void **state)
{
    (void)state;
    const double n[3] = {0.31, 0.57, 0.43}, d = 1.237;
    double corner[4][3] = {{0}};
    uint32_t face[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    for (int a = 0; a < 3; a++) {
        corner[a + 1][a] = d / n[a];
    }
    const ms_mesh mesh = {.vertex = corner, .n_vertices = 4, .triangle = face, .n_triangles = 4};
    ms_target target = target_of(&mesh, 0.21, MS_VOXEL_CENTRE);
    ms_cut_cells *cells = cut(&target.grid, &mesh);
    size_t partial = 0;
    for (size_t c = 0; c < cells->count; c++) {
        double low[3], at = 0;
        int inner = 1;
        for (int a = 0; a < 3; a++) { /* the lower corner of the cell */
            low[a] = cells->origin[a] + cells->h * (floor(2 * ((double)cells->cell[c].at[a] + 0.5)) / 2 - 0.5);
            inner &= low[a] > 0;
            at += n[a] * low[a];
        }
        if (inner) {
            const double side = cells->h / 2, expected = half_space_in_cube(n, (d - at) / side) / 8;
            expect_close((double)cells->cell[c].weight / MS_CUT_WHOLE, expected, 2e-7);
            partial += expected < 0.1249;
        }
    }
    assert_true(partial > 100);
    expect_close(volume_in(cells, cells->total), d * d * d / (6 * n[0] * n[1] * n[2]), 1e-6);
    ms_cut_cells_free(cells);
    ms_target_free(&target);
}

/* All of the volume is in the cells, and its centre where it is, however coarse they are. */
static void cells_have_the_volume_and_the_centre(void **state)
{
    (void)state;
    static const char *const KINDS[] = {"ball", "torus", "grain", "box", "tablet"};
    for (size_t s = 0; s < sizeof KINDS / sizeof *KINDS; s++) {
        ms_mesh mesh = default_body(KINDS[s]);
        move_body(&mesh, 3.3, -7.1, 0.77);
        for (double h = 0.31; h > 0.04; h /= 2.3) {
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

/* Each part of a cell by points of which the mesh says whether they are inside. */
static void points_agree(void **state)
{
    (void)state;
    enum { POINTS = 8 };
    ms_mesh mesh = default_body("torus");
    ms_target target = target_of(&mesh, 0.23, MS_VOXEL_CENTRE);
    ms_cut_cells *cells = cut(&target.grid, &mesh);
    double worst = 0, drift = 0;
    size_t looked_at = 0;
    for (size_t c = 0; c < cells->count; c += 11) {
        const ms_cut_cell *cell = &cells->cell[c];
        const double whole = 0.5;
        double low[3], sum[3] = {0}, inside = 0;
        for (int a = 0; a < 3; a++) {
            low[a] = floor(((double)cell->at[a] + 0.5) / whole) * whole - 0.5;
        }
        for (int p = 0; p < POINTS * POINTS * POINTS; p++) {
            const int step[3] = {p % POINTS, p / POINTS % POINTS, p / (POINTS * POINTS)};
            double at[3], place[3];
            for (int a = 0; a < 3; a++) {
                at[a] = low[a] + whole * (step[a] + 0.5) / POINTS;
            }
            ms_grid_place(place, &target.grid, at);
            if (ms_closest_signed_distance(target.closest, place) < 0) {
                inside++;
                for (int a = 0; a < 3; a++) {
                    sum[a] += at[a];
                }
            }
        }
        const double share = inside / (POINTS * POINTS * POINTS);
        worst = fmax(worst, fabs(share - cell->weight / (whole * whole * whole * MS_CUT_WHOLE)));
        for (int a = 0; a < 3 && share > 0.2; a++) {
            drift = fmax(drift, fabs(sum[a] / inside - (double)cell->at[a]) / whole);
        }
        looked_at++;
    }
    assert_true(looked_at > 100);
    expect_close(worst, 0, 0.04);
    expect_close(drift, 0, 0.04);
    ms_cut_cells_free(cells);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

static double covered_share(const ms_cut_cells *cells, const ms_ball *ball, size_t count)
{
    uint8_t *left = ms_cut_cells_left(cells);
    int64_t sum = 0;
    assert_non_null(left);
    for (size_t b = 0; b < count; b++) {
        const int64_t would = ms_cut_cells_count(cells, left, &ball[b]);
        const int64_t does = ms_cut_cells_cover(cells, left, &ball[b]);
        assert_true(would == does && ms_cut_cells_count(cells, left, &ball[b]) == 0);
        sum += does;
    }
    free(left);
    return (double)sum / (double)cells->total;
}

/* Concentric balls, root mean square over many radii: the error falls as the square of h. */
static void balls_converge_at_second_order(void **state)
{
    (void)state;
    ms_mesh mesh = make_body("ball", (double[]){1, 160});
    double error[3] = {0};
    const double body = volume_of(&mesh);
    for (int level = 0; level < 3; level++) {
        const double h = 0.17 / (1 << level);
        ms_target target = target_of(&mesh, h, MS_VOXEL_CENTRE);
        ms_cut_cells *cells = cut(&target.grid, &mesh);
        int count = 0;
        for (double radius = 0.5; radius < 0.8; radius += 0.0023, count++) {
            const ms_sphere sphere = {{0.013, -0.021, 0.007}, radius};
            const ms_ball ball = ms_grid_ball(&target.grid, &sphere);
            error[level] += pow(covered_share(cells, &ball, 1) - ball_volume(fmin(radius, 1)) / body, 2);
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
        cmocka_unit_test(half_spaces_cut_cubes),
        cmocka_unit_test(cells_have_the_volume_and_the_centre),
        cmocka_unit_test(points_agree),
        cmocka_unit_test(balls_converge_at_second_order),
        cmocka_unit_test(two_balls_cover_their_union),
        cmocka_unit_test(voxels_stand_whole_without_a_mesh),
        cmocka_unit_test(threads_change_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
