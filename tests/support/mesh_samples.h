/** A tetrahedron that every format can hold exactly, and what a parser must say of a sample. */
#ifndef MESH_SAMPLES_H
#define MESH_SAMPLES_H

#include "mesh/formats/ms_mesh_formats.h"
#include "reader_samples.h"

/* Powers of two apart, so that float32 holds them; a coordinate is negative, one is 0. */
static const double corner[4][3] = {{0.5, -1.25, 2.375}, {4.75, 0.0, 2.375}, {0.5, 3.0, 2.375}, {0.5, -1.25, 9.0}};
static const int face[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};

typedef ms_status mesh_parser(ms_mesh *mesh, ms_error *remark, const ms_bytes *bytes, const char *name, ms_error *err);

static inline ms_status parse_remarked(ms_mesh *mesh, ms_error *remark, mesh_parser *parse, const void *data,
                                       size_t size, ms_error *err)
{
    ms_bytes bytes = copy_bytes(data, size);
    ms_status status = parse(mesh, remark, &bytes, "sample", err);
    ms_file_free(&bytes);
    return status;
}

static inline ms_status parse_sample(ms_mesh *mesh, mesh_parser *parse, const void *data, size_t size, ms_error *err)
{
    return parse_remarked(mesh, NULL, parse, data, size, err);
}

static inline void expect_mesh_refused(mesh_parser *parse, const void *data, size_t size, ms_status status,
                                       const char *message)
{
    ms_mesh mesh;
    ms_error err = {{0}};
    ms_status got = parse_sample(&mesh, parse, data, size, &err);
    if (got != status) {
        fail_msg("status %d and not %d where \"%s\" was expected: \"%s\"", got, status, message, err.text);
    }
    expect_message(&err, "sample: ");
    expect_message(&err, message);
    assert_null(mesh.vertex);
    assert_null(mesh.triangle);
    assert_int_equal(mesh.n_vertices + mesh.n_triangles, 0);
    /* Without a message the status is the same. */
    assert_int_equal(parse_sample(&mesh, parse, data, size, NULL), status);
}

/** @param message a part of the remark; NULL: there must be none */
static inline void expect_tetrahedron_remarked(mesh_parser *parse, const void *data, size_t size, const char *message)
{
    ms_mesh mesh;
    ms_error err = {{0}}, remark;
    ms_status status = parse_remarked(&mesh, &remark, parse, data, size, &err);
    if (status) {
        fail_msg("refused: %s", err.text);
    }
    if (message) {
        expect_message(&remark, "sample: ");
        expect_message(&remark, message);
    } else {
        assert_string_equal(remark.text, "");
    }
    assert_int_equal(mesh.n_vertices, 4);
    assert_int_equal(mesh.n_triangles, 4);
    for (int t = 0; t < 4; t++) {
        for (int k = 0; k < 3; k++) {
            assert_memory_equal(mesh.vertex[mesh.triangle[t][k]], corner[face[t][k]], sizeof corner[0]);
        }
    }
    ms_mesh_free(&mesh);
}

static inline void expect_tetrahedron(mesh_parser *parse, const void *data, size_t size)
{
    expect_tetrahedron_remarked(parse, data, size, NULL);
}

static inline void expect_tetrahedron_text(mesh_parser *parse, const char *text)
{
    expect_tetrahedron(parse, text, strlen(text));
}

/** A text that must be refused as malformed, and a part of the message. */
typedef struct refused_text {
    const char *text;
    const char *message;
} refused_text;

static inline void expect_all_refused(mesh_parser *parse, const refused_text *cases, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        expect_mesh_refused(parse, cases[i].text, strlen(cases[i].text), MS_ERR_FORMAT, cases[i].message);
    }
}

#endif
