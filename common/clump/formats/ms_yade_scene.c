/* YADE: a script that lets the particles of a scene come to rest. */
#include "base/ms_escape.h"
#include "ms_fields.h"
#include "ms_formats.h"
#include "ms_script_scene.h"
#include "ms_yade.h"

static void write_yade_settings(FILE *stream, const ms_script_scene *s)
{
    ms_number young, step, fall, rest;
    fputs("import itertools\nimport math\nimport random\nimport sys\nfrom yade import export, geom, ymport\n\n",
          stream);
    fprintf(stream, "young, poisson, restitution, friction = %s, 0.3, 0.5, 0.5\n", ms_script_number(s->young, &young));
    fprintf(stream, "step = %s * math.sqrt(%s / young)\n", ms_script_number(s->step, &step), young.text);
    fprintf(stream, "tenth = math.ceil(%s / 100 / step)  # steps: of a part, ten of which are the time of the fall\n",
            ms_script_number(s->fall, &fall));
    fprintf(stream, "least = %s  # J, kinetic energy of all at rest\n", ms_script_number(s->rest, &rest));
    fprintf(stream, "density = %s\n", ms_script_number(s->density, &rest));
    fputs("for label, own in (('matter', density), ('weightless', 0), ('cross', 1)):\n"
          "    O.materials.append(FrictMat(label=label, young=young, poisson=poisson, density=own,\n"
          "                                frictionAngle=math.atan(friction)))\n\n\n",
          stream);
}

static void write_yade_kinds(FILE *stream, const ms_packing *scene)
{
    fputs("kinds = [  # particles, template, scale, mass, moments of inertia, reach; the largest first\n", stream);
    for (size_t k = 0; k < scene->count; k++) {
        const ms_placed *kind = &scene->placed[k];
        const ms_particle *p = &kind->particle;
        const double moment[] = {p->inertia[0][0], p->inertia[1][1], p->inertia[2][2]};
        char file[4096];
        ms_number scale, mass;
        snprintf(file, sizeof file, "%s.yade", kind->name);
        fprintf(stream, "    (%zu, ", kind->count);
        ms_escape_python(stream, file);
        fprintf(stream, ", %s, %s, Vector3(", ms_script_number(kind->scale, &scale), ms_script_number(p->mass, &mass));
        ms_fields_numbers(stream, moment, 3, ", ");
        fprintf(stream, "), %s),\n", ms_script_number(kind->scale * ms_template_reach(&kind->clump), &scale));
    }
    fputs("]\n", stream);
}

/* Balls around the particles are put where there is room; what may be near stands in the cells around. */
static void write_yade_column(FILE *stream, const ms_script_scene *s)
{
    ms_number x, y, low, top;
    fprintf(stream, "half_x, half_y, low, top = %s, %s, %s, %s  # of the vessel; of the column\n",
            ms_script_number(s->half[0], &x), ms_script_number(s->half[1], &y), ms_script_number(s->low, &low),
            ms_script_number(s->top, &top));
    fputs("cell = 2 * max(kind[-1] for kind in kinds)\n"
          "balls = {}  # by cells\n\n\n"
          "def find_room(reach):\n"
          "    for attempt in range(10000):\n"
          "        x, y = (random.uniform(-1, 1) * (half - reach) for half in (half_x, half_y))\n"
          "        at = (x, y, random.uniform(low + reach, top - reach))\n"
          "        home = tuple(int(c // cell) for c in at)\n"
          "        around = itertools.product(*((c - 1, c, c + 1) for c in home))\n",
          stream);
    fprintf(
        stream,
        "        if %sall(math.dist(at, other) > reach + its for c in around for other, its in balls.get(c, ())):\n",
        s->is_round ? "math.hypot(x, y) < half_x - reach and " : "");
    fputs("            balls.setdefault(home, []).append((at, reach))\n"
          "            return Vector3(*at)\n"
          "    print('scene: not all particles have room; make the column higher')\n"
          "    sys.exit(1)\n\n\n"
          "random.seed(1)\n"
          "clumps = []\n"
          "for count, file, scale, mass, inertia, reach in kinds:\n"
          "    for i in range(count):\n"
          "        axis = Vector3(*[random.gauss(0, 1) for k in range(3)]).normalized()\n"
          "        turn = Quaternion(axis, random.uniform(0, 2 * math.pi))\n"
          "        clumps.append(particle(file, scale, mass, inertia, find_room(reach), turn))\n",
          stream);
}

/* A cylinder is of facets, of which so many make its area that of the circle. */
static void write_yade_vessel(FILE *stream, const ms_script_scene *s)
{
    fputs("O.bodies.append(wall(0, axis=2, material='matter'))\n", stream);
    if (s->is_round) {
        fputs("edges = 72\n"
              "corner = half_x * math.sqrt(2 * math.pi / edges / math.sin(2 * math.pi / edges))\n"
              "O.bodies.append(geom.facetCylinder((0, 0, top / 2), corner, top, segmentsNumber=edges, wallMask=4,\n"
              "                                   material='matter'))\n",
              stream);
    } else {
        fputs("for axis, half in ((0, half_x), (1, half_y)):\n"
              "    O.bodies.append([wall(at, axis=axis, material='matter') for at in (-half, half)])\n",
              stream);
    }
}

static const char ENGINES[] =
    "O.engines = [\n"
    "    ForceResetter(),\n"
    "    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb(), Bo1_Facet_Aabb()]),\n"
    "    InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom(), Ig2_Facet_Sphere_ScGeom()],\n"
    "                    [Ip2_FrictMat_FrictMat_MindlinPhys(en=restitution)], [Law2_ScGeom_MindlinPhys_Mindlin()]),\n"
    "    NewtonIntegrator(damping=0, gravity=(0, 0, -9.81)),\n"
    "    PyRunner(command='slow_down()', iterPeriod=tenth, firstIterRun=200 * tenth),\n"
    "]\n"
    "O.dt = step\n\n\n";

static const char MEASURES[] =
    "def measure():\n"
    "    \"\"\"Mass, kinetic and total energy, height, highest point, packing fraction.\"\"\"\n"
    "    states = [O.bodies[clump].state for clump in clumps]\n"
    "    mass = sum(state.mass for state in states)\n"
    "    weight = 9.81 * sum(state.mass * state.pos[2] for state in states)\n"
    "    height = 2 * weight / 9.81 / mass\n"
    "    highest = within = 0\n"
    "    for clump in clumps:\n"
    "        spheres = [b for b in (O.bodies[i] for i in O.bodies[clump].shape.members) if b.mask]\n"
    "        highest = max([highest] + [b.state.pos[2] + b.shape.radius for b in spheres])\n"
    "        inner = [b for b in spheres if height / 4 < b.state.pos[2] < 3 * height / 4]\n"
    "        share = sum(b.shape.radius ** 3 for b in inner) / sum(b.shape.radius ** 3 for b in spheres)\n"
    "        within += O.bodies[clump].state.mass / density * share\n"
    "    kinetic = kineticEnergy()\n"
    "    return mass, kinetic, kinetic + weight, height, highest, within / (area * height / 2)\n\n\n";

static const char DRAG[] =
    "def slow_down():\n"
    "    \"\"\"The drag, a hundredth of all that moves.\"\"\"\n"
    "    for body in [O.bodies[clump].state for clump in clumps]:\n"
    "        body.vel, body.angVel, body.angMom = body.vel * 0.99, body.angVel * 0.99, body.angMom * 0.99\n\n\n";

/* Each O.run waits some hundredths of a second for its end. */
static const char REST[] = "# They fall, and come to rest within a hundred times the time of the fall.\n"
                           "print('step', 'mass', 'kinetic', 'total', 'height', 'highest', 'fraction')\n"
                           "state = 'not at rest'\n"
                           "for parts in range(1000):\n"
                           "    O.run(10 * tenth, True)\n"
                           "    print(O.iter, *measure())\n"
                           "    if parts >= 20 and kineticEnergy() < least:\n"
                           "        state = 'at rest'\n"
                           "        break\n\n"
                           "ids = [i for clump in clumps for i in O.bodies[clump].shape.members if O.bodies[i].mask]\n"
                           "with open('scene.yade.dump', 'w') as dump:\n"
                           "    print('# id clump x y z radius', file=dump)\n"
                           "    for i in ids:\n"
                           "        b = O.bodies[i]\n"
                           "        print(i, b.clumpId, *b.state.pos, b.shape.radius, file=dump)\n"
                           "export.VTKExporter('scene.yade').exportSpheres(ids=ids)\n\n";

static void write_yade_results(FILE *stream, const ms_script_scene *s)
{
    ms_number low;
    fputs("mass, kinetic, total, height, highest, fraction = measure()\n", stream);
    fprintf(stream, "kept = sum(O.bodies[clump].state.pos[2] > -%s for clump in clumps)\n",
            ms_script_number(s->reach, &low));
    fprintf(stream,
            "print('scene: %%s, kinetic energy of a particle %%g m g d' %% (state, kinetic / least * 1e-6))\n"
            "print('scene: particles %%d of %.0f' %% kept)\n"
            "print('scene: mass %%.15g kg' %% mass)\n"
            "print('scene: height %%g m, highest point %%g m' %% (height, highest))\n"
            "print('scene: packing fraction %%g' %% fraction)\n"
            "print('scene: energy %%.15g J, of which kinetic %%g J' %% (total, kinetic))\n",
            s->particles);
}

ms_status ms_yade_scene(FILE *stream, const ms_packing *scene, const char *name, ms_error *err)
{
    const ms_script_scene s = ms_script_scene_of(scene, 0);
    ms_number area;
    (void)err;
    ms_script_scene_title(stream, &s, scene, name, "yade -x -n", ".py");
    write_yade_settings(stream, &s);
    ms_yade_particle(stream);
    write_yade_kinds(stream, scene);
    write_yade_column(stream, &s);
    write_yade_vessel(stream, &s);
    fprintf(stream, "area = %s  # of the floor\n", ms_script_number(ms_script_scene_area(&s), &area));
    fputs(ENGINES, stream);
    fputs(DRAG, stream);
    fputs(MEASURES, stream);
    fputs(REST, stream);
    write_yade_results(stream, &s);
    return MS_OK;
}
