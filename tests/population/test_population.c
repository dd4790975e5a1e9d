/* Populations: distances against brute force, weights of the linear programme, the choice of grains. */
#include "population/ms_population_choose.h"
#include "population/ms_population_distance.h"
#include "population/ms_population_split.h"
#include "population/ms_population_weights.h"
#include "support/test_support.h"

#include <math.h>
#include <stdlib.h>

#include "base/ms_random.h"
#include "clump/ms_linear_program.h"

enum { GRAINS = 60, DESCRIPTORS = 3 };

static double uniform(void)
{
    return rand() / (RAND_MAX + 1.0);
}

/* Correlated, some of them equal. */
static void fill_values(double *value, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        const double common = uniform();
        value[i * DESCRIPTORS] = floor(20 * (common + uniform())) / 20;
        value[i * DESCRIPTORS + 1] = common + 0.3 * uniform();
        value[i * DESCRIPTORS + 2] = uniform() - common;
    }
}

static void fill_shares(double *share, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        share[i] = 0.1 + uniform();
    }
}

/* A population of such values, each grain alike. */
static void make_grains(ms_population *p, unsigned seed)
{
    double value[GRAINS * DESCRIPTORS];
    ms_error err;
    srand(seed);
    fill_values(value, GRAINS);
    assert_int_equal(ms_population_make(p, value, NULL, GRAINS, DESCRIPTORS, &err), MS_OK);
}

static double distribution(const double *value, const double *share, size_t n, size_t d, double at)
{
    double of_less = 0, all = 0;
    for (size_t i = 0; i < n; i++) {
        of_less += value[i * DESCRIPTORS + d] <= at ? share[i] : 0;
        all += share[i];
    }
    return of_less / all;
}

/* The largest difference at any value of either. */
static double largest_difference(const double *a, const double *of_a, size_t n, const double *b, const double *of_b,
                                 size_t k, size_t d)
{
    double largest = 0;
    for (size_t i = 0; i < n + k; i++) {
        const double at = i < n ? a[i * DESCRIPTORS + d] : b[(i - n) * DESCRIPTORS + d];
        largest = fmax(largest, fabs(distribution(a, of_a, n, d, at) - distribution(b, of_b, k, d, at)));
    }
    return largest;
}

static void distances_are_those_of_brute_force(void **state)
{
    double value[GRAINS * DESCRIPTORS], share[GRAINS], sample[12 * DESCRIPTORS], weight[12];
    ms_error err;
    (void)state;
    srand(3);
    for (int trial = 0; trial < 20; trial++) {
        ms_population p;
        ms_population_distance distance;
        fill_values(value, GRAINS);
        fill_values(sample, 12);
        fill_shares(share, GRAINS);
        fill_shares(weight, 12);
        weight[5] = 0;
        assert_int_equal(ms_population_make(&p, value, share, GRAINS, DESCRIPTORS, &err), MS_OK);
        assert_int_equal(ms_population_distance_of(&distance, &p, sample, weight, 12, &err), MS_OK);
        double largest = 0;
        for (size_t d = 0; d < DESCRIPTORS; d++) {
            const double truth = largest_difference(value, share, GRAINS, sample, weight, 12, d);
            assert_close(distance.ks[d], truth, 1e-12);
            largest = fmax(largest, truth);
        }
        assert_close(distance.largest, largest, 1e-12);
        ms_population_free(&p);
    }
}

/* Of ranks 1 to 5 against 2 1 4 3 5: 1 - 6 sum d^2 / (n (n^2 - 1)) = 0.8; with a tie, Pearson of the mean ranks. */
static void correlations_are_spearmans(void **state)
{
    const double plain[] = {1, 20, 2, 10, 3, 40, 4, 30, 5, 50}, tied[] = {1, 1, 1, 2, 2, 3};
    ms_population p;
    ms_error err;
    (void)state;
    assert_int_equal(ms_population_make(&p, plain, NULL, 5, 2, &err), MS_OK);
    assert_close(p.correlation[0], 0.8, 1e-12);
    ms_population_free(&p);
    /* Ranks 1.5 1.5 3 and 1 2 3: covariance 1.5 / 3, variances 1.5 / 3 and 2 / 3. */
    assert_int_equal(ms_population_make(&p, tied, NULL, 3, 2, &err), MS_OK);
    assert_close(p.correlation[0], 1.5 / sqrt(1.5 * 2), 1e-12);
    ms_population_free(&p);
}

/* Two points against two in one dimension, by hand: X = 0, 2; Y = 0 with weight 1. E|X-Y| = 1, E|X-X'| = 1: 1, over the
 * standard deviation 1. */
static void energy_is_that_by_hand(void **state)
{
    const double value[] = {0, 2}, sample[] = {0}, weight[] = {3};
    double energy;
    ms_population p;
    ms_error err;
    (void)state;
    assert_int_equal(ms_population_make(&p, value, NULL, 2, 1, &err), MS_OK);
    assert_int_equal(ms_population_energy(&energy, &p, sample, weight, 1, &err), MS_OK);
    assert_close(energy, 1, 1e-12);
    assert_int_equal(ms_population_energy(&energy, &p, value, p.share, 2, &err), MS_OK);
    assert_close(energy, 0, 1e-12);
    ms_population_free(&p);
}

typedef struct programme {
    const ms_population *p;
    ms_population_weights *w;
    const size_t *chosen;
} programme;

static ms_status solve(void *context, ms_error *err)
{
    const programme *c = context;
    return ms_population_weights_solve(c->w, c->p, c->chosen) ? MS_OK : ms_fail(err, MS_ERR_LIMIT, "no end");
}

/* What the mismatch is of any weights, by the definition. */
static double mismatch_of(const ms_population *p, const size_t *chosen, const double *weight, size_t k)
{
    double sample[8 * DESCRIPTORS], largest = 0;
    ms_population_distance distance;
    ms_error err;
    for (size_t j = 0; j < k * DESCRIPTORS; j++) {
        sample[j] = p->value[chosen[j / DESCRIPTORS] * DESCRIPTORS + j % DESCRIPTORS];
    }
    assert_int_equal(ms_population_distance_of(&distance, p, sample, weight, k, &err), MS_OK);
    for (size_t pair = 0; pair < p->n_pairs; pair++) {
        double mean = 0;
        for (size_t j = 0; j < k; j++) {
            mean += weight[j] * p->product[chosen[j] * p->n_pairs + pair];
        }
        largest = fmax(largest, fabs(mean - p->correlation[pair]) / MS_POPULATION_CORRELATION_SCALE);
    }
    return fmax(largest, distance.largest);
}

/* Its mismatch is that of its weights, and no weights near them or anywhere have less. */
static void weights_are_the_best(void **state)
{
    double value[GRAINS * DESCRIPTORS], share[GRAINS], weight[8];
    ms_error err;
    (void)state;
    srand(5);
    for (int trial = 0; trial < 10; trial++) {
        ms_population p;
        ms_population_weights w;
        const size_t chosen[8] = {3, 11, 17, 20, 31, 44, 50, 58};
        fill_values(value, GRAINS);
        fill_shares(share, GRAINS);
        assert_int_equal(ms_population_make(&p, value, share, GRAINS, DESCRIPTORS, &err), MS_OK);
        assert_int_equal(ms_population_weights_init(&w, &p, 8, &err), MS_OK);
        assert_int_equal(ms_linear_program_apart(solve, &(programme){&p, &w, chosen}, &err), MS_OK);
        assert_close(w.mismatch, mismatch_of(&p, chosen, w.weight, 8), 1e-9);
        for (int other = 0; other < 200; other++) {
            double sum = 0;
            for (int j = 0; j < 8; j++) {
                weight[j] = other % 2 ? w.weight[j] * (0.9 + 0.2 * uniform()) : uniform();
                sum += weight[j];
            }
            for (int j = 0; j < 8; j++) {
                weight[j] /= sum;
            }
            assert_true(mismatch_of(&p, chosen, weight, 8) > w.mismatch - 1e-9);
        }
        ms_population_weights_free(&w);
        ms_population_free(&p);
    }
}

/* By one descriptor 3 of 9 grains are chosen as well as the best of all 84 sets. */
static void choice_is_the_best_of_few(void **state)
{
    double value[9];
    ms_error err;
    ms_population p;
    ms_population_weights w;
    ms_population_choice choice;
    double best = 1;
    (void)state;
    srand(8);
    for (int i = 0; i < 9; i++) {
        value[i] = uniform();
    }
    assert_int_equal(ms_population_make(&p, value, NULL, 9, 1, &err), MS_OK);
    assert_int_equal(ms_population_weights_init(&w, &p, 3, &err), MS_OK);
    for (size_t a = 0; a < 9; a++) {
        for (size_t b = a + 1; b < 9; b++) {
            for (size_t c = b + 1; c < 9; c++) {
                const size_t chosen[] = {a, b, c};
                assert_int_equal(ms_linear_program_apart(solve, &(programme){&p, &w, chosen}, &err), MS_OK);
                best = fmin(best, w.mismatch);
            }
        }
    }
    assert_int_equal(ms_population_choose(&choice, &p, 3, 1, 1, &err), MS_OK);
    assert_close(choice.mismatch, best, 1e-9);
    ms_population_choice_free(&choice);
    ms_population_weights_free(&w);
    ms_population_free(&p);
}

static double judged_mismatch(const ms_population *p, const ms_population_choice *choice)
{
    double sample[8 * DESCRIPTORS];
    ms_population_distance distance;
    ms_error err;
    for (size_t j = 0; j < choice->k * DESCRIPTORS; j++) {
        sample[j] = p->value[choice->grain[j / DESCRIPTORS] * DESCRIPTORS + j % DESCRIPTORS];
    }
    assert_int_equal(ms_population_distance_of(&distance, p, sample, choice->weight, choice->k, &err), MS_OK);
    return fmax(distance.largest, distance.correlation / 2);
}

/* Its weights are those of its grains; the same seed gives the same ones, and each is chosen once. */
static void choices_repeat(void **state)
{
    ms_error err;
    ms_population p;
    ms_population_choice first, second;
    (void)state;
    make_grains(&p, 2);
    assert_int_equal(ms_population_choose(&first, &p, 8, 0.05, 4, &err), MS_OK);
    assert_int_equal(ms_population_choose(&second, &p, 8, 0.05, 4, &err), MS_OK);
    assert_close(first.mismatch, judged_mismatch(&p, &first), 1e-12);
    for (size_t j = 0; j < 8; j++) {
        assert_int_equal(first.grain[j], second.grain[j]);
        assert_true(first.weight[j] == second.weight[j]);
        assert_true(j == 0 || first.grain[j] > first.grain[j - 1]);
    }
    ms_population_choice_free(&first);
    ms_population_choice_free(&second);
    ms_population_free(&p);
}

/* One, all, and grains that are all alike. */
static void extremes_are_chosen(void **state)
{
    double value[GRAINS * DESCRIPTORS];
    ms_error err;
    ms_population p;
    ms_population_choice choice;
    (void)state;
    make_grains(&p, 6);
    assert_int_equal(ms_population_choose(&choice, &p, 1, 0.1, 1, &err), MS_OK);
    assert_close(choice.weight[0], 1, 0);
    assert_close(choice.mismatch, judged_mismatch(&p, &choice), 1e-12);
    ms_population_choice_free(&choice);
    assert_int_equal(ms_population_choose(&choice, &p, GRAINS, 0.1, 1, &err), MS_OK);
    assert_close(choice.mismatch, 0, 1e-9);
    ms_population_choice_free(&choice);
    assert_int_equal(ms_population_choose(&choice, &p, GRAINS + 1, 1, 1, &err), MS_ERR_ARG);
    assert_int_equal(ms_population_choose(&choice, &p, 0, 1, 1, &err), MS_ERR_ARG);
    ms_population_free(&p);
    for (size_t i = 0; i < GRAINS * DESCRIPTORS; i++) {
        value[i] = 0.5;
    }
    assert_int_equal(ms_population_make(&p, value, NULL, GRAINS, DESCRIPTORS, &err), MS_OK);
    assert_int_equal(ms_population_choose(&choice, &p, 2, 0.1, 1, &err), MS_OK);
    assert_close(choice.mismatch, 0, 1e-9);
    ms_population_choice_free(&choice);
    ms_population_free(&p);
}

/* Samples of n from n grains lie about as far from them as theory says: E sup |F_n - F| = 0.8687 / sqrt(n) for large n
 * (mean of Kolmogorov's distribution). */
static void noise_is_kolmogorovs(void **state)
{
    enum { N = 400 };
    static double value[N];
    ms_error err;
    ms_population p;
    ms_population_distance noise;
    (void)state;
    for (size_t i = 0; i < N; i++) {
        value[i] = (double)i;
    }
    assert_int_equal(ms_population_make(&p, value, NULL, N, 1, &err), MS_OK);
    assert_int_equal(ms_population_noise(&noise, &p, 400, 1, &err), MS_OK);
    assert_close(noise.ks[0] * sqrt(N), 0.8687, 0.05);
    ms_population_free(&p);
}

/* Nearly all of a half stand for the other as well as the half itself; a half has no more than its grains. */
static void splits_judge_on_the_other_half(void **state)
{
    ms_error err;
    ms_population p;
    ms_population_split split;
    (void)state;
    make_grains(&p, 9);
    assert_int_equal(ms_population_split_of(&split, &p, GRAINS / 2, 4, 0.01, 1, &err), MS_OK);
    assert_close(split.choice, split.halves, 1e-9);
    assert_int_equal(ms_population_split_of(&split, &p, 3, 4, 0.02, 1, &err), MS_OK);
    assert_true(split.choice > split.halves && split.halves > 0);
    assert_int_equal(ms_population_split_of(&split, &p, GRAINS / 2 + 1, 4, 0.01, 1, &err), MS_ERR_ARG);
    ms_population_free(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(distances_are_those_of_brute_force),
        cmocka_unit_test(correlations_are_spearmans),
        cmocka_unit_test(energy_is_that_by_hand),
        cmocka_unit_test(weights_are_the_best),
        cmocka_unit_test(choice_is_the_best_of_few),
        cmocka_unit_test(choices_repeat),
        cmocka_unit_test(extremes_are_chosen),
        cmocka_unit_test(noise_is_kolmogorovs),
        cmocka_unit_test(splits_judge_on_the_other_half),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
