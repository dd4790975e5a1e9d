/* mskit correct CLUMP --target SHAPE --density RHO */
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_file.h"
#include "cli/ms_mass.h"
#include "cli/ms_outputs.h"
#include "cli/ms_report.h"
#include "clump/formats/ms_json.h"
#include "clump/formats/ms_read.h"
#include "ms_commands.h"

static const ms_flag FLAGS[] = {
    {"target", 't', "SHAPE", "the mesh or volume that the clump stands for; not with --properties union"},
    {"equal-volume", 0, NULL, "scale the clump about the centroid of the shape until its union has the shape's volume"},
    MS_MASS_FLAGS,
    MS_OUTPUT_FLAGS,
    {"json", 0, NULL, "the particle and what the masses reach, as JSON on standard output"},
    MS_INPUT_FLAGS,
    {0},
};

typedef struct correct_arguments {
    ms_input_flags input;
    ms_mass_flags mass;
    ms_outputs outputs;
    const char *clump, *target;
    const char *of_shape; /* a flag about the shape and its grid; NULL without */
    int json, equal_volume;
} correct_arguments;

static ms_status take_correct_flag(void *context, const char *name, const char *value, ms_error *err)
{
    correct_arguments *a = context;
    int taken;
    ms_status status = ms_input_flag(&taken, &a->input, name, value, err);
    if (taken && strcmp(name, "threads") != 0 && strcmp(name, "max-memory") != 0) {
        a->of_shape = name;
    }
    if (!taken) {
        status = ms_mass_flag(&taken, &a->mass, name, value, err);
    }
    if (!taken) {
        status = ms_outputs_flag(&taken, &a->outputs, name, value, err);
    }
    if (!taken && strcmp(name, "target") == 0) {
        a->target = value;
    }
    a->json |= strcmp(name, "json") == 0;
    a->equal_volume |= strcmp(name, "equal-volume") == 0;
    return status;
}

/* Volume, centre and inertia of the shape: the integrals over a closed mesh need no voxels. */
static ms_status body_of_target(ms_body *body, const correct_arguments *a, ms_error *err)
{
    ms_input input;
    ms_status status = ms_input_read(&input, a->target, &a->input, err);
    if (status != MS_OK) {
        return status;
    }
    status = ms_input_check_flags(&input, &a->input, err);
    if (status == MS_OK && input.mesh.n_triangles && input.report.closed) {
        *body = input.solid.body;
    } else if (status == MS_OK) {
        status = ms_input_target(&input, &a->input, err);
        *body = input.target.body;
    }
    ms_input_free(&input);
    return status;
}

static ms_status report_correct(const correct_arguments *a, const ms_clump *clump, const ms_mass *mass,
                                const ms_equal_volume *volume, ms_error *err)
{
    FILE *words = a->json || ms_outputs_to_stdout(&a->outputs) ? stderr : stdout;
    json_t *json =
        json_pack("{s:o,s:o*}", "masses", ms_mass_json(mass), "equal_volume", ms_report_equal_volume_json(volume));
    char *record = json ? json_dumps(json, JSON_COMPACT) : NULL;
    json_decref(json);
    if (!record) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the record of the run");
    }
    if (!a->json) {
        fprintf(words, "%s, %zu spheres\n", ms_file_name(a->clump), clump->n_spheres);
        ms_mass_print(words, mass);
        ms_report_equal_volume(words, volume);
    }
    const ms_content content = {.clump = clump, .particle = &mass->particle, .record = record};
    ms_status status = ms_outputs_write(&a->outputs, &content, words, err);
    free(record);
    if (status == MS_OK && a->json) {
        status =
            ms_report_print(stdout,
                            json_pack("{s:o,s:o,s:o*}", "particle", ms_json_from_particle(&mass->particle), "masses",
                                      ms_mass_json(mass), "equal_volume", ms_report_equal_volume_json(volume)),
                            err);
    }
    return status;
}

static ms_status execute_correct(const correct_arguments *a, ms_error *err)
{
    ms_clump clump;
    ms_particle unused;
    ms_body body = {0};
    ms_mass mass;
    ms_equal_volume volume = {0};
    if (a->input.threads) {
        omp_set_num_threads(a->input.threads);
    }
    ms_status status = ms_read_clump(&clump, &unused, a->clump, err);
    if (status != MS_OK) {
        return status;
    }
    status = ms_outputs_check(&a->outputs, a->clump, NULL, a->target, err);
    if (status == MS_OK && a->target) {
        status = body_of_target(&body, a, err);
    }
    if (status == MS_OK && a->equal_volume) {
        status = ms_equal_volume_scale(&clump, &volume, &body, err);
        ms_report_equal_volume_remark(a->clump, &volume);
    }
    if (status == MS_OK) {
        status = ms_mass_correct(&mass, &clump, &a->mass, &body, ms_input_max_voxels(&a->input), err);
    }
    if (status == MS_OK) {
        status = report_correct(a, &clump, &mass, &volume, err);
    }
    ms_clump_free(&clump);
    return status;
}

/* What follows from all flags together. */
static ms_status resolve_correct(correct_arguments *a, ms_error *err)
{
    if (!a->target == !a->mass.of_union) {
        return ms_fail(err, MS_ERR_ARG, "takes either --target SHAPE or --properties union");
    }
    if (a->mass.of_union && a->equal_volume) {
        return ms_fail(err, MS_ERR_ARG, "--equal-volume is to the shape, which --properties union takes none of");
    }
    if (a->mass.of_union && a->of_shape) {
        return ms_fail(err, MS_ERR_ARG, "--%s is of a shape, which --properties union takes none of; leave it out",
                       a->of_shape);
    }
    if (!(a->mass.density > 0)) {
        return ms_fail(err, MS_ERR_ARG, "takes --density RHO, in kg/m^3");
    }
    const char *const inputs[] = {a->clump, a->target};
    ms_status status = ms_files_check_standard(inputs, 2, err);
    status = status == MS_OK ? ms_mass_resolve(&a->mass, err) : status;
    if (status == MS_OK) {
        const int only_json = a->json && !a->outputs.n_asked && !a->outputs.n_formats && !a->outputs.folder;
        status = only_json ? MS_OK : ms_outputs_resolve(&a->outputs, a->clump, "", MS_NEED_MASSES, 0, err);
    }
    return status == MS_OK && ms_outputs_to_stdout(&a->outputs) + a->json > 1
               ? ms_fail(err, MS_ERR_ARG, "--json and each - write to standard output; choose one of them")
               : status;
}

static int run_correct(const ms_command *command, int argc, char **argv)
{
    correct_arguments a = {0};
    int first;
    ms_error err;
    ms_input_defaults(&a.input);
    int code = ms_flags_parse(&first, command, 0, argc, argv, take_correct_flag, &a);
    if (code != MS_FLAGS_GO_ON) {
        return code;
    }
    if (argc - first != 1) {
        return ms_flags_wrong_words(command, "takes one clump file", 1, argc - first, argv + first);
    }
    a.clump = argv[first];
    const ms_status status = resolve_correct(&a, &err);
    if (status != MS_OK) {
        code = ms_flags_refuse(command, status, &err);
    } else {
        code = execute_correct(&a, &err) == MS_OK ? EXIT_DONE : ms_flags_fail(command, &err);
    }
    ms_outputs_free(&a.outputs);
    return code;
}

const ms_command ms_command_correct = {
    .name = "correct",
    .summary = "give the spheres masses that sum to the true mass and inertia",
    .usage = "CLUMP --target SHAPE --density RHO [--unit m|mm|um] -o FILE...",
    .example = "mskit correct grain.csv --target grain.stl --density 2650 --unit mm -o grain.json -o grain.lammps",
    .flags = FLAGS,
    .run = run_correct,
};
