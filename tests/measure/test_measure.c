/* The table of measures: complete, in agreement with its structs, and what the guide says of each. */
#include "support/test_support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "measure/ms_measure.h"
#include "measure/ms_metrics.h"

static void rows_are_complete(void **state)
{
    (void)state;
    int count = 0;
    for (const ms_measure *m = ms_measures; m->name; m++, count++) {
        assert_true(m->name[0] && m->label[0] && m->source[0] && strlen(m->help) > 2);
        assert_true(ms_measure_column(m, m->in_compare)[0] && ms_measure_column(m, m->in_stability)[0] &&
                    m->of_metrics);
        assert_int_equal(ms_measure_is_of_score(m),
                         m->kind == MS_MEASURE_KIND_GOAL || m->kind == MS_MEASURE_KIND_UNION);
        assert_true(!m->curve || ms_measure_is_of_score(m)); /* a curve is made of scores */
        assert_true(m->kind != MS_MEASURE_KIND_GOAL || m->better <= MS_BETTER_MORE);
        for (const ms_measure *other = ms_measures; other < m; other++) {
            assert_string_not_equal(other->name, m->name);
        }
    }
    assert_int_equal(count, MS_MEASURES);
}

static void each_row_gives_its_own_field(void **state)
{
    (void)state;
    const ms_metrics metrics = {
        .score =
            {.eta = 1, .dice = 2, .coverage = 3, .overshoot = 4, .off_volume = 5, .inertia = 18, .coverage_cut = 19},
        .protrusion_max = 6,
        .protrusion_rms = 7,
        .gap_max = 8,
        .gap_rms = 9,
        .normal_median = 10,
        .normal_95 = 11,
        .edge_part = 12,
        .edge_normal_median = 13,
        .edge_normal_95 = 14,
        .smallest_radius_ratio = 15,
        .work = 16,
        .pieces = 17,
        .voxel_limit = 20,
        .shape_equivalent_diameter = 21,
        .clump_equivalent_diameter = 22,
        .shape_area = 23,
        .clump_area = 24,
        .shape_sphericity = 25,
        .clump_sphericity = 26,
        .shape_elongation = 27,
        .clump_elongation = 28,
        .shape_flatness = 29,
        .clump_flatness = 30,
        .shape_feret_elongation = 31,
        .clump_feret_elongation = 32,
        .shape_feret_flatness = 33,
        .clump_feret_flatness = 34,
        .shape_corey = 35,
        .clump_corey = 36,
        .shape_convexity = 37,
        .clump_convexity = 38};
    for (int m = 0; m < MS_MEASURES; m++) {
        assert_true(ms_measures[m].of_metrics(&metrics) == m + 1);
        assert_true(!ms_measures[m].of_score || ms_measures[m].of_score(&metrics.score) == m + 1);
    }
}

static void what_is_reached_follows_what_is_better(void **state)
{
    (void)state;
    const ms_measure *dice = &ms_measures[MS_MEASURE_DICE], *coverage = &ms_measures[MS_MEASURE_COVERAGE];
    assert_true(ms_measure_is_reached(dice, 0.25, 0.25) && ms_measure_is_reached(dice, 0.24, 0.25));
    assert_false(ms_measure_is_reached(dice, 0.26, 0.25));
    assert_true(ms_measure_is_reached(coverage, 0.25, 0.25) && ms_measure_is_reached(coverage, 0.26, 0.25));
    assert_false(ms_measure_is_reached(coverage, 0.24, 0.25));
    assert_false(ms_measure_is_reached(dice, (double)NAN, 1) || ms_measure_is_reached(coverage, (double)NAN, 0.1));
}

static void goals_are_found_by_name(void **state)
{
    (void)state;
    for (const ms_measure *m = ms_measures; m->name; m++) {
        ms_error err = {{0}};
        const ms_measure *found = ms_measure_find_goal(m->name, &err);
        assert_ptr_equal(found, m->kind == MS_MEASURE_KIND_GOAL ? m : NULL);
        if (!found) {
            assert_non_null(strstr(err.text, "choose from eta, dice, coverage, inertia, coverage_cut"));
        }
    }
    assert_string_equal(MS_MEASURE_GOAL_NAMES, "eta, dice, coverage, inertia, coverage_cut, ");
    assert_string_equal(MS_MEASURE_CURVE_NAMES, ",eta,dice,coverage,overshoot");
}

/* In a table of Markdown a bar is escaped. */
static void add_escaped(char *row, const char *text)
{
    char *at = row + strlen(row);
    for (; *text; text++) {
        if (*text == '|') {
            *at++ = '\\';
        }
        *at++ = *text;
    }
    *at = 0;
}

/* A row of the table of descriptors. */
static void expect_row(const char *guide, const char *label, const char *names, const char *help, const char *unit,
                       const char *source)
{
    char row[1024];
    snprintf(row, sizeof row, "| %s | %s | %s | %s | %s |\n", label, names, help, unit ? unit : "-", source);
    if (!strstr(guide, row)) {
        fail_msg("docs/guide.md lacks this row of the table of descriptors:\n%s", row);
    }
}

/* The guide's tables are these. */
static void the_guide_has_the_table(void **state)
{
    (void)state;
    static const char *const BEST[] = {[MS_BETTER_LESS] = "less",
                                       [MS_BETTER_MORE] = "more",
                                       [MS_BETTER_ONE] = "1",
                                       [MS_BETTER_SHAPE] = "the shape's",
                                       [MS_BETTER_NONE] = "-"};
    static char text[65536];
    char path[512];
    snprintf(path, sizeof path, "%s/guide.md", getenv("MSKIT_DOCS"));
    FILE *guide = fopen(path, "r");
    assert_non_null(guide);
    text[fread(text, 1, sizeof text - 1, guide)] = 0;
    fclose(guide);
    for (const ms_measure *m = ms_measures; m->name; m++) {
        char row[1024] = "| ";
        if (m->kind == MS_MEASURE_KIND_DESCRIPTOR && m != &ms_measures[MS_MEASURE_VOXEL_LIMIT]) {
            continue; /* shape and clump are a row there */
        }
        add_escaped(row, m->label);
        strcat(strcat(strcat(row, " | `"), m->name), "` | ");
        add_escaped(row, m->help);
        const size_t used = strlen(row);
        snprintf(row + used, sizeof row - used, " | %s | %s | %s |\n", BEST[m->better], m->unit ? m->unit : "-",
                 m->source);
        if (!strstr(text, row)) {
            fail_msg("docs/guide.md lacks this row of the table of measures:\n%s", row);
        }
    }
#define FIND(X, CODE, name, digits, unit, label, source, help) \
    expect_row(text, label, "`shape_" #name "`, `clump_" #name "`", help, unit, source);
    MS_DESCRIPTOR_LIST(FIND, )
#undef FIND
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_are_complete),
        cmocka_unit_test(each_row_gives_its_own_field),
        cmocka_unit_test(what_is_reached_follows_what_is_better),
        cmocka_unit_test(goals_are_found_by_name),
        cmocka_unit_test(the_guide_has_the_table),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
