/* mskit convert CLUMP -o FILE */
#include <math.h>
#include <omp.h>
#include <string.h>

#include "base/ms_file.h"
#include "cli/ms_input.h"
#include "cli/ms_mass.h"
#include "cli/ms_outputs.h"
#include "clump/formats/ms_read.h"
#include "measure/ms_metrics.h"
#include "ms_commands.h"
#include "view/ms_view_formats.h"

static const ms_flag FLAGS[] = {
    {"frame", 0, "FILE", "the STEM.frame.json beside a template: carries it back into the frame of the shape"},
    MS_UNIT_FLAGS,
    MS_OUTPUT_FLAGS,
    {"target", 't', "SHAPE", "the mesh or volume that the clump stands for: pages and pictures show it, too"},
    MS_INPUT_FLAGS,
    {0},
};

typedef struct convert_arguments {
    const char *clump, *frame, *target;
    const char *of_target;  /* a flag that was given and is of use with a target alone; NULL: none */
    const char *of_surface; /* likewise, with what shows a clump alone */
    ms_mass_flags mass;
    ms_outputs outputs;
    ms_input_flags input;
    int argc; /* as the command was typed */
    char **argv;
} convert_arguments;

/* Of the flags about a grid those that a surface takes without a target, too. */
static int is_of_surface(const char *name)
{
    static const char *const NAMES[] = {"cells", "voxel-size", "max-voxels", "max-memory", "threads"};
    for (size_t n = 0; n < sizeof NAMES / sizeof *NAMES; n++) {
        if (strcmp(name, NAMES[n]) == 0) {
            return 1;
        }
    }
    return 0;
}

static ms_status take_convert_flag(void *context, const char *name, const char *value, ms_error *err)
{
    convert_arguments *a = context;
    int taken;
    ms_status status = ms_input_flag(&taken, &a->input, name, value, err);
    if (taken && !is_of_surface(name)) {
        a->of_target = name;
    } else if (taken && strcmp(name, "threads") != 0 && strcmp(name, "max-memory") != 0) {
        a->of_surface = name;
    }
    if (!taken) {
        status = ms_mass_flag(&taken, &a->mass, name, value, err);
    }
    if (!taken) {
        status = ms_outputs_flag(&taken, &a->outputs, name, value, err);
    }
    if (!taken) {
        *(strcmp(name, "target") == 0 ? &a->target : &a->frame) = value;
    }
    return status;
}

/* What the file does not say of the particle: from the sums of the spheres and from the flags. */
static ms_status complete_particle(ms_particle *particle, const convert_arguments *a, const ms_clump *clump,
                                   ms_error *err)
{
    if (particle->mass > 0 && (a->mass.unit || a->mass.scale > 0) && a->mass.scale != particle->scale) {
        return ms_fail(err, MS_ERR_ARG, "%s says that its unit is %g m, and not %g", ms_file_name(a->clump),
                       particle->scale, a->mass.scale);
    }
    if (particle->density > 0 && a->mass.density > 0 && a->mass.density != particle->density) {
        return ms_fail(err, MS_ERR_ARG, "%s says that its density is %.9g kg/m^3; another takes mskit correct",
                       ms_file_name(a->clump), particle->density);
    }
    if (!(particle->mass > 0) && clump->mass) {
        ms_status status = ms_particle_from_spheres(particle, clump, a->mass.scale > 0 ? a->mass.scale : 1, err);
        if (status != MS_OK) {
            return status;
        }
    }
    if (a->mass.density > 0 && !(particle->mass > 0)) {
        return ms_fail(err, MS_ERR_ARG, "%s has no masses that --density could go with; mskit correct finds them",
                       ms_file_name(a->clump));
    }
    if (a->mass.density > 0) {
        particle->density = a->mass.density;
    }
    return MS_OK;
}

static ms_status read_clump(ms_clump *clump, ms_particle *particle, const convert_arguments *a, ms_error *err)
{
    ms_status status = ms_read_clump(clump, particle, a->clump, err);
    if (status == MS_OK && a->frame) {
        status = ms_read_particle(particle, a->frame, err);
        if (status == MS_OK) {
            status = ms_template_undo(clump, particle, err);
        }
    }
    return status == MS_OK ? complete_particle(particle, a, clump, err) : status;
}

/* The lattice of surfaces without a target: so many cells along the shortest side of the clump. */
static double find_lattice(const convert_arguments *a, const ms_clump *clump)
{
    double lo[3], hi[3];
    ms_clump_box(lo, hi, clump);
    const double side = fmin(hi[0] - lo[0], fmin(hi[1] - lo[1], hi[2] - lo[2]));
    return a->input.voxel_size > 0 ? a->input.voxel_size : a->input.cells > 0 ? side / a->input.cells : 0;
}

static ms_status write_converted(const convert_arguments *a, ms_content *content, ms_view_about *about, ms_error *err)
{
    about->ordered = 1;
    about->max_points = ms_input_max_voxels(&a->input);
    about->argc = a->argc;
    about->argv = a->argv;
    content->more = about;
    return ms_outputs_write(&a->outputs, content, ms_outputs_to_stdout(&a->outputs) ? stderr : stdout, err);
}

static ms_status write_with_target(const convert_arguments *a, ms_content *content, ms_error *err)
{
    ms_input input;
    ms_metrics metrics;
    ms_status status = ms_input_read(&input, a->target, &a->input, err);
    if (status != MS_OK) {
        return status;
    }
    status = ms_input_target(&input, &a->input, err);
    if (status == MS_OK) {
        status = ms_metrics_compute(&metrics, NULL, &input.target, content->clump, ms_input_max_voxels(&a->input), err);
    }
    if (status == MS_OK) {
        ms_view_about about = {
            .shape = input.path, .target = &input.target, .metrics = &metrics, .h = input.target.grid.h};
        status = write_converted(a, content, &about, err);
    }
    ms_input_free(&input);
    return status;
}

static ms_status execute_convert(convert_arguments *a, ms_error *err)
{
    ms_clump clump;
    ms_particle particle;
    if (a->input.threads) {
        omp_set_num_threads(a->input.threads);
    }
    ms_status status = read_clump(&clump, &particle, a, err);
    if (status == MS_OK) {
        const int known = particle.mass > 0 && particle.density > 0;
        const ms_need need = !known ? MS_NEED_SPHERES : clump.mass ? MS_NEED_MASSES : MS_NEED_PARTICLE;
        ms_content content = {.clump = &clump, .particle = particle.mass > 0 ? &particle : NULL};
        ms_view_about about = {.h = find_lattice(a, &clump)};
        status = ms_outputs_resolve(&a->outputs, a->clump, "", need, 0, err);
        if (status == MS_OK) {
            status = ms_outputs_check(&a->outputs, a->clump, a->frame, a->target, err);
        }
        if (status == MS_OK) {
            status = a->target ? write_with_target(a, &content, err) : write_converted(a, &content, &about, err);
        }
    }
    ms_clump_free(&clump);
    return status;
}

/* Checks the flags; what can be written of the clump is known when it is read. */
static ms_status resolve_convert(convert_arguments *a, ms_error *err)
{
    const int unit_given = a->mass.unit || a->mass.scale > 0;
    ms_status status = unit_given ? ms_mass_resolve(&a->mass, err) : MS_OK;
    if (status == MS_OK && !a->target && a->of_target) {
        return ms_fail(err, MS_ERR_ARG, "--%s is about a shape and takes --target SHAPE beside it", a->of_target);
    }
    if (status == MS_OK) {
        status = ms_outputs_resolve(&a->outputs, a->clump, "", MS_NEED_MASSES, 0, err);
    }
    const char *of_shown = a->target ? "target" : a->of_surface;
    return status == MS_OK && of_shown && !ms_outputs_shown(&a->outputs)
               ? ms_fail(err, MS_ERR_ARG, "--%s is for pages, pictures and surfaces, and no output is one", of_shown)
               : status;
}

static int run_convert(const ms_command *command, int argc, char **argv)
{
    convert_arguments a = {.argc = argc, .argv = argv};
    int first;
    ms_error err;
    ms_input_defaults(&a.input);
    int code = ms_flags_parse(&first, command, 0, argc, argv, take_convert_flag, &a);
    if (code != MS_FLAGS_GO_ON) {
        return code;
    }
    if (argc - first != 1) {
        return ms_flags_wrong_words(command, "takes one clump file", 1, argc - first, argv + first);
    }
    a.clump = argv[first];
    const char *const inputs[] = {a.clump, a.target};
    ms_status status = ms_files_check_standard(inputs, 2, &err);
    if (status == MS_OK) {
        status = resolve_convert(&a, &err);
    }
    if (status != MS_OK) {
        code = ms_flags_refuse(command, status, &err);
    } else {
        code = execute_convert(&a, &err) == MS_OK ? EXIT_DONE : ms_flags_fail(command, &err);
    }
    ms_outputs_free(&a.outputs);
    return code;
}

const ms_command ms_command_convert = {
    .name = "convert",
    .summary = "write a clump file in other formats",
    .usage = "CLUMP -o FILE...",
    .example = "mskit convert grain.json -o grain.liggghts -o grain.yade",
    .flags = FLAGS,
    .run = run_convert,
};
