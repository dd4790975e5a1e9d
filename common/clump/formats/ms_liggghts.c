/* LIGGGHTS: a sphere file and a script with its particletemplate/multisphere. */
#include <math.h>
#include <string.h>

#include "base/ms_escape.h"
#include "ms_fields.h"
#include "ms_formats.h"
#include "ms_liggghts.h"
#include "ms_script.h"

const char ms_liggghts_style[] = "atom_style granular\natom_modify map array\ncommunicate single vel yes\n"
                                 "boundary f f f\nnewton off\nunits si\n";

/* Of the one sphere, in it: what touches it has passed through half of that one. */
static ms_sphere inner_of(const ms_sphere *sphere)
{
    ms_sphere inner = *sphere;
    inner.radius /= 2;
    return inner;
}

size_t ms_liggghts_spheres(const ms_clump *clump)
{
    return clump->n_spheres == 1 ? 2 : clump->n_spheres;
}

double ms_liggghts_cubes(const ms_clump *clump)
{
    double sum = clump->n_spheres == 1 ? pow(inner_of(&clump->sphere[0]).radius, 3) : 0;
    for (size_t s = 0; s < clump->n_spheres; s++) {
        sum += pow(clump->sphere[s].radius, 3);
    }
    return sum;
}

/* A comment or an empty line in it crashes LIGGGHTS. */
ms_status ms_liggghts_write(FILE *stream, const ms_content *content, ms_error *err)
{
    const ms_clump *clump = content->clump;
    (void)err;
    ms_fields_spheres(stream, clump, " ", "\n");
    if (clump->n_spheres == 1) {
        ms_sphere inner = inner_of(&clump->sphere[0]);
        ms_fields_spheres(stream, &(ms_clump){.n_spheres = 1, .sphere = &inner}, " ", "\n");
    }
    return MS_OK;
}

/* Without the sphere that LIGGGHTS alone needs. */
ms_status ms_liggghts_read(ms_clump *clump, ms_particle *particle, ms_bytes *bytes, const char *name, ms_error *err)
{
    const ms_status status = ms_xyzr_read(clump, particle, bytes, name, err);
    if (status == MS_OK && clump->n_spheres == 2 && clump->n_carriers == 0 && !clump->mass) {
        const ms_sphere inner = inner_of(&clump->sphere[0]);
        clump->n_spheres = memcmp(&inner, &clump->sphere[1], sizeof inner) == 0 ? 1 : 2;
    }
    return status;
}

/* Where particles are inserted: above the floor, within the walls, the higher the more there are. */
static void write_liggghts_places(FILE *stream, const ms_script_drop *drop)
{
    ms_number reach, side, low;
    fprintf(stream, "variable top equal %s*(2+v_n)\nvariable roof equal v_top+%s\n",
            ms_script_number(drop->reach, &reach), reach.text);
    fprintf(stream, "region box block -%s %s -%s %s", ms_script_number(1.25 * drop->side, &side), side.text, side.text,
            side.text);
    fprintf(stream, " -%s ${roof} units box\ncreate_box 1 box\n", reach.text);
    fprintf(stream, "region above block -%s %s -%s %s", ms_script_number(drop->side, &side), side.text, side.text,
            side.text);
    fprintf(stream, " %s ${top} volume_limit 1e-300 units box\n", ms_script_number(0.2 * drop->reach, &low));
}

static void write_liggghts_law(FILE *stream, double young)
{
    ms_number value;
    fputs("hard_particles yes\n", stream); /* lets the modulus be above 1e9 */
    fprintf(stream, "fix young all property/global youngsModulus peratomtype %s\n", ms_script_number(young, &value));
    fputs("fix poisson all property/global poissonsRatio peratomtype 0.3\n"
          "fix restitution all property/global coefficientRestitution peratomtypepair 1 0.5\n"
          "fix friction all property/global coefficientFriction peratomtypepair 1 0.5\n"
          "pair_style gran model hertz tangential history\npair_coeff * *\n",
          stream);
}

/* The floor and four walls, in the order of their names. */
static void write_liggghts_walls(FILE *stream, const double at[5])
{
    static const char *const WALLS[] = {"floor", "west", "east", "south", "north"};
    ms_number value;
    for (int k = 0; k < 5; k++) {
        fprintf(stream, "fix %s all wall/gran model hertz tangential history primitive type 1 %cplane %s\n", WALLS[k],
                "zxxyy"[k], ms_script_number(at[k], &value));
    }
}

/* The end of the line of a template. */
static void write_liggghts_mass(FILE *stream, const ms_particle *particle)
{
    ms_number value;
    fprintf(stream, " mass %s inertia_tensor", ms_script_number(particle->mass, &value));
    for (int k = 0; k < 6; k++) {
        const int is_moment = k == 0 || k == 3 || k == 5;
        fprintf(stream, " %s", is_moment ? ms_script_number(particle->inertia[k / 2][k / 2], &value) : "0");
    }
    fputs(" use_density\n", stream);
}

static void write_liggghts_particle(FILE *stream, const ms_content *content)
{
    const ms_particle *p = content->particle;
    ms_number a;
    fputs("# The template: mass and inertia about its origin, along its axes.\n", stream);
    fprintf(stream,
            "fix clump all particletemplate/multisphere 15485863 atom_type 1 volume_limit 1e-300 "
            "density constant %s nspheres %zu ntry 1000 spheres file ",
            ms_script_number(p->density, &a), ms_liggghts_spheres(content->clump));
    ms_escape_lammps(stream, content->name);
    fputs(" scale 1.0 type 1", stream);
    write_liggghts_mass(stream, p);
    fputs("fix kinds all particledistribution/discrete 15485867 1 clump 1.0\n", stream);
}

/* @param bin beyond which spheres are no neighbours */
static void start_liggghts_drop(FILE *stream, const ms_script_drop *d, double bin)
{
    ms_number a;
    fputs(ms_liggghts_style, stream);
    write_liggghts_places(stream, d);
    fprintf(stream, "neighbor %s bin\nneigh_modify delay 0\n\n", ms_script_number(bin, &a));
    write_liggghts_law(stream, d->young);
    write_liggghts_walls(stream, (const double[]){0, -d->side, d->side, -d->side, d->side});
    ms_script_drop_steps(stream, d);
    fprintf(stream, "timestep %s\n", ms_script_number(d->step, &a));
    fputs("fix gravity all gravity 9.81 vector 0 0 -1\n\n", stream);
}

/* Of the distribution `kinds`. */
static void end_liggghts_drop(FILE *stream, const ms_script_drop *d)
{
    fputs("fix insert all insert/pack seed 32452843 distributiontemplate kinds insert_every once overlapcheck yes "
          "orientation random all_in yes particles_in_region ${n} region above\nfix move all multisphere\n\n",
          stream);
    ms_script_drop_run(stream, d);
}

ms_status ms_liggghts_script(FILE *stream, const ms_content *content, ms_error *err)
{
    const ms_script_drop d = ms_script_drop_of(content);
    (void)err;
    ms_script_title(stream, content->name, "liggghts -in", ".in", "-var n 50");
    fputs("variable n index 1\n\n", stream);
    start_liggghts_drop(stream, &d, 0.2 * d.reach);
    write_liggghts_particle(stream, content);
    end_liggghts_drop(stream, &d);
    return MS_OK;
}

void ms_liggghts_template(FILE *stream, const ms_placed *placed, size_t k, unsigned seed)
{
    ms_number a, b;
    char file[4096];
    snprintf(file, sizeof file, "%s.liggghts", placed->name);
    fprintf(stream,
            "fix t%zu all particletemplate/multisphere %u atom_type 1 volume_limit 1e-300 density constant %s "
            "nspheres %zu ntry 1000 spheres file ",
            k, seed, ms_script_number(placed->particle.density, &a), ms_liggghts_spheres(&placed->clump));
    ms_escape_lammps(stream, file);
    fprintf(stream, " scale %s type %zu", ms_script_number(placed->scale, &b), k);
    write_liggghts_mass(stream, &placed->particle);
}

/* No command puts a multisphere at a point: each is inserted into a region that is as good as one. */
static void write_liggghts_placed(FILE *stream, const ms_placed *placed, size_t k, double speck)
{
    ms_number a, b;
    ms_liggghts_template(stream, placed, k, 15485863);
    fprintf(stream, "fix d%zu all particledistribution/discrete 15485867 1 t%zu 1.0\nregion r%zu block", k, k, k);
    for (int axis = 0; axis < 3; axis++) {
        const double x = placed->centre[axis];
        fprintf(stream, " %s %s", ms_script_number(x - speck, &a), ms_script_number(x + speck, &b));
    }
    fprintf(stream,
            " volume_limit 1e-300 units box\nfix i%zu all insert/pack seed 32452843 distributiontemplate d%zu "
            "insert_every once overlapcheck no orientation constant ",
            k, k);
    ms_fields_numbers(stream, placed->turn, 4, " ");
    fprintf(stream, " all_in no particles_in_region 1 region r%zu\n", k);
}

/* Half the width of such a region: a part in 1e9 of the smallest sphere, or what doubles can tell apart. */
static double speck_of(const ms_script_settle *s)
{
    double speck = 1e-9 * s->least;
    for (int k = 0; k < 3; k++) {
        speck = fmax(speck, 1e-15 * fmax(fabs(s->lo[k]), fabs(s->hi[k])));
    }
    return speck;
}

ms_status ms_liggghts_packing(FILE *stream, const ms_packing *packing, const char *name, ms_error *err)
{
    const ms_script_settle s = ms_script_settle_of(packing);
    (void)err;
    (void)name;
    for (size_t p = 0; p < packing->count; p++) {
        write_liggghts_placed(stream, &packing->placed[p], p + 1, speck_of(&s));
    }
    return MS_OK;
}

static void write_liggghts_domain(FILE *stream, const ms_script_settle *s)
{
    ms_number a, b;
    fputs("region box block", stream);
    for (int axis = 0; axis < 3; axis++) {
        double lo, hi;
        ms_script_settle_domain(&lo, &hi, s, axis);
        fprintf(stream, " %s %s", ms_script_number(lo, &a), ms_script_number(hi, &b));
    }
    fputs(" units box\ncreate_box 1 box\n", stream);
}

ms_status ms_liggghts_settle(FILE *stream, const ms_packing *packing, const char *name, ms_error *err)
{
    const ms_script_settle s = ms_script_settle_of(packing);
    ms_number a;
    (void)err;
    ms_script_settle_title(stream, name, "liggghts -in", ".in");
    fprintf(stream, "variable loosen index %.0f\nvariable steps index %.0f\n\n%s", s.loosen, s.end, ms_liggghts_style);
    write_liggghts_domain(stream, &s);
    fprintf(stream, "neighbor %s bin\nneigh_modify delay 0\n\n", ms_script_number(s.least, &a));
    fputs("soft_particles yes\n", stream); /* lets the modulus be below 5e6 */
    write_liggghts_law(stream, s.young);
    write_liggghts_walls(stream, (const double[]){s.lo[2], s.lo[0], s.hi[0], s.lo[1], s.hi[1]});
    fprintf(stream, "timestep %s\n\n# A template and a place for each.\ninclude ", ms_script_number(s.step, &a));
    ms_escape_lammps(stream, name);
    fputs("\nfix move all multisphere\ncompute energy all ke/multisphere\nthermo_style custom step atoms c_energy\n\n# "
          "Those that overlap come apart.\n",
          stream);
    fprintf(stream, "fix drag all viscous %s\nthermo 1000\nrun ${loosen}\nunfix drag\n\n",
            ms_script_number(s.drag, &a));
    fputs("# They settle.\nfix gravity all gravity 9.81 vector 0 0 -1\nthermo 10000\nrun ${steps}\n", stream);
    return MS_OK;
}

unsigned ms_liggghts_seed(unsigned after)
{
    for (unsigned n = after + 1;; n++) {
        unsigned divisor = 2;
        while (divisor * divisor <= n && n % divisor != 0) {
            divisor++;
        }
        if (divisor * divisor > n) {
            return n;
        }
    }
}

/* The shares are by number. Seeds must be primes above 10000, each another. */
ms_status ms_liggghts_mixture(FILE *stream, const ms_packing *mixture, const char *name, ms_error *err)
{
    const ms_script_drop d = ms_script_drop_of_mixture(mixture);
    unsigned seed = 1000000;
    ms_number a;
    (void)err;
    ms_script_mixture_title(stream, name, "liggghts -in", ".in", "-var n 500");
    fputs("variable n index 100\n\n", stream);
    start_liggghts_drop(stream, &d, 0.2 * d.reach);
    fputs("# A template of each kind and size, and the share of each.\n", stream);
    for (size_t k = 0; k < mixture->count; k++) {
        seed = ms_liggghts_seed(seed);
        ms_liggghts_template(stream, &mixture->placed[k], k + 1, seed);
    }
    fprintf(stream, "fix kinds all particledistribution/discrete/numberbased 15485867 %zu", mixture->count);
    for (size_t k = 0; k < mixture->count; k++) {
        fprintf(stream, " t%zu %s", k + 1, ms_script_number(mixture->placed[k].share, &a));
    }
    fputc('\n', stream);
    end_liggghts_drop(stream, &d);
    return MS_OK;
}
