/* A queue of runs: each is done once and taken in the order of the list; large ones are alone. */
#include "support/test_support.h"

#include <omp.h>
#include <stdatomic.h>
#include <string.h>
#include <time.h>

#include "queue/ms_queue.h"

enum { RUNS = 40 };

/* What happened. */
typedef struct record {
    atomic_int at_work, most_at_work, worked[RUNS], threads[RUNS], beside[RUNS];
    atomic_int crowded; /* large runs that were not alone */
    int large[RUNS];
    size_t taken[RUNS], n_taken, fails_at;
} record;

static void sleep_ms(long ms)
{
    const struct timespec time = {.tv_nsec = ms * 1000000};
    nanosleep(&time, NULL);
}

/* Later runs are shorter, so that they are done before those that began before them. */
static void work(void *context, size_t run, ms_queue_place *place)
{
    record *r = context;
    const int others = atomic_fetch_add(&r->at_work, 1);
    if (others + 1 > r->most_at_work) {
        r->most_at_work = others + 1;
    }
    sleep_ms(run % 4 == 0 ? 8 : 1);
    if (r->large[run]) {
        atomic_fetch_sub(&r->at_work, 1); /* while it waits it is not */
        ms_queue_need_memory(place, 60, 100);
        r->crowded += atomic_fetch_add(&r->at_work, 1) > 0;
        sleep_ms(4);
        r->crowded += r->at_work > 1;
    }
    r->worked[run]++;
    r->threads[run] = omp_get_max_threads();
    r->beside[run] = ms_queue_beside(place);
    atomic_fetch_sub(&r->at_work, 1);
}

static ms_status take(void *context, size_t run, size_t *failed, ms_error *err)
{
    record *r = context;
    assert_int_equal(r->worked[run], 1);
    r->taken[r->n_taken++] = run;
    *failed += run % 3 == 0;
    return run == r->fails_at ? ms_fail(err, MS_ERR_IO, "run %zu could not be taken", run) : MS_OK;
}

static record run_queue(int threads, int in_turn, int large, size_t fails_at, ms_status wanted)
{
    record r;
    ms_error err;
    memset(&r, 0, sizeof r);
    for (int k = 0; k < RUNS; k++) {
        r.large[k] = large && (k % 7 == 3 || k % 7 == 4); /* neighbours, too, which wait at the same time */
    }
    r.fails_at = fails_at;
    const ms_queue queue = {
        .count = RUNS, .threads = threads, .in_turn = in_turn, .context = &r, .work = work, .take = take};
    const int before = omp_get_max_threads();
    assert_int_equal(ms_queue_run(&queue, &err), wanted);
    assert_int_equal(omp_get_max_threads(), before);
    assert_true(wanted == MS_OK || strcmp(err.text, "run 20 could not be taken") == 0);
    return r;
}

static void assert_all_taken_in_order(const record *r)
{
    assert_int_equal(r->n_taken, RUNS);
    for (size_t k = 0; k < RUNS; k++) {
        assert_int_equal(r->taken[k], k);
    }
}

static void runs_go_side_by_side_and_are_taken_in_order(void **state)
{
    (void)state;
    for (int threads = 2; threads <= 5; threads++) {
        const record r = run_queue(threads, 0, 0, RUNS, MS_OK);
        assert_all_taken_in_order(&r);
        assert_in_range(r.most_at_work, 2, threads);
        for (int k = 0; k < RUNS; k++) {
            assert_int_equal(r.threads[k], 1);
            assert_int_equal(r.beside[k], threads - 1);
        }
    }
}

static void in_turn_each_has_all_threads(void **state)
{
    (void)state;
    const record r = run_queue(3, 1, 1, RUNS, MS_OK);
    assert_all_taken_in_order(&r);
    assert_int_equal(r.most_at_work, 1);
    for (int k = 0; k < RUNS; k++) {
        assert_int_equal(r.threads[k], 3);
        assert_int_equal(r.beside[k], 0);
    }
}

static void large_runs_are_alone_and_have_all_threads(void **state)
{
    (void)state;
    for (int threads = 2; threads <= 5; threads++) {
        const record r = run_queue(threads, 0, 1, RUNS, MS_OK);
        assert_all_taken_in_order(&r);
        assert_int_equal(r.crowded, 0);
        for (int k = 0; k < RUNS; k++) {
            assert_int_equal(r.threads[k], r.large[k] ? threads : 1);
            assert_int_equal(r.beside[k], r.large[k] ? 0 : threads - 1);
        }
    }
}

/* What could not be written ends it: nothing behind it is taken, and few runs begin. */
static void a_failure_of_take_ends_the_queue(void **state)
{
    (void)state;
    for (int threads = 1; threads <= 4; threads++) {
        const record r = run_queue(threads, 0, 1, 20, MS_ERR_IO);
        int worked = 0;
        for (int k = 0; k < RUNS; k++) {
            worked += r.worked[k];
        }
        assert_int_equal(r.n_taken, 21);
        assert_in_range(worked, 21, RUNS - 1);
    }
}

static void an_empty_list_is_done(void **state)
{
    (void)state;
    ms_error err;
    const ms_queue queue = {.count = 0, .threads = 2, .work = work, .take = take};
    assert_int_equal(ms_queue_run(&queue, &err), MS_OK);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(runs_go_side_by_side_and_are_taken_in_order),
        cmocka_unit_test(in_turn_each_has_all_threads),
        cmocka_unit_test(large_runs_are_alone_and_have_all_threads),
        cmocka_unit_test(a_failure_of_take_ends_the_queue),
        cmocka_unit_test(an_empty_list_is_done),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
