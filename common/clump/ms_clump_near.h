/** Private: which spheres of a clump are near a place, for a search that looks at a few of many. */
#ifndef MS_CLUMP_NEAR_H
#define MS_CLUMP_NEAR_H

#include "mesh/ms_mesh.h"
#include "ms_clump.h"

/** A box in cells, as many along each axis, and of each the spheres that may be nearest to a place in it, by the
 * distance from their surface, which is negative within. */
typedef struct ms_clump_near {
    const ms_clump *clump; /* borrowed */
    double lo[3], side[3]; /* of the box, of a cell */
    double per_side[3];    /* 1 / side */
    size_t cells;          /* along an axis */
    struct ms_clump_near_cell *cell;
    struct ms_clump_near_list *list;
} ms_clump_near;

/**
 * @param[out] near  freed by ms_clump_near_free; empty on failure
 * @param      clump at least one sphere; borrowed
 * @param      mesh  the box is that of the clump and of this; NULL: of the clump
 * @return MS_OK; MS_ERR_NOMEM
 * Cost: O(n log n) for spheres that overlap few others; some kB for each; all cores.
 */
ms_status ms_clump_near_build(ms_clump_near *near, const ms_clump *clump, const ms_mesh *mesh, ms_error *err);

/** Distance from a place to the nearest sphere; 0 within one. Beyond the box all spheres are looked at. */
double ms_clump_near_distance(const ms_clump_near *near, const double place[3]);

/** Is a point of sphere s within another one? Of equal spheres the first counts as exposed. */
int ms_clump_near_hides(const ms_clump_near *near, const double point[3], size_t s);

void ms_clump_near_free(ms_clump_near *near);

#endif
