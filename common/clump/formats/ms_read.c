#include "ms_read.h"

#include <math.h>
#include <string.h>

#include "base/ms_file.h"
#include "base/ms_text.h"
#include "ms_formats.h"
#include "ms_json.h"

static ms_status read_bytes(ms_clump *clump, ms_particle *particle, ms_bytes *bytes, const char *path, ms_error *err)
{
    char ending[16];
    ms_file_ending(ending, path);
    for (const ms_format *f = ms_formats; f->name; f++) {
        if (strcmp(ending, f->ending) == 0) {
            return f->read ? f->read(clump, particle, bytes, path, err)
                           : ms_fail(err, MS_ERR_ARG,
                                     "%s: this format is written and not read; clumps are read from .csv, .json, "
                                     ".lammps, .liggghts, .yade and other text of x y z r",
                                     path);
        }
    }
    return ms_xyzr_read(clump, particle, bytes, path, err);
}

/* A clump of MS_CLUMP_MAX_SPHERES is far shorter, so that an input without end is found out. */
static const size_t MOST_BYTES = (size_t)1 << 28;

/* Standard input has no ending: an object is JSON, other text is x y z r. */
static ms_status read_standard(ms_clump *clump, ms_particle *particle, ms_error *err)
{
    const char *name = ms_file_name("-");
    ms_bytes bytes;
    ms_text text;
    ms_status status = ms_file_read_standard(&bytes, MOST_BYTES, err);
    if (status == MS_OK && bytes.size == 0) {
        ms_file_free(&bytes);
        return ms_fail(err, MS_ERR_FORMAT, "%s: is empty (0 bytes); it can be read once, so that - is given once",
                       name);
    }
    if (status != MS_OK) {
        return status;
    }
    ms_text_start(&text, &bytes, name);
    const int is_json = ms_text_seek(&text) && *text.at == '{';
    status = (is_json ? ms_json_read : ms_xyzr_read)(clump, particle, &bytes, name, err);
    ms_file_free(&bytes);
    return status;
}

static ms_status read_file(ms_clump *clump, ms_particle *particle, const char *path, ms_error *err)
{
    ms_bytes bytes;
    ms_status status = ms_file_read(&bytes, path, err);
    if (status == MS_OK) {
        status = read_bytes(clump, particle, &bytes, path, err);
        ms_file_free(&bytes);
    }
    return status;
}

static ms_status check_masses(const ms_clump *clump, const char *name, ms_error *err)
{
    for (size_t s = 0; clump->mass && s < ms_clump_count_masses(clump); s++) {
        if (!isfinite(clump->mass[s]) || !(clump->mass[s] > 0)) {
            return ms_fail(err, MS_ERR_FORMAT, "%s: sphere %zu has the mass %g; masses must be finite and above 0",
                           name, s + 1, clump->mass[s]);
        }
    }
    return MS_OK;
}

ms_status ms_read_clump(ms_clump *clump, ms_particle *particle, const char *path, ms_error *err)
{
    memset(clump, 0, sizeof *clump);
    memset(particle, 0, sizeof *particle);
    ms_status status =
        ms_file_is_standard(path) ? read_standard(clump, particle, err) : read_file(clump, particle, path, err);
    if (status == MS_OK) {
        status = check_masses(clump, ms_file_name(path), err);
    }
    if (status != MS_OK) {
        ms_clump_free(clump);
        memset(particle, 0, sizeof *particle);
    }
    return status;
}

ms_status ms_read_spheres(ms_clump *clump, const char *path, ms_error *err)
{
    ms_bytes bytes;
    ms_particle unused = {0};
    memset(clump, 0, sizeof *clump);
    ms_status status = ms_file_read(&bytes, path, err);
    if (status == MS_OK) {
        status = ms_xyzr_read(clump, &unused, &bytes, path, err);
        ms_file_free(&bytes);
    }
    if (status != MS_OK) {
        ms_clump_free(clump);
    }
    return status;
}

ms_status ms_read_particle(ms_particle *particle, const char *path, ms_error *err)
{
    ms_bytes bytes;
    memset(particle, 0, sizeof *particle);
    ms_status status = ms_file_read(&bytes, path, err);
    if (status == MS_OK) {
        status = ms_json_read_particle(particle, &bytes, path, err);
        ms_file_free(&bytes);
    }
    return status;
}
