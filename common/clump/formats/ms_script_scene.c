#include "ms_script_scene.h"

#include <math.h>

#include "base/ms_escape.h"
#include "base/ms_vector.h"

static const double PI = 3.14159265358979323846, BED = 0.6; /* its packing fraction, to choose a width by */
/* Of the balls around the particles in the column: well below 0.3, where random insertion begins to fail. */
static const double COLUMN = 0.15;

static double largest_sphere(const ms_placed *kind)
{
    double most = 0;
    for (size_t b = 0; b < kind->clump.n_spheres; b++) {
        most = fmax(most, kind->scale * kind->clump.sphere[b].radius);
    }
    return most;
}

/* About that line drag on the spheres turns nothing. Off it by a tenth of the reach they end a spin tens of times
 * more slowly than a motion. */
static int is_nearly_on_line(const ms_clump *clump)
{
    const double *from = clump->sphere[0].centre, *to = from, most = ms_template_reach(clump) / 10;
    for (size_t b = 1; b < clump->n_spheres; b++) {
        const double *c = clump->sphere[b].centre;
        to = ms_squared_distance(from, c) > ms_squared_distance(from, to) ? c : to;
    }
    for (size_t b = 1; b < clump->n_spheres; b++) {
        double across[3];
        ms_vector_triangle(across, from, to, clump->sphere[b].centre);
        if (ms_dot(across, across) > most * most * ms_squared_distance(from, to)) {
            return 0;
        }
    }
    return 1;
}

/* Sums over the particles, and what is the largest or least of them. */
static double take_kinds(ms_script_scene *s, const ms_packing *scene)
{
    double lightest = HUGE_VAL;
    s->least = HUGE_VAL;
    s->density = scene->placed[0].particle.density;
    for (size_t k = 0; k < scene->count; k++) {
        const ms_placed *kind = &scene->placed[k];
        const double count = (double)kind->count, mass = kind->particle.mass;
        s->particles += count;
        s->spheres += count * (double)kind->clump.n_spheres;
        s->carriers += count * (double)kind->clump.n_carriers;
        s->mass += count * mass;
        s->rest += count * 1e-6 * mass * MS_SCRIPT_GRAVITY * 2 * ms_script_radius(mass, s->density);
        s->reach = fmax(s->reach, kind->scale * ms_template_reach(&kind->clump));
        lightest = fmin(lightest, mass);
        s->drag = fmax(s->drag, mass / (double)kind->clump.n_spheres);
        s->least = fmin(s->least, kind->scale * ms_clump_smallest_radius(&kind->clump));
        s->most = fmax(s->most, largest_sphere(kind));
        s->keeps_spin |= is_nearly_on_line(&kind->clump);
    }
    return lightest;
}

/* The vessel that is given, or a box. */
static void take_vessel(ms_script_scene *s, const ms_packing *scene)
{
    const double bed = s->mass / (s->density * BED);
    const double own = fmax(cbrt(bed), 8 * s->reach);
    s->is_round = scene->is_round;
    for (int k = 0; k < 2; k++) {
        s->half[k] = (scene->width[k] > 0 ? scene->width[k] : own) / 2;
    }
}

/* Where centres of particles may be: a reach from the walls. */
static double area_of_centres(const ms_script_scene *s)
{
    const double a = s->half[0] - s->reach, b = s->half[1] - s->reach;
    return s->is_round ? PI * a * a : 4 * a * b;
}

/* Of the balls in which particles keep others away, as far as they lie in the space of the centres: in a vessel hardly
 * wider than a particle that is a slice as high as the ball. */
static double volume_of_balls(const ms_script_scene *s, const ms_packing *scene, int is_alike)
{
    double sum = 0;
    for (size_t k = 0; k < scene->count; k++) {
        const ms_placed *kind = &scene->placed[k];
        const double more = is_alike ? (s->most - largest_sphere(kind)) / 2 : 0;
        const double radius = kind->scale * ms_template_reach(&kind->clump) + more;
        sum += (double)kind->count * fmin(4 * PI / 3 * pow(radius, 3), 2 * radius * area_of_centres(s));
    }
    return sum;
}

double ms_script_scene_near(const ms_script_scene *s, const ms_placed *kind)
{
    return 1.01 * (largest_sphere(kind) + s->most);
}

ms_script_scene ms_script_scene_of(const ms_packing *scene, int is_alike)
{
    ms_script_scene s = {0};
    const double lightest = take_kinds(&s, scene);
    take_vessel(&s, scene);
    s.low = 0.5 * s.reach;
    s.top = s.low + 2 * s.reach + volume_of_balls(&s, scene, is_alike) / (COLUMN * area_of_centres(&s));
    s.young = ms_script_young(s.top, s.density);
    s.step = ms_script_step(ms_script_radius(lightest, s.density), s.density, s.young);
    s.convention = ms_script_step(s.least, s.density, s.young);
    s.fall = sqrt(2 * s.top / MS_SCRIPT_GRAVITY);
    s.drag /= s.fall;
    return s;
}

static const char NOTES[] =
    "#\n"
    "# Modulus: so stiff that what lands from the top of the column overlaps by some 2 % of its radius, and what "
    "rests\n"
    "# by far less. A real one is higher: the step below goes with its inverse root. Overlaps change the packing, so\n"
    "# double the modulus once to see that they do not matter.\n"
    "# Restitution and friction: put those of your material, and rolling friction where you have it. What was "
    "calibrated\n"
    "# with one number of spheres does not carry over to another: spheres that touch at once add up their stiffness "
    "and\n"
    "# damp more (mskit contact says how much).\n"
    "# Rocking and rolling have no friction of their own here and would not end: after twice the time of the fall a "
    "drag\n"
    "# slows the particles down, each within that time or sooner.\n"
    "# Rest: the kinetic energy of a particle is below 1e-6 m g d in the mean, d the diameter of the ball of its "
    "volume.\n"
    "# The height is twice that of the centre of mass; the packing fraction is that between a quarter and three "
    "quarters\n"
    "# of it, where spheres count whose centres are there, each with its part of the particle.\n";

void ms_script_scene_title(FILE *stream, const ms_script_scene *s, const ms_packing *scene, const char *name,
                           const char *command, const char *suffix)
{
    fprintf(stream, "# Lets %.0f particles come to rest in a %s: %s ", s->particles, s->is_round ? "cylinder" : "box",
            command);
    ms_escape_comment(stream, name);
    fprintf(stream, "%s\n", suffix);
    for (size_t k = 0; k < scene->count; k++) {
        const ms_placed *kind = &scene->placed[k];
        fprintf(stream, "#   %zu of ", kind->count);
        ms_escape_comment(stream, kind->name);
        fprintf(stream, ", %zu spheres", kind->clump.n_spheres);
        if (kind->scale < 1 || kind->scale > 1) {
            fprintf(stream, ", %g times its size", kind->scale);
        }
        fputc('\n', stream);
    }
    fputs(NOTES, stream);
    fprintf(
        stream,
        "# Step: a tenth of the Rayleigh time of a ball of the lightest particle's mass, since what swings in a\n"
        "# contact is the mass of whole particles; that of the smallest sphere, as by convention, would be %.3g s.\n\n",
        s->convention);
}

double ms_script_scene_area(const ms_script_scene *s)
{
    return s->is_round ? PI * s->half[0] * s->half[0] : 4 * s->half[0] * s->half[1];
}

void ms_script_scene_settings(FILE *stream, const ms_script_scene *s, const char *restitution)
{
    ms_number young, number;
    fprintf(stream,
            "variable young index %s\nvariable poisson index 0.3\nvariable restitution index %s\n"
            "variable friction index 0.5\n",
            ms_script_number(s->young, &young), restitution);
    fprintf(stream, "variable step equal %s*sqrt(%s/${young})\n", ms_script_number(s->step, &number), young.text);
    fprintf(stream, "variable part equal ceil(%s/10/v_step)\n\n", ms_script_number(s->fall, &number));
}

void ms_script_scene_inserted(FILE *stream, double atoms)
{
    fprintf(stream,
            "variable inserted equal atoms\n"
            "if \"${inserted} != %.0f\" then \"print 'scene: not all particles have room; make the column higher'\" "
            "\"quit 1\"\n\n",
            atoms);
}

void ms_script_scene_measures(FILE *stream, const ms_script_scene *s)
{
    ms_number area;
    fputs(s->keeps_spin
              ? "# Spheres of a particle lie nearly on one line, and drag on them ends no spin about it: rest "
                "is that of motion alone.\nvariable motion equal c_moving\n"
              : "variable motion equal v_kinetic\n",
          stream);
    fprintf(stream, "variable fraction equal c_within/(%s*0.5*v_height)\n",
            ms_script_number(s->density * ms_script_scene_area(s), &area));
}

void ms_script_scene_results(FILE *stream, const ms_script_scene *s, double atoms)
{
    ms_number each, rest;
    fprintf(stream, "\nvariable kept equal atoms*%s\nvariable each equal v_motion/%s\n",
            ms_script_number(s->particles / atoms, &each), ms_script_number(s->rest * 1e6, &rest));
    fprintf(stream,
            "print \"scene: ${state}, kinetic energy of a particle%s ${each} m g d\"\n"
            "print \"scene: particles ${kept} of %.0f\"\n",
            s->keeps_spin ? " without spin" : "", s->particles);
    fputs("print \"scene: mass ${mass} kg\"\n"
          "print \"scene: height ${height} m, highest point ${highest} m\"\n"
          "print \"scene: packing fraction ${fraction}\"\n"
          "print \"scene: energy ${total} J, of which kinetic ${kinetic} J\"\n",
          stream);
}
