/** Do two balls overlap? Private to the methods. */
#ifndef MS_OVERLAP_H
#define MS_OVERLAP_H

#include "base/ms_sphere.h"
#include "base/ms_vector.h"

/** Nonzero if they do; 0 if they only touch. */
static inline int ms_overlap(const ms_ball *a, const ms_ball *b)
{
    const double reach = a->radius + b->radius;
    return ms_squared_distance(a->centre, b->centre) < reach * reach;
}

#endif
