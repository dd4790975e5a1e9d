/** Readers and writers in the table of formats (ms_write.c), a file for each engine. Private to the table;
 * tests and fuzzers read from memory with them. */
#ifndef MS_FORMATS_H
#define MS_FORMATS_H

#include "base/ms_file.h"
#include "clump/ms_packing.h"
#include "ms_write.h"

/* Readers, as ms_format.read. In the files of YADE a fifth column is the id of a clump. */
ms_status ms_xyzr_read(ms_clump *clump, ms_particle *particle, ms_bytes *bytes, const char *name, ms_error *err);
ms_status ms_xyzr_read_yade(ms_clump *clump, ms_particle *particle, ms_bytes *bytes, const char *name, ms_error *err);
ms_status ms_liggghts_read(ms_clump *clump, ms_particle *particle, ms_bytes *bytes, const char *name, ms_error *err);
ms_status ms_json_read(ms_clump *clump, ms_particle *particle, ms_bytes *bytes, const char *name, ms_error *err);
ms_status ms_lammps_read(ms_clump *clump, ms_particle *particle, ms_bytes *bytes, const char *name, ms_error *err);

/* Writers, as ms_part.write. Templates get a clump and particle in the frame of the template. */
ms_status ms_xyzr_write(FILE *stream, const ms_content *content, ms_error *err);
ms_status ms_json_write(FILE *stream, const ms_content *content, ms_error *err);
ms_status ms_json_write_frame(FILE *stream, const ms_content *content, ms_error *err);
ms_status ms_vtk_write(FILE *stream, const ms_content *content, ms_error *err);

ms_status ms_liggghts_write(FILE *stream, const ms_content *content, ms_error *err);
ms_status ms_liggghts_script(FILE *stream, const ms_content *content, ms_error *err);
ms_status ms_lammps_write(FILE *stream, const ms_content *content, ms_error *err);
ms_status ms_lammps_script(FILE *stream, const ms_content *content, ms_error *err);
ms_status ms_yade_write(FILE *stream, const ms_content *content, ms_error *err);
ms_status ms_yade_script(FILE *stream, const ms_content *content, ms_error *err);
ms_status ms_mercury_write_clump(FILE *stream, const ms_content *content, ms_error *err);
ms_status ms_mercury_write_mass(FILE *stream, const ms_content *content, ms_error *err);
ms_status ms_mercury_write_inertia(FILE *stream, const ms_content *content, ms_error *err);
ms_status ms_mercury_write_axes(FILE *stream, const ms_content *content, ms_error *err);
ms_status ms_deme_write(FILE *stream, const ms_content *content, ms_error *err);
ms_status ms_kratos_write(FILE *stream, const ms_content *content, ms_error *err);
ms_status ms_mfix_write(FILE *stream, const ms_content *content, ms_error *err);
ms_status ms_pfc_write(FILE *stream, const ms_content *content, ms_error *err);

/* Writers of packings, as ms_packing_part.write. */
ms_status ms_liggghts_packing(FILE *stream, const ms_packing *packing, const char *name, ms_error *err);
ms_status ms_liggghts_settle(FILE *stream, const ms_packing *packing, const char *name, ms_error *err);
ms_status ms_lammps_packing(FILE *stream, const ms_packing *packing, const char *name, ms_error *err);
ms_status ms_lammps_bodies(FILE *stream, const ms_packing *packing, const char *name, ms_error *err);
ms_status ms_lammps_settle(FILE *stream, const ms_packing *packing, const char *name, ms_error *err);
ms_status ms_yade_packing(FILE *stream, const ms_packing *packing, const char *name, ms_error *err);
ms_status ms_yade_settle(FILE *stream, const ms_packing *packing, const char *name, ms_error *err);

/* Likewise of mixtures. */
ms_status ms_liggghts_mixture(FILE *stream, const ms_packing *mixture, const char *name, ms_error *err);
ms_status ms_lammps_mixture(FILE *stream, const ms_packing *mixture, const char *name, ms_error *err);
ms_status ms_yade_kinds(FILE *stream, const ms_packing *mixture, const char *name, ms_error *err);
ms_status ms_yade_mixture(FILE *stream, const ms_packing *mixture, const char *name, ms_error *err);

/* Likewise of scenes. */
ms_status ms_liggghts_scene(FILE *stream, const ms_packing *scene, const char *name, ms_error *err);
ms_status ms_lammps_scene(FILE *stream, const ms_packing *scene, const char *name, ms_error *err);
ms_status ms_yade_scene(FILE *stream, const ms_packing *scene, const char *name, ms_error *err);

#endif
