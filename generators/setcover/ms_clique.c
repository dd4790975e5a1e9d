#include "ms_clique.h"

/* Sets of voxels of a neighbourhood; an octal digit is a row along x. */
static const uint32_t ALL = 0777777777, CENTRE = 0000020000, FACES = 0020252020, EDGES_AND_FACES = 0272757272;

/* By axis: the voxels at -1 and at +1, and how far the next one is. */
static const uint32_t LOW[3] = {0111111111, 0007007007, 0000000777};
static const uint32_t HIGH[3] = {0444444444, 0700700700, 0777000000};
static const int STRIDE[3] = {1, 3, 9};

static uint32_t shift_up(uint32_t set, int axis)
{
    return (set & ~HIGH[axis]) << STRIDE[axis];
}

static uint32_t shift_down(uint32_t set, int axis)
{
    return (set & ~LOW[axis]) >> STRIDE[axis];
}

/* The set and what touches it, if only at a corner. */
static uint32_t grow_26(uint32_t set)
{
    for (int a = 0; a < 3; a++) {
        set |= shift_up(set, a) | shift_down(set, a);
    }
    return set;
}

/* The set and what shares a face with it. */
static uint32_t grow_6(uint32_t set)
{
    return set | shift_up(set, 0) | shift_down(set, 0) | shift_up(set, 1) | shift_down(set, 1) | shift_up(set, 2) |
           shift_down(set, 2);
}

static uint32_t find_lowest(uint32_t set)
{
    return set & -set;
}

int ms_clique_is_simple(uint32_t object)
{
    const uint32_t ground = ~object & EDGES_AND_FACES, exposed = ground & FACES, others = object & ALL & ~CENTRE;
    uint32_t piece, before;
    if (!exposed || !others) {
        return 0;
    }
    piece = find_lowest(exposed); /* theorem 1 (ii) */
    do {
        before = piece;
        piece = grow_6(piece) & ground;
    } while (piece != before);
    if (exposed & ~piece) {
        return 0;
    }
    piece = find_lowest(others); /* theorem 1 (i) */
    do {
        before = piece;
        piece = grow_26(piece) & others;
    } while (piece != before);
    return piece == others;
}

/* A pair is regular if the 16 voxels around it reduce to one. Squeezing its two layers into
 * one changes neither pieces nor holes of what surrounds it, and then a voxel in its place
 * would have to be simple. */
static int pair_is_critical(uint32_t object, int axis)
{
    const uint32_t layer = ALL & ~LOW[axis] & ~HIGH[axis];
    return !ms_clique_is_simple((object | shift_down(object, axis)) & layer);
}

/* Around an edge: the voxels above it are all neighbours of one another, and so are those
 * below; none above touches one below. */
static int edge_is_critical(uint32_t object, uint32_t around, int axis)
{
    return !(object & shift_up(around, axis)) == !(object & shift_down(around, axis));
}

/* A face (square, edge, corner) of the centre, by its direction from there. */
typedef signed char direction[3];

/* Of the squares only those with a voxel of higher index behind them. */
static const direction SQUARE[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
static const direction EDGE[] = {{0, -1, -1}, {0, 1, -1}, {0, -1, 1},  {0, 1, 1},  {-1, 0, -1}, {1, 0, -1},
                                 {-1, 0, 1},  {1, 0, 1},  {-1, -1, 0}, {1, -1, 0}, {-1, 1, 0},  {1, 1, 0}};
static const direction CORNER[] = {{-1, -1, -1}, {1, -1, -1}, {-1, 1, -1}, {1, 1, -1},
                                   {-1, -1, 1},  {1, -1, 1},  {-1, 1, 1},  {1, 1, 1}};
static const struct {
    const direction *face;
    int count;
} FACES_OF_RANK[] = {{CORNER, 8}, {EDGE, 12}, {SQUARE, 3}};

static int keeps_face(uint32_t object, uint32_t free, const direction d)
{
    uint32_t around = CENTRE;
    int along = 0, across = 0; /* an axis in the face, and one across it */
    for (int a = 0; a < 3; a++) {
        if (d[a] == 0) {
            along = a;
        } else {
            around |= d[a] > 0 ? shift_up(around, a) : shift_down(around, a);
            across = a;
        }
    }
    const uint32_t clique = object & around;
    if (find_lowest(clique) != CENTRE || (clique & ~free)) {
        return 0;
    }
    for (int a = 0; a < 3; a++) { /* else a face of higher dimension is common to all */
        if (d[a] != 0 && !(clique & (d[a] > 0 ? HIGH[a] : LOW[a]))) {
            return 0;
        }
    }
    switch ((d[0] == 0) + (d[1] == 0) + (d[2] == 0)) {
    case 2:
        return pair_is_critical(object, across);
    case 1:
        return edge_is_critical(object, around, along);
    default:
        return 1; /* nothing is next to all voxels around a corner */
    }
}

int ms_clique_keeps(uint32_t object, uint32_t free, int rank)
{
    if (!(free & ALL & ~(CENTRE - 1) & ~CENTRE)) {
        return 0; /* no voxel of higher index to form a clique with */
    }
    for (int f = 0; f < FACES_OF_RANK[rank].count; f++) {
        if (keeps_face(object, free, FACES_OF_RANK[rank].face[f])) {
            return 1;
        }
    }
    return 0;
}
