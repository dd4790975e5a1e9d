/* Greedy set cover against brute force. */
#include "support/test_support.h"

#include "shared/ms_cover.h"
#include "shared/ms_cover_bits.h"

enum { MAX_BALLS = 40 };

typedef struct problem {
    ms_grid grid;
    ms_ball ball[MAX_BALLS];
    size_t count;
} problem;

static double uniform(void)
{
    return (double)rand() / RAND_MAX;
}

/* A noisy grid and balls off the lattice, some twice, some concentric, some beyond the grid. */
static void make_problem(problem *p, int nx)
{
    static const double ORIGIN[3] = {0, 0, 0};
    const int n[3] = {nx, 3 + rand() % 12, 3 + rand() % 12};
    ms_error err;
    assert_int_equal(ms_grid_alloc(&p->grid, n, 1, ORIGIN, &err), MS_OK);
    for (size_t v = 0; v < ms_grid_voxels(&p->grid); v++) {
        p->grid.inside[v] = rand() % 4 != 0;
    }
    p->count = 1 + (size_t)rand() % MAX_BALLS;
    for (size_t b = 0; b < p->count; b++) {
        ms_ball *ball = &p->ball[b];
        *ball = p->ball[(size_t)rand() % (b ? b : 1)]; /* of the first nothing is kept */
        const int kind = b ? rand() % 8 : 7;
        for (int a = 0; a < 3 && kind > 1; a++) {
            ball->centre[a] = (1.4 * uniform() - 0.2) * n[a];
        }
        ball->radius = kind == 0 ? ball->radius : 0.1 + 6.283 * uniform() * uniform() * (rand() % 9 ? 1 : nx / 6.0);
    }
}

static int holds(const ms_ball *b, int i, int j, int k)
{
    const double x = i - b->centre[0], y = j - b->centre[1], z = k - b->centre[2];
    return x * x + y * y + z * z <= b->radius * b->radius;
}

/* How many voxels of `left` a ball holds; takes them if asked to. */
static size_t brute_count(uint8_t *left, const ms_grid *grid, const ms_ball *b, int take)
{
    size_t count = 0;
    for (int k = 0; k < grid->n[2]; k++) {
        for (int j = 0; j < grid->n[1]; j++) {
            for (int i = 0; i < grid->n[0]; i++) {
                uint8_t *at = left + ms_grid_index(grid, i, j, k);
                if (*at && holds(b, i, j, k)) {
                    count++;
                    *at = !take;
                }
            }
        }
    }
    return count;
}

static int touches(const ms_ball *ball, const ms_ball *taken, size_t n_taken)
{
    for (size_t t = 0; t < n_taken; t++) {
        double square = 0;
        for (int a = 0; a < 3; a++) {
            square += (ball->centre[a] - taken[t].centre[a]) * (ball->centre[a] - taken[t].centre[a]);
        }
        const double reach = ball->radius + taken[t].radius;
        if (square < reach * reach) {
            return 1;
        }
    }
    return n_taken == 0;
}

/* The best candidate by the stated rule; its gain. */
static size_t brute_next(size_t *which, const problem *p, uint8_t *left, const ms_ball *taken, size_t n_taken,
                         int connected)
{
    size_t best = 0;
    for (size_t b = 0; b < p->count; b++) {
        const size_t gain = brute_count(left, &p->grid, &p->ball[b], 0);
        const int larger = gain == best && gain > 0 && p->ball[b].radius > p->ball[*which].radius;
        if ((gain > best || larger) && (!connected || touches(&p->ball[b], taken, n_taken))) {
            best = gain;
            *which = b;
        }
    }
    return best;
}

static void check_problem(const problem *p, int connected)
{
    ms_cover *cover;
    ms_error err;
    uint8_t *left = malloc(ms_grid_voxels(&p->grid));
    ms_ball taken[MAX_BALLS];
    size_t n_taken = 0, expected, which = 0, wanted = 0;
    memcpy(left, p->grid.inside, ms_grid_voxels(&p->grid));
    assert_int_equal(
        ms_cover_build(&cover, &p->grid, p->ball, p->count, connected ? MS_COVER_CONNECTED : MS_COVER_ANY, &err),
        MS_OK);
    do {
        expected = brute_next(&wanted, p, left, taken, n_taken, connected);
        assert_int_equal(ms_cover_next(&which, cover), expected);
        if (expected) {
            assert_int_equal(which, wanted);
            assert_int_equal(brute_count(left, &p->grid, &p->ball[which], 1), expected);
            taken[n_taken++] = p->ball[which];
        }
    } while (expected);
    ms_cover_free(cover);
    free(left);
}

static void every_choice_is_the_greedy_one(void **state)
{
    (void)state;
    static const int WIDTH[] = {1, 7, 63, 64, 65, 128, 130, 200};
    srand(5);
    for (int round = 0; round < 240; round++) {
        problem p;
        make_problem(&p, WIDTH[round % 8]);
        check_problem(&p, 0);
        check_problem(&p, 1);
        ms_grid_free(&p.grid);
    }
}

/* With many balls in a group none is taken twice, nothing that any holds is left, and the first is nearly the best. */
static void groups_lose_nothing(void **state)
{
    (void)state;
    enum { COUNT = 300 };
    static const double ORIGIN[3] = {0, 0, 0};
    static const int N[3] = {70, 40, 40};
    ms_ball ball[COUNT];
    ms_grid grid;
    ms_cover *cover[2];
    ms_error err;
    size_t total[2] = {0}, which, first[2], gain;
    assert_int_equal(ms_grid_alloc(&grid, N, 1, ORIGIN, &err), MS_OK);
    memset(grid.inside, 1, ms_grid_voxels(&grid));
    srand(8);
    for (int b = 0; b < COUNT; b++) { /* clusters of centres half a voxel wide */
        for (int a = 0; a < 3; a++) {
            ball[b].centre[a] = (a ? 12 : 15) + 9 * ((b >> a) & 1) + 0.5 * uniform();
        }
        ball[b].radius = 11 + 0.3 * uniform();
    }
    for (int grouped = 0; grouped < 2; grouped++) {
        uint8_t taken[COUNT] = {0};
        int n = 0;
        assert_int_equal(
            ms_cover_build(&cover[grouped], &grid, ball, COUNT, grouped ? MS_COVER_GROUPED : MS_COVER_ANY, &err),
            MS_OK);
        while ((gain = ms_cover_next(&which, cover[grouped])) > 0) {
            first[grouped] = n++ ? first[grouped] : gain;
            total[grouped] += gain;
            assert_int_equal(taken[which]++, 0);
        }
        ms_cover_free(cover[grouped]);
    }
    assert_int_equal(total[0], total[1]);
    assert_true(first[1] <= first[0] && (double)first[1] > 0.9 * (double)first[0]);
    ms_grid_free(&grid);
}

/* What a ball holds in every so many-th row of such planes; once another ball was taken out, too. */
static void samples_are_of_every_so_many_rows(void **state)
{
    (void)state;
    srand(11);
    for (int round = 0; round < 100; round++) {
        problem p;
        ms_cover_bits set;
        make_problem(&p, 30 + 3 * round);
        assert_true(ms_cover_bits_alloc(&set, &p.grid));
        for (size_t b = 0; b < p.count; b++) {
            const ms_ball *ball = &p.ball[b];
            for (int step = 1; step <= 8; step *= 2) {
                size_t count = 0;
                for (int k = 0; k < p.grid.n[2]; k += step) {
                    for (int j = 0; j < p.grid.n[1]; j += step) {
                        for (int i = 0; i < p.grid.n[0]; i++) {
                            count += p.grid.inside[ms_grid_index(&p.grid, i, j, k)] && holds(ball, i, j, k);
                        }
                    }
                }
                assert_int_equal(ms_cover_bits_sample(&set, ball, step), count);
            }
            if (b % 3 == 0) {
                ms_cover_bits_remove(&set, ball);
                brute_count(p.grid.inside, &p.grid, ball, 1);
            }
        }
        ms_cover_bits_free(&set);
        ms_grid_free(&p.grid);
    }
}

/* By the rule of voxel centres the union on the grid grows by just what each ball is said to add. */
static void gains_are_those_of_the_raster(void **state)
{
    (void)state;
    srand(6);
    for (int round = 0; round < 60; round++) {
        problem p;
        ms_cover *cover;
        ms_raster raster;
        ms_error err;
        size_t which, gain;
        make_problem(&p, 20 + round);
        assert_int_equal(ms_cover_build(&cover, &p.grid, p.ball, p.count, 0, &err), MS_OK);
        assert_int_equal(ms_raster_alloc(&raster, &p.grid, MS_VOXEL_CENTRE, &err), MS_OK);
        while ((gain = ms_cover_next(&which, cover)) > 0) {
            assert_int_equal(ms_raster_add(&raster, &p.ball[which], 1, &err), MS_OK);
            assert_int_equal(raster.tally[raster.n_balls - 1].inside, gain);
        }
        ms_raster_free(&raster);
        ms_cover_free(cover);
        ms_grid_free(&p.grid);
    }
}

/* Balls of all sizes, most of them large enough to be estimated. */
static void make_crowd(ms_grid *grid, ms_ball *ball, int count)
{
    static const double ORIGIN[3] = {0, 0, 0};
    static const int N[3] = {90, 70, 70};
    ms_error err;
    assert_int_equal(ms_grid_alloc(grid, N, 1, ORIGIN, &err), MS_OK);
    memset(grid->inside, 1, ms_grid_voxels(grid));
    srand(12);
    for (int b = 0; b < count; b++) {
        for (int a = 0; a < 3; a++) {
            ball[b].centre[a] = uniform() * N[a];
        }
        ball[b].radius = 8 + 18 * uniform();
    }
}

/* In the code under test malloc is this one (the linker's --wrap). */
void *__real_malloc(size_t size);
void *__wrap_malloc(size_t size);

static int starved; /* nonzero: there is no memory */
static size_t refused;

void *__wrap_malloc(size_t size)
{
    if (starved) {
#pragma omp atomic
        refused++;
        return NULL;
    }
    return __real_malloc(size);
}

/* Without memory for what is left of candidates the same ones are taken. */
static void the_choice_does_not_hang_on_memory(void **state)
{
    (void)state;
    enum { COUNT = 400 };
    ms_ball ball[COUNT];
    size_t taken[COUNT], gain[COUNT], which, adds, n = 0, m = 0;
    ms_grid grid;
    ms_cover *cover[2];
    ms_error err;
    make_crowd(&grid, ball, COUNT);
    for (int c = 0; c < 2; c++) {
        assert_int_equal(ms_cover_build(&cover[c], &grid, ball, COUNT, MS_COVER_GROUPED, &err), MS_OK);
    }
    for (; (adds = ms_cover_next(&which, cover[0])) > 0; n++) {
        taken[n] = which;
        gain[n] = adds;
    }
    starved = 1;
    for (; (adds = ms_cover_next(&which, cover[1])) > 0 && m < n && which == taken[m] && adds == gain[m]; m++) {
    }
    starved = 0;
    assert_int_equal(m, n);
    assert_int_equal(adds, 0);
    assert_true(n > 20 && refused > COUNT);
    ms_cover_free(cover[0]);
    ms_cover_free(cover[1]);
    ms_grid_free(&grid);
}

/* The best of those admitted, and the count of any ball, by brute force, whatever is taken. */
static void only_what_was_admitted_is_chosen(void **state)
{
    (void)state;
    srand(13);
    for (int round = 0; round < 60; round++) {
        problem p;
        ms_cover *cover;
        ms_error err;
        size_t admitted = 0, which, gain = 1;
        make_problem(&p, 20);
        assert_int_equal(ms_cover_build(&cover, &p.grid, p.ball, p.count, MS_COVER_ADMITTED, &err), MS_OK);
        assert_int_equal(ms_cover_best(&which, cover), 0);
        while (admitted < p.count || gain > 0) {
            if (admitted < p.count) {
                ms_cover_admit(cover, admitted++);
            }
            size_t most = 0;
            for (size_t b = 0; b < p.count; b++) {
                const size_t count = brute_count(p.grid.inside, &p.grid, &p.ball[b], 0);
                assert_int_equal(ms_cover_count(cover, &p.ball[b]), count);
                most = b < admitted && count > most ? count : most;
            }
            gain = ms_cover_best(&which, cover);
            assert_int_equal(gain, most);
            assert_true(gain == 0 || which < admitted);
            if (gain > 0) {
                ms_ball moved = p.ball[which];
                moved.centre[0] += rand() % 3 ? 0 : 1; /* no candidate */
                ms_cover_take(cover, &moved);
                brute_count(p.grid.inside, &p.grid, &moved, 1);
            }
        }
        ms_cover_free(cover);
        ms_grid_free(&p.grid);
    }
}

static void nothing_to_cover(void **state)
{
    (void)state;
    problem p;
    ms_cover *cover;
    ms_error err;
    size_t which;
    make_problem(&p, 30);
    memset(p.grid.inside, 0, ms_grid_voxels(&p.grid));
    assert_int_equal(ms_cover_build(&cover, &p.grid, p.ball, p.count, 0, &err), MS_OK);
    assert_int_equal(ms_cover_next(&which, cover), 0);
    ms_cover_free(cover);
    assert_int_equal(ms_cover_build(&cover, &p.grid, p.ball, 0, 1, &err), MS_OK);
    assert_int_equal(ms_cover_next(&which, cover), 0);
    ms_cover_free(cover);
    ms_grid_free(&p.grid);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_choice_is_the_greedy_one),
        cmocka_unit_test(groups_lose_nothing),
        cmocka_unit_test(samples_are_of_every_so_many_rows),
        cmocka_unit_test(gains_are_those_of_the_raster),
        cmocka_unit_test(the_choice_does_not_hang_on_memory),
        cmocka_unit_test(only_what_was_admitted_is_chosen),
        cmocka_unit_test(nothing_to_cover),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
