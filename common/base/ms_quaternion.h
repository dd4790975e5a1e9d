/** Turns as unit quaternions w, x, y, z. Private. */
#ifndef MS_QUATERNION_H
#define MS_QUATERNION_H

/**
 * The turn that carries the axes of a frame onto those of a body, from the body's coordinates to the frame's.
 *
 * @param[out] q    of length 1, w >= 0
 * @param      axis rows: the axes of the body in the frame, orthonormal and right-handed
 *
 * Source: Shepperd 1978, doi:10.2514/3.55767b: the largest of the four is found by a root, the others from it.
 */
void ms_quaternion_from_axes(double q[4], double axis[3][3]);

/** The point as the turn leaves it. */
void ms_quaternion_turn(double out[3], const double q[4], const double point[3]);

/** The same of the opposite turn. */
void ms_quaternion_turn_back(double out[3], const double q[4], const double point[3]);

#endif
