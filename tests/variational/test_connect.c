/* The spheres are one piece: by brute force. */
#include "support/variational_samples.h"

#include <string.h>

#include "variational/ms_connect.h"

/* Pieces by union and find over all pairs; two of one piece overlap by that along the line of their centres. */
static size_t brute_pieces(const ms_ball *ball, size_t count, double overlap)
{
    size_t of[64], pieces = count;
    assert_true(count <= 64);
    for (size_t a = 0; a < count; a++) {
        of[a] = a;
    }
    for (size_t a = 0; a < count; a++) {
        for (size_t b = 0; b < a; b++) {
            const double way = sqrt(ms_squared_distance(ball[a].centre, ball[b].centre));
            if (way + overlap <= ball[a].radius + ball[b].radius && of[a] != of[b]) {
                const size_t gone = of[a], stays = of[b];
                for (size_t c = 0; c < count; c++) {
                    of[c] = of[c] == gone ? stays : of[c];
                }
                pieces--;
            }
        }
    }
    return pieces;
}

static void random_balls(ms_ball *ball, size_t count, double widest)
{
    for (size_t b = 0; b < count; b++) {
        ball[b].radius = uniform(2, widest);
        for (int a = 0; a < 3; a++) {
            ball[b].centre[a] = uniform(0, 60);
        }
    }
}

/* As many links as pieces but one, each from both ends; what they lack is what the pieces are apart. */
static void ties_are_what_is_apart(void **state)
{
    (void)state;
    static const ms_mirror NONE;
    enum { BALLS = 20 };
    int apart = 0, joined = 0;
    ms_error err;
    srand(11);
    for (int t = 0; t < 200; t++) {
        ms_ball ball[BALLS];
        ms_tie *tie;
        size_t ties, kept = BALLS;
        random_balls(ball, BALLS, 3 + 0.15 * t);
        const size_t pieces = brute_pieces(ball, BALLS, 0.5);
        assert_int_equal(ms_connect_find(&tie, &ties, ball, BALLS, &NONE, &err), MS_OK);
        assert_int_equal(ties, 2 * (pieces - 1));
        for (size_t i = 0; i < ties; i++) {
            assert_true(fabs(ms_dot(tie[i].normal, tie[i].normal) - 1) < 1e-12);
            assert_true(tie[i].away > 0);
        }
        /* Once each end has moved along its tie's way, that link holds. */
        for (size_t i = 0; i < ties; i++) {
            ball[tie[i].ball].radius += tie[i].away + 1e-9;
        }
        assert_int_equal(brute_pieces(ball, BALLS, 0.5), 1);
        free(tie);
        random_balls(ball, BALLS, 3 + 0.15 * t);
        const size_t before = brute_pieces(ball, BALLS, 0.5);
        assert_int_equal(ms_connect_keep_largest(ball, &kept, &err), MS_OK);
        assert_true(kept <= BALLS && kept > 0 && kept + before - 1 <= BALLS);
        assert_int_equal(brute_pieces(ball, kept, 0.5), 1);
        apart += before > 1;
        joined += before == 1;
    }
    assert_true(apart > 20 && joined > 20);
}

/* With a plane of symmetry: no ties, and spheres and images are one piece. */
static void images_are_joined(void **state)
{
    (void)state;
    static const ms_mirror X = {.across = {1, 0, 0}, .at = {-6, 0, 0}};
    enum { BALLS = 12 };
    int with = 0, without = 0;
    ms_error err;
    srand(12);
    for (int t = 0; t < 300; t++) {
        ms_ball ball[BALLS], all[2 * BALLS];
        ms_tie *tie;
        size_t ties;
        random_balls(ball, BALLS, 24);
        assert_int_equal(ms_connect_find(&tie, &ties, ball, BALLS, &X, &err), MS_OK);
        const size_t count = ms_mirror_expand(all, ball, BALLS, &X);
        assert_true((ties == 0) == (brute_pieces(all, count, 0.5) == 1));
        *(ties == 0 ? &without : &with) += 1;
        free(tie);
    }
    assert_true(with > 20 && without > 20);
}

static ms_clump run_remarked(char remark[512], const ms_target *target, size_t n, const char *options)
{
    ms_clump clump;
    ms_stop_reason reason;
    ms_error err;
    remark[0] = 0;
    assert_int_equal(try_generator(&clump, &reason, &ms_generator_variational, target, (ms_stop){.spheres = n}, options,
                                   keep_remark, remark, &err),
                     MS_OK);
    return clump;
}

static size_t pieces_of(const ms_clump *clump, const ms_target *target)
{
    ms_ball ball[64];
    assert_true(clump->n_spheres <= 64);
    for (size_t s = 0; s < clump->n_spheres; s++) {
        ball[s] = ms_grid_ball(&target->grid, &clump->sphere[s]);
    }
    return brute_pieces(ball, clump->n_spheres, 0);
}

/* A thin plate of few spheres, which stand apart unless they may not. */
static void clumps_are_one_piece(void **state)
{
    (void)state;
    static const char *const MORE[] = {"", "equal-radius", "symmetry=x", "symmetry=xy", "gap=6", "protrusion=4"};
    ms_mesh mesh;
    ms_target target;
    char remark[512];
    make_shape(&mesh, "plate", "a=20 b=10 c=1 fineness=6");
    make_target(&target, &mesh, 4, MS_VOXEL_CENTRE);
    for (size_t m = 0; m < sizeof MORE / sizeof *MORE; m++) {
        char options[64];
        snprintf(options, sizeof options, "connected %s", MORE[m]);
        ms_clump clump = run_remarked(remark, &target, 12, options),
                 free_one = run_remarked(remark, &target, 12, MORE[m]);
        print_message("%s: %zu spheres in %zu pieces, D %.4f; else %zu pieces, D %.4f\n", options, clump.n_spheres,
                      pieces_of(&clump, &target), dice_of(&target, &clump), pieces_of(&free_one, &target),
                      dice_of(&target, &free_one));
        assert_int_equal(pieces_of(&clump, &target), 1);
        assert_true(m > 0 || pieces_of(&free_one, &target) > 1);
        assert_true(m == 5 || clump.n_spheres == 12);
        assert_true(m == 5 || dice_of(&target, &clump) < 1.15 * dice_of(&target, &free_one));
        ms_clump_free(&clump);
        ms_clump_free(&free_one);
    }
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* Inscribed spheres of two bodies do not reach one another: those of one are left, and it is said; with a plane of
 * symmetry between them nothing can be left out. */
static void what_cannot_be_joined_is_said(void **state)
{
    (void)state;
    enum { X = 34, Y = 9, Z = 10 };
    ms_target target;
    ms_error err;
    char remark[512];
    uint32_t label[X * Y * Z];
    for (int v = 0; v < X * Y * Z; v++) {
        label[v] = v % X < 12 || v % X >= 22;
    }
    const ms_volume two = {.n = {X, Y, Z}, .spacing = 1, .label = label};
    assert_int_equal(ms_target_from_volume(&target, &two, 0, &err), MS_OK);
    size_t fewer = 0;
    for (size_t n = 2; n <= 6; n += 2) {
        ms_clump some = run_remarked(remark, &target, n, "connected protrusion=0");
        print_message("%zu of %zu: D %.3f %s\n", some.n_spheres, n, dice_of(&target, &some), remark);
        assert_int_equal(pieces_of(&some, &target), 1);
        assert_true((some.n_spheres < n) == (strstr(remark, "spheres are one piece") != NULL));
        fewer += some.n_spheres < n;
        ms_clump_free(&some);
    }
    assert_true(fewer > 0);
    ms_clump clump = run_remarked(remark, &target, 6, "connected protrusion=0 symmetry=x");
    assert_true(pieces_of(&clump, &target) > 1);
    assert_non_null(strstr(remark, "connected cannot be held by"));
    ms_clump_free(&clump);
    clump = run_remarked(remark, &target, 6, "connected");
    assert_int_equal(pieces_of(&clump, &target), 1);
    assert_string_equal(remark, "");
    ms_clump_free(&clump);
    ms_target_free(&target);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ties_are_what_is_apart),
        cmocka_unit_test(images_are_joined),
        cmocka_unit_test(clumps_are_one_piece),
        cmocka_unit_test(what_cannot_be_joined_is_said),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
