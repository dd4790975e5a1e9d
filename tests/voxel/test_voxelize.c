/* Meshes to voxels: bodies whose voxels are known by arithmetic, limits and errors. */
#include "support/grid_samples.h"

static const ms_voxel_rule both_rules[] = {MS_VOXEL_HALF, MS_VOXEL_CENTRE};

static void expect_refused(const ms_mesh *mesh, double h, ms_status status, const char *message)
{
    for (int open = 0; open < 2; open++) {
        ms_grid grid;
        size_t disagree;
        ms_error err = {{0}};
        const ms_status got =
            open ? ms_voxelize_open(&grid, &disagree, mesh, h, &err) : ms_voxelize(&grid, mesh, h, MS_VOXEL_HALF, &err);
        assert_int_equal(got, status);
        expect_message(&err, message);
        assert_null(grid.inside);
    }
}

static void bad_arguments_are_refused(void **state)
{
    (void)state;
    ms_mesh cube = unit_cube(), none = {0};
    expect_refused(&cube, 0, MS_ERR_ARG, "voxel size 0");
    expect_refused(&cube, -0.1, MS_ERR_ARG, "voxel size -0.1");
    expect_refused(&cube, (double)NAN, MS_ERR_ARG, "voxel size");
    expect_refused(&cube, HUGE_VAL, MS_ERR_ARG, "voxel size");
    expect_refused(&none, 1, MS_ERR_ARG, "no triangles");
    expect_refused(&cube, 1e-6, MS_ERR_LIMIT, "larger voxel size");
    expect_refused(&cube, 1e-300, MS_ERR_LIMIT, "larger voxel size");
    cube.vertex[7][1] = 1e308;
    cube.vertex[0][1] = -1e308;
    expect_refused(&cube, 1, MS_ERR_LIMIT, "along y");
    cube.vertex[7][1] = (double)NAN;
    expect_refused(&cube, 1, MS_ERR_ARG, "not a finite number");
    cube.vertex[7][1] = HUGE_VAL;
    expect_refused(&cube, 1, MS_ERR_ARG, "not a finite number");
    ms_mesh_free(&cube);
}

static void what_is_thinner_than_half_a_voxel_is_refused(void **state)
{
    (void)state;
    ms_mesh plate = cuboid(0, 8, 0, 8, 0, 0.4);
    ms_mesh needle = cuboid(0, 8, 0, 0.7, 0, 0.7);
    ms_error err = {{0}};
    ms_grid grid;
    assert_int_equal(ms_voxelize(&grid, &plate, 1, MS_VOXEL_HALF, &err), MS_ERR_SHAPE);
    expect_message(&err, "use more cells");
    assert_null(grid.inside);
    assert_int_equal(ms_voxelize(&grid, &needle, 1, MS_VOXEL_HALF, NULL), MS_ERR_SHAPE); /* 0.49 of each voxel */
    /* The box is centred, so that the plate's voxels have their centres in it. */
    grid = voxels_of(&plate, 1, MS_VOXEL_CENTRE);
    assert_int_equal(ms_grid_count(&grid), 64);
    ms_grid_free(&grid);
    ms_mesh_free(&plate);
    ms_mesh_free(&needle);
    needle = cuboid(0, 8, 0, 0.76, 0, 0.76); /* 0.5776 */
    grid = voxels_of(&needle, 1, MS_VOXEL_HALF);
    assert_int_equal(ms_grid_count(&grid), 8);
    ms_grid_free(&grid);
    ms_mesh_free(&needle);
}

static void a_cube_of_whole_voxels_is_exact(void **state)
{
    (void)state;
    for (int cells = 1; cells <= 12; cells++) {
        for (int r = 0; r < 2; r++) {
            ms_mesh cube = cuboid(0.1, 0.1 + 2.385, -7, -7 + 2.385, 0, 2.385);
            ms_grid grid = voxels_of(&cube, 2.385 / cells, both_rules[r]);
            for (int a = 0; a < 3; a++) {
                assert_int_equal(grid.n[a], cells + 2 * MS_GRID_HULL);
            }
            assert_int_equal(ms_grid_count(&grid), cells * cells * cells);
            expect_hull(&grid);
            expect_mirrored(&grid);
            ms_grid_free(&grid);
            ms_mesh_free(&cube);
        }
    }
}

/* Length of a voxel at i that lies between lo and hi. */
static double share(int i, double lo, double hi)
{
    return fmax(0, fmin(hi, i + 0.5) - fmax(lo, i - 0.5));
}

/* A box of 10 x 11 x 12 voxels, pinned by two corner cubes, with a cuboid inside it: the
 * cuboid's faces then stand where the test wants them. Voxel centres are at whole numbers. */
static void expect_cuboid(const double lo[3], const double hi[3])
{
    for (int r = 0; r < 2; r++) {
        ms_mesh mesh = cuboid(-0.5, 0.5, -0.5, 0.5, -0.5, 0.5);
        add_part(&mesh, cuboid(8.5, 9.5, 9.5, 10.5, 10.5, 11.5));
        add_part(&mesh, cuboid(lo[0], hi[0], lo[1], hi[1], lo[2], hi[2]));
        ms_grid grid = voxels_of(&mesh, 1, both_rules[r]);
        for (int k = 0; k < 12; k++) {
            for (int j = 0; j < 11; j++) {
                for (int i = 0; i < 10; i++) {
                    const double x = share(i, lo[0], hi[0]), y = share(j, lo[1], hi[1]), z = share(k, lo[2], hi[2]);
                    const int centred = i > lo[0] && i < hi[0] && j > lo[1] && j < hi[1] && k > lo[2] && k < hi[2];
                    const int pinned = (i == 0 && j == 0 && k == 0) || (i == 9 && j == 10 && k == 11);
                    const int expected = pinned || (r == 0 ? x * y * z > 0.5 : centred);
                    if (inside_at(&grid, i + 2, j + 2, k + 2) != expected) {
                        fail_msg("rule %d, voxel (%d, %d, %d) is not %d", r, i, j, k, expected);
                    }
                }
            }
        }
        ms_grid_free(&grid);
        ms_mesh_free(&mesh);
    }
}

/* (0.1 + 0.2) / 0.1 is a little more than 3. */
static void rounding_adds_no_voxel(void **state)
{
    (void)state;
    ms_mesh cube = cuboid(0, 0.1 + 0.2, 0, 0.1 + 0.2, 0, 0.1 + 0.2);
    assert_true(ceil((0.1 + 0.2) / 0.1) > 3.5);
    ms_grid grid = voxels_of(&cube, 0.1, MS_VOXEL_HALF);
    assert_int_equal(grid.n[0], 3 + 2 * MS_GRID_HULL);
    assert_int_equal(ms_grid_count(&grid), 27);
    ms_grid_free(&grid);
    ms_mesh_free(&cube);
}

/* A side that is a hair longer or shorter than a number of voxels must not gain or lose a layer, whatever its axis. */
static void a_hair_adds_no_layer(void **state)
{
    (void)state;
    static const double hair[] = {1e-5, 1e-6, 3e-3, -1e-6, -1e-5, -3e-3};
    for (size_t m = 0; m < 3 * sizeof hair / sizeof *hair; m++) {
        double side[3] = {1, 1, 1};
        side[m % 3] += hair[m / 3];
        for (int r = 0; r < 2; r++) {
            ms_mesh box = cuboid(0, side[0], 0, side[1], 0, side[2]);
            ms_grid grid = voxels_of(&box, 0.01, both_rules[r]);
            assert_int_equal(ms_grid_count(&grid), 100 * 100 * 100);
            expect_hull(&grid);
            expect_mirrored(&grid);
            ms_grid_free(&grid);
            ms_mesh_free(&box);
        }
    }
}

/* However long a side is, the layers are as many as the nearest whole number of voxels. */
static void layers_are_the_nearest_number(void **state)
{
    (void)state;
    for (int step = 1; step < 40; step++) {
        const double side = 6 + 0.05 * step + 0.003;
        for (int axis = 0; axis < 3; axis++) {
            double hi[3] = {5, 5, 5};
            hi[axis] = side;
            ms_mesh box = cuboid(0, hi[0], 0, hi[1], 0, hi[2]);
            ms_grid grid = voxels_of(&box, 1, MS_VOXEL_HALF);
            assert_int_equal(ms_grid_count(&grid), 25 * (int)rint(side));
            ms_grid_free(&grid);
            ms_mesh_free(&box);
        }
    }
}

/* The extents by the documented rule, not by the code: the nearest whole numbers and the hull. */
static double count_by_rule(const double side[3], double cells)
{
    double total = 1;
    for (int a = 0; a < 3; a++) {
        const double n = side[a] / side[0] * cells;
        total *= fmax(1, n - floor(n) > 0.5 + 1e-6 ? ceil(n) : floor(n)) + 2 * MS_GRID_HULL;
    }
    return total;
}

static void so_many_voxels_at_most(void **state)
{
    /* The shortest side is that along x. The last asks for 30,000 cells in length before it has 1e6 voxels. */
    static const double side[][3] = {{1, 1, 1}, {0.01, 1, 1}, {0.3, 0.7, 1.1}, {1, 1, 900}};
    (void)state;
    for (int s = 0; s < 4; s++) {
        ms_mesh mesh = cuboid(0, side[s][0], 0, side[s][1], 0, side[s][2]);
        double least = count_by_rule(side[s], 1), h, n[3];
        ms_error err;
        for (double most = least; most < 1e8; most *= 1.7) {
            assert_int_equal(ms_voxelize_size_within(&h, &mesh, most, &err), MS_OK);
            ms_voxelize_extents(n, &mesh, h);
            const double cells = side[s][0] / h;
            expect_close(cells, round(cells), 1e-9 * cells);
            assert_true(n[0] * n[1] * n[2] <= most);
            assert_true(n[0] * n[1] * n[2] == count_by_rule(side[s], round(cells)));
            assert_true(count_by_rule(side[s], round(cells) + 1) > most ||
                        side[s][2] / side[s][0] * (cells + 1) > 32763);
        }
        assert_int_equal(ms_voxelize_size_within(&h, &mesh, least - 1, &err), MS_ERR_LIMIT);
        expect_message(&err, "are too few");
        assert_int_equal(ms_voxelize_size_within(&h, &mesh, 0, &err), MS_ERR_ARG);
        assert_int_equal(ms_voxelize_size_within(&h, &mesh, (double)NAN, &err), MS_ERR_ARG);
        assert_int_equal(ms_voxelize_size_within(&h, &mesh, HUGE_VAL, &err), MS_ERR_ARG);
        ms_mesh_free(&mesh);
    }
    ms_mesh flat = cuboid(0, 1, 0, 1, 0, 0);
    double h;
    assert_int_equal(ms_voxelize_size_within(&h, &flat, 1e6, NULL), MS_ERR_SHAPE);
    ms_mesh_free(&flat);
}

static void faces_may_stand_anywhere_in_a_voxel(void **state)
{
    (void)state;
    const int before = omp_get_max_threads();
    omp_set_num_threads(1); /* many small grids */
    /* Fractions of a voxel: its face, its centre (half covered is not inside), quarters, eighths.
     * Across the rays every multiple of 1/8 is exact, along them any place. */
    static const double at[] = {-0.5, -0.25, -0.125, 0, 0.125, 0.25, 0.375, 0.499, 0.001};
    enum { COUNT = sizeof at / sizeof *at };
    for (int m = 0; m < COUNT; m++) {
        for (int o = 0; o < COUNT; o++) {
            const double a = at[m], b = at[o], c = at[(m + 2 * o) % COUNT];
            const double lo[3] = {2 + a, 3 + b, 2 + c}, hi[3] = {6 + b, 7 + c, 9 + a};
            const double lo_x[3] = {2 + a, 1.5, 1.5}, hi_x[3] = {6 + b, 6.5, 7.5};
            expect_cuboid(lo_x, hi_x);
            if (m < COUNT - 2 && o < COUNT - 2 && (m + 2 * o) % COUNT < COUNT - 2) {
                expect_cuboid(lo, hi);
            }
        }
    }
    omp_set_num_threads(before);
}

/* Voxels of a cube of `cells` voxels whose centres are in the octahedron |x|+|y|+|z| < radius. */
static size_t octahedron_voxels(int cells, double radius)
{
    size_t count = 0;
    for (int c = 0; c < cells * cells * cells; c++) {
        const double middle = 0.5 * (cells - 1);
        const double x = c % cells - middle, y = c / cells % cells - middle, z = c / cells / cells - middle;
        count += fabs(x) + fabs(y) + fabs(z) < radius;
    }
    return count;
}

static void an_octahedron_on_the_lattice_is_exact(void **state)
{
    (void)state;
    for (int radius = 2; radius <= 9; radius++) {
        /* Centres at halves: the faces cut voxels into 1/6 and 5/6, so that both rules agree.
         * Then, with pins that make the box odd, at whole numbers: the vertices and faces go
         * right through centres, which leaves half of a voxel or less. */
        for (int pinned = 0; pinned < 2; pinned++) {
            ms_mesh body = make_body("octahedron", (double[]){radius, 2});
            const int cells = 2 * radius + 3 * pinned;
            if (pinned) {
                const double far = 0.5 * cells, near = far - 1;
                add_part(&body, cuboid(-far, -near, -far, -near, -far, -near));
                add_part(&body, cuboid(near, far, near, far, near, far));
            }
            for (int r = 0; r < 2; r++) {
                ms_grid grid = voxels_of(&body, 1, both_rules[r]);
                if (!pinned) {
                    expect_mirrored(&grid);
                }
                assert_int_equal(ms_grid_count(&grid), octahedron_voxels(cells, radius) + (pinned ? 2 : 0));
                ms_grid_free(&grid);
            }
            ms_mesh_free(&body);
        }
    }
}

static void a_mesh_snapped_to_the_lattice_stays_symmetric(void **state)
{
    (void)state;
    for (int cells = 4; cells <= 13; cells++) {
        ms_mesh body = make_body("ellipsoid", (double[]){2, 1.3, 1, 7});
        const double h = 2.0 / cells;
        for (size_t v = 0; v < body.n_vertices; v++) {
            for (int a = 0; a < 3; a++) {
                body.vertex[v][a] = h / 2 * rint(body.vertex[v][a] / (h / 2));
            }
        }
        for (int r = 0; r < 2; r++) {
            ms_grid grid = voxels_of(&body, h, both_rules[r]);
            expect_mirrored(&grid);
            ms_grid_free(&grid);
        }
        ms_mesh_free(&body);
    }
}

typedef struct round_body {
    const char *kind;
    double value[4];
    double volume;
} round_body;

static void volumes_converge_and_grids_are_symmetric(void **state)
{
    (void)state;
    const round_body bodies[] = {
        {"ball", {1.03, 48}, 4.0 / 3 * pi * 1.03 * 1.03 * 1.03},
        {"ellipsoid", {2, 1, 1.1, 48}, 4.0 / 3 * pi * 2.2},
        {"torus", {1.5, 0.6, 40}, 2 * pi * pi * 1.5 * 0.36},
        /* A band and two caps of a ball, pi c (3 r^2 + c^2) / 6 each. */
        {"tablet", {1.4, 1, 0.4, 48}, pi * 1.96 + pi * 0.4 * (3 * 1.96 + 0.16) / 3},
    };
    for (size_t b = 0; b < sizeof bodies / sizeof *bodies; b++) {
        ms_mesh mesh = make_body(bodies[b].kind, bodies[b].value);
        for (int r = 0; r < 2; r++) {
            double worst = 0;
            for (double h = 0.2; h > 0.04; h *= 0.61) {
                ms_grid grid = voxels_of(&mesh, h, both_rules[r]);
                expect_mirrored(&grid);
                expect_hull(&grid);
                worst = fabs((double)ms_grid_count(&grid) * h * h * h / bodies[b].volume - 1);
                ms_grid_free(&grid);
            }
            assert_true(worst < 0.006); /* h 0.045: some 15 voxels along the least radius */
        }
        ms_mesh_free(&mesh);
    }
}

/* A box of whole voxels on a moved lattice: less than half a voxel away each is inside as before, further on the next
 * one; its centres have moved with the lattice. */
static void a_moved_lattice_moves_the_voxels(void **state)
{
    (void)state;
    ms_mesh box = cuboid(-1, 3, 0, 5, 2, 8); /* 4 x 5 x 6 */
    static const double SHIFT[3] = {0.25, 0, 0.75};
    for (int kind = 0; kind < 3; kind++) {
        ms_grid still = voxels_of(&box, 1, MS_VOXEL_HALF), grid;
        size_t disagree = 0;
        assert_int_equal(kind < 2 ? ms_voxelize_moved(&grid, &box, 1, both_rules[kind], SHIFT, NULL)
                                  : ms_voxelize_open_moved(&grid, &disagree, &box, 1, SHIFT, NULL),
                         MS_OK);
        assert_int_equal(disagree, 0);
        assert_int_equal(ms_grid_count(&grid), 4 * 5 * 6);
        expect_hull(&grid);
        for (int a = 0; a < 3; a++) {
            assert_true(grid.origin[a] == still.origin[a] - SHIFT[a]);
            assert_int_equal(grid.n[a], still.n[a] + (SHIFT[a] > 0));
        }
        const int first = MS_GRID_HULL; /* along z the first layer holds a quarter of the box alone */
        assert_int_equal(grid.inside[ms_grid_index(&grid, first, first, first)], 0);
        assert_int_equal(grid.inside[ms_grid_index(&grid, first, first, first + 1)], 1);
        assert_int_equal(grid.inside[ms_grid_index(&grid, first + 3, first + 4, first + 6)], 1);
        assert_int_equal(grid.inside[ms_grid_index(&grid, first + 4, first, first + 1)], 0);
        ms_grid_free(&still);
        ms_grid_free(&grid);
    }
    for (int bad = 0; bad < 2; bad++) {
        ms_grid grid;
        ms_error err = {{0}};
        const double shift[3] = {0, bad ? 1 : -0.1, 0};
        assert_int_equal(ms_voxelize_moved(&grid, &box, 1, MS_VOXEL_HALF, shift, &err), MS_ERR_ARG);
        expect_message(&err, bad ? "not by 1" : "not by -0.1");
        assert_null(grid.inside);
    }
    ms_mesh_free(&box);
}

static void a_cavity_stays_empty(void **state)
{
    (void)state;
    ms_mesh hollow = make_body("hollow", (double[]){1, 0.5, 16});
    ms_mesh_report report = repair_body(&hollow);
    assert_int_equal(report.cavities, 1);
    for (int r = 0; r < 2; r++) {
        ms_grid grid = voxels_of(&hollow, 0.1, both_rules[r]);
        const int middle = grid.n[0] / 2;
        assert_int_equal(inside_at(&grid, middle, middle, middle), 0);
        assert_int_equal(inside_at(&grid, middle + 7, middle, middle), 1);
        expect_close((double)ms_grid_count(&grid) * 1e-3, 4.0 / 3 * pi * (1 - 0.125), 0.1);
        ms_grid_free(&grid);
    }
    ms_mesh_free(&hollow);
}

static void a_far_mesh_has_the_same_voxels(void **state)
{
    (void)state;
    ms_mesh body = make_body("ellipsoid", (double[]){64, 32, 48, 12});
    for (size_t v = 0; v < body.n_vertices; v++) {
        for (int a = 0; a < 3; a++) {
            body.vertex[v][a] = rint(body.vertex[v][a] * 1024) / 1024; /* not lost a thousand million away */
        }
    }
    ms_grid near = voxels_of(&body, 4.1, MS_VOXEL_HALF);
    move_body(&body, 1e9, -1e9, 1e9);
    ms_grid away = voxels_of(&body, 4.1, MS_VOXEL_HALF);
    assert_true(same_voxels(&near, &away));
    expect_close(away.origin[0] - near.origin[0], 1e9, 1e-6);
    expect_close(away.origin[1] - near.origin[1], -1e9, 1e-6);
    ms_grid_free(&near);
    ms_grid_free(&away);
    ms_mesh_free(&body);
}

static void any_number_of_threads_gives_the_same_bits(void **state)
{
    (void)state;
    const int before = omp_get_max_threads();
    ms_mesh body = make_body("torus", (double[]){1.5, 0.6, 20});
    for (int r = 0; r < 3; r++) {
        ms_grid grid[3];
        for (int threads = 1; threads <= 3; threads++) {
            size_t disagree;
            omp_set_num_threads(threads);
            if (r < 2) {
                grid[threads - 1] = voxels_of(&body, 0.07, both_rules[r]);
            } else {
                assert_int_equal(ms_voxelize_open(&grid[threads - 1], &disagree, &body, 0.07, NULL), MS_OK);
                assert_true(disagree < 20); /* centres on the surface, but for the rounding across the rays */
            }
        }
        assert_true(same_voxels(&grid[0], &grid[1]) && same_voxels(&grid[0], &grid[2]));
        for (int g = 0; g < 3; g++) {
            ms_grid_free(&grid[g]);
        }
    }
    omp_set_num_threads(before);
    ms_mesh_free(&body);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_arguments_are_refused),
        cmocka_unit_test(what_is_thinner_than_half_a_voxel_is_refused),
        cmocka_unit_test(a_cube_of_whole_voxels_is_exact),
        cmocka_unit_test(rounding_adds_no_voxel),
        cmocka_unit_test(a_hair_adds_no_layer),
        cmocka_unit_test(layers_are_the_nearest_number),
        cmocka_unit_test(so_many_voxels_at_most),
        cmocka_unit_test(faces_may_stand_anywhere_in_a_voxel),
        cmocka_unit_test(an_octahedron_on_the_lattice_is_exact),
        cmocka_unit_test(a_mesh_snapped_to_the_lattice_stays_symmetric),
        cmocka_unit_test(volumes_converge_and_grids_are_symmetric),
        cmocka_unit_test(a_moved_lattice_moves_the_voxels),
        cmocka_unit_test(a_cavity_stays_empty),
        cmocka_unit_test(a_far_mesh_has_the_same_voxels),
        cmocka_unit_test(any_number_of_threads_gives_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
