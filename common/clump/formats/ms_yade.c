/* YADE: a file for ymport.textClumps, and a script. */
#include <math.h>

#include "base/ms_escape.h"
#include "ms_fields.h"
#include "ms_formats.h"
#include "ms_script.h"

ms_status ms_yade_write(FILE *stream, const ms_content *content, ms_error *err)
{
    (void)err;
    fputs("# x y z r clumpId\n", stream); /* with #format x_y_z_r_clumpId, ymport.text would refuse it */
    ms_fields_spheres(stream, content->clump, " ", " 0\n");
    return MS_OK;
}

/* YADE sums spheres by volume and density, and turns the clump into the axes of that sum. Spheres without density
 * around four small ones, a cross of unequal arms, sum to the centre and the axes of the template; mass and inertia can
 * then be set. The law of contact takes the reduced mass of the two spheres that touch: each is given that of the body,
 * which moves by the mass of the clump alone. Weightless, two of them have 0/0. */
static void write_yade_particle(FILE *stream, const ms_content *content)
{
    const ms_particle *p = content->particle;
    const double arm = ms_clump_smallest_radius(content->clump);
    ms_number a, b, c;
    fputs("def particle(position):\n"
          "    \"\"\"Adds a particle; its axes are those of the template. Returns the id of the clump.\"\"\"\n",
          stream);
    fputs("    spheres = ymport.text(", stream);
    ms_escape_python(stream, content->name);
    fputs(", shift=position, material='weightless')\n", stream);
    fprintf(stream, "    arms = [Vector3(%s, 0, 0), Vector3(0, %s, 0)]\n", ms_script_number(arm, &a),
            ms_script_number(arm / 2, &b));
    fputs("    cross = [sphere(position + side * arm, ", stream);
    fprintf(stream, "%s, material='cross') for arm in arms for side in (-1, 1)]\n", ms_script_number(1e-3 * arm, &a));
    fprintf(stream, "    mass = %s\n", ms_script_number(p->mass, &a));
    fputs("    clump, members = O.bodies.appendClumped(spheres + cross)\n"
          "    for i in members:\n"
          "        O.bodies[i].mat = O.materials['matter']\n"
          "        O.bodies[i].state.mass = mass  # what damps their contacts\n"
          "    for part in cross:\n"
          "        part.mask = 0  # meets nothing\n",
          stream);
    fputs("    O.bodies[clump].state.mass = mass\n", stream);
    fprintf(stream, "    O.bodies[clump].state.inertia = Vector3(%s, %s, %s)\n", ms_script_number(p->inertia[0][0], &a),
            ms_script_number(p->inertia[1][1], &b), ms_script_number(p->inertia[2][2], &c));
    fputs("    return clump\n\n\n", stream);
}

/* Nine to a layer, the first in the middle, turned at random; then the walls. */
static void write_yade_places(FILE *stream, const ms_script_drop *drop)
{
    ms_number reach, side;
    fprintf(stream, "reach, side = %s, %s  # of a particle; of the box, half its width\n",
            ms_script_number(drop->reach, &reach), ms_script_number(drop->side, &side));
    fputs("places = [Vector3(x, y, 1.5 + 2.2 * (k // 9)) * reach for k in range(0, n, 9)\n"
          "          for x in (0, -2.4, 2.4) for y in (0, -2.4, 2.4)]\n"
          "clumps = [particle(place) for place in places[:n]]\n"
          "random.seed(1)\n"
          "for clump in clumps:\n"
          "    axis = Vector3(*[random.gauss(0, 1) for k in range(3)]).normalized()\n"
          "    O.bodies[clump].state.ori = Quaternion(axis, random.uniform(0, 2 * math.pi))\n"
          "O.bodies.append(wall(0, axis=2, material='matter'))\n"
          "O.bodies.append([wall(at, axis=k, material='matter') for k in (0, 1) for at in (-side, side)])\n",
          stream);
}

ms_status ms_yade_script(FILE *stream, const ms_content *content, ms_error *err)
{
    static const char *const MATERIALS[] = {"matter", "weightless", "cross"};
    const ms_script_drop d = ms_script_drop_of(content);
    ms_number a, b;
    (void)err;
    ms_script_title(stream, content->name, "yade -x -n", ".py", "50");
    fputs("import math\nimport random\nimport sys\nfrom yade import ymport\n\n"
          "n = int(sys.argv[1]) if len(sys.argv) > 1 else 1\n",
          stream);
    for (int m = 0; m < 3; m++) {
        const double density[] = {content->particle->density, 0, 1};
        fprintf(stream,
                "O.materials.append(FrictMat(label='%s', young=%s, poisson=0.3, density=%s, frictionAngle=0.46))\n",
                MATERIALS[m], ms_script_number(d.young, &a), ms_script_number(density[m], &b));
    }
    fputs("\n\n", stream);
    write_yade_particle(stream, content);
    write_yade_places(stream, &d);
    fputs("O.engines = [\n"
          "    ForceResetter(),\n"
          "    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()]),\n"
          "    InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()],\n"
          "                    [Ip2_FrictMat_FrictMat_MindlinPhys(en=0.5)], [Law2_ScGeom_MindlinPhys_Mindlin()]),\n"
          "    NewtonIntegrator(damping=0, gravity=(0, 0, -9.81)),\n]\n",
          stream);
    fprintf(stream, "O.dt = %s\n", ms_script_number(d.step, &a));
    fprintf(stream, "for part in range(10):\n    O.run(math.ceil(%.0f * math.sqrt(1 + n / 4)), True)\n",
            ceil(d.end / d.step / 10));
    fputs("    print(O.time, O.bodies[clumps[0]].state.pos, O.bodies[clumps[0]].state.vel)\n", stream);
    return MS_OK;
}
