#include "ms_scene_script.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_file.h"
#include "clump/ms_packing.h"
#include "ms_write_packing.h"

/* Half a vessel's width over the reach of a particle, at least. */
static const double ROOM = 1.2;

/* The name of a template without folder and ending. The caller frees it; NULL without memory. */
static char *name_of(const char *path)
{
    const char *name = ms_file_base_name(path), *dot = strrchr(name, '.');
    return dot ? strndup(name, (size_t)(dot - name)) : strdup(name);
}

static ms_status add_kind(ms_packing *packing, const ms_scene_kind *from, ms_error *err)
{
    ms_template made;
    ms_status status = ms_template_make(&made, from->clump, from->particle, err);
    ms_placed *kind = &packing->placed[packing->count];
    *kind = (ms_placed){.number = packing->count, .name = name_of(from->path), .scale = 1, .count = from->count};
    packing->count++;
    if (status == MS_OK) { /* handed on */
        kind->clump = made.clump;
        kind->particle = made.particle;
    }
    return status == MS_OK && !kind->name ? ms_fail(err, MS_ERR_NOMEM, "no memory for the kinds of particles") : status;
}

/* The largest first; what is alike stays in its order. */
static int order_of_kinds(const void *a, const void *b)
{
    const ms_placed *x = a, *y = b;
    const double of_x = ms_template_reach(&x->clump), of_y = ms_template_reach(&y->clump);
    return of_x > of_y ? -1 : of_x < of_y ? 1 : (x->number > y->number) - (x->number < y->number);
}

static ms_status fill_packing(ms_packing *packing, const ms_scene_kind *kind, size_t count,
                              const ms_scene_vessel *vessel, ms_error *err)
{
    ms_status status = MS_OK;
    *packing = (ms_packing){.placed = calloc(count, sizeof *packing->placed), .is_round = vessel->is_round};
    if (!packing->placed) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu kinds of particles", count);
    }
    for (int k = 0; k < 2; k++) {
        packing->width[k] = vessel->width[k] * kind[0].particle->scale;
    }
    for (size_t n = 0; n < count && status == MS_OK; n++) {
        status = add_kind(packing, &kind[n], err);
    }
    return status;
}

ms_status ms_scene_script_check(const ms_scene_kind *kind, size_t count, const ms_scene_vessel *vessel, ms_error *err)
{
    const double width = fmin(vessel->width[0], vessel->width[1]);
    ms_status status = MS_OK;
    for (size_t n = 0; n < count && width > 0 && status == MS_OK; n++) {
        ms_template made;
        status = ms_template_make(&made, kind[n].clump, kind[n].particle, err);
        if (status != MS_OK) {
            return status;
        }
        const double reach = ms_template_reach(&made.clump) / kind[n].particle->scale;
        if (width < 2 * ROOM * reach) {
            status = ms_fail(err, MS_ERR_ARG,
                             "%s reaches %.4g from its centre, which takes a vessel of %.4g; the %s has %.4g",
                             kind[n].name, reach, 2 * ROOM * reach, vessel->is_round ? "cylinder" : "box", width);
        }
        ms_template_free(&made);
    }
    return status;
}

/* FOLDER/scene.ENDING and what stands behind it. */
static char *join_path(const char *folder, const ms_format *format, const char *behind)
{
    const size_t room = strlen(folder) + strlen(format->ending) + strlen(behind) + sizeof "/scene.";
    char *path = malloc(room);
    if (path) {
        snprintf(path, room, "%s/scene.%s%s", folder, format->ending, behind);
    }
    return path;
}

char *ms_scene_script_path(const char *folder, const ms_format *format)
{
    return join_path(folder, format, format->scene.suffix);
}

ms_status ms_scene_script_write(const ms_scene_kind *kind, size_t count, const ms_scene_vessel *vessel,
                                const char *folder, const ms_format *format, ms_error *err)
{
    ms_packing packing;
    char *path = join_path(folder, format, "");
    ms_status status = path ? fill_packing(&packing, kind, count, vessel, err)
                            : ms_fail(err, MS_ERR_NOMEM, "no memory for the name of a script");
    if (path) {
        if (status == MS_OK) {
            qsort(packing.placed, packing.count, sizeof *packing.placed, order_of_kinds);
            status = ms_write_scene(&packing, path, format, err);
        }
        ms_packing_free(&packing);
    }
    free(path);
    return status;
}
