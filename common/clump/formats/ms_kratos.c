/* Kratos: a cluster file. */
#include <math.h>

#include "base/ms_escape.h"
#include "ms_fields.h"
#include "ms_formats.h"

static double find_equivalent_diameter(const ms_particle *particle)
{
    return cbrt(6 * particle->mass / (particle->density * acos(-1.0)));
}

ms_status ms_kratos_write(FILE *stream, const ms_content *content, ms_error *err)
{
    const ms_particle *p = content->particle;
    const ms_number size = ms_text_of_number(2 * ms_template_reach(content->clump));
    (void)err;
    fputs("Name\n", stream);
    ms_escape_name(stream, content->name);
    fputs("\n\nBegin centers_and_radii\n", stream);
    ms_fields_spheres(stream, content->clump, " ", "\n");
    fprintf(stream, "End centers_and_radii\n\nParticle_center_and_diameter\n0 0 0 %s\n\nSize\n%s\n\nVolume\n%s\n\n",
            ms_text_of_number(find_equivalent_diameter(p)).text, size.text,
            ms_text_of_number(p->mass / p->density).text);
    fputs("Inertia per unit mass\n", stream);
    ms_fields_moments(stream, p, p->mass, "\n");
    fputc('\n', stream);
    return MS_OK;
}
