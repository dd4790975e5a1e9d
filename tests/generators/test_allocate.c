/* The allocation of spheres over a scene, against all allocations there are. */
#include "ms_allocate.h"
#include "support/test_support.h"

enum { SHAPES = 3, MOST = 7, SCENES = 300 };

typedef struct scene {
    size_t count;
    ms_share share[SHAPES];
    double error[SHAPES][MOST];
} scene;

static uint32_t draw(uint32_t *state, uint32_t below)
{
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 16) % below;
}

/* Curves that fall and now and then rise. In 1/4096, so that sums and differences of errors are exact. */
static void make_scene(scene *s, uint32_t seed)
{
    uint32_t state = seed;
    s->count = 1 + draw(&state, SHAPES);
    for (size_t i = 0; i < s->count; i++) {
        double error = 4096;
        s->share[i] = (ms_share){1 + draw(&state, 9), 1 + draw(&state, MOST), s->error[i]};
        for (size_t n = 0; n < MOST; n++) {
            s->error[i][n] = error / 4096;
            error = fmax(0, error - draw(&state, 1500) + (draw(&state, 4) == 0 ? 300 : 0));
        }
    }
}

/* Convex: each step takes away less than the one before. */
static void make_convex(scene *s, uint32_t seed, uint64_t particles)
{
    uint32_t state = seed;
    s->count = SHAPES;
    for (size_t i = 0; i < SHAPES; i++) {
        double error = 4000, fall = 1000;
        s->share[i] = (ms_share){particles, MOST, s->error[i]};
        for (size_t n = 0; n < MOST; n++) {
            s->error[i][n] = error / 4096;
            fall -= draw(&state, (uint32_t)fall / 2);
            error -= fall;
        }
    }
}

/* The next of all allocations; 0 behind the last. */
static int next_allocation(size_t *n, const scene *s)
{
    for (size_t i = 0; i < s->count; i++) {
        if (n[i] < s->share[i].most) {
            n[i]++;
            return 1;
        }
        n[i] = 1;
    }
    return 0;
}

/* The least mean error of all allocations within a budget. */
static double best_error(const scene *s, uint64_t budget)
{
    size_t n[SHAPES] = {1, 1, 1};
    double best = HUGE_VAL;
    do {
        const ms_allocation sum = ms_allocate_sum(s->share, n, s->count);
        best = sum.spheres <= budget ? fmin(best, sum.error) : best;
    } while (next_allocation(n, s));
    return best;
}

/* The fewest spheres of all allocations that reach a mean error. */
static double fewest_spheres(const scene *s, double error)
{
    size_t n[SHAPES] = {1, 1, 1};
    double fewest = HUGE_VAL;
    do {
        const ms_allocation sum = ms_allocate_sum(s->share, n, s->count);
        fewest = sum.error <= error ? fmin(fewest, (double)sum.spheres) : fewest;
    } while (next_allocation(n, s));
    return fewest;
}

static uint64_t particles_of(const scene *s)
{
    uint64_t particles = 0;
    for (size_t i = 0; i < s->count; i++) {
        particles += s->share[i].particles;
    }
    return particles;
}

static void expect_consistent(const ms_allocation *a, const size_t *n, const scene *s)
{
    const ms_allocation sum = ms_allocate_sum(s->share, n, s->count);
    assert_true(a->particles == particles_of(s) && a->spheres == sum.spheres && a->error == sum.error);
    for (size_t i = 0; i < s->count; i++) {
        assert_true(n[i] >= 1 && n[i] <= s->share[i].most);
    }
}

static void a_sum_is_weighted_by_particles(void **state)
{
    (void)state;
    const double coarse[] = {0.5, 0.25}, fine[] = {0.125};
    const ms_share share[] = {{3, 2, coarse}, {1, 1, fine}};
    const ms_allocation sum = ms_allocate_sum(share, (size_t[]){2, 1}, 2);
    assert_true(sum.particles == 4 && sum.spheres == 7);
    assert_close(sum.error, (3 * 0.25 + 0.125) / 4, 0);
}

static void budgets_are_spent_as_well_as_can_be(void **state)
{
    (void)state;
    size_t runs = 0;
    for (uint32_t seed = 1; seed <= SCENES; seed++) {
        scene s;
        make_scene(&s, seed);
        const uint64_t least = particles_of(&s);
        for (uint64_t budget = least; budget <= MOST * least; budget += 1 + least / 5) {
            size_t n[SHAPES];
            ms_allocation a;
            assert_int_equal(ms_allocate_budget(n, &a, s.share, s.count, budget, NULL), MS_OK);
            expect_consistent(&a, n, &s);
            assert_true(a.spheres <= budget && a.slack == 0);
            assert_close(a.error, best_error(&s, budget), 1e-11); /* better by less than 1e-12 of it is not sought */
            runs++;
        }
    }
    assert_true(runs > 2000);
}

/* A step of one sphere always fits: with convex curves the allocation is the best, and all of the budget is spent. */
static void convex_curves_of_equal_numbers_have_no_slack(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 50; seed++) {
        scene s;
        make_convex(&s, seed, 4);
        for (uint64_t budget = 12; budget <= 4 * SHAPES * MOST; budget += 4) {
            size_t n[SHAPES];
            ms_allocation a;
            assert_int_equal(ms_allocate_budget(n, &a, s.share, s.count, budget, NULL), MS_OK);
            assert_true(a.spheres == budget && a.slack == 0);
            assert_close(a.error, best_error(&s, budget), 1e-15);
        }
    }
}

static void an_error_takes_as_few_spheres_as_can_be(void **state)
{
    (void)state;
    size_t runs = 0;
    for (uint32_t seed = 1; seed <= SCENES; seed++) {
        scene s;
        make_scene(&s, seed);
        for (int level = 0; level <= 16; level++) {
            const double error = level / 16.0, fewest = fewest_spheres(&s, error);
            size_t n[SHAPES];
            ms_allocation a;
            ms_error err = {{0}};
            const ms_status status = ms_allocate_error(n, &a, s.share, s.count, error, &err);
            if (fewest == HUGE_VAL) {
                assert_int_equal(status, MS_ERR_LIMIT);
                assert_non_null(strstr(err.text, "allow more spheres"));
                continue;
            }
            assert_int_equal(status, MS_OK);
            expect_consistent(&a, n, &s);
            assert_true(a.error <= error + 1e-12 && (double)a.spheres == fewest && a.slack == 0);
            runs++;
        }
    }
    assert_true(runs > 1000);
}

/* A thousand shapes of large, different numbers: too many choices to try. What is left open is bounded, and small. */
static void a_search_that_is_too_long_is_given_up(void **state)
{
    (void)state;
    enum { MANY = 1000, LONG = 50 };
    static double error[MANY][LONG];
    static ms_share share[MANY];
    static size_t n[MANY];
    uint32_t seed = 5;
    uint64_t particles = 0;
    for (size_t i = 0; i < MANY; i++) {
        const uint32_t scale = 1 + draw(&seed, 60000);
        share[i] = (ms_share){1 + draw(&seed, 60000), LONG, error[i]};
        particles += share[i].particles;
        for (int k = 0; k < LONG; k++) {
            error[i][k] = scale / 120000.0 / (k + 1);
        }
    }
    ms_allocation a, b;
    assert_int_equal(ms_allocate_budget(n, &a, share, MANY, 10 * particles + 12345, NULL), MS_OK);
    assert_true(a.spheres <= 10 * particles + 12345 && (double)a.spheres > 9.99 * (double)particles);
    assert_true(a.slack > 0 && a.slack < 1e-4 * a.error);
    /* The other way round the same number of spheres must do, but for the slack of both. */
    assert_int_equal(ms_allocate_error(n, &b, share, MANY, a.error, NULL), MS_OK);
    assert_true((double)b.spheres <= (double)a.spheres + b.slack);
    assert_true(b.slack > 0 && b.slack < 1e-4 * (double)b.spheres);
}

static void the_gain_is_that_of_the_least_useful_spheres(void **state)
{
    (void)state;
    const double error[] = {1, 0.5, 0.375, 0.3125}, flat[] = {0.25, 0.25};
    const ms_share share[] = {{2, 4, error}, {1, 2, flat}};
    const struct {
        uint64_t budget;
        double gain;
        size_t n;
    } expected[] = {{3, 0, 1}, {4, 0, 1}, {5, 0.5, 2}, {7, 0.125, 3}, {9, 0.0625, 4}, {100, 0.0625, 4}};
    for (size_t e = 0; e < sizeof expected / sizeof *expected; e++) {
        size_t n[2];
        ms_allocation a;
        assert_int_equal(ms_allocate_budget(n, &a, share, 2, expected[e].budget, NULL), MS_OK);
        assert_close(ms_allocate_gain(share, n, 2), expected[e].gain, 0);
        assert_true(n[0] == expected[e].n && n[1] == 1); /* a sphere that takes nothing away is not spent */
    }
}

static void a_budget_below_one_sphere_each_is_refused(void **state)
{
    (void)state;
    const double error[] = {0.5};
    const ms_share share[] = {{1000000000, 1, error}, {3, 1, error}};
    size_t n[2];
    ms_allocation a;
    ms_error err = {{0}};
    assert_int_equal(ms_allocate_budget(n, &a, share, 2, 1000000002, &err), MS_ERR_LIMIT);
    assert_non_null(strstr(err.text, "1000000002 spheres"));
    assert_non_null(strstr(err.text, "1000000003 particles"));
    assert_int_equal(ms_allocate_budget(n, &a, share, 2, 1000000003, &err), MS_OK);
}

/* Of error 1/n: from n to n + 1 a part 1/(n + 1) of what is left, and less from there to any other. */
static void the_knee_of_a_hyperbola(void **state)
{
    (void)state;
    double error[100];
    for (int n = 1; n <= 100; n++) {
        error[n - 1] = 1.0 / n;
    }
    const ms_share share = {1, 100, error};
    assert_int_equal(ms_allocate_knee(&share, 0.6), 1);
    assert_int_equal(ms_allocate_knee(&share, 0.105), 9);
    assert_int_equal(ms_allocate_knee(&share, 0.0205), 48);
    assert_int_equal(ms_allocate_knee(&share, 0.009), 0);
}

/* A template that is worse than a smaller one is no knee; one without error is. */
static void knees_of_odd_curves(void **state)
{
    (void)state;
    const double bump[] = {0.5, 0.55, 0.25, 0.249}, none[] = {0.5, 0, 0}, one[] = {0.5};
    assert_int_equal(ms_allocate_knee(&(ms_share){1, 4, bump}, 0.1), 3);
    assert_int_equal(ms_allocate_knee(&(ms_share){1, 3, none}, 0.1), 2);
    assert_int_equal(ms_allocate_knee(&(ms_share){1, 1, one}, 0.1), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sum_is_weighted_by_particles),
        cmocka_unit_test(budgets_are_spent_as_well_as_can_be),
        cmocka_unit_test(convex_curves_of_equal_numbers_have_no_slack),
        cmocka_unit_test(an_error_takes_as_few_spheres_as_can_be),
        cmocka_unit_test(a_search_that_is_too_long_is_given_up),
        cmocka_unit_test(the_gain_is_that_of_the_least_useful_spheres),
        cmocka_unit_test(a_budget_below_one_sphere_each_is_refused),
        cmocka_unit_test(the_knee_of_a_hyperbola),
        cmocka_unit_test(knees_of_odd_curves),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
