/* Clumps: growing, pieces, boxes; reading them from text. */
#include "clump/formats/ms_read.h"
#include "support/clump_samples.h"

static void spheres_are_kept_in_order(void **state)
{
    (void)state;
    ms_clump clump = {0};
    for (int s = 0; s < 1000; s++) {
        add_sphere(&clump, s, -s, 0.5 * s, 1001 - s);
    }
    assert_int_equal(clump.n_spheres, 1000);
    for (int s = 0; s < 1000; s++) {
        assert_true(clump.sphere[s].centre[1] == -s && clump.sphere[s].radius == 1001 - s);
    }
    double lo[3], hi[3];
    ms_clump_box(lo, hi, &clump);
    expect_close(lo[0], -1001, 0);
    expect_close(hi[0], 1001, 0);
    expect_close(lo[1], -1001, 0);
    expect_close(hi[1], 1001, 0);
    expect_close(hi[2], 1001, 0); /* s/2 + 1001 - s */
    expect_close(ms_clump_smallest_radius(&clump), 2, 0);
    ms_clump_free(&clump);
    assert_int_equal(clump.n_spheres, 0);
    ms_clump_free(&clump);
    ms_clump_free(NULL);
}

static void a_clump_has_a_limit(void **state)
{
    (void)state;
    ms_clump clump = {0};
    const ms_sphere sphere = {{0, 0, 0}, 1};
    ms_error err = {{0}};
    for (int s = 0; s < MS_CLUMP_MAX_SPHERES; s++) {
        assert_int_equal(ms_clump_add(&clump, &sphere, NULL), MS_OK);
    }
    assert_int_equal(ms_clump_add(&clump, &sphere, &err), MS_ERR_LIMIT);
    expect_message(&err, "65534");
    assert_int_equal(clump.n_spheres, MS_CLUMP_MAX_SPHERES);
    ms_clump_free(&clump);
}

/* Joins names until nothing changes. */
static size_t brute_pieces(const ms_clump *clump)
{
    size_t name[64], pieces = 0;
    for (size_t s = 0; s < clump->n_spheres; s++) {
        name[s] = s;
    }
    for (int changed = 1; changed;) {
        changed = 0;
        for (size_t m = 0; m < clump->n_spheres * clump->n_spheres; m++) {
            const ms_sphere *a = &clump->sphere[m % clump->n_spheres], *b = &clump->sphere[m / clump->n_spheres];
            const double x = a->centre[0] - b->centre[0], y = a->centre[1] - b->centre[1];
            const double z = a->centre[2] - b->centre[2];
            size_t *p = &name[m % clump->n_spheres], *q = &name[m / clump->n_spheres];
            if (sqrt(x * x + y * y + z * z) < a->radius + b->radius && *p != *q) {
                *p = *q = *p < *q ? *p : *q;
                changed = 1;
            }
        }
    }
    for (size_t s = 0; s < clump->n_spheres; s++) {
        pieces += name[s] == s;
    }
    return pieces;
}

static void pieces_agree_with_brute_force(void **state)
{
    (void)state;
    uint64_t seed = 41;
    int met[64] = {0}, different = 0;
    for (int run = 0; run < 500; run++) {
        ms_clump clump = {0};
        const int count = 1 + pick(&seed, 50);
        for (int s = 0; s < count; s++) {
            const double x = between(&seed, 0, 8), y = between(&seed, 0, 8), z = between(&seed, 0, 8);
            add_sphere(&clump, x, y, z, between(&seed, 0.1, 1.5));
        }
        size_t pieces;
        assert_int_equal(ms_clump_pieces(&pieces, &clump, NULL), MS_OK);
        assert_int_equal(pieces, brute_pieces(&clump));
        different += !met[pieces];
        met[pieces] = 1;
        ms_clump_free(&clump);
    }
    assert_true(different > 10);
}

static void pieces_by_hand(void **state)
{
    (void)state;
    ms_clump clump = {0};
    size_t pieces;
    assert_int_equal(ms_clump_pieces(&pieces, &clump, NULL), MS_OK);
    assert_int_equal(pieces, 0);
    add_sphere(&clump, 0, 0, 0, 1);
    add_sphere(&clump, 2, 0, 0, 1); /* they touch: no overlap */
    assert_int_equal(ms_clump_pieces(&pieces, &clump, NULL), MS_OK);
    assert_int_equal(pieces, 2);
    add_sphere(&clump, 1, 0, 0, 0.1);  /* joins them */
    add_sphere(&clump, 0, 0, 0, 0.01); /* within the first */
    assert_int_equal(ms_clump_pieces(&pieces, &clump, NULL), MS_OK);
    assert_int_equal(pieces, 1);
    ms_clump_free(&clump);
}

static ms_status read_text(ms_clump *clump, const void *text, size_t size, ms_error *err)
{
    char folder[64], path[128];
    make_folder(folder);
    write_file(path, folder, "clump.csv", text, size);
    const ms_status status = ms_read_spheres(clump, path, err);
    remove(path);
    remove(folder);
    return status;
}

/* Each text holds the same two spheres. */
static void spheres_are_read_from_what_tools_write(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "x,y,z,r\n1,-2.5,3e2,0.25\n4,5,6,7\n",
        "1,-2.5,3e2,0.25\n4,5,6,7", /* no header, no end of the last line */
        "1;-2.5;300;.25\r\n4;5;6;7\r\n",
        "x;y;z;r\n1;-2.5;300;.25;9;text\n4;5;6;7;;\n",
        "1 -2.5 300 0.25\n4 5 6 7\n",
        "1\t-2.5\t300\t0.25\n4\t5\t6\t7\n",
        "  1 ,  -2.5 ,\t3E+02,25e-2  \n\n\n 4,5,6,7 , extra, 8\n\n",
        "# a comment, with; marks\n# another\nx,y,z,radius,mass\n1,-2.5,300,0.25,12 # why\n#4,4,4,4\n4,5,6,7,8\n",
        "X Y Z R\n+1 -2.5 300.0 0.25\n4. 5. 6. 7.\n",
        "spheres of a stone, by hand\n1,-2.5,300,0.25\n4,5,6,7\n",
        "\xEF\xBB\xBFx,y,z,r\r\n1,-2.5,300,0.25\r\n4,5,6,7\r\n",
        "x,y,z,r\r1,-2.5,300,0.25\r4,5,6,7\r", /* ends of line of old */
        "x,y,z,rad\n1,-2.5,300,0.25\n4,5,6,7\n",
        "X,Y,Z,R\n1,-2.5,300,0.25\n4,5,6,7\n",
        "\"x\",\"y\",\"z\",\"r\"\n1,-2.5,300,0.25\n4,5,6,7\n",
        "x [m],y [m],z [m],Radius[m]\n1,-2.5,300,0.25\n4,5,6,7\n",
        "x y z radius (mm)\n1 -2.5 300 0.25\n4 5 6 7\n",
        "#format x_y_z_r_clumpId\n1 -2.5 300 0.25 7\n4 5 6 7 7\n",
        "x,y,z,r,clumpId\n1,-2.5,300,0.25,stone\n4,5,6,7,stone\n",
        "#format x_y_z_r\n1 -2.5 300 0.25 7\n4 5 6 7 8\n",
        "x,y,z,r,,,\n1,-2.5,300,0.25,,,\n,,,,,,\n4,5,6,7,,,\n;;;\n",
    };
    for (size_t t = 0; t < sizeof texts / sizeof *texts; t++) {
        ms_clump clump;
        ms_error err = {{0}};
        if (read_text(&clump, texts[t], strlen(texts[t]), &err) != MS_OK) {
            fail_msg("text %zu: %s", t, err.text);
        }
        const ms_sphere expected[] = {{{1, -2.5, 300}, 0.25}, {{4, 5, 6}, 7}};
        assert_int_equal(clump.n_spheres, 2);
        assert_memory_equal(clump.sphere, expected, sizeof expected);
        ms_clump_free(&clump);
    }
}

static const struct {
    const char *text, *message;
} malformed[] = {
    {"id,x,y,z,r\n1,2,3,4,5\n", "line 1"},
    {"r x y z\n1 2 3 4\n", "line 1"},
    {"y,x,z,r\n1,2,3,4\n", "line 1"},
    {"x (m),z (m),y (m),r (m)\n1,2,3,4\n", "line 1: x, y, z stand in other columns"},
    {"x,y,z,diameter\n1,2,3,4\n", "line 1: the fourth column is called 'diameter' and not r, rad or radius"},
    {"x;y;z;D;r\n1;2;3;4;2\n", "line 1: the fourth column is called 'D'"},
    {"x y z density r\n1 2 3 4 5\n", "line 1: the fourth column is called 'density'"},
    {"x,y,z,,r\n1,2,3,4,5\n", "line 1: the fourth column is called ''"},
    {"\nX Y Z Diameter [mm]\n1 2 3 4\n", "line 2: the fourth column is called 'Diameter'"},
    {"cx,cy,cz,2r\n1,2,3,4\n", "line 1: the fourth column is called '2r'"},
    {"x,y,z,radius of gyration\n1,2,3,4\n", "line 1: the fourth column is called 'radius of gyration'"},
    {"#version = 1\nx,y,z,rel_d,rel_sa\n1,2,3,4,5\n", "line 2: the fourth column is called 'rel_d'"}, /* MFiX */
    {"# x,y,z,diameter\n1,2,3,4\n", "line 1: the fourth column is called 'diameter'"},
    {"x,y,z,r,carrier\n1,2,3,4,0\n", "line 1: a column 'carrier' must be the seventh"},
    {"# a bed\n\n# r x y z\n1 2 3 4\n", "line 3: x, y, z stand in other columns"},
    {"#format id_x_y_z_r_matId\n1 2 3 4 5 6\n", "line 1: x, y, z stand in other columns"}, /* YADE's textExt */
    {"#format x_y_z_r_clumpId\n1 2 3 4 7\n1 2 3 4 8\n", "line 3: this sphere is of clump 8, those before of clump 7"},
    {"", "no spheres"},
    {"x,y,z,r\n", "no spheres"},
    {"# nothing\n\n", "no spheres"},
    {"1,2,3,4\n1,2,3,-4\n", "line 2: sphere (1, 2, 3) with radius -4"},
    {"1,2,3,0\n", "line 1: sphere"},
    {"x,y,z,r\n1,2,3,nan\n", "line 2: sphere"},
    {"1,2,inf,4\n", "line 1: sphere"},
    {"1,2,3,1e999\n", "line 1: sphere"},
    {"1,2,3,4\n\n1,2,3\n", "line 3: a sphere (x y z r) needs 4 numbers but the line has 3"},
    {"1,2,3,4\n5,6,seven,8\n", "line 2: a sphere (x y z r) has 'seven'"},
    {"x,y,z,r\nx,y,z,r\n1,2,3,4\n", "line 2: a sphere (x y z r) has 'x'"}, /* one header only */
    {"1,2,3,4\nx,y,z,r\n", "line 2: "},
    {"1,2,3,4\nand so on\n1,2,3,4\n", "line 2: "},
    {"1,2,3,4#5\n", "line 1: "},
    {"1,,3,4,5\n", "line 1: one of the first four columns is empty"},
    {"1, ;3,4,5\n", "line 1: one of the first four columns is empty"},
    {",x,y,z,r\n0,1,2,3,4\n", "line 1: one of the first four columns is empty"}, /* numbers of rows */
    {"1,2,3,4\n,1,2,3,4\n", "line 2: one of the first four columns is empty"},
    {"x;y;z;r\n1,5;2,5;3,0;0,5\n", "line 2: commas and other"},
    {"1;2;3;0,5\n", "line 1: commas and other"},
    {"1;2,5;3;1\n", "line 1: commas and other"},
    {"1,5 2,5 3,0 0,5\n", "line 1: commas and other"},
    {"1\t2\t3\t1,5\n", "line 1: commas and other"},
    {"1.O,2,3,4\n1,2,3,4\n", "line 1: a sphere (x y z r) has '1.O'"}, /* no header: the sphere would be lost */
    {"0x1,2,3,4\n1,2,3,4\n", "line 1: a sphere (x y z r) has '0x1'"},
    {"nan,2,3,4\n1,2,3,4\n", "line 1: sphere"},
};

static void malformed_texts_are_refused_with_the_line(void **state)
{
    (void)state;
    for (size_t c = 0; c < sizeof malformed / sizeof *malformed; c++) {
        ms_clump clump;
        ms_error err = {{0}};
        const ms_status status = read_text(&clump, malformed[c].text, strlen(malformed[c].text), &err);
        if (status != MS_ERR_FORMAT) {
            fail_msg("\"%s\" gives %d", malformed[c].text, status);
        }
        expect_message(&err, malformed[c].message);
        expect_message(&err, "clump.csv");
        assert_null(clump.sphere);
        assert_int_equal(clump.n_spheres, 0);
    }
}

static void what_is_no_text_is_refused(void **state)
{
    (void)state;
    static const char binary[] = "1,2,3,4\n\0\1\2\3";
    ms_clump clump;
    ms_error err = {{0}};
    assert_int_equal(read_text(&clump, binary, sizeof binary, &err), MS_ERR_FORMAT);
    expect_message(&err, "not a text file");
    assert_int_equal(ms_read_spheres(&clump, "/nowhere/clump.csv", &err), MS_ERR_IO);
    expect_message(&err, "/nowhere/clump.csv");
    assert_int_equal(ms_read_spheres(&clump, "/", &err), MS_ERR_IO);
    assert_null(clump.sphere);
}

static void too_many_lines_are_refused(void **state)
{
    (void)state;
    const size_t lines = MS_CLUMP_MAX_SPHERES + 1, size = 8 * lines;
    char *text = malloc(size);
    assert_non_null(text);
    for (size_t l = 0; l < lines; l++) {
        memcpy(text + 8 * l, "1,2,3,4\n", 8);
    }
    ms_clump clump;
    ms_error err = {{0}};
    assert_int_equal(read_text(&clump, text, size - 8, &err), MS_OK);
    assert_int_equal(clump.n_spheres, MS_CLUMP_MAX_SPHERES);
    ms_clump_free(&clump);
    assert_int_equal(read_text(&clump, text, size, &err), MS_ERR_LIMIT);
    assert_null(clump.sphere);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spheres_are_kept_in_order),
        cmocka_unit_test(a_clump_has_a_limit),
        cmocka_unit_test(pieces_agree_with_brute_force),
        cmocka_unit_test(pieces_by_hand),
        cmocka_unit_test(spheres_are_read_from_what_tools_write),
        cmocka_unit_test(malformed_texts_are_refused_with_the_line),
        cmocka_unit_test(what_is_no_text_is_refused),
        cmocka_unit_test(too_many_lines_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
