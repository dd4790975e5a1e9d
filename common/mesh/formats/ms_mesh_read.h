/** Reads triangle meshes: STL (ASCII, binary), OBJ, PLY (ASCII, binary), OFF. */
#ifndef MS_MESH_READ_H
#define MS_MESH_READ_H

#include "base/ms_file.h"
#include "mesh/ms_mesh.h"

MS_C_BEGIN

/**
 * Reads a mesh, in double precision: a file that does not say exactly one mesh is refused. Of what other programs get
 * wrong, that is read which leaves no doubt (docs/formats.md). The format comes from the ending (.stl .obj .ply .off).
 * Polygons are cut into triangles that stay within them; vertices with equal coordinates are welded, those that no face
 * uses dropped. What an untrusted header claims is checked against the file's size before anything is allocated.
 *
 * @param[out] mesh the caller frees it; empty on failure
 * @param      path the file
 * @param[out] err  names the file and the line or byte; may be NULL
 * @return MS_OK; MS_ERR_IO; MS_ERR_FORMAT; MS_ERR_LIMIT over 2^31 triangles or for concave
 *         polygons that take very long to cut; MS_ERR_NOMEM
 *
 * Cost: O(file size), and of concave polygons mostly O(corners^2).
 */
MS_API ms_status ms_mesh_read(ms_mesh *mesh, const char *path, ms_error *err);

/**
 * The same from the bytes of a file that was read already; the path tells the format and stands in messages. Of "-",
 * standard input, the content tells it.
 *
 * @param[out] remark what is wrong in the file though it was read, in one sentence; empty if nothing is; may be NULL
 */
MS_API ms_status ms_mesh_parse(ms_mesh *mesh, ms_error *remark, const ms_bytes *bytes, const char *path, ms_error *err);

/** Nonzero if the path ends like a mesh that ms_mesh_read takes. */
MS_API int ms_mesh_read_is_mesh_path(const char *path);

MS_C_END

#endif
