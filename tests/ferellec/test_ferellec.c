/* Ferellec & McDowell's spheres: their radii in a cube by formula, on a lump by what they promise. */
#include "mesh/ms_closest.h"
#include "ms_generator_list.h"
#include "shared/ms_nodes.h"
#include "support/run_samples.h"

/*
 * A cube of side 1 with vertices at corners, in the middle of edges and of faces, t beyond the surface allowed. About
 * the middle the sphere meets the opposite face: (1 + t) / 2. A surface that falls away from the tangent plane at the
 * slope s = -e.N / |e| bounds it to t (1 + sqrt(1 - s^2)) / s^2, the least of (e^2 - t^2) / (2 (s e - t)): where it is
 * steepest, s^2 is 1/2 at edges and, along the diagonals of the faces, 2/3 at corners.
 */
static void radii_in_a_cube(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target;
    ms_stop_reason reason;
    make_shape(&mesh, "cube", "fineness=2");
    assert_int_equal(mesh.n_vertices, 26);
    make_target(&target, &mesh, 40, MS_VOXEL_HALF);
    const double t = 0.5 * target.grid.h;
    const double wanted[3] = {(1 + t) / 2, 2 * t * (1 + sqrt(0.5)), 1.5 * t * (1 + sqrt(1.0 / 3))};
    size_t found[3] = {0};
    ms_clump clump = run_generator(&ms_generator_ferellec, &target, (ms_stop){.spheres = 26}, "distance=0", &reason);
    assert_int_equal(reason, MS_STOP_EXHAUSTED); /* the large one meets the middles of all faces */
    for (size_t s = 0; s < clump.n_spheres; s++) {
        for (int w = 0; w < 3; w++) {
            found[w] += fabs(clump.sphere[s].radius - wanted[w]) < 1e-5;
        }
    }
    assert_int_equal(found[0], 1);
    assert_int_equal(found[1], 12);
    assert_int_equal(found[2], 8);
    assert_int_equal(clump.n_spheres, 21);
    ms_clump_free(&clump);
    clump = run_generator(&ms_generator_ferellec, &target, (ms_stop){.spheres = 26, .radius = 0.2}, "", &reason);
    assert_int_equal(reason, MS_STOP_RADIUS);
    assert_int_equal(clump.n_spheres, 1);
    ms_clump_free(&clump);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* Each sphere touches a vertex and leaves the surface by the tolerance, and no more; no vertex was met before. */
static void spheres_keep_the_tolerance(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target;
    make_shape(&mesh, "grain", "fineness=12");
    make_target(&target, &mesh, 30, MS_VOXEL_HALF);
    const double h = target.grid.h;
    ms_clump clump =
        run_generator(&ms_generator_ferellec, &target, (ms_stop){.spheres = 60}, "tolerance=0.8 distance=0.2", NULL);
    assert_int_equal(clump.n_spheres, 60);
    for (size_t s = 0; s < clump.n_spheres; s++) {
        const ms_sphere *sphere = &clump.sphere[s];
        assert_close(ms_closest_distance(NULL, target.closest, sphere->centre, HUGE_VAL), sphere->radius - 0.8 * h,
                     1e-6 * h);
        int touched = 0;
        for (size_t v = 0; v < mesh.n_vertices && !touched; v++) {
            int met = 0;
            for (size_t b = 0; b < s && !met; b++) {
                const double *c = clump.sphere[b].centre, *p = mesh.vertex[v];
                met =
                    hypot(hypot(p[0] - c[0], p[1] - c[1]), p[2] - c[2]) < clump.sphere[b].radius + 0.2 * h * (1 - 1e-9);
            }
            const double *c = sphere->centre, *p = mesh.vertex[v];
            touched = !met && fabs(hypot(hypot(p[0] - c[0], p[1] - c[1]), p[2] - c[2]) - sphere->radius) < 1e-9;
        }
        assert_true(touched);
    }
    ms_clump_free(&clump);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* Of a volume the surface is half a voxel beyond the centres of the border's voxels. */
static void volumes_keep_the_tolerance(void **state)
{
    (void)state;
    ms_target target;
    ms_nodes nodes;
    ms_error err;
    make_voxel_box(&target, (int[3]){12, 9, 15});
    assert_int_equal(ms_nodes_of_target(&nodes, &target, &err), MS_OK);
    ms_clump clump = run_generator(&ms_generator_ferellec, &target, (ms_stop){.spheres = 20}, "tolerance=0.25", NULL);
    double largest = 0;
    for (size_t s = 0; s < clump.n_spheres; s++) {
        const ms_ball ball = ms_grid_ball(&target.grid, &clump.sphere[s]);
        double distance;
        ms_nodes_nearest(&distance, &nodes, ball.centre, MS_NORM_EUCLIDEAN);
        assert_true(distance >= ball.radius - 0.75 - 1e-6);
        largest = fmax(largest, ball.radius);
    }
    assert_close(largest, (9 + 0.25) / 2, 1e-6); /* from a face of 12 x 15 to the other, as in the cube */
    ms_clump_free(&clump);
    ms_nodes_free(&nodes);
    ms_target_free(&target);
}

/* The run ends with the sphere that meets the last vertex of the share. */
static void the_share_ends_the_run(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target;
    ms_stop_reason reason;
    make_shape(&mesh, "grain", "fineness=12");
    make_target(&target, &mesh, 30, MS_VOXEL_HALF);
    ms_clump clump =
        run_generator(&ms_generator_ferellec, &target, (ms_stop){.spheres = 500}, "vertices-met=0.4", &reason);
    assert_int_equal(reason, MS_STOP_EXHAUSTED);
    for (size_t n = clump.n_spheres - 1; n <= clump.n_spheres; n++) {
        size_t met = 0;
        for (size_t v = 0; v < mesh.n_vertices; v++) {
            int found = 0;
            for (size_t s = 0; s < n && !found; s++) {
                const double *c = clump.sphere[s].centre, *p = mesh.vertex[v];
                found = hypot(hypot(p[0] - c[0], p[1] - c[1]), p[2] - c[2]) <=
                        clump.sphere[s].radius + 0.5 * target.grid.h * (1 + 1e-9);
            }
            met += found;
        }
        assert_true(n == clump.n_spheres ? (double)met >= 0.4 * (double)mesh.n_vertices
                                         : (double)met < 0.4 * (double)mesh.n_vertices);
    }
    ms_clump_free(&clump);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(radii_in_a_cube),
        cmocka_unit_test(spheres_keep_the_tolerance),
        cmocka_unit_test(volumes_keep_the_tolerance),
        cmocka_unit_test(the_share_ends_the_run),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
