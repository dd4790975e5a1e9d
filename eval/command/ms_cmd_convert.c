/* mskit convert CLUMP -o FILE */
#include <string.h>

#include "base/ms_file.h"
#include "cli/ms_mass.h"
#include "cli/ms_outputs.h"
#include "clump/formats/ms_read.h"
#include "ms_commands.h"

static const ms_flag FLAGS[] = {
    {"frame", 0, "FILE", "the STEM.frame.json beside a template: carries it back into the frame of the shape"},
    MS_UNIT_FLAGS,
    MS_OUTPUT_FLAGS,
    {0},
};

typedef struct convert_arguments {
    const char *clump, *frame;
    ms_mass_flags mass;
    ms_outputs outputs;
} convert_arguments;

static ms_status take_convert_flag(void *context, const char *name, const char *value, ms_error *err)
{
    convert_arguments *a = context;
    int taken;
    ms_status status = ms_mass_flag(&taken, &a->mass, name, value, err);
    if (!taken) {
        status = ms_outputs_flag(&taken, &a->outputs, name, value, err);
    }
    if (!taken) {
        a->frame = value;
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

static ms_status check_convert_files(const convert_arguments *a, ms_error *err)
{
    ms_files files = {0};
    ms_status status = ms_files_add(&files, a->clump, MS_FILE_READ, err);
    if (status == MS_OK && a->frame) {
        status = ms_files_add(&files, a->frame, MS_FILE_READ, err);
    }
    if (status == MS_OK) {
        status = ms_outputs_list(&files, &a->outputs, err);
    }
    if (status == MS_OK) {
        status = ms_files_check(&files, err);
    }
    ms_files_free(&files);
    return status;
}

static ms_status execute_convert(convert_arguments *a, ms_error *err)
{
    ms_clump clump;
    ms_particle particle;
    ms_status status = read_clump(&clump, &particle, a, err);
    if (status == MS_OK) {
        const int known = particle.mass > 0 && particle.density > 0;
        const ms_need need = !known ? MS_NEED_SPHERES : clump.mass ? MS_NEED_MASSES : MS_NEED_PARTICLE;
        const ms_content content = {.clump = &clump, .particle = particle.mass > 0 ? &particle : NULL};
        status = ms_outputs_resolve(&a->outputs, a->clump, "", need, 0, err);
        if (status == MS_OK) {
            status = check_convert_files(a, err);
        }
        if (status == MS_OK) {
            status = ms_outputs_write(&a->outputs, &content, ms_outputs_to_stdout(&a->outputs) ? stderr : stdout, err);
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
    return status == MS_OK ? ms_outputs_resolve(&a->outputs, a->clump, "", MS_NEED_MASSES, 0, err) : status;
}

static int run_convert(const ms_command *command, int argc, char **argv)
{
    convert_arguments a = {0};
    int first;
    ms_error err;
    int code = ms_flags_parse(&first, command, 0, argc, argv, take_convert_flag, &a);
    if (code != MS_FLAGS_GO_ON) {
        return code;
    }
    if (argc - first != 1) {
        return ms_flags_wrong_usage(command, "takes one clump file");
    }
    a.clump = argv[first];
    const ms_status status = resolve_convert(&a, &err);
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
