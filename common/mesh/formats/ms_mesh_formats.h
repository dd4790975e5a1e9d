/** What the readers of mesh formats share: one parser per format, and the mesh as it grows. Private. */
#ifndef MS_MESH_FORMATS_H
#define MS_MESH_FORMATS_H

#include "base/ms_file.h"
#include "mesh/ms_mesh.h"

/**
 * One parser per format, from memory, so that tests and fuzzers need no files.
 *
 * @param[out] mesh   the caller frees it; empty on failure
 * @param[out] remark as ms_mesh_parse
 * @param      bytes of the file, with the 0 byte behind them
 * @param      name  of the file, for messages
 * @return MS_OK; MS_ERR_FORMAT; MS_ERR_LIMIT; MS_ERR_NOMEM
 */
ms_status ms_mesh_parse_stl(ms_mesh *mesh, ms_error *remark, const ms_bytes *bytes, const char *name, ms_error *err);
ms_status ms_mesh_parse_obj(ms_mesh *mesh, ms_error *remark, const ms_bytes *bytes, const char *name, ms_error *err);
ms_status ms_mesh_parse_ply(ms_mesh *mesh, ms_error *remark, const ms_bytes *bytes, const char *name, ms_error *err);
ms_status ms_mesh_parse_off(ms_mesh *mesh, ms_error *remark, const ms_bytes *bytes, const char *name, ms_error *err);

/** A face of more than three corners, as the triangles of its fan. */
typedef struct ms_mesh_fan {
    size_t first, n; /* triangles */
    size_t place;
} ms_mesh_fan;

/** A mesh under construction. Places are line numbers in text and byte offsets in binary files. */
typedef struct ms_mesh_builder {
    const char *name;       /* of the file */
    const char *place_word; /* "line" or "byte" */
    int64_t first_index;    /* what the format calls its first vertex: 0 or 1 */
    ms_mesh mesh;           /* vertices as in the file, not yet welded */
    size_t vertex_room;
    size_t triangle_room;
    ms_mesh_fan *polygon;
    size_t n_polygons, polygon_room;
    size_t place;     /* of the face under way */
    size_t n_corners; /* of the face under way */
    uint32_t fan[2];  /* its first corner and its latest; of a strip those of the next triangle, in its order */
    uint32_t largest; /* index of a vertex that any face names, from 0 */
    size_t largest_place;
    size_t n_not_finite;     /* vertices */
    size_t first_not_finite; /* its place */
    ms_error remark;         /* the first */
    size_t n_remarks;
} ms_mesh_builder;

/** Room for what a header announces; the caller has checked that the file is long enough to hold it. */
ms_status ms_mesh_build_reserve(ms_mesh_builder *builder, size_t n_vertices, size_t n_triangles, ms_error *err);

ms_status ms_mesh_build_vertex(ms_mesh_builder *builder, const double position[3], size_t place, ms_error *err);

/** A polygon: begin, its corners in turn, end. It is cut into triangles within it (ms_mesh_polygon.h). */
void ms_mesh_build_face_begin(ms_mesh_builder *builder, size_t place);

/** A vertex, counted from 0, that may come later in the file: whether it exists is checked at the end. */
ms_status ms_mesh_build_face_corner(ms_mesh_builder *builder, int64_t index, ms_error *err);
ms_status ms_mesh_build_face_end(ms_mesh_builder *builder, ms_error *err);

/**
 * A strip: begin as a face, its corners in turn, end. Each corner after the second makes a triangle with the two before
 * it. A negative index begins a new strip; a triangle with two equal corners joins parts of one and is left out.
 */
ms_status ms_mesh_build_strip_corner(ms_mesh_builder *builder, int64_t index, ms_error *err);
ms_status ms_mesh_build_strip_end(const ms_mesh_builder *builder, ms_error *err);

/** Notes what was passed over, in one sentence with file and place; of several the first is told, and how many. */
void ms_mesh_build_remark(ms_mesh_builder *builder, const char *format, ...) MS_PRINTF(2, 3);

/** Nonzero if all bytes are blanks, ends of lines or 0, as programs and copies leave behind a binary file. */
int ms_mesh_build_is_padding(const uint8_t *bytes, size_t size);

/**
 * Checks the mesh, cuts its polygons, welds vertices with equal coordinates (-0 equals 0) and drops those that
 * no triangle uses; the others keep the order of the file. Frees the builder in any case.
 *
 * @param[out] remark as ms_mesh_parse
 * @param      status of the parsing; nothing is built unless it is MS_OK
 * @return `status` if that is not MS_OK; MS_OK; MS_ERR_FORMAT; MS_ERR_LIMIT and cost as
 *         ms_mesh_polygon_cut, else O(vertices + triangles); MS_ERR_NOMEM
 */
ms_status ms_mesh_build_finish(ms_mesh *mesh, ms_error *remark, ms_mesh_builder *builder, ms_status status,
                               ms_error *err);

#endif
