/* What fcm does on request: nodes thinned, the search from one cluster up, the volume of the hull. */
#include "mesh/ms_hull.h"
#include "ms_generator_list.h"
#include "shared/ms_nodes.h"
#include "support/run_samples.h"

/* Nodes are of one group just where they are in one cube. */
static void groups_are_cubes(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target;
    ms_nodes nodes;
    ms_error err;
    size_t *group, count, found = 0;
    make_shape(&mesh, "grain", "fineness=10");
    make_target(&target, &mesh, 40, MS_VOXEL_HALF);
    assert_int_equal(ms_nodes_of_target(&nodes, &target, &err), MS_OK);
    assert_int_equal(ms_nodes_group(&group, &count, &nodes, 5.3, &err), MS_OK);
    for (size_t p = 0; p < nodes.count; p++) {
        int is_first = 1;
        for (size_t q = 0; q < p; q++) {
            int same = 1;
            for (int a = 0; a < 3; a++) {
                same &= floor(nodes.at[p][a] / 5.3) == floor(nodes.at[q][a] / 5.3);
            }
            assert_int_equal(same, group[p] == group[q]);
            is_first &= !same;
        }
        assert_true(group[p] < count);
        found += is_first;
    }
    assert_int_equal(found, count);
    assert_in_range(count, 20, 400);
    free(group);
    ms_nodes_free(&nodes);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* More nodes than spheres: as many clusters from the same spheres, found sooner, and it is said. */
static void fine_meshes_are_thinned(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target;
    ms_clump clump[2];
    char remark[2][512] = {"", ""};
    ms_error err;
    make_shape(&mesh, "grain", "fineness=30");
    make_target(&target, &mesh, 30, MS_VOXEL_HALF);
    for (int all = 0; all < 2; all++) {
        ms_stop_reason reason;
        const char *options = all ? "filling=1000 nodes=all" : "filling=1000";
        assert_int_equal(try_generator(&clump[all], &reason, &ms_generator_fcm, &target, (ms_stop){.spheres = 12},
                                       options, keep_remark, remark[all], &err),
                         MS_OK);
    }
    assert_true(mesh.n_vertices > 1000);
    assert_non_null(strstr(remark[0], "nodes are thinned to"));
    assert_string_equal(remark[1], "");
    assert_memory_equal(clump[0].sphere, clump[1].sphere, 12 * sizeof *clump[0].sphere);
    ms_clump_free(&clump[0]);
    ms_clump_free(&clump[1]);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* From one up, the first number that is enough ends the run: one less is not. */
static void the_search_goes_up(void **state)
{
    (void)state;
    static const char OPTIONS[] = "search=up filling=2000";
    ms_mesh mesh;
    ms_target target;
    ms_stop_reason reason;
    ms_stop stop = {.dice = 0.12};
    make_shape(&mesh, "ellipsoid", "fineness=12");
    make_target(&target, &mesh, 30, MS_VOXEL_HALF);
    ms_clump clump = run_generator(&ms_generator_fcm, &target, stop, OPTIONS, &reason);
    assert_int_equal(reason, MS_STOP_DICE);
    assert_true(score_of(&clump, &target).dice <= 0.12);
    assert_in_range(clump.n_spheres, 2, 20);
    stop.spheres = clump.n_spheres - 1;
    ms_clump less = run_generator(&ms_generator_fcm, &target, stop, OPTIONS, &reason);
    assert_int_equal(reason, MS_STOP_SPHERES);
    assert_int_equal(less.n_spheres, stop.spheres);
    assert_true(score_of(&less, &target).dice > 0.12);
    ms_clump_free(&clump);
    ms_clump_free(&less);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* The hull of a ring is a disc with a round rim, of a box of voxels the box. */
static void the_volume_of_the_hull(void **state)
{
    (void)state;
    const ms_stop stop = {.spheres = 400};
    const double disc = acos(-1) * (2 * 9 + acos(-1) * 3 + 4.0 / 3);
    ms_mesh mesh;
    ms_target ring, box;
    ms_stop_reason reason;
    make_shape(&mesh, "torus", "R=3 r=1 fineness=12");
    make_target(&ring, &mesh, 20, MS_VOXEL_HALF);
    ms_clump clump = run_generator(&ms_generator_fcm, &ring, stop, "volume=hull off-volume=0.5", &reason);
    assert_int_equal(reason, MS_STOP_OFF_VOLUME);
    const double reached = score_of(&clump, &ring).off_volume * ring.body.volume / disc;
    assert_true(reached > 0.49 && reached < 0.53); /* one sphere less is not enough */
    ms_clump_free(&clump);
    make_voxel_box(&box, (int[3]){5, 6, 7});
    clump = run_generator(&ms_generator_fcm, &box, stop, "volume=hull off-volume=0.8", NULL);
    ms_clump same = run_generator(&ms_generator_fcm, &box, stop, "volume=shape off-volume=0.8", NULL);
    assert_int_equal(clump.n_spheres, same.n_spheres);
    assert_memory_equal(clump.sphere, same.sphere, same.n_spheres * sizeof *same.sphere);
    ms_clump_free(&clump);
    ms_clump_free(&same);
    ms_target_free(&box);
    ms_target_free(&ring);
    ms_mesh_free(&mesh);
}

static void without_qhull_it_says_so(void **state)
{
    (void)state;
    const ms_stop stop = {.spheres = 4};
    ms_target box;
    ms_clump clump;
    ms_stop_reason reason;
    ms_error err;
    make_voxel_box(&box, (int[3]){5, 6, 7});
    assert_int_equal(
        try_generator(&clump, &reason, &ms_generator_fcm, &box, stop, "volume=hull off-volume=0.8", NULL, NULL, &err),
        MS_ERR_ARG);
    assert_non_null(strstr(err.text, "libqhull-dev"));
    ms_target_free(&box);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(groups_are_cubes),
        cmocka_unit_test(fine_meshes_are_thinned),
        cmocka_unit_test(the_search_goes_up),
        ms_hull_is_built() ? (struct CMUnitTest)cmocka_unit_test(the_volume_of_the_hull)
                           : (struct CMUnitTest)cmocka_unit_test(without_qhull_it_says_so),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
