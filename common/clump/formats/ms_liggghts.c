/* LIGGGHTS: a sphere file and a script with its particletemplate/multisphere. */
#include <math.h>

#include "base/ms_escape.h"
#include "ms_fields.h"
#include "ms_formats.h"
#include "ms_script.h"

/* A comment or an empty line in it crashes LIGGGHTS. */
ms_status ms_liggghts_write(FILE *stream, const ms_content *content, ms_error *err)
{
    (void)err;
    ms_fields_spheres(stream, content->clump, " ", "\n");
    return MS_OK;
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

static void write_liggghts_contacts(FILE *stream, const ms_script_drop *drop)
{
    static const char *const WALLS[] = {"floor", "west", "east", "south", "north"};
    ms_number value;
    fputs("hard_particles yes\n", stream); /* lets the modulus be above 1e9 */
    fprintf(stream, "fix young all property/global youngsModulus peratomtype %s\n",
            ms_script_number(drop->young, &value));
    fputs("fix poisson all property/global poissonsRatio peratomtype 0.3\n"
          "fix restitution all property/global coefficientRestitution peratomtypepair 1 0.5\n"
          "fix friction all property/global coefficientFriction peratomtypepair 1 0.5\n"
          "pair_style gran model hertz tangential history\npair_coeff * *\n",
          stream);
    ms_script_number(drop->side, &value);
    for (int k = 0; k < 5; k++) {
        fprintf(stream, "fix %s all wall/gran model hertz tangential history primitive type 1 %cplane %s%s\n", WALLS[k],
                "zxxyy"[k], k % 2 ? "-" : "", k == 0 ? "0" : value.text);
    }
}

static void write_liggghts_particle(FILE *stream, const ms_content *content)
{
    const ms_particle *p = content->particle;
    ms_number a, b, c;
    fputs("# The template: mass and inertia about its origin, along its axes.\n", stream);
    fprintf(stream,
            "fix clump all particletemplate/multisphere 15485863 atom_type 1 volume_limit 1e-300 "
            "density constant %s nspheres %zu ntry 1000 spheres file ",
            ms_script_number(p->density, &a), content->clump->n_spheres);
    ms_escape_lammps(stream, content->name);
    fprintf(stream, " scale 1.0 type 1 mass %s inertia_tensor", ms_script_number(p->mass, &b));
    for (int k = 0; k < 6; k++) {
        fprintf(stream, " %s", k == 0 || k == 3 || k == 5 ? ms_script_number(p->inertia[k / 2][k / 2], &c) : "0");
    }
    fputs(" use_density\nfix kinds all particledistribution/discrete 15485867 1 clump 1.0\n", stream);
}

ms_status ms_liggghts_script(FILE *stream, const ms_content *content, ms_error *err)
{
    const ms_script_drop d = ms_script_drop_of(content);
    ms_number a;
    (void)err;
    ms_script_title(stream, content->name, "liggghts -in", ".in", "-var n 50");
    fputs("variable n index 1\n\n", stream);
    fputs("atom_style granular\natom_modify map array\ncommunicate single vel yes\nboundary f f f\nnewton off\n"
          "units si\n",
          stream);
    write_liggghts_places(stream, &d);
    fprintf(stream, "neighbor %s bin\nneigh_modify delay 0\n\n", ms_script_number(0.2 * d.reach, &a));
    write_liggghts_contacts(stream, &d);
    fprintf(stream, "timestep %s\n", ms_script_number(d.step, &a));
    fputs("fix gravity all gravity 9.81 vector 0 0 -1\n\n", stream);
    write_liggghts_particle(stream, content);
    fputs("fix insert all insert/pack seed 32452843 distributiontemplate kinds insert_every once overlapcheck yes "
          "orientation random all_in yes particles_in_region ${n} region above\nfix move all multisphere\n\n",
          stream);
    fprintf(stream, "variable steps equal ceil(%.0f*sqrt(1+v_n/4))\n", ceil(d.end / d.step));
    fprintf(stream, "thermo %.0f\nrun ${steps}\n", ceil(d.end / d.step / 10));
    return MS_OK;
}
