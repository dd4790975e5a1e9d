/* Scripts that load a template and drop it on a plane: a start for the user's own, run by the tests of the engines. */
#include <math.h>

#include "ms_write_formats.h"

/* A drop that suits the size of the particle, whatever that is. */
typedef struct drop {
    double reach; /* of the particle around its centre of mass */
    double young; /* stiff enough for overlaps of a per mille of its size, and what LIGGGHTS demands */
    double step;  /* a tenth of the Rayleigh time of the smallest sphere */
    double end;   /* time to fall and come to rest */
} drop;

static const double GRAVITY = 9.81, POISSON = 0.3;

static drop drop_of(const ms_content *content)
{
    const ms_particle *p = content->particle;
    const double reach = ms_template_reach(content->clump), least = ms_clump_smallest_radius(content->clump);
    const double young = fmax(1e5 * p->density * GRAVITY * reach, 5e6), shear = young / (2 * (1 + POISSON));
    const double rayleigh = acos(-1.0) * least * sqrt(p->density / shear) / (0.1631 * POISSON + 0.8766);
    return (drop){.reach = reach, .young = young, .step = rayleigh / 10, .end = 4 * sqrt(4 * reach / GRAVITY)};
}

static const char *text(double value, ms_number *room)
{
    *room = ms_text_of_number(value);
    return room->text;
}

ms_status ms_write_liggghts_script(FILE *stream, const ms_content *content, ms_error *err)
{
    const drop d = drop_of(content);
    const ms_particle *p = content->particle;
    ms_number a, b, c;
    (void)err;
    fprintf(stream, "# Drops %s on a plane: liggghts -in %s.in\n", content->name, content->name);
    fputs("atom_style granular\natom_modify map array\ncommunicate single vel yes\nboundary f f f\nnewton off\n"
          "units si\n",
          stream);
    fprintf(stream, "region box block -%s %s -%s %s", text(40 * d.reach, &a), a.text, a.text, a.text);
    fprintf(stream, " -%s %s units box\ncreate_box 1 box\n", text(d.reach, &b), text(4 * d.reach, &c));
    fprintf(stream, "neighbor %s bin\nneigh_modify delay 0\n\n", text(0.2 * d.reach, &a));
    fputs("hard_particles yes\n", stream); /* lets the modulus be above 1e9 */
    fprintf(stream, "fix young all property/global youngsModulus peratomtype %s\n", text(d.young, &a));
    fputs("fix poisson all property/global poissonsRatio peratomtype 0.3\n"
          "fix restitution all property/global coefficientRestitution peratomtypepair 1 0.5\n"
          "fix friction all property/global coefficientFriction peratomtypepair 1 0.5\n"
          "pair_style gran model hertz tangential history\npair_coeff * *\n",
          stream);
    fprintf(stream, "timestep %s\n", text(d.step, &a));
    fputs("fix gravity all gravity 9.81 vector 0 0 -1\n"
          "fix floor all wall/gran model hertz tangential history primitive type 1 zplane 0\n\n",
          stream);
    fputs("# The template: mass and inertia about its origin, along its axes.\n", stream);
    fprintf(stream,
            "fix clump all particletemplate/multisphere 15485863 atom_type 1 volume_limit 1e-300 "
            "density constant %s nspheres %zu ntry 1000 spheres file %s scale 1.0 type 1 mass %s inertia_tensor",
            text(p->density, &a), content->clump->n_spheres, content->name, text(p->mass, &b));
    for (int k = 0; k < 6; k++) {
        fprintf(stream, " %s", k == 0 || k == 3 || k == 5 ? text(p->inertia[k / 2][k / 2], &c) : "0");
    }
    fputs(" use_density\nfix kinds all particledistribution/discrete 15485867 1 clump 1.0\n", stream);
    fprintf(stream, "region above block -%s %s -%s %s", text(2 * d.reach, &a), a.text, a.text, a.text);
    fprintf(stream, " %s %s volume_limit 1e-300 units box\n", text(0.2 * d.reach, &b), text(3 * d.reach, &c));
    fputs("fix insert all insert/pack seed 32452843 distributiontemplate kinds insert_every once overlapcheck yes "
          "all_in yes particles_in_region 1 region above\nfix move all multisphere\n\n",
          stream);
    fprintf(stream, "thermo %.0f\nrun %.0f\n", ceil(d.end / d.step / 10), ceil(d.end / d.step));
    return MS_OK;
}

ms_status ms_write_lammps_script(FILE *stream, const ms_content *content, ms_error *err)
{
    const drop d = drop_of(content);
    ms_number a, b, c;
    (void)err;
    fprintf(stream, "# Drops %s on a plane: lmp -in %s.in\n", content->name, content->name);
    fputs("units si\natom_style sphere\natom_modify map array\nboundary f f f\nnewton off\n", stream);
    fprintf(stream, "region box block -%s %s -%s %s", text(40 * d.reach, &a), a.text, a.text, a.text);
    fprintf(stream, " -%s %s\ncreate_box 1 box\n", text(d.reach, &b), text(4 * d.reach, &c));
    fprintf(stream, "comm_modify vel yes cutoff %s\n", text(2 * d.reach, &a));
    fprintf(stream, "neighbor %s bin\n\n", text(0.2 * d.reach, &a));
    fputs("fix molecules all property/atom mol ghost yes\n"
          "neigh_modify delay 0 exclude molecule/intra all\n"
          "pair_style granular\n",
          stream);
    fprintf(stream, "pair_coeff * * hertz/material %s 0.5 0.3 tangential mindlin NULL 1.0 0.5 damping tsuji\n",
            text(d.young, &a));
    fprintf(stream, "timestep %s\n", text(d.step, &b));
    fputs("fix gravity all gravity 9.81 vector 0 0 -1 disable\n", stream);
    fprintf(stream,
            "fix floor all wall/gran granular hertz/material %s 0.5 0.3 tangential mindlin NULL 1.0 0.5 "
            "damping tsuji zplane 0 NULL\n\n",
            a.text);
    fputs("# The template: its mass and inertia are kept (reinit no) and gravity acts on the body.\n", stream);
    fprintf(stream, "molecule clump %s\n", content->name);
    fputs("fix move all rigid/small molecule mol clump reinit no gravity gravity\n", stream);
    fprintf(stream, "region above block -%s %s -%s %s", text(d.reach, &a), a.text, a.text, a.text);
    fprintf(stream, " %s %s\n", text(1.5 * d.reach, &b), text(2 * d.reach, &c));
    fputs("fix insert all deposit 1 0 1 32452843 region above mol clump rigid move\n\n", stream);
    fputs("thermo_style custom step atoms\nthermo_modify lost error\n", stream);
    fprintf(stream, "thermo %.0f\nrun %.0f\n", ceil(d.end / d.step / 10), ceil(d.end / d.step));
    return MS_OK;
}

/* YADE sums spheres by volume and density, and turns the clump into the axes of that sum. Spheres without density
 * around four small ones, a cross of unequal arms, sum to the centre and the axes of the template; mass and inertia can
 * then be set. */
static void write_yade_particle(FILE *stream, const ms_content *content)
{
    const ms_particle *p = content->particle;
    const double arm = ms_clump_smallest_radius(content->clump);
    ms_number a, b, c;
    fputs("def particle(position):\n"
          "    \"\"\"Adds a particle; its axes are those of the template. Returns the id of the clump.\"\"\"\n",
          stream);
    fprintf(stream, "    spheres = ymport.text('%s', shift=position, material='weightless')\n", content->name);
    fprintf(stream, "    arms = [Vector3(%s, 0, 0), Vector3(0, %s, 0)]\n", text(arm, &a), text(arm / 2, &b));
    fputs("    cross = [sphere(position + side * arm, ", stream);
    fprintf(stream, "%s, material='cross') for arm in arms for side in (-1, 1)]\n", text(1e-3 * arm, &a));
    fputs("    clump, members = O.bodies.appendClumped(spheres + cross)\n"
          "    for i in members:\n"
          "        O.bodies[i].mat = O.materials['matter']\n"
          "    for part in cross:\n"
          "        part.mask = 0  # meets nothing\n",
          stream);
    fprintf(stream, "    O.bodies[clump].state.mass = %s\n", text(p->mass, &a));
    fprintf(stream, "    O.bodies[clump].state.inertia = Vector3(%s, %s, %s)\n", text(p->inertia[0][0], &a),
            text(p->inertia[1][1], &b), text(p->inertia[2][2], &c));
    fputs("    return clump\n\n\n", stream);
}

ms_status ms_write_yade_script(FILE *stream, const ms_content *content, ms_error *err)
{
    static const char *const MATERIALS[] = {"matter", "weightless", "cross"};
    const drop d = drop_of(content);
    ms_number a, b;
    (void)err;
    fprintf(stream, "# Drops %s on a plane: yade -x -n %s.py\nfrom yade import ymport\n\n", content->name,
            content->name);
    for (int m = 0; m < 3; m++) {
        const double density[] = {content->particle->density, 0, 1};
        fprintf(stream,
                "O.materials.append(FrictMat(label='%s', young=%s, poisson=0.3, density=%s, frictionAngle=0.46))\n",
                MATERIALS[m], text(d.young, &a), text(density[m], &b));
    }
    fputs("\n\n", stream);
    write_yade_particle(stream, content);
    fprintf(stream, "clump = particle(Vector3(0, 0, %s))\n", text(1.5 * d.reach, &a));
    fputs("O.bodies.append(wall(0, axis=2, material='matter'))\n"
          "O.engines = [\n"
          "    ForceResetter(),\n"
          "    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()]),\n"
          "    InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()],\n"
          "                    [Ip2_FrictMat_FrictMat_MindlinPhys(en=0.5)], [Law2_ScGeom_MindlinPhys_Mindlin()]),\n"
          "    NewtonIntegrator(damping=0, gravity=(0, 0, -9.81)),\n]\n",
          stream);
    fprintf(stream, "O.dt = %s\n", text(d.step, &a));
    fprintf(stream, "for part in range(10):\n    O.run(%.0f, True)\n", ceil(d.end / d.step / 10));
    fputs("    print(O.time, O.bodies[clump].state.pos, O.bodies[clump].state.vel)\n", stream);
    return MS_OK;
}
