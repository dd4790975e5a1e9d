/* A population of shapes: numbers found by hand, the interval by other means. */
#include "compare/ms_compare_population.h"
#include "compare/ms_compare_verdict.h"
#include "support/test_support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROWS_MAX = 32 };

/* Rows of a comparison, with the columns that count here. */
typedef struct lines {
    char *row[ROWS_MAX];
    size_t count;
} lines;

static void put(char *text, size_t room, double number)
{
    text[0] = '\0';
    if (!isnan(number)) {
        snprintf(text, room, "%.17g", number);
    }
}

/* @param asked NAN: a clump of another tool, of n spheres */
static void add_line(lines *l, const char *shape, const char *method, double asked, double n, double dice, double time)
{
    char field[MS_COLUMNS][32] = {{0}};
    char *line = calloc(MS_COLUMNS, 32);
    assert_non_null(line);
    snprintf(field[MS_COLUMN_SHAPE], 32, "%s", shape);
    snprintf(field[MS_COLUMN_GENERATOR], 32, "%s", method);
    snprintf(field[MS_COLUMN_OPTIONS], 32, "%s", isnan(asked) ? shape : ""); /* its file */
    put(field[MS_COLUMN_CELLS], 32, 20);
    put(field[MS_COLUMN_ASKED], 32, asked);
    put(field[MS_COLUMN_SPHERES], 32, n);
    put(field[MS_COLUMN_DICE], 32, dice);
    put(field[MS_COLUMN_GENERATE], 32, time);
    for (int c = 0; c < MS_COLUMNS; c++) {
        strcat(line, c ? "," : "");
        strcat(line, field[c]);
    }
    l->row[l->count++] = line;
}

static void make_population(ms_compare_population *p, ms_compare_records *all, lines *l)
{
    ms_error err;
    const ms_csv csv = {.n_rows = l->count, .row = l->row};
    assert_int_equal(ms_compare_records_cut(all, &csv, &err), MS_OK);
    assert_int_equal(ms_compare_population_make(p, all, "20", &err), MS_OK);
}

static void free_all(ms_compare_population *p, ms_compare_records *all, lines *l)
{
    ms_compare_population_free(p);
    ms_compare_records_free(all);
    while (l->count) {
        free(l->row[--l->count]);
    }
}

static void quartiles_are_those_by_hand(void **state)
{
    double five[] = {9, 1, 4, 2, 7}, four[] = {10, 40, 20, 30}, one[] = {2.385};
    (void)state;
    ms_compare_spread s = ms_compare_spread_of(five, 5);
    assert_int_equal(s.count, 5);
    assert_close(s.mean, 23. / 5, 1e-15);
    assert_close(s.lower, 2, 1e-15);
    assert_close(s.median, 4, 1e-15);
    assert_close(s.upper, 7, 1e-15);
    s = ms_compare_spread_of(four, 4); /* at 0.75, 1.5 and 2.25 from the least */
    assert_close(s.lower, 17.5, 1e-15);
    assert_close(s.median, 25, 1e-15);
    assert_close(s.upper, 32.5, 1e-15);
    s = ms_compare_spread_of(one, 1);
    assert_close(s.lower, 2.385, 1e-15);
    assert_close(s.upper, 2.385, 1e-15);
    s = ms_compare_spread_of(one, 0);
    assert_int_equal(s.count, 0);
    assert_true(isnan(s.mean) && isnan(s.median));
}

/* Of two values, each of k of n, the mean of a sample is binomial: its quantiles are sums of probabilities. */
static void the_interval_is_that_of_the_binomial(void **state)
{
    enum { N = 40, ONES = 10 };
    double value[N] = {0}, low, high, probability = pow(0.75, N), sum = 0, exact[2] = {-1, -1};
    ms_error err;
    (void)state;
    for (int i = 0; i < ONES; i++) {
        value[4 * i] = 1;
    }
    for (int k = 0; k <= N; k++) {
        sum += probability;
        exact[0] = exact[0] < 0 && sum >= 0.025 ? k / (double)N : exact[0];
        exact[1] = exact[1] < 0 && sum >= 0.975 ? k / (double)N : exact[1];
        probability *= (double)(N - k) / (k + 1) * (0.25 / 0.75);
    }
    assert_int_equal(ms_compare_spread_interval(&low, &high, value, N, &err), MS_OK);
    assert_true(fabs(low - exact[0]) <= 1.01 / N); /* one step: 1000 samples know 2.5 % to 0.5 % */
    assert_true(fabs(high - exact[1]) <= 1.01 / N);
    double again[2];
    assert_int_equal(ms_compare_spread_interval(&again[0], &again[1], value, N, &err), MS_OK);
    assert_true(again[0] == low && again[1] == high);
    assert_int_equal(ms_compare_spread_interval(&low, &high, value, MS_COMPARE_SPREAD_LEAST - 1, &err), MS_OK);
    assert_true(isnan(low) && isnan(high));
}

static void standings_are_those_by_hand(void **state)
{
    lines l = {.count = 0};
    ms_compare_population p;
    ms_compare_records all;
    ms_compare_standing s[2];
    ms_error err;
    (void)state;
    add_line(&l, "a", "x", 10, 10, 0.1, 4);
    add_line(&l, "a", "y", 10, 10, 0.2, 1);
    add_line(&l, "b", "x", 10, 10, 0.3, 4);
    add_line(&l, "b", "y", 10, 10, 0.3, 1); /* both are best */
    add_line(&l, "c", "x", 10, 10, 0.4, 4);
    add_line(&l, "c", "y", 10, 10, 0.1, 1);
    add_line(&l, "d", "x", 10, 10, 0.4, 4);
    add_line(&l, "d", "y", 10, 10, (double)NAN, (double)NAN); /* failed: x has no rival */
    make_population(&p, &all, &l);
    assert_int_equal(p.n_shapes, 4);
    assert_int_equal(ms_compare_population_judge(s, &p, 0, MS_COLUMN_DICE, &err), MS_OK);
    assert_int_equal(s[0].shapes, 3);
    assert_int_equal(s[0].best, 2);
    assert_int_equal(s[1].best, 2);
    assert_close(s[0].factor, cbrt(2. * 1 / 4), 1e-14);
    assert_close(s[1].factor, cbrt(4. * 1 / 2), 1e-14);
    assert_true(isnan(s[0].low) && isnan(s[0].high)); /* three shapes */
    assert_int_equal(ms_compare_population_judge(s, &p, 0, MS_COLUMN_GENERATE, &err), MS_OK);
    assert_int_equal(s[0].best, 0);
    assert_close(s[1].factor, 4, 1e-14);
    free_all(&p, &all, &l);
}

static void equal_factors_have_no_spread(void **state)
{
    static const char *const SHAPES[] = {"a", "b", "c", "d", "e", "f"};
    lines l = {.count = 0};
    ms_compare_population p;
    ms_compare_records all;
    ms_compare_standing s[2];
    ms_error err;
    (void)state;
    for (int k = 0; k < 6; k++) {
        add_line(&l, SHAPES[k], "x", 10, 10, 0.1 * (k + 1), 1);
        add_line(&l, SHAPES[k], "y", 10, 10, k ? 0.15 * (k + 1) : 0, 1); /* 0 counts as 1e-6 */
    }
    make_population(&p, &all, &l);
    assert_int_equal(ms_compare_population_judge(s, &p, 0, MS_COLUMN_DICE, &err), MS_OK);
    assert_close(s[0].factor, pow(pow(1.5, 5) * 1e-5, 1. / 6), 1e-12);
    assert_true(s[0].low < s[0].factor && s[0].factor < s[0].high && s[0].high <= 1.5 + 1e-12);
    assert_int_equal(ms_compare_population_judge(s, &p, 0, MS_COLUMN_GENERATE, &err), MS_OK);
    assert_int_equal(s[0].best, 6);
    assert_close(s[0].low, 1, 1e-15);
    assert_close(s[0].high, 1, 1e-15);
    free_all(&p, &all, &l);
}

/* Clumps stand where a method was asked for as many spheres, or the next larger number. */
static void clumps_stand_at_the_next_number(void **state)
{
    lines l = {.count = 0};
    double room[3];
    ms_compare_population p;
    ms_compare_records all;
    (void)state;
    for (int k = 0; k < 3; k++) {
        const char *shape = k == 0 ? "a" : k == 1 ? "b" : "c";
        static const double OF_CLUMP[] = {10, 11, 21};
        add_line(&l, shape, "x", 10, 10, 0.1, 2 + k);
        add_line(&l, shape, "x", 20, 18, 0.1, 7);
        add_line(&l, shape, "tool", (double)NAN, OF_CLUMP[k], 0.2 + k, (double)NAN);
    }
    make_population(&p, &all, &l);
    assert_int_equal(p.n_methods, 2);
    assert_int_equal(p.n_numbers, 2);
    assert_int_equal(p.left_out, 1);
    assert_close(ms_compare_population_value(&p, 0, 1, 0, MS_COLUMN_DICE), 0.2, 1e-15);
    assert_true(isnan(ms_compare_population_value(&p, 1, 1, 0, MS_COLUMN_DICE)));
    assert_close(ms_compare_population_value(&p, 1, 1, 1, MS_COLUMN_DICE), 1.2, 1e-15);
    assert_int_equal(ms_compare_population_spread(&p, 0, 1, MS_COLUMN_GENERATE, room).count, 0);
    assert_close(ms_compare_population_spread(&p, 1, 0, MS_COLUMN_SPHERES, room).mean, 18, 1e-15);
    assert_close(ms_compare_population_time(&p, room), 3, 1e-15); /* of 2, 3, 4 at the least number */
    free_all(&p, &all, &l);
}

static void expect_verdict(lines *l, const char *says)
{
    char text[1024] = {0};
    ms_compare_records all;
    ms_error err;
    const ms_csv csv = {.n_rows = l->count, .row = l->row};
    FILE *stream = fmemopen(text, sizeof text, "w");
    assert_non_null(stream);
    assert_int_equal(ms_compare_records_cut(&all, &csv, &err), MS_OK);
    assert_int_equal(ms_compare_verdict_say(stream, &all, &err), MS_OK);
    fclose(stream);
    ms_compare_records_free(&all);
    while (l->count) {
        free(l->row[--l->count]);
    }
    if (!strstr(text, says)) {
        fail_msg("'%s' should hold '%s'", text, says);
    }
}

/* Nine shapes: x wins on `wins` of them by 1 part in 1000, and on the others has `worse` times the D of y. */
static void add_contest(lines *l, int wins, double worse)
{
    char shape[] = "a";
    for (int k = 0; k < 9; k++, shape[0]++) {
        add_line(l, shape, "x", 10, 10, k < wins ? 0.1 : 0.1 * worse, (double)NAN);
        add_line(l, shape, "y", 10, 10, k < wins ? 0.1001 : 0.1, (double)NAN);
    }
}

static void the_verdict_does_not_mislead(void **state)
{
    lines l = {.count = 0};
    (void)state;
    add_contest(&l, 5, 5); /* of 9 drawn none is lost in 0.5 % of the samples: (5/9)^9, so the interval lies below 1 */
    expect_verdict(&l,
                   "x has the least D on 5 of 9 shapes, but loses by more than it wins; the best of the others has ");
    add_contest(&l, 8, 5);
    expect_verdict(&l, "on 8 of 9 shapes; the best of the others has 0.837 times its D on average (95 %: ");
    add_contest(&l, 8, 5);
    expect_verdict(&l, "): by this not to be told apart");
    add_contest(&l, 9, 1);
    expect_verdict(&l, "on 9 of 9 shapes; the best of the others has 1 times its D on average (95 %: 1 to 1)\n");
    add_contest(&l, 9, 1);
    add_line(&l, "z", "y", 10, 10, 0.1, (double)NAN);
    expect_verdict(&l, "x has the least D on 9 of 9 shapes (of 10; on the rest it or all others have none);");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quartiles_are_those_by_hand),     cmocka_unit_test(the_interval_is_that_of_the_binomial),
        cmocka_unit_test(standings_are_those_by_hand),     cmocka_unit_test(equal_factors_have_no_spread),
        cmocka_unit_test(clumps_stand_at_the_next_number), cmocka_unit_test(the_verdict_does_not_mislead),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
