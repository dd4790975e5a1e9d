#include "ms_script.h"

#include <math.h>

#include "base/ms_escape.h"
#include "ms_stable.h"

static const double POISSON = 0.3;
static const double LOOSEN_STEPS = 10000, SLOWING_STEPS = 5;
static const double LEAST_YOUNG = 5e6; /* for LIGGGHTS without soft_particles */

double ms_script_young(double height, double density)
{
    return 1e5 * density * MS_SCRIPT_GRAVITY * height;
}

double ms_script_step(double radius, double density, double young)
{
    const double shear = young / (2 * (1 + POISSON));
    const double rayleigh = acos(-1.0) * radius * sqrt(density / shear) / (0.1631 * POISSON + 0.8766);
    return rayleigh / 10;
}

double ms_script_radius(double mass, double density)
{
    return cbrt(0.75 * mass / (acos(-1.0) * density));
}

/* @param reach of the largest particle @param radius whose Rayleigh time bounds the step */
static ms_script_drop make_drop(double reach, double radius, double density)
{
    const double young = fmax(ms_script_young(reach, density), LEAST_YOUNG);
    return (ms_script_drop){.reach = reach,
                            .young = young,
                            .step = ms_script_step(radius, density, young),
                            .one = HUGE_VAL,
                            .all = HUGE_VAL,
                            .end = 4 * sqrt(4 * reach / MS_SCRIPT_GRAVITY),
                            .side = 4 * reach};
}

/* The least of what the bodies bear. */
static void bound_steps(ms_script_drop *drop, const ms_clump *clump, double scale, const ms_particle *particle)
{
    const ms_stable_law law = {.young = drop->young, .poisson = POISSON, .overlap = drop->reach / 1000};
    double one, all;
    ms_stable_step(&one, &all, clump, scale, particle, &law);
    drop->one = fmin(drop->one, one);
    drop->all = fmin(drop->all, all);
}

ms_script_drop ms_script_drop_of(const ms_content *content)
{
    ms_script_drop drop = make_drop(ms_template_reach(content->clump), ms_clump_smallest_radius(content->clump),
                                    content->particle->density);
    bound_steps(&drop, content->clump, 1, content->particle);
    return drop;
}

ms_script_drop ms_script_drop_of_mixture(const ms_packing *mixture)
{
    const double density = mixture->placed[0].particle.density;
    double reach = 0, lightest = HUGE_VAL;
    for (size_t k = 0; k < mixture->count; k++) {
        const ms_placed *kind = &mixture->placed[k];
        reach = fmax(reach, kind->scale * ms_template_reach(&kind->clump));
        lightest = fmin(lightest, kind->particle.mass);
    }
    ms_script_drop drop = make_drop(reach, ms_script_radius(lightest, density), density);
    for (size_t k = 0; k < mixture->count; k++) {
        bound_steps(&drop, &mixture->placed[k].clump, mixture->placed[k].scale, &mixture->placed[k].particle);
    }
    return drop;
}

ms_script_settle ms_script_settle_of(const ms_packing *packing)
{
    ms_script_settle s = {.least = HUGE_VAL, .drag = HUGE_VAL, .loosen = LOOSEN_STEPS};
    const double density = packing->placed[0].particle.density;
    double lightest = HUGE_VAL;
    ms_packing_box(s.lo, s.hi, packing);
    for (size_t p = 0; p < packing->count; p++) {
        const ms_placed *placed = &packing->placed[p];
        s.reach = fmax(s.reach, placed->scale * ms_template_reach(&placed->clump));
        s.least = fmin(s.least, placed->scale * ms_clump_smallest_radius(&placed->clump));
        s.drag = fmin(s.drag, placed->particle.mass / (double)placed->clump.n_spheres);
        lightest = fmin(lightest, placed->particle.mass);
    }
    s.young = ms_script_young(s.hi[2] - s.lo[2], density);
    s.step = ms_script_step(ms_script_radius(lightest, density), density, s.young);
    s.drag /= SLOWING_STEPS * s.step;
    s.end = ceil(4 * sqrt(2 * (s.hi[2] - s.lo[2]) / MS_SCRIPT_GRAVITY) / s.step);
    return s;
}

void ms_script_settle_domain(double *lo, double *hi, const ms_script_settle *s, int axis)
{
    const int is_up = axis == 2;
    *lo = s->lo[axis] - s->reach;
    *hi = s->hi[axis] + s->reach + (is_up ? s->hi[2] - s->lo[2] : 0);
}

/* A comment: "BEFORE NAME BEHIND: COMMAND NAMESUFFIX", and what follows. */
static void write_title(FILE *stream, const char *before, const char *name, const char *behind, const char *command,
                        const char *suffix)
{
    fprintf(stream, "# %s ", before);
    ms_escape_comment(stream, name);
    fprintf(stream, " %s: %s ", behind, command);
    ms_escape_comment(stream, name);
    fputs(suffix, stream);
}

void ms_script_title(FILE *stream, const char *name, const char *command, const char *suffix, const char *fifty)
{
    write_title(stream, "Drops", name, "into a box", command, suffix);
    fprintf(stream, "; fifty of them: %s behind it\n", fifty);
}

void ms_script_mixture_title(FILE *stream, const char *name, const char *command, const char *suffix, const char *more)
{
    write_title(stream, "Drops a hundred particles of the mixture", name, "into a box", command, suffix);
    fprintf(stream, "; five hundred: %s behind it\n", more);
}

void ms_script_settle_title(FILE *stream, const char *name, const char *command, const char *suffix)
{
    write_title(stream, "Lets", name, "come to rest in the box around it", command, suffix);
    fputc('\n', stream);
}

void ms_script_drop_steps(FILE *stream, const ms_script_drop *drop)
{
    fprintf(stream,
            "# A step by convention, after the Rayleigh time. What bounds it is the body: pressed by a thousandth\n"
            "# of its reach it is stable to %.3g s on one contact, to %.3g s on all its spheres at once.\n",
            drop->one, drop->all);
}

void ms_script_drop_run(FILE *stream, const ms_script_drop *drop)
{
    fprintf(stream, "variable steps equal ceil(%.0f*sqrt(1+v_n/4))\n", ceil(drop->end / drop->step));
    fprintf(stream, "thermo %.0f\nrun ${steps}\n", ceil(drop->end / drop->step / 10));
}

const char *ms_script_number(double value, ms_number *room)
{
    *room = ms_text_of_number(value);
    return room->text;
}
