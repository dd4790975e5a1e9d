#include "ms_script.h"

#include <math.h>

#include "base/ms_escape.h"

static const double GRAVITY = 9.81, POISSON = 0.3;

ms_script_drop ms_script_drop_of(const ms_content *content)
{
    const ms_particle *p = content->particle;
    const double reach = ms_template_reach(content->clump), least = ms_clump_smallest_radius(content->clump);
    const double young = fmax(1e5 * p->density * GRAVITY * reach, 5e6), shear = young / (2 * (1 + POISSON));
    const double rayleigh = acos(-1.0) * least * sqrt(p->density / shear) / (0.1631 * POISSON + 0.8766);
    return (ms_script_drop){
        .reach = reach, .young = young, .step = rayleigh / 10, .end = 4 * sqrt(4 * reach / GRAVITY), .side = 4 * reach};
}

void ms_script_title(FILE *stream, const char *name, const char *command, const char *suffix, const char *fifty)
{
    fputs("# Drops ", stream);
    ms_escape_comment(stream, name);
    fprintf(stream, " into a box: %s ", command);
    ms_escape_comment(stream, name);
    fprintf(stream, "%s; fifty of them: %s behind it\n", suffix, fifty);
}

const char *ms_script_number(double value, ms_number *room)
{
    *room = ms_text_of_number(value);
    return room->text;
}
