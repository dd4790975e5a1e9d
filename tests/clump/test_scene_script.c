/* Scripts of scenes: what they name, and what they are refused. */
#include <unistd.h>

#include "base/ms_file.h"
#include "clump/formats/ms_scene_script.h"
#include "support/clump_samples.h"

/* Two balls in one another's reach, of 3 m, that weigh a kilogram; of a particle whose longest way is along x. */
static void make_pair(ms_clump *clump, ms_particle *particle)
{
    *clump = (ms_clump){0};
    add_sphere(clump, -0.5, 0, 0, 1);
    add_sphere(clump, 0.5, 0, 0, 1);
    *particle = (ms_particle){.mass = 1, .density = 1, .scale = 1, .inertia = {{0.4, 0, 0}, {0, 0.6, 0}, {0, 0, 0.6}}};
}

static const ms_format *format_of(const char *name)
{
    return ms_write_format_find(name, NULL);
}

static void a_vessel_has_room(void **state)
{
    static const struct {
        double x, y;
        ms_status status;
        const char *says;
    } CASES[] = {{0, 0, MS_OK, ""},
                 {3.601, 9, MS_OK, ""},
                 {0, 3.601, MS_OK, ""},
                 {3.599, 9, MS_ERR_ARG, "takes a vessel of 3.6; the box has 3.599"},
                 {0, 1, MS_ERR_ARG, "the box has 1"},
                 {1, 0, MS_ERR_ARG, "the box has 1"},
                 {-1, 9, MS_ERR_ARG, "a vessel -1 wide"},
                 {9, (double)NAN, MS_ERR_ARG, "nan wide"},
                 {(double)INFINITY, 9, MS_ERR_ARG, "inf wide"}};
    ms_clump clump;
    ms_particle particle;
    (void)state;
    make_pair(&clump, &particle);
    const ms_scene_kind kind = {&clump, &particle, "out/pair.yade", "pair", 5};
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        const ms_scene_vessel vessel = {{CASES[i].x, CASES[i].y}, 0};
        ms_error err = {""};
        assert_int_equal(ms_scene_script_check(&kind, 1, &vessel, &err), CASES[i].status);
        if (!strstr(err.text, CASES[i].says)) {
            fail_msg("'%s' does not say '%s'", err.text, CASES[i].says);
        }
    }
    ms_clump_free(&clump);
}

/* The script names the template, without which it is none. */
static void a_script_is_written(void **state)
{
    char folder[64];
    ms_clump clump;
    ms_particle particle;
    ms_bytes bytes;
    (void)state;
    make_pair(&clump, &particle);
    make_folder(folder);
    const ms_scene_vessel vessel = {0};
    const ms_scene_kind kind = {&clump, &particle, "elsewhere/a pair.yade", "pair", 5};
    assert_int_equal(ms_scene_script_write(&kind, 1, &vessel, folder, format_of("yade"), NULL), MS_OK);
    char *path = ms_scene_script_path(folder, format_of("yade"));
    assert_non_null(path);
    assert_int_equal(ms_file_read(&bytes, path, NULL), MS_OK);
    assert_non_null(strstr((const char *)bytes.data, "a pair.yade"));
    ms_file_free(&bytes);
    assert_int_equal(unlink(path), 0);
    assert_int_equal(rmdir(folder), 0); /* nothing else is left */
    free(path);
    ms_clump_free(&clump);
}

static void what_has_no_script(void **state)
{
    ms_clump clump;
    ms_particle particle;
    ms_error err;
    const ms_scene_vessel vessel = {0};
    (void)state;
    make_pair(&clump, &particle);
    ms_scene_kind kind = {&clump, &particle, "pair.yade", "pair", 5};
    assert_int_equal(ms_scene_script_write(&kind, 0, &vessel, "none", format_of("yade"), &err), MS_ERR_ARG);
    assert_non_null(strstr(err.text, "0 kinds of particles; give one"));
    assert_int_equal(ms_scene_script_write(&kind, 1, &vessel, "none", format_of("csv"), &err), MS_ERR_ARG);
    assert_non_null(strstr(err.text, "liggghts, lammps and yade"));
    assert_int_equal(ms_scene_script_write(&kind, 1, &vessel, "none/such", format_of("yade"), &err), MS_ERR_IO);
    kind.particle = &(const ms_particle){0};
    assert_int_equal(ms_scene_script_write(&kind, 1, &vessel, "none", format_of("yade"), &err), MS_ERR_ARG);
    assert_non_null(strstr(err.text, "pair: a yade template needs the mass"));
    ms_clump_free(&clump);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_vessel_has_room),
        cmocka_unit_test(a_script_is_written),
        cmocka_unit_test(what_has_no_script),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
