/* Components against a flood fill by hand, on random volumes. */
#include "support/reader_samples.h"

#include "volume/ms_components.h"
#include "volume/ms_otsu.h"

/* Deterministic (Park and Miller). */
static uint32_t draw(uint32_t *state)
{
    *state = (uint32_t)(*state * (uint64_t)48271 % 2147483647);
    return *state;
}

static size_t count_voxels(const int n[3])
{
    return (size_t)n[0] * (size_t)n[1] * (size_t)n[2];
}

/* Do two voxels of one piece touch as the connectivity wants? */
static int are_neighbours(const int a[3], const int b[3], int connectivity)
{
    int differ = 0;
    for (int c = 0; c < 3; c++) {
        const int d = abs(a[c] - b[c]);
        if (d > 1) {
            return 0;
        }
        differ += d;
    }
    return differ > 0 && differ <= (connectivity == 6 ? 1 : connectivity == 18 ? 2 : 3);
}

static void place_of(int place[3], size_t i, const int n[3])
{
    place[0] = (int)(i % (size_t)n[0]);
    place[1] = (int)(i / (size_t)n[0] % (size_t)n[1]);
    place[2] = (int)(i / (size_t)n[0] / (size_t)n[1]);
}

/* Spreads labels from voxel to voxel until nothing changes. */
static size_t flood(uint32_t *label, const uint32_t *inside, const int n[3], int connectivity)
{
    const size_t count = count_voxels(n);
    uint32_t components = 0;
    memset(label, 0, count * sizeof *label);
    for (size_t seed = 0; seed < count; seed++) {
        if (!inside[seed] || label[seed]) {
            continue;
        }
        label[seed] = ++components;
        for (int changed = 1; changed;) {
            changed = 0;
            for (size_t i = 0; i < count; i++) {
                int p[3], q[3];
                place_of(p, i, n);
                for (size_t j = 0; j < count && inside[i] && !label[i]; j++) {
                    place_of(q, j, n);
                    if (label[j] == components && are_neighbours(p, q, connectivity)) {
                        label[i] = components;
                        changed = 1;
                    }
                }
            }
        }
    }
    return components;
}

static void assert_components(const int n[3], uint32_t one_in, uint32_t seed, int connectivity)
{
    const size_t count = count_voxels(n);
    uint32_t *inside = calloc(count, sizeof *inside), *truth = calloc(count, sizeof *truth);
    size_t found;
    assert_true(inside && truth);
    for (size_t i = 0; i < count; i++) {
        inside[i] = draw(&seed) % one_in == 0 ? 1 + draw(&seed) % 5 : 0; /* any number but 0 is inside */
    }
    const size_t components = flood(truth, inside, n, connectivity);
    assert_int_equal(ms_components_label(inside, &found, n, connectivity, NULL), MS_OK);
    assert_int_equal(found, components);
    assert_memory_equal(inside, truth, count * sizeof *truth);
    free(inside);
    free(truth);
}

static void components_are_those_of_a_flood_fill(void **state)
{
    static const int EXTENTS[][3] = {{7, 6, 5}, {1, 9, 8}, {9, 1, 7}, {8, 7, 1}, {11, 1, 1}, {1, 1, 1}},
                     BY[] = {6, 18, 26};
    (void)state;
    for (size_t e = 0; e < sizeof EXTENTS / sizeof *EXTENTS; e++) {
        for (int b = 0; b < 3; b++) {
            for (uint32_t one_in = 1; one_in <= 5; one_in++) {
                assert_components(EXTENTS[e], one_in, (uint32_t)(17 + e * 100 + one_in), BY[b]);
            }
        }
    }
}

/* Two voxels that share a face, an edge, a corner. */
static void connectivity_is_what_voxels_share(void **state)
{
    static const size_t SECOND[] = {1, 4, 13}; /* (1,0,0), (1,1,0), (1,1,1) of 3 x 3 x 3, from (0,0,0) */
    static const int BY[] = {6, 18, 26};
    (void)state;
    for (int s = 0; s < 3; s++) {
        for (int b = 0; b < 3; b++) {
            uint32_t label[27] = {9};
            size_t count;
            label[SECOND[s]] = 9;
            assert_int_equal(ms_components_label(label, &count, (const int[3]){3, 3, 3}, BY[b], NULL), MS_OK);
            assert_int_equal(count, s <= b ? 1 : 2);
        }
    }
}

static void the_largest_piece_stays(void **state)
{
    uint32_t row[9] = {7, 7, 0, 7, 7, 7, 0, 7, 7}, tie[5] = {4, 0, 4, 0, 4}, empty[2] = {0, 0};
    const uint32_t kept[9] = {0, 0, 0, 7, 7, 7, 0, 0, 0}, first[5] = {4, 0, 0, 0, 0};
    ms_volume v = {.n = {9, 1, 1}, .spacing = 1, .label = row};
    size_t count;
    ms_error err;
    (void)state;
    assert_int_equal(ms_components_keep_largest(&v, &count, 26, &err), MS_OK);
    assert_int_equal(count, 3);
    assert_memory_equal(row, kept, sizeof kept);
    v = (ms_volume){.n = {5, 1, 1}, .spacing = 1, .label = tie};
    assert_int_equal(ms_components_keep_largest(&v, &count, 6, &err), MS_OK);
    assert_memory_equal(tie, first, sizeof first);
    v = (ms_volume){.n = {2, 1, 1}, .spacing = 1, .label = empty};
    assert_int_equal(ms_components_keep_largest(&v, &count, 6, &err), MS_OK);
    assert_int_equal(count, 0);
    v.label = row;
    assert_int_equal(ms_components_keep_largest(&v, &count, 8, &err), MS_ERR_ARG);
    expect_message(&err, "a connectivity of 8 is none of 6, 18 and 26");
}

/* The histogram by its bins, and every cut tried: the variance within the classes, summed voxel by voxel. */
static void cut_by_hand(size_t *below, size_t *above, const uint64_t *h, size_t bins)
{
    double best = 1e300;
    for (size_t cut = 1; cut < bins; cut++) {
        double within = 0;
        int is_empty = 0;
        for (int upper = 0; upper < 2; upper++) {
            double count = 0, mean = 0;
            for (size_t b = upper ? cut : 0; b < (upper ? bins : cut); b++) {
                count += (double)h[b];
                mean += (double)h[b] * (double)b;
            }
            is_empty |= count == 0;
            for (size_t b = upper ? cut : 0; b < (upper ? bins : cut); b++) {
                within += (double)h[b] * ((double)b - mean / count) * ((double)b - mean / count);
            }
        }
        if (!is_empty && within < best - 1e-9) {
            best = within;
            *above = cut;
        }
    }
    *below = *above - 1;
    while (h[*below] == 0) {
        --*below;
    }
    while (h[*above] == 0) {
        ++*above;
    }
}

static void otsu_cuts_hand_made_histograms(void **state)
{
    static const struct {
        uint64_t h[8];
        size_t below, above;
    } cases[] = {
        {{8, 7, 2, 6, 9, 4}, 2, 3},          /* the example of many lectures: classes 0-2 and 3-5 */
        {{0, 10, 0, 0, 0, 0, 10, 0}, 1, 6},  /* two values: any cut between them */
        {{5, 0, 0, 5, 0, 0, 0, 1000}, 3, 7}, /* a rare lower class, of two values */
        {{1, 1, 1, 1, 1, 1, 1, 1}, 3, 4},    /* even: in the middle */
    };
    size_t below, above;
    (void)state;
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        assert_true(ms_otsu_cut(&below, &above, cases[c].h, 8));
        assert_int_equal(below, cases[c].below);
        assert_int_equal(above, cases[c].above);
    }
    assert_false(ms_otsu_cut(&below, &above, (const uint64_t[4]){0, 3, 0, 0}, 4));
    assert_false(ms_otsu_cut(&below, &above, (const uint64_t[4]){0}, 4));
}

static void otsu_has_the_least_variance_within_the_classes(void **state)
{
    uint32_t seed = 3;
    (void)state;
    for (int trial = 0; trial < 200; trial++) {
        uint64_t h[24];
        size_t below = 0, above = 0, b = 0, a = 0;
        for (int i = 0; i < 24; i++) {
            h[i] = draw(&seed) % 3 ? draw(&seed) % 1000 : 0;
        }
        cut_by_hand(&b, &a, h, 24);
        assert_true(ms_otsu_cut(&below, &above, h, 24));
        assert_true(below == b && above == a);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(components_are_those_of_a_flood_fill),
        cmocka_unit_test(connectivity_is_what_voxels_share),
        cmocka_unit_test(the_largest_piece_stays),
        cmocka_unit_test(otsu_cuts_hand_made_histograms),
        cmocka_unit_test(otsu_has_the_least_variance_within_the_classes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
