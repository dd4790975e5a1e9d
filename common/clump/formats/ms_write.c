#include "ms_write.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/ms_choice.h"
#include "base/ms_escape.h"
#include "base/ms_file.h"
#include "ms_fields.h"
#include "ms_formats.h"

const ms_format ms_formats[] = {
    {"csv", "csv", "x,y,z,r in the unit and frame of the shape", MS_NEED_SPHERES, ms_xyzr_read,
     .part = {{"", ms_xyzr_write}}},
    {"json", "json", "spheres, scores and all that is needed to repeat the run", MS_NEED_SPHERES, ms_json_read,
     .part = {{"", ms_json_write}}},
    {"vtk", "vtk", "points with radius, for ParaView", MS_NEED_SPHERES, NULL, .part = {{"", ms_vtk_write}}},
    {"liggghts", "liggghts", "sphere file, and a script with its particletemplate/multisphere", MS_NEED_PARTICLE,
     ms_liggghts_read, .part = {{"", ms_liggghts_write}, {".in", ms_liggghts_script}},
     .packing = {{"", ms_liggghts_packing}, {".in", ms_liggghts_settle}}, .mixture = {{".in", ms_liggghts_mixture}},
     .scene = {".in", ms_liggghts_scene}},
    {"lammps", "lammps", "molecule file for fix rigid/small, and a script", MS_NEED_MASSES, ms_lammps_read,
     .part = {{"", ms_lammps_write}, {".in", ms_lammps_script}}, .sum = MS_SUM_MASSES,
     .sums = "LAMMPS sums the spheres without 'reinit no', and after create_atoms",
     .packing = {{"", ms_lammps_packing}, {".bodies", ms_lammps_bodies}, {".in", ms_lammps_settle}},
     .mixture = {{".in", ms_lammps_mixture}}, .scene = {".in", ms_lammps_scene}},
    {"yade", "yade", "file for ymport.textClumps, and a script", MS_NEED_PARTICLE, ms_xyzr_read_yade,
     .part = {{"", ms_yade_write}, {".py", ms_yade_script}},
     .packing = {{"", ms_yade_packing}, {".py", ms_yade_settle}},
     .mixture = {{"", ms_yade_kinds}, {".py", ms_yade_mixture}}, .scene = {".py", ms_yade_scene}},
    {"mercury", "mercury", "folder for MercuryDPM's ClumpInput", MS_NEED_PARTICLE, NULL,
     .part = {{"/Clump/Clump.txt", ms_mercury_write_clump},
              {"/Inertia/Mass.txt", ms_mercury_write_mass},
              {"/Inertia/TOI.txt", ms_mercury_write_inertia},
              {"/Inertia/PD.txt", ms_mercury_write_axes}}},
    {"deme", "deme", "Chrono DEM-Engine's x,y,z,r", MS_NEED_PARTICLE, ms_xyzr_read, .part = {{"", ms_deme_write}}},
    {"kratos", "clu", "Kratos cluster file", MS_NEED_PARTICLE, NULL, .part = {{"", ms_kratos_write}}},
    {"mfix", "mfix", "MFiX gsp_config.csv", MS_NEED_PARTICLE, NULL, .part = {{"", ms_mfix_write}},
     .sum = MS_SUM_VOLUMES, .sums = "MFiX sums the spheres at one density, overlaps and all"},
    {"pfc", "pfc", "PFC command clump template create", MS_NEED_PARTICLE, NULL, .part = {{"", ms_pfc_write}}},
    {0},
};

const ms_format *ms_write_format_find(const char *name, ms_error *err)
{
    ms_choice choice = {.typed = name};
    for (const ms_format *f = ms_formats; f->name; f++) {
        if (ms_choice_offer(&choice, f->name)) {
            return f;
        }
    }
    ms_choice_fail(&choice, err, "there is no clump format '%s'", name);
    return NULL;
}

const ms_format *ms_write_format_of_path(const char *path, ms_error *err)
{
    char ending[16];
    ms_file_ending(ending, path);
    for (const ms_format *f = ms_formats; f->name; f++) {
        if (strcmp(f->ending, strcmp(path, "-") == 0 ? "csv" : ending) == 0) {
            return f;
        }
    }
    return ms_write_format_find(ending, err);
}

int ms_write_format_is_folder(const ms_format *format)
{
    return format->part[0].suffix[0] == '/';
}

/* Makes the folders on the way to a file. */
static ms_status make_folders(char *path, size_t from, ms_error *err)
{
    for (char *slash = strchr(path + from, '/'); slash; slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        struct stat info;
        const int made = mkdir(path, 0777) == 0, why = made ? 0 : errno;
        if (!made && (stat(path, &info) != 0 || !S_ISDIR(info.st_mode))) {
            return ms_fail(err, MS_ERR_IO, "the folder '%s' cannot be made: %s", path, strerror(why));
        }
        *slash = '/';
    }
    return MS_OK;
}

/* The first `stem` characters of `path` and the suffix; the caller frees it. */
static char *name_part(const char *path, size_t stem, const ms_part *part, ms_error *err)
{
    const size_t room = stem + strlen(part->suffix) + 1;
    char *name = malloc(room);
    if (name) {
        snprintf(name, room, "%.*s%s", (int)stem, path, part->suffix);
    } else {
        ms_fail(err, MS_ERR_NOMEM, "%s: no memory to write it", path);
    }
    return name;
}

static ms_status write_part(const ms_content *content, const char *path, size_t stem, const ms_part *part,
                            ms_error *err)
{
    ms_output output;
    char *name = name_part(path, stem, part, err);
    if (!name) {
        return MS_ERR_NOMEM;
    }
    ms_status status = part->suffix[0] == '/' ? make_folders(name, stem, err) : MS_OK;
    if (status == MS_OK) {
        status = ms_output_open(&output, name, err);
    }
    if (status == MS_OK) {
        status = ms_output_close(&output, part->write(output.stream, content, err), err);
    }
    free(name);
    return status;
}

/* Length of the path without the ending of its file. */
static size_t stem_length(const char *path)
{
    const char *base = ms_file_base_name(path), *dot = strrchr(base, '.');
    return dot && dot > base ? (size_t)(dot - path) : strlen(path);
}

static const ms_part FRAME = {".frame.json", ms_json_write_frame};

static ms_status write_template(const ms_content *content, const char *path, const ms_format *format, ms_error *err)
{
    const int alone = strcmp(path, "-") == 0;
    ms_template made;
    ms_status status = ms_template_make(&made, content->clump, content->particle, err);
    const ms_content inner = {&made.clump, &made.particle, content->record, content->more, content->name};
    for (const ms_part *part = format->part; status == MS_OK && part->suffix; part++) {
        status = write_part(&inner, path, strlen(path), part, err);
        if (alone) {
            ms_template_free(&made);
            return status;
        }
    }
    if (status == MS_OK) {
        status = write_part(content, path, stem_length(path), &FRAME, err);
    }
    ms_template_free(&made);
    return status;
}

ms_status ms_write_check(const ms_content *content, const ms_format *format, ms_error *err)
{
    if (format->need == MS_NEED_SPHERES) {
        return MS_OK;
    }
    if (!content->particle || !(content->particle->mass > 0) || !(content->particle->density > 0)) {
        return ms_fail(err, MS_ERR_ARG,
                       "a %s template needs the mass, inertia and density of the particle; correct the clump first "
                       "(mskit correct)",
                       format->name);
    }
    if (format->need == MS_NEED_MASSES && !content->clump->mass) {
        return ms_fail(err, MS_ERR_ARG,
                       "a %s template needs a mass for each sphere; correct the clump first (mskit correct)",
                       format->name);
    }
    return MS_OK;
}

ms_status ms_write_list(const char *path, const ms_format *format,
                        ms_status (*take)(void *context, const char *path, int is_frame, ms_error *err), void *context,
                        ms_error *err)
{
    const int is_template = format->need != MS_NEED_SPHERES;
    ms_status status = MS_OK;
    for (const ms_part *part = format->part; status == MS_OK && strcmp(path, "-") != 0;) {
        const int is_frame = part == &FRAME;
        char *name = name_part(path, is_frame ? stem_length(path) : strlen(path), part, err);
        status = name ? take(context, name, is_frame, err) : MS_ERR_NOMEM;
        free(name);
        if (is_frame || (!part[1].suffix && !is_template)) {
            break;
        }
        part = part[1].suffix ? part + 1 : &FRAME;
    }
    return status;
}

ms_status ms_write_check_path(const char *path, const ms_format *format, ms_error *err)
{
    const char *name = ms_file_base_name(path);
    int fits = 1;
    for (const ms_part *part = format->part; part->suffix; part++) {
        fits = fits && (part->write != ms_lammps_script || ms_escape_fits_lammps(name)) &&
               (part->write != ms_liggghts_script || ms_escape_fits_liggghts(name));
    }
    return fits ? MS_OK
                : ms_fail(err, MS_ERR_ARG,
                          "%s: no script of %s can name this file, which has control characters, both kinds of quotes, "
                          "or letters that it does not take; name another",
                          path, format->name);
}

char *ms_write_path(const char *folder, const char *source, const char *behind, const ms_format *format)
{
    size_t length;
    const char *stem = ms_file_stem(&length, source);
    const size_t room = strlen(folder) + length + strlen(behind) + strlen(format->ending) + 3;
    char *path = malloc(room);
    if (path) {
        const int start = snprintf(path, room, "%s%s", folder, folder[0] ? "/" : "");
        snprintf(path + start, room - (size_t)start, "%.*s%s.%s", (int)length, stem, behind, format->ending);
        ms_escape_file_name(path + start);
        if (ms_write_check_path(path, format, NULL) != MS_OK) {
            ms_escape_script_name(path + start);
        }
    }
    return path;
}

/* A sphere that is next to nothing beside its mass has a density that no file could give back. */
static ms_status check_densities(const ms_content *content, ms_error *err)
{
    for (size_t s = 0; ms_fields_has_masses(content) && s < ms_fields_count(content); s++) {
        if (!isfinite(ms_fields_density(content, s))) {
            return ms_fail(err, MS_ERR_ARG,
                           "sphere %zu, of radius %g and %g kg, has a density that no number holds; are clump and "
                           "particle in one unit?",
                           s + 1, content->clump->sphere[s].radius, content->clump->mass[s]);
        }
    }
    return MS_OK;
}

ms_status ms_write_clump(const ms_content *content, const char *path, const ms_format *format, ms_error *err)
{
    ms_content named = *content;
    format = format ? format : ms_write_format_of_path(path, err);
    if (!format) {
        return MS_ERR_ARG;
    }
    named.name = ms_file_base_name(path);
    ms_status status = ms_write_check(content, format, err);
    if (status == MS_OK) {
        status = check_densities(content, err);
    }
    if (status == MS_OK) {
        status = ms_write_check_path(path, format, err);
    }
    if (status != MS_OK) {
        return status;
    }
    return format->need == MS_NEED_SPHERES ? write_part(&named, path, strlen(path), format->part, err)
                                           : write_template(&named, path, format, err);
}
