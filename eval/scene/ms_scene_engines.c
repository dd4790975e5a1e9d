#include "ms_scene_engines.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

/* Of a vessel, so that the area of its floor is a number. */
static const double WIDEST = 1e100;

/* X,Y */
static ms_status take_box(double width[2], const char *value, ms_error *err)
{
    char first[64];
    const char *comma = strchr(value, ',');
    const size_t length = comma ? (size_t)(comma - value) : 0;
    if (!comma || length >= sizeof first) {
        return ms_fail(err, MS_ERR_ARG, "--box '%.60s' is not two widths X,Y", value);
    }
    snprintf(first, sizeof first, "%.*s", (int)length, value);
    ms_status status = ms_flags_number(&width[0], "box", first, DBL_MIN, WIDEST, err);
    return status == MS_OK ? ms_flags_number(&width[1], "box", comma + 1, DBL_MIN, WIDEST, err) : status;
}

ms_status ms_scene_engines_flag(int *taken, ms_scene_engines *e, const char *name, const char *value, ms_error *err)
{
    const int round = strcmp(name, "cylinder") == 0;
    ms_status status;
    if (!round && strcmp(name, "box") != 0) {
        return ms_mass_flag(taken, &e->mass, name, value, err);
    }
    *taken = 1;
    if (e->vessel.width[0] > 0) {
        return ms_fail(err, MS_ERR_ARG, "there is one vessel: give --box or --cylinder, once");
    }
    double *width = e->vessel.width;
    e->vessel.is_round = round;
    status = round ? ms_flags_number(&width[0], name, value, DBL_MIN, WIDEST, err) : take_box(width, value, err);
    width[1] = round ? width[0] : width[1];
    return status;
}

ms_status ms_scene_engines_resolve(ms_scene_engines *e, const ms_format *const *format, size_t formats, ms_error *err)
{
    int scripts = 0;
    if (e->mass.any && !(e->mass.density > 0)) {
        return ms_fail(err, MS_ERR_ARG, "flags about masses take --density beside them");
    }
    for (size_t f = 0; f < formats; f++) {
        if (format[f]->need != MS_NEED_SPHERES && !(e->mass.density > 0)) {
            return ms_fail(err, MS_ERR_ARG,
                           "a %s template needs the mass of the particle; give --density RHO, in kg/m^3",
                           format[f]->name);
        }
        scripts += format[f]->scene.suffix != NULL;
    }
    if (e->vessel.width[0] > 0 && !scripts) {
        return ms_fail(err, MS_ERR_ARG, "--box and --cylinder are of scripts; give --format liggghts, lammps or yade");
    }
    return ms_mass_resolve(&e->mass, err);
}

ms_status ms_scene_engines_correct(ms_scene *scene, const ms_scene_engines *e, size_t max_voxels, ms_error *err)
{
    ms_status status = MS_OK;
    for (size_t s = 0; s < scene->count && e->mass.density > 0 && status == MS_OK; s++) {
        ms_scene_shape *shape = &scene->shape[s];
        ms_error cause;
        status = ms_mass_correct(&shape->mass, &shape->sized, &e->mass, &shape->body, max_voxels, &cause);
        if (status != MS_OK) {
            status = ms_fail(err, status, "%s: %s", ms_manifest_name_row(shape->row).text, cause.text);
        }
    }
    return status;
}

/* The kinds of particles as the scripts take them, in borrowed parts. */
typedef struct engine_kinds {
    ms_scene_kind *kind;
    ms_manifest_name *name;
} engine_kinds;

/* @param f number of the format among the files of each shape */
static ms_status list_kinds(engine_kinds *kinds, const ms_scene *scene, const ms_outputs *outputs, size_t f,
                            ms_error *err)
{
    kinds->kind = calloc(scene->count, sizeof *kinds->kind);
    kinds->name = calloc(scene->count, sizeof *kinds->name);
    if (!kinds->kind || !kinds->name) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu kinds of particles", scene->count);
    }
    for (size_t s = 0; s < scene->count; s++) {
        const ms_scene_shape *shape = &scene->shape[s];
        kinds->name[s] = ms_manifest_name_row(shape->row);
        kinds->kind[s] = (ms_scene_kind){.clump = ms_scene_clump(shape),
                                         .particle = &shape->mass.particle,
                                         .path = outputs[s].file[f].path,
                                         .name = kinds->name[s].text,
                                         .count = (size_t)shape->row->particles};
    }
    return MS_OK;
}

static void free_kinds(engine_kinds *kinds)
{
    free(kinds->kind);
    free(kinds->name);
}

ms_status ms_scene_engines_check(const ms_scene *scene, const ms_scene_engines *e, const ms_outputs *outputs,
                                 ms_error *err)
{
    engine_kinds kinds = {0};
    ms_status status = MS_OK;
    for (size_t s = 0; s < scene->count && status == MS_OK; s++) {
        const ms_scene_shape *shape = &scene->shape[s];
        const ms_content content = {.clump = ms_scene_clump(shape), .particle = &shape->mass.particle};
        for (size_t f = 0; f < outputs[s].n_files && status == MS_OK; f++) {
            ms_error cause;
            status = ms_write_check(&content, outputs[s].file[f].format, &cause);
            if (status != MS_OK) {
                status = ms_fail(err, status, "%s: %s", ms_manifest_name_row(shape->row).text, cause.text);
            }
        }
    }
    if (status != MS_OK || !(e->vessel.width[0] > 0)) {
        return status;
    }
    status = list_kinds(&kinds, scene, outputs, 0, err);
    if (status == MS_OK) {
        status = ms_scene_script_check(kinds.kind, scene->count, &e->vessel, err);
    }
    free_kinds(&kinds);
    return status;
}

static ms_status write_script(const engine_kinds *kinds, const ms_scene *scene, const ms_scene_engines *e,
                              const char *folder, const ms_format *format, FILE *words, ms_error *err)
{
    char *path = ms_scene_script_path(folder, format);
    const ms_status status = path ? ms_scene_script_write(kinds->kind, scene->count, &e->vessel, folder, format, err)
                                  : ms_fail(err, MS_ERR_NOMEM, "no memory for the name of a script");
    if (status == MS_OK) {
        fprintf(words, "wrote %s\n", path);
    }
    free(path);
    return status;
}

ms_status ms_scene_engines_write(const ms_scene *scene, const ms_scene_engines *e, const ms_outputs *outputs,
                                 const char *folder, FILE *words, ms_error *err)
{
    ms_status status = MS_OK;
    for (size_t f = 0; f < outputs[0].n_files && status == MS_OK; f++) {
        const ms_format *format = outputs[0].file[f].format;
        engine_kinds kinds = {0};
        if (!format->scene.suffix) {
            continue;
        }
        status = list_kinds(&kinds, scene, outputs, f, err);
        if (status == MS_OK) {
            status = write_script(&kinds, scene, e, folder, format, words, err);
        }
        free_kinds(&kinds);
    }
    return status;
}
