/* Sieve curves: sizes of classes by closed forms, counts against all whole numbers there are. */
#include <unistd.h>

#include "ms_sieve.h"
#include "ms_sieve_counts.h"
#include "support/test_support.h"

enum { MOST = 4, DRAWS = 200 };

static uint64_t draw(uint32_t *state, uint32_t below)
{
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 16) % below;
}

/* The next of all ways to part `total` among n; 0 behind the last. The first is all in the last class. */
static int next_parting(uint64_t *count, size_t n)
{
    size_t c = n - 1;
    while (c > 0 && count[c] == 0) {
        c--;
    }
    if (c == 0) {
        return 0;
    }
    const uint64_t rest = count[c] - 1;
    count[c] = 0;
    count[c - 1]++;
    count[n - 1] = rest;
    return 1;
}

static double squares(const uint64_t *count, const double *share, const double *mass, size_t n, uint64_t total)
{
    double per_mass = 0, sum = 0;
    for (size_t c = 0; c < n; c++) {
        per_mass += share[c] / mass[c];
    }
    for (size_t c = 0; c < n; c++) {
        const double off = mass[c] * (double)count[c] - (double)total / per_mass * share[c];
        sum += off * off;
    }
    return sum;
}

static void test_round(void **state)
{
    uint32_t seed = 7;
    (void)state;
    for (int i = 0; i < DRAWS; i++) {
        uint64_t count[MOST], other[MOST] = {0}, sum = 0;
        double share[MOST], mass[MOST], best = HUGE_VAL;
        const size_t n = 1 + draw(&seed, MOST);
        const uint64_t total = 1 + draw(&seed, 20);
        for (size_t c = 0; c < n; c++) {
            share[c] = (1 + (double)draw(&seed, 100)) / 100;
            mass[c] = pow(1 + (double)draw(&seed, 30) / 10, 3);
        }
        ms_sieve_counts_round(count, share, mass, n, total);
        other[n - 1] = total;
        do {
            best = fmin(best, squares(other, share, mass, n, total));
        } while (next_parting(other, n));
        for (size_t c = 0; c < n; c++) {
            sum += count[c];
        }
        assert_int_equal(sum, total);
        assert_close(squares(count, share, mass, n, total), best, 1e-9 * (1 + best));
    }
}

/* Of a billion particles each class has its number to half a particle, but for what the smallest makes up. */
static void test_round_many(void **state)
{
    const double share[] = {0.2, 0.5, 0.3}, mass[] = {1, 8, 27};
    const uint64_t total = 1000000000;
    const double all = (double)total / (0.2 + 0.5 / 8 + 0.3 / 27);
    uint64_t count[3];
    (void)state;
    ms_sieve_counts_round(count, share, mass, 3, total);
    assert_int_equal(count[0] + count[1] + count[2], total);
    assert_close((double)count[0], all * share[0], 1.5);
    assert_close((double)count[1], all * share[1] / 8, 0.5);
    assert_close((double)count[2], all * share[2] / 27, 0.5);
}

/* Sum of squares of (taken - its share), times the square of what is left: a whole number. */
static uint64_t unevenness(const uint64_t *taken, const uint64_t *left, size_t n, uint64_t total, uint64_t all)
{
    uint64_t sum = 0;
    for (size_t c = 0; c < n; c++) {
        const int64_t off = (int64_t)(all * taken[c]) - (int64_t)(total * left[c]);
        sum += (uint64_t)(off * off);
    }
    return sum;
}

static void test_take(void **state)
{
    uint32_t seed = 11;
    (void)state;
    for (int i = 0; i < DRAWS; i++) {
        const size_t n = 1 + draw(&seed, MOST);
        uint64_t left[MOST], before[MOST], all = 0;
        for (size_t c = 0; c < n; c++) {
            all += left[c] = draw(&seed, 9);
        }
        while (all > 0) { /* row by row, until nothing is left */
            const uint64_t total = 1 + draw(&seed, (uint32_t)all);
            uint64_t taken[MOST], other[MOST] = {0}, best = UINT64_MAX, sum = 0;
            memcpy(before, left, sizeof left);
            ms_sieve_counts_take(taken, left, n, total);
            other[n - 1] = total;
            do {
                const uint64_t uneven = unevenness(other, before, n, total, all);
                best = uneven < best ? uneven : best;
            } while (next_parting(other, n));
            for (size_t c = 0; c < n; c++) {
                assert_true(taken[c] <= before[c]);
                assert_int_equal(left[c], before[c] - taken[c]);
                sum += taken[c];
            }
            assert_int_equal(sum, total);
            assert_int_equal(unevenness(taken, before, n, total, all), best);
            all -= total;
        }
    }
}

static ms_status read_text(ms_sieve *sieve, const char *text, size_t classes, ms_error *err)
{
    char path[] = "/tmp/test_sieve_XXXXXX";
    const int fd = mkstemp(path);
    assert_true(fd >= 0);
    assert_int_equal(write(fd, text, strlen(text)), strlen(text));
    close(fd);
    const ms_status status = ms_sieve_read(sieve, path, classes, err);
    unlink(path);
    return status;
}

/* Mass that is even in the logarithm of the size: the mean of size^-3 is (a^-3 - b^-3) / (3 ln(b / a)). */
static double mean_of(double a, double b)
{
    return (pow(a, -3) - pow(b, -3)) / (3 * log(b / a));
}

static void test_classes_of_rows(void **state)
{
    ms_sieve sieve;
    ms_error err;
    (void)state;
    assert_int_equal(
        read_text(&sieve, "# sand\nsize,passing\n0.063, 0\n0.25,0.4\n\n0.5 ,0.4\r\n1.385,1\n2,1\n", 0, &err), MS_OK);
    assert_int_equal(sieve.count, 2); /* nothing lies between 0.25 and 0.5, nothing above 1.385 */
    assert_close(pow(sieve.of[0].size, -3) / mean_of(0.063, 0.25), 1, 1e-13);
    assert_close(pow(sieve.of[1].size, -3) / mean_of(0.5, 1.385), 1, 1e-13);
    assert_close(sieve.of[0].share, 0.4, 0);
    assert_close(sieve.of[1].share, 0.6, 1e-15);
    ms_sieve_free(&sieve);
}

/* However it is cut, a unit of mass has the same number of particles; each class lies between its ends. */
static void test_classes_of_equal_mass(void **state)
{
    static const char TEXT[] = "size,passing\n0.1,0\n0.3,0.15\n0.9,0.8\n1.7,1\n";
    const double number = 0.15 * mean_of(0.1, 0.3) + 0.65 * mean_of(0.3, 0.9) + 0.2 * mean_of(0.9, 1.7);
    ms_error err;
    (void)state;
    for (size_t classes = 1; classes <= MS_SIEVE_MAX_CLASSES; classes++) {
        ms_sieve sieve;
        double sum = 0, before = 0.1;
        assert_int_equal(read_text(&sieve, TEXT, classes, &err), MS_OK);
        assert_int_equal(sieve.count, classes);
        for (size_t c = 0; c < classes; c++) {
            assert_close(sieve.of[c].share, 1.0 / (double)classes, 1e-15);
            assert_true(sieve.of[c].size > before && sieve.of[c].size < 1.7);
            before = sieve.of[c].size;
            sum += sieve.of[c].share * pow(before, -3);
        }
        assert_close(sum / number, 1, 1e-12);
        ms_sieve_free(&sieve);
    }
}

/* The least share and the least step of sizes there are. */
static void test_classes_of_next_to_nothing(void **state)
{
    ms_sieve sieve;
    ms_error err;
    (void)state;
    assert_int_equal(read_text(&sieve, "size,passing\n1,0\n2,5e-324\n3,1\n", 0, &err), MS_OK);
    assert_int_equal(sieve.count, 2);
    assert_close(pow(sieve.of[0].size, -3) / mean_of(1, 2), 1, 1e-13);
    assert_close(pow(sieve.of[1].size, -3) / mean_of(2, 3), 1, 1e-13);
    ms_sieve_free(&sieve);
    assert_int_equal(read_text(&sieve, "size,passing\n1.9999999999999996,0\n1.9999999999999998,1\n", 2, &err), MS_OK);
    for (int c = 0; c < 2; c++) {
        assert_close(sieve.of[c].size, 2, 1e-15);
    }
    ms_sieve_free(&sieve);
}

static void test_refused(void **state)
{
    static const char *const CASES[][2] = {
        {"", "empty"},
        {"size,share\n1,0\n", "line 1: the header is 'size,share', not size,passing"},
        {"size,passing,more\n1,0\n", "line 1: the header"},
        {"size,passing\n", "lets 0 of the mass pass"},
        {"size,passing\n1,0\n2,0.5\n", "lets 0.5 of the mass pass"},
        {"size,passing\n1,0\n\n2\n", "line 4: '2' is not a size and a share"},
        {"size,passing\n1,0,0\n", "line 2: '1,0,0'"},
        {"size,passing\n0,0\n", "line 2: the size '0'"},
        {"size,passing\nnan,0\n", "line 2: the size 'nan'"},
        {"size,passing\n1e60,0\n", "line 2: the size '1e60'"},
        {"size,passing\n1,0\n2,50\n3,100\n", "line 3: the share '50' is not a number from 0 to 1"},
        {"size,passing\n1,x\n", "line 2: the share 'x'"},
        {"size,passing\n1,0.1\n2,1\n", "line 2: 0.1 of the mass is finer"},
        {"size,passing\n1,0\n1,1\n", "line 3: size 1 with share 1 stands behind 1"},
        {"size,passing\n2,0\n1,1\n", "line 3: size 1"},
        {"size,passing\n1,0\n2,0.5\n3,0.4\n", "line 4: size 3 with share 0.4"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        ms_sieve sieve;
        ms_error err;
        assert_int_equal(read_text(&sieve, CASES[i][0], 0, &err), MS_ERR_FORMAT);
        assert_int_equal(sieve.count, 0);
        assert_null(sieve.of);
        if (!strstr(err.text, CASES[i][1])) {
            fail_msg("'%s' does not say '%s'", err.text, CASES[i][1]);
        }
    }
    ms_sieve none;
    ms_error err;
    assert_int_equal(ms_sieve_read(&none, "/none/such.csv", 0, &err), MS_ERR_IO);
    char *many = malloc(20000);
    size_t at = (size_t)sprintf(many, "size,passing\n");
    for (int r = 1; r <= MS_SIEVE_MAX_ROWS + 1; r++) {
        at += (size_t)sprintf(many + at, "%d,0\n", r);
    }
    assert_int_equal(read_text(&none, many, 0, &err), MS_ERR_FORMAT);
    assert_non_null(strstr(err.text, "line 1002: more than 1000 rows"));
    free(many);
}

/* Of the same rows the same classes; what is wrong is said by the row. */
static void test_curves_in_memory(void **state)
{
    static const double SIZE[] = {0.1, 0.3, 0.9, 1.7}, PASSING[] = {0, 0.15, 0.8, 1}, FALLING[] = {0, 0.15, 0.1, 1};
    ms_sieve read, made;
    ms_error err;
    (void)state;
    for (size_t classes = 0; classes < 9; classes++) {
        assert_int_equal(read_text(&read, "size,passing\n0.1,0\n0.3,0.15\n0.9,0.8\n1.7,1\n", classes, &err), MS_OK);
        assert_int_equal(ms_sieve_make(&made, SIZE, PASSING, 4, classes, &err), MS_OK);
        assert_int_equal(made.count, read.count);
        assert_memory_equal(made.of, read.of, read.count * sizeof *read.of);
        ms_sieve_free(&read);
        ms_sieve_free(&made);
    }
    assert_int_equal(ms_sieve_make(&made, SIZE, FALLING, 4, 0, &err), MS_ERR_FORMAT);
    assert_non_null(strstr(err.text, "row 2: size 0.9 with share 0.1 stands behind 0.3"));
    assert_int_equal(ms_sieve_make(&made, SIZE, PASSING, 0, 0, &err), MS_ERR_FORMAT);
    assert_non_null(strstr(err.text, "lets 0 of the mass pass"));
    assert_int_equal(ms_sieve_make(&made, FALLING, PASSING, 4, 0, &err), MS_ERR_FORMAT);
    assert_non_null(strstr(err.text, "row 0: the size '0' is not a number"));
    assert_int_equal(ms_sieve_make(&made, SIZE, PASSING, 4, MS_SIEVE_MAX_CLASSES + 1, &err), MS_ERR_ARG);
    assert_null(made.of);
}

/* Rows keep their numbers, and all together have those of the classes. */
static void test_apply(void **state)
{
    static const uint64_t PARTICLES[] = {300, 1, 40};
    ms_sieve sieve;
    char path[3][2] = {"a", "b", "c"};
    ms_manifest_row row[3];
    const ms_manifest rows = {row, 3};
    ms_manifest manifest;
    ms_error err;
    double mass[2] = {0};
    uint64_t of_class[2] = {0}, of_row[3] = {0};
    (void)state;
    for (size_t r = 0; r < 3; r++) {
        row[r] = (ms_manifest_row){path[r], PARTICLES[r], 0.1, (double)NAN};
    }
    assert_int_equal(read_text(&sieve, "size,passing\n1,0\n2,0.6\n3,1\n", 0, &err), MS_OK);
    assert_int_equal(ms_sieve_apply(&manifest, &sieve, &rows, &err), MS_OK);
    assert_true(ms_manifest_has_sizes(&manifest));
    for (size_t k = 0; k < manifest.count; k++) {
        const ms_manifest_row *kind = &manifest.row[k];
        const int class = kind->size > sieve.of[0].size;
        assert_close(kind->size, sieve.of[class].size, 0);
        assert_close(kind->tolerance, 0.1, 0);
        assert_true(kind->particles > 0);
        of_class[class] += kind->particles;
        of_row[kind->path[0] - 'a'] += kind->particles;
        mass[class] += (double)kind->particles * pow(kind->size, 3);
        assert_string_equal(manifest.row[ms_manifest_first(&manifest, k)].path, kind->path);
    }
    for (int c = 0; c < 2; c++) {
        assert_int_equal(of_class[c], sieve.of[c].count);
        assert_close(sieve.of[c].mass, mass[c] / (mass[0] + mass[1]), 1e-15);
        assert_close(sieve.of[c].mass, sieve.of[c].share, 0.006); /* half a large particle */
    }
    for (int r = 0; r < 3; r++) {
        assert_int_equal(of_row[r], PARTICLES[r]);
    }
    ms_manifest_free(&manifest);
    row[0].particles = MS_MANIFEST_MAX_PARTICLES;
    assert_int_equal(ms_sieve_apply(&manifest, &sieve, &rows, &err), MS_ERR_LIMIT);
    assert_int_equal(manifest.count, 0);
    row[0].particles = UINT64_MAX - 40; /* with those of the others 0, if the sum began anew */
    assert_int_equal(ms_sieve_apply(&manifest, &sieve, &rows, &err), MS_ERR_LIMIT);
    assert_int_equal(manifest.count, 0);
    ms_sieve_free(&sieve);
}

/* Nothing to divide by, and nothing to divide. */
static void test_apply_nothing(void **state)
{
    ms_sieve empty = {0}, sieve;
    char path[] = "a";
    ms_manifest_row row = {path, 1, (double)NAN, (double)NAN};
    const ms_manifest rows = {&row, 1}, none = {0};
    ms_manifest manifest;
    ms_error err;
    (void)state;
    assert_int_equal(ms_sieve_apply(&manifest, &empty, &rows, &err), MS_ERR_ARG);
    assert_non_null(strstr(err.text, "no classes"));
    assert_int_equal(read_text(&sieve, "size,passing\n1,0\n2,1\n", 0, &err), MS_OK);
    assert_int_equal(ms_sieve_apply(&manifest, &sieve, &none, &err), MS_ERR_ARG);
    row.particles = 0;
    assert_int_equal(ms_sieve_apply(&manifest, &sieve, &rows, &err), MS_ERR_ARG);
    assert_non_null(strstr(err.text, "no particles"));
    assert_int_equal(manifest.count, 0);
    ms_sieve_free(&sieve);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_round),
        cmocka_unit_test(test_round_many),
        cmocka_unit_test(test_take),
        cmocka_unit_test(test_classes_of_rows),
        cmocka_unit_test(test_classes_of_equal_mass),
        cmocka_unit_test(test_classes_of_next_to_nothing),
        cmocka_unit_test(test_refused),
        cmocka_unit_test(test_curves_in_memory),
        cmocka_unit_test(test_apply),
        cmocka_unit_test(test_apply_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
