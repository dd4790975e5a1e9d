/** The voxels that no sphere covers yet, as bits, and what a sphere would gain by covering them. Private to ms_mss. */
#ifndef MS_MSS_OPEN_H
#define MS_MSS_OPEN_H

#include "voxel/ms_raster.h"

typedef struct ms_mss_open {
    int n[3];
    size_t words;      /* of a row */
    uint64_t *inside;  /* voxels of the shape that are not covered */
    uint64_t *outside; /* voxels of the background that are not covered */
} ms_mss_open;

/** Nothing is covered. @param[out] open the caller frees it @return MS_OK; MS_ERR_NOMEM. A quarter byte a voxel */
ms_status ms_mss_open_init(ms_mss_open *open, const ms_grid *grid, ms_error *err);

/** Takes out the voxels that the balls of a raster from `first_new` on cover. Cost: the voxels of their boxes. */
void ms_mss_open_cover(ms_mss_open *open, const ms_raster *raster, size_t first_new);

/**
 * By how many voxels |S xor S~| falls if a ball is added: those inside less those outside that it covers first, by
 * their centres.
 * Cost: the rows of the ball, 64 voxels at a time.
 */
long ms_mss_open_gain(const ms_mss_open *open, const ms_ball *ball);

/**
 * Climbs from the ball's radius, in steps, as long as the gain rises; within lo and hi.
 * @return the gain
 */
long ms_mss_open_fit(ms_ball *ball, const ms_mss_open *open, double lo, double hi, double step);

void ms_mss_open_free(ms_mss_open *open);

/** The index of a row that a place belongs to: within lo and hi, cut towards 0. */
static inline int ms_mss_open_clamp(double value, int lo, int hi)
{
    return value < lo ? lo : value > hi ? hi : (int)value;
}

#endif
