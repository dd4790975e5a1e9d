/** Writes triangle meshes: binary STL, OBJ, PLY, OFF, by the ending of the path. */
#ifndef MS_MESH_WRITE_H
#define MS_MESH_WRITE_H

#include <stdio.h>

#include "mesh/ms_mesh.h"

MS_C_BEGIN

/**
 * Writes a mesh to a temporary name beside `path` and renames it there when it is whole.
 * STL holds single precision; the text formats restore the doubles.
 *
 * @param path the file; "-" writes OFF to standard output
 * @return MS_OK; MS_ERR_ARG for an unknown ending or coordinates beyond single precision in
 *         STL; MS_ERR_LIMIT; MS_ERR_NOMEM; MS_ERR_IO
 */
MS_API ms_status ms_mesh_write(const ms_mesh *mesh, const char *path, ms_error *err);

/** The same to an open file. @param ending "stl", "obj", "ply" or "off" @return as above; MS_ERR_IO has no message */
MS_API ms_status ms_mesh_write_stream(const ms_mesh *mesh, FILE *stream, const char *ending, ms_error *err);

MS_C_END

#endif
