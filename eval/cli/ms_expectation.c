#include "ms_expectation.h"

#include <math.h>

#include "ms_json_object.h"
#include "ms_report.h"

/* Numbers of spheres: those of a table, and those of JSON. */
static const double NUMBERS[] = {5, 10, 20, 50, 100, 200, 500, 1000},
                    ALL_NUMBERS[] = {5, 10, 15, 20, 30, 40, 50, 60, 80, 100, 150, 200, 300, 400, 500, 600, 800, 1000},
                    MISMATCHES[] = {0.1, 0.05, 0.02, 0.01};
enum { N_NUMBERS = sizeof NUMBERS / sizeof *NUMBERS, N_MISMATCHES = sizeof MISMATCHES / sizeof *MISMATCHES };
static const char *const KINDS[] = {[MS_EXPECT_FREE] = "free", [MS_EXPECT_INSCRIBED] = "inscribed"};

/* A clump of this mismatch holds too little of its shape to stand for it. */
static const double HOPELESS = 0.2;

static ms_status refuse_open(const ms_input *input, ms_error *err)
{
    if (input->mesh.n_triangles > 0 && (!input->report.closed || input->solid.overlapping)) {
        return ms_fail(err, MS_ERR_SHAPE, "%s: of a mesh that %s nothing can be expected", input->path,
                       input->report.closed ? "passes through itself" : "is open");
    }
    return MS_OK;
}

ms_status ms_expectation_find(ms_expect *expect, const ms_input *input, ms_error *err)
{
    *expect = (ms_expect){0};
    const ms_status status = refuse_open(input, err);
    if (status != MS_OK) {
        return status;
    }
    return input->mesh.n_triangles > 0 ? ms_expect_mesh(expect, &input->mesh, err)
                                       : ms_expect_grid(expect, &input->target.grid, err);
}

ms_status ms_expectation_try(ms_expect *expect, const ms_input *input, ms_error *err)
{
    const ms_status status = ms_expectation_find(expect, input, err);
    return status == MS_ERR_SHAPE ? MS_OK : status;
}

ms_status ms_expectation_near(ms_expect *expect, const ms_input *input, size_t spheres, ms_error *err)
{
    *expect = (ms_expect){0};
    ms_status status = refuse_open(input, err);
    if (status == MS_OK) {
        status = ms_expect_near(expect, &input->target, (double)spheres, err);
    }
    return status == MS_ERR_SHAPE ? MS_OK : status;
}

double ms_expectation_dice(const ms_expect *expect, size_t spheres)
{
    return expect->curve[MS_EXPECT_FREE].count > 0 ? ms_expect_dice(expect, MS_EXPECT_FREE, (double)spheres)
                                                   : (double)NAN;
}

double ms_expectation_spheres(const ms_expect *expect, double dice)
{
    return expect->curve[MS_EXPECT_FREE].count > 0 ? ms_expect_spheres(expect, MS_EXPECT_FREE, dice) : (double)NAN;
}

void ms_expectation_say(FILE *stream, const ms_expect *expect, const ms_metrics *metrics)
{
    const double dice = ms_expectation_dice(expect, metrics->spheres);
    if (dice > 0) {
        fprintf(stream,
                "  D is %.2f times the least D expected of %zu spheres, %.2g (an estimate: mskit info --expect)\n",
                metrics->score.dice / dice, metrics->spheres, dice);
    }
}

json_t *ms_expectation_factor_json(const ms_expect *expect, const ms_metrics *metrics)
{
    const double dice = ms_expectation_dice(expect, metrics->spheres);
    return isnan(dice) ? json_null()
                       : json_pack("{s:o,s:o}", "dice", ms_report_number(dice), "factor",
                                   ms_report_number(metrics->score.dice / dice));
}

static double find_number(const ms_expect *expect, int kind, double dice)
{
    return ms_expect_round(ms_expect_spheres(expect, (ms_expect_kind)kind, dice));
}

void ms_expectation_print(FILE *stream, const ms_expect *expect)
{
    fprintf(stream,
            "  expected least D by number of spheres (asymptotic, an estimate, not a proven bound: the least D known\n"
            "  of measured shapes was 1/%g to %g times it from 10 spheres on, 1/%g to %g from 100 on)\n  %-22s",
            MS_EXPECT_RANGE, MS_EXPECT_RANGE, MS_EXPECT_RANGE_MANY, MS_EXPECT_RANGE_MANY, "    spheres");
    for (int i = 0; i < N_NUMBERS; i++) {
        fprintf(stream, " %7g", NUMBERS[i]);
    }
    for (int kind = 0; kind < MS_EXPECT_KINDS; kind++) {
        fprintf(stream, "\n      %-18s", KINDS[kind]);
        for (int i = 0; i < N_NUMBERS; i++) {
            fprintf(stream, " %7.2g", ms_expect_dice(expect, (ms_expect_kind)kind, NUMBERS[i]));
        }
    }
    fprintf(stream, "\n  spheres expected by D\n  %-22s", "    D");
    for (int i = 0; i < N_MISMATCHES; i++) {
        fprintf(stream, " %7g", MISMATCHES[i]);
    }
    fprintf(stream, " least sensible");
    for (int kind = 0; kind < MS_EXPECT_KINDS; kind++) {
        fprintf(stream, "\n      %-18s", KINDS[kind]);
        for (int i = 0; i < N_MISMATCHES; i++) {
            fprintf(stream, " %7g", find_number(expect, kind, MISMATCHES[i]));
        }
        fprintf(stream, " %14g", ms_expect_round(ms_expect_least_spheres(expect, (ms_expect_kind)kind)));
    }
    putc('\n', stream);
}

/* A pair of figures, for free spheres and for inscribed ones, beside what it belongs to. */
static json_t *pair_json(const char *name, double value, double free, double inscribed)
{
    json_t *pair = json_pack("{s:o,s:o}", KINDS[0], ms_report_number(free), KINDS[1], ms_report_number(inscribed));
    if (name) {
        ms_json_object_set(&pair, name, ms_report_number(value));
    }
    return pair;
}

json_t *ms_expectation_json(const ms_expect *expect)
{
    json_t *dice = json_array(), *spheres = json_array();
    for (size_t i = 0; i < sizeof ALL_NUMBERS / sizeof *ALL_NUMBERS; i++) {
        const double n = ALL_NUMBERS[i];
        ms_json_object_append(&dice, pair_json("spheres", n, ms_expect_dice(expect, MS_EXPECT_FREE, n),
                                               ms_expect_dice(expect, MS_EXPECT_INSCRIBED, n)));
    }
    for (int i = 0; i < N_MISMATCHES; i++) {
        ms_json_object_append(&spheres, pair_json("dice", MISMATCHES[i], find_number(expect, 0, MISMATCHES[i]),
                                                  find_number(expect, 1, MISMATCHES[i])));
    }
    return json_pack("{s:o,s:o,s:o,s:[f,f]}", "dice", dice, "spheres", spheres, "least_spheres",
                     pair_json(NULL, 0, ms_expect_round(ms_expect_least_spheres(expect, MS_EXPECT_FREE)),
                               ms_expect_round(ms_expect_least_spheres(expect, MS_EXPECT_INSCRIBED))),
                     "range", 1 / MS_EXPECT_RANGE, MS_EXPECT_RANGE);
}

ms_status ms_expectation_warn(const ms_expect *expect, const ms_input *input, size_t n, ms_error *err)
{
    const double dice = ms_expectation_dice(expect, n);
    ms_expect whole;
    if (!(dice / MS_EXPECT_RANGE > HOPELESS)) { /* NAN, too */
        return MS_OK;
    }
    const ms_status status = ms_expectation_find(&whole, input, err);
    const double least = status == MS_OK ? ms_expect_least_spheres(&whole, MS_EXPECT_FREE) : 0;
    if ((double)n < least) {
        fprintf(stderr,
                "%s: for %zu spheres the least D to be expected is about %.2g: most of the shape is too thin for so "
                "few; %g would bring it to about %.2g\n",
                input->path, n, dice, ms_expect_round(least), ms_expect_dice(&whole, MS_EXPECT_FREE, least));
    }
    return status;
}
