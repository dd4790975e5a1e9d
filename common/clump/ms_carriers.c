#include "ms_carriers.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_vector.h"
#include "ms_carriers_search.h"

/* Depth and radius of a carrier / radius of the sphere around it. */
static const double DEPTH = 0.1, SIZE = 0.05;
static const double OVERLAPS = 5;

/* Carriers are looked for in as many spheres, the largest; and in more directions where these are few. */
enum { HOSTS = 150, FEW_HOSTS = 40 };

/* All errors that ms_density_solve calls 0. */
static int is_exact(const ms_density_report *r)
{
    return r->optimal && r->centre == 0 && r->epsilon == 0 && r->products == 0;
}

static double depth_in(const ms_sphere *host, double depth, double overlap)
{
    return depth > 0 ? depth : fmax(DEPTH * host->radius, OVERLAPS * overlap);
}

/* A candidate at d of the principal axes from the middle of its host. */
static ms_status add_candidate(ms_clump *all, const ms_sphere *host, const double d[3], double axis[3][3],
                               ms_error *err)
{
    ms_sphere carrier = {.radius = SIZE * host->radius};
    for (int k = 0; k < 3; k++) {
        carrier.centre[k] = host->centre[k] + d[0] * axis[0][k] + d[1] * axis[1][k] + d[2] * axis[2][k];
    }
    return ms_clump_add_carrier(all, &carrier, err);
}

/* Candidates in a sphere at most, where there are more than FEW_HOSTS. */
enum { OF_A_HOST = 27 };

/* The candidates in a sphere: in its middle, as far out as the depth lets them be, and half way; in the directions of
 * the outermost points of a cube's lattice of 2 fine + 1 a side. */
static ms_status add_candidates(ms_clump *all, const ms_sphere *host, double depth, int fine, double axis[3][3],
                                ms_error *err)
{
    const double arm = (1 - SIZE) * host->radius - depth;
    const int side = 2 * fine + 1;
    if (arm <= 0) {
        return MS_OK;
    }
    ms_status status = add_candidate(all, host, (const double[3]){0, 0, 0}, axis, err);
    for (int at = 0; at < side * side * side && status == MS_OK; at++) {
        const int i = at % side - fine, j = at / side % side - fine, k = at / side / side - fine;
        const double length = sqrt((double)(i * i + j * j + k * k));
        if (abs(i) < fine && abs(j) < fine && abs(k) < fine) {
            continue;
        }
        for (int part = 1; part <= fine && status == MS_OK; part++) {
            const double scale = arm * part / fine / length;
            status = add_candidate(all, host, (const double[3]){scale * i, scale * j, scale * k}, axis, err);
        }
    }
    return status;
}

typedef struct host_rank {
    double radius;
    size_t at;
} host_rank;

static int larger_first(const void *a, const void *b)
{
    const host_rank *p = a, *q = b;
    if (p->radius != q->radius) {
        return p->radius > q->radius ? -1 : 1;
    }
    return p->at < q->at ? -1 : 1;
}

/* The spheres, and behind them all candidates. */
static ms_status list_candidates(ms_clump *all, const ms_clump *clump, double depth, double overlap, double axis[3][3],
                                 ms_error *err)
{
    const size_t n = clump->n_spheres;
    const int most = MS_CLUMP_MAX_SPHERES - HOSTS * OF_A_HOST;
    if (n > (size_t)most) {
        return ms_fail(err, MS_ERR_LIMIT,
                       "carriers are looked for in up to %d spheres, and here are %zu; use fewer, or no carriers", most,
                       n);
    }
    host_rank *rank = malloc(n * sizeof *rank);
    ms_status status = rank ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory to sort %zu spheres", n);
    for (size_t s = 0; s < n && status == MS_OK; s++) {
        rank[s] = (host_rank){clump->sphere[s].radius, s};
        status = ms_clump_add(all, &clump->sphere[s], err);
    }
    if (status == MS_OK) {
        qsort(rank, n, sizeof *rank, larger_first);
    }
    for (size_t h = 0; h < n && h < HOSTS && status == MS_OK; h++) {
        const ms_sphere *host = &clump->sphere[rank[h].at];
        status = add_candidates(all, host, depth_in(host, depth, overlap), n <= FEW_HOSTS ? 2 : 1, axis, err);
    }
    free(rank);
    return status;
}

/* Carriers at that depth, found or not; those of the clump are set. @param[out] all_do as ms_carriers_search */
static ms_status find_at_depth(ms_clump *clump, int *found, int *all_do, const ms_particle *particle,
                               const ms_density_options *options, double depth, double overlap, ms_error *err)
{
    ms_clump all = {0};
    ms_mass_equations e = {0};
    size_t *pick = NULL, picked = 0;
    *found = *all_do = 0;
    ms_clump_drop_masses(clump);
    ms_status status = ms_mass_equations_make(&e, clump, particle, 0, err);
    if (status == MS_OK) {
        status = list_candidates(&all, clump, depth, overlap, e.axis, err);
    }
    ms_mass_equations_free(&e);
    if (status == MS_OK && all.n_carriers > 0) {
        status = ms_mass_equations_make(&e, &all, particle, 0, err);
        if (status == MS_OK) {
            status = ms_carriers_search(&pick, &picked, all_do, &e, clump->n_spheres, options, err);
        }
        ms_mass_equations_free(&e);
    }
    for (size_t c = 0; c < picked && status == MS_OK; c++) {
        status = ms_clump_add_carrier(clump, &all.sphere[pick[c]], err);
    }
    *found = status == MS_OK && picked > 0;
    free(pick);
    ms_clump_free(&all);
    return status;
}

/* The sphere around the carrier of the greatest mass. */
static size_t host_of_heaviest(const ms_clump *clump)
{
    const size_t n = clump->n_spheres;
    size_t heaviest = n, host = 0;
    double deepest = -HUGE_VAL;
    for (size_t c = n; c < ms_clump_count_masses(clump); c++) {
        heaviest = clump->mass[c] > clump->mass[heaviest] ? c : heaviest;
    }
    for (size_t s = 0; s < n; s++) {
        const double distance = sqrt(ms_squared_distance(clump->sphere[s].centre, clump->sphere[heaviest].centre));
        if (clump->sphere[s].radius - distance > deepest) {
            deepest = clump->sphere[s].radius - distance;
            host = s;
        }
    }
    return host;
}

/* Why there are none: at lesser depths there are some, or not. */
static ms_status explain(ms_clump *clump, const ms_density_report *alone, const ms_particle *particle,
                         const ms_density_options *options, double depth, ms_error *err)
{
    enum { HALVINGS = 5 };
    int found = 0, all_do, ever_do = 0;
    ms_density_report report;
    ms_status status = MS_OK;
    for (int k = 0; k < HALVINGS && !found && status == MS_OK; k++) {
        depth /= 2;
        status = find_at_depth(clump, &found, &all_do, particle, options, depth, 0, err);
        ever_do |= all_do;
    }
    if (status == MS_OK && found && (status = ms_density_solve(clump, &report, particle, options, err)) == MS_OK) {
        const size_t at = host_of_heaviest(clump);
        const ms_sphere *host = &clump->sphere[at];
        return ms_fail(
            err, MS_ERR_LIMIT,
            "no carriers so deep below the surface: the wall around sphere %zu at (%g, %g, %g), of radius %g, "
            "has no room for what they would have to carry; %g below the surface it has "
            "(carrier-depth)",
            at + 1, host->centre[0], host->centre[1], host->centre[2], host->radius, depth);
    }
    if (status != MS_OK) {
        return status;
    }
    if (ever_do) {
        return ms_fail(err, MS_ERR_LIMIT,
                       "no carriers were found that all have the least mass, %g of the particle's, though lighter ones "
                       "would do; a smaller least mass (least-mass), or more spheres, may help",
                       ms_density_least(options, clump->n_spheres + MS_MASS_EQUATIONS_COUNT));
    }
    if (alone->centre > MS_DENSITY_CENTRE_TOLERANCE) {
        return ms_fail(err, MS_ERR_LIMIT,
                       "no carriers do: the centre of mass is %.2g radii of gyration outside the hull of the spheres' "
                       "centres; more spheres may help",
                       alone->centre);
    }
    return ms_fail(err, MS_ERR_LIMIT,
                   "no carriers do, at any depth: within these %zu spheres no masses have the inertia of the particle; "
                   "more spheres, or fuller ones, may help",
                   clump->n_spheres);
}

/* Radius of the ball of the particle's volume, in the clump's unit. */
static double equal_ball_radius(const ms_particle *p)
{
    return cbrt(0.75 * p->mass / (acos(-1.0) * p->density)) / p->scale;
}

static ms_status add_carriers(ms_clump *clump, ms_density_report *report, const ms_particle *particle,
                              const ms_carriers_options *options, ms_error *err)
{
    const ms_density_report alone = *report;
    const double overlap = MS_CARRIERS_OVERLAP * equal_ball_radius(particle);
    int found, all_do;
    ms_status status = find_at_depth(clump, &found, &all_do, particle, &options->masses, options->depth, overlap, err);
    if (status == MS_OK && found) {
        status = ms_density_solve(clump, report, particle, &options->masses, err);
        found = is_exact(report);
    }
    if (status == MS_OK && !found) {
        double largest = 0;
        for (size_t s = 0; s < clump->n_spheres; s++) {
            largest = fmax(largest, clump->sphere[s].radius);
        }
        const ms_sphere host = {.radius = largest};
        status = explain(clump, &alone, particle, &options->masses, depth_in(&host, options->depth, overlap), err);
    }
    return status;
}

ms_status ms_carriers_solve(ms_clump *clump, ms_density_report *report, const ms_particle *particle,
                            const ms_carriers_options *options, ms_error *err)
{
    ms_clump_drop_masses(clump);
    memset(report, 0, sizeof *report);
    if (!(options->depth >= 0) || !isfinite(options->depth) || !(options->depth > 0 || particle->density > 0)) {
        return ms_fail(err, MS_ERR_ARG,
                       "the depth of carriers, %g, is not above 0, or it is to follow from a volume that is not known",
                       options->depth);
    }
    ms_status status = ms_density_solve(clump, report, particle, &options->masses, err);
    if (status == MS_OK && !is_exact(report)) {
        status = add_carriers(clump, report, particle, options, err);
    }
    if (status != MS_OK) {
        memset(report, 0, sizeof *report);
        ms_clump_drop_masses(clump);
    }
    return status;
}
