/* LAMMPS: a molecule file for fix rigid/small, a header, then sections with a line for each sphere; and a script. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_escape.h"
#include "base/ms_quaternion.h"
#include "base/ms_text.h"
#include "base/ms_version.h"
#include "ms_fields.h"
#include "ms_formats.h"
#include "ms_lammps.h"
#include "ms_script.h"

/* Products of inertia below this part of the moments are rounding, of whoever wrote the file. */
static const double ROUNDING = 1e-9;

/* What the file says of each sphere. */
typedef struct molecule {
    size_t n;
    double (*row)[5]; /* x, y, z, diameter, mass */
    int seen[3];      /* sections: Coords, Diameters, Masses */
    size_t carriers;  /* the last ones */
} molecule;

static const struct {
    const char *name;
    size_t first, count; /* columns of the row */
} SECTIONS[] = {{"coords", 0, 3}, {"diameters", 3, 1}, {"masses", 4, 1}};

static ms_status read_section(molecule *t, ms_text *text, int section, ms_error *err)
{
    for (size_t s = 0; s < t->n; s++) {
        double v[4];
        if (!ms_text_seek(text)) {
            return ms_text_fail(err, text, "the section ends after %zu of %zu spheres", s, t->n);
        }
        ms_status status = ms_text_doubles(v, SECTIONS[section].count + 1, text, "a sphere of the section", err);
        if (status != MS_OK) {
            return status;
        }
        if (!(v[0] >= 1 && v[0] <= (double)t->n && v[0] == floor(v[0]))) {
            return ms_text_fail(err, text, "there is no sphere %g among %zu", v[0], t->n);
        }
        memcpy(t->row[(size_t)v[0] - 1] + SECTIONS[section].first, v + 1, SECTIONS[section].count * sizeof *v);
        ms_text_skip_line(text);
    }
    t->seen[section] = 1;
    return MS_OK;
}

static ms_status start_molecule(molecule *t, ms_text *text, double n, ms_error *err)
{
    if (t->row || !(n >= 1 && n <= MS_CLUMP_MAX_SPHERES && n == floor(n))) {
        return ms_text_fail(err, text, "the number of atoms is given twice or is not from 1 to %d",
                            MS_CLUMP_MAX_SPHERES);
    }
    t->n = (size_t)n;
    t->row = calloc(t->n, sizeof *t->row);
    return t->row ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "%s: no memory for %zu spheres", text->name, t->n);
}

/* A line "numbers keyword" of the header. */
static ms_status read_header_line(molecule *t, ms_particle *particle, ms_text *text, const double *v, int n,
                                  const ms_word *keyword, ms_error *err)
{
    if (n == 1 && ms_text_word_is(keyword, "atoms")) {
        return start_molecule(t, text, v[0], err);
    }
    if (n == 1 && ms_text_word_is(keyword, "mass")) {
        particle->mass = v[0];
    } else if (n == 3 && ms_text_word_is(keyword, "com")) {
        memcpy(particle->centre, v, 3 * sizeof *v);
    } else if (n == 6 && ms_text_word_is(keyword, "inertia")) {
        if (!(fmax(fabs(v[3]), fmax(fabs(v[4]), fabs(v[5]))) <= ROUNDING * (v[0] + v[1] + v[2]))) {
            return ms_text_fail(err, text, "the inertia has products; only principal axes are read");
        }
        for (int k = 0; k < 3; k++) {
            particle->inertia[k][k] = v[k];
        }
    } else {
        return ms_text_fail(err, text, "this line of the header is not understood; give atoms, mass, com, inertia");
    }
    return MS_OK;
}

static ms_status read_line(molecule *t, ms_particle *particle, ms_text *text, ms_error *err)
{
    double v[6];
    ms_word word;
    int n = 0;
    while (ms_text_word(&word, text) && n < 6 && ms_text_to_double(&v[n], &word)) {
        n++;
    }
    if (n > 0) {
        return read_header_line(t, particle, text, v, n, &word, err);
    }
    if (ms_text_word_is(&word, "types")) {
        for (size_t s = 0; s < t->n && ms_text_seek(text); s++) {
            ms_text_skip_line(text);
        }
        return MS_OK;
    }
    for (int section = 0; section < 3; section++) {
        if (ms_text_word_is(&word, SECTIONS[section].name)) {
            ms_text_skip_line(text);
            return read_section(t, text, section, err);
        }
    }
    return ms_text_fail(err, text, "'%s' is no section that is read; these are Coords, Types, Diameters, Masses",
                        ms_text_quote(&word).text);
}

/* A file may leave out mass and inertia; what it says must make sense. */
static ms_status finish_particle(ms_particle *particle, const char *name, ms_error *err)
{
    if (particle->mass == 0 && particle->inertia[0][0] == 0) {
        memset(particle, 0, sizeof *particle);
        return MS_OK;
    }
    ms_error cause;
    particle->scale = 1;
    return ms_particle_check(particle, &cause) == MS_OK
               ? MS_OK
               : ms_fail(err, MS_ERR_FORMAT, "%s: mass and inertia of its header: %s", name, cause.text);
}

static const char LAST[] = "; the last ", CARRIERS[] = " are carriers of mass";

/* What the title says of carriers, if mskit wrote it. */
static size_t carriers_of_title(ms_text text)
{
    char title[256];
    const ms_word line = ms_text_rest(&text);
    snprintf(title, sizeof title, "%.*s", (int)(line.length < sizeof title ? line.length : 0), line.start);
    const char *at = strstr(title, LAST);
    char *end = NULL;
    const unsigned long count = at ? strtoul(at + strlen(LAST), &end, 10) : 0;
    return end && strncmp(end, CARRIERS, strlen(CARRIERS)) == 0 ? count : 0;
}

static ms_status fill_clump(ms_clump *clump, ms_particle *particle, const molecule *t, const char *name, ms_error *err)
{
    if (t->n == 0 || !t->seen[0] || !t->seen[1]) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: a molecule of spheres has the number of atoms, Coords and Diameters",
                       name);
    }
    if (t->carriers >= t->n || (t->carriers > 0 && !t->seen[2])) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: its title tells of %zu carriers, for which it has no spheres or masses",
                       name, t->carriers);
    }
    ms_status status = MS_OK;
    for (size_t s = 0; s < t->n && status == MS_OK; s++) {
        const double *row = t->row[s];
        const int is_carrier = s >= t->n - t->carriers;
        status =
            ms_fields_add_sphere(clump, is_carrier, (const double[]){row[0], row[1], row[2], row[3] / 2}, name, err);
    }
    if (status == MS_OK && t->seen[2]) {
        status = ms_clump_alloc_masses(clump, err);
        for (size_t s = 0; s < t->n && status == MS_OK; s++) {
            clump->mass[s] = t->row[s][4];
        }
    }
    return status == MS_OK ? finish_particle(particle, name, err) : status;
}

ms_status ms_lammps_read(ms_clump *clump, ms_particle *particle, ms_bytes *bytes, const char *name, ms_error *err)
{
    ms_text text;
    molecule t = {0};
    ms_status status = MS_OK;
    ms_text_start(&text, bytes, name);
    text.comment = '#';
    t.carriers = carriers_of_title(text); /* the first line is a title */
    ms_text_skip_line(&text);
    while (status == MS_OK && ms_text_seek(&text)) {
        status = read_line(&t, particle, &text, err);
        ms_text_skip_line(&text);
    }
    if (status == MS_OK) {
        status = fill_clump(clump, particle, &t, name, err);
    }
    free(t.row);
    return status;
}

static void write_section(FILE *stream, const char *name, const ms_clump *clump)
{
    fprintf(stream, "\n%s\n\n", name);
    for (size_t s = 0; s < ms_clump_count_masses(clump); s++) {
        fprintf(stream, "%zu ", s + 1);
        switch (name[0]) {
        case 'C':
            ms_fields_numbers(stream, clump->sphere[s].centre, 3, " ");
            break;
        case 'T':
            fputc(s < clump->n_spheres ? '1' : '2', stream);
            break;
        case 'D':
            ms_fields_numbers(stream, (const double[]){2 * clump->sphere[s].radius}, 1, " ");
            break;
        default:
            ms_fields_numbers(stream, &clump->mass[s], 1, " ");
        }
        fputc('\n', stream);
    }
}

/* Zeros for the products of inertia: their order differs between LAMMPS's manual and its code. */
ms_status ms_lammps_write(FILE *stream, const ms_content *content, ms_error *err)
{
    static const char *const WRITTEN[] = {"Coords", "Types", "Diameters", "Masses"};
    (void)err;
    fputs("clump by mskit " MS_VERSION ", SI, from the centre of mass along the principal axes", stream);
    if (content->clump->n_carriers > 0) {
        fprintf(stream, "%s%zu%s", LAST, content->clump->n_carriers, CARRIERS);
    }
    fprintf(stream, "\n\n%zu atoms\n", ms_clump_count_masses(content->clump));
    fprintf(stream, "%s mass\n0 0 0 com\n", ms_text_of_number(content->particle->mass).text);
    ms_fields_moments(stream, content->particle, 1, " ");
    fputs(" 0 0 0 inertia\n", stream);
    for (int k = 0; k < 4; k++) {
        write_section(stream, WRITTEN[k], content->clump);
    }
    return MS_OK;
}

/* Contact of spheres and of walls. The polynomial of damping tsuji is for the mass of one of two equal spheres, but
 * LAMMPS multiplies it by the reduced mass: a restitution of 0.5 has to be asked for as that whose polynomial is larger
 * by the root of 2, or 0.615 is what comes of it. Each run puts the walls' through the polynomial again: the script has
 * one. */
static void write_lammps_law(FILE *stream, double young)
{
    ms_number value;
    fprintf(stream,
            "# 0.3667 makes a restitution of 0.5.\n"
            "variable contact string \"hertz/material %s 0.3667 0.3 tangential mindlin NULL 1.0 0.5 damping tsuji\"\n"
            "pair_style granular\npair_coeff * * ${contact}\n",
            ms_script_number(young, &value));
}

/* The floor, and the walls along x and y. */
static void write_lammps_walls(FILE *stream, double floor, const double lo[2], const double hi[2])
{
    ms_number a, b;
    fprintf(stream, "fix floor all wall/gran granular ${contact} zplane %s NULL\n", ms_script_number(floor, &a));
    for (int k = 0; k < 2; k++) {
        fprintf(stream, "fix %s all wall/gran granular ${contact} %cplane %s %s\n", k ? "south_north" : "west_east",
                "xy"[k], ms_script_number(lo[k], &a), ms_script_number(hi[k], &b));
    }
}

/* Where particles are inserted: above the floor, within the walls, the higher the more there are. */
static void write_lammps_places(FILE *stream, const ms_script_drop *drop, int carriers)
{
    ms_number reach, width, low;
    fprintf(stream, "variable top equal %s*(2+v_n)\nvariable roof equal v_top+%s\n",
            ms_script_number(drop->reach, &reach), reach.text);
    fprintf(stream, "region box block -%s %s -%s %s", ms_script_number(1.25 * drop->side, &width), width.text,
            width.text, width.text);
    fprintf(stream, " -%s ${roof}\ncreate_box %d box\n", reach.text, carriers ? 2 : 1);
    fprintf(stream, "region above block -%s %s -%s %s", ms_script_number(drop->side - drop->reach, &width), width.text,
            width.text, width.text);
    fprintf(stream, " %s ${top}\n", ms_script_number(1.5 * drop->reach, &low));
}

void ms_lammps_exclude_carriers(FILE *stream)
{
    fputs("# Carriers of mass, type 2, meet no other sphere, and the step is that of the others. Walls know no types:\n"
          "# one meets a carrier if it comes as deep into the sphere around it as that lies.\n"
          "neigh_modify exclude type 1 2\nneigh_modify exclude type 2 2\n",
          stream);
}

/* Up to the templates. @param carriers some have them */
static void start_lammps_drop(FILE *stream, const ms_script_drop *d, int carriers)
{
    ms_number a, b;
    fputs("units si\natom_style sphere\natom_modify map array\nboundary f f f\nnewton off\n", stream);
    write_lammps_places(stream, d, carriers);
    fprintf(stream, "comm_modify vel yes cutoff %s\n", ms_script_number(2 * d->reach, &a));
    fprintf(stream, "neighbor %s bin\n\n", ms_script_number(0.2 * d->reach, &a));
    fputs("fix molecules all property/atom mol ghost yes\n"
          "neigh_modify delay 0 exclude molecule/intra all\n",
          stream);
    if (carriers) {
        ms_lammps_exclude_carriers(stream);
    }
    write_lammps_law(stream, d->young);
    write_lammps_walls(stream, 0, (const double[]){-d->side, -d->side}, (const double[]){d->side, d->side});
    ms_script_drop_steps(stream, d);
    fprintf(stream, "timestep %s\n", ms_script_number(d->step, &b));
    fputs("fix gravity all gravity 9.81 vector 0 0 -1 disable\n\n", stream);
}

/* Of the molecule `clump`, or of a choice of them by shares. */
static void end_lammps_drop(FILE *stream, const ms_script_drop *d, const ms_packing *mixture)
{
    ms_number a;
    fputs("\nfix move all rigid/small molecule mol clump reinit no gravity gravity\n", stream);
    fputs("# Without near they may be inserted into each other, and LAMMPS loses atoms.\n", stream);
    fputs("fix insert all deposit ${n} 0 1 32452843 region above mol clump", stream);
    for (size_t k = 0; mixture && k < mixture->count; k++) {
        fprintf(stream, "%s%s", k ? " " : " molfrac ", ms_script_number(mixture->placed[k].share, &a));
    }
    fprintf(stream, " rigid move near %s attempt 500\n\n", ms_script_number(2 * d->reach, &a));
    fputs("thermo_style custom step atoms\nthermo_modify lost error\n", stream);
    ms_script_drop_run(stream, d);
}

ms_status ms_lammps_script(FILE *stream, const ms_content *content, ms_error *err)
{
    const ms_script_drop d = ms_script_drop_of(content);
    (void)err;
    ms_script_title(stream, content->name, "lmp -in", ".in", "-var n 50");
    fputs("variable n index 1\n\n", stream);
    start_lammps_drop(stream, &d, content->clump->n_carriers > 0);
    fputs("# The template: its mass and inertia are kept (reinit no) and gravity acts on the body.\n", stream);
    fputs("molecule clump ", stream);
    ms_escape_lammps(stream, content->name);
    end_lammps_drop(stream, &d, NULL);
    return MS_OK;
}

static void write_lammps_atoms(FILE *stream, const ms_packing *packing)
{
    size_t atom = 1;
    fputs("\nAtoms # sphere\n\n", stream);
    for (size_t p = 0; p < packing->count; p++) {
        const ms_placed *placed = &packing->placed[p];
        for (size_t s = 0; s < placed->clump.n_spheres; s++) {
            const ms_sphere b = ms_packing_sphere(placed, s);
            const double row[] = {2 * b.radius, placed->particle.density, b.centre[0], b.centre[1], b.centre[2]};
            fprintf(stream, "%zu 1 ", atom++);
            ms_fields_numbers(stream, row, 5, " ");
            fputc('\n', stream);
        }
    }
}

/* The number of the body of each atom. */
static void write_lammps_molecules(FILE *stream, const ms_packing *packing)
{
    size_t atom = 1;
    fputs("\nMolecules\n\n", stream);
    for (size_t p = 0; p < packing->count; p++) {
        for (size_t s = 0; s < packing->placed[p].clump.n_spheres; s++) {
            fprintf(stream, "%zu %zu\n", atom++, p + 1);
        }
    }
}

/* A data file: the spheres as atoms, in their places. */
ms_status ms_lammps_packing(FILE *stream, const ms_packing *packing, const char *name, ms_error *err)
{
    const ms_script_settle settle = ms_script_settle_of(packing);
    size_t spheres = 0;
    ms_number a, b;
    (void)err;
    (void)name;
    for (size_t p = 0; p < packing->count; p++) {
        spheres += packing->placed[p].clump.n_spheres;
    }
    fprintf(stream, "packing by mskit " MS_VERSION ", SI\n\n%zu atoms\n1 atom types\n", spheres);
    for (int axis = 0; axis < 3; axis++) {
        double lo, hi;
        ms_script_settle_domain(&lo, &hi, &settle, axis);
        fprintf(stream, "%s %s %clo %chi\n", ms_script_number(lo, &a), ms_script_number(hi, &b), "xyz"[axis],
                "xyz"[axis]);
    }
    write_lammps_atoms(stream, packing);
    write_lammps_molecules(stream, packing);
    return MS_OK;
}

/* The inertia of a body along the axes of the packing, xx yy zz xy xz yz: sum of moment * axis axis^T. */
static void turn_inertia(double out[6], const ms_placed *placed)
{
    static const int ROW[] = {0, 1, 2, 0, 0, 1}, COLUMN[] = {0, 1, 2, 1, 2, 2};
    memset(out, 0, 6 * sizeof *out);
    for (int m = 0; m < 3; m++) {
        const double along[3] = {m == 0, m == 1, m == 2};
        double axis[3];
        ms_quaternion_turn(axis, placed->turn, along);
        for (int k = 0; k < 6; k++) {
            out[k] += placed->particle.inertia[m][m] * axis[ROW[k]] * axis[COLUMN[k]];
        }
    }
}

/* The infile of fix rigid/small: body, mass, centre, inertia, velocity, angular momentum, images. */
ms_status ms_lammps_bodies(FILE *stream, const ms_packing *packing, const char *name, ms_error *err)
{
    (void)err;
    (void)name;
    fprintf(stream, "%zu\n", packing->count);
    for (size_t p = 0; p < packing->count; p++) {
        const ms_placed *placed = &packing->placed[p];
        double inertia[6];
        turn_inertia(inertia, placed);
        fprintf(stream, "%zu %s ", p + 1, ms_text_of_number(placed->particle.mass).text);
        ms_fields_numbers(stream, placed->centre, 3, " ");
        fputc(' ', stream);
        ms_fields_numbers(stream, inertia, 6, " ");
        fputs(" 0 0 0 0 0 0 0 0 0\n", stream);
    }
    return MS_OK;
}

static void write_lammps_bodies_fix(FILE *stream, const char *name)
{
    char bodies[512];
    snprintf(bodies, sizeof bodies, "%s.bodies", name);
    fputs("# The bodies: mass and inertia are kept (reinit no) and gravity acts on them.\n"
          "fix move all rigid/small molecule infile ",
          stream);
    ms_escape_lammps(stream, bodies);
    fputs(" reinit no gravity gravity\n\n", stream);
}

ms_status ms_lammps_settle(FILE *stream, const ms_packing *packing, const char *name, ms_error *err)
{
    const ms_script_settle s = ms_script_settle_of(packing);
    ms_number a;
    (void)err;
    ms_script_settle_title(stream, name, "lmp -in", ".in");
    fprintf(stream, "variable loosen index %.0f\nvariable steps index %.0f\n\n", s.loosen, s.end);
    fputs("units si\natom_style sphere\natom_modify map array\nboundary f f f\nnewton off\n"
          "fix molecules all property/atom mol ghost yes\nread_data ",
          stream);
    ms_escape_lammps(stream, name);
    fprintf(stream, " fix molecules NULL Molecules\ncomm_modify vel yes cutoff %s\n",
            ms_script_number(2 * s.reach, &a));
    fprintf(stream, "neighbor %s bin\nneigh_modify delay 0 exclude molecule/intra all\n\n",
            ms_script_number(s.least, &a));
    write_lammps_law(stream, s.young);
    write_lammps_walls(stream, s.lo[2], s.lo, s.hi);
    fprintf(stream, "timestep %s\nfix gravity all gravity 0 vector 0 0 -1 disable\n\n", ms_script_number(s.step, &a));
    write_lammps_bodies_fix(stream, name);
    fprintf(stream,
            "compute energy all ke/rigid move\nthermo_style custom step atoms c_energy\n"
            "thermo_modify lost error\n\n# Those that overlap come apart.\n"
            "fix drag all viscous %s\nthermo 1000\nrun ${loosen}\nunfix drag\n\n",
            ms_script_number(s.drag, &a));
    fputs("# They settle. Walls lose their damping in a second run: new ones.\n"
          "unfix floor\nunfix west_east\nunfix south_north\n",
          stream);
    write_lammps_walls(stream, s.lo[2], s.lo, s.hi);
    fputs("fix gravity all gravity 9.81 vector 0 0 -1 disable\nthermo 10000\nrun ${steps}\n", stream);
    return MS_OK;
}

/* The scale of a molecule goes for mass and inertia, too. */
void ms_lammps_molecules(FILE *stream, const ms_packing *mixture)
{
    fputs("# A template of each kind and size: mass and inertia are kept (reinit no) and gravity acts on the body.\n"
          "molecule clump",
          stream);
    for (size_t k = 0; k < mixture->count; k++) {
        ms_number scale;
        char file[4096];
        snprintf(file, sizeof file, "%s.lammps", mixture->placed[k].name);
        fputs(" &\n    ", stream);
        ms_escape_lammps(stream, file);
        fprintf(stream, " scale %s", ms_script_number(mixture->placed[k].scale, &scale));
    }
}

ms_status ms_lammps_mixture(FILE *stream, const ms_packing *mixture, const char *name, ms_error *err)
{
    const ms_script_drop d = ms_script_drop_of_mixture(mixture);
    int carriers = 0;
    (void)err;
    for (size_t k = 0; k < mixture->count; k++) {
        carriers |= mixture->placed[k].clump.n_carriers > 0;
    }
    ms_script_mixture_title(stream, name, "lmp -in", ".in", "-var n 500");
    fputs("variable n index 100\n\n", stream);
    start_lammps_drop(stream, &d, carriers);
    ms_lammps_molecules(stream, mixture);
    end_lammps_drop(stream, &d, mixture);
    return MS_OK;
}
