/* Clump files: what is written is read back bit for bit; failures leave what was there. */
#include <jansson.h>
#include <locale.h>
#include <sys/stat.h>
#include <unistd.h>

#include "clump/formats/ms_read.h"
#include "clump/formats/ms_write.h"
#include "support/clump_samples.h"

/* Numbers that need all their digits, and the ends of the range. */
static ms_clump awkward_clump(void)
{
    ms_clump clump = {0};
    uint64_t seed = 51;
    add_sphere(&clump, 0.1, -1.0 / 3, 1e-300, 2.385);
    add_sphere(&clump, 1e300, -0.0, 4.9406564584124654e-324, 1.7976931348623157e308);
    add_sphere(&clump, 123456789012345680.0, 5e-5, -100, nextafter(1, 2));
    for (int s = 0; s < 200; s++) {
        const double scale = pow(10, between(&seed, -20, 20)), x = between(&seed, -1, 1), y = between(&seed, -1, 1);
        add_sphere(&clump, x * scale, y / scale, between(&seed, -1, 1), scale * next_uniform(&seed) + 1e-30);
    }
    return clump;
}

static void write_clump(char path[128], const char *folder, const char *name, const char *format, const ms_clump *clump,
                        const char *record)
{
    ms_error err = {{0}};
    snprintf(path, 128, "%s/%s", folder, name);
    const ms_content content = {.clump = clump, .record = record};
    if (ms_write_clump(&content, path, format ? ms_write_format_find(format, NULL) : NULL, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
}

static ms_status write_to(const ms_clump *clump, const char *path, const ms_format *format, const char *record,
                          ms_error *err)
{
    const ms_content content = {.clump = clump, .record = record};
    return ms_write_clump(&content, path, format, err);
}

static char *text_of(const char *path)
{
    ms_bytes bytes;
    assert_int_equal(ms_file_read(&bytes, path, NULL), MS_OK);
    return (char *)bytes.data;
}

static void expect_same_spheres(const ms_clump *got, const ms_clump *expected)
{
    assert_int_equal(got->n_spheres, expected->n_spheres);
    assert_memory_equal(got->sphere, expected->sphere, expected->n_spheres * sizeof *expected->sphere);
}

static void expect_csv_restores(const char *folder, const ms_clump *clump)
{
    char path[128];
    ms_clump got;
    ms_error err = {{0}};
    write_clump(path, folder, "a.csv", NULL, clump, NULL);
    if (ms_read_spheres(&got, path, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
    expect_same_spheres(&got, clump);
    ms_clump_free(&got);
    remove(path);
}

static void expect_json_restores(const char *folder, const ms_clump *clump)
{
    char path[128];
    ms_clump got = {0};
    write_clump(path, folder, "a.json", NULL, clump, "{\"seed\": 7, \"spheres\": 1}");
    json_t *root = json_load_file(path, JSON_REJECT_DUPLICATES, NULL), *spheres = json_object_get(root, "spheres");
    assert_non_null(root);
    assert_true(json_is_string(json_object_get(root, "mskit")));
    assert_int_equal(json_integer_value(json_object_get(root, "seed")), 7);
    assert_int_equal(json_array_size(json_object_get(root, "columns")), 4);
    for (size_t s = 0; s < json_array_size(spheres); s++) {
        double v[4];
        for (size_t a = 0; a < 4; a++) {
            v[a] = json_real_value(json_array_get(json_array_get(spheres, s), a));
        }
        add_sphere(&got, v[0], v[1], v[2], v[3]);
    }
    expect_same_spheres(&got, clump);
    json_decref(root);
    ms_clump_free(&got);
    remove(path);
}

/* Finds a title in the text, reads the numbers behind it. */
static const char *numbers_after(double *values, size_t count, const char *text, const char *title)
{
    const char *at = strstr(text, title);
    assert_non_null(at);
    at += strlen(title);
    for (size_t v = 0; v < count; v++) {
        char *end;
        values[v] = strtod(at, &end);
        assert_true(end > at);
        at = end;
    }
    return at;
}

static void expect_vtk_restores(const char *folder, const ms_clump *clump)
{
    char path[128];
    ms_clump got = {0};
    const size_t n = clump->n_spheres;
    write_clump(path, folder, "a.vtk", NULL, clump, NULL);
    char *text = text_of(path), *old = strdup(setlocale(LC_NUMERIC, NULL));
    setlocale(LC_NUMERIC, "C"); /* the file has points in any case */
    double *centre = malloc(3 * n * sizeof *centre), *radius = malloc(n * sizeof *radius), count;
    assert_true(centre && radius && old);
    assert_int_equal(strncmp(text, "# vtk DataFile Version 3.0\n", 27), 0);
    numbers_after(&count, 1, text, "POINTS ");
    assert_int_equal((size_t)count, n);
    numbers_after(centre, 3 * n, text, " double\n");
    numbers_after(radius, n, text, "LOOKUP_TABLE default\n");
    for (size_t s = 0; s < n; s++) {
        add_sphere(&got, centre[3 * s], centre[3 * s + 1], centre[3 * s + 2], radius[s]);
    }
    expect_same_spheres(&got, clump);
    setlocale(LC_NUMERIC, old);
    free(old);
    free(centre);
    free(radius);
    free(text);
    ms_clump_free(&got);
    remove(path);
}

static void every_format_restores_the_spheres(void **state)
{
    (void)state;
    char folder[64];
    ms_clump clump = awkward_clump();
    make_folder(folder);
    expect_csv_restores(folder, &clump);
    expect_json_restores(folder, &clump);
    expect_vtk_restores(folder, &clump);
    assert_int_equal(rmdir(folder), 0); /* nothing temporary is left */
    ms_clump_free(&clump);
}

static void a_decimal_comma_changes_nothing(void **state)
{
    (void)state;
    static const char *const names[] = {"de_DE.UTF-8", "de_DE.utf8", "de_DE", "fr_FR.UTF-8", "nl_NL.UTF-8"};
    const char *set = NULL;
    for (size_t m = 0; !set && m < sizeof names / sizeof *names; m++) {
        set = setlocale(LC_NUMERIC, names[m]);
    }
    if (!set || strcmp(localeconv()->decimal_point, ",") != 0) {
        setlocale(LC_NUMERIC, "C");
        print_message("skipped: no locale with a decimal comma is installed\n");
        skip();
    }
    char folder[64];
    ms_clump clump = awkward_clump();
    make_folder(folder);
    expect_csv_restores(folder, &clump);
    expect_json_restores(folder, &clump);
    expect_vtk_restores(folder, &clump);
    setlocale(LC_NUMERIC, "C");
    assert_int_equal(rmdir(folder), 0);
    ms_clump_free(&clump);
}

/* LIGGGHTS takes two at the least: the second one is in the first, and gone when it is read back. */
static void one_sphere_for_liggghts(void **state)
{
    char folder[64], path[128];
    ms_clump clump = {0}, got;
    ms_particle ignored;
    ms_error err = {{0}};
    const ms_particle particle = {
        .scale = 1, .density = 1000, .mass = 0.7, .inertia = {{0.1, 0, 0}, {0, 0.2, 0}, {0, 0, 0.25}}};
    (void)state;
    add_sphere(&clump, 0.1, -1.0 / 3, 1e-300, 2.385);
    make_folder(folder);
    snprintf(path, sizeof path, "%s/one.liggghts", folder);
    const ms_content content = {.clump = &clump, .particle = &particle};
    assert_int_equal(ms_write_clump(&content, path, NULL, &err), MS_OK);
    char *text = text_of(path);
    assert_string_equal(strchr(text, '\n'), "\n0.1 -0.3333333333333333 1e-300 1.1925\n");
    free(text);
    assert_int_equal(ms_read_clump(&got, &ignored, path, &err), MS_OK);
    expect_same_spheres(&got, &clump);
    ms_clump_free(&got);
    ms_clump_free(&clump);
    remove(path);
    snprintf(path, sizeof path, "%s/one.liggghts.in", folder);
    remove(path);
    snprintf(path, sizeof path, "%s/one.frame.json", folder);
    remove(path);
    assert_int_equal(rmdir(folder), 0);
}

/* Its volume is 0 in doubles, and its density none: no format writes inf. */
static void density_is_a_number(void **state)
{
    static const char *const NAME[] = {"a.csv", "a.json", "a.vtk", "a.lammps"};
    char folder[64], path[128];
    ms_clump clump = {0};
    double mass[2] = {0.5, 0.2};
    ms_error err = {{0}};
    const ms_particle particle = {
        .scale = 1, .density = 1000, .mass = 0.7, .inertia = {{0.1, 0, 0}, {0, 0.2, 0}, {0, 0, 0.25}}};
    (void)state;
    add_sphere(&clump, 0, 0, 0, 2.385);
    add_sphere(&clump, 0, 0, 1, 1e-150);
    clump.mass = mass;
    make_folder(folder);
    const ms_content content = {.clump = &clump, .particle = &particle};
    for (int n = 0; n < 4; n++) {
        snprintf(path, sizeof path, "%s/%s", folder, NAME[n]);
        assert_int_equal(ms_write_clump(&content, path, NULL, &err), MS_ERR_ARG);
        expect_message(&err, "sphere 2, of radius 1e-150 and 0.2 kg, has a density that no number holds");
    }
    assert_int_equal(rmdir(folder), 0); /* nothing is left there */
    clump.mass = NULL;
    ms_clump_free(&clump);
}

static void the_ending_names_the_format(void **state)
{
    (void)state;
    char folder[64], path[128];
    ms_clump clump = {0};
    ms_error err = {{0}};
    add_sphere(&clump, 1, 2, 3, 4);
    make_folder(folder);
    write_clump(path, folder, "A.CSV", NULL, &clump, NULL);
    char *text = text_of(path);
    assert_string_equal(text, "x,y,z,r\n1,2,3,4\n");
    free(text);
    remove(path);
    write_clump(path, folder, "a.csv", "vtk", &clump, NULL); /* what is asked for goes first */
    text = text_of(path);
    assert_int_equal(strncmp(text, "# vtk", 5), 0);
    free(text);
    remove(path);
    static const char *const bad[] = {"a", "a.xyz", "a.csv.gz", "a.", ".csv/a"};
    for (int b = 0; b < 5; b++) {
        snprintf(path, sizeof path, "%s/%s", folder, bad[b]);
        assert_int_equal(write_to(&clump, path, NULL, NULL, &err), MS_ERR_ARG);
        expect_message(&err, "csv, json, vtk");
        assert_int_not_equal(access(path, F_OK), 0);
    }
    assert_null(ms_write_format_find("CSV", &err));
    assert_int_equal(rmdir(folder), 0);
    ms_clump_free(&clump);
}

static ms_status failing_format(FILE *stream, const ms_content *content, ms_error *err)
{
    (void)content;
    fputs("half of a file", stream);
    return ms_fail(err, MS_ERR_SHAPE, "this format fails");
}

static void a_failure_leaves_the_file_that_was_there(void **state)
{
    (void)state;
    char folder[64], path[128];
    ms_clump clump = {0}, bad = {0};
    ms_error err = {{0}};
    const ms_format failing = {"failing", "failing", "fails", MS_NEED_SPHERES, NULL, .part = {{"", failing_format}}};
    add_sphere(&clump, 1, 2, 3, 4);
    add_sphere(&bad, 1, 2, (double)NAN, 4); /* JSON has no such number */
    make_folder(folder);
    write_clump(path, folder, "a.csv", NULL, &clump, NULL);
    assert_int_equal(write_to(&clump, path, &failing, NULL, &err), MS_ERR_SHAPE);
    expect_message(&err, "this format fails");
    assert_int_equal(write_to(&bad, path, ms_write_format_find("json", NULL), NULL, &err), MS_ERR_IO);
    assert_int_equal(write_to(&clump, path, ms_write_format_find("json", NULL), "[1, 2", &err), MS_ERR_IO);
    assert_int_equal(write_to(&clump, path, ms_write_format_find("json", NULL), "[1, 2]", &err), MS_ERR_IO);
    char *text = text_of(path);
    assert_string_equal(text, "x,y,z,r\n1,2,3,4\n");
    free(text);
    remove(path);
    assert_int_equal(rmdir(folder), 0);
    ms_clump_free(&clump);
    ms_clump_free(&bad);
}

static void expect_unwritable(const ms_clump *clump, const char *path)
{
    const ms_grid grid = {.n = {1, 1, 1}, .h = 1, .inside = (uint8_t[]){1}};
    ms_error err = {{0}};
    assert_int_equal(write_to(clump, path, ms_formats, NULL, &err), MS_ERR_IO);
    expect_message(&err, path);
    err.text[0] = '\0';
    assert_int_equal(ms_grid_write(&grid, path, &err), MS_ERR_IO);
    expect_message(&err, path);
}

static void what_cannot_be_written_is_said(void **state)
{
    (void)state;
    char folder[64], path[128];
    ms_clump clump = {0};
    add_sphere(&clump, 1, 2, 3, 4);
    make_folder(folder);
    snprintf(path, sizeof path, "%s/missing/a.csv", folder);
    expect_unwritable(&clump, path);
    expect_unwritable(&clump, folder);
    expect_unwritable(&clump, "/dev/full"); /* a full disk */
    if (geteuid() != 0) {
        assert_int_equal(chmod(folder, 0500), 0);
        snprintf(path, sizeof path, "%s/a.csv", folder);
        expect_unwritable(&clump, path);
        assert_int_equal(chmod(folder, 0700), 0);
    }
    assert_int_equal(rmdir(folder), 0);
    ms_clump_free(&clump);
}

static void a_grid_is_written_as_it_is(void **state)
{
    (void)state;
    static const char head[] = "DIMENSIONS 3 2 4\nORIGIN 0.1 -20 0\nSPACING 0.3 0.3 0.3\nPOINT_DATA 24\n"
                               "SCALARS inside unsigned_char 1\nLOOKUP_TABLE default\n";
    char folder[64], path[128];
    ms_bytes bytes;
    ms_grid grid = empty_grid(3, 2, 4, 0.3);
    grid.origin[0] = 0.1;
    grid.origin[1] = -20;
    for (int v = 0; v < 24; v++) {
        grid.inside[v] = v % 5 == 0;
    }
    make_folder(folder);
    snprintf(path, sizeof path, "%s/grid.vtk", folder);
    assert_int_equal(ms_grid_write(&grid, path, NULL), MS_OK);
    assert_int_equal(ms_file_read(&bytes, path, NULL), MS_OK);
    assert_non_null(strstr((char *)bytes.data, head));
    assert_memory_equal(bytes.data + bytes.size - 24, grid.inside, 24);
    ms_file_free(&bytes);
    remove(path);
    assert_int_equal(rmdir(folder), 0);
    ms_grid_free(&grid);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_format_restores_the_spheres), cmocka_unit_test(one_sphere_for_liggghts),
        cmocka_unit_test(a_decimal_comma_changes_nothing),   cmocka_unit_test(density_is_a_number),
        cmocka_unit_test(the_ending_names_the_format),       cmocka_unit_test(a_failure_leaves_the_file_that_was_there),
        cmocka_unit_test(what_cannot_be_written_is_said),    cmocka_unit_test(a_grid_is_written_as_it_is),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
