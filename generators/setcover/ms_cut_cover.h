/** Greedy set cover of cut cells (ms_cut_cells.h): ms_cover with weights. Private to setcover. */
#ifndef MS_CUT_COVER_H
#define MS_CUT_COVER_H

#include <stddef.h>

#include "voxel/ms_cut_cells.h"

MS_C_BEGIN

/** Opaque: the cells not yet covered, and what each ball would cover of them. */
typedef struct ms_cut_cover ms_cut_cover;

/**
 * Starts with nothing covered.
 *
 * @param[out] out       freed by ms_cut_cover_free; NULL on failure
 * @param      cells     borrowed, as the candidates, until ms_cut_cover_free
 * @param      candidate `count` balls, in voxels
 * @param      connected nonzero: each ball overlaps one taken before
 * @return MS_OK; MS_ERR_NOMEM; MS_ERR_LIMIT for 2^31 candidates or more
 * Cost: a byte per cut cell and per voxel, some 25 per candidate.
 */
ms_status ms_cut_cover_build(ms_cut_cover **out, const ms_cut_cells *cells, const ms_ball *candidate, size_t count,
                             int connected, ms_error *err);

/**
 * Takes the candidate that covers the largest weight not yet covered: of equals the one of larger radius, then the
 * earlier one. Lazy, as ms_cover_next, on all cores, and exactly the greedy choice (Yuan 2019, algorithm 2).
 *
 * @return that weight; 0: no candidate covers any, and nothing was taken
 */
int64_t ms_cut_cover_next(size_t *which, ms_cut_cover *cover);

void ms_cut_cover_free(ms_cut_cover *cover);

MS_C_END

#endif
