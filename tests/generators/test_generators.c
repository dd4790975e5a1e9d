/* The contract of generators, checked on every one in the table; the first test fails if its docs page is missing. */
#include "support/test_support.h"

#include <omp.h>
#include <stdlib.h>

#include "measure/ms_metrics.h"
#include "ms_generator.h"
#include "support/generator_samples.h"

/* What is checked: the table, and a plain one that promises no quality; ends with NULL. */
enum { MOST_GENERATORS = 32 };
static const ms_generator *checked[MOST_GENERATORS];

static void list_generators(void)
{
    size_t count = 0;
    for (const ms_generator *const *g = ms_generators; *g; g++) {
        assert_true(count < MOST_GENERATORS - 2);
        checked[count++] = *g;
    }
    checked[count] = &deepest_generator;
}

typedef struct outcome {
    ms_clump clump;
    ms_stop_reason reason;
} outcome;

static ms_status try_run(outcome *o, const ms_generator *g, const ms_target *target, ms_stop stop, ms_error *err)
{
    ms_settings settings;
    assert_int_equal(ms_option_settings_init(&settings, g->options, err), MS_OK);
    const ms_run run = {.target = target, .stop = stop, .settings = &settings, .seed = 7};
    ms_status status = ms_generator_run(&o->clump, &o->reason, g, &run, err);
    ms_option_settings_free(&settings);
    return status;
}

static outcome run_with(const ms_generator *g, const ms_target *target, ms_stop stop)
{
    outcome o;
    ms_error err;
    if (try_run(&o, g, target, stop, &err) != MS_OK) {
        fail_msg("%s: %s", g->name, err.text);
    }
    return o;
}

static outcome run_spheres(const ms_generator *g, const ms_target *target, size_t spheres)
{
    ms_stop stop = {0};
    stop.spheres = spheres;
    return run_with(g, target, stop);
}

static void assert_same_spheres(const ms_clump *a, const ms_clump *b, size_t count)
{
    assert_true(a->n_spheres >= count && b->n_spheres >= count);
    assert_memory_equal(a->sphere, b->sphere, count * sizeof *a->sphere);
}

static ms_score score_of(const ms_clump *clump, const ms_target *target)
{
    ms_score score;
    ms_error err;
    if (ms_metrics_score_clump(&score, NULL, target, clump, 1u << 28, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
    return score;
}

/* A lump without symmetry, and one with. */
typedef struct fixture {
    ms_mesh grain, tablet;
    ms_target rough, smooth;
} fixture;

static int set_up(void **state)
{
    static fixture f;
    list_generators();
    make_shape(&f.grain, "grain", "fineness=12");
    make_shape(&f.tablet, "tablet", "fineness=12");
    make_target(&f.rough, &f.grain, 26, MS_VOXEL_HALF);
    make_target(&f.smooth, &f.tablet, 31, MS_VOXEL_CENTRE);
    *state = &f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    ms_target_free(&f->rough);
    ms_target_free(&f->smooth);
    ms_mesh_free(&f->grain);
    ms_mesh_free(&f->tablet);
    return 0;
}

static void every_generator_is_complete(void **state)
{
    (void)state;
    for (const ms_generator *const *g = ms_generators; *g; g++) {
        char page[512];
        assert_true((*g)->name && (*g)->summary && (*g)->source && (*g)->options && (*g)->generate);
        snprintf(page, sizeof page, "%s/methods/%s.md", getenv("MSKIT_DOCS"), (*g)->name);
        FILE *docs = fopen(page, "r");
        assert_non_null(docs);
        fclose(docs);
    }
}

/* Every option is named in the docs page, has a help text and a default within its range. */
static void options_are_documented(void **state)
{
    (void)state;
    for (const ms_generator *const *g = ms_generators; *g; g++) {
        static char text[65536];
        char page[512];
        snprintf(page, sizeof page, "%s/methods/%s.md", getenv("MSKIT_DOCS"), (*g)->name);
        FILE *docs = fopen(page, "r");
        assert_non_null(docs);
        text[fread(text, 1, sizeof text - 1, docs)] = 0;
        fclose(docs);
        for (const ms_option *o = (*g)->options; o->name; o++) {
            char quoted[64];
            snprintf(quoted, sizeof quoted, "`%s`", o->name);
            assert_non_null(strstr(text, quoted));
            assert_true(o->help && strlen(o->help) > 10);
            if (o->type == MS_OPTION_REAL || o->type == MS_OPTION_INTEGER) {
                assert_true(o->fallback >= o->min && o->fallback <= o->max);
            }
        }
    }
}

static void asked_number_is_given(void **state)
{
    fixture *f = *state;
    for (const ms_generator *const *g = checked; *g; g++) {
        static const size_t ASKED[] = {1, 2, 7, 23};
        for (size_t a = 0; a < sizeof ASKED / sizeof *ASKED; a++) {
            outcome o = run_spheres(*g, &f->rough, ASKED[a]);
            assert_int_equal(o.clump.n_spheres, ASKED[a]);
            assert_int_equal(o.reason, MS_STOP_SPHERES);
            ms_clump_free(&o.clump);
        }
    }
}

/* In the frame of the mesh, with finite centres and positive radii, overlapping the body. */
static void spheres_are_sane(void **state)
{
    fixture *f = *state;
    for (const ms_generator *const *g = checked; *g; g++) {
        outcome o = run_spheres(*g, &f->smooth, 20);
        double lo[3], hi[3];
        ms_mesh_box(lo, hi, &f->tablet);
        for (size_t s = 0; s < o.clump.n_spheres; s++) {
            const ms_sphere *sphere = &o.clump.sphere[s];
            assert_true(isfinite(sphere->radius) && sphere->radius > 0);
            for (int a = 0; a < 3; a++) {
                assert_true(sphere->centre[a] > lo[a] && sphere->centre[a] < hi[a]);
            }
        }
        const ms_score score = score_of(&o.clump, &f->smooth);
        assert_true((*g)->baseline || (score.dice < 0.3 && score.coverage > 0.6));
        ms_clump_free(&o.clump);
    }
}

static void prefixes_are_clumps(void **state)
{
    fixture *f = *state;
    for (const ms_generator *const *g = checked; *g; g++) {
        if (!(*g)->nested) {
            continue;
        }
        outcome whole = run_spheres(*g, &f->rough, 23), part = run_spheres(*g, &f->rough, 9);
        assert_same_spheres(&whole.clump, &part.clump, 9);
        ms_clump_free(&whole.clump);
        ms_clump_free(&part.clump);
    }
}

/* On a finer grid, since short loops are one thread's. */
static void threads_do_not_matter(void **state)
{
    const fixture *f = *state;
    const int before = omp_get_max_threads();
    ms_target fine;
    make_target(&fine, &f->grain, 40, MS_VOXEL_HALF);
    for (const ms_generator *const *g = checked; *g; g++) {
        omp_set_num_threads(1);
        outcome alone = run_spheres(*g, &fine, 23);
        for (int threads = 2; threads <= 5; threads += 3) {
            omp_set_num_threads(threads);
            outcome team = run_spheres(*g, &fine, 23);
            assert_same_spheres(&alone.clump, &team.clump, 23);
            ms_clump_free(&team.clump);
        }
        ms_clump_free(&alone.clump);
    }
    ms_target_free(&fine);
    omp_set_num_threads(before);
}

/* A mesh scaled by a power of two and moved by as much as its box gives the same clump, scaled and moved. */
static void frame_follows_the_mesh(void **state)
{
    fixture *f = *state;
    for (const ms_generator *const *g = checked; *g; g++) {
        ms_mesh moved;
        ms_target target;
        outcome here = run_spheres(*g, &f->rough, 12);
        make_shape(&moved, "grain", "fineness=12");
        for (size_t v = 0; v < moved.n_vertices; v++) {
            for (int a = 0; a < 3; a++) {
                moved.vertex[v][a] = 8 * moved.vertex[v][a] + 1024 * (a + 1);
            }
        }
        make_target(&target, &moved, 26, MS_VOXEL_HALF);
        outcome there = run_spheres(*g, &target, 12);
        for (size_t s = 0; s < 12; s++) {
            for (int a = 0; a < 3; a++) {
                assert_close(there.clump.sphere[s].centre[a], 8 * here.clump.sphere[s].centre[a] + 1024 * (a + 1),
                             1e-6);
            }
            assert_close(there.clump.sphere[s].radius, 8 * here.clump.sphere[s].radius, 1e-6);
        }
        ms_clump_free(&here.clump);
        ms_clump_free(&there.clump);
        ms_target_free(&target);
        ms_mesh_free(&moved);
    }
}

/* A baseline need not get as far, and says so. */
static int gave_up(const ms_generator *g, const outcome *o)
{
    return g->baseline && o->reason == MS_STOP_EXHAUSTED;
}

/* The run ends with the first sphere that makes the measure good enough. */
static void check_measure(const ms_generator *g, const ms_target *target, ms_stop stop, ms_stop_reason wanted)
{
    outcome o = run_with(g, target, stop);
    if (gave_up(g, &o)) {
        ms_clump_free(&o.clump);
        return;
    }
    const ms_score end = score_of(&o.clump, target);
    assert_int_equal(o.reason, wanted);
    assert_true(stop.eta == 0 || end.eta <= stop.eta);
    assert_true(stop.dice == 0 || end.dice <= stop.dice);
    assert_true(stop.coverage == 0 || end.coverage >= stop.coverage);
    if (g->nested && o.clump.n_spheres > 1) {
        o.clump.n_spheres--;
        const ms_score before = score_of(&o.clump, target);
        assert_true(stop.eta == 0 || before.eta > stop.eta);
        assert_true(stop.dice == 0 || before.dice > stop.dice);
        assert_true(stop.coverage == 0 || before.coverage < stop.coverage);
    }
    ms_clump_free(&o.clump);
}

static void measures_end_the_run(void **state)
{
    fixture *f = *state;
    for (const ms_generator *const *g = checked; *g; g++) {
        ms_stop stop = {0};
        stop.eta = 0.25;
        check_measure(*g, &f->rough, stop, MS_STOP_ETA);
        stop = (ms_stop){0};
        stop.dice = 0.11;
        check_measure(*g, &f->rough, stop, MS_STOP_DICE);
        stop = (ms_stop){0};
        stop.coverage = 0.83;
        check_measure(*g, &f->rough, stop, MS_STOP_COVERAGE);
        stop.coverage = 0.99; /* the first of several rules that holds */
        stop.spheres = 3;
        outcome o = run_with(*g, &f->rough, stop);
        assert_int_equal(o.reason, MS_STOP_SPHERES);
        ms_clump_free(&o.clump);
    }
}

static void inertia_ends_the_run(void **state)
{
    fixture *f = *state;
    for (const ms_generator *const *g = checked; *g; g++) {
        ms_stop stop = {0};
        ms_metrics metrics;
        ms_error err;
        stop.inertia = 0.3;
        outcome o = run_with(*g, &f->rough, stop);
        assert_true(o.reason == MS_STOP_INERTIA || gave_up(*g, &o));
        assert_int_equal(ms_metrics_compute_kinds(&metrics, NULL, 0, &f->rough, &o.clump, 1u << 28, &err), MS_OK);
        assert_true(metrics.inertia.weighted <= 0.3 || gave_up(*g, &o));
        ms_clump_free(&o.clump);
    }
}

static void least_radius_is_kept(void **state)
{
    fixture *f = *state;
    for (const ms_generator *const *g = checked; *g; g++) {
        ms_stop stop = {0};
        stop.radius = 0.7 * ms_target_equivalent_radius(&f->rough);
        outcome o = run_with(*g, &f->rough, stop);
        assert_int_equal(o.reason, MS_STOP_RADIUS);
        assert_true(ms_clump_smallest_radius(&o.clump) >= stop.radius);
        ms_clump_free(&o.clump);
    }
}

static void nothing_asked_is_an_error(void **state)
{
    fixture *f = *state;
    for (const ms_generator *const *g = checked; *g; g++) {
        outcome o;
        ms_error err;
        ms_stop stop = {0};
        assert_int_equal(try_run(&o, *g, &f->rough, stop, &err), MS_ERR_ARG);
        assert_int_equal(o.clump.n_spheres, 0);
        const ms_settings others = {.options = NULL};
        const ms_run mixed = {.target = &f->rough, .stop = {.spheres = 3}, .settings = &others};
        assert_int_equal(ms_generator_run(&o.clump, &o.reason, *g, &mixed, &err), MS_ERR_ARG);
        stop.radius = 1e9; /* no sphere is as large */
        assert_int_equal(try_run(&o, *g, &f->rough, stop, &err), MS_ERR_SHAPE);
        assert_int_equal(o.clump.n_spheres, 0);
        stop.spheres = MS_CLUMP_MAX_SPHERES + 1;
        assert_int_equal(try_run(&o, *g, &f->rough, stop, &err), MS_ERR_LIMIT);
    }
}

/* Walls of 0.6 and 0.9 voxels: spheres between them may hold centres of voxels and yet cover none of them by more than
 * half. Such a clump is no result. */
static void spheres_that_cover_nothing_are_no_clump(void **state)
{
    (void)state;
    ms_mesh mesh;
    make_shape(&mesh, "hollow", "r=0.97 fineness=12");
    int refused = 0;
    for (double cells = 40; cells <= 60; cells += 20) {
        ms_target target;
        make_target(&target, &mesh, cells, MS_VOXEL_HALF);
        for (const ms_generator *const *g = checked; *g; g++) {
            outcome o;
            ms_error err = {{0}};
            const ms_stop stop = {.spheres = 10};
            const ms_status status = try_run(&o, *g, &target, stop, &err);
            if (status == MS_OK) {
                assert_true(score_of(&o.clump, &target).coverage > 0);
            } else {
                assert_int_equal(status, MS_ERR_SHAPE);
                assert_int_equal(o.clump.n_spheres, 0);
                refused += strstr(err.text, "cover no voxel of the shape; use more cells") != NULL;
            }
            ms_clump_free(&o.clump);
        }
        ms_target_free(&target);
    }
    assert_true(refused > 0);
    ms_mesh_free(&mesh);
}

/* What a listener has heard. */
typedef struct heard {
    size_t stages, before; /* of them before the first sphere */
    size_t most;           /* stages, after which the run is to end; 0: any number */
    int has_spheres, failed;
    double share;
} heard;

static int hear_stage(void *context, const char *stage, double share)
{
    heard *h = context;
    h->stages++;
    h->before += !h->has_spheres;
    h->failed |= stage[0] == '\0' || strlen(stage) > 47 || share < h->share || share < 0 || share > 1;
    h->share = isnan(share) ? h->share : share;
    return h->stages == h->most;
}

static int hear_spheres(void *context, size_t spheres, double dice)
{
    heard *h = context;
    h->has_spheres |= spheres > 0 && !isnan(dice);
    return 0;
}

/* Shares are of the whole run and never fall. */
static void what_a_run_tells(void **state)
{
    const fixture *f = *state;
    for (const ms_generator *const *g = checked; *g; g++) {
        heard h = {0};
        const ms_run run = {.target = &f->rough,
                            .stop = {.spheres = 12},
                            .seed = 7,
                            .progress = hear_spheres,
                            .progress_context = &h,
                            .stage = hear_stage,
                            .stage_context = &h};
        outcome o;
        assert_int_equal(ms_generator_run(&o.clump, &o.reason, *g, &run, NULL), MS_OK);
        ms_clump_free(&o.clump);
        assert_true(h.has_spheres);
        assert_false(h.failed);
        if (strcmp((*g)->name, "setcover") == 0 || strcmp((*g)->name, "variational") == 0) {
            assert_true(h.before >= 2); /* they take long to their first sphere */
        }
        if (strcmp((*g)->name, "variational") == 0) {
            assert_true(h.stages > 7 && h.share >= 0.75);
        }
    }
}

/* At whatever stage that is; no stage follows. Those that tell none are ended by ms_progress alone. */
static void a_stage_ends_the_run(void **state)
{
    const fixture *f = *state;
    size_t ended = 0;
    for (const ms_generator *const *g = checked; *g; g++) {
        for (size_t most = 1; most < 100; most++) {
            heard h = {.most = most};
            ms_error err;
            const ms_run run = {
                .target = &f->rough, .stop = {.spheres = 12}, .seed = 7, .stage = hear_stage, .stage_context = &h};
            outcome o;
            const ms_status status = ms_generator_run(&o.clump, &o.reason, *g, &run, &err);
            if (h.stages < most) {
                assert_int_equal(status, MS_OK);
                ms_clump_free(&o.clump);
                break;
            }
            assert_int_equal(status, MS_ERR_INTERRUPTED);
            assert_non_null(strstr(err.text, "interrupted at"));
            assert_int_equal(h.stages, most);
            assert_int_equal(o.clump.n_spheres, 0);
            ended++;
        }
    }
    assert_true(ended > 9);
}

/* A few voxels, one voxel; a volume without a mesh. */
static void small_targets_work(void **state)
{
    (void)state;
    uint32_t label[4 * 3 * 3] = {0};
    label[1 + 4 * (1 + 3 * 1)] = 5;
    const ms_volume one = {.n = {4, 3, 3}, .spacing = 0.5, .origin = {10, 20, 30}, .label = label};
    for (const ms_generator *const *g = checked; *g; g++) {
        ms_target target;
        ms_error err;
        assert_int_equal(ms_target_from_volume(&target, &one, 0, &err), MS_OK);
        outcome o = run_spheres(*g, &target, 1);
        assert_int_equal(o.clump.n_spheres, 1);
        assert_close(o.clump.sphere[0].centre[0], 10.5, 1e-12);
        assert_close(o.clump.sphere[0].centre[1], 20.5, 1e-12);
        assert_close(o.clump.sphere[0].centre[2], 30.5, 1e-12);
        ms_clump_free(&o.clump);
        ms_target_free(&target);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_generator_is_complete),
        cmocka_unit_test(options_are_documented),
        cmocka_unit_test(asked_number_is_given),
        cmocka_unit_test(spheres_are_sane),
        cmocka_unit_test(prefixes_are_clumps),
        cmocka_unit_test(threads_do_not_matter),
        cmocka_unit_test(frame_follows_the_mesh),
        cmocka_unit_test(measures_end_the_run),
        cmocka_unit_test(inertia_ends_the_run),
        cmocka_unit_test(least_radius_is_kept),
        cmocka_unit_test(nothing_asked_is_an_error),
        cmocka_unit_test(small_targets_work),
        cmocka_unit_test(what_a_run_tells),
        cmocka_unit_test(a_stage_ends_the_run),
        cmocka_unit_test(spheres_that_cover_nothing_are_no_clump),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
