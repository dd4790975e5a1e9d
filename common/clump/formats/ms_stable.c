#include "ms_stable.h"

#include <math.h>

/* Damping ratio of one contact for e = 0.5: the greatest of the engines, that of YADE (LIGGGHTS, LAMMPS: 0.215). */
static const double DAMPING = 0.2553;

/* What a push at a point moves that point by, at most: the largest eigenvalue of 1/m + C^T J C; J is 1/I, C is p x.
 * The second term has the eigenvalue 0 along p; the others have the sum t and the product d. All over 1/m, whose square
 * need not be a number. */
static double yield_at(const double p[3], const ms_particle *particle)
{
    double j[3], t = 0, d = 0, square = 0;
    for (int k = 0; k < 3; k++) {
        j[k] = particle->mass / particle->inertia[k][k];
        square += p[k] * p[k];
    }
    for (int k = 0; k < 3; k++) {
        t += j[k] * (square - p[k] * p[k]);
        d += square * p[k] * p[k] * j[(k + 1) % 3] * j[(k + 2) % 3];
    }
    return (1 + (t + sqrt(fmax(t * t - 4 * d, 0))) / 2) / particle->mass;
}

/* The same at the point of a sphere that is farthest from the centre of mass. */
static double yield_of(const ms_sphere *sphere, double scale, const ms_particle *particle)
{
    const double *c = sphere->centre;
    const double off = sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
    double p[3] = {0, 0, scale * sphere->radius};
    for (int k = 0; off > 0 && k < 3; k++) {
        p[k] = scale * c[k] * (1 + sphere->radius / off);
    }
    return yield_at(p, particle);
}

/* The greatest at its ends along the axes: there a slim body is twisted. */
static double yield_of_ends(const ms_sphere *sphere, double scale, const ms_particle *particle)
{
    double most = 0;
    for (int end = 0; end < 6; end++) {
        double p[3];
        for (int k = 0; k < 3; k++) {
            p[k] = scale * (sphere->centre[k] + (k == end / 2 ? (end % 2 ? sphere->radius : -sphere->radius) : 0));
        }
        most = fmax(most, yield_at(p, particle));
    }
    return most;
}

/* @param square omega^2 on a plane @param drag sum of root(S) w */
static double largest_step(double square, double drag, double mass)
{
    const double z = sqrt(5.0 / 6 * mass) * DAMPING * drag / sqrt(square);
    return 2 / sqrt(sqrt(2) * square) * (sqrt(1 + z * z) - z);
}

void ms_stable_step(double *one, double *all, const ms_clump *clump, double scale, const ms_particle *particle,
                    const ms_stable_law *law)
{
    const double modulus = law->young / (1 - law->poisson * law->poisson); /* 2 E* */
    double square = 0, drag = 0;
    *one = HUGE_VAL;
    for (size_t i = 0; i < clump->n_spheres; i++) {
        const ms_sphere *sphere = &clump->sphere[i];
        const double stiffness = modulus * sqrt(scale * sphere->radius * law->overlap);
        const double yield = yield_of(sphere, scale, particle);
        const double most = fmax(yield, yield_of_ends(sphere, scale, particle));
        *one = fmin(*one, largest_step(stiffness * most, sqrt(stiffness) * most, particle->mass));
        square += stiffness * yield;
        drag += sqrt(stiffness) * yield;
    }
    *all = fmin(*one, largest_step(square, drag, particle->mass));
}
