/** Fewer triangles, for show. */
#ifndef MS_MESH_DECIMATE_H
#define MS_MESH_DECIMATE_H

#include "ms_mesh.h"

MS_C_BEGIN

/**
 * A mesh of at most so many triangles: vertices in one cell of a lattice become that of them nearest to their mean, so
 * that all that are left lie on the mesh; the cells grow until the triangles are few enough. It need not be closed.
 *
 * @param[out] out freed by ms_mesh_free; empty on failure
 * @return MS_OK; MS_ERR_NOMEM
 *
 * Source: Rossignac & Borrel, in Modeling in Computer Graphics, Springer 1993, 455. Cost: O(vertices log vertices), a
 * few times.
 */
MS_API ms_status ms_mesh_decimate(ms_mesh *out, const ms_mesh *mesh, size_t most_triangles, ms_error *err);

MS_C_END

#endif
