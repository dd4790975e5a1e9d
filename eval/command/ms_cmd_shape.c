/* mskit shape KIND [KEY=VALUE]... -o FILE */
#include <stdio.h>
#include <string.h>

#include "base/ms_choice.h"
#include "base/ms_text.h"
#include "cli/ms_json_object.h"
#include "cli/ms_report.h"
#include "mesh/formats/ms_mesh_read.h"
#include "mesh/formats/ms_mesh_write.h"
#include "ms_commands.h"
#include "shape/ms_shape.h"

static const ms_flag FLAGS[] = {
    {"output", 'o', "FILE", "the mesh: .stl, .obj, .ply or .off; - for OFF on standard output"},
    {"list", 0, NULL, "list the kinds and their parameters"},
    {"json", 0, NULL, "the list as JSON"},
    {0},
};

typedef struct shape_arguments {
    const char *output;
    int list, json;
} shape_arguments;

static ms_status take_shape_flag(void *context, const char *name, const char *value, ms_error *err)
{
    shape_arguments *a = context;
    (void)err;
    if (strcmp(name, "output") == 0) {
        a->output = value;
    } else {
        *(name[0] == 'l' ? &a->list : &a->json) = 1;
    }
    return MS_OK;
}

static void list_kinds(void)
{
    for (const ms_shape_kind *kind = ms_shape_kinds; kind->name; kind++) {
        printf("%s: %s\n", kind->name, kind->summary);
        for (const ms_shape_parameter *p = kind->parameters; p->name; p++) {
            printf("    %-12s %-8g %s\n", p->name, p->fallback, p->help);
        }
    }
}

static json_t *kinds_json(void)
{
    json_t *list = json_array();
    for (const ms_shape_kind *kind = ms_shape_kinds; kind->name; kind++) {
        json_t *parameters = json_array();
        for (const ms_shape_parameter *p = kind->parameters; p->name; p++) {
            ms_json_object_append(&parameters, json_pack("{s:s,s:f,s:f,s:f,s:s}", "name", p->name, "default",
                                                         p->fallback, "min", p->min, "max", p->max, "help", p->help));
        }
        ms_json_object_append(
            &list, json_pack("{s:s,s:s,s:o}", "name", kind->name, "summary", kind->summary, "parameters", parameters));
    }
    return list;
}

static int run_list(const ms_command *command, int json)
{
    ms_error err;
    if (!json) {
        list_kinds();
        return EXIT_DONE;
    }
    return ms_report_print(stdout, kinds_json(), &err) == MS_OK ? EXIT_DONE : ms_flags_fail(command, &err);
}

static ms_status set_value(double *value, const ms_shape_kind *kind, const char *assignment, ms_error *err)
{
    const char *equals = strchr(assignment, '=');
    ms_choice choice = {.typed = assignment, .length = strcspn(assignment, "=")};
    for (const ms_shape_parameter *p = kind->parameters; p->name; p++) {
        if (ms_choice_offer(&choice, p->name) && equals) {
            const ms_word word = {equals + 1, strlen(equals + 1)};
            if (word.length == 0 || !ms_text_to_double(&value[p - kind->parameters], &word)) {
                return ms_fail(err, MS_ERR_ARG, "%s is not a number in %s", equals + 1, assignment);
            }
            return MS_OK;
        }
    }
    return ms_choice_fail(&choice, err, "'%s' does not set a parameter of %s, as %s=%g does (mskit shape --list)",
                          assignment, kind->name, kind->parameters[0].name, kind->parameters[0].fallback);
}

static int make(const ms_command *command, const char *output, int n_words, char **word)
{
    double value[MS_SHAPE_MAX_PARAMETERS];
    ms_error err;
    ms_mesh mesh;
    const ms_shape_kind *kind = ms_shape_find(word[0], &err);
    if (!kind) {
        return ms_flags_wrong_usage(command, err.text);
    }
    for (size_t p = 0; kind->parameters[p].name; p++) {
        value[p] = kind->parameters[p].fallback;
    }
    for (int w = 1; w < n_words; w++) {
        if (set_value(value, kind, word[w], &err) != MS_OK) {
            return ms_flags_wrong_usage(command, err.text);
        }
    }
    ms_status status = ms_shape_make(&mesh, kind, value, &err);
    if (status == MS_OK) {
        status = ms_mesh_write(&mesh, output, &err);
        if (status == MS_OK) {
            fprintf(stderr, "%s: %zu triangles\n", output, mesh.n_triangles);
        }
        ms_mesh_free(&mesh);
    }
    return status == MS_OK ? EXIT_DONE : ms_flags_fail(command, &err);
}

static int run_shape(const ms_command *command, int argc, char **argv)
{
    shape_arguments a = {0};
    int first;
    const int code = ms_flags_parse(&first, command, 0, argc, argv, take_shape_flag, &a);
    if (code != MS_FLAGS_GO_ON) {
        return code;
    }
    if (a.list) {
        return run_list(command, a.json);
    }
    if (a.json) {
        return ms_flags_wrong_usage(command, "--json is of the list; give --list beside it");
    }
    if (first >= argc || !a.output) {
        return ms_flags_wrong_usage(command, "takes a kind of shape and -o FILE; --list shows the kinds");
    }
    if (strcmp(a.output, "-") != 0 && !ms_mesh_read_is_mesh_path(a.output)) {
        return ms_flags_wrong_usage(command,
                                    "a mesh is written as .stl, .obj, .ply or .off; give -o FILE one of these endings");
    }
    return make(command, a.output, argc - first, argv + first);
}

const ms_command ms_command_shape = {
    .name = "shape",
    .summary = "make the mesh of an analytic or test body",
    .usage = "KIND [KEY=VALUE]... -o FILE | --list [--json]",
    .example = "mskit shape ellipsoid a=2 b=1 c=1 -o ellipsoid.stl",
    .flags = FLAGS,
    .run = run_shape,
};
