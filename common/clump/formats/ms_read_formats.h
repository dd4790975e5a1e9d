/** Parsers of clump formats from memory, so that tests and fuzzers need no files. Private to ms_read. */
#ifndef MS_READ_FORMATS_H
#define MS_READ_FORMATS_H

#include "base/ms_file.h"
#include "ms_read.h"

/**
 * @param[in,out] clump    empty; on failure the caller frees what it holds
 * @param[out]    particle zeros; untouched where the file does not know it
 * @param         bytes    of the file, with the 0 byte behind them
 * @param         name     of the file, for messages
 */
ms_status ms_read_json(ms_clump *clump, ms_particle *particle, ms_bytes *bytes, const char *name, ms_error *err);
ms_status ms_read_lammps(ms_clump *clump, ms_particle *particle, ms_bytes *bytes, const char *name, ms_error *err);

/** Adds a sphere if its numbers can be one. @return MS_OK; MS_ERR_FORMAT; as ms_clump_add */
ms_status ms_read_sphere(ms_clump *clump, const double v[4], const char *name, ms_error *err);

#endif
