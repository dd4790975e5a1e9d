#include "ms_library_mixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/ms_escape.h"
#include "base/ms_file.h"
#include "clump/formats/ms_read.h"
#include "clump/formats/ms_write_packing.h"
#include "clump/ms_union.h"

/* A template of the library: where it comes from, and what all its sizes share. */
typedef struct template_of {
    char stem[512];   /* in the folder of the table, without ending */
    const char *name; /* the same, without folder */
    ms_clump clump;
    double density;
} template_of;

/* The ending of the table's files is that of the first format of its run. */
static void cut_stem(template_of *t, const char *file)
{
    snprintf(t->stem, sizeof t->stem, "%s", file);
    t->name = ms_file_base_name(t->stem);
    char *dot = strrchr(t->stem, '.');
    if (dot && dot > t->name) {
        *dot = '\0';
    }
}

static void path_of(char *out, size_t size, const char *folder, const char *stem, const ms_format *format)
{
    snprintf(out, size, "%s/%s.%s", folder, stem, format->ending);
}

/* Has each grain a template of the format, and a mass? */
static int has_all(const ms_library *l, const template_of *all, const char *from, const ms_format *format)
{
    int has = format->mixture[0].suffix && format->read;
    for (size_t j = 0; j < l->choice.k && has; j++) {
        char path[4096];
        path_of(path, sizeof path, from, all[j].stem, format);
        has = access(path, R_OK) == 0 && l->table->grain[l->choice.grain[j]].found.place.mass > 0;
    }
    return has;
}

static ms_status copy_template(const char *from, const char *to, ms_error *err)
{
    ms_bytes bytes;
    ms_output output;
    ms_status status = ms_file_read(&bytes, from, err);
    if (status != MS_OK) {
        return status;
    }
    status = ms_output_open(&output, to, err);
    if (status == MS_OK) {
        fwrite(bytes.data, 1, bytes.size, output.stream);
        status = ms_output_close(&output, MS_OK, err);
    }
    ms_file_free(&bytes);
    return status;
}

/* The table has mass and volume, but the latter in the unit of its source; the union of the spheres tells how long
 * that is in metres. */
static ms_status find_density(template_of *t, const ms_library_grain *grain, ms_error *err)
{
    double volume, area;
    const ms_status status = ms_union_measure(&volume, &area, &t->clump, err);
    const double scale = cbrt(6 * volume / acos(-1.0)) / grain->clump[MS_LIBRARY_SIZE];
    t->density = grain->found.place.mass / (pow(scale, 3) * grain->found.volume);
    return status;
}

static ms_status take_template(template_of *t, const ms_library_grain *grain, const char *from, const char *folder,
                               const ms_format *format, ms_error *err)
{
    char source[4096], own[4096];
    ms_particle ignored;
    if (!ms_escape_fits_lammps(t->name) || !ms_escape_fits_liggghts(t->name)) {
        return ms_fail(err, MS_ERR_ARG, "'%.60s' is a name that no script can hold; rename the grain", t->name);
    }
    path_of(source, sizeof source, from, t->stem, format);
    path_of(own, sizeof own, folder, t->name, format);
    ms_status status = copy_template(source, own, err);
    ms_clump_free(&t->clump);
    if (status == MS_OK) {
        status = ms_read_clump(&t->clump, &ignored, own, err);
    }
    return status == MS_OK ? find_density(t, grain, err) : status;
}

/* The table may say what no particle is. */
static ms_status check_kind(const ms_placed *kind, ms_error *err)
{
    ms_error cause;
    const ms_status status = ms_particle_check(&kind->particle, &cause);
    return status == MS_OK ? status
                           : ms_fail(err, status, "%s, %g times its size: %s", kind->name, kind->scale, cause.text);
}

/* A kind of particles: a grain in one size, which is `scale` times its own. */
static ms_status add_kind(ms_packing *mixture, const template_of *t, const ms_grain_place *place, double scale,
                          double share, ms_error *err)
{
    ms_placed *kind = &mixture->placed[mixture->count];
    *kind = (ms_placed){.name = strdup(t->name), .scale = scale, .share = share};
    mixture->count++;
    ms_status status = kind->name ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for the kinds of particles");
    for (size_t s = 0; s < t->clump.n_spheres && status == MS_OK; s++) {
        status = ms_clump_add(&kind->clump, &t->clump.sphere[s], err);
    }
    for (size_t c = 0; c < t->clump.n_carriers && status == MS_OK; c++) {
        status = ms_clump_add_carrier(&kind->clump, &t->clump.sphere[t->clump.n_spheres + c], err);
    }
    kind->particle = (ms_particle){.scale = 1, .density = t->density, .mass = place->mass * pow(scale, 3)};
    for (int m = 0; m < 3; m++) {
        kind->particle.inertia[m][m] = place->moment[m] * pow(scale, 5);
    }
    return status == MS_OK ? check_kind(kind, err) : status;
}

/* Grains without weight are left out. */
static ms_status fill_mixture(ms_packing *mixture, const ms_library *l, const template_of *all, ms_error *err)
{
    const size_t sizes = l->size ? l->goal.classes : 1;
    ms_status status = MS_OK;
    *mixture = (ms_packing){.placed = calloc(l->choice.k * sizes, sizeof *mixture->placed)};
    if (!mixture->placed) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu kinds of particles", l->choice.k * sizes);
    }
    for (size_t j = 0; j < l->choice.k && status == MS_OK; j++) {
        const ms_library_grain *grain = &l->table->grain[l->choice.grain[j]];
        const double share = ms_library_number(l, j);
        for (size_t c = 0; c < sizes && share > 0 && status == MS_OK; c++) {
            const double scale = l->size ? l->size[c].diameter / grain->shape[MS_LIBRARY_SIZE] : 1;
            status =
                add_kind(mixture, &all[j], &grain->found.place, scale, share * (l->size ? l->size[c].number : 1), err);
        }
    }
    return status;
}

static ms_status write_mixture(char *names, size_t size, const ms_library *l, template_of *all, const char *from,
                               const char *folder, const ms_format *format, ms_error *err)
{
    char path[4096];
    ms_packing mixture = {0};
    ms_status status = MS_OK;
    for (size_t j = 0; j < l->choice.k && status == MS_OK; j++) {
        status = take_template(&all[j], &l->table->grain[l->choice.grain[j]], from, folder, format, err);
    }
    if (status == MS_OK) {
        status = fill_mixture(&mixture, l, all, err);
    }
    path_of(path, sizeof path, folder, "library", format);
    if (status == MS_OK) {
        status = ms_write_mixture(&mixture, path, format, err);
    }
    const size_t used = strlen(names);
    const ms_packing_part *last = format->mixture;
    for (; last[1].suffix; last++) {
    }
    snprintf(names + used, size - used, "%slibrary.%s%s", used ? ", " : "", format->ending, last->suffix);
    ms_packing_free(&mixture);
    return status;
}

ms_status ms_library_mixture_write(char *names, size_t size, const ms_library *l, const char *from, const char *folder,
                                   ms_error *err)
{
    ms_status status = MS_OK;
    template_of *all = calloc(l->choice.k, sizeof *all);
    names[0] = '\0';
    if (!all) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu templates", l->choice.k);
    }
    for (size_t j = 0; j < l->choice.k; j++) {
        cut_stem(&all[j], l->table->grain[l->choice.grain[j]].found.file);
    }
    for (const ms_format *format = ms_formats; format->name && status == MS_OK; format++) {
        if (has_all(l, all, from, format)) {
            status = write_mixture(names, size, l, all, from, folder, format, err);
        }
    }
    for (size_t j = 0; j < l->choice.k; j++) {
        ms_clump_free(&all[j].clump);
    }
    free(all);
    return status;
}
