#include "ms_read.h"

#include <math.h>
#include <string.h>

#include "base/ms_file.h"
#include "ms_clump_parse.h"
#include "ms_read_formats.h"

typedef ms_status parser(ms_clump *clump, ms_particle *particle, ms_bytes *bytes, const char *name, ms_error *err);

static ms_status parse_text(ms_clump *clump, ms_particle *particle, ms_bytes *bytes, const char *name, ms_error *err)
{
    (void)particle;
    return ms_clump_parse(clump, bytes, name, err);
}

static ms_status refuse(ms_clump *clump, ms_particle *particle, ms_bytes *bytes, const char *name, ms_error *err)
{
    (void)clump;
    (void)particle;
    (void)bytes;
    return ms_fail(err, MS_ERR_ARG,
                   "%s: this format is written and not read; clumps are read from .csv, .json, .lammps, .liggghts, "
                   ".yade and other text of x y z r",
                   name);
}

static parser *parser_of(const char *path)
{
    static const struct {
        const char *ending;
        parser *parse;
    } READERS[] = {{"json", ms_read_json}, {"lammps", ms_read_lammps},
                   {"vtk", refuse},        {"clu", refuse},
                   {"pfc", refuse},        {"mfix", refuse}};
    char ending[16];
    ms_file_ending(ending, path);
    for (size_t r = 0; r < sizeof READERS / sizeof *READERS; r++) {
        if (strcmp(ending, READERS[r].ending) == 0) {
            return READERS[r].parse;
        }
    }
    return parse_text;
}

static ms_status check_masses(const ms_clump *clump, const char *name, ms_error *err)
{
    for (size_t s = 0; clump->mass && s < clump->n_spheres; s++) {
        if (!isfinite(clump->mass[s]) || !(clump->mass[s] > 0)) {
            return ms_fail(err, MS_ERR_FORMAT, "%s: sphere %zu has the mass %g; masses must be finite and above 0",
                           name, s + 1, clump->mass[s]);
        }
    }
    return MS_OK;
}

ms_status ms_read_clump(ms_clump *clump, ms_particle *particle, const char *path, ms_error *err)
{
    ms_bytes bytes;
    memset(clump, 0, sizeof *clump);
    memset(particle, 0, sizeof *particle);
    ms_status status = ms_file_read(&bytes, path, err);
    if (status == MS_OK) {
        status = parser_of(path)(clump, particle, &bytes, path, err);
        ms_file_free(&bytes);
    }
    if (status == MS_OK) {
        status = check_masses(clump, path, err);
    }
    if (status != MS_OK) {
        ms_clump_free(clump);
        memset(particle, 0, sizeof *particle);
    }
    return status;
}
