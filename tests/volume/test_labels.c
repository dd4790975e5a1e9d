/* The labels of a volume against brute force on random volumes. */
#include "support/test_support.h"

#include <stdlib.h>
#include <string.h>

#include "volume/ms_labels.h"

/* Deterministic (Park and Miller). */
static uint32_t draw(uint32_t *state)
{
    *state = (uint32_t)(*state * (uint64_t)48271 % 2147483647);
    return *state;
}

/* Few labels or many, small or large ones; a third is background. */
static ms_volume make_random(const int n[3], uint32_t labels, uint32_t spread, uint32_t seed)
{
    ms_volume v = {.n = {n[0], n[1], n[2]}, .spacing = 0.5, .origin = {1, 2, 3}};
    const size_t count = (size_t)n[0] * (size_t)n[1] * (size_t)n[2];
    v.label = malloc(count * sizeof *v.label);
    assert_non_null(v.label);
    for (size_t i = 0; i < count; i++) {
        v.label[i] = draw(&seed) % 3 ? (1 + draw(&seed) % labels) * spread : 0;
    }
    return v;
}

/* What a loop over all voxels says of a label. */
static ms_label_entry look_through(const ms_volume *v, uint32_t label)
{
    ms_label_entry e = {.label = label, .lo = {v->n[0], v->n[1], v->n[2]}};
    for (int k = 0, i = 0; k < v->n[2]; k++) {
        for (int y = 0; y < v->n[1]; y++) {
            for (int x = 0; x < v->n[0]; x++, i++) {
                const int p[3] = {x, y, k};
                for (int a = 0; a < 3 && v->label[i] == label; a++) {
                    e.lo[a] = p[a] < e.lo[a] ? p[a] : e.lo[a];
                    e.hi[a] = p[a] + 1 > e.hi[a] ? p[a] + 1 : e.hi[a];
                    e.cut |= p[a] == 0 || p[a] == v->n[a] - 1;
                }
                e.voxels += v->label[i] == label;
            }
        }
    }
    return e;
}

static void assert_crop(const ms_volume *v, const ms_label_entry *e)
{
    ms_volume crop;
    ms_error err;
    size_t voxels = 0;
    assert_int_equal(ms_labels_crop(&crop, v, e, &err), MS_OK);
    for (int k = 0, i = 0; k < crop.n[2]; k++) {
        for (int y = 0; y < crop.n[1]; y++) {
            for (int x = 0; x < crop.n[0]; x++, i++) {
                const int at = ((k + e->lo[2]) * v->n[1] + y + e->lo[1]) * v->n[0] + x + e->lo[0];
                assert_int_equal(crop.label[i], v->label[at] == e->label ? e->label : 0);
                voxels += crop.label[i] != 0;
            }
        }
    }
    assert_int_equal(voxels, e->voxels);
    for (int a = 0; a < 3; a++) {
        assert_true(crop.origin[a] == v->origin[a] && crop.first[a] == e->lo[a]);
    }
    ms_volume_free(&crop);
}

static void assert_labels(const int n[3], uint32_t labels, uint32_t spread, uint32_t seed)
{
    ms_volume v = make_random(n, labels, spread, seed);
    ms_labels found;
    ms_error err;
    size_t count = 0;
    assert_int_equal(ms_labels_find(&found, &v, &err), MS_OK);
    for (uint32_t l = 1; l <= labels; l++) {
        const ms_label_entry truth = look_through(&v, l * spread), *e = ms_labels_entry(&found, l * spread);
        count += truth.voxels > 0;
        assert_int_equal(e != NULL, truth.voxels > 0);
        if (e) {
            assert_true(e->label == truth.label && e->voxels == truth.voxels && e->cut == truth.cut);
            assert_memory_equal(e->lo, truth.lo, sizeof truth.lo);
            assert_memory_equal(e->hi, truth.hi, sizeof truth.hi);
            assert_crop(&v, e);
        }
    }
    assert_int_equal(found.count, count);
    assert_null(ms_labels_entry(&found, 0));
    assert_null(ms_labels_entry(&found, labels * spread + 1));
    for (size_t l = 1; l < found.count; l++) {
        assert_true(found.entry[l - 1].label < found.entry[l].label);
    }
    ms_labels_free(&found);
    ms_volume_free(&v);
}

static void labels_are_those_of_a_loop_over_all_voxels(void **state)
{
    (void)state;
    assert_labels((const int[3]){7, 5, 6}, 4, 1, 1);
    assert_labels((const int[3]){1, 1, 9}, 3, 1000003, 2);
    assert_labels((const int[3]){9, 8, 11}, 700, 256, 3); /* more than the first table holds, of equal low bits */
    assert_labels((const int[3]){2, 1, 1}, 1, UINT32_MAX, 5);
}

static void a_volume_without_labels_has_none(void **state)
{
    (void)state;
    uint32_t voxels[8] = {0};
    const ms_volume v = {.n = {2, 2, 2}, .spacing = 1, .label = voxels};
    ms_labels found;
    ms_error err;
    assert_int_equal(ms_labels_find(&found, &v, &err), MS_OK);
    assert_int_equal(found.count, 0);
    assert_null(ms_labels_entry(&found, 1));
    ms_labels_free(&found);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(labels_are_those_of_a_loop_over_all_voxels),
        cmocka_unit_test(a_volume_without_labels_has_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
