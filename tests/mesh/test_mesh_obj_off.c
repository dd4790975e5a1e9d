/* OBJ and OFF: what is read and what is refused. */
#include "support/mesh_samples.h"

#define OBJ_VERTICES "v 0.5 -1.25 2.375\nv 4.75 0 2.375\nv 0.5 3 2.375\nv 0.5 -1.25 9\n"
#define OFF_VERTICES "0.5 -1.25 2.375\n4.75 0 2.375\n0.5 3 2.375\n0.5 -1.25 9\n"
#define OFF_FACES "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n"

static void obj_is_read(void **state)
{
    static const char *const texts[] = {
        OBJ_VERTICES "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n",
        "# made by hand\nmtllib a.mtl\no x\n" OBJ_VERTICES "vn 0 0 1\nvt 0 0\ng a b\nusemtl m\ns off\n"
        "f 1/1/1 3/1/1 2/1/1 # c\nf 1/1 2/1 4/1\nf 2//1 3//1 4//1\nf -2 -4 -1\nl 1 2\np 1\n",
        "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n" OBJ_VERTICES,
        "v 0.5 -1.25 2.375 1\r\nv 4.75 0 2.375 0.1 0.2 0.3\r\nv 0.5 3 2.375 0.1 0.2 0.3 1\r\n"
        "v 0.5 \\\r\n-1.25\\\r\n 9\r\n"
        "f 1 3\\\r\n 2\r\nf 1 2 4\r\nf 2 3 4\r\nf 3 1 4",
        /* Vertex 2 again as 5, with -0; vertex 6 that nothing uses. */
        OBJ_VERTICES "v 4.75 -0 2.375\nv 7 7 7\nf 1 3 5\nf 1 2 4\nf 5 3 4\nf 3 1 4\n",
    };
    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        expect_tetrahedron_text(ms_mesh_parse_obj, texts[i]);
    }
}

static void corners_without_what_they_name_are_read(void **state)
{
    static const struct {
        const char *text, *remark;
    } cases[] = {
        {OBJ_VERTICES "f 1// 3// 2//\nf 1 2 4\nf 2 3 4\nf 3 1 4\n",
         "line 5: '1//' names a texture or normal and gives none; its vertex was read (the first of 3 such places)"},
        {OBJ_VERTICES "f 1 3 2\nf 1 2/ 4\nf 2 3 4\nf 3 1 4\n", "line 6: '2/' names"},
        {OBJ_VERTICES "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1/1/ 4\n", "line 8: '1/1/' names"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        expect_tetrahedron_remarked(ms_mesh_parse_obj, cases[i].text, strlen(cases[i].text), cases[i].remark);
    }
}

static void polygons_are_cut_into_fans(void **state)
{
    static const uint32_t wanted[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {4, 3, 3}};
    const char *text = "v 0 0 0\nv 1 0 0\nv 2 1 0\nv 1 2 0\nv 0 2 0\nf 1 2 3 4 5\nf 5 4 4\n";
    ms_mesh mesh;
    (void)state;
    assert_int_equal(parse_sample(&mesh, ms_mesh_parse_obj, text, strlen(text), NULL), MS_OK);
    assert_int_equal(mesh.n_vertices, 5);
    assert_int_equal(mesh.n_triangles, 4);
    assert_memory_equal(mesh.triangle, wanted, sizeof wanted);
    ms_mesh_free(&mesh);
}

static void malformed_obj_is_refused_with_its_line(void **state)
{
    static const refused_text cases[] = {
        {OBJ_VERTICES "f 1 2 5\n", "line 5: the face names vertex 5 but the file has vertices 1 to 4"},
        {"v 0 0 0\nf 1 -1 -2\n", "line 2: the face names vertex 0 but the file has vertices 1 to 1"},
        {OBJ_VERTICES "f 1 2 99999999999\n", "line 5: the face names vertex 99999999999"},
        {OBJ_VERTICES "f 1 2 0\n", "line 5: '0' is no corner of a face"},
        {OBJ_VERTICES "f 1 2 3.0\n", "line 5: '3.0' is no corner of a face"},
        {OBJ_VERTICES "f 1 2 3///\n", "line 5: '3///' is no corner of a face"},
        {OBJ_VERTICES "f 1 2 //\n", "line 5: '//' is no corner of a face"},
        {OBJ_VERTICES "f 1 2 3/x/\n", "line 5: '3/x/' is no corner of a face"},
        {OBJ_VERTICES "f 1 2 3/1/1/1\n", "line 5: '3/1/1/1' is no corner of a face"},
        {OBJ_VERTICES "f 1 2 /1\n", "line 5: '/1' is no corner of a face"},
        {OBJ_VERTICES "f 1 2\n", "line 5: a face has 2 corners and needs at least 3"},
        {OBJ_VERTICES "f\n", "line 5: a face has 0 corners"},
        {"v 1 2\n", "line 1: a vertex needs 3 numbers but the line has 2"},
        {"v 1 2 x\n", "line 1: a vertex has 'x'"},
        {"v 1 2 3 y\n", "line 1: a vertex has 'y'"},
        {"v 1 2 3 4 5\n", "line 1: a vertex has 5 numbers"},
        {"v 1 2 3 4 5 6 7 8\n", "line 1: a vertex has 8 numbers"},
        {"v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n", "1 of 1 triangles have a corner that is not finite"},
        {"v 0 0 nan\n" OBJ_VERTICES "f 2 3 4\n",
         "0 of 1 triangles have a corner that is not finite (inf or nan), line 1"},
        {"<html>\n", "line 1: '<html>' is no statement of OBJ"},
        {"1 2 3\n", "line 1: '1' is no statement of OBJ"},
        {"surf 0 1 0 1 1 2\n", "line 1: 'surf' is not read"},
        {OBJ_VERTICES, "has no triangles (and 4 vertices)"},
        {"# nothing\n", "has no triangles (and 0 vertices)"},
    };
    (void)state;
    expect_all_refused(ms_mesh_parse_obj, cases, sizeof cases / sizeof cases[0]);
}

static void off_is_read(void **state)
{
    static const char *const texts[] = {
        "OFF\n4 4 6\n" OFF_VERTICES OFF_FACES,
        "OFF 4 4\n" OFF_VERTICES OFF_FACES,
        "# made by hand\r\noff # c\r\n\r\n4 4 0\r\n# c\r\n0.5 -1.25 2.375 # c\r\n\r\n4.75 0 2.375\r\n0.5 3 2.375\r\n"
        "0.5 -1.25 9\r\n3 0 2 1 7\r\n3 0 1 3 255 0 0\r\n3 1 2 3 0.1 0.2 0.3 1\r\n3 2 0 3",
        "COFF\n4 4 6\n0.5 -1.25 2.375 1 2 3 4\n4.75 0 2.375\n0.5 3 2.375\n0.5 -1.25 9\n" OFF_FACES,
        "STCNOFF\n4 4 6\n0.5 -1.25 2.375 1 2 3 4 5 6 7 8\n4.75 0 2.375\n0.5 3 2.375\n0.5 -1.25 9\n" OFF_FACES,
    };
    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        expect_tetrahedron_text(ms_mesh_parse_off, texts[i]);
    }
}

static void malformed_off_is_refused_with_its_line(void **state)
{
    static const refused_text cases[] = {
        {"# no more", "line 1: the file ends where OFF belongs"},
        {"OBJ\n", "line 1: 'OBJ' stands where OFF belongs"},
        {"4OFF\n", "line 1: '4OFF' stands where OFF belongs"},
        {"OFF BINARY\n", "line 1: binary OFF is not read"},
        {"OFF\n", "the file ends where the numbers of vertices and faces belong"},
        {"OFF\n4\n", "line 2: the line ends where the number of faces belongs"},
        {"OFF\n-4 4 6\n", "line 2: '-4' stands where the number of vertices belongs"},
        {"OFF\n4 4 x\n", "line 2: 'x' stands where the number of edges belongs"},
        {"OFF\n4 4 6 7\n", "line 2: '7' stands where the line should end"},
        {"OFF\n9999999999 1 0\n0 0 0\n", "line 2: 9999999999 vertices and 1 faces are claimed but only 7 bytes follow"},
        {"OFF\n1 999999999999999999 0\n0 0 0\n", "line 2: 1 vertices and 999999999999999999 faces are claimed"},
        {"OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n", "line 4: a vertex needs 3 numbers but the line has 2"},
        {"OFF\n3 1 0\n0 0 0\n1 0 0 5\n0 1 0\n3 0 1 2\n", "line 4: '5' stands where the line should end"},
        {"COFF\n3 1 0\n0 0 0\n1 0 0 red\n0 1 0\n3 0 1 2\n", "line 4: 'red' stands where a number belongs"},
        {"OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "line 7: the file ends after 1 of 2 faces"},
        {"OFF\n4 1 0\n0.0 0.0 0.0\n1.0 0.0 0.0\n0.0 1.0 0.0\n", "line 6: the file ends after 3 of 4 vertices"},
        {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n",
         "line 6: the face names vertex 3 but the file has vertices 0 to 2"},
        {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n", "line 6: '-1' stands where the index of a vertex belongs"},
        {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n", "line 6: the line ends where the index of a vertex belongs"},
        {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n", "line 6: a face has 2 corners"},
        {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 2 1\n", "line 7: more follows after the last of 1 faces"},
        {"OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", "has no triangles (and 3 vertices)"},
        {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 inf 0\n3 0 1 2\n", "not finite (inf or nan), line 5 is the first"},
    };
    (void)state;
    expect_all_refused(ms_mesh_parse_off, cases, sizeof cases / sizeof cases[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(obj_is_read),
        cmocka_unit_test(corners_without_what_they_name_are_read),
        cmocka_unit_test(polygons_are_cut_into_fans),
        cmocka_unit_test(malformed_obj_is_refused_with_its_line),
        cmocka_unit_test(off_is_read),
        cmocka_unit_test(malformed_off_is_refused_with_its_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
