/* LAMMPS: a script that lets the particles of a scene come to rest. */
#include "ms_formats.h"
#include "ms_lammps.h"
#include "ms_script_scene.h"

static void write_lammps_box(FILE *stream, const ms_script_scene *s)
{
    const double inner[] = {s->half[0] - s->reach, s->half[1] - s->reach};
    ms_number x, y, low, top;
    fputs("units si\natom_style sphere\natom_modify map array\nboundary f f f\nnewton off\n", stream);
    fprintf(stream, "region box block -%s %s -%s %s -%s %s\ncreate_box %d box\n",
            ms_script_number(s->half[0] + s->reach, &x), x.text, ms_script_number(s->half[1] + s->reach, &y), y.text,
            ms_script_number(s->reach, &low), ms_script_number(s->top + s->reach, &top), s->carriers > 0 ? 2 : 1);
    ms_script_number(s->low + s->reach, &low);
    ms_script_number(s->top - s->reach, &top);
    ms_script_number(inner[0], &x);
    ms_script_number(inner[1], &y);
    if (s->is_round) {
        fprintf(stream, "region column cylinder z 0 0 %s %s %s\n", x.text, low.text, top.text);
    } else {
        fprintf(stream, "region column block -%s %s -%s %s %s %s\n", x.text, x.text, y.text, y.text, low.text,
                top.text);
    }
    fprintf(stream, "comm_modify vel yes cutoff %s\n", ms_script_number(2 * s->reach, &x));
    fprintf(stream, "neighbor %s bin\n", ms_script_number(0.2 * s->reach, &x));
    fputs("fix molecules all property/atom mol ghost yes\nneigh_modify delay 0 exclude molecule/intra all\n", stream);
    if (s->carriers > 0) {
        ms_lammps_exclude_carriers(stream);
    }
}

static void write_lammps_matter(FILE *stream)
{
    fputs("variable contact string \"hertz/material ${young} ${restitution} ${poisson} tangential mindlin NULL 1.0 "
          "${friction} damping tsuji\"\n"
          "pair_style granular\npair_coeff * * ${contact}\ntimestep ${step}\n\n",
          stream);
}

/* Without weight nothing moves until all are there. Walls come later: a second run would change their damping. */
static void write_lammps_particles(FILE *stream, const ms_packing *scene, const ms_script_scene *s)
{
    ms_number near;
    size_t most = 0;
    ms_lammps_molecules(stream, scene);
    fputs("\nfix gravity all gravity 0 vector 0 0 -1 disable\n"
          "fix move all rigid/small molecule mol clump reinit no gravity gravity\n",
          stream);
    for (size_t k = 0; k < scene->count; k++) {
        most = scene->placed[k].count > most ? scene->placed[k].count : most;
        fprintf(stream, "fix insert%zu all deposit %zu 0 1 %zu region column mol clump molfrac", k,
                scene->placed[k].count, 32452843 + k);
        for (size_t other = 0; other < scene->count; other++) {
            fputs(other == k ? " 1" : " 0", stream);
        }
        fprintf(stream, " rigid move near %s attempt 1000\n",
                ms_script_number(ms_script_scene_near(s, &scene->placed[k]), &near));
    }
    fprintf(stream, "thermo_style custom step atoms\nthermo_modify lost error\nrun %zu\n", 2 * most + 100);
    for (size_t k = 0; k < scene->count; k++) {
        fprintf(stream, "unfix insert%zu\n", k);
    }
    ms_script_scene_inserted(stream, s->spheres + s->carriers);
}

static void write_lammps_vessel(FILE *stream, const ms_script_scene *s)
{
    ms_number a;
    fputs("# They fall.\nfix floor all wall/gran granular ${contact} zplane 0 NULL\n", stream);
    for (int k = 0; k < 2 && !s->is_round; k++) {
        fprintf(stream, "fix %s all wall/gran granular ${contact} %cplane -%s %s\n", k ? "south_north" : "west_east",
                "xy"[k], ms_script_number(s->half[k], &a), a.text);
    }
    if (s->is_round) {
        fprintf(stream, "fix side all wall/gran granular ${contact} zcylinder %s\n", ms_script_number(s->half[0], &a));
    }
    fputs("fix gravity all gravity 9.81 vector 0 0 -1 disable\n\n", stream);
}

static const char MEASURES[] = "compute sphere all property/atom radius\n"
                               "compute bodies all rigid/local move mass\n"
                               "compute mass all reduce sum c_bodies\n"
                               "compute moving all ke/rigid move\n"
                               "compute turning all erotate/rigid move\n"
                               "variable mass equal c_mass\n"
                               "variable kinetic equal c_moving+c_turning\n"
                               "variable total equal v_kinetic+9.81*mass(all)*xcm(all,z)\n"
                               "variable height equal 2*xcm(all,z)\n"
                               "variable high atom z+c_sphere\n"
                               "compute high all reduce max v_high\n"
                               "variable highest equal c_high\n"
                               "variable within atom mass*(z>0.25*v_height)*(z<0.75*v_height)\n"
                               "compute within all reduce sum v_within\n";

static void write_lammps_measures(FILE *stream, const ms_script_scene *s)
{
    fputs(MEASURES, stream);
    ms_script_scene_measures(stream, s);
    fputs("thermo_style custom step atoms v_mass v_kinetic v_total v_height v_highest v_fraction\nthermo ${part}\n"
          "thermo_modify lost error\n\n",
          stream);
}

/* One run: a second one would change the damping of the walls. */
static void write_lammps_rest(FILE *stream, const ms_script_scene *s)
{
    ms_number drag, rest;
    fprintf(
        stream,
        "# They fall, and come to rest within a hundred times the time of the fall. The drag begins within the run.\n"
        "variable landed equal step+20*v_part\nvariable landed equal ${landed}\n"
        "variable drag equal -%s*(step>v_landed)\n",
        ms_script_number(s->drag, &drag));
    for (int axis = 0; axis < 3; axis++) {
        fprintf(stream, "variable drag_%c atom v_drag*v%c\n", "xyz"[axis], "xyz"[axis]);
    }
    fprintf(stream,
            "fix drag all addforce v_drag_x v_drag_y v_drag_z\n"
            "variable end equal 1000*v_part\nvariable moves equal \"v_motion > %s || step < v_landed\"\n"
            "fix rest all halt ${part} v_moves < 0.5 error continue\nrun ${end}\nunfix rest\nrun 0\n",
            ms_script_number(s->rest, &rest));
    fputs("variable state string \"at rest\"\nif \"${moves} > 0.5\" then \"variable state string 'not at rest'\"\n\n"
          "write_dump all custom scene.lammps.dump id mol type x y z radius modify sort id\n",
          stream);
}

/* No style of dump is VTK's; a dump without header is a table of numbers. */
static void write_lammps_picture(FILE *stream)
{
    static const char *const HEAD[] = {"# vtk DataFile Version 3.0", "scene", "ASCII", "DATASET POLYDATA",
                                       "POINTS ${spheres} double"};
    fputs("variable spheres equal atoms\n", stream);
    for (int line = 0; line < 5; line++) {
        fprintf(stream, "print \"%s\" %s scene.lammps.vtk screen no\n", HEAD[line], line ? "append" : "file");
    }
    fputs("write_dump all custom scene.lammps.vtk x y z modify header no append yes sort id\n"
          "print \"POINT_DATA ${spheres}\" append scene.lammps.vtk screen no\n"
          "print \"SCALARS radius double 1\" append scene.lammps.vtk screen no\n"
          "print \"LOOKUP_TABLE default\" append scene.lammps.vtk screen no\n"
          "write_dump all custom scene.lammps.vtk radius modify header no append yes sort id\n",
          stream);
}

ms_status ms_lammps_scene(FILE *stream, const ms_packing *scene, const char *name, ms_error *err)
{
    const ms_script_scene s = ms_script_scene_of(scene, 1);
    (void)err;
    ms_script_scene_title(stream, &s, scene, name, "lmp -in", ".in");
    /* through a polynomial (docs/templates.md) */
    ms_script_scene_settings(stream, &s, "0.3667 # makes 0.5: docs/templates.md of mskit says how");
    write_lammps_box(stream, &s);
    write_lammps_matter(stream);
    write_lammps_particles(stream, scene, &s);
    write_lammps_vessel(stream, &s);
    write_lammps_measures(stream, &s);
    write_lammps_rest(stream, &s);
    write_lammps_picture(stream);
    ms_script_scene_results(stream, &s, s.spheres + s.carriers);
    return MS_OK;
}
