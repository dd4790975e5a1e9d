/** What of a sphere's surface others cover. Private to variational. */
#ifndef MS_CAPS_H
#define MS_CAPS_H

#include <stdint.h>

#include "voxel/ms_raster.h"

/** The left end of a sphere along x. */
typedef struct ms_caps_end {
    double left;
    uint32_t ball;
} ms_caps_end;

/** Spheres in the order of their left ends along x, so that those near one are found in a window as
 * wide as the widest. The few that are much larger than the mean stand apart: they would make all
 * windows wide. */
typedef struct ms_caps_window {
    size_t count;
    ms_ball *ball;    /* those that are fitted, and behind them their images: the caller's to fill in */
    ms_caps_end *end; /* in order, and behind them the large ones */
    double *at[4];    /* their centres and radii */
    size_t n_small;   /* in order */
    double widest;    /* diameter of those */
} ms_caps_window;

/** The parts of a sphere's surface that others cover: u.axis > least for the normals u there. Blocks of them are
 * compared at once. */
enum { MS_CAPS_BLOCK = 8 };
typedef struct ms_caps {
    float axis[3][MS_CAPS_BLOCK]; /* to the other centres, in radii */
    float least[MS_CAPS_BLOCK];
    float length[MS_CAPS_BLOCK]; /* of the axis; 0: there is no cap, or one of all or nothing */
    float root[MS_CAPS_BLOCK];   /* of length^2 - least^2: length times the sine of the cap's angle */
} ms_caps;

/** The caps of one sphere. */
typedef struct ms_caps_list {
    ms_caps *near;  /* of all that overlap it, in the spheres' frame */
    size_t nears;   /* blocks */
    ms_caps *block; /* those that lie in no other, about the largest first, in the lattice's frame */
    size_t blocks;
    uint32_t *which, *order; /* of `near`: places in the window; those of the largest caps first */
    uint8_t *size;           /* its class */
} ms_caps_list;

/**
 * Room for a window of `count` balls, which the caller fills in.
 *
 * @param[out] out the caller frees it; empty on failure
 * @return nonzero; 0 without memory
 */
int ms_caps_window_alloc(ms_caps_window *out, size_t count);
void ms_caps_window_free(ms_caps_window *s);

/** The same for the caps of one sphere among `count`. */
int ms_caps_list_alloc(ms_caps_list *out, size_t count);
void ms_caps_list_free(ms_caps_list *list);

/** Puts the first `count` balls in order. */
void ms_caps_sort(ms_caps_window *s);

/**
 * What other spheres cover of one's surface. Of many that overlap it few caps lie in no other.
 *
 * @param turn its columns are the axes of the lattice's frame
 *
 * Cost: spheres in its window, and those that overlap it times those whose caps are left.
 */
void ms_caps_find(ms_caps_list *out, const ms_caps_window *s, uint32_t self, const double turn[3][3]);

/** Is the place with this normal covered? The block that covers it is tried first next time. */
static inline int ms_caps_cover(size_t *first, const ms_caps *block, size_t blocks, const float normal[3])
{
    for (size_t b = 0; b < blocks; b++) {
        const size_t at = b == 0 ? *first : b <= *first ? b - 1 : b;
        const ms_caps *c = &block[at];
        int covered = 0;
#pragma omp simd reduction(| : covered)
        for (int i = 0; i < MS_CAPS_BLOCK; i++) {
            covered |= c->axis[0][i] * normal[0] + c->axis[1][i] * normal[1] + c->axis[2][i] * normal[2] > c->least[i];
        }
        if (covered) {
            *first = at;
            return 1;
        }
    }
    return 0;
}

/**
 * Which caps matter for the normals within an angle of a centre.
 *
 * @param[out] out    those that reach there, packed; room for `blocks`
 * @param      cosine of the angle, and its sine
 * @return how many blocks; -1: one cap covers them all (if in doubt, it does not)
 */
int ms_caps_narrow(ms_caps *out, const ms_caps *block, size_t blocks, const float centre[3], float cosine, float sine);

#endif
