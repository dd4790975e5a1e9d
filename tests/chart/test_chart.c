/* Charts: the Pareto front against brute force, what the files hold. */
#include "base/ms_file.h"
#include "chart/ms_chart_parts.h"
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
    const ms_chart_point point[] = {{.x = (double)NAN, .y = 0, .label = ""},
                                    {.x = 2.385, .y = 1.7, .label = "a"},
                                    {.x = 0, .y = HUGE_VAL, .label = ""},
                                    {.x = -HUGE_VAL, .y = 0, .label = ""}};
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
    const ms_chart_point first[] = {{.x = 1, .y = 0, .label = "a"},
                                    {.x = 10, .y = 0.25, .label = "i\"t"},
                                    {.x = 0, .y = 0.5, .label = "gone"},
                                    {.x = (double)NAN, .y = 1, .label = "gone"}};
    const ms_chart_point none[] = {{.x = -1, .y = 1, .label = "gone"}};
    const ms_chart_series series[] = {{.name = "nothing", .style = MS_CHART_CURVE, .count = 1, .point = none},
                                      {.name = "o'ne\n", .style = MS_CHART_CURVE, .count = 4, .point = first}};
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
    const ms_chart_series series[] = {{.name = "s", .style = MS_CHART_BAND, .count = 2, .point = band},
                                      {.name = "s", .style = MS_CHART_CURVE, .count = 2, .point = curve}};
    const ms_chart chart = {.title = "t", .x_label = "x", .y_label = "y", .n_series = 2, .series = series};
    assert_int_equal(ms_chart_write(&chart, "test-band", &err), MS_OK);
    read_text(text, sizeof text, "test-band.dat");
    assert_non_null(strstr(text, "1 2 6 \"\"\n2 3 12 \"\"\n"));
    read_text(text, sizeof text, "test-band.gp");
    assert_non_null(strstr(text, "set yrange [1.5:12.5]"));
    assert_non_null(strstr(text, "using 1:2:3 with filledcurves fc rgb '#000000'"));
    assert_non_null(strstr(text, "lc rgb '#000000' title"));
}

/* Enough of a crowd that some labels find room and some do not. */
static ms_chart_series make_crowd(ms_chart_point *point, size_t count, const char *name, double offset)
{
    for (size_t p = 0; p < count; p++) {
        const double x = 1 + (double)((7 * p + 3) % count);
        point[p] =
            (ms_chart_point){.x = x, .y = offset + 0.1 * (double)((5 * p) % count), .low = 0.9 * x, .high = 1.1 * x};
        snprintf(point[p].label, sizeof point[p].label, "%zu", 10 * p);
    }
    return (ms_chart_series){.name = name, .style = MS_CHART_CURVE, .count = count, .point = point};
}

static double distance_to_line(double x, double y, const double p[2], const double q[2])
{
    const double u[2] = {q[0] - p[0], q[1] - p[1]}, square = u[0] * u[0] + u[1] * u[1];
    const double t = square > 0 ? fmin(1, fmax(0, ((x - p[0]) * u[0] + (y - p[1]) * u[1]) / square)) : 0;
    return hypot(x - p[0] - t * u[0], y - p[1] - t * u[1]);
}

/* How near a spot of a label comes to any point, line or bar of a curve, pixels. */
static double find_nearest(double x, double y, const ms_chart_frame *f, const ms_chart_series *series)
{
    double nearest = HUGE_VAL, before[2] = {0};
    for (size_t p = 0; p < series->count; p++) {
        const ms_chart_point *point = &series->point[p];
        const double scale[2] = {f->width / (f->x.hi - f->x.lo), f->height / (f->y.hi - f->y.lo)};
        const double at[2] = {scale[0] * (point->x - f->x.lo), scale[1] * (point->y - f->y.lo)};
        const double lo[2] = {scale[0] * (point->low - f->x.lo), at[1]};
        const double hi[2] = {scale[0] * (point->high - f->x.lo), at[1]};
        nearest = fmin(nearest, hypot(x - at[0], y - at[1]) - 6);
        nearest = fmin(nearest, distance_to_line(x, y, lo, hi));
        nearest = fmin(nearest, p > 0 ? distance_to_line(x, y, before, at) : HUGE_VAL);
        memcpy(before, at, sizeof before);
    }
    return nearest;
}

/* Spot by spot: what a label covers is on no point, line, bar or other label. */
static void labels_lie_on_nothing(void **state)
{
    enum { COUNT = 11 };
    (void)state;
    ms_chart_point one[COUNT], two[COUNT];
    ms_chart_place place[2 * COUNT];
    const ms_chart_series series[] = {make_crowd(one, COUNT, "one", 0), make_crowd(two, COUNT, "two", 0.03)};
    const ms_chart chart = {.n_series = 2, .series = series};
    const ms_chart_frame frame = {.x = {0, 12.5}, .y = {-0.1, 1.3}, .width = 680, .height = 480};
    const size_t count = ms_chart_labels_place(place, &frame, &chart);
    assert_in_range(count, COUNT / 2, 2 * COUNT);
    for (size_t k = 0; k < count; k++) {
        const double half[2] = {3.5 * (double)strlen(place[k].text), 6};
        const double middle[2] = {place[k].x * frame.width, place[k].y * frame.height};
        for (double x = middle[0] - half[0]; x <= middle[0] + half[0]; x += 1) {
            for (double y = middle[1] - half[1]; y <= middle[1] + half[1]; y += 1) {
                assert_true(x > 0 && y > 0 && x < frame.width && y < frame.height);
                assert_true(find_nearest(x, y, &frame, &series[0]) > 0);
                assert_true(find_nearest(x, y, &frame, &series[1]) > 0);
            }
        }
        for (size_t other = 0; other < k; other++) {
            const double apart[2] = {fabs(place[other].x * frame.width - middle[0]),
                                     fabs(place[other].y * frame.height - middle[1])};
            assert_true(apart[1] >= 2 * half[1] || apart[0] >= half[0] + 3.5 * (double)strlen(place[other].text));
        }
    }
}

/* Where a run of more spheres gives the same clump, one label is enough. */
static void one_label_of_two_points_in_a_place(void **state)
{
    (void)state;
    ms_chart_place place[3];
    ms_chart_point point[] = {
        {.x = 1, .y = 1, .label = "53"}, {.x = 1.01, .y = 1, .label = "53"}, {.x = 5, .y = 1, .label = "53"}};
    const ms_chart_series series = {.name = "s", .style = MS_CHART_CURVE, .count = 3, .point = point};
    const ms_chart chart = {.n_series = 1, .series = &series};
    const ms_chart_frame frame = {.x = {0, 6}, .y = {0, 2}, .width = 680, .height = 480};
    assert_int_equal(ms_chart_labels_place(place, &frame, &chart), 2);
    strcpy(point[1].label, "54");
    assert_int_equal(ms_chart_labels_place(place, &frame, &chart), 3);
}

/* One point, or one of each curve by x, is told in words; with a front, or of points alone, two are a chart. */
static void a_point_is_no_chart(void **state)
{
    (void)state;
    const ms_chart_point point[] = {{.x = 20, .y = 0.25}, {.x = 30, .y = 0.125}};
    ms_chart_series series[] = {{.name = "mss", .style = MS_CHART_CURVE, .count = 1, .point = point},
                                {.name = "fcm", .style = MS_CHART_CURVE, .count = 1, .point = point + 1},
                                {.name = "line", .style = MS_CHART_LINE, .count = 2, .point = point}};
    ms_chart chart = {.x_label = "n", .y_label = "D", .n_series = 3, .series = series};
    char *said = NULL;
    size_t size;
    assert_false(ms_chart_is_one(&chart));
    FILE *stream = open_memstream(&said, &size);
    assert_non_null(stream);
    ms_chart_say(stream, &chart, "a");
    chart.n_series = 0;
    ms_chart_say(stream, &chart, "b");
    chart.n_series = 3;
    fclose(stream);
    assert_string_equal(said, "no chart a, but words: mss: n 20, D 0.25; fcm: n 30, D 0.125\n"
                              "no chart b: none of its points has a place on the axes\n");
    free(said);
    series[2].style = MS_CHART_FRONT;
    assert_true(ms_chart_is_one(&chart));
    series[1].count = 0;
    assert_false(ms_chart_is_one(&chart));
    series[2].style = MS_CHART_LINE;
    series[0].count = 2;
    assert_true(ms_chart_is_one(&chart));
}

/* Bars widen the axis and stand behind their points; a level runs from end to end of it. */
static void bars_and_levels(void **state)
{
    (void)state;
    char text[8192];
    ms_error err;
    const ms_chart_point timed[] = {{.x = 4, .y = 1, .low = 2, .high = 8}, {.x = 10, .y = 3, .low = 9, .high = 11}};
    const ms_chart_point level[] = {{.x = (double)NAN, .y = 2, .label = "7"}};
    const ms_chart_series series[] = {
        {.name = "s", .style = MS_CHART_CURVE, .count = 2, .point = timed, .look = {3, 0}},
        {.name = "l", .style = MS_CHART_LEVEL, .count = 1, .point = level, .look = {MS_CHART_LOOK_OTHER, 2}}};
    const ms_chart chart = {
        .title = "t", .note = "how", .x_label = "x", .y_label = "y", .n_series = 2, .series = series};
    assert_int_equal(ms_chart_write(&chart, "test-bars", &err), MS_OK);
    read_text(text, sizeof text, "test-bars.dat");
    assert_non_null(strstr(text, "4 1 \"\" 2 8\n10 3 \"\" 9 11\n"));
    assert_non_null(strstr(text, "1.55 2 \"7\"\n11.45 2 \"7\"\n"));
    read_text(text, sizeof text, "test-bars.gp");
    assert_non_null(strstr(text, "set xrange [1.55:11.45]"));
    assert_non_null(strstr(text, "using 1:2:4:5 with xerrorbars pt 0 lw 1.5 lc rgb '#0072b2'"));
    assert_non_null(strstr(text, "index 1 using 1:2 with lines dt 3 lw 2 lc rgb '#777777'"));
    assert_null(strstr(text, "'7'"));
    assert_non_null(strstr(text, "'how' at graph 0.5,1 center"));
}

/* A look does not go by the place; options are other points in the same colour. */
static void looks_belong_to_what_they_are_of(void **state)
{
    (void)state;
    for (int family = 1; family <= 7; family++) {
        const ms_chart_look plain = {family, 0}, other = {family, ms_chart_look_variant("boost=2")};
        assert_string_equal(ms_chart_look_colour(plain, 0), ms_chart_look_colour(plain, 5));
        assert_int_equal(ms_chart_look_point(plain, 0), ms_chart_look_point(plain, 5));
        assert_string_equal(ms_chart_look_colour(plain, 0), ms_chart_look_colour(other, 0));
        assert_int_not_equal(ms_chart_look_point(plain, 0), ms_chart_look_point(other, 0));
        for (int before = 1; before < family; before++) {
            const ms_chart_look first = {before, 0};
            assert_string_not_equal(ms_chart_look_colour(plain, 0), ms_chart_look_colour(first, 0));
            assert_int_not_equal(ms_chart_look_point(plain, 0), ms_chart_look_point(first, 0));
        }
    }
    assert_string_equal(ms_chart_look_colour((ms_chart_look){0}, 1), ms_chart_look_colour((ms_chart_look){2, 0}, 0));
}

/* These two options have one variant by chance; a band and its curve are of one name and stay alike. */
static void looks_of_one_chart_differ(void **state)
{
    (void)state;
    const ms_chart_look look = {3, ms_chart_look_variant("spacing=1.5")};
    assert_int_equal(ms_chart_look_variant("spacing=2"), look.variant);
    char name[24][8];
    ms_chart_series series[24];
    for (int s = 0; s < 24; s++) {
        snprintf(name[s], sizeof name[s], "%d", s / 2);
        series[s] = (ms_chart_series){.name = name[s], .style = s % 2 ? MS_CHART_CURVE : MS_CHART_BAND, .look = look};
    }
    ms_chart_part_looks(series, 24);
    for (int s = 0; s < 20; s++) {
        assert_int_equal(series[s].look.family, 3);
        for (int before = 0; before < s; before++) {
            assert_int_equal(ms_chart_look_point(series[s].look, 0) == ms_chart_look_point(series[before].look, 0),
                             s / 2 == before / 2);
        }
    }
    assert_int_equal(series[0].look.variant, look.variant);
}

static void what_is_refused(void **state)
{
    (void)state;
    ms_error err;
    const ms_chart_point point[] = {{.x = 1, .y = 1, .label = ""}};
    const ms_chart_series series[] = {{.name = "s", .style = MS_CHART_CURVE, .count = 0, .point = point}};
    ms_chart chart = {.title = "t", .x_label = "x", .y_label = "y", .n_series = 1, .series = series};
    assert_int_equal(ms_chart_write(&chart, "test-none", &err), MS_ERR_ARG);
    assert_non_null(strstr(err.text, "no points"));
    const ms_chart_series one[] = {{.name = "s", .style = MS_CHART_CURVE, .count = 1, .point = point}};
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
        cmocka_unit_test(labels_lie_on_nothing),
        cmocka_unit_test(one_label_of_two_points_in_a_place),
        cmocka_unit_test(a_point_is_no_chart),
        cmocka_unit_test(bars_and_levels),
        cmocka_unit_test(looks_belong_to_what_they_are_of),
        cmocka_unit_test(looks_of_one_chart_differ),
        cmocka_unit_test(what_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
