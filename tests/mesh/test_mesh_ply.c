/* PLY in its three encodings: what is read and what is refused. */
#include <math.h>

#include "support/mesh_samples.h"

typedef enum encoding { ASCII, LITTLE, BIG } encoding;

static const char *const encoding_name[] = {"ascii", "binary_little_endian", "binary_big_endian"};

/* One value in the encoding of the file. */
static void put_value(sample *to, const char *type, double value, encoding as)
{
    int size = strstr(type, "8") || strstr(type, "char") ? 1 : strstr(type, "16") || strstr(type, "short") ? 2 : 4;
    char text[32];
    if (as == ASCII) {
        snprintf(text, sizeof text, " %.17g", value);
        put_text(to, text);
    } else if (strcmp(type, "double") == 0 || strcmp(type, "float64") == 0) {
        put_float64(to, value, as == BIG);
    } else if (strstr(type, "float")) {
        put_float32(to, value, as == BIG);
    } else {
        put_integer(to, (uint64_t)(int64_t)value, (size_t)size, as == BIG);
    }
}

static void end_row(sample *to, encoding as)
{
    if (as == ASCII) {
        put_text(to, "\n");
    }
}

static void put_vertices(sample *to, const char *type, encoding as)
{
    for (int v = 0; v < 4; v++) {
        put_value(to, "uchar", 200.0, as);
        for (int k = 0; k < 3; k++) {
            put_value(to, type, corner[v][k], as);
        }
        put_value(to, "uint8", 2.0, as);
        put_value(to, "double", -7.5, as);
        put_value(to, "double", 1e300, as);
        end_row(to, as);
    }
}

static void put_faces(sample *to, const char *count_type, const char *index_type, encoding as)
{
    for (int t = 0; t < 4; t++) {
        put_value(to, count_type, 3.0, as);
        for (int k = 0; k < 3; k++) {
            put_value(to, index_type, face[t][k], as);
        }
        put_value(to, "short", -2.0, as);
        end_row(to, as);
    }
}

static void put_others(sample *to, encoding as)
{
    for (int i = 0; i < 2; i++) {
        put_value(to, "uint16", i, as);
        for (int k = 0; k < i; k++) {
            put_value(to, "float", 2.5, as);
        }
        put_value(to, "int8", -1.0, as);
        end_row(to, as);
    }
}

static sample tetrahedron(const char *type, const char *count_type, const char *index_type, encoding as,
                          int faces_first)
{
    char vertex[256];
    char faces[256];
    sample made = {.size = 0};
    snprintf(vertex, sizeof vertex,
             "element vertex 4\nproperty uchar red\nproperty %s x\nproperty %s y\nproperty %s z\n"
             "property list uint8 double w\n",
             type, type, type);
    snprintf(faces, sizeof faces, "element face 4\nproperty list %s %s %s\nproperty short flag\n", count_type,
             index_type, faces_first ? "vertex_index" : "vertex_indices");
    put_text(&made, "ply\nformat ");
    put_text(&made, encoding_name[as]);
    put_text(&made, " 1.0\ncomment made by hand\nobj_info x\n");
    put_text(&made, faces_first ? faces : vertex);
    put_text(&made, "element other 2\nproperty list uint16 float q\nproperty int8 s\n");
    put_text(&made, faces_first ? vertex : faces);
    put_text(&made, "end_header\n");
    if (faces_first) {
        put_faces(&made, count_type, index_type, as);
    } else {
        put_vertices(&made, type, as);
    }
    put_others(&made, as);
    if (faces_first) {
        put_vertices(&made, type, as);
    } else {
        put_faces(&made, count_type, index_type, as);
    }
    return made;
}

static void every_encoding_and_type_is_read(void **state)
{
    static const char *const reals[] = {"float", "double", "float32", "float64"};
    static const char *const integers[] = {"char", "uchar", "short", "ushort", "int",   "uint",
                                           "int8", "uint8", "int16", "uint16", "int32", "uint32"};
    (void)state;
    for (encoding as = ASCII; as <= BIG; as++) {
        for (int i = 0; i < 12; i++) {
            for (int first = 0; first < 2; first++) {
                sample made = tetrahedron(reals[i % 4], integers[i], integers[11 - i], as, first);
                expect_tetrahedron(ms_mesh_parse_ply, made.data, made.size);
            }
        }
    }
}

#define HEAD(format) \
    "ply\r\nformat " format " 1.0\r\nelement vertex 3\r\nproperty short x\r\nproperty short y\r\nproperty short z\r\n"
#define FACE "element face 1\r\nproperty list uchar uchar vertex_indices\r\nend_header\r\n"

static void integer_coordinates_are_read(void **state)
{
    static const double wanted[3][3] = {{-1.0, 0.0, 0.0}, {300.0, 0.0, 0.0}, {0.0, 7.0, -300.0}};
    sample made = {.size = 0};
    ms_mesh mesh;
    (void)state;
    put_text(&made, HEAD("binary_big_endian") FACE);
    for (int i = 0; i < 9; i++) {
        put_integer(&made, (uint64_t)(int64_t)wanted[i / 3][i % 3], 2, 1);
    }
    put_bytes(&made, "\3\0\1\2", 4);
    assert_int_equal(parse_sample(&mesh, ms_mesh_parse_ply, made.data, made.size, NULL), MS_OK);
    assert_memory_equal(mesh.vertex, wanted, sizeof wanted);
    ms_mesh_free(&mesh);
}

static void binary_of_a_wrong_length_is_refused(void **state)
{
    sample made = tetrahedron("float", "uchar", "int", LITTLE, 0);
    (void)state;
    expect_mesh_refused(ms_mesh_parse_ply, made.data, made.size - 1, MS_ERR_FORMAT, "is cut inside its rows");
    expect_mesh_refused(ms_mesh_parse_ply, made.data, 57, MS_ERR_FORMAT, "line 4: the file ends without 'end_header'");
    put_text(&made, "\n");
    expect_tetrahedron_remarked(ms_mesh_parse_ply, made.data, made.size, "1 bytes behind its last row");
    put_text(&made, "0");
    expect_mesh_refused(ms_mesh_parse_ply, made.data, made.size, MS_ERR_FORMAT, "2 bytes follow after the last row");
}

static void bad_values_of_binary_are_refused_with_their_byte(void **state)
{
    static const refused_text endings[] = {
        {"\3\0\1\3", "byte 198: the face names vertex 3 but the file has vertices 0 to 2"},
        {"\2\0\1", "byte 198: a face has 2 corners and needs at least 3"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof endings / sizeof endings[0]; i++) {
        sample made = {.size = 0};
        put_text(&made, HEAD("binary_little_endian") FACE);
        put_bytes(&made, "\0\0\0\0\0\0\1\0\0\0\0\0\0\0\1\0\0\0", 18);
        assert_int_equal(made.size, 198);
        put_bytes(&made, endings[i].text, i == 0 ? 4 : 3);
        expect_mesh_refused(ms_mesh_parse_ply, made.data, made.size, MS_ERR_FORMAT, endings[i].message);
    }
}

static void lists_of_negative_length_are_refused(void **state)
{
    sample made = {.size = 0};
    (void)state;
    put_text(&made, HEAD("binary_little_endian") "element face 1\nproperty list char char vertex_index\nend_header\n");
    put_bytes(&made, "\0\0\0\0\0\0\1\0\0\0\0\0\0\0\1\0\0\0\377\0\1\2", 22);
    expect_mesh_refused(ms_mesh_parse_ply, made.data, made.size, MS_ERR_FORMAT, "a list has the length -1");
}

#define P "ply\nformat ascii 1.0\n"
#define XYZ "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
#define LIST "property list uchar int vertex_indices\n"
#define F1 "element face 1\n" LIST
#define END "end_header\n"
#define ROWS "0 0 0\n1 0 0\n0 1 0\n"

/* One strip, and strips that are joined by corners that stand twice or by -1. */
static void strips_are_read(void **state)
{
    static const struct {
        const char *row;
        size_t n;
        uint32_t wanted[4][3];
    } cases[] = {
        {"6 0 1 2 3 4 5", 4, {{0, 1, 2}, {2, 1, 3}, {2, 3, 4}, {4, 3, 5}}},
        {"7 0 1 2 -1 3 4 5", 2, {{0, 1, 2}, {3, 4, 5}}},
        {"8 0 1 2 2 3 3 4 5", 2, {{0, 1, 2}, {4, 3, 5}}},
        {"9 0 1 2 2 2 3 3 4 5", 2, {{0, 1, 2}, {3, 4, 5}}},
        {"8 -1 -1 0 1 2 -1 -1 -1", 1, {{0, 1, 2}}},
    };
    char text[512];
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        ms_mesh mesh;
        ms_error err = {{0}}, remark;
        snprintf(
            text, sizeof text,
            P "element vertex 6\nproperty float x\nproperty float y\nproperty float z\nelement tristrips 1\n" LIST END
              "0 0 0\n1 0 0\n2 0 1\n3 1 0\n4 0 2\n5 2 0\n%s\n",
            cases[i].row);
        if (parse_remarked(&mesh, &remark, ms_mesh_parse_ply, text, strlen(text), &err)) {
            fail_msg("%s", err.text);
        }
        expect_message(&remark, "sample: its triangle strips were read as triangles");
        assert_int_equal(mesh.n_triangles, cases[i].n);
        for (size_t c = 0; c < 3 * cases[i].n; c++) { /* the first coordinate is the number in the file */
            assert_true(mesh.vertex[mesh.triangle[c / 3][c % 3]][0] == cases[i].wanted[c / 3][c % 3]);
        }
        ms_mesh_free(&mesh);
    }
}

static void malformed_headers_are_refused_with_their_line(void **state)
{
    static const refused_text cases[] = {
        {"plx\n", "line 1: 'plx' stands where 'ply' belongs"},
        {"ply\n", "the file ends without 'end_header'"},
        {"ply\nformat binary_middle_endian 1.0\n", "line 2: the format 'binary_middle_endian' is none of"},
        {"ply\nformat ascii 2.0\n", "line 2: version '2.0' stands where 1.0 belongs"},
        {"ply\nformat ascii\n", "line 2: the line ends where the version 1.0 belongs"},
        {"ply\nformat\n", "line 2: the line ends where the format belongs"},
        {"ply\nformat ascii 1.0 x\n", "line 2: 'x' stands where the line should end"},
        {"ply\n" XYZ F1 END, "line 8: the header ends without 'format'"},
        {P "element vertex twelve\n", "line 3: 'twelve' is no number of elements"},
        {P "element vertex -1\n", "line 3: '-1' is no number of elements"},
        {P "element vertex\n", "line 3: the line ends where the number of elements belongs"},
        {P "element\n", "line 3: the line ends where the name of an element belongs"},
        {P "property float x\n", "line 3: a property stands before the first element"},
        {P "element vertex 3\nproperty quux y\n", "line 4: 'quux' is no type for a property"},
        {P "element vertex 3\nproperty list float int y\n", "line 4: 'float' is no type for the length of a list"},
        {P "element vertex 3\nproperty float\n", "line 4: the line ends where the name of a property belongs"},
        {P "element vertex 3\nproperty\n", "line 4: the line ends where a type belongs"},
        {P "element vertex 3\nproperty list\n", "line 4: the line ends where a type belongs"},
        {P XYZ "property float x\n", "line 7: a second property 'x'"},
        {P XYZ "element vertex 3\n", "line 7: a second element 'vertex'"},
        {P XYZ "element tristrips 1\nelement tristrips 1\n", "line 8: a second element 'tristrips'"},
        {P XYZ "element tristrips 0\n" LIST END ROWS, "has no faces (and 3 points)"},
        {P XYZ "element tristrips 1\nproperty list uchar int strips\n" END ROWS "3 0 1 2\n",
         "or the list 'vertex_indices'"},
        {P XYZ "element tristrips 1\n" LIST END ROWS "2 0 1\n", "line 13: a strip has 2 corners and needs at least 3"},
        {P XYZ "element tristrips 1\n" LIST END ROWS "6 0 1 2 -1 0 1\n", "line 13: a strip has 2 corners"},
        {P XYZ "element tristrips 1\n" LIST END ROWS "6 0 -1 0 1 2 0\n", "line 13: a strip has 1 corners"},
        {P XYZ "element tristrips 1\n" LIST END ROWS "3 0 1 3\n", "line 13: the face names vertex 3"},
        {P "junk\n", "line 3: 'junk' is no line of a PLY header"},
        {P XYZ END ROWS, "has no faces (and 3 points)"},
        {P XYZ "element face 0\nproperty list uchar int vertex_indices\n" END ROWS, "has no faces (and 3 points)"},
        {P "element vertex 3\nproperty float x\nproperty float y\n" F1 END, "the header lacks x, y, z"},
        {P XYZ "element face 1\nproperty list uchar int edges\n" END, "or the list 'vertex_indices'"},
        {P XYZ "element face 999999999999\nproperty list uchar int vertex_indices\n" END ROWS,
         "line 7: 999999999999 rows of at least 2 bytes are claimed but only 1"},
        {P XYZ "element other 9999999999\n" F1 END ROWS, "line 7: an element has 9999999999 rows and no property"},
    };
    (void)state;
    expect_all_refused(ms_mesh_parse_ply, cases, sizeof cases / sizeof cases[0]);
}

static void headers_beyond_the_limits_are_refused(void **state)
{
    sample elements = {.size = 0};
    sample properties = {.size = 0};
    (void)state;
    put_text(&elements, P);
    put_text(&properties, P "element other 1\n");
    for (int i = 0; i < 33; i++) {
        put_text(&elements, "element other 0\n");
    }
    for (int i = 0; i < 513; i++) {
        put_text(&properties, "property int q\n");
    }
    expect_mesh_refused(ms_mesh_parse_ply, elements.data, elements.size, MS_ERR_FORMAT,
                        "line 35: more than 32 elements are not read");
    expect_mesh_refused(ms_mesh_parse_ply, properties.data, properties.size, MS_ERR_FORMAT,
                        "line 516: more than 512 properties are not read");
}

static void malformed_rows_are_refused_with_their_line(void **state)
{
    static const refused_text cases[] = {
        {P XYZ F1 END "0 0 0\n1 0\n0 1 0\n3 0 1 2\n", "line 11: a row needs 1 numbers but the line has 0"},
        {P XYZ F1 END "0 0 0\n1 0 x\n0 1 0\n3 0 1 2\n", "line 11: a row has 'x' where a number belongs"},
        {P XYZ F1 END "0 0 0\n1 0 0 9\n0 1 0\n3 0 1 2\n", "line 11: '9' stands where the line should end"},
        {P XYZ F1 END "0.0 0.0 0.0\n1.0 0.0 0.0\n0.0 1.0 0.0\n", "line 13: the file ends after 0 of 1 rows"},
        {P XYZ F1 END ROWS "3 0 1 2.5\n", "line 13: 2.5 is no index or length"},
        {P XYZ F1 END ROWS "3 0 1 -1\n", "line 13: the face names vertex -1"},
        {P XYZ F1 END ROWS "3 0 1 3\n", "line 13: the face names vertex 3 but the file has vertices 0 to 2"},
        {P XYZ F1 END ROWS "-3 0 1 2\n", "line 13: a list has the length -3"},
        {P XYZ F1 END ROWS "nan 0 1 2\n", "line 13: nan is no index or length"},
        {P XYZ F1 END ROWS "4000000000 0 1 2\n", "line 13: a row needs 1 numbers but the line has 0"},
        {P XYZ F1 END ROWS "2 0 1\n", "line 13: a face has 2 corners"},
        {P XYZ F1 END ROWS "3 0 1 2\n3 0 1 2\n", "line 14: more follows after the last row"},
        {P XYZ F1 END "0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n", "not finite (inf or nan), line 10 is the first"},
    };
    (void)state;
    expect_all_refused(ms_mesh_parse_ply, cases, sizeof cases / sizeof cases[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_encoding_and_type_is_read),
        cmocka_unit_test(integer_coordinates_are_read),
        cmocka_unit_test(binary_of_a_wrong_length_is_refused),
        cmocka_unit_test(bad_values_of_binary_are_refused_with_their_byte),
        cmocka_unit_test(lists_of_negative_length_are_refused),
        cmocka_unit_test(strips_are_read),
        cmocka_unit_test(malformed_headers_are_refused_with_their_line),
        cmocka_unit_test(headers_beyond_the_limits_are_refused),
        cmocka_unit_test(malformed_rows_are_refused_with_their_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
