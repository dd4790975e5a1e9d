/** Where two particles meet: drawn at random, or face on face. */
#ifndef MS_PLACE_H
#define MS_PLACE_H

#include <gsl/gsl_rng.h>

#include "ms_poses.h"
#include "ms_touch.h"

/** A direction and a turn, all alike; the second body is led at the centre of the first. */
ms_touch_place ms_place_anywhere(gsl_rng *random);

/**
 * The second body lies with its face `other` on the face `one` of the first.
 *
 * @param one, other what of each body points to the other, in the body's frame
 * @param yaw        angle by which the second is turned about their common normal, radians
 */
ms_touch_place ms_place_faces(const double one[3], const double other[3], double yaw);

/** One of the poses, as often as directions roll into it. */
const ms_pose *ms_place_pose(const ms_pose *pose, size_t count, gsl_rng *random);

#endif
