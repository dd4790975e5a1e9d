#include "ms_write.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/ms_file.h"
#include "ms_version.h"
#include "ms_write_formats.h"

void ms_write_numbers(FILE *stream, const double *value, size_t count, const char *mark)
{
    for (size_t k = 0; k < count; k++) {
        fprintf(stream, "%s%s", k ? mark : "", ms_text_of_number(value[k]).text);
    }
}

void ms_write_spheres(FILE *stream, const ms_clump *clump, const char *mark, const char *end)
{
    for (size_t s = 0; s < clump->n_spheres; s++) {
        const double *c = clump->sphere[s].centre;
        ms_write_numbers(stream, (const double[]){c[0], c[1], c[2], clump->sphere[s].radius}, 4, mark);
        fputs(end, stream);
    }
}

double ms_write_density(const ms_content *content, size_t sphere)
{
    const double r = content->clump->sphere[sphere].radius * content->particle->scale;
    return content->clump->mass[sphere] / (4 * acos(-1.0) / 3 * r * r * r);
}

static int has_masses(const ms_content *content)
{
    return content->clump->mass && content->particle;
}

ms_status ms_write_csv(FILE *stream, const ms_content *content, ms_error *err)
{
    const ms_clump *clump = content->clump;
    (void)err;
    fputs(has_masses(content) ? "x,y,z,r,mass,density\n" : "x,y,z,r\n", stream);
    for (size_t s = 0; s < clump->n_spheres; s++) {
        const ms_sphere *b = &clump->sphere[s];
        ms_write_numbers(stream, (const double[]){b->centre[0], b->centre[1], b->centre[2], b->radius}, 4, ",");
        if (has_masses(content)) {
            fputc(',', stream);
            ms_write_numbers(stream, (const double[]){clump->mass[s], ms_write_density(content, s)}, 2, ",");
        }
        fputc('\n', stream);
    }
    return MS_OK;
}

static void write_scalars(FILE *stream, const char *name)
{
    fprintf(stream, "SCALARS %s double 1\nLOOKUP_TABLE default\n", name);
}

/* Legacy VTK: points with their radius; in ParaView, a Glyph of spheres scaled by it. */
ms_status ms_write_vtk(FILE *stream, const ms_content *content, ms_error *err)
{
    const ms_clump *clump = content->clump;
    (void)err;
    fputs("# vtk DataFile Version 3.0\nclump by mskit " MS_VERSION "\nASCII\nDATASET POLYDATA\n", stream);
    fprintf(stream, "POINTS %zu double\n", clump->n_spheres);
    for (size_t s = 0; s < clump->n_spheres; s++) {
        ms_write_numbers(stream, clump->sphere[s].centre, 3, " ");
        fputc('\n', stream);
    }
    fprintf(stream, "VERTICES %zu %zu\n", clump->n_spheres, 2 * clump->n_spheres);
    for (size_t s = 0; s < clump->n_spheres; s++) {
        fprintf(stream, "1 %zu\n", s);
    }
    fprintf(stream, "POINT_DATA %zu\n", clump->n_spheres);
    for (int array = 0; array < 3; array++) {
        if (array > 0 && !has_masses(content)) {
            break;
        }
        write_scalars(stream, array == 0 ? "radius" : array == 1 ? "mass" : "density");
        for (size_t s = 0; s < clump->n_spheres; s++) {
            const double value = array == 0   ? clump->sphere[s].radius
                                 : array == 1 ? clump->mass[s]
                                              : ms_write_density(content, s);
            fprintf(stream, "%s\n", ms_text_of_number(value).text);
        }
    }
    return MS_OK;
}

const ms_format ms_formats[] = {
    {"csv", "csv", "x,y,z,r in the unit and frame of the shape", MS_NEED_SPHERES, {{"", ms_write_csv}}},
    {"json",
     "json",
     "spheres, scores and all that is needed to repeat the run",
     MS_NEED_SPHERES,
     {{"", ms_write_json}}},
    {"vtk", "vtk", "points with radius, for ParaView", MS_NEED_SPHERES, {{"", ms_write_vtk}}},
    {"liggghts",
     "liggghts",
     "sphere file, and a script with its particletemplate/multisphere",
     MS_NEED_PARTICLE,
     {{"", ms_write_liggghts}, {".in", ms_write_liggghts_script}}},
    {"lammps",
     "lammps",
     "molecule file for fix rigid/small, and a script",
     MS_NEED_MASSES,
     {{"", ms_write_lammps}, {".in", ms_write_lammps_script}}},
    {"yade",
     "yade",
     "file for ymport.textClumps, and a script",
     MS_NEED_PARTICLE,
     {{"", ms_write_yade}, {".py", ms_write_yade_script}}},
    {"mercury",
     "mercury",
     "folder for MercuryDPM's ClumpInput",
     MS_NEED_PARTICLE,
     {{"/Clump/Clump.txt", ms_write_mercury_clump},
      {"/Inertia/Mass.txt", ms_write_mercury_mass},
      {"/Inertia/TOI.txt", ms_write_mercury_tensor},
      {"/Inertia/PD.txt", ms_write_mercury_axes}}},
    {"deme", "deme", "Chrono DEM-Engine's x,y,z,r", MS_NEED_PARTICLE, {{"", ms_write_deme}}},
    {"kratos", "clu", "Kratos cluster file", MS_NEED_PARTICLE, {{"", ms_write_kratos}}},
    {"mfix", "mfix", "MFiX gsp_config.csv", MS_NEED_PARTICLE, {{"", ms_write_mfix}}},
    {"pfc", "pfc", "PFC command clump template create", MS_NEED_PARTICLE, {{"", ms_write_pfc}}},
    {0},
};

static void list_formats(char names[256])
{
    names[0] = '\0';
    for (const ms_format *f = ms_formats; f->name; f++) {
        const size_t used = strlen(names);
        snprintf(names + used, 256 - used, "%s%s", used ? ", " : "", f->name);
    }
}

const ms_format *ms_write_format_find(const char *name, ms_error *err)
{
    char names[256];
    for (const ms_format *f = ms_formats; f->name; f++) {
        if (strcmp(f->name, name) == 0) {
            return f;
        }
    }
    list_formats(names);
    ms_fail(err, MS_ERR_ARG, "there is no clump format '%s'; choose from %s", name, names);
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
        const int made = mkdir(path, 0777) == 0 || (stat(path, &info) == 0 && S_ISDIR(info.st_mode));
        if (!made) {
            return ms_fail(err, MS_ERR_IO, "%s: this folder cannot be made", path);
        }
        *slash = '/';
    }
    return MS_OK;
}

/* The path that is written to is the first `stem` characters of `path` and the suffix. */
static ms_status write_part(const ms_content *content, const char *path, size_t stem, const ms_part *part,
                            ms_error *err)
{
    ms_output output;
    const size_t room = stem + strlen(part->suffix) + 1;
    char *name = malloc(room);
    if (!name) {
        return ms_fail(err, MS_ERR_NOMEM, "%s: no memory to write it", path);
    }
    snprintf(name, room, "%.*s%s", (int)stem, path, part->suffix);
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
    const char *slash = strrchr(path, '/'), *base = slash ? slash + 1 : path, *dot = strrchr(base, '.');
    return dot && dot > base ? (size_t)(dot - path) : strlen(path);
}

static ms_status write_template(const ms_content *content, const char *path, const ms_format *format, ms_error *err)
{
    static const ms_part FRAME = {".frame.json", ms_write_frame};
    const int alone = strcmp(path, "-") == 0;
    ms_template made;
    ms_status status = ms_template_make(&made, content->clump, content->particle, err);
    const ms_content inner = {&made.clump, &made.particle, content->record, content->name};
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

static ms_status check_need(const ms_content *content, const ms_format *format, ms_error *err)
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

ms_status ms_write_clump(const ms_content *content, const char *path, const ms_format *format, ms_error *err)
{
    const char *slash = strrchr(path, '/');
    ms_content named = *content;
    format = format ? format : ms_write_format_of_path(path, err);
    if (!format) {
        return MS_ERR_ARG;
    }
    named.name = slash ? slash + 1 : path;
    ms_status status = check_need(content, format, err);
    if (status != MS_OK) {
        return status;
    }
    return format->need == MS_NEED_SPHERES ? write_part(&named, path, strlen(path), format->part, err)
                                           : write_template(&named, path, format, err);
}

ms_status ms_write_grid(const ms_grid *grid, const char *path, ms_error *err)
{
    ms_output output;
    ms_number at[3], h = ms_text_of_number(grid->h);
    ms_status status = ms_output_open(&output, path, err);
    if (status != MS_OK) {
        return status;
    }
    for (int a = 0; a < 3; a++) {
        at[a] = ms_text_of_number(grid->origin[a]);
    }
    fputs("# vtk DataFile Version 3.0\ntarget by mskit " MS_VERSION "\nBINARY\nDATASET STRUCTURED_POINTS\n",
          output.stream);
    fprintf(output.stream, "DIMENSIONS %d %d %d\nORIGIN %s %s %s\nSPACING %s %s %s\n", grid->n[0], grid->n[1],
            grid->n[2], at[0].text, at[1].text, at[2].text, h.text, h.text, h.text);
    fprintf(output.stream, "POINT_DATA %zu\nSCALARS inside unsigned_char 1\nLOOKUP_TABLE default\n",
            ms_grid_voxels(grid));
    fwrite(grid->inside, 1, ms_grid_voxels(grid), output.stream);
    return ms_output_close(&output, MS_OK, err);
}
