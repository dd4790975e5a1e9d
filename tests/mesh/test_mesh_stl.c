/* STL, ASCII and binary: what is read and what is refused. */
#include <math.h>

#include "support/mesh_samples.h"

static void put_header(sample *to, const char *comment, uint32_t count)
{
    uint8_t header[80] = {0};
    memcpy(header, comment, strlen(comment));
    put_bytes(to, header, sizeof header);
    put_integer(to, count, 4, 0);
}

static sample binary_tetrahedron(const char *comment)
{
    sample made = {.size = 0};
    put_header(&made, comment, 4);
    for (int t = 0; t < 4; t++) {
        for (int i = 0; i < 3; i++) {
            put_float32(&made, (double)NAN, 0);
        }
        for (int k = 0; k < 9; k++) {
            put_float32(&made, corner[face[t][k / 3]][k % 3], 0);
        }
        put_integer(&made, 0x8001, 2, 0);
    }
    return made;
}

static sample ascii_facets(int first, int last, const char *end_of_line)
{
    sample made = {.size = 0};
    char line[128];
    for (int t = first; t < last; t++) {
        snprintf(line, sizeof line, "facet normal 0 0 nan%s outer loop%s", end_of_line, end_of_line);
        put_text(&made, line);
        for (int k = 0; k < 3; k++) {
            const double *p = corner[face[t][k]];
            snprintf(line, sizeof line, "\tvertex %.17g %.3e  %.6f%s", p[0], p[1], p[2], end_of_line);
            put_text(&made, line);
        }
        snprintf(line, sizeof line, " endloop%sendfacet%s", end_of_line, end_of_line);
        put_text(&made, line);
    }
    return made;
}

static void ascii_is_read(void **state)
{
    static const char *const ends[] = {"\n", "\r\n", "  \n\n"};
    (void)state;
    for (int i = 0; i < 3; i++) {
        sample made = {.size = 0};
        sample facets = ascii_facets(0, 4, ends[i]);
        put_text(&made, i == 1 ? "\xEF\xBB\xBF \nsolid facet normal" : "solid");
        put_text(&made, ends[i]);
        put_bytes(&made, facets.data, facets.size);
        put_text(&made, i == 2 ? "ENDSOLID" : "endsolid x y\n");
        expect_tetrahedron(ms_mesh_parse_stl, made.data, made.size);
    }
}

static void solids_are_joined(void **state)
{
    sample made = {.size = 0};
    (void)state;
    for (int t = 0; t < 4; t += 2) {
        sample facets = ascii_facets(t, t + 2, "\n");
        put_text(&made, "Solid part\n");
        put_bytes(&made, facets.data, facets.size);
        put_text(&made, "endsolid part\n");
    }
    expect_tetrahedron(ms_mesh_parse_stl, made.data, made.size);
}

static void binary_is_read_whatever_its_header(void **state)
{
    static const char *const comments[] = {"", "COLOR=", "solid", "solid ascii\nfacet normal 0 0 0\n"};
    (void)state;
    for (int i = 0; i < 4; i++) {
        sample made = binary_tetrahedron(comments[i]);
        expect_tetrahedron(ms_mesh_parse_stl, made.data, made.size);
    }
}

static void binary_of_a_wrong_size_is_refused(void **state)
{
    sample made = binary_tetrahedron("solid");
    sample huge = {.size = 0};
    (void)state;
    expect_mesh_refused(ms_mesh_parse_stl, made.data, made.size - 1, MS_ERR_FORMAT,
                        "cut after 3 of 4 triangles: its header claims 284 bytes and the file has 283");
    for (int i = 0; i < 50; i++) {
        put_text(&made, "x");
    }
    expect_mesh_refused(ms_mesh_parse_stl, made.data, made.size, MS_ERR_FORMAT,
                        "claims 4 triangles (284 bytes) has 50 bytes more behind byte 284");
    put_header(&huge, "", UINT32_MAX);
    expect_mesh_refused(ms_mesh_parse_stl, huge.data, huge.size, MS_ERR_FORMAT,
                        "cut after 0 of 4294967295 triangles: its header claims 214748364834 bytes");
    expect_mesh_refused(ms_mesh_parse_stl, huge.data, 83, MS_ERR_FORMAT, "is no STL");
}

static void what_stands_behind_the_last_triangle_is_passed_over(void **state)
{
    static const struct {
        const char *text; /* and the 0 behind it */
        size_t size, times;
        const char *remark;
    } tails[] = {
        {"\n", 1, 1, "sample: 1 bytes behind the last of its 4 triangles"},
        {"\r\n", 2, 1, "2 bytes behind"},
        {"x", 1, 49, "49 bytes behind"},
        {"", 1, 200, "200 bytes behind"},
        {" \n", 2, 100, "200 bytes behind"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof tails / sizeof tails[0]; i++) {
        sample made = binary_tetrahedron("solid");
        for (size_t k = 0; k < tails[i].times; k++) {
            put_bytes(&made, tails[i].text, tails[i].size);
        }
        expect_tetrahedron_remarked(ms_mesh_parse_stl, made.data, made.size, tails[i].remark);
    }
}

static void ends_in_two_words_or_none_are_read(void **state)
{
    static const char *const ends[] = {"end solid", "End Solid name\n", "", "\n"};
    static const char *const remarks[] = {"line 30: 'end solid' was read as 'endsolid'", "'end solid'",
                                          "line 30: the file ends without 'endsolid' after 4 triangles",
                                          "line 31: the file ends without"};
    sample facets = ascii_facets(0, 4, "\n");
    (void)state;
    for (size_t i = 0; i < sizeof ends / sizeof ends[0]; i++) {
        sample made = {.size = 0};
        put_text(&made, "solid\n");
        put_bytes(&made, facets.data, facets.size);
        put_text(&made, ends[i]);
        expect_tetrahedron_remarked(ms_mesh_parse_stl, made.data, made.size, remarks[i]);
    }
}

#define TWO_WORDS " end loop\n end facet\n"

static void facets_that_end_in_two_words_are_read(void **state)
{
    static const char text[] =
        "solid\n"
        "facet normal 0 0 1 outer loop vertex .5 -1.25 2.375\nvertex .5 3 2.375\n"
        "vertex 4.75 0 2.375\n" TWO_WORDS "facet normal 0 0 1 outer loop vertex .5 -1.25 2.375\nvertex 4.75 0 2.375\n"
        "vertex .5 -1.25 9\n" TWO_WORDS "facet normal 0 0 1 outer loop vertex 4.75 0 2.375\nvertex .5 3 2.375\n"
        "vertex .5 -1.25 9\n" TWO_WORDS "facet normal 0 0 1 outer loop vertex .5 3 2.375\nvertex .5 -1.25 2.375\n"
        "vertex .5 -1.25 9\n" TWO_WORDS "endsolid\n";
    (void)state;
    expect_tetrahedron_remarked(ms_mesh_parse_stl, text, sizeof text - 1,
                                "line 5: 'end loop' was read as 'endloop' (the first of 8 such places)");
}

static void binary_without_triangles_is_refused(void **state)
{
    sample made = {.size = 0};
    (void)state;
    put_header(&made, "", 0);
    expect_mesh_refused(ms_mesh_parse_stl, made.data, made.size, MS_ERR_FORMAT, "has no triangles");
}

static void binary_that_is_not_finite_is_refused(void **state)
{
    sample made = binary_tetrahedron("");
    sample infinite = {.size = 0};
    (void)state;
    put_float32(&infinite, (double)INFINITY, 0);
    /* The second corner of the second triangle is corner 1, and that of the fourth is corner 0. */
    memcpy(made.data + 84 + 50 + 12 + 12 + 8, infinite.data, 4);
    memcpy(made.data + 84 + 150 + 12 + 12, infinite.data, 4);
    expect_mesh_refused(ms_mesh_parse_stl, made.data, made.size, MS_ERR_FORMAT,
                        "2 of 4 triangles have a corner that is not finite (inf or nan), byte 158 is the first");
}

#define OPEN "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
#define FACET OPEN "endloop\nendfacet\n"

static void malformed_ascii_is_refused_with_its_line(void **state)
{
    static const refused_text cases[] = {
        {"solid s\nfacet normal 0 0 1\nouter loop\nvertex 12.5 abc 7\n",
         "line 4: a vertex has 'abc' where a number belongs"},
        {"solid s\nfacet normal 0 0 1\nouter loop\nvertex 12.5 7,3 7\n", "line 4: a vertex has '7,3'"},
        {"solid s\nfacet normal 0 0 1\nouter loop\nvertex 1.0 2.0\nvertex 1 2 3\n",
         "line 4: a vertex needs 3 numbers but the line has 2"},
        {"solid s\nfacet normal 0 0 1\nouter loop\nvertex 1 2 3 4\n", "line 4: '4' stands where 'vertex' belongs"},
        {"solid s\nfacet normal 0 0\nouter loop\n", "line 2: a normal needs 3 numbers but the line has 2"},
        {"solid s\nfacet 0 0 1\n", "line 2: '0' stands where 'normal' belongs"},
        {"solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\n",
         "line 6: 'endloop' stands where 'vertex' belongs"},
        {OPEN "vertex 1 1 1\nendloop\nendfacet\nendsolid\n", "line 7: 'vertex' stands where 'endloop' belongs"},
        {OPEN "endloop\n", "line 8: the file ends where 'endfacet' belongs"},
        {"solid s\n", "line 2: the file ends without 'endsolid' after 0 triangles"},
        {FACET "end\n", "line 9: 'end' stands where 'facet' or 'endsolid'"},
        {FACET "end facet\n", "line 9: 'end' stands where 'facet' or 'endsolid'"},
        {OPEN "end facet\n", "line 7: 'end' stands where 'endloop' belongs"},
        {OPEN "endlooped\n", "line 7: 'endlooped' stands where 'endloop' belongs"},
        {FACET "<html>404 Not Found</html>\nendsolid\n", "line 9: '<html>404' stands where 'facet' or 'endsolid'"},
        {FACET "endsolid s\njunk\n", "line 10: 'junk' stands where 'solid' belongs"},
        {"solid s\nendsolid s\n", "has no triangles"},
        {"solid", "line 1: the file ends without 'endsolid'"},
        {"solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 inf 0\nvertex 0 1 1e999\nendloop\nendfacet\n"
         "endsolid",
         "1 of 1 triangles have a corner that is not finite (inf or nan), line 5 is the first"},
        {"solidity s\nendsolid s\n", "is no STL"},
        {"<html>", "is no STL"},
        {"\n", "is no STL"},
    };
    (void)state;
    expect_all_refused(ms_mesh_parse_stl, cases, sizeof cases / sizeof cases[0]);
}

static void meshes_over_the_limit_are_refused(void **state)
{
    ms_mesh_builder builder = {.name = "sample"};
    ms_mesh mesh;
    ms_error err;
    (void)state;
    assert_int_equal(ms_mesh_build_reserve(&builder, (size_t)UINT32_MAX + 1, 0, &err), MS_ERR_LIMIT);
    expect_message(&err, "sample: has more than 4294967295 vertices");
    assert_int_equal(ms_mesh_build_reserve(&builder, 0, ((size_t)1 << 31) + 1, &err), MS_ERR_LIMIT);
    expect_message(&err, "sample: has more than 2147483648 triangles");
    assert_int_equal(ms_mesh_build_finish(&mesh, NULL, &builder, MS_ERR_LIMIT, &err), MS_ERR_LIMIT);
    assert_null(mesh.vertex);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ascii_is_read),
        cmocka_unit_test(solids_are_joined),
        cmocka_unit_test(binary_is_read_whatever_its_header),
        cmocka_unit_test(binary_of_a_wrong_size_is_refused),
        cmocka_unit_test(what_stands_behind_the_last_triangle_is_passed_over),
        cmocka_unit_test(ends_in_two_words_or_none_are_read),
        cmocka_unit_test(facets_that_end_in_two_words_are_read),
        cmocka_unit_test(binary_without_triangles_is_refused),
        cmocka_unit_test(binary_that_is_not_finite_is_refused),
        cmocka_unit_test(meshes_over_the_limit_are_refused),
        cmocka_unit_test(malformed_ascii_is_refused_with_its_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
