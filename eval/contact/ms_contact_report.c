#include "ms_contact_report.h"

#include <math.h>

#include "base/ms_vector.h"
#include "chart/ms_csv.h"
#include "cli/ms_json_object.h"
#include "cli/ms_report.h"
#include "contact/ms_factors.h"

static const char *const AGAINST[] = {[MS_CONTACT_PLANE] = "plane", [MS_CONTACT_PARTICLE] = "particle"};
static const char *const WHERE[] = {[MS_CONTACT_RANDOM] = "random", [MS_CONTACT_POSES] = "poses"};

/* The numbers of a row, in the order of the columns: X of those that are whole, Y of others. */
#define MS_CONTACT_COLUMNS(X, Y)                   \
    Y("overlap", row->overlap)                     \
    X("orientations", row->samples)                \
    Y("missed", row->missed)                       \
    Y("contacts", row->mean)                       \
    X("contacts_median", row->median)              \
    X("contacts_most", row->most)                  \
    Y("stiffness", row->stiffness)                 \
    Y("stiffness_most", row->most_stiffness)       \
    Y("damping", row->damping)                     \
    Y("damping_most", row->most_damping)           \
    Y("restitution", row->restitution)             \
    Y("restitution_least", row->least_restitution) \
    Y("overdamped", row->overdamped)

static void print_forms(FILE *stream, const ms_contact *c)
{
    fprintf(stream, "  %-22s %.9g\n", "r_eq", c->r_eq);
    fprintf(stream, "  %-22s %.6g", "mean width", c->clump.mean_width);
    if (c->shape.pose) {
        fprintf(stream, ", of the shape %.6g\n  %-22s %.6g, %.3g r_eq", c->shape.mean_width, "rms of the support",
                c->rms, c->rms / c->r_eq);
    }
    fputc('\n', stream);
}

static void print_poses(FILE *stream, const ms_contact *c, const ms_contact_form *form, const char *name)
{
    const ms_contact_form *other = form == &c->clump ? &c->shape : &c->clump;
    fprintf(stream, "\n  %-6s %9s %9s %7s  %-26s %s\n", name, "height", "barrier", "share", "down",
            other->pose ? "angle to the other's nearest" : "");
    for (size_t p = 0; p < form->n_poses; p++) {
        const ms_pose *pose = &form->pose[p];
        fprintf(stream, "  %-6zu %9.4f ", p + 1, pose->height / c->r_eq);
        if (isfinite(pose->barrier)) {
            fprintf(stream, "%9.4f", pose->barrier / c->r_eq);
        } else {
            fprintf(stream, "%9s", "-");
        }
        fprintf(stream, " %7.4f  %8.4f %8.4f %8.4f", pose->share, pose->direction[0], pose->direction[1],
                pose->direction[2]);
        if (other->pose) {
            double angle;
            ms_contact_nearest(&angle, other, pose->direction);
            fprintf(stream, "  %.2f", angle * MS_VECTOR_DEGREES);
        }
        fputc('\n', stream);
    }
}

static void print_sleds(FILE *stream, const ms_contact *c)
{
    fprintf(stream,
            "\n  dragged over its like, on pose %d     T/N               (mu + tan t)/(1 - mu tan t)\n"
            "  mu       overlap  jammed missed      mean    most      mean    most\n",
            (int)(c->face - c->clump.pose) + 1);
    for (size_t s = 0; s < c->n_sleds; s++) {
        for (int f = 0; f < MS_CONTACT_N_FRICTIONS; f++) {
            const ms_sled *sled = &c->sled[s].sled[f];
            fprintf(stream, "  %-8.3g %-8.3g %6.3f %6.3f", sled->friction, c->sled[s].overlap, sled->jammed,
                    sled->missed);
            if (isfinite(sled->mean)) {
                fprintf(stream, "  %8.3f %7.3f  %8.3f %7.3f", sled->mean, sled->largest, sled->slope_mean,
                        sled->slope_largest);
            }
            fputc('\n', stream);
        }
    }
}

static void print_row(FILE *stream, const ms_contact_row *row)
{
    fprintf(stream, "  %-8s %-6s %-8.3g ", AGAINST[row->against], WHERE[row->where], row->overlap);
    if (row->most == 0) {
        fputs("all pass without touching\n", stream);
        return;
    }
    fprintf(stream, "%7.2f %6zu %4zu   %8.2f %5.4g  %8.2f %5.4g  %8.3f %6.3f %5.3f\n", row->mean, row->median,
            row->most, row->stiffness, row->most_stiffness, row->damping, row->most_damping, row->restitution,
            row->least_restitution, row->overdamped);
    if (row->missed > 0) {
        fprintf(stream, "  (of these %.3g pass without touching and are left out)\n", row->missed);
    }
}

void ms_contact_report_print(FILE *stream, const ms_contact *c)
{
    print_forms(stream, c);
    fputs("\n  touches                     spheres at once        stiffness       damping         e\n"
          "  what     where  overlap     mean median most       mean  most      mean  most      mean  least  none\n",
          stream);
    for (size_t r = 0; r < c->n_rows; r++) {
        print_row(stream, &c->row[r]);
    }
    print_sleds(stream, c);
    print_poses(stream, c, &c->clump, "clump");
    if (c->shape.pose) {
        print_poses(stream, c, &c->shape, "shape");
    }
    fputs("\n  (heights and barriers in r_eq; e: none is the part of which nothing rebounds)\n", stream);
}

void ms_contact_report_factors(FILE *stream, const ms_contact *c, double single)
{
    fputs("\n  to make the mean contact like one    factors               price at random and in poses\n"
          "  what     where  overlap     modulus  ask for e     least stiffness  greatest e\n",
          stream);
    for (size_t r = 0; r < c->n_rows; r++) {
        const ms_contact_row *row = &c->row[r];
        if (row->most > 0) {
            const ms_factors f = ms_factors_of(c, row, single);
            fprintf(stream, "  %-8s %-6s %-8.3g %10.4g %10.3f %19.4g %11.3f\n", AGAINST[row->against],
                    WHERE[row->where], row->overlap, f.modulus, f.restitution, f.softest, f.bounciest);
        }
    }
    fputs("  (none is the default: one number makes a corner as much too soft as it makes a face right)\n", stream);
}

json_t *ms_contact_report_factors_json(const ms_contact *c, double single)
{
    json_t *list = json_array();
    for (size_t r = 0; r < c->n_rows; r++) {
        const ms_contact_row *row = &c->row[r];
        if (row->most > 0) {
            const ms_factors f = ms_factors_of(c, row, single);
            ms_json_object_append(&list, json_pack("{s:s,s:s,s:f,s:f,s:f,s:f,s:f}", "against", AGAINST[row->against],
                                                   "where", WHERE[row->where], "overlap", row->overlap, "modulus",
                                                   f.modulus, "restitution", f.restitution, "softest", f.softest,
                                                   "bounciest", f.bounciest));
        }
    }
    return json_pack("{s:o}", "factors", list);
}

void ms_contact_report_csv(FILE *stream, const ms_contact *c)
{
#define NAME(name, value) "," name
    fputs("against,where" MS_CONTACT_COLUMNS(NAME, NAME) "\n", stream);
#undef NAME
    for (size_t r = 0; r < c->n_rows; r++) {
        const ms_contact_row *row = &c->row[r];
        fprintf(stream, "%s,%s", AGAINST[row->against], WHERE[row->where]);
#define PUT(name, value) ms_csv_put_number(stream, (double)(value));
        MS_CONTACT_COLUMNS(PUT, PUT)
#undef PUT
        fputc('\n', stream);
    }
}

/* How often each number of contacts occurs: [[number, part], ...]. The samples are in its order. */
static json_t *counts_json(const ms_contact_row *row)
{
    json_t *list = json_array();
    for (size_t i = 0; i < row->samples;) {
        const size_t count = row->sample[i].touch.count;
        double part = 0;
        for (; i < row->samples && row->sample[i].touch.count == count; i++) {
            part += row->sample[i].weight;
        }
        ms_json_object_append(&list, json_pack("[I,f]", (json_int_t)count, part / row->whole));
    }
    return list;
}

static json_t *row_json(const ms_contact_row *row)
{
    json_t *json = json_pack("{s:s,s:s}", "against", AGAINST[row->against], "where", WHERE[row->where]);
#define SET_WHOLE(name, value) ms_json_object_set(&json, name, json_integer((json_int_t)(value)));
#define SET(name, value) ms_json_object_set(&json, name, ms_report_number(value));
    MS_CONTACT_COLUMNS(SET_WHOLE, SET)
#undef SET
#undef SET_WHOLE
    ms_json_object_set(&json, "counts", counts_json(row));
    return json;
}

static json_t *sleds_json(const ms_contact *c)
{
    json_t *list = json_array();
    for (size_t s = 0; s < c->n_sleds; s++) {
        for (int f = 0; f < MS_CONTACT_N_FRICTIONS; f++) {
            const ms_sled *sled = &c->sled[s].sled[f];
            ms_json_object_append(&list,
                                  json_pack("{s:f,s:f,s:f,s:f,s:o,s:o,s:o,s:o}", "friction", sled->friction, "overlap",
                                            c->sled[s].overlap, "jammed", sled->jammed, "missed", sled->missed, "mean",
                                            ms_report_number(sled->mean), "most", ms_report_number(sled->largest),
                                            "slope_mean", ms_report_number(sled->slope_mean), "slope_most",
                                            ms_report_number(sled->slope_largest)));
        }
    }
    return json_pack("{s:I,s:o}", "pose", (json_int_t)(c->face - c->clump.pose), "drags", list);
}

static json_t *pose_json(const ms_contact *c, const ms_pose *pose, const ms_contact_form *other)
{
    json_t *json = json_pack("{s:[f,f,f],s:f,s:o,s:f}", "down", pose->direction[0], pose->direction[1],
                             pose->direction[2], "height", pose->height / c->r_eq, "barrier",
                             ms_report_number(pose->barrier / c->r_eq), "share", pose->share);
    if (other->pose) {
        double angle;
        const ms_pose *nearest = ms_contact_nearest(&angle, other, pose->direction);
        ms_json_object_set(&json, "nearest", json_integer((json_int_t)(nearest - other->pose)));
        ms_json_object_set(&json, "angle", json_real(angle * MS_VECTOR_DEGREES));
    }
    return json;
}

static json_t *form_json(const ms_contact *c, const ms_contact_form *form, const ms_contact_form *other)
{
    json_t *poses = json_array();
    for (size_t p = 0; p < form->n_poses; p++) {
        ms_json_object_append(&poses, pose_json(c, &form->pose[p], other));
    }
    return json_pack("{s:f,s:o}", "mean_width", form->mean_width, "poses", poses);
}

json_t *ms_contact_report_json(const ms_contact *c)
{
    json_t *rows = json_array();
    for (size_t r = 0; r < c->n_rows; r++) {
        ms_json_object_append(&rows, row_json(&c->row[r]));
    }
    json_t *json = json_pack("{s:f,s:o,s:o,s:o}", "r_eq", c->r_eq, "contacts", rows, "sled", sleds_json(c), "clump",
                             form_json(c, &c->clump, &c->shape));
    if (c->shape.pose) {
        ms_json_object_set(&json, "shape", form_json(c, &c->shape, &c->clump));
        ms_json_object_set(&json, "support_rms", json_real(c->rms));
    }
    return json;
}
