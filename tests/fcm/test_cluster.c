/* Fuzzy c-means and k-means against hand-made cases, the textbook's formulas and brute force; the search for
 * the nearest node against all nodes. */
#include "support/test_support.h"

#include <omp.h>

#include "fcm/ms_cluster.h"
#include "fcm/ms_power.h"
#include "shared/ms_nodes.h"

enum { MANY = 700, MOST = 12 };

static double uniform(double from, double to)
{
    return from + (to - from) * rand() / RAND_MAX;
}

static double normal(void)
{
    return sqrt(-2 * log(uniform(1e-9, 1))) * cos(2 * acos(-1.0) * uniform(0, 1));
}

static ms_cluster *build(const double (*point)[4], size_t count)
{
    ms_cluster *cluster;
    ms_error err;
    if (ms_cluster_build(&cluster, point, count, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
    return cluster;
}

static ms_cluster_result run(double (*centre)[4], size_t count, const ms_cluster *cluster, double m, size_t iterations)
{
    const ms_cluster_rule rule = {.fuzzifier = m, .tolerance = 1e-12, .iterations = iterations};
    ms_cluster_result result;
    ms_error err;
    if (ms_cluster_run(&result, centre, count, cluster, &rule, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
    return result;
}

static void start(double (*centre)[4], size_t count, const ms_cluster *cluster, uint64_t seed)
{
    assert_int_equal(ms_cluster_start(centre, 0, count, cluster, MS_CLUSTER_FAR, seed, NULL), MS_OK);
}

static double square_of(const double a[4], const double b[4])
{
    double sum = 0;
    for (int k = 0; k < 4; k++) {
        sum += (a[k] - b[k]) * (a[k] - b[k]);
    }
    return sum;
}

/* u of the textbook: 1 / sum_k (d_i / d_k)^(2 / (m - 1)); for m = 1 the nearest. */
static double textbook_u(const double point[4], const double (*centre)[4], size_t count, size_t i, double m)
{
    double sum = 0;
    const double here = square_of(point, centre[i]);
    for (size_t k = 0; k < count; k++) {
        const double there = square_of(point, centre[k]);
        if (m > 1) {
            sum += pow(here / there, 1 / (m - 1));
        } else if (there < here || (there == here && k < i)) {
            return 0;
        }
    }
    return m > 1 ? 1 / sum : 1;
}

/* One step of the textbook's: the objective, and the centres after it. */
static double textbook_step(double (*centre)[4], size_t count, const double (*point)[4], size_t points, double m)
{
    double before[MOST][4], objective = 0;
    memcpy(before, centre, count * sizeof *centre);
    for (size_t i = 0; i < count; i++) {
        double weight = 0, sum[4] = {0};
        for (size_t p = 0; p < points; p++) {
            const double u = pow(textbook_u(point[p], (const double(*)[4])before, count, i, m), m);
            objective += u * square_of(point[p], before[i]);
            weight += u;
            for (int k = 0; k < 4; k++) {
                sum[k] += u * point[p][k];
            }
        }
        for (int k = 0; k < 4; k++) {
            centre[i][k] = sum[k] / weight;
        }
    }
    return objective;
}

static void make_cloud(double (*point)[4], size_t count)
{
    for (size_t p = 0; p < count; p++) {
        for (int a = 0; a < 4; a++) {
            point[p][a] = uniform(0, a == 3 ? 7 : 20 + 9 * a);
        }
    }
}

static void a_step_is_the_textbooks(void **state)
{
    (void)state;
    static const double M[] = {1, 1.3, 1.5, 2, 2.385, 3, 7};
    static double point[MANY][4];
    srand(11);
    for (int round = 0; round < 42; round++) {
        const size_t points = 40 + (size_t)rand() % (MANY - 40), count = 1 + (size_t)rand() % MOST;
        double centre[MOST][4], expected[MOST][4];
        make_cloud(point, points);
        ms_cluster *cluster = build((const double(*)[4])point, points);
        start(centre, count, cluster, (uint64_t)round);
        for (size_t i = 0; i < count; i++) {
            centre[i][0] += 0.1; /* not on a point, where the textbook divides by 0 */
        }
        for (int t = 0; t < 3; t++) {
            memcpy(expected, centre, sizeof centre);
            const double objective = textbook_step(expected, count, (const double(*)[4])point, points, M[round % 7]);
            const ms_cluster_result result = run(centre, count, cluster, M[round % 7], 1);
            assert_close(result.objective, objective, 1e-7 * objective);
            for (size_t i = 0; i < count; i++) {
                assert_true(square_of(centre[i], expected[i]) < 1e-12);
            }
        }
        ms_cluster_free(cluster);
    }
}

static void memberships_sum_to_one(void **state)
{
    (void)state;
    static const double M[] = {1, 1.01, 1.5, 2, 3, 50};
    static double point[MANY][4], u[MANY * MOST];
    double centre[MOST][4];
    srand(12);
    make_cloud(point, MANY);
    ms_cluster *cluster = build((const double(*)[4])point, MANY);
    start(centre, MOST, cluster, 1); /* centres on points: the division by 0 */
    for (int m = 0; m < 6; m++) {
        assert_int_equal(ms_cluster_memberships(u, (const double(*)[4])centre, MOST, cluster, M[m], NULL), MS_OK);
        for (size_t p = 0; p < MANY; p++) {
            double sum = 0;
            int on_centre = 0;
            for (size_t i = 0; i < MOST; i++) {
                assert_true(u[p * MOST + i] >= 0 && u[p * MOST + i] <= 1 + 1e-7);
                on_centre |= square_of(point[p], centre[i]) == 0;
                sum += u[p * MOST + i];
            }
            assert_close(sum, 1, 1e-7);
            for (size_t i = 0; i < MOST && !on_centre; i++) {
                const double expected = textbook_u(point[p], (const double(*)[4])centre, MOST, i, M[m]);
                assert_close(u[p * MOST + i], expected, 1e-7);
            }
        }
    }
    ms_cluster_free(cluster);
}

/* Step by step, from random centres, some of which coincide or have nothing. */
static void the_objective_never_rises(void **state)
{
    (void)state;
    static const double M[] = {1, 1.05, 1.5, 2, 2.5, 3};
    static double point[MANY][4];
    srand(13);
    for (int round = 0; round < 24; round++) {
        double centre[MOST][4], before = HUGE_VAL;
        make_cloud(point, MANY);
        ms_cluster *cluster = build((const double(*)[4])point, MANY);
        for (size_t i = 0; i < MOST; i++) {
            memcpy(centre[i], i % 4 == 1 ? centre[i - 1] : point[i], sizeof centre[i]);
            centre[i][0] += i % 4 == 2 ? 1e4 : 0;
        }
        for (int t = 0; t < 60; t++) {
            const ms_cluster_result result = run(centre, MOST, cluster, M[round % 6], 1);
            assert_true(result.objective <= before * (1 + 1e-12));
            before = result.objective;
        }
        ms_cluster_free(cluster);
    }
}

/* Two clouds far apart: the centres are their means, whatever m. */
static void two_clouds_are_found(void **state)
{
    (void)state;
    static const double M[] = {1, 1.5, 2, 3};
    static double point[MANY][4];
    double mean[2][4] = {{0}};
    srand(14);
    for (size_t p = 0; p < MANY; p++) {
        for (int a = 0; a < 4; a++) {
            point[p][a] = normal() + (p % 2 && a < 2 ? 1000 : 0);
            mean[p % 2][a] += point[p][a] / (MANY / 2);
        }
    }
    ms_cluster *cluster = build((const double(*)[4])point, MANY);
    for (int m = 0; m < 4; m++) {
        for (uint64_t seed = 0; seed < 10; seed++) {
            double centre[2][4];
            start(centre, 2, cluster, seed);
            run(centre, 2, cluster, M[m], 1000);
            const int far = centre[0][0] > 500;
            for (int a = 0; a < 4; a++) { /* m = 3: the other cloud pulls with weights of 1e-9 or so, 1000 away */
                assert_close(centre[far][a], mean[0][a], M[m] < 3 ? 0.01 : 0.1);
                assert_close(centre[!far][a], mean[1][a], M[m] < 3 ? 0.01 : 0.1);
            }
        }
    }
    ms_cluster_free(cluster);
}

/* k evenly spread centres on a ring of points are equally far from its middle, and 360/k degrees apart. */
static void a_ring_is_shared(void **state)
{
    (void)state;
    static double point[720][4];
    double centre[3][4];
    for (int p = 0; p < 720; p++) {
        const double angle = p * acos(-1.0) / 360;
        const double at[4] = {10 * cos(angle), 10 * sin(angle), 5, 2.385};
        memcpy(point[p], at, sizeof at);
    }
    ms_cluster *cluster = build((const double(*)[4])point, 720);
    for (int m = 1; m <= 2; m++) {
        start(centre, 3, cluster, 4);
        run(centre, 3, cluster, m, 5000);
        for (int i = 0; i < 3; i++) {
            /* m = 1: the centroid of an arc of 120 degrees. */
            const double away = hypot(centre[i][0], centre[i][1]);
            if (m == 1) {
                assert_close(away, 10 * sin(acos(-1.0) / 3) / (acos(-1.0) / 3), 0.02);
            }
            assert_close(sqrt(square_of(centre[i], centre[(i + 1) % 3])), away * sqrt(3), 0.05);
            assert_close(centre[i][2], 5, 1e-9);
            assert_close(centre[i][3], 2.385, 1e-9);
        }
    }
    ms_cluster_free(cluster);
}

static void m_near_one_tends_to_kmeans(void **state)
{
    (void)state;
    static double point[MANY][4];
    double hard[6][4], soft[6][4], away[2] = {0};
    srand(15);
    for (size_t p = 0; p < MANY; p++) {
        for (int a = 0; a < 4; a++) {
            point[p][a] = normal() + (p % 6 == (size_t)a ? 7 : 0) - (p % 6 == 5 ? 4 : 0);
        }
    }
    ms_cluster *cluster = build((const double(*)[4])point, MANY);
    memcpy(hard, point, sizeof hard); /* one of each cloud */
    run(hard, 6, cluster, 1, 1000);
    for (int k = 0; k < 2; k++) {
        memcpy(soft, hard, sizeof hard);
        run(soft, 6, cluster, k ? 1.01 : 1.3, 1000);
        for (int i = 0; i < 6; i++) {
            away[k] = fmax(away[k], sqrt(square_of(soft[i], hard[i])));
        }
    }
    assert_true(away[0] < 0.05 && away[1] < 1e-6);
    ms_cluster_free(cluster);
}

/* Fewer different points than clusters: all are found, nothing is NAN, and the run ends. */
static void duplicates_are_found(void **state)
{
    (void)state;
    double point[90][4], centre[5][4];
    for (int p = 0; p < 90; p++) {
        const double at[4] = {p % 3 * 2.0, p % 3, -p % 3, 1};
        memcpy(point[p], at, sizeof at);
    }
    ms_cluster *cluster = build((const double(*)[4])point, 90);
    for (int m = 1; m <= 3; m++) {
        start(centre, 5, cluster, 1);
        const ms_cluster_result result = run(centre, 5, cluster, m, 1000);
        assert_true(result.iterations < 1000 && result.objective < 1e-12);
        for (int p = 0; p < 3; p++) {
            double nearest = HUGE_VAL;
            for (int i = 0; i < 5; i++) {
                nearest = fmin(nearest, square_of(point[p], centre[i]));
            }
            assert_true(nearest < 1e-12);
        }
    }
    ms_cluster_free(cluster);
}

/* Two centres on one cloud and none on the other: a centre without points moves there. */
static void empty_clusters_are_filled(void **state)
{
    (void)state;
    static double point[MANY][4];
    srand(16);
    for (size_t p = 0; p < MANY; p++) {
        for (int a = 0; a < 4; a++) {
            point[p][a] = normal() + (p % 2 ? 100 : 0);
        }
    }
    ms_cluster *cluster = build((const double(*)[4])point, MANY);
    for (int m = 1; m <= 2; m++) {
        double centre[2][4] = {{0}};
        if (m == 1) {
            centre[1][0] = 1e6; /* nobody's nearest */
        }
        const ms_cluster_result result = run(centre, 2, cluster, m, 1000);
        assert_true(fabs(centre[0][0] - centre[1][0]) > 90);
        assert_true(result.objective < 5.0 * MANY); /* four coordinates of variance 1 */
    }
    ms_cluster_free(cluster);
}

static void starts_are_spread(void **state)
{
    (void)state;
    static double point[MANY][4];
    double centre[MOST][4], kept[4] = {1, 2, 3, 4};
    for (size_t p = 0; p < MANY; p++) { /* ten places, one of them with most of the points */
        const double place = p < 9 ? 1 + (double)p : 0;
        const double at[4] = {100 * place, 0, 0, 0};
        memcpy(point[p], at, sizeof at);
    }
    ms_cluster *cluster = build((const double(*)[4])point, MANY);
    for (int spread = MS_CLUSTER_FAR; spread <= MS_CLUSTER_RANDOM; spread++) {
        memcpy(centre[0], kept, sizeof kept);
        assert_int_equal(ms_cluster_start(centre, 1, 11, cluster, (ms_cluster_spread)spread, 5, NULL), MS_OK);
        assert_memory_equal(centre[0], kept, sizeof kept);
        for (int place = 0; place < 10; place++) {
            int found = 0;
            for (int i = 1; i < 11; i++) {
                found += centre[i][0] == 100 * place;
            }
            assert_int_equal(found, 1);
        }
    }
    ms_cluster_free(cluster);
}

static void threads_do_not_matter(void **state)
{
    (void)state;
    static double point[MANY][4];
    const int before = omp_get_max_threads();
    srand(17);
    make_cloud(point, MANY);
    ms_cluster *cluster = build((const double(*)[4])point, MANY);
    for (int m = 1; m <= 3; m++) {
        double alone[MOST][4], team[MOST][4];
        omp_set_num_threads(1);
        start(alone, MOST, cluster, 3);
        run(alone, MOST, cluster, m, 50);
        for (int threads = 2; threads <= 7; threads++) {
            omp_set_num_threads(threads);
            start(team, MOST, cluster, 3);
            run(team, MOST, cluster, m, 50);
            assert_memory_equal(alone, team, sizeof alone);
        }
    }
    omp_set_num_threads(before);
    ms_cluster_free(cluster);
}

static void bad_arguments_are_refused(void **state)
{
    (void)state;
    double point[2][4] = {{1, 2, 3, 4}, {5, 6, 7, (double)NAN}};
    ms_cluster *cluster;
    ms_error err;
    assert_int_equal(ms_cluster_build(&cluster, (const double(*)[4])point, 0, &err), MS_ERR_ARG);
    assert_null(cluster);
    assert_int_equal(ms_cluster_build(&cluster, (const double(*)[4])point, 2, &err), MS_ERR_ARG);
    assert_non_null(strstr(err.text, "coordinate 4 of point 2"));
    cluster = build((const double(*)[4])point, 1);
    ms_cluster_rule rule = {.fuzzifier = 0.9, .iterations = 1};
    assert_int_equal(ms_cluster_run(NULL, point, 1, cluster, &rule, &err), MS_ERR_ARG);
    rule.fuzzifier = (double)NAN;
    assert_int_equal(ms_cluster_run(NULL, point, 1, cluster, &rule, &err), MS_ERR_ARG);
    rule.fuzzifier = 2;
    assert_int_equal(ms_cluster_run(NULL, point, 0, cluster, &rule, &err), MS_ERR_ARG);
    ms_cluster_free(cluster);
}

static void powers_are_those_of_the_library(void **state)
{
    (void)state;
    static const double P[] = {0, 0.01, 0.5, 1, 2, 3.7, 100};
    srand(18);
    for (int t = 0; t < 20000; t++) {
        const double x = t < 4 ? (const double[]){1, 0.70710678118654757, 0.70710678118654746, 1e-24}[t]
                               : exp(-uniform(0, 1) * (t % 3 ? 2 : 60));
        const double p = P[t % 7], expected = fmax(pow(x, p), 0x1p-1000);
        assert_close(ms_power(x, p) / expected, 1, 1e-8);
    }
    assert_true(ms_power(1, 2.385) == 1);
}

static void the_nearest_node_is_found(void **state)
{
    (void)state;
    static double at[900][3];
    srand(19);
    for (int round = 0; round < 60; round++) {
        const size_t count = 1 + (size_t)rand() % 900;
        ms_nodes nodes;
        for (size_t n = 0; n < count; n++) {
            for (int a = 0; a < 3; a++) { /* odd rounds: many equal coordinates */
                at[n][a] = round % 2 ? rand() % 4 : uniform(0, 10);
            }
        }
        assert_int_equal(ms_nodes_build(&nodes, (const double(*)[3])at, count, NULL), MS_OK);
        for (int t = 0; t < 100; t++) {
            const double place[3] = {uniform(-3, 13), uniform(-3, 13), uniform(-3, 13)};
            double least[2] = {HUGE_VAL, HUGE_VAL}, got;
            for (size_t n = 0; n < count; n++) {
                const double x = fabs(at[n][0] - place[0]), y = fabs(at[n][1] - place[1]);
                const double z = fabs(at[n][2] - place[2]);
                least[0] = fmin(least[0], sqrt(x * x + y * y + z * z));
                least[1] = fmin(least[1], x + y + z);
            }
            for (int norm = 0; norm < 2; norm++) {
                const size_t which = ms_nodes_nearest(&got, &nodes, place, (ms_norm)norm);
                assert_true(which < count);
                assert_close(got, least[norm], 1e-12);
            }
        }
        ms_nodes_free(&nodes);
    }
    ms_nodes none;
    assert_int_equal(ms_nodes_build(&none, (const double(*)[3])at, 0, NULL), MS_ERR_ARG);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_step_is_the_textbooks),   cmocka_unit_test(memberships_sum_to_one),
        cmocka_unit_test(the_objective_never_rises), cmocka_unit_test(two_clouds_are_found),
        cmocka_unit_test(a_ring_is_shared),          cmocka_unit_test(m_near_one_tends_to_kmeans),
        cmocka_unit_test(duplicates_are_found),      cmocka_unit_test(empty_clusters_are_filled),
        cmocka_unit_test(starts_are_spread),         cmocka_unit_test(threads_do_not_matter),
        cmocka_unit_test(bad_arguments_are_refused), cmocka_unit_test(powers_are_those_of_the_library),
        cmocka_unit_test(the_nearest_node_is_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
