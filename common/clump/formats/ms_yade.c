/* YADE: a file for ymport.textClumps, and a script. */
#include <math.h>

#include "base/ms_escape.h"
#include "ms_fields.h"
#include "ms_formats.h"
#include "ms_script.h"
#include "ms_yade.h"

ms_status ms_yade_write(FILE *stream, const ms_content *content, ms_error *err)
{
    (void)err;
    fputs("# x y z r clumpId\n", stream); /* with #format x_y_z_r_clumpId, ymport.text would refuse it */
    ms_fields_spheres(stream, content->clump, " ", " 0\n");
    return MS_OK;
}

static const char CLUMPING[] = "    clump, members = O.bodies.appendClumped(spheres + cross)\n"
                               "    for i in members:\n"
                               "        O.bodies[i].mat = O.materials['matter']\n"
                               "        O.bodies[i].state.mass = mass  # what damps their contacts\n"
                               "    for part in cross:\n"
                               "        part.mask = 0  # meets nothing\n"
                               "    O.bodies[clump].state.mass = mass\n";

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
    fputs(CLUMPING, stream);
    fprintf(stream, "    O.bodies[clump].state.inertia = Vector3(%s, %s, %s)\n", ms_script_number(p->inertia[0][0], &a),
            ms_script_number(p->inertia[1][1], &b), ms_script_number(p->inertia[2][2], &c));
    fputs("    return clump\n\n\n", stream);
}

/* Nine to a layer, the first in the middle. */
static void write_yade_places(FILE *stream, const ms_script_drop *drop)
{
    ms_number reach, side;
    fprintf(stream, "reach, side = %s, %s  # of a particle; of the box, half its width\n",
            ms_script_number(drop->reach, &reach), ms_script_number(drop->side, &side));
    fputs("places = [Vector3(x, y, 1.5 + 2.2 * (k // 9)) * reach for k in range(0, n, 9)\n"
          "          for x in (0, -2.4, 2.4) for y in (0, -2.4, 2.4)]\n"
          "random.seed(1)\n"
          "def turn():\n"
          "    axis = Vector3(*[random.gauss(0, 1) for k in range(3)]).normalized()\n"
          "    return Quaternion(axis, random.uniform(0, 2 * math.pi))\n\n\n",
          stream);
}

static void write_yade_box(FILE *stream)
{
    fputs("O.bodies.append(wall(0, axis=2, material='matter'))\n"
          "O.bodies.append([wall(at, axis=k, material='matter') for k in (0, 1) for at in (-side, side)])\n",
          stream);
}

static void write_yade_materials(FILE *stream, double density, double young)
{
    static const char *const MATERIALS[] = {"matter", "weightless", "cross"};
    ms_number a, b;
    for (int m = 0; m < 3; m++) {
        fprintf(stream,
                "O.materials.append(FrictMat(label='%s', young=%s, poisson=0.3, density=%s, frictionAngle=0.46))\n",
                MATERIALS[m], ms_script_number(young, &a), ms_script_number(m == 0 ? density : m - 1, &b));
    }
    fputs("\n\n", stream);
}

static void write_yade_engines(FILE *stream, const char *gravity, double step)
{
    ms_number a;
    fprintf(stream,
            "O.engines = [\n"
            "    ForceResetter(),\n"
            "    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()]),\n"
            "    InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()],\n"
            "                    [Ip2_FrictMat_FrictMat_MindlinPhys(en=0.5)], [Law2_ScGeom_MindlinPhys_Mindlin()]),\n"
            "    NewtonIntegrator(damping=0, gravity=(0, 0, %s)),\n]\n"
            "O.dt = %s\n",
            gravity, ms_script_number(step, &a));
}

/* The box, and ten parts of the fall. */
static void write_yade_fall(FILE *stream, const ms_script_drop *drop)
{
    write_yade_box(stream);
    ms_script_drop_steps(stream, drop);
    write_yade_engines(stream, "-9.81", drop->step);
    fprintf(stream, "for part in range(10):\n    O.run(math.ceil(%.0f * math.sqrt(1 + n / 4)), True)\n",
            ceil(drop->end / drop->step / 10));
}

ms_status ms_yade_script(FILE *stream, const ms_content *content, ms_error *err)
{
    const ms_script_drop d = ms_script_drop_of(content);
    (void)err;
    ms_script_title(stream, content->name, "yade -x -n", ".py", "50");
    fputs("import math\nimport random\nimport sys\nfrom yade import ymport\n\n"
          "n = int(sys.argv[1]) if len(sys.argv) > 1 else 1\n",
          stream);
    write_yade_materials(stream, content->particle->density, d.young);
    write_yade_particle(stream, content);
    write_yade_places(stream, &d);
    fputs("clumps = [particle(place) for place in places[:n]]\n"
          "for clump in clumps:\n"
          "    O.bodies[clump].state.ori = turn()\n",
          stream);
    write_yade_fall(stream, &d);
    fputs("    print(O.time, O.bodies[clumps[0]].state.pos, O.bodies[clumps[0]].state.vel)\n", stream);
    return MS_OK;
}

/* Scale, mass and moments of a body. */
static void write_yade_body(FILE *stream, const ms_placed *d)
{
    const double row[] = {d->scale, d->particle.mass, d->particle.inertia[0][0], d->particle.inertia[1][1],
                          d->particle.inertia[2][2]};
    ms_fields_numbers(stream, row, 5, " ");
}

/* A line for each: its template, scale, mass, moments, centre and turn. */
ms_status ms_yade_packing(FILE *stream, const ms_packing *packing, const char *name, ms_error *err)
{
    (void)err;
    (void)name;
    fputs("# scale mass I1 I2 I3 x y z w qx qy qz template\n", stream);
    for (size_t p = 0; p < packing->count; p++) {
        const ms_placed *d = &packing->placed[p];
        write_yade_body(stream, d);
        fputc(' ', stream);
        ms_fields_numbers(stream, d->centre, 3, " ");
        fputc(' ', stream);
        ms_fields_numbers(stream, d->turn, 4, " ");
        fprintf(stream, " %s.yade\n", d->name);
    }
    return MS_OK;
}

void ms_yade_particle(FILE *stream)
{
    fputs(
        "def particle(file, scale, mass, inertia, position, turn):\n"
        "    \"\"\"Adds a particle; its axes are those of the template. Returns the id of the clump.\"\"\"\n"
        "    spheres = ymport.text(file, scale=scale, shift=position, material='weightless')\n"
        "    arm = min(part.shape.radius for part in spheres)\n"
        "    arms = [Vector3(arm, 0, 0), Vector3(0, arm / 2, 0)]\n"
        "    cross = [sphere(position + side * at, 1e-3 * arm, material='cross') for at in arms for side in (-1, 1)]\n",
        stream);
    fputs(CLUMPING, stream);
    fputs("    O.bodies[clump].state.inertia = inertia\n"
          "    O.bodies[clump].state.ori = turn * O.bodies[clump].state.ori  # which may be a half turn\n"
          "    for i in members:  # which would follow in the step after the first contacts\n"
          "        O.bodies[i].state.pos = position + turn * (O.bodies[i].state.pos - position)\n"
          "    return clump\n\n\n",
          stream);
}

static void write_yade_placed(FILE *stream, const char *name)
{
    ms_yade_particle(stream);
    fputs("clumps = []\nfor line in open(", stream);
    ms_escape_python(stream, name);
    fputs("):\n"
          "    if line.startswith('#'):\n"
          "        continue\n"
          "    *row, file = line.rstrip('\\n').split(' ', 12)\n"
          "    scale, mass, *row = map(float, row)\n"
          "    turn = Quaternion(*row[6:])\n"
          "    clumps.append(particle(file, scale, mass, Vector3(*row[:3]), Vector3(*row[3:6]), turn))\n",
          stream);
}

ms_status ms_yade_settle(FILE *stream, const ms_packing *packing, const char *name, ms_error *err)
{
    const ms_script_settle s = ms_script_settle_of(packing);
    ms_number a, b;
    (void)err;
    ms_script_settle_title(stream, name, "yade -x -n", ".py");
    fprintf(stream,
            "import sys\nfrom yade import ymport\n\n"
            "loosen = int(sys.argv[1]) if len(sys.argv) > 1 else %.0f  # steps\n"
            "steps = int(sys.argv[2]) if len(sys.argv) > 2 else %.0f\n",
            s.loosen, s.end);
    write_yade_materials(stream, packing->placed[0].particle.density, s.young);
    write_yade_placed(stream, name);
    fprintf(stream, "O.bodies.append(wall(%s, axis=2, material='matter'))\n", ms_script_number(s.lo[2], &a));
    for (int k = 0; k < 2; k++) {
        fprintf(stream, "O.bodies.append([wall(at, axis=%d, material='matter') for at in (%s, %s)])\n", k,
                ms_script_number(s.lo[k], &a), ms_script_number(s.hi[k], &b));
    }
    write_yade_engines(stream, "0", s.step);
    fputs("# Those that overlap come apart: they are stopped every 20 steps.\n"
          "for part in range(loosen // 20):\n"
          "    O.run(20, True)\n"
          "    calm()\n"
          "# They settle.\n"
          "O.engines[-1].gravity = (0, 0, -9.81)\n"
          "for part in range(10):\n"
          "    O.run(max(1, steps // 10), True)\n"
          "    print(O.time, max(O.bodies[clump].state.vel.norm() for clump in clumps))\n",
          stream);
    return MS_OK;
}

/* A line for each kind: its share, template, scale, mass and moments. */
ms_status ms_yade_kinds(FILE *stream, const ms_packing *mixture, const char *name, ms_error *err)
{
    (void)err;
    (void)name;
    fputs("# share scale mass I1 I2 I3 template\n", stream);
    for (size_t k = 0; k < mixture->count; k++) {
        const ms_placed *kind = &mixture->placed[k];
        fprintf(stream, "%s ", ms_text_of_number(kind->share).text);
        write_yade_body(stream, kind);
        fprintf(stream, " %s.yade\n", kind->name);
    }
    return MS_OK;
}

ms_status ms_yade_mixture(FILE *stream, const ms_packing *mixture, const char *name, ms_error *err)
{
    const ms_script_drop d = ms_script_drop_of_mixture(mixture);
    (void)err;
    ms_script_mixture_title(stream, name, "yade -x -n", ".py", "500");
    fputs("import math\nimport random\nimport sys\nfrom yade import ymport\n\n"
          "n = int(sys.argv[1]) if len(sys.argv) > 1 else 100\n",
          stream);
    write_yade_materials(stream, mixture->placed[0].particle.density, d.young);
    ms_yade_particle(stream);
    write_yade_places(stream, &d);
    fputs("kinds = [line.rstrip('\\n').split(' ', 6) for line in open(", stream);
    ms_escape_python(stream, name);
    fputs(") if not line.startswith('#')]\n"
          "shares = [float(kind[0]) for kind in kinds]\n"
          "clumps = []\n"
          "for place in places[:n]:\n"
          "    _, *row, file = random.choices(kinds, shares)[0]\n"
          "    scale, mass, *inertia = map(float, row)\n"
          "    clumps.append(particle(file, scale, mass, Vector3(*inertia), place, turn()))\n",
          stream);
    write_yade_fall(stream, &d);
    fputs("    print(O.time, max(O.bodies[clump].state.vel.norm() for clump in clumps))\n", stream);
    return MS_OK;
}
