/* mskit info SHAPE */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/ms_expectation.h"
#include "cli/ms_input.h"
#include "cli/ms_json_object.h"
#include "cli/ms_label_list.h"
#include "cli/ms_report.h"
#include "measure/ms_descriptors.h"
#include "ms_commands.h"

static const ms_flag FLAGS[] = {
    {"expect", 0, NULL, "also the least D to be expected by number of spheres, and the numbers for D"},
    {"json", 0, NULL, "as JSON"},
    MS_INPUT_VOLUME_FLAGS,
    MS_INPUT_MENDING_FLAGS,
    {"max-memory", 0, "SIZE",
     "refuse volumes, and a standard input, beyond this, as 500M or 8G (3/4 of the machine's)"},
    {0},
};

typedef struct info_arguments {
    ms_input_flags input;
    int json, expect;
} info_arguments;

static ms_status take_info_flag(void *context, const char *name, const char *value, ms_error *err)
{
    info_arguments *a = context;
    int taken;
    if (strcmp(name, "json") == 0 || strcmp(name, "expect") == 0) {
        *(name[0] == 'j' ? &a->json : &a->expect) = 1;
        return MS_OK;
    }
    return ms_input_flag(&taken, &a->input, name, value, err);
}

/* What is known of a shape. */
typedef struct info_facts {
    const ms_input *input;
    double lo[3], hi[3];
    double area; /* of the surface; of a mesh whose surface is in part inside, of all of it */
    ms_descriptors form;
    int has_body;
    ms_body body;
    ms_principal principal;
    ms_expect expect; /* empty if it was not asked for */
} info_facts;

static ms_status describe(info_facts *f, const ms_input *input, ms_error *err)
{
    if (input->volume.label) {
        const ms_status status = ms_descriptors_of_grid(&f->form, &input->target.grid, &f->body, err);
        f->area = f->form.area;
        return status;
    }
    f->area = ms_mesh_area(&input->mesh);
    return ms_descriptors_of_mesh(&f->form, &input->mesh, f->has_body ? &input->solid : NULL, err);
}

static ms_status gather(info_facts *f, ms_input *input, const ms_input_flags *flags, ms_error *err)
{
    ms_status status = MS_OK;
    memset(f, 0, sizeof *f);
    f->input = input;
    status = ms_input_check_flags(input, flags, err);
    if (status != MS_OK) {
        return status;
    }
    if (input->is_volume) {
        status = ms_target_voxels_from_volume(&input->target, &input->volume, flags->label, err);
        f->body = input->target.body;
        f->has_body = 1;
        for (int a = 0; a < 3 && status == MS_OK; a++) {
            f->lo[a] = input->target.grid.origin[a] + input->target.grid.h * (MS_GRID_HULL - 0.5);
            f->hi[a] = f->lo[a] + input->target.grid.h * (input->target.grid.n[a] - 2 * MS_GRID_HULL);
        }
    } else {
        ms_mesh_box(f->lo, f->hi, &input->mesh);
        f->has_body = input->report.closed;
        f->body = input->solid.body;
    }
    if (status == MS_OK) {
        status = describe(f, input, err);
    }
    return status == MS_OK && f->has_body ? ms_inertia_principal(&f->principal, &f->body, err) : status;
}

static void print_vector(const char *name, const double v[3])
{
    printf("  %-22s %.9g %.9g %.9g\n", name, v[0], v[1], v[2]);
}

static void print_mesh(const info_facts *f)
{
    const ms_mesh_report *r = &f->input->report;
    printf("  %-22s %zu\n  %-22s %zu\n", "triangles", f->input->mesh.n_triangles, "vertices",
           f->input->mesh.n_vertices);
    printf("  %-22s %s\n  %-22s %zu\n  %-22s %zu\n", "closed", r->closed ? "yes" : "no", "open edges", r->open_edges,
           "non-manifold edges", r->nonmanifold_edges);
    if (r->holes) {
        printf("  %-22s %zu, the largest of %zu edges\n", "holes", r->holes, r->largest_hole);
    }
    if (r->closed) {
        printf("  %-22s %zu (%zu cavities%s)\n", "bodies", r->bodies, r->cavities,
               f->input->solid.overlapping ? ", overlapping" : "");
    } else {
        printf("  %-22s %zu\n", "shells", r->shells);
    }
}

static void print_voxels(const ms_target *target)
{
    printf("  %-22s %zu\n  %-22s %zu", "voxels", target->voxels, "pieces", target->pieces);
    if (target->pieces > 1) {
        printf(" that touch nowhere, the largest of %zu voxels", target->largest_piece);
    }
    putchar('\n');
}

/* Of length or area as exact as the other figures, of ratios with less. */
static void print_descriptor(const char *label, const char *unit, double value)
{
    if (isfinite(value)) {
        printf("  %-22s %.*g\n", label, unit ? 9 : 6, value);
    }
}

/* The descriptors that are known; the area has been told. */
static void print_form(const ms_descriptors *form)
{
#define PRINT(X, CODE, name, digits, unit, label, ...) \
    print_descriptor(label, unit, &form->name == &form->area ? (double)NAN : form->name);
    MS_DESCRIPTOR_LIST(PRINT, )
#undef PRINT
    if (isfinite(form->feret[0])) {
        print_vector("Feret dimensions", form->feret);
    } else if (!ms_descriptors_has_hull()) {
        puts("  (built without qhull: no Feret dimensions, no convexity)");
    }
}

static void print_facts(const info_facts *f)
{
    static const char *const ROWS[] = {"inertia tensor", "", ""}, *const AXES[] = {"principal axes", "", ""};
    printf("%s\n", f->input->path);
    if (f->input->mesh.n_triangles) {
        print_mesh(f);
    } else {
        print_voxels(&f->input->target);
    }
    const double size[3] = {f->hi[0] - f->lo[0], f->hi[1] - f->lo[1], f->hi[2] - f->lo[2]};
    print_vector("box from", f->lo);
    print_vector("box size", size);
    if (isfinite(f->area)) {
        printf("  %-22s %.9g%s\n", "area", f->area, f->input->solid.overlapping ? " with what is inside" : "");
    }
    if (!f->has_body) {
        puts("  (an open mesh has no volume)");
        print_form(&f->form);
        return;
    }
    printf("  %-22s %.9g\n", "volume", f->body.volume);
    print_vector("centroid", f->body.centroid);
    for (int a = 0; a < 3; a++) {
        print_vector(ROWS[a], f->body.inertia[a]);
    }
    print_vector("principal moments", f->principal.moment);
    for (int a = 0; a < 3; a++) {
        print_vector(AXES[a], f->principal.axis[a]);
    }
    print_form(&f->form);
    if (f->expect.curve[MS_EXPECT_FREE].count > 0) {
        ms_expectation_print(stdout, &f->expect);
    }
}

static json_t *form_json(const ms_descriptors *form)
{
    json_t *json = json_object();
#define PUT(X, CODE, name, ...) ms_json_object_set(&json, #name, ms_report_number(form->name));
    MS_DESCRIPTOR_LIST(PUT, )
#undef PUT
    ms_json_object_set(&json, "feret",
                       json_pack("[o,o,o]", ms_report_number(form->feret[0]), ms_report_number(form->feret[1]),
                                 ms_report_number(form->feret[2])));
    return json;
}

static json_t *facts_json(const info_facts *f)
{
    const ms_mesh_report *r = &f->input->report;
    json_t *json = json_pack("{s:o,s:[f,f,f],s:[f,f,f]}", "path", ms_report_text(f->input->path), "box_lo", f->lo[0],
                             f->lo[1], f->lo[2], "box_hi", f->hi[0], f->hi[1], f->hi[2]);
    ms_json_object_merge(&json, form_json(&f->form));
    ms_json_object_set(&json, "area", ms_report_number(f->area));
    json_t *mesh = json_pack(
        "{s:I,s:I,s:b,s:I,s:I,s:I,s:I,s:I,s:b}", "triangles", (json_int_t)f->input->mesh.n_triangles, "vertices",
        (json_int_t)f->input->mesh.n_vertices, "closed", r->closed, "open_edges", (json_int_t)r->open_edges,
        "nonmanifold_edges", (json_int_t)r->nonmanifold_edges, "shells", (json_int_t)r->shells, "bodies",
        (json_int_t)r->bodies, "cavities", (json_int_t)r->cavities, "overlapping", f->input->solid.overlapping);
    if (f->input->mesh.n_triangles) {
        ms_json_object_set(&mesh, "holes", json_integer((json_int_t)r->holes));
        ms_json_object_set(&mesh, "largest_hole", json_integer((json_int_t)r->largest_hole));
        ms_json_object_merge(&mesh, ms_report_mending_json(r));
        ms_json_object_merge(&json, mesh);
    } else {
        ms_json_object_set(&json, "voxels", json_integer((json_int_t)f->input->target.voxels));
        ms_json_object_set(&json, "pieces", json_integer((json_int_t)f->input->target.pieces));
        ms_json_object_set(&json, "largest_piece", json_integer((json_int_t)f->input->target.largest_piece));
        ms_json_object_merge(&json, ms_input_volume_json(&f->input->origin));
        json_decref(mesh);
    }
    if (f->has_body) {
        ms_json_object_merge(&json, ms_report_body_json(&f->body, &f->principal));
    }
    if (f->expect.curve[MS_EXPECT_FREE].count > 0) {
        ms_json_object_set(&json, "expected", ms_expectation_json(&f->expect));
    }
    return json;
}

static json_t *labels_json(const ms_input *input, const ms_label_row *row)
{
    const ms_scan *v = &input->scan;
    json_t *json = json_pack("{s:o,s:[i,i,i],s:f,s:[f,f,f],s:o}", "path", ms_report_text(input->path), "n", v->n[0],
                             v->n[1], v->n[2], "spacing", v->spacing, "origin", v->origin[0], v->origin[1],
                             v->origin[2], "labels", ms_label_list_json(row, input->labels.count));
    ms_json_object_merge(&json, ms_input_volume_json(&input->origin));
    return json;
}

/* Of a volume of several labels, of which none was chosen. */
static ms_status list_labels(const ms_input *input, int as_json, ms_error *err)
{
    const ms_scan *v = &input->scan;
    const size_t count = input->labels.count;
    ms_label_row *row;
    ms_status status = ms_label_list_make(&row, &input->labels, v, err);
    if (status == MS_OK && as_json) {
        status = ms_report_print(stdout, labels_json(input, row), err);
    } else if (status == MS_OK) {
        printf("%s: %dx%dx%d voxels of %.9g, %zu labels; --label L tells more of one\n", input->path, v->n[0], v->n[1],
               v->n[2], v->spacing, count);
        ms_label_list_print(stdout, row, count);
    }
    free(row);
    return status;
}

static ms_status tell_shape(ms_input *input, const info_arguments *a, ms_error *err)
{
    info_facts f;
    ms_status status = gather(&f, input, &a->input, err);
    if (status == MS_OK && a->expect) {
        status = ms_expectation_find(&f.expect, input, err);
    }
    if (status == MS_OK && a->json) {
        return ms_report_print(stdout, facts_json(&f), err);
    }
    if (status == MS_OK) {
        print_facts(&f);
    }
    return status;
}

static int run_info(const ms_command *command, int argc, char **argv)
{
    info_arguments a = {0};
    int first;
    ms_error err;
    ms_input input;
    ms_input_defaults(&a.input);
    const int code = ms_flags_parse(&first, command, 0, argc, argv, take_info_flag, &a);
    if (code != MS_FLAGS_GO_ON) {
        return code;
    }
    if (argc - first != 1) {
        return ms_flags_wrong_words(command, "takes one shape", 1, argc - first, argv + first);
    }
    ms_status status = ms_input_read(&input, argv[first], &a.input, &err);
    if (status != MS_OK) {
        return ms_flags_fail(command, &err);
    }
    const int is_list = input.labels.count > 1 && !a.input.label;
    if (is_list && a.expect) {
        ms_input_free(&input);
        return ms_flags_wrong_usage(command, "--expect is of one shape; give --label L beside it");
    }
    status = is_list ? list_labels(&input, a.json, &err) : tell_shape(&input, &a, &err);
    ms_input_free(&input);
    return status == MS_OK ? EXIT_DONE : ms_flags_fail(command, &err);
}

const ms_command ms_command_info = {
    .name = "info",
    .summary = "what a shape is: closed or not, volume, inertia, principal frame; the labels of a volume",
    .usage = "SHAPE [--expect] [--json] [--label L] [--weld SHARE] [--fill-holes EDGES] [--drop-bodies SHARE] "
             "[--max-memory SIZE]",
    .example = "mskit info grain.stl",
    .flags = FLAGS,
    .run = run_info,
};
