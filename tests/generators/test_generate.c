/* One call from a file to a clump: the same as the calls one by one, and what it refuses. */
#include <unistd.h>

#include "mesh/formats/ms_mesh_read.h"
#include "mesh/formats/ms_mesh_write.h"
#include "ms_generate.h"
#include "ms_generator.h"
#include "support/body_samples.h"
#include "support/test_support.h"

static const char MESH[] = "test_generate.obj", OPEN[] = "test_generate_open.obj", VOLUME[] = "test_generate.mha";

static int write_files(void **state)
{
    (void)state;
    ms_mesh mesh;
    make_shape(&mesh, "grain", "fineness=10");
    assert_int_equal(ms_mesh_write(&mesh, MESH, NULL), MS_OK);
    mesh.n_triangles--;
    assert_int_equal(ms_mesh_write(&mesh, OPEN, NULL), MS_OK);
    ms_mesh_free(&mesh);
    FILE *file = fopen(VOLUME, "wb");
    assert_non_null(file);
    fputs("ObjectType = Image\nNDims = 3\nDimSize = 12 12 12\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n",
          file);
    for (int v = 0; v < 12 * 12 * 12; v++) {
        fputc(v < 6 * 12 * 12 ? 3 : 7, file); /* two halves */
    }
    assert_int_equal(fclose(file), 0);
    return 0;
}

static int remove_files(void **state)
{
    (void)state;
    return unlink(MESH) | unlink(OPEN) | unlink(VOLUME);
}

/* The clump of the calls one by one. */
static ms_clump by_hand(const char *option, const char *text, size_t spheres, double cells)
{
    ms_mesh mesh;
    ms_target target;
    ms_settings settings;
    ms_clump clump;
    ms_stop_reason reason;
    const ms_generator *generator = ms_generator_find("variational", NULL);
    ms_mesh_report report;
    assert_int_equal(ms_mesh_read(&mesh, MESH, NULL), MS_OK);
    assert_int_equal(ms_mesh_repair(&mesh, &report, NULL), MS_OK);
    make_target(&target, &mesh, cells, MS_VOXEL_HALF);
    assert_int_equal(ms_option_settings_init(&settings, generator->options, NULL), MS_OK);
    if (option) {
        assert_int_equal(ms_option_settings_set(&settings, option, text, NULL), MS_OK);
    }
    const ms_run run = {.target = &target, .stop = {.spheres = spheres}, .settings = &settings, .seed = 1};
    assert_int_equal(ms_generator_run(&clump, &reason, generator, &run, NULL), MS_OK);
    ms_option_settings_free(&settings);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
    return clump;
}

static void expect_same(ms_clump *one, ms_clump *two)
{
    assert_int_equal(one->n_spheres, two->n_spheres);
    assert_memory_equal(one->sphere, two->sphere, one->n_spheres * sizeof *one->sphere);
    ms_clump_free(one);
    ms_clump_free(two);
}

static void as_the_calls_one_by_one(void **state)
{
    (void)state;
    const ms_generate_option options[] = {{"points", "150"}, {0}};
    const ms_generate_request request = {.options = options, .stop = {.spheres = 10}, .cells = 40};
    ms_clump clump, truth = by_hand("points", "150", 10, 40);
    ms_metrics metrics;
    ms_error err = {{0}};
    assert_int_equal(ms_generate_file(&clump, &metrics, MESH, &request, &err), MS_OK);
    assert_int_equal(metrics.spheres, 10);
    assert_true(metrics.score.dice > 0 && metrics.score.dice < 0.06);
    expect_same(&clump, &truth);
    truth = by_hand(NULL, NULL, 50, 100);
    assert_int_equal(ms_generate_file(&clump, NULL, MESH, NULL, &err), MS_OK);
    expect_same(&clump, &truth);
}

/* Half of a cube, as it stands in the file. */
static void a_label_of_a_volume(void **state)
{
    (void)state;
    const ms_generate_request request = {.generator = "setcover", .label = 7, .stop = {.spheres = 1}};
    ms_clump clump;
    ms_error err = {{0}};
    assert_int_equal(ms_generate_file(&clump, NULL, VOLUME, &request, &err), MS_OK);
    expect_close(clump.sphere[0].radius, 3, 0.51);
    expect_close(clump.sphere[0].centre[2], 8.5, 0.51);
    ms_clump_free(&clump);
}

static void expect_refusal(const char *path, ms_generate_request request, ms_status expected, const char *says)
{
    ms_clump clump;
    ms_error err = {{0}};
    assert_int_equal(ms_generate_file(&clump, NULL, path, &request, &err), expected);
    assert_int_equal(clump.n_spheres, 0);
    assert_null(clump.sphere);
    if (!strstr(err.text, says)) {
        fail_msg("'%s' does not say '%s'", err.text, says);
    }
    assert_int_equal(ms_generate_file(&clump, NULL, path, &request, NULL), expected);
}

static void what_is_refused(void **state)
{
    (void)state;
    const ms_generate_option wrong[] = {{"no-such", "1"}, {0}};
    expect_refusal(MESH, (ms_generate_request){.generator = "none"}, MS_ERR_ARG, "none");
    expect_refusal(MESH, (ms_generate_request){.options = wrong}, MS_ERR_ARG, "no-such");
    expect_refusal(MESH, (ms_generate_request){.max_bytes = 1e5}, MS_ERR_LIMIT, MESH);
    expect_refusal(VOLUME, (ms_generate_request){.max_bytes = 1e3}, MS_ERR_LIMIT, VOLUME);
    expect_refusal(VOLUME, (ms_generate_request){0}, MS_ERR_SHAPE, "several labels");
    expect_refusal(VOLUME, (ms_generate_request){.label = 5}, MS_ERR_SHAPE, "label 5");
    expect_refusal(OPEN, (ms_generate_request){0}, MS_ERR_SHAPE, "open");
    expect_refusal("shape.txt", (ms_generate_request){0}, MS_ERR_FORMAT, "shape.txt");
    expect_refusal("no-such.stl", (ms_generate_request){0}, MS_ERR_IO, "no-such.stl");
    expect_refusal(MESH, (ms_generate_request){.stop = {.radius = 100}}, MS_ERR_SHAPE, "no sphere");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(as_the_calls_one_by_one),
        cmocka_unit_test(a_label_of_a_volume),
        cmocka_unit_test(what_is_refused),
    };
    return cmocka_run_group_tests(tests, write_files, remove_files);
}
