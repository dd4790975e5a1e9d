/** Triangle meshes: what one is, whether it bounds a body, and how it is mended. */
#ifndef MS_MESH_H
#define MS_MESH_H

#include <stddef.h>
#include <stdint.h>

#include "base/ms_error.h"

MS_C_BEGIN

/** Indexed triangles. A zeroed struct is an empty mesh. */
typedef struct ms_mesh {
    size_t n_vertices;
    size_t n_triangles;
    double (*vertex)[3];     /* n_vertices, in the file's unit of length */
    uint32_t (*triangle)[3]; /* n_triangles, counter-clockwise seen from outside */
} ms_mesh;

/** How far ms_mesh_mend goes. A zeroed struct: no further than ms_mesh_repair. */
typedef struct ms_mesh_mending {
    double
        weld; /* corners of open edges this near in each coordinate are one; part of the box's longest side; 0: none */
    size_t fill_holes;  /* holes of at most so many edges are filled; 0: none */
    double drop_bodies; /* pieces smaller than this part of the largest are dropped; 0: none */
} ms_mesh_mending;

/** What single precision leaves of a coordinate: the tolerance of `mskit`. */
#define MS_MESH_WELD 1e-7
/** The tolerances that are allowed beside 0. */
#define MS_MESH_LEAST_WELD 1e-13
#define MS_MESH_MOST_WELD 0.1

/** What ms_mesh_repair and ms_mesh_mend found and what they changed. */
typedef struct ms_mesh_report {
    size_t joined;             /* corners of open edges that became another nearby */
    size_t dropped_degenerate; /* triangles with two equal corners, and fins, removed */
    size_t dropped_duplicate;  /* triangles on the same three corners as another, removed */
    size_t flipped;            /* triangles whose winding was reversed */
    size_t filled;             /* holes that were filled */
    size_t dropped_bodies;     /* pieces that were too small */
    double dropped_volume;     /* that they held, those that were closed */
    size_t open_edges;         /* edges of one triangle */
    size_t nonmanifold_edges;  /* edges of more than two triangles */
    size_t odd_edges;          /* edges of an odd number of triangles: with any, the mesh bounds no body */
    size_t holes;              /* rings of such edges */
    size_t largest_hole;       /* edges of the longest */
    size_t shells;             /* pieces joined by edges; of four triangles at an edge two and two are */
    size_t cavities;           /* shells that lie inside an odd number of others */
    size_t bodies;             /* shells - cavities */
    int closed;                /* no odd edges, every shell could be oriented */
} ms_mesh_report;

/**
 * Arrays for that many vertices and triangles, their contents undefined.
 *
 * @param[out] mesh freed by ms_mesh_free; empty on failure
 * @return MS_OK; MS_ERR_ARG if a number is 0; MS_ERR_NOMEM
 */
MS_API ms_status ms_mesh_alloc(ms_mesh *mesh, size_t n_vertices, size_t n_triangles, ms_error *err);

/** Axis-aligned box: lo[3], hi[3] in the mesh's unit. The mesh is not empty. */
MS_API void ms_mesh_box(double lo[3], double hi[3], const ms_mesh *mesh);

/**
 * Drops what bounds nothing and, where the mesh is closed, winds every shell so that it
 * encloses matter: outer shells outward, cavities inward. An open mesh keeps its windings and
 * is reported, not refused: the caller decides.
 *
 * Dropped are triangles with two equal corners; of triangles on the same three corners, pairs
 * of opposite winding and all but one of the rest; fins, which hang by one edge on an edge of two
 * or more others; and vertices that no triangle uses. Of what is drawn from both sides one side
 * stays where a hole would be left, or where there is nothing else and it is closed. A collinear
 * triangle of three vertices that fills a gap is kept.
 *
 * A shell is a cavity if it lies inside an odd number of others. Shells that cut each other
 * do not lie inside each other.
 *
 * @param[in,out] mesh    vertices already welded (ms_mesh_read does); on failure it may have
 *                        lost triangles but is whole
 * @param[out]    report  what was found and done
 * @param[out]    err     message; may be NULL
 * @return MS_OK; MS_ERR_SHAPE if no triangle is left or a closed shell cannot be
 *         oriented (one-sided); MS_ERR_ARG for a corner that does not exist; MS_ERR_LIMIT
 *         over 2^32 / 3 triangles; MS_ERR_NOMEM
 *
 * Cost: O(triangles log triangles).
 */
MS_API ms_status ms_mesh_repair(ms_mesh *mesh, ms_mesh_report *report, ms_error *err);

/**
 * The same, and before: joins corners at seams, then fills holes, then drops what is too small.
 *
 * Joined are corners of open edges alone, so that a closed mesh stays as it is to the last bit; the nearest first, no
 * chains, and never the two ends of an edge (ms_mesh_weld.h). A hole is a ring of open edges; it is cut into triangles
 * as a polygon is, so that a flat one is filled exactly. A piece is a shell, a cavity too; its size is the volume that
 * it encloses, and if it is open that of its box.
 *
 * @return as ms_mesh_repair; MS_ERR_ARG for a `weld` that is neither 0 nor in its range or a share outside 0 to 1;
 *         MS_ERR_LIMIT also for a `weld` that is far too large or a hole that takes too long to fill
 *
 * Cost: as ms_mesh_repair; O(edges^2) for a concave hole.
 */
MS_API ms_status ms_mesh_mend(ms_mesh *mesh, ms_mesh_report *report, const ms_mesh_mending *how, ms_error *err);

/** Frees the arrays and empties the struct; NULL is allowed. */
MS_API void ms_mesh_free(ms_mesh *mesh);

MS_C_END

#endif
