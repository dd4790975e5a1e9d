/** What the scripts share that insert all particles of a scene into a box or a cylinder and let them come to rest. The
 * numbers are SI. Private to the writers of formats. */
#ifndef MS_SCRIPT_SCENE_H
#define MS_SCRIPT_SCENE_H

#include "ms_script.h"

/** All at once are inserted as a loose column above the floor, turned at random and at rest; they fall and settle. */
typedef struct ms_script_scene {
    double particles, spheres; /* in the scene; carriers are no spheres */
    double carriers;           /* in the scene */
    double mass;               /* of all */
    double density;            /* of their matter: the volume of all is mass / density */
    double reach;              /* of the largest particle around its centre of mass */
    double most, least;        /* radius of a sphere */
    double half[2];            /* width of the box along x and y, or diameter of the cylinder; halved */
    int is_round;              /* a cylinder */
    double low, top;           /* of the column: no particle reaches out of it */
    double young;              /* so that overlaps are some 2 % where particles land from its top */
    double step;               /* a tenth of the Rayleigh time of a ball of the least mass, at that modulus */
    double convention;         /* the same of the smallest sphere */
    double fall;               /* time of a fall from the top */
    double drag;               /* of each sphere, kg/s: slows every particle within the time of the fall */
    double rest;               /* J: 1e-6 m g d, summed over the particles; d of the ball of equal volume */
    int keeps_spin;            /* spheres of a particle lie nearly on one line, about which drag on them ends no spin */
} ms_script_scene;

/**
 * @param scene    not empty, with counts and masses; width 0: a box as wide as the bed is high, or eight reaches
 * @param is_alike nonzero: the engine inserts by ms_script_scene_near, so that a small particle takes more room in the
 *                 column where there are larger spheres
 */
ms_script_scene ms_script_scene_of(const ms_packing *scene, int is_alike);

/** The least distance of its spheres' centres from those of all others at which nothing in the scene overlaps it. */
double ms_script_scene_near(const ms_script_scene *s, const ms_placed *kind);

/** The head of a script, all comments: what it is, how it is started ("COMMAND NAMESUFFIX"), its particles, and what
 * stands behind its numbers. */
void ms_script_scene_title(FILE *stream, const ms_script_scene *s, const ms_packing *scene, const char *name,
                           const char *command, const char *suffix);

/** The floor's, m^2. */
double ms_script_scene_area(const ms_script_scene *s);

/** Variables of LIGGGHTS and LAMMPS that the user may set on the command line, and of the step and of the steps in a
 * tenth of the fall. @param restitution as the engine takes it, and a remark on it */
void ms_script_scene_settings(FILE *stream, const ms_script_scene *s, const char *restitution);

/** Ends a script of LIGGGHTS or LAMMPS that has inserted too few. @param atoms in the scene, as the engine counts */
void ms_script_scene_inserted(FILE *stream, double atoms);

/** Two variables of LIGGGHTS and LAMMPS: `motion`, the kinetic energy that has to end, is v_kinetic, or c_moving where
 * spin does not end; `fraction`, of packing, comes from the mass c_within and v_height. */
void ms_script_scene_measures(FILE *stream, const ms_script_scene *s);

/** How LIGGGHTS and LAMMPS say at the end what came of it: lines "scene: ...". Their scripts have the variables state,
 * mass, kinetic, motion, total, height, highest and fraction. @param atoms in the scene, as the engine counts */
void ms_script_scene_results(FILE *stream, const ms_script_scene *s, double atoms);

#endif
