/** The writers behind the table of formats. Private to ms_write. */
#ifndef MS_WRITE_FORMATS_H
#define MS_WRITE_FORMATS_H

#include <jansson.h>

#include "base/ms_text.h"
#include "ms_write.h"

/* As ms_part.write. Templates get a clump and particle in the frame of the template. */
ms_status ms_write_csv(FILE *stream, const ms_content *content, ms_error *err);
ms_status ms_write_json(FILE *stream, const ms_content *content, ms_error *err);
ms_status ms_write_vtk(FILE *stream, const ms_content *content, ms_error *err);
ms_status ms_write_frame(FILE *stream, const ms_content *content, ms_error *err);

ms_status ms_write_liggghts(FILE *stream, const ms_content *content, ms_error *err);
ms_status ms_write_lammps(FILE *stream, const ms_content *content, ms_error *err);
ms_status ms_write_yade(FILE *stream, const ms_content *content, ms_error *err);
ms_status ms_write_liggghts_script(FILE *stream, const ms_content *content, ms_error *err);
ms_status ms_write_lammps_script(FILE *stream, const ms_content *content, ms_error *err);
ms_status ms_write_yade_script(FILE *stream, const ms_content *content, ms_error *err);

ms_status ms_write_mercury_clump(FILE *stream, const ms_content *content, ms_error *err);
ms_status ms_write_mercury_mass(FILE *stream, const ms_content *content, ms_error *err);
ms_status ms_write_mercury_tensor(FILE *stream, const ms_content *content, ms_error *err);
ms_status ms_write_mercury_axes(FILE *stream, const ms_content *content, ms_error *err);
ms_status ms_write_deme(FILE *stream, const ms_content *content, ms_error *err);
ms_status ms_write_kratos(FILE *stream, const ms_content *content, ms_error *err);
ms_status ms_write_mfix(FILE *stream, const ms_content *content, ms_error *err);
ms_status ms_write_pfc(FILE *stream, const ms_content *content, ms_error *err);

/** Writes numbers with marks between them and none behind. */
void ms_write_numbers(FILE *stream, const double *value, size_t count, const char *mark);

/** One line for each sphere: x, y, z, r with marks between them, and an end. */
void ms_write_spheres(FILE *stream, const ms_clump *clump, const char *mark, const char *end);

/** Density of a sphere of the clump, kg/m^3. */
double ms_write_density(const ms_content *content, size_t sphere);

#endif
