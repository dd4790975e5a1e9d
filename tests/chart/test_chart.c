/* Charts: the Pareto front against brute force, what the files hold. */
#include "base/ms_file.h"
#include "chart/ms_chart.h"
#include "support/test_support.h"

static int beats(const ms_chart_point *a, const ms_chart_point *b)
{
    return a->x <= b->x && a->y <= b->y && (a->x < b->x || a->y < b->y);
}

static int on_front(const ms_chart_point *point, size_t count, size_t p)
{
    for (size_t q = 0; q < count; q++) {
        if (beats(&point[q], &point[p])) {
            return 0;
        }
    }
    return 1;
}

/* Coordinates from few values, so that ties and equal points abound. */
static void pareto_against_brute_force(void **state)
{
    enum { MOST = 40 };
    (void)state;
    srand(7);
    for (int trial = 0; trial < 2000; trial++) {
        ms_chart_point point[MOST], front[MOST];
        const size_t count = (size_t)(rand() % (MOST + 1));
        size_t wanted = 0, at = 0;
        const int values = 2 + rand() % 30;
        for (size_t p = 0; p < count; p++) {
            point[p] = (ms_chart_point){.x = rand() % values, .y = rand() % values};
            snprintf(point[p].label, sizeof point[p].label, "%zu", p);
        }
        const size_t found = ms_chart_pareto(front, point, count);
        for (size_t p = 0; p < count; p++) {
            wanted += on_front(point, count, p);
        }
        assert_int_equal(found, wanted);
        for (; at < found; at++) {
            const size_t p = (size_t)atoi(front[at].label);
            assert_true(front[at].x == point[p].x && front[at].y == point[p].y);
            assert_true(on_front(point, count, p));
            assert_true(at == 0 || front[at].x >= front[at - 1].x);
            for (size_t other = 0; other < at; other++) {
                assert_string_not_equal(front[at].label, front[other].label);
            }
        }
    }
}

static void pareto_without_numbers(void **state)
{
    (void)state;
    const ms_chart_point point[] = {
        {(double)NAN, 0, "", 0}, {2.385, 1.7, "a", 0}, {0, HUGE_VAL, "", 0}, {-HUGE_VAL, 0, "", 0}};
    ms_chart_point front[4];
    assert_int_equal(ms_chart_pareto(front, point, 4), 1);
    assert_string_equal(front[0].label, "a");
    assert_int_equal(ms_chart_pareto(front, point, 0), 0);
}

static void read_text(char *text, size_t size, const char *path)
{
    ms_error err;
    ms_bytes bytes;
    if (ms_file_read(&bytes, path, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
    assert_true(bytes.size < size);
    memcpy(text, bytes.data, bytes.size + 1);
    ms_file_free(&bytes);
    assert_int_equal(remove(path), 0);
}

/* Points without a place are left out, small values lifted, names and labels quoted. */
static void what_the_files_hold(void **state)
{
    (void)state;
    char text[8192];
    ms_error err;
    const ms_chart_point first[] = {
        {1, 0, "a", 0}, {10, 0.25, "i\"t", 0}, {0, 0.5, "gone", 0}, {(double)NAN, 1, "gone", 0}};
    const ms_chart_point none[] = {{-1, 1, "gone", 0}};
    const ms_chart_series series[] = {{"nothing", MS_CHART_CURVE, 1, none}, {"o'ne\n", MS_CHART_CURVE, 4, first}};
    const ms_chart chart = {.title = "t",
                            .x_label = "x",
                            .y_label = "y",
                            .x_log = 1,
                            .y_log = 1,
                            .y_least = 0.125,
                            .n_series = 2,
                            .series = series};
    assert_int_equal(ms_chart_write(&chart, "test-chart", &err), MS_OK);
    read_text(text, sizeof text, "test-chart.dat");
    assert_string_equal(text, "# x y label: \"o\\047ne?\"\n1 0.125 \"a\"\n10 0.25 \"i?t\"\n\n\n");
    read_text(text, sizeof text, "test-chart.gp");
    assert_non_null(strstr(text, "set xrange [0.8:12.5]"));
    assert_non_null(strstr(text, "set yrange [0.1:0.3125]"));
    assert_non_null(strstr(text, "title \"o\\047ne?\""));
    assert_non_null(strstr(text, "set ylabel 'y (0.125: that or less)'"));
    assert_null(strstr(text, "nothing"));
}

/* A band spans its axis up to its upper edge, and has the colour of the curve behind it. */
static void a_band_has_two_edges(void **state)
{
    (void)state;
    char text[8192];
    ms_error err;
    const ms_chart_point band[] = {{.x = 1, .y = 2, .top = 6}, {.x = 2, .y = 3, .top = 12}};
    const ms_chart_point curve[] = {{.x = 1, .y = 4}, {.x = 2, .y = 5}};
    const ms_chart_series series[] = {{"s", MS_CHART_BAND, 2, band}, {"s", MS_CHART_CURVE, 2, curve}};
    const ms_chart chart = {.title = "t", .x_label = "x", .y_label = "y", .n_series = 2, .series = series};
    assert_int_equal(ms_chart_write(&chart, "test-band", &err), MS_OK);
    read_text(text, sizeof text, "test-band.dat");
    assert_non_null(strstr(text, "1 2 6 \"\"\n2 3 12 \"\"\n"));
    read_text(text, sizeof text, "test-band.gp");
    assert_non_null(strstr(text, "set yrange [1.5:12.5]"));
    assert_non_null(strstr(text, "using 1:2:3 with filledcurves fc rgb '#000000'"));
    assert_non_null(strstr(text, "lc rgb '#000000' title"));
}

static void what_is_refused(void **state)
{
    (void)state;
    ms_error err;
    const ms_chart_point point[] = {{1, 1, "", 0}};
    const ms_chart_series series[] = {{"s", MS_CHART_CURVE, 0, point}};
    ms_chart chart = {.title = "t", .x_label = "x", .y_label = "y", .n_series = 1, .series = series};
    assert_int_equal(ms_chart_write(&chart, "test-none", &err), MS_ERR_ARG);
    assert_non_null(strstr(err.text, "no points"));
    const ms_chart_series one[] = {{"s", MS_CHART_CURVE, 1, point}};
    chart.series = one;
    assert_int_equal(ms_chart_write(&chart, "no/such/folder/c", &err), MS_ERR_IO);
    assert_non_null(strstr(err.text, "no/such/folder/c.dat"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pareto_against_brute_force),
        cmocka_unit_test(pareto_without_numbers),
        cmocka_unit_test(what_the_files_hold),
        cmocka_unit_test(a_band_has_two_edges),
        cmocka_unit_test(what_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
