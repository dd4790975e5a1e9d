#include "ms_scene_engines.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "clump/formats/ms_write_packing.h"
#include "clump/ms_packing.h"

/* Half a vessel's width over the reach of a particle, at least. */
static const double ROOM = 1.2;

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
    if (e->width[0] > 0) {
        return ms_fail(err, MS_ERR_ARG, "there is one vessel: give --box or --cylinder, once");
    }
    e->is_round = round;
    status = round ? ms_flags_number(&e->width[0], name, value, DBL_MIN, WIDEST, err) : take_box(e->width, value, err);
    e->width[1] = round ? e->width[0] : e->width[1];
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
    if (e->width[0] > 0 && !scripts) {
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

/* The name of a template without folder and ending. The caller frees it; NULL without memory. */
static char *name_of(const ms_output_file *file)
{
    const char *slash = strrchr(file->path, '/');
    char *name = strdup(slash ? slash + 1 : file->path);
    if (name) {
        name[strlen(name) - strlen(file->format->ending) - 1] = '\0';
    }
    return name;
}

/* The particles of a shape. @param file its template */
static ms_status add_kind(ms_packing *packing, const ms_scene_shape *shape, const ms_output_file *file, ms_error *err)
{
    ms_template made;
    ms_status status = ms_template_make(&made, ms_scene_clump(shape), &shape->mass.particle, err);
    ms_placed *kind = &packing->placed[packing->count];
    *kind = (ms_placed){
        .number = packing->count, .name = name_of(file), .scale = 1, .count = (size_t)shape->row->particles};
    packing->count++;
    if (status == MS_OK) { /* handed on */
        kind->clump = made.clump;
        kind->particle = made.particle;
    }
    return status == MS_OK && !kind->name ? ms_fail(err, MS_ERR_NOMEM, "no memory for the kinds of particles") : status;
}

/* The largest first, which find no room among small ones; what is alike stays in its order. */
static int order_of_kinds(const void *a, const void *b)
{
    const ms_placed *x = a, *y = b;
    const double of_x = ms_template_reach(&x->clump), of_y = ms_template_reach(&y->clump);
    return of_x > of_y ? -1 : of_x < of_y ? 1 : (x->number > y->number) - (x->number < y->number);
}

/* @param f number of the format among the files of each shape */
static ms_status fill_packing(ms_packing *packing, const ms_scene *scene, const ms_scene_engines *e,
                              const ms_outputs *outputs, size_t f, ms_error *err)
{
    ms_status status = MS_OK;
    *packing = (ms_packing){.placed = calloc(scene->count, sizeof *packing->placed), .is_round = e->is_round};
    if (!packing->placed) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu kinds of particles", scene->count);
    }
    for (int k = 0; k < 2; k++) {
        packing->width[k] = e->width[k] * e->mass.scale;
    }
    for (size_t s = 0; s < scene->count && status == MS_OK; s++) {
        status = add_kind(packing, &scene->shape[s], &outputs[s].file[f], err);
    }
    return status;
}

static ms_status check_room(const ms_packing *packing, const ms_scene *scene, const ms_scene_engines *e, ms_error *err)
{
    for (size_t k = 0; k < packing->count && e->width[0] > 0; k++) {
        const double reach = packing->placed[k].scale * ms_template_reach(&packing->placed[k].clump) / e->mass.scale;
        const double width = fmin(e->width[0], e->width[1]);
        if (width < 2 * ROOM * reach) {
            return ms_fail(err, MS_ERR_ARG,
                           "%s reaches %.4g from its centre, which takes a vessel of %.4g; --%s has %.4g",
                           ms_manifest_name_row(scene->shape[k].row).text, reach, 2 * ROOM * reach,
                           e->is_round ? "cylinder" : "box", width);
        }
    }
    return MS_OK;
}

ms_status ms_scene_engines_check(const ms_scene *scene, const ms_scene_engines *e, const ms_outputs *outputs,
                                 ms_error *err)
{
    ms_packing packing;
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
    if (status != MS_OK || !(e->width[0] > 0)) {
        return status;
    }
    status = fill_packing(&packing, scene, e, outputs, 0, err);
    if (status == MS_OK) {
        status = check_room(&packing, scene, e, err);
    }
    ms_packing_free(&packing);
    return status;
}

char *ms_scene_engines_path(const char *folder, const ms_format *format, int suffix)
{
    const char *behind = suffix ? format->scene.suffix : "";
    const size_t room = strlen(folder) + strlen(format->ending) + 16;
    char *path = malloc(room);
    if (path) {
        snprintf(path, room, "%s/scene.%s%s", folder, format->ending, behind);
    }
    return path;
}

static ms_status write_script(const ms_packing *packing, const char *folder, const ms_format *format, FILE *words,
                              ms_error *err)
{
    char *path = ms_scene_engines_path(folder, format, 0);
    ms_status status = path ? ms_write_scene(packing, path, format, err)
                            : ms_fail(err, MS_ERR_NOMEM, "no memory for the name of a script");
    if (status == MS_OK) {
        fprintf(words, "wrote %s%s\n", path, format->scene.suffix);
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
        ms_packing packing;
        if (!format->scene.suffix) {
            continue;
        }
        status = fill_packing(&packing, scene, e, outputs, f, err);
        if (status == MS_OK) {
            qsort(packing.placed, packing.count, sizeof *packing.placed, order_of_kinds);
            status = write_script(&packing, folder, format, words, err);
        }
        ms_packing_free(&packing);
    }
    return status;
}
