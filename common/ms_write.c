#include "ms_write.h"

#include <jansson.h>
#include <string.h>

#include "ms_file.h"
#include "ms_text.h"
#include "ms_version.h"

static ms_status write_csv(FILE *stream, const ms_clump *clump, const char *record, ms_error *err)
{
    (void)record;
    (void)err;
    fputs("x,y,z,r\n", stream);
    for (size_t s = 0; s < clump->n_spheres; s++) {
        const double *c = clump->sphere[s].centre;
        ms_number x = ms_number_text(c[0]), y = ms_number_text(c[1]), z = ms_number_text(c[2]);
        ms_number r = ms_number_text(clump->sphere[s].radius);
        fprintf(stream, "%s,%s,%s,%s\n", x.text, y.text, z.text, r.text);
    }
    return MS_OK;
}

/* {"mskit": version, <the record>, "columns": [...], "spheres": [[x, y, z, r], ...]} */
static ms_status write_json(FILE *stream, const ms_clump *clump, const char *record, ms_error *err)
{
    json_t *root = json_pack("{s:s}", "mskit", MS_VERSION), *spheres = json_array();
    json_t *columns = json_pack("[s,s,s,s]", "x", "y", "z", "r");
    json_t *how = record ? json_loads(record, 0, NULL) : json_object();
    int failed = !root || !how || json_object_update(root, how) != 0;
    failed |= json_object_set_new(root, "columns", columns) != 0;
    for (size_t s = 0; s < clump->n_spheres; s++) {
        const double *c = clump->sphere[s].centre;
        failed |= json_array_append_new(spheres, json_pack("[f,f,f,f]", c[0], c[1], c[2], clump->sphere[s].radius));
    }
    failed |= json_object_set_new(root, "spheres", spheres) != 0;
    failed = failed || json_dumpf(root, stream, JSON_INDENT(2)) != 0 || fputc('\n', stream) == EOF;
    json_decref(how);
    json_decref(root);
    return failed ? ms_fail(err, MS_ERR_IO, "the clump could not be written as JSON") : MS_OK;
}

/* Legacy VTK: points with their radius; in ParaView, a Glyph of spheres scaled by it. */
static ms_status write_vtk(FILE *stream, const ms_clump *clump, const char *record, ms_error *err)
{
    (void)record;
    (void)err;
    fputs("# vtk DataFile Version 3.0\nclump by mskit " MS_VERSION "\nASCII\nDATASET POLYDATA\n", stream);
    fprintf(stream, "POINTS %zu double\n", clump->n_spheres);
    for (size_t s = 0; s < clump->n_spheres; s++) {
        const double *c = clump->sphere[s].centre;
        ms_number x = ms_number_text(c[0]), y = ms_number_text(c[1]), z = ms_number_text(c[2]);
        fprintf(stream, "%s %s %s\n", x.text, y.text, z.text);
    }
    fprintf(stream, "VERTICES %zu %zu\n", clump->n_spheres, 2 * clump->n_spheres);
    for (size_t s = 0; s < clump->n_spheres; s++) {
        fprintf(stream, "1 %zu\n", s);
    }
    fprintf(stream, "POINT_DATA %zu\nSCALARS radius double 1\nLOOKUP_TABLE default\n", clump->n_spheres);
    for (size_t s = 0; s < clump->n_spheres; s++) {
        fprintf(stream, "%s\n", ms_number_text(clump->sphere[s].radius).text);
    }
    return MS_OK;
}

const ms_format ms_formats[] = {
    {"csv", "x,y,z,r in the unit and frame of the shape", write_csv},
    {"json", "spheres, scores and all that is needed to repeat the run", write_json},
    {"vtk", "points with radius, for ParaView", write_vtk},
    {0},
};

const ms_format *ms_format_find(const char *name, ms_error *err)
{
    char names[128] = "";
    for (const ms_format *f = ms_formats; f->name; f++) {
        if (strcmp(f->name, name) == 0) {
            return f;
        }
        const size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s%s", used ? ", " : "", f->name);
    }
    ms_fail(err, MS_ERR_ARG, "there is no clump format '%s'; choose from %s", name, names);
    return NULL;
}

ms_status ms_write_clump(const ms_clump *clump, const char *path, const ms_format *format, const char *record,
                         ms_error *err)
{
    ms_output output;
    char ending[16];
    if (!format) {
        ms_file_ending(ending, path);
        format = ms_format_find(strcmp(path, "-") == 0 ? "csv" : ending, err);
        if (!format) {
            return MS_ERR_ARG;
        }
    }
    ms_status status = ms_output_open(&output, path, err);
    if (status != MS_OK) {
        return status;
    }
    return ms_output_close(&output, format->write(output.stream, clump, record, err), err);
}

ms_status ms_write_grid(const ms_grid *grid, const char *path, ms_error *err)
{
    ms_output output;
    ms_number at[3], h = ms_number_text(grid->h);
    ms_status status = ms_output_open(&output, path, err);
    if (status != MS_OK) {
        return status;
    }
    for (int a = 0; a < 3; a++) {
        at[a] = ms_number_text(grid->origin[a]);
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
