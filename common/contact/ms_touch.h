/** Which spheres of a clump touch at once, how stiff and damped that makes the contact, and what rebounds. */
#ifndef MS_TOUCH_H
#define MS_TOUCH_H

#include "ms_contact.h"

/** A pair that touches. */
typedef struct ms_touch_pair {
    double normal[3];       /* from the first body to the second */
    double radius, overlap; /* R_i R_j / (R_i + R_j) */
} ms_touch_pair;

/**
 * A plane pressed against a body.
 *
 * @param u       where it lies, from the body, of length 1; what points down
 * @param r_eq    radius of the ball of the body's volume
 * @param overlap the largest, > 0, in the body's unit
 */
ms_touch ms_touch_plane(const ms_support *body, const double u[3], double r_eq, double overlap);

/** Where a second body is. */
typedef struct ms_touch_place {
    double turn[4];  /* a quaternion (base/ms_quaternion.h): from its frame to that of the first */
    double u[3];     /* from which it comes, of length 1, */
    double aside[3]; /* and by which its centre of mass passes that of the first */
} ms_touch_place;

/**
 * A second body of the same spheres, moved against the first along -u until the largest overlap is `overlap`.
 *
 * @param[out] pair  those that touch, at most `most` of them; may be NULL with 0
 * @param      turned room for the spheres of the second body
 * @return count is 0 where it passes the first without that much overlap
 * Cost: O(count^2) at worst; spheres that lie too deep to meet are passed over
 */
ms_touch ms_touch_second(ms_touch_pair *pair, size_t most, ms_sphere *turned, const ms_support *body,
                         const ms_touch_place *place, double r_eq, double overlap);

/**
 * Restitution of contacts side by side that are each damped for `single` on the whole mass: with b = -ln e / root(pi^2
 * + ln^2 e), the damping ratio of N contacts is b root(N), and e(N) = exp(-pi b root(N) / root(1 - N b^2)).
 *
 * @param single of one contact, above 0 and at most 1
 * @param n      contacts; of unequal ones ms_touch_number
 * @return 0 where it is overdamped, n b^2 >= 1
 */
double ms_touch_restitution(double single, double n);

/** The number of equal contacts that are as damped: damping^2 / stiffness. */
double ms_touch_number(const ms_touch *touch);

#endif
