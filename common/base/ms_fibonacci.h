/** Directions spread evenly over the sphere. Private. */
#ifndef MS_FIBONACCI_H
#define MS_FIBONACCI_H

#include <math.h>

/** One of `count` points of equal areas along a spiral, the Fibonacci lattice of the unit sphere. */
static inline void ms_fibonacci(double out[3], int which, int count)
{
    const double turn = 3.14159265358979323846 * (3 - sqrt(5.0)) * which;
    const double z = 1 - (2 * which + 1.0) / count, ring = sqrt(1 - z * z);
    out[0] = ring * cos(turn);
    out[1] = ring * sin(turn);
    out[2] = z;
}

#endif
