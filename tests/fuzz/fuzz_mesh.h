/** A fuzz target of one parser of meshes. */
#ifndef FUZZ_MESH_H
#define FUZZ_MESH_H

#include "fuzz.h"
#include "mesh/formats/ms_mesh_formats.h"

typedef ms_status fuzz_mesh_parser(ms_mesh *mesh, ms_error *remark, const ms_bytes *bytes, const char *name,
                                   ms_error *err);

static inline void fuzz_check_mesh(const ms_mesh *mesh)
{
    FUZZ_REQUIRE(mesh->n_triangles > 0 && mesh->n_vertices > 0);
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        for (int k = 0; k < 3; k++) {
            FUZZ_REQUIRE(mesh->triangle[t][k] < mesh->n_vertices);
        }
    }
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        for (int k = 0; k < 3; k++) {
            FUZZ_REQUIRE(isfinite(mesh->vertex[v][k]));
        }
    }
}

static inline int fuzz_mesh(fuzz_mesh_parser *parse, const uint8_t *data, size_t size)
{
    ms_mesh mesh;
    ms_error err = {{0}}, remark;
    ms_bytes bytes = fuzz_bytes(data, size);
    ms_status status = parse(&mesh, &remark, &bytes, "fuzz", &err);
    if (status == MS_OK) {
        fuzz_check_mesh(&mesh);
        FUZZ_REQUIRE(remark.text[0] == 0 || strncmp(remark.text, "fuzz: ", 6) == 0);
    } else {
        FUZZ_REQUIRE(!mesh.vertex && !mesh.triangle && mesh.n_vertices == 0 && mesh.n_triangles == 0);
        FUZZ_REQUIRE(strncmp(err.text, "fuzz: ", 6) == 0);
    }
    ms_mesh_free(&mesh);
    ms_file_free(&bytes);
    return 0;
}

#endif
