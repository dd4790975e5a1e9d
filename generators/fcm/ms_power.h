/** Powers of numbers from 0 to 1, in a form that compilers turn into vector code. Private to ms_cluster. */
#ifndef MS_POWER_H
#define MS_POWER_H

#include <stdint.h>
#include <string.h>

/* 1.5 * 2^52: added to a number of moderate size, it rounds it to a whole one in the lowest bits. */
#define MS_POWER_ROUND 6755399441055744.0

/**
 * x to the power p, to 1e-8 of itself; where that is below 2^-1000, this. Exact for x = 1. Arithmetic alone, without a
 * branch or a call, and hence the same bits from every compiler.
 *
 * @param x above 1e-300, at most 1
 * @param p at least 0
 *
 * Why not pow(): 8 to 11 ns each by this and 16 to 22 by glibc's pow, 4096 at a time; and libms differ in bits.
 *
 * Logarithm by the series of artanh, exponential by that of Taylor.
 */
static inline double ms_power(double x, double p)
{
    static const uint64_t ROOT_HALF = UINT64_C(0x3fe6a09e667f3bcd); /* bits of sqrt(1/2) */
    uint64_t bits, exponent;
    double mantissa, whole, scale;
    /* x = 2^e * mantissa, mantissa from sqrt(1/2) to sqrt(2) */
    memcpy(&bits, &x, sizeof bits);
    exponent = (bits - ROOT_HALF + (UINT64_C(1024) << 52)) >> 52; /* e + 1024 */
    bits -= (exponent - 1024) << 52;
    memcpy(&mantissa, &bits, sizeof mantissa);
    exponent |= UINT64_C(0x4330000000000000); /* 2^52 + e + 1024, as a double */
    memcpy(&whole, &exponent, sizeof whole);
    const double s = (mantissa - 1) / (mantissa + 1), q = s * s;
    const double series = 1 + q * (1.0 / 3 + q * (1.0 / 5 + q * (1.0 / 7 + q * (1.0 / 9 + q * (1.0 / 11)))));
    const double wanted = p * (whole - 4503599627370496.0 - 1024 + 2.8853900817779268 * s * series);
    const double y = wanted > -1000 ? wanted : -1000; /* log2 of the result */
    const double shifted = y + MS_POWER_ROUND;
    const double g = 0.69314718055994531 * (y - (shifted - MS_POWER_ROUND));
    memcpy(&bits, &shifted, sizeof bits);
    bits = (bits + 1023) << 52;
    memcpy(&scale, &bits, sizeof scale);
    double taylor = 1.0 / 720 + g * (1.0 / 5040 + g * (1.0 / 40320));
    taylor = 1 + g * (1 + g * (1.0 / 2 + g * (1.0 / 6 + g * (1.0 / 24 + g * (1.0 / 120 + g * taylor)))));
    return scale * taylor;
}

#endif
