/* PFC: a command "clump template create". */
#include "base/ms_escape.h"
#include "ms_fields.h"
#include "ms_formats.h"

/* Volume and inertia at unit density. */
ms_status ms_pfc_write(FILE *stream, const ms_content *content, ms_error *err)
{
    const ms_particle *p = content->particle;
    (void)err;
    fputs("clump template create name \"", stream);
    ms_escape_name(stream, content->name);
    fprintf(stream, "\" pebbles %zu ...\n", content->clump->n_spheres);
    for (size_t s = 0; s < content->clump->n_spheres; s++) {
        const ms_sphere *b = &content->clump->sphere[s];
        ms_fields_numbers(stream, (const double[]){b->radius, b->centre[0], b->centre[1], b->centre[2]}, 4, " ");
        fputs(" ...\n", stream);
    }
    fprintf(stream, "volume %s inertia ", ms_text_of_number(p->mass / p->density).text);
    ms_fields_moments(stream, p, p->density, " ");
    fputs(" 0 0 0\n", stream);
    return MS_OK;
}
