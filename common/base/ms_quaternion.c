#include "ms_quaternion.h"

#include <math.h>

#include "ms_vector.h"

void ms_quaternion_from_axes(double q[4], double axis[3][3])
{
    /* 4 w^2, 4 x^2, 4 y^2, 4 z^2 are each 1 + the diagonal with one of four choices of signs. */
    const double d[3] = {axis[0][0], axis[1][1], axis[2][2]};
    double four[4] = {1 + d[0] + d[1] + d[2], 1 + d[0] - d[1] - d[2], 1 - d[0] + d[1] - d[2], 1 - d[0] - d[1] + d[2]};
    int most = 0;
    for (int k = 1; k < 4; k++) {
        most = four[k] > four[most] ? k : most;
    }
    /* The matrix of the turn has the axes as its columns. */
    const double off[3] = {axis[1][2] - axis[2][1], axis[2][0] - axis[0][2], axis[0][1] - axis[1][0]};
    const double sum[3] = {axis[1][2] + axis[2][1], axis[2][0] + axis[0][2], axis[0][1] + axis[1][0]};
    const double all[4][4] = {{four[0], off[0], off[1], off[2]},
                              {off[0], four[1], sum[2], sum[1]},
                              {off[1], sum[2], four[2], sum[0]},
                              {off[2], sum[1], sum[0], four[3]}};
    double length = 0;
    for (int k = 0; k < 4; k++) {
        length += all[most][k] * all[most][k];
    }
    length = all[most][0] < 0 ? -sqrt(length) : sqrt(length);
    for (int k = 0; k < 4; k++) {
        q[k] = all[most][k] / length;
    }
}

/* v + 2 u x (u x v + w v), u the vector of the quaternion and w its first number, or minus it. */
static void turn_by(double out[3], const double u[3], double w, const double v[3])
{
    double once[3], twice[3];
    ms_cross(once, u, v);
    for (int k = 0; k < 3; k++) {
        once[k] += w * v[k];
    }
    ms_cross(twice, u, once);
    for (int k = 0; k < 3; k++) {
        out[k] = v[k] + 2 * twice[k];
    }
}

void ms_quaternion_turn(double out[3], const double q[4], const double point[3])
{
    turn_by(out, q + 1, q[0], point);
}

void ms_quaternion_turn_back(double out[3], const double q[4], const double point[3])
{
    turn_by(out, q + 1, -q[0], point);
}
