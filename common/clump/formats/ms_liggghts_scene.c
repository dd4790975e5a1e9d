/* LIGGGHTS: a script that lets the particles of a scene come to rest. */
#include <math.h>

#include "ms_fields.h"
#include "ms_formats.h"
#include "ms_liggghts.h"
#include "ms_script_scene.h"

static void write_liggghts_box(FILE *stream, const ms_script_scene *s)
{
    ms_number x, y, low, top;
    fputs(ms_liggghts_style, stream);
    fprintf(stream, "region box block -%s %s -%s %s -%s %s units box\ncreate_box 1 box\n",
            ms_script_number(s->half[0] + s->reach, &x), x.text, ms_script_number(s->half[1] + s->reach, &y), y.text,
            ms_script_number(s->reach, &low), ms_script_number(s->top + s->reach, &top));
    ms_script_number(s->low, &low);
    ms_script_number(s->top, &top);
    ms_script_number(s->half[0], &x);
    ms_script_number(s->half[1], &y);
    if (s->is_round) {
        fprintf(stream, "region column cylinder z 0 0 %s %s %s", x.text, low.text, top.text);
    } else {
        fprintf(stream, "region column block -%s %s -%s %s %s %s", x.text, x.text, y.text, y.text, low.text, top.text);
    }
    fprintf(stream, " volume_limit 1e-300 units box\nneighbor %s bin\nneigh_modify delay 0\n\n",
            ms_script_number(0.2 * s->reach, &x));
}

static void write_liggghts_matter(FILE *stream, const ms_script_scene *s)
{
    ms_number a;
    fputs("soft_particles yes # below 5e6\nhard_particles yes # above 1e9\n"
          "fix young all property/global youngsModulus peratomtype ${young}\n"
          "fix poisson all property/global poissonsRatio peratomtype ${poisson}\n"
          "fix restitution all property/global coefficientRestitution peratomtypepair 1 ${restitution}\n"
          "fix friction all property/global coefficientFriction peratomtypepair 1 ${friction}\n"
          "variable law string \"model hertz tangential history\"\npair_style gran ${law}\npair_coeff * *\n"
          "fix floor all wall/gran ${law} primitive type 1 zplane 0\n",
          stream);
    if (s->is_round) {
        fprintf(stream, "fix side all wall/gran ${law} primitive type 1 zcylinder %s 0 0\n",
                ms_script_number(s->half[0], &a));
    }
    for (int wall = 0; wall < 4 && !s->is_round; wall++) {
        static const char *const WALLS[] = {"west", "east", "south", "north"};
        fprintf(stream, "fix %s all wall/gran ${law} primitive type 1 %cplane %s%s\n", WALLS[wall], "xxyy"[wall],
                wall % 2 ? "" : "-", ms_script_number(s->half[wall / 2], &a));
    }
    fputs("timestep ${step}\nfix gravity all gravity 9.81 vector 0 0 -1\n\n", stream);
}

/* fix insert/pack fills up to a number in its region: those of the kinds before are counted in. */
static void write_liggghts_particles(FILE *stream, const ms_packing *scene)
{
    unsigned seed = 1000000;
    size_t so_far = 0;
    fputs("# A template of each kind; particles_in_region counts the kinds before in.\n", stream);
    for (size_t k = 0; k < scene->count; k++) {
        seed = ms_liggghts_seed(seed);
        ms_liggghts_template(stream, &scene->placed[k], k + 1, seed);
    }
    for (size_t k = 1; k <= scene->count; k++) {
        const unsigned first = seed = ms_liggghts_seed(seed);
        seed = ms_liggghts_seed(seed);
        so_far += scene->placed[k - 1].count;
        fprintf(stream,
                "fix d%zu all particledistribution/discrete %u 1 t%zu 1.0\n"
                "fix i%zu all insert/pack seed %u distributiontemplate d%zu insert_every once overlapcheck yes "
                "orientation random all_in yes particles_in_region %zu region column\n",
                k, first, k, k, seed, k, so_far);
    }
    fputs("fix move all multisphere\n\n", stream);
}

/* LIGGGHTS knows the mass of a body at each of its spheres: here each has the part of it that goes with its volume.
 * Spheres are numbered kind by kind. */
static void write_liggghts_shares(FILE *stream, const ms_packing *scene)
{
    double last = 0;
    for (size_t k = 0; k < scene->count; k++) {
        const ms_placed *kind = &scene->placed[k];
        ms_number per_cube;
        ms_script_number(1 / (pow(kind->scale, 3) * ms_liggghts_cubes(&kind->clump)), &per_cube);
        if (k == 0) {
            fprintf(stream, "variable share1 atom %s\n", per_cube.text);
        } else {
            fprintf(stream, "variable share%zu atom \"v_share%zu*(id<=%.0f)+%s*(id>%.0f)\"\n", k + 1, k, last,
                    per_cube.text, last);
        }
        last += (double)(kind->count * ms_liggghts_spheres(&kind->clump));
    }
    fprintf(stream, "variable own atom \"c_sphere[2]*c_sphere[1]^3*v_share%zu\"\n", scene->count);
}

static const char MEASURES[] =
    "variable moment atom v_own*z\n"
    "variable high atom z+c_sphere[1]\n"
    "compute sums all reduce sum v_own v_moment\n"
    "compute high all reduce max v_high\n"
    "compute moving all ke/multisphere # the plain ke and erotate are wrong for multispheres\n"
    "compute turning all erotate/multisphere\n"
    "variable mass equal c_sums[1]\n"
    "variable highest equal c_high\n"
    "variable kinetic equal c_moving+c_turning\n"
    "variable weight equal 9.81*c_sums[2] # by spheres: LIGGGHTS sums no centres of mass by mass\n"
    "variable total equal v_kinetic+v_weight\n"
    "variable height equal 2*c_sums[2]/c_sums[1]\n"
    "variable within atom v_own*(z>0.25*v_height)*(z<0.75*v_height)\n"
    "compute within all reduce sum v_within\n";

/* As LIGGGHTS counts. */
static double count_atoms(const ms_packing *scene)
{
    double atoms = 0;
    for (size_t k = 0; k < scene->count; k++) {
        atoms += (double)(scene->placed[k].count * ms_liggghts_spheres(&scene->placed[k].clump));
    }
    return atoms;
}

/* After the first step, when there are particles: before, sums over them are 0. */
static void write_liggghts_measures(FILE *stream, const ms_packing *scene, const ms_script_scene *s)
{
    fputs("run 1\n", stream);
    ms_script_scene_inserted(stream, count_atoms(scene));
    fputs("compute sphere all property/atom radius mass\n", stream);
    write_liggghts_shares(stream, scene);
    fputs(MEASURES, stream);
    ms_script_scene_measures(stream, s);
    fputs("thermo_style custom step atoms v_mass v_kinetic v_total v_height c_high v_fraction\n"
          "thermo ${part}\nthermo_modify lost error\n\n",
          stream);
}

static void write_liggghts_rest(FILE *stream, const ms_script_scene *s)
{
    ms_number drag, rest;
    fprintf(stream,
            "# They fall, and come to rest within a hundred times the time of the fall.\n"
            "variable fall equal 20*v_part\nrun ${fall}\nfix drag all viscous %s\n",
            ms_script_number(s->drag, &drag));
    fprintf(stream,
            "variable more loop 1000\nvariable state string \"not at rest\"\n"
            "label more\nrun ${part}\nvariable now equal ${motion}\n"
            "if \"${now} < %s\" then \"variable state string 'at rest'\" \"jump SELF end\"\nnext more\njump SELF more\n"
            "label end\n\n",
            ms_script_number(s->rest, &rest));
    fputs("run 0\nwrite_dump all custom scene.liggghts.dump id type x y z radius modify sort id\n", stream);
}

/* Last, since a LIGGGHTS that was built without VTK ends here. */
static void write_liggghts_pictures(FILE *stream)
{
    fputs("\n# Takes a LIGGGHTS built with VTK, as packages are.\n"
          "dump pictures all custom/vtk 1 scene.liggghts_*.vtk id type x y z radius\nrun 0\n",
          stream);
}

ms_status ms_liggghts_scene(FILE *stream, const ms_packing *scene, const char *name, ms_error *err)
{
    const ms_script_scene s = ms_script_scene_of(scene, 0);
    (void)err;
    ms_script_scene_title(stream, &s, scene, name, "liggghts -in", ".in");
    ms_script_scene_settings(stream, &s, "0.5");
    write_liggghts_box(stream, &s);
    write_liggghts_matter(stream, &s);
    write_liggghts_particles(stream, scene);
    write_liggghts_measures(stream, scene, &s);
    write_liggghts_rest(stream, &s);
    ms_script_scene_results(stream, &s, count_atoms(scene));
    write_liggghts_pictures(stream);
    return MS_OK;
}
