/* Set cover: spheres inside the mesh, on the medial surface, the paper's figures. */
#include "ms_generator_list.h"
#include "setcover/ms_medial.h"
#include "support/run_samples.h"

static ms_clump run_setcover(const ms_target *target, size_t spheres, const char *options)
{
    return run_generator(&ms_generator_setcover, target, (ms_stop){.spheres = spheres}, options, NULL);
}

static void target_of_deq(ms_target *target, const ms_mesh *mesh, double deq)
{
    ms_body body;
    ms_error err;
    assert_int_equal(ms_inertia_mesh(&body, mesh, &err), MS_OK);
    const double h = cbrt(6 * body.volume / acos(-1.0)) / deq;
    assert_int_equal(ms_target_from_mesh(target, mesh, 1, h, MS_VOXEL_HALF, &err), MS_OK);
}

/* No sphere leaves the mesh by more than rounding, whatever the candidates: however coarse the skeleton is, which
 * places them. */
static void spheres_are_inscribed(void **state)
{
    (void)state;
    static const char *const KINDS[] = {"ellipsoid", "hollow", "tablet",      "torus", "needle", "cone",
                                        "dumbbell",  "cube",   "tetrahedron", "plate", "grain"};
    static const char *const OPTIONS[] = {"skeleton-deq=40", "candidates=skeleton skeleton-deq=40",
                                          "candidates=all skeleton-deq=20", "skeleton=curve skeleton-deq=40",
                                          "align connected skeleton-deq=40"};
    for (size_t k = 0; k < sizeof KINDS / sizeof *KINDS; k++) {
        ms_mesh mesh;
        ms_target target;
        make_shape(&mesh, KINDS[k], "fineness=12"); /* coarse: facets and edges count */
        target_of_deq(&target, &mesh, 40);
        for (size_t o = 0; o < sizeof OPTIONS / sizeof *OPTIONS; o++) {
            ms_clump clump = run_setcover(&target, 60, OPTIONS[o]);
            for (size_t s = 0; s < clump.n_spheres; s++) {
                const double depth = -ms_closest_signed_distance(target.closest, clump.sphere[s].centre);
                assert_true(clump.sphere[s].radius <= depth + 1e-9 * ms_target_equivalent_radius(&target));
            }
            ms_clump_free(&clump);
        }
        ms_target_free(&target);
        ms_mesh_free(&mesh);
    }
}

/* Of a ball among voxels no sphere holds the centre of a voxel outside; the lattice takes every
 * third voxel. A least radius holds, too. */
static void volumes_have_inscribed_spheres(void **state)
{
    (void)state;
    enum { SIDE = 70 };
    static uint32_t label[SIDE * SIDE * SIDE];
    for (int v = 0; v < SIDE * SIDE * SIDE; v++) {
        const double x = v % SIDE - 34.3, y = v / SIDE % SIDE - 34.3, z = v / SIDE / SIDE - 34.3;
        label[v] = x * x + y * y + z * z < 30.0 * 30.0;
    }
    const ms_volume volume = {.n = {SIDE, SIDE, SIDE}, .spacing = 1, .label = label};
    ms_target target;
    ms_error err;
    assert_int_equal(ms_target_from_volume(&target, &volume, 0, &err), MS_OK);
    ms_clump large = run_generator(&ms_generator_setcover, &target, (ms_stop){.spheres = 60, .radius = 10}, "", NULL);
    assert_true(large.n_spheres > 1 && ms_clump_smallest_radius(&large) >= 10);
    ms_clump_free(&large);
    for (int align = 0; align < 2; align++) {
        ms_clump clump = run_setcover(&target, 30, align ? "skeleton-deq=20 align" : "skeleton-deq=20");
        assert_true(clump.sphere[0].radius > 28 && clump.sphere[0].radius < 30.5);
        for (size_t s = 0; s < clump.n_spheres; s++) {
            const ms_ball ball = ms_grid_ball(&target.grid, &clump.sphere[s]);
            for (size_t v = 0; v < ms_grid_voxels(&target.grid); v++) {
                const double x = (double)(v % (size_t)target.grid.n[0]) - ball.centre[0],
                             y = (double)(v / (size_t)target.grid.n[0] % (size_t)target.grid.n[1]) - ball.centre[1],
                             z = (double)(v / (size_t)target.grid.n[0] / (size_t)target.grid.n[1]) - ball.centre[2];
                assert_true(target.grid.inside[v] || x * x + y * y + z * z > ball.radius * ball.radius);
            }
        }
        ms_clump_free(&clump);
    }
    ms_target_free(&target);
}

static double roll_exactly(double centre[3], const ms_closest *closest, double stride, double tolerance)
{
    double nearest[3];
    const double radius = ms_closest_distance(nearest, closest, centre, HUGE_VAL);
    return ms_medial_sphere(centre, radius, nearest, closest, stride, tolerance);
}

/* In a plate the medial surface is the middle plane; from anywhere the new sphere holds the old. So do those of strides
 * that end beyond the medial surface, or outside. */
static void medial_spheres_are_maximal(void **state)
{
    (void)state;
    ms_mesh plate, grain;
    ms_closest *closest;
    ms_error err;
    make_shape(&plate, "plate", "a=5 b=5 c=0.5");
    assert_int_equal(ms_closest_build(&closest, &plate, &err), MS_OK);
    double lo[3], hi[3];
    ms_mesh_box(lo, hi, &plate);
    for (int i = 1; i < 10; i++) {
        double centre[3] = {0.5 * (lo[0] + hi[0]) + 0.1 * i, 0.5 * (lo[1] + hi[1]), lo[2] + 0.05 * i};
        const double stride = i % 3 == 0 ? 0.01 : i % 3 == 1 ? 0.4 : 3;
        assert_close(roll_exactly(centre, closest, stride, 1e-6), 0.25, 1e-5);
        assert_close(centre[2], 0.5 * (lo[2] + hi[2]), 1e-5);
    }
    ms_closest_free(closest);
    ms_mesh_free(&plate);
    make_shape(&grain, "grain", "");
    assert_int_equal(ms_closest_build(&closest, &grain, &err), MS_OK);
    srand(9);
    for (int i = 0; i < 300; i++) {
        double from[3], centre[3], moved = 0;
        for (int a = 0; a < 3; a++) {
            from[a] = centre[a] = 1.2 * rand() / RAND_MAX - 0.6;
        }
        const double radius = -ms_closest_signed_distance(closest, from);
        if (radius > 0) {
            const double grown = roll_exactly(centre, closest, i % 3 == 0 ? 0.02 : i % 3 == 1 ? 0.5 : 2, 1e-4);
            for (int a = 0; a < 3; a++) {
                moved += (centre[a] - from[a]) * (centre[a] - from[a]);
            }
            assert_close(-ms_closest_signed_distance(closest, centre), grown, 1e-9);
            assert_true(grown >= radius && grown >= radius + 0.9 * sqrt(moved) - 2e-4);
        }
    }
    ms_closest_free(closest);
    ms_mesh_free(&grain);
}

static double coverage_of(const ms_clump *clump, const ms_target *target, size_t spheres)
{
    ms_clump part = *clump;
    part.n_spheres = spheres < clump->n_spheres ? spheres : clump->n_spheres;
    return score_of(&part, target).coverage;
}

/* Yuan's shapes at d_eq/100: coverage by so many spheres (DESIGN.md: known figures). */
static void shapes_of_the_paper(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target;
    make_shape(&mesh, "ellipsoid", "a=6.585 b=6.585 c=3.395");
    target_of_deq(&target, &mesh, 100);
    ms_clump clump = run_setcover(&target, 181, "skeleton-deq=100");
    /* His 181 spheres cover 99 %; ours 98.98 % of voxels (docs/validation.md: a stricter count than his). */
    assert_true(coverage_of(&clump, &target, 48) >= 0.95 && coverage_of(&clump, &target, 181) >= 0.9897);
    ms_clump_free(&clump);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
    make_shape(&mesh, "tablet", "");
    target_of_deq(&target, &mesh, 100);
    clump = run_setcover(&target, 250, "");
    assert_true(coverage_of(&clump, &target, 96) >= 0.9504 && coverage_of(&clump, &target, 250) >= 0.9785);
    ms_clump_free(&clump);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* Every prefix of a dumbbell's clump is one piece, which it is not otherwise. */
static void connected_prefixes_are_one_piece(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target;
    ms_error err;
    size_t pieces;
    make_shape(&mesh, "dumbbell", "fineness=12");
    target_of_deq(&target, &mesh, 50);
    ms_clump loose = run_setcover(&target, 2, ""), clump = run_setcover(&target, 40, "connected skeleton-deq=40");
    assert_int_equal(ms_clump_pieces(&pieces, &loose, &err), MS_OK);
    assert_int_equal(pieces, 2);
    assert_true(clump.n_spheres > 5);
    for (; clump.n_spheres > 0; clump.n_spheres--) {
        assert_int_equal(ms_clump_pieces(&pieces, &clump, &err), MS_OK);
        assert_int_equal(pieces, 1);
    }
    ms_clump_free(&loose);
    ms_clump_free(&clump);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* A box turned by an odd angle, aligned, is covered as the straight one is. */
static void aligned_boxes_agree(void **state)
{
    (void)state;
    ms_mesh straight, turned;
    ms_target target[2];
    make_shape(&straight, "box", "");
    make_shape(&turned, "box", "");
    for (size_t v = 0; v < turned.n_vertices; v++) {
        double *p = turned.vertex[v];
        const double x = p[0], y = p[1], z = p[2], u = cos(0.7) * x - sin(0.7) * y, w = sin(0.7) * x + cos(0.7) * y;
        p[0] = cos(0.4) * u - sin(0.4) * z + 3;
        p[1] = w - 2;
        p[2] = sin(0.4) * u + cos(0.4) * z;
    }
    const double deq = 27 * cbrt(36 / acos(-1.0)); /* voxels of 1/27: the straight one, 3 x 2 x 1, has its volume */
    target_of_deq(&target[0], &straight, deq);
    target_of_deq(&target[1], &turned, deq);
    ms_clump a = run_setcover(&target[0], 60, ""), b = run_setcover(&target[1], 60, "align");
    assert_close(a.sphere[0].radius, b.sphere[0].radius, 1e-6);
    assert_close(coverage_of(&a, &target[0], 60), coverage_of(&b, &target[1], 60), 0.01);
    ms_clump_free(&a);
    ms_clump_free(&b);
    ms_target_free(&target[0]);
    ms_target_free(&target[1]);
    ms_mesh_free(&straight);
    ms_mesh_free(&turned);
}

static void huge_lattices_are_refused(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target;
    ms_clump clump;
    ms_stop_reason reason;
    ms_error err;
    make_shape(&mesh, "needle", "");
    target_of_deq(&target, &mesh, 20);
    assert_int_equal(try_generator(&clump, &reason, &ms_generator_setcover, &target, (ms_stop){.spheres = 3},
                                   "skeleton-deq=2000", NULL, NULL, &err),
                     MS_ERR_LIMIT);
    assert_non_null(strstr(err.text, "skeleton-deq"));
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spheres_are_inscribed),
        cmocka_unit_test(volumes_have_inscribed_spheres),
        cmocka_unit_test(medial_spheres_are_maximal),
        cmocka_unit_test(shapes_of_the_paper),
        cmocka_unit_test(connected_prefixes_are_one_piece),
        cmocka_unit_test(aligned_boxes_agree),
        cmocka_unit_test(huge_lattices_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
