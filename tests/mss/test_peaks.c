/* Local maxima: found by brute force, refined on fields whose maximum is known. */
#include "mss/ms_peaks.h"
#include "support/grid_samples.h"

enum { SIZE = 11, MIDDLE = 5, VOXELS = SIZE * SIZE * SIZE };

static const int cube[3] = {SIZE, SIZE, SIZE}, origin[3] = {0, 0, 0};

static size_t index_of(const int n[3], int i, int j, int k)
{
    return (size_t)i + (size_t)n[0] * ((size_t)j + (size_t)n[1] * (size_t)k);
}

static const size_t middle = MIDDLE + SIZE * (MIDDLE + SIZE * MIDDLE);

/* A field that is the sum of one function along each axis. */
static void fill(float *field, double (*f)(double x, int axis, const double *p), const double *p)
{
    for (int v = 0; v < VOXELS; v++) {
        const int at[3] = {v % SIZE - MIDDLE, v / SIZE % SIZE - MIDDLE, v / SIZE / SIZE - MIDDLE};
        field[v] = (float)(20 + f(at[0], 0, p) + f(at[1], 1, p) + f(at[2], 2, p));
    }
}

static int brute_peak(const float *field, const int n[3], int i, int j, int k)
{
    const float here = field[index_of(n, i, j, k)];
    int peak = here > 0;
    for (int d = 0; d < 27; d++) {
        peak &= field[index_of(n, i + d % 3 - 1, j + d / 3 % 3 - 1, k + d / 9 - 1)] <= here;
    }
    return peak;
}

static void expect_brute(const float *field, const int n[3], const int lo[3], const int hi[3])
{
    size_t *voxel, count, at = 0;
    assert_int_equal(ms_peaks_find(&voxel, &count, field, n, lo, hi, NULL), MS_OK);
    assert_non_null(voxel);
    for (int k = 1; k < n[2] - 1; k++) {
        for (int j = 1; j < n[1] - 1; j++) {
            for (int i = 1; i < n[0] - 1; i++) {
                const int in_box = i >= lo[0] && i < hi[0] && j >= lo[1] && j < hi[1] && k >= lo[2] && k < hi[2];
                if (in_box && brute_peak(field, n, i, j, k)) {
                    assert_true(at < count);
                    assert_int_equal(voxel[at], index_of(n, i, j, k));
                    at++;
                }
            }
        }
    }
    assert_int_equal(at, count);
    free(voxel);
}

static void maxima_agree_with_brute_force(void **state)
{
    (void)state;
    uint64_t seed = 5;
    for (int run = 0; run < 400; run++) {
        int lo[3], hi[3], n[3];
        float field[14 * 14 * 14];
        for (int a = 0; a < 3; a++) {
            n[a] = 1 + pick(&seed, 14);
            lo[a] = run % 2 ? -3 : pick(&seed, 10);
            hi[a] = run % 2 ? 99 : lo[a] + pick(&seed, 10) - 1;
        }
        const int levels = run % 3 ? 4 : 1000; /* few levels make plateaus */
        for (int v = 0; v < n[0] * n[1] * n[2]; v++) {
            field[v] = (float)(pick(&seed, levels) - 1);
        }
        expect_brute(field, n, lo, hi);
    }
}

static void plateaus_appear_whole(void **state)
{
    (void)state;
    float field[VOXELS] = {0};
    size_t *voxel, count;
    for (int v = 0; v < 12; v++) {
        field[index_of(cube, 3 + v % 2, 4 + v / 2 % 2, 2 + v / 4)] = 1.5f;
    }
    assert_int_equal(ms_peaks_find(&voxel, &count, field, cube, origin, cube, NULL), MS_OK);
    assert_int_equal(count, 12);
    free(voxel);
    memset(field, 0, sizeof field);
    assert_int_equal(ms_peaks_find(&voxel, &count, field, cube, origin, cube, NULL), MS_OK);
    assert_int_equal(count, 0); /* zero is no maximum */
    free(voxel);
    field[0] = field[VOXELS - 1] = 9; /* corners: the outermost layer is not looked at */
    assert_int_equal(ms_peaks_find(&voxel, &count, field, cube, origin, cube, NULL), MS_OK);
    assert_int_equal(count, 0);
    free(voxel);
}

/* Different slopes on both sides of the top: p[axis] the place, p[3+axis] and p[6+axis] the slopes. */
static double tent(double x, int axis, const double *p)
{
    const double away = x - p[axis];
    return away < 0 ? p[3 + axis] * away : -p[6 + axis] * away;
}

static void a_tent_is_found_between_the_voxels(void **state)
{
    (void)state;
    uint64_t seed = 6;
    float field[VOXELS];
    for (int run = 0; run < 300; run++) {
        double p[9];
        for (int a = 0; a < 9; a++) {
            p[a] = a < 3 ? between(&seed, -0.99, 0.99) : between(&seed, 0.3, 3);
        }
        int peak_at[3];
        double highest = 0;
        fill(field, tent, p);
        for (int a = 0; a < 3; a++) { /* the voxel next to the top that is the higher one */
            const int other = p[a] < 0 ? -1 : 1;
            peak_at[a] = tent(0, a, p) >= tent(other, a, p) ? 0 : other;
        }
        const size_t voxel = index_of(cube, MIDDLE + peak_at[0], MIDDLE + peak_at[1], MIDDLE + peak_at[2]);
        ms_peak peak;
        ms_peaks_refine(&peak, field, cube, voxel);
        for (int a = 0; a < 3; a++) {
            assert_int_equal(peak.voxel[a], MIDDLE + peak_at[a]);
            expect_close(peak.voxel[a] - MIDDLE + peak.shift[a], p[a], 1e-4);
            highest = fmax(highest, -tent(peak_at[a], a, p));
        }
        expect_close(peak.value, (double)field[voxel] + highest, 1e-4);
        expect_close(ms_peaks_value(&peak, field, cube), peak.value, 1e-4);
    }
}

/* Only along one axis: the others see a ridge, whose top is on the voxel. */
static void each_axis_is_refined_alone(void **state)
{
    (void)state;
    float field[VOXELS];
    for (int a = 0; a < 3; a++) {
        double p[9] = {0, 0, 0, 0, 0, 0, 0, 0, 0};
        p[a] = 0.3;
        p[3 + a] = p[6 + a] = 1;
        fill(field, tent, p);
        ms_peak peak;
        ms_peaks_refine(&peak, field, cube, middle);
        for (int b = 0; b < 3; b++) {
            expect_close(peak.shift[b], b == a ? 0.3 : 0, 1e-5);
        }
        expect_close(peak.value, 20, 1e-5);
    }
}

/* Five values along x, constant across. */
static ms_peak refine_line(const double e[5])
{
    float field[VOXELS];
    ms_peak peak;
    for (int v = 0; v < VOXELS; v++) {
        const int d = v % SIZE - MIDDLE + 2;
        field[v] = (float)e[d < 0 ? 0 : d > 4 ? 4 : d];
    }
    ms_peaks_refine(&peak, field, cube, middle);
    assert_true(peak.shift[1] == 0 && peak.shift[2] == 0);
    return peak;
}

static void lines_by_hand(void **state)
{
    (void)state;
    static const struct {
        double e[5], shift, value;
        const char *what;
    } cases[] = {
        {{1, 1, 1, 1, 1}, 0, 1, "all parallel: a plateau (eqs. 15, 16, 20, 21)"},
        {{0, 1, 2, 2, 1}, 0.5, 2.5, "a plateau of two, the top between them"},
        {{1, 2, 2, 1, 0}, -0.5, 2.5, "its other voxel"},
        {{0, 1, 2, 1, 0}, 0, 2, "the top on the voxel"},
        {{1, 2, 2, 2, 1}, 0, 2, "a plateau of three: its middle"},
        {{0, 2, 3, 2, 0}, 0, 3, "both pairs cross above the voxel, and as high: the middle stays"},
        {{0, 2, 3, 2.5, 0}, 4.0 / 7, 25.0 / 7, "both cross above it, the right pair higher: 3 + x meets 5 - 2.5x"},
        {{0, 0, 1, 1, 1}, 0, 1, "the rim of a plateau: no lines cross above it"},
        {{0, 0, 5, 0, 0}, 0, 5, "a needle: g(-2,-1) and g(0,1) cross below it"},
        {{1, 3, 4, 2, 0}, -1.0 / 4, 4.5, "left: 1 + 2(x + 2) meets 4 - 2x at x = -1/4"},
        {{0, 2, 4, 3, 1}, 1.0 / 4, 4.5, "right: its mirror image"},
    };
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        const ms_peak peak = refine_line(cases[c].e);
        if (fabs(peak.shift[0] - cases[c].shift) > 1e-12 || fabs(peak.value - cases[c].value) > 1e-12) {
            fail_msg("%s: shift %g, value %g", cases[c].what, peak.shift[0], peak.value);
        }
    }
}

/* Eqs. 12 to 22 as they stand in the paper, for lines that the symmetric rule does not touch. */
static void paper_axis(double *at, double *value, const double *e)
{
    const double rise = e[1] - e[0], left = e[2] - e[1], right = e[3] - e[2], fall = e[4] - e[3];
    const double la = (left - rise) / (rise - right), lb = (right - fall) / (left - fall);
    const double ea = e[2] + la * rise + (rise - left), eb = e[2] + lb * left;
    *at = ea > e[2] ? la : lb;
    *value = ea > e[2] ? ea : eb;
}

static void the_paper_s_formulas_hold(void **state)
{
    (void)state;
    uint64_t seed = 8;
    int compared = 0;
    for (int run = 0; run < 20000; run++) {
        double e[5] = {0, 0, 8, 0, 0}, at, value;
        for (int d = 1; d <= 2; d++) { /* rising to the middle by steps that shrink: concave */
            e[2 - d] = (double)(float)(e[3 - d] - between(&seed, 0, d));
            e[2 + d] = (double)(float)(e[1 + d] - between(&seed, 0, d));
        }
        const ms_peak peak = refine_line(e);
        assert_true(peak.value >= 8 && fabs(peak.shift[0]) <= 1);
        const double rise = e[1] - e[0], left = 8 - e[1], right = e[3] - 8, fall = e[4] - e[3];
        /* One pair of lines rises above the voxel, the other does not; none are nearly parallel. */
        if ((rise > left) == (right > fall) || fabs(rise - left) < 1e-3 || fabs(right - fall) < 1e-3 ||
            fabs(rise - right) < 1e-3 || fabs(left - fall) < 1e-3) {
            continue;
        }
        paper_axis(&at, &value, e);
        if (value > 8 + 1e-4) {
            expect_close(peak.shift[0], at, 1e-9);
            expect_close(peak.value, value, 1e-9);
            compared++;
        }
    }
    assert_true(compared > 1000);
}

static void mirrored_fields_give_mirrored_shifts(void **state)
{
    (void)state;
    uint64_t seed = 9;
    float field[VOXELS], mirrored[VOXELS];
    for (int run = 0; run < 200; run++) {
        for (int v = 0; v < VOXELS; v++) {
            /* Roots of whole numbers, as in a distance field; often equal. */
            field[v] = sqrtf((float)pick(&seed, run % 2 ? 6 : 400));
            mirrored[VOXELS - 1 - v] = field[v];
        }
        field[middle] = mirrored[middle] = 21;
        ms_peak one, other;
        ms_peaks_refine(&one, field, cube, middle);
        ms_peaks_refine(&other, mirrored, cube, middle);
        assert_true(one.value == other.value);
        for (int a = 0; a < 3; a++) {
            assert_true(one.shift[a] == -other.shift[a]);
            assert_true(fabs(one.shift[a]) <= 1);
        }
        assert_true(ms_peaks_value(&one, field, cube) == ms_peaks_value(&other, mirrored, cube));
    }
}

/* The second field is read at the place that the first gave. */
static void another_field_is_read_at_the_same_place(void **state)
{
    (void)state;
    float field[VOXELS], other[VOXELS];
    const double steep[9] = {0.3, 0, 0, 1, 1, 1, 1, 1, 1}, flat[9] = {0.3, 0, 0, 0.5, 0.5, 0.5, 0.25, 0.5, 0.5};
    fill(field, tent, steep);
    fill(other, tent, flat);
    ms_peak peak;
    ms_peaks_refine(&peak, field, cube, middle);
    expect_close(peak.shift[0], 0.3, 1e-5);
    /* Along x the ridge of the other field is met at its top; there it has its full height, 20. */
    expect_close(ms_peaks_value(&peak, other, cube), 20, 1e-5);
    peak.shift[0] = 0; /* on the voxel: its own value */
    assert_true(ms_peaks_value(&peak, other, cube) == (double)other[middle]);
}

static void threads_change_nothing(void **state)
{
    (void)state;
    const int n[3] = {40, 37, 41}, before = omp_get_max_threads();
    const size_t voxels = 40 * 37 * 41;
    uint64_t seed = 10;
    float *field = malloc(voxels * sizeof *field);
    size_t *found[3], count[3];
    assert_non_null(field);
    for (size_t v = 0; v < voxels; v++) {
        field[v] = (float)pick(&seed, 9);
    }
    for (int threads = 1; threads <= 3; threads++) {
        omp_set_num_threads(threads);
        assert_int_equal(ms_peaks_find(&found[threads - 1], &count[threads - 1], field, n, origin, n, NULL), MS_OK);
    }
    omp_set_num_threads(before);
    for (int t = 0; t < 3; t++) {
        assert_int_equal(count[t], count[0]);
        assert_memory_equal(found[t], found[0], count[0] * sizeof *found[0]);
    }
    for (int t = 0; t < 3; t++) {
        free(found[t]);
    }
    free(field);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(threads_change_nothing),
        cmocka_unit_test(maxima_agree_with_brute_force),
        cmocka_unit_test(plateaus_appear_whole),
        cmocka_unit_test(a_tent_is_found_between_the_voxels),
        cmocka_unit_test(each_axis_is_refined_alone),
        cmocka_unit_test(lines_by_hand),
        cmocka_unit_test(the_paper_s_formulas_hold),
        cmocka_unit_test(mirrored_fields_give_mirrored_shifts),
        cmocka_unit_test(another_field_is_read_at_the_same_place),
    };
    omp_set_num_threads(1); /* small fields */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
