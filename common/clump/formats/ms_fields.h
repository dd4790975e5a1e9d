/** What readers and writers of clump formats share. Private to them. */
#ifndef MS_FIELDS_H
#define MS_FIELDS_H

#include "base/ms_text.h"
#include "ms_write.h"

/** Writes numbers with marks between them and none behind. */
void ms_fields_numbers(FILE *stream, const double *value, size_t count, const char *mark);

/** Writes a line for each sphere that touches, which leaves out carriers: x, y, z, r with marks between them, and an
 * end. */
void ms_fields_spheres(FILE *stream, const ms_clump *clump, const char *mark, const char *end);

/** Writes the three moments of a template, divided by `over`. */
void ms_fields_moments(FILE *stream, const ms_particle *particle, double over, const char *mark);

/** Are masses and densities known? */
int ms_fields_has_masses(const ms_content *content);

/** How many are written where carriers are: spheres, and with masses, without which these are nothing, carriers. */
size_t ms_fields_count(const ms_content *content);

/** Density of a sphere of the clump, kg/m^3. */
double ms_fields_density(const ms_content *content, size_t sphere);

/** Adds a sphere, or a carrier, if its numbers x, y, z, r can be one. @return MS_OK; MS_ERR_FORMAT; as ms_clump_add */
ms_status ms_fields_add_sphere(ms_clump *clump, int is_carrier, const double v[4], const char *name, ms_error *err);

#endif
