#include "ms_report.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_escape.h"
#include "ms_json_object.h"

/* A largest distance, with its root mean square, which is the row behind it; nothing where it does not apply. */
static void print_distance(FILE *stream, const ms_measure *measure, const ms_metrics *m, double h)
{
    const double most = measure->of_metrics(m), rms = measure[1].of_metrics(m);
    if (isfinite(most)) {
        fprintf(stream, "  %-34s %.4g (rms %.3g), %.2f voxels\n", measure->label, most, rms, most / h);
    }
}

/* A median, with the angle behind it, which 95 % are below; nothing where there is no such surface. */
static void print_normals(FILE *stream, const char *label, double median, double most)
{
    if (isfinite(median)) {
        fprintf(stream, "  %-34s median %.2f, 95 %% %.2f degrees\n", label, median, most);
    }
}

static void print_edges(FILE *stream, const ms_metrics *m)
{
    char label[64];
    snprintf(label, sizeof label, "  of %.1f %% near sharp edges", 100 * m->edge_part);
    print_normals(stream, label, m->edge_normal_median, m->edge_normal_95);
}

static void print_pieces(FILE *stream, const ms_measure *measure, const ms_metrics *m)
{
    fprintf(stream, "  %-34s %s", measure->label, m->pieces == 1 ? "yes\n" : "");
    if (m->pieces != 1) {
        fprintf(stream, "no, %zu pieces\n", m->pieces);
    }
}

static void print_inertia(FILE *stream, const ms_measure *measure, const ms_metrics *m)
{
    if (!(m->body.volume > 0)) {
        fprintf(stream, "  %-34s none: the spheres cover no voxel\n", "inertia of the union");
        return;
    }
    fprintf(stream, "  %-34s %+.2f %% %+.2f %% %+.2f %%\n", "error of principal moments", 100 * m->inertia.moment[0],
            100 * m->inertia.moment[1], 100 * m->inertia.moment[2]);
    fprintf(stream, "  %-34s %.2f %%, axes turned %.2f degrees\n", measure->label, 100 * m->inertia.weighted,
            m->inertia.angle);
}

static void print_form(FILE *stream, const char *label, const char *unit, int digits, double shape, double clump)
{
    const double value[2] = {shape, clump};
    fprintf(stream, "  %-34s", label);
    for (int v = 0; v < 2; v++) {
        if (!isfinite(value[v])) {
            fprintf(stream, " %-12s", "-");
        } else if (unit) {
            fprintf(stream, " %-12.5g", value[v]);
        } else {
            fprintf(stream, " %-12.*f", digits, value[v]);
        }
    }
    fputc('\n', stream);
}

/* Descriptors of the shape and, beside them, of the clump. */
static void print_descriptors(FILE *stream, const ms_metrics *m)
{
    fprintf(stream, "  %-34s %-12s %-12s\n", "form", "shape", "clump");
#define PRINT(X, CODE, name, digits, unit, label, ...) \
    print_form(stream, label, unit, digits, m->shape_##name, m->clump_##name);
    MS_DESCRIPTOR_LIST(PRINT, )
#undef PRINT
}

void ms_report_metrics(FILE *stream, const ms_metrics *m, const ms_target *target)
{
    fprintf(stream, "  %-34s %zu\n", "spheres", m->spheres);
    for (int code = 0; code < MS_MEASURES; code++) {
        const ms_measure *measure = &ms_measures[code];
        if (code == MS_MEASURE_PROTRUSION || code == MS_MEASURE_GAP) {
            print_distance(stream, measure, m, target->grid.h);
        } else if (code == MS_MEASURE_NORMAL_MEDIAN) {
            print_normals(stream, "error of the normals", m->normal_median, m->normal_95);
            print_edges(stream, m);
        } else if (measure->kind == MS_MEASURE_KIND_NORMAL) {
            continue;
        } else if (code == MS_MEASURE_PIECES) {
            print_pieces(stream, measure, m);
        } else if (code == MS_MEASURE_INERTIA) {
            print_inertia(stream, measure, m);
        } else if (measure->kind == MS_MEASURE_KIND_DESCRIPTOR && code != MS_MEASURE_VOXEL_LIMIT) {
            continue;
        } else if (isnan(measure->of_metrics(m))) { /* not asked for, or of a volume of few voxels not known */
            continue;
        } else if (code != MS_MEASURE_PROTRUSION_RMS && code != MS_MEASURE_GAP_RMS) {
            fprintf(stream, "  %-34s %.*f\n", measure->label, measure->digits, measure->of_metrics(m));
        }
    }
    print_descriptors(stream, m);
}

void ms_report_curve(FILE *stream, const ms_score *curve, size_t count)
{
    const ms_measure *cut = &ms_measures[MS_MEASURE_COVERAGE_CUT];
    const int with_cut = count > 0 && !isnan(cut->of_score(&curve[0]));
    fprintf(stream, "n" MS_MEASURE_CURVE_NAMES "%s%s\n", with_cut ? "," : "", with_cut ? cut->name : "");
    for (size_t n = 0; n < count; n++) {
        fprintf(stream, "%zu", n + 1);
        for (const ms_measure *m = ms_measures; m->name; m++) {
            if (m->curve || (with_cut && m == cut)) {
                fprintf(stream, ",%.8g", m->of_score(&curve[n]));
            }
        }
        fputc('\n', stream);
    }
}

json_t *ms_report_number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

json_t *ms_report_text(const char *text)
{
    char *valid = ms_escape_utf8(text);
    json_t *json = valid ? json_string(valid) : NULL;
    free(valid);
    return json;
}

static json_t *pack_vector(const double v[3])
{
    return json_pack("[o,o,o]", ms_report_number(v[0]), ms_report_number(v[1]), ms_report_number(v[2]));
}

/* A union that covers no voxel has no inertia to compare. */
static json_t *inertia_json(const ms_metrics *m)
{
    if (!(m->body.volume > 0)) {
        return json_null();
    }
    return json_pack("{s:o,s:o,s:o,s:o}", "moments", pack_vector(m->inertia.moment), "weighted_mean",
                     ms_report_number(m->inertia.weighted), "axes_degrees", ms_report_number(m->inertia.angle),
                     "centroid", ms_report_number(m->inertia.centre));
}

json_t *ms_report_whole(json_t *object, int failed)
{
    if (failed) {
        json_decref(object);
        return NULL;
    }
    return object;
}

json_t *ms_report_metrics_json(const ms_metrics *m)
{
    json_t *json = json_object();
    int failed = json_object_set_new(json, "spheres", json_integer((json_int_t)m->spheres));
    for (const ms_measure *measure = ms_measures; measure->name; measure++) {
        const double value = measure->of_metrics(m);
        if (measure->kind == MS_MEASURE_KIND_COUNT) {
            failed |= json_object_set_new(json, measure->name, json_integer((json_int_t)value));
        } else if (measure != &ms_measures[MS_MEASURE_INERTIA]) { /* an object of its own */
            failed |= json_object_set_new(json, measure->name, ms_report_number(value));
        }
    }
    failed |= json_object_set_new(json, "volume", json_real(m->body.volume));
    failed |= json_object_set_new(json, "inertia_error", inertia_json(m));
    return ms_report_whole(json, failed);
}

json_t *ms_report_score_json(const ms_score *score, size_t spheres)
{
    json_t *json = json_object();
    int failed = json_object_set_new(json, "spheres", json_integer((json_int_t)spheres));
    for (const ms_measure *measure = ms_measures; measure->name; measure++) {
        if (ms_measure_is_of_score(measure)) {
            failed |= json_object_set_new(json, measure->name, ms_report_number(measure->of_score(score)));
        }
    }
    return ms_report_whole(json, failed);
}

json_t *ms_report_mending_json(const ms_mesh_report *r)
{
    return json_pack("{s:I,s:I,s:I,s:I,s:I,s:f,s:I}", "joined", (json_int_t)r->joined, "dropped_degenerate",
                     (json_int_t)r->dropped_degenerate, "dropped_duplicate", (json_int_t)r->dropped_duplicate,
                     "filled_holes", (json_int_t)r->filled, "dropped_bodies", (json_int_t)r->dropped_bodies,
                     "dropped_volume", r->dropped_volume, "turned", (json_int_t)r->flipped);
}

json_t *ms_report_input_json(const ms_input *input)
{
    char checksum[20];
    const ms_grid *grid = &input->target.grid;
    snprintf(checksum, sizeof checksum, "%016" PRIx64, input->checksum);
    json_t *json = json_pack("{s:o,s:s,s:s,s:[i,i,i],s:f,s:o,s:I}", "path", ms_report_text(input->path), "fnv1a",
                             checksum, "rule", input->target.rule == MS_VOXEL_HALF ? "half" : "centre", "grid",
                             grid->n[0], grid->n[1], grid->n[2], "voxel_size", grid->h, "grid_origin",
                             pack_vector(grid->origin), "voxels", (json_int_t)input->target.voxels);
    if (input->mesh.n_triangles) {
        ms_json_object_set(&json, "triangles", json_integer((json_int_t)input->mesh.n_triangles));
        ms_json_object_set(&json, "closed", json_boolean(input->report.closed));
        ms_json_object_merge(&json, ms_report_mending_json(&input->report));
    } else {
        ms_json_object_set(&json, "label", input->label ? json_integer(input->label) : json_null());
        ms_json_object_merge(&json, ms_input_volume_json(&input->origin));
    }
    return json;
}

json_t *ms_report_body_json(const ms_body *body, const ms_principal *p)
{
    return json_pack("{s:f,s:o,s:[o,o,o],s:o,s:[o,o,o]}", "volume", body->volume, "centroid",
                     pack_vector(body->centroid), "inertia", pack_vector(body->inertia[0]),
                     pack_vector(body->inertia[1]), pack_vector(body->inertia[2]), "principal_moments",
                     pack_vector(p->moment), "principal_axes", pack_vector(p->axis[0]), pack_vector(p->axis[1]),
                     pack_vector(p->axis[2]));
}

ms_status ms_report_print(FILE *stream, json_t *value, ms_error *err)
{
    if (!value) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the report");
    }
    const int failed = json_dumpf(value, stream, JSON_INDENT(2)) != 0;
    json_decref(value);
    return failed || fputc('\n', stream) == EOF || fflush(stream) != 0
               ? ms_fail(err, MS_ERR_IO, "standard output cannot be written")
               : MS_OK;
}

void ms_report_equal_volume(FILE *stream, const ms_equal_volume *done)
{
    if (done->scale > 0) {
        fprintf(stream, "  %-34s scaled by %.6g; volume of the union %.9g, off by %.1e\n", "equal volume", done->scale,
                done->volume, done->error);
        fprintf(stream, "  %-34s %.6g\n", "mean width of the clump", done->mean_width);
    }
}

void ms_report_equal_volume_remark(const char *name, const ms_equal_volume *done)
{
    ms_error remark = {""};
    ms_equal_volume_remark(&remark, done);
    if (remark.text[0]) {
        fprintf(stderr, "%s: %s\n", name, remark.text);
    }
}

json_t *ms_report_equal_volume_json(const ms_equal_volume *done)
{
    return done->scale > 0 ? json_pack("{s:f,s:f,s:f,s:f}", "scale", done->scale, "volume", done->volume, "error",
                                       done->error, "mean_width", done->mean_width)
                           : NULL;
}
