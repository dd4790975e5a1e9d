/** Clump files back in: spheres, and what else the file knows. */
#ifndef MS_READ_H
#define MS_READ_H

#include "clump/ms_particle.h"

MS_C_BEGIN

/**
 * Reads a clump file; its ending names the format. CSV gives masses if its header says so (x,y,z,r,mass), JSON also
 * the particle, a LAMMPS molecule (.lammps) both, without the density. Sphere files of LIGGGHTS and YADE, and any
 * other text, are read as ms_read_spheres does; in .yade a fifth column is the id of the sphere's clump. Files of
 * formats that mskit only writes are refused. "-" is standard input: JSON if it begins with a brace, else text of x y
 * z r, 268 MB at most.
 *
 * @param[out] clump    the caller frees it; empty on failure
 * @param[out] particle zeros where the file does not know it
 * @return as ms_read_spheres; MS_ERR_ARG for a format that is not read
 */
MS_API ms_status ms_read_clump(ms_clump *clump, ms_particle *particle, const char *path, ms_error *err);

/**
 * Reads spheres from a text file: four numbers a line, x y z r, separated by commas,
 * semicolons or blanks; a fifth is the mass if the header calls it so, further columns are
 * ignored, but for ids of clumps, of which there may be one only. Empty lines, '#' comments and
 * one header line before the first sphere are skipped; any other line is an error, and so are an
 * empty column, decimal commas, a header whose fourth column is no radius, and one, or a
 * comment before the first sphere, that names x, y, z in other columns.
 *
 * @param[out] clump the caller frees it; empty on failure
 * @return MS_OK; MS_ERR_IO; MS_ERR_FORMAT with the line; MS_ERR_LIMIT; MS_ERR_NOMEM
 */
MS_API ms_status ms_read_spheres(ms_clump *clump, const char *path, ms_error *err);

/**
 * Reads the particle from a STEM.frame.json or the JSON of a clump.
 * @return MS_OK; MS_ERR_IO; MS_ERR_FORMAT; MS_ERR_NOMEM
 */
MS_API ms_status ms_read_particle(ms_particle *particle, const char *path, ms_error *err);

MS_C_END

#endif
