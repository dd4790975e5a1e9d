#include "ms_least_work_search.h"

#include <math.h>

/* D falls with the number of spheres as n^-1 on sheets, n^-2 along curves (docs/expected.md): n by D. */
static const double NUMBER_BY_DICE = 0.75;

/* The least radius is raised by this while that does, and by no less than that. */
static const double RAISE = 1.6, LEAST_RAISE = 1.04;

/* Runs that the first number of spheres may take. */
enum { MOST_NUMBERS = 5 };

/* The search as it goes. */
typedef struct work_search {
    ms_least_work_tries *tries;
    const ms_least_work_bounds *bounds;
    ms_least_work_run run;
    void *context;
} work_search;

static int has_room(const work_search *s)
{
    return s->tries->count < MS_LEAST_WORK_MOST_RUNS;
}

static double work_of(const work_search *s, double spheres, double radius)
{
    return spheres * pow(s->bounds->equivalent / radius, s->bounds->power);
}

static const ms_least_work_try *kept_of(const work_search *s)
{
    return &s->tries->row[s->tries->kept];
}

/* @param[out] row that of this run */
static ms_status try_one(const ms_least_work_try **row, work_search *s, double n, double radius, ms_error *err)
{
    ms_least_work_tries *t = s->tries;
    ms_least_work_try *own = &t->row[t->count];
    const double asked = fmax(1, fmin(ceil(n), (double)s->bounds->most));
    *own = (ms_least_work_try){.asked = (size_t)asked, .radius = fmax(radius, s->bounds->radius)};
    const ms_status status = s->run(s->context, own, t->count, err);
    own->work = own->spheres > 0 ? work_of(s, (double)own->spheres, own->least) : (double)NAN;
    if (own->spheres > 0 && own->dice <= s->bounds->dice && (t->kept < 0 || own->work < kept_of(s)->work)) {
        t->kept = t->count;
    }
    t->count++;
    *row = own;
    return status;
}

/* How many spheres would bring D to what is asked, from that of a run. */
static double scale_number(const work_search *s, const ms_least_work_try *row)
{
    const double ratio = row->spheres > 0 ? fmax(row->dice, 1e-9) / s->bounds->dice : 2;
    return (double)row->asked * fmax(0.25, fmin(pow(ratio, NUMBER_BY_DICE), 4));
}

/* From the expected number to the least that reaches D. */
static ms_status find_number(work_search *s, ms_error *err)
{
    const int exact = s->bounds->power == 0;
    double lo = 0, hi = HUGE_VAL, n = (double)s->bounds->first; /* lo does not reach it, hi does */
    while (has_room(s) && hi - lo > 1 && (exact || s->tries->count < MOST_NUMBERS || isinf(hi))) {
        const ms_least_work_try *row;
        const ms_status status = try_one(&row, s, n, 0, err);
        if (status != MS_OK) {
            return status;
        }
        const int reached = row->spheres > 0 && row->dice <= s->bounds->dice;
        *(reached ? &hi : &lo) = (double)(reached ? row->spheres : row->asked);
        if (lo >= (double)s->bounds->most || (!exact && hi <= 1.05 * lo) || (!reached && row->spheres < row->asked)) {
            break; /* of the last, more cannot be had */
        }
        n = isinf(hi) ? fmax(scale_number(s, row), 1.1 * lo + 1) : lo == 0 ? fmin(scale_number(s, row), 0.9 * hi) : 0;
        n = n > 0 ? ceil(n) : lo + floor((hi - lo) / 2);
        n = fmax(lo + 1, fmin(n, hi - 1));
    }
    return MS_OK;
}

/* The number that would bring D to what is asked, by what the last run gained over one of fewer spheres. */
static double extrapolate_number(const work_search *s, const ms_least_work_try *less, const ms_least_work_try *row)
{
    const double gain = log(less->dice / row->dice) / log((double)row->asked / (double)less->asked);
    return gain > 0 ? (double)row->asked * pow(row->dice / s->bounds->dice, 1 / gain) : HUGE_VAL;
}

/* Spheres of a radius and more, and as many as they take while that would be less work. */
static ms_status try_radius(work_search *s, double radius, ms_error *err)
{
    const ms_least_work_try best = *kept_of(s), *less = NULL, *row;
    double n = (double)best.asked;
    ms_status status;
    do {
        status = try_one(&row, s, n, radius, err);
        n = fmax(n + 1, ceil(less ? extrapolate_number(s, less, row) : scale_number(s, row)));
        less = row;
    } while (status == MS_OK && kept_of(s)->work >= best.work && has_room(s) && row->spheres >= row->asked &&
             n <= (double)s->bounds->most && work_of(s, n, radius) < best.work);
    return status;
}

/* Larger ones, halving the way to a radius that was too large. */
static ms_status raise_radius(work_search *s, ms_error *err)
{
    double too_large = HUGE_VAL;
    ms_status status = MS_OK;
    while (has_room(s) && too_large > LEAST_RAISE * kept_of(s)->least && status == MS_OK) {
        const int before = s->tries->kept;
        const double least = kept_of(s)->least, radius = isinf(too_large) ? RAISE * least : sqrt(least * too_large);
        status = try_radius(s, radius, err);
        too_large = s->tries->kept == before ? radius : too_large;
    }
    return status;
}

static int was_tried(const work_search *s, size_t n, double radius)
{
    int found = 0;
    for (int k = 0; k < s->tries->count; k++) {
        found |= s->tries->row[k].asked == n && s->tries->row[k].radius == radius;
    }
    return found;
}

/* Fewer spheres of the same radii. */
static ms_status drop_spheres(work_search *s, ms_error *err)
{
    size_t step = kept_of(s)->spheres / 16 + 1;
    ms_status status = MS_OK;
    while (has_room(s) && step > 0 && status == MS_OK) {
        const ms_least_work_try *row;
        const int before = s->tries->kept;
        const size_t have = kept_of(s)->spheres;
        if (have > step && !was_tried(s, have - step, kept_of(s)->radius)) {
            status = try_one(&row, s, (double)(have - step), kept_of(s)->radius, err);
        }
        step = s->tries->kept == before ? step / 2 : step;
    }
    return status;
}

ms_status ms_least_work_search(ms_least_work_tries *tries, const ms_least_work_bounds *bounds, ms_least_work_run run,
                               void *context, ms_error *err)
{
    work_search s = {tries, bounds, run, context};
    *tries = (ms_least_work_tries){.kept = -1};
    ms_status status = find_number(&s, err);
    if (status == MS_OK && tries->kept >= 0 && bounds->power > 0) {
        status = raise_radius(&s, err);
        status = status == MS_OK ? drop_spheres(&s, err) : status;
    }
    return status;
}
