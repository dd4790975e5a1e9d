#include "ms_report.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

void ms_report_metrics(FILE *stream, const ms_metrics *m, const ms_target *target)
{
    const double h = target->grid.h;
    fprintf(stream, "  %-34s %zu\n", "spheres", m->spheres);
    fprintf(stream, "  %-34s %.5f\n", "eta, |S xor U| / |S|", m->score.eta);
    fprintf(stream, "  %-34s %.5f\n", "D, Dice mismatch", m->score.dice);
    fprintf(stream, "  %-34s %.5f\n", "coverage", m->score.coverage);
    fprintf(stream, "  %-34s %.5f\n", "overshoot", m->score.overshoot);
    fprintf(stream, "  %-34s %.5f\n", "volume of union / of shape", m->score.off_volume);
    if (isfinite(m->protrusion_max)) {
        fprintf(stream, "  %-34s %.4g (rms %.3g), %.2f voxels\n", "largest protrusion", m->protrusion_max,
                m->protrusion_rms, m->protrusion_max / h);
    }
    if (isfinite(m->gap_max)) {
        fprintf(stream, "  %-34s %.4g (rms %.3g), %.2f voxels\n", "largest gap", m->gap_max, m->gap_rms,
                m->gap_max / h);
    }
    fprintf(stream, "  %-34s %.4f\n", "smallest / equivalent radius", m->smallest_radius_ratio);
    fprintf(stream, "  %-34s %s", "connected", m->pieces == 1 ? "yes\n" : "");
    if (m->pieces != 1) {
        fprintf(stream, "no, %zu pieces\n", m->pieces);
    }
    if (!(m->body.volume > 0)) {
        fprintf(stream, "  %-34s none: the spheres cover no voxel\n", "inertia of the union");
        return;
    }
    fprintf(stream, "  %-34s %+.2f %% %+.2f %% %+.2f %%\n", "error of principal moments", 100 * m->inertia.moment[0],
            100 * m->inertia.moment[1], 100 * m->inertia.moment[2]);
    fprintf(stream, "  %-34s %.2f %%, axes turned %.2f degrees\n", "their weighted mean (Yuan)",
            100 * m->inertia.weighted, m->inertia.angle);
}

void ms_report_curve(FILE *stream, const ms_score *curve, size_t count)
{
    fputs("n,eta,dice,coverage,overshoot\n", stream);
    for (size_t n = 0; n < count; n++) {
        fprintf(stream, "%zu,%.8g,%.8g,%.8g,%.8g\n", n + 1, curve[n].eta, curve[n].dice, curve[n].coverage,
                curve[n].overshoot);
    }
}

json_t *ms_report_number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

json_t *ms_report_text(const char *text)
{
    json_t *json = json_string(text);
    char *plain = json ? NULL : strdup(text);
    for (char *at = plain; at && *at; at++) {
        *at = (char)(*at & 0x80 ? '?' : *at);
    }
    json = plain ? json_string(plain) : json;
    free(plain);
    return json;
}

static json_t *vector(const double v[3])
{
    return json_pack("[o,o,o]", ms_report_number(v[0]), ms_report_number(v[1]), ms_report_number(v[2]));
}

/* A union that covers no voxel has no inertia to compare. */
static json_t *inertia_json(const ms_metrics *m)
{
    if (!(m->body.volume > 0)) {
        return json_null();
    }
    return json_pack("{s:o,s:o,s:o,s:o}", "moments", vector(m->inertia.moment), "weighted_mean",
                     ms_report_number(m->inertia.weighted), "axes_degrees", ms_report_number(m->inertia.angle),
                     "centroid", ms_report_number(m->inertia.centre));
}

json_t *ms_report_metrics_json(const ms_metrics *m)
{
    return json_pack("{s:I,s:f,s:f,s:f,s:f,s:f,s:o,s:o,s:o,s:o,s:f,s:I,s:f,s:o}", "spheres", (json_int_t)m->spheres,
                     "eta", m->score.eta, "dice", m->score.dice, "coverage", m->score.coverage, "overshoot",
                     m->score.overshoot, "off_volume", m->score.off_volume, "protrusion_max",
                     ms_report_number(m->protrusion_max), "protrusion_rms", ms_report_number(m->protrusion_rms),
                     "gap_max", ms_report_number(m->gap_max), "gap_rms", ms_report_number(m->gap_rms),
                     "smallest_radius_ratio", m->smallest_radius_ratio, "pieces", (json_int_t)m->pieces, "volume",
                     m->body.volume, "inertia_error", inertia_json(m));
}

json_t *ms_report_input_json(const ms_input *input)
{
    char checksum[20];
    const ms_grid *grid = &input->target.grid;
    snprintf(checksum, sizeof checksum, "%016" PRIx64, input->checksum);
    json_t *json = json_pack("{s:o,s:s,s:s,s:[i,i,i],s:f,s:o,s:I}", "path", ms_report_text(input->path), "fnv1a",
                             checksum, "rule", input->target.rule == MS_VOXEL_HALF ? "half" : "centre", "grid",
                             grid->n[0], grid->n[1], grid->n[2], "voxel_size", grid->h, "grid_origin",
                             vector(grid->origin), "voxels", (json_int_t)input->target.voxels);
    if (input->mesh.n_triangles && json) {
        json_object_set_new(json, "triangles", json_integer((json_int_t)input->mesh.n_triangles));
        json_object_set_new(json, "closed", json_boolean(input->report.closed));
    } else if (json) {
        json_object_set_new(json, "label", input->label ? json_integer(input->label) : json_null());
    }
    return json;
}

json_t *ms_report_body_json(const ms_body *body, const ms_principal *p)
{
    return json_pack("{s:f,s:o,s:[o,o,o],s:o,s:[o,o,o]}", "volume", body->volume, "centroid", vector(body->centroid),
                     "inertia", vector(body->inertia[0]), vector(body->inertia[1]), vector(body->inertia[2]),
                     "principal_moments", vector(p->moment), "principal_axes", vector(p->axis[0]), vector(p->axis[1]),
                     vector(p->axis[2]));
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
