#include "ms_union.h"

#include <math.h>
#include <stdlib.h>

#include "base/ms_vector.h"

static const double PI = 3.14159265358979323846;

/* A circle nearer to the pole than this lies about it, in radii. */
static const double AT_POLE = 1e-12;

/* The part of a unit sphere that another sphere hides: the points n with n . axis > cosine. */
typedef struct cap {
    double axis[3];
    double cosine, sine; /* of its angular radius, which is within 0 and pi */
    size_t sphere;       /* that hides it */
} cap;

typedef struct range {
    double from, to;
} range;

/* A circle as n(t) = cosine axis + sine (cos t e1 + sin t e2), with e2 normal to the pole. */
typedef struct circle {
    const cap *of;
    double e1[3], e2[3];
    double
        ratio; /* of the cosines of half the sum and half the difference of its radius and its distance to the pole */
} circle;

/* Of the exposed part of a unit sphere: its area, and the integral of its normal. */
typedef struct patch {
    double area, normal[3];
} patch;

/* What a thread works with. */
typedef struct union_workspace {
    cap *caps;
    range *hidden;
} union_workspace;

/* Largest first; of equal ones that of the earlier sphere. */
static int compare_caps(const void *a, const void *b)
{
    const cap *p = a, *q = b;
    if (p->cosine != q->cosine) {
        return p->cosine < q->cosine ? -1 : 1;
    }
    return p->sphere < q->sphere ? -1 : p->sphere > q->sphere;
}

static int compare_ranges(const void *a, const void *b)
{
    const range *p = a, *q = b;
    return (p->from > q->from) - (p->from < q->from);
}

/* What sphere `by` hides of a sphere. @return -1 all of it; 0 nothing; 1 a cap */
static int make_cap(cap *out, const ms_clump *clump, size_t of, size_t by)
{
    const ms_sphere *sphere = &clump->sphere[of], *other = &clump->sphere[by];
    const double r = sphere->radius, q = other->radius, away = ms_squared_distance(sphere->centre, other->centre);
    if (away > (r + q) * (r + q) * (1 + 1e-12)) {
        return 0; /* most of them: without a root */
    }
    const double d = sqrt(away);
    if (d <= q - r) {
        return d < q - r || r < q || by < of ? -1 : 0; /* of equal spheres the first is exposed */
    }
    const double square = (q + (d - r)) * (q - (d - r)) * (d + r - q) * (d + r + q); /* (2 d r sine)^2, Heron */
    if (d >= r + q || d <= r - q || !(square > 0)) {
        return 0;
    }
    for (int a = 0; a < 3; a++) {
        out->axis[a] = (other->centre[a] - sphere->centre[a]) / d;
    }
    out->cosine = (d * d + (r - q) * (r + q)) / (2 * d * r);
    out->sine = sqrt(square) / (2 * d * r);
    out->sphere = by;
    return 1;
}

/* Is a cap within a larger one? Cosines tell it to 1e-8; what is dropped for that is as small. */
static int is_within(const cap *small, const cap *large)
{
    return ms_dot(small->axis, large->axis) >= small->cosine * large->cosine + small->sine * large->sine;
}

/* Those that lie in no other. @return 0 if nothing of the sphere is exposed */
static int find_caps(cap *caps, size_t *count, const ms_clump *clump, size_t s)
{
    size_t all = 0;
    *count = 0;
    for (size_t o = 0; o < clump->n_spheres; o++) {
        const int hides = o == s ? 0 : make_cap(&caps[all], clump, s, o);
        if (hides < 0) {
            return 0;
        }
        all += (size_t)hides;
    }
    qsort(caps, all, sizeof *caps, compare_caps);
    for (size_t c = 0; c < all; c++) {
        size_t larger = 0;
        while (larger < *count && !is_within(&caps[c], &caps[larger])) {
            larger++;
        }
        if (larger == *count) {
            caps[(*count)++] = caps[c];
        }
    }
    return 1;
}

/* The pole is where the surface potential is regular: opposite to the axis of the largest cap. */
static circle make_circle(const cap *of, const double pole[3])
{
    circle c = {.of = of};
    const double cosine = ms_dot(of->axis, pole);
    double away[3];
    for (int a = 0; a < 3; a++) {
        away[a] = pole[a] - cosine * of->axis[a];
    }
    const double sine = sqrt(ms_dot(away, away));
    if (sine < AT_POLE) { /* about the pole: any direction will do */
        const int least = fabs(of->axis[0]) < 0.6 ? 0 : 1;
        const double other[3] = {least == 0, least == 1, 0};
        ms_cross(away, of->axis, other);
    }
    const double length = sqrt(ms_dot(away, away));
    for (int a = 0; a < 3; a++) {
        c.e1[a] = away[a] / length;
    }
    ms_cross(c.e2, of->axis, c.e1);
    const double radius = atan2(of->sine, of->cosine), distance = atan2(sine, cosine);
    c.ratio = cos((radius + distance) / 2) / cos((radius - distance) / 2);
    return c;
}

/* Appends what a cap hides of a circle, within 0 and 2 pi. @return 0 if it hides all of it: neither cap lies within
 * the other, so that both together hide the whole sphere */
static int hide(range *hidden, size_t *count, const circle *c, const cap *by)
{
    const double x = ms_dot(c->e1, by->axis), y = ms_dot(c->e2, by->axis), along = ms_dot(c->of->axis, by->axis);
    const double level = by->cosine - c->of->cosine * along, sine = c->of->sine;
    if (level * level > sine * sine * (x * x + y * y) * (1 + 1e-12)) {
        return level > 0; /* for sure */
    }
    const double reach = sine * hypot(x, y);
    if (level >= reach || level <= -reach) {
        return level > 0;
    }
    const double half = acos(level / reach), middle = atan2(y, x), from = middle - half, to = middle + half;
    const double turn = 2 * PI;
    if (from < 0 && to > 0) {
        hidden[(*count)++] = (range){from + turn, turn};
        hidden[(*count)++] = (range){0, to};
    } else if (to > turn) {
        hidden[(*count)++] = (range){from, turn};
        hidden[(*count)++] = (range){0, to - turn};
    } else {
        hidden[(*count)++] = to <= 0 ? (range){from + turn, to + turn} : (range){from, to};
    }
    return 1;
}

/* Takes off what lies within the arc from a to b of the circle, by the boundary integrals along it. With heights z
 * above the plane through the centre normal to the pole, they are of (x dy - y dx) / (1 + z) and of n x dn / 2. */
static void take_arc(patch *sum, const circle *c, double a, double b)
{
    const double cosine = c->of->cosine, sine = c->of->sine;
    const double turn_a = atan2(c->ratio * sin(a / 2), cos(a / 2)), turn_b = atan2(c->ratio * sin(b / 2), cos(b / 2));
    sum->area -= 2 * (turn_b - turn_a) - cosine * (b - a);
    for (int m = 0; m < 3; m++) {
        sum->normal[m] -=
            sine / 2 *
            (sine * c->of->axis[m] * (b - a) - cosine * ((sin(b) - sin(a)) * c->e1[m] + (cos(a) - cos(b)) * c->e2[m]));
    }
}

/* @return 0 if nothing of the whole sphere is exposed */
static int take_circle(patch *sum, const union_workspace *w, size_t which, size_t count, const double pole[3])
{
    const circle c = make_circle(&w->caps[which], pole);
    size_t ranges = 0;
    for (size_t o = 0; o < count; o++) {
        if (o != which && !hide(w->hidden, &ranges, &c, &w->caps[o])) {
            return 0;
        }
    }
    qsort(w->hidden, ranges, sizeof *w->hidden, compare_ranges);
    double reached = 0;
    for (size_t h = 0; h < ranges; h++) {
        if (w->hidden[h].from > reached) {
            take_arc(sum, &c, reached, w->hidden[h].from);
        }
        reached = fmax(reached, w->hidden[h].to);
    }
    if (reached < 2 * PI) {
        take_arc(sum, &c, reached, 2 * PI);
    }
    return 1;
}

static patch measure_sphere(const union_workspace *w, const ms_clump *clump, size_t s)
{
    patch sum = {0};
    size_t count;
    if (!find_caps(w->caps, &count, clump, s)) {
        return sum;
    }
    if (count == 0) {
        sum.area = 4 * PI;
        return sum;
    }
    const double pole[3] = {-w->caps[0].axis[0], -w->caps[0].axis[1], -w->caps[0].axis[2]};
    for (size_t c = 0; c < count; c++) {
        if (!take_circle(&sum, w, c, count, pole)) {
            return (patch){0};
        }
    }
    return sum;
}

static ms_status measure_all(patch *patches, const ms_clump *clump, ms_error *err)
{
    int out_of_memory = 0;
#pragma omp parallel reduction(| : out_of_memory)
    {
        const union_workspace w = {malloc((clump->n_spheres + 1) * sizeof(cap)),
                                   malloc((2 * clump->n_spheres + 1) * sizeof(range))};
        out_of_memory = !w.caps || !w.hidden;
#pragma omp for schedule(dynamic, 1)
        for (size_t s = 0; s < clump->n_spheres; s++) {
            if (w.caps && w.hidden) {
                patches[s] = measure_sphere(&w, clump, s);
            }
        }
        free(w.caps);
        free(w.hidden);
    }
    return out_of_memory ? ms_fail(err, MS_ERR_NOMEM, "no memory to measure %zu spheres", clump->n_spheres) : MS_OK;
}

ms_status ms_union_measure(double *volume, double *area, const ms_clump *clump, ms_error *err)
{
    *volume = *area = 0;
    patch *patches = calloc(clump->n_spheres + 1, sizeof *patches);
    if (!patches) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory to measure %zu spheres", clump->n_spheres);
    }
    const ms_status status = measure_all(patches, clump, err);
    for (size_t s = 0; status == MS_OK && s < clump->n_spheres; s++) {
        const ms_sphere *sphere = &clump->sphere[s];
        const double r = sphere->radius;
        double from_first[3];
        for (int a = 0; a < 3; a++) {
            from_first[a] = sphere->centre[a] - clump->sphere[0].centre[a];
        }
        *area += r * r * patches[s].area;
        *volume += r * r * (r * patches[s].area + ms_dot(from_first, patches[s].normal)) / 3;
    }
    free(patches);
    return status;
}
