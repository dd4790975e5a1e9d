/** Private to mesh repair: shells, their orientation and their nesting. */
#ifndef MS_MESH_ORIENT_H
#define MS_MESH_ORIENT_H

#include "ms_mesh_edges.h"

/**
 * Counts shells, cavities and bodies; if the mesh has no odd edge, winds every shell as its
 * nesting wants it.
 *
 * @param[in,out] report its edges are counted already
 * @return MS_OK; MS_ERR_SHAPE if a closed shell is one-sided; MS_ERR_NOMEM
 */
ms_status ms_mesh_orient(ms_mesh *mesh, const ms_edges *edges, ms_mesh_report *report, ms_error *err);

/**
 * Drops shells that are smaller than a share of the largest: a closed one by what it encloses, an open one by its box.
 *
 * @param[in,out] report its dropped_bodies and dropped_volume are added to
 * @param         edges  of the mesh as it comes
 * @return MS_OK; MS_ERR_NOMEM
 */
ms_status ms_mesh_orient_drop(ms_mesh *mesh, const ms_edges *edges, double share, ms_mesh_report *report,
                              ms_error *err);

/**
 * For each side the side across its edge, where a walk over the surface goes on. Two sides
 * of an edge point to each other. Of four, six, ... those do that have matter between them,
 * so that bodies which touch along an edge stay apart. An odd number point in a ring.
 *
 * @param[out] across      3 per triangle; the caller allocates
 * @param      inside_out  nonzero if the windings, taken together, enclose negative volume
 */
ms_status ms_mesh_link(uint32_t *across, const ms_mesh *mesh, const ms_edges *edges, int inside_out, ms_error *err);

/** A piece of the surface that is joined by its edges. */
typedef struct ms_shell {
    uint32_t first, n;   /* its triangles in ms_shells.order */
    double lo[3], hi[3]; /* box */
    double volume;       /* enclosed; signed by the winding until the shell is settled */
    size_t depth;        /* number of shells that it lies inside */
} ms_shell;

typedef struct ms_shells {
    size_t n;
    ms_shell *shell;
    uint32_t *order;    /* all triangles, shell by shell */
    uint32_t *shell_of; /* of each triangle */
} ms_shells;

/**
 * Sets the depth of every shell. A shell lies inside another if its box does and rays from
 * points spread over it cross the other an odd number of times, from every one of them: so
 * shells that cut each other do not count as nested.
 *
 * Cost: O(triangles log triangles) and a few rays per shell.
 */
ms_status ms_mesh_nest(ms_shells *shells, const ms_mesh *mesh, ms_error *err);

#endif
