/** Vectors of three doubles. Private. */
#ifndef MS_VECTOR_H
#define MS_VECTOR_H

/** Degrees of a radian. */
#define MS_VECTOR_DEGREES 57.295779513082321

static inline double ms_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void ms_cross(double out[3], const double a[3], const double b[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/** Twice the area of a triangle times its normal. */
static inline void ms_vector_triangle(double out[3], const double a[3], const double b[3], const double c[3])
{
    const double ab[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, ac[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    ms_cross(out, ab, ac);
}

static inline double ms_squared_distance(const double a[3], const double b[3])
{
    const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return x * x + y * y + z * z;
}

#endif
