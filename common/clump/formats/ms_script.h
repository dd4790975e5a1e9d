/** What the scripts share that load a template and drop particles into a box, one or as many as asked for: a start for
 * the user's own, run by the tests of the engines. Private to the writers of formats. */
#ifndef MS_SCRIPT_H
#define MS_SCRIPT_H

#include "base/ms_text.h"
#include "clump/ms_packing.h"
#include "ms_write.h"

#define MS_SCRIPT_GRAVITY 9.81

/** A modulus stiff enough for what weighs on a particle below that height. */
double ms_script_young(double height, double density);

/** A tenth of the Rayleigh time of a sphere of that radius. */
double ms_script_step(double radius, double density, double young);

/** Of the ball of that mass. */
double ms_script_radius(double mass, double density);

/** A drop that suits the size of the particle, whatever that is; the scripts have a restitution of 0.5. */
typedef struct ms_script_drop {
    double reach; /* of the particle around its centre of mass */
    double young; /* stiff enough for overlaps of a per mille of its size, and what LIGGGHTS demands */
    double step;  /* a tenth of the Rayleigh time of the smallest sphere */
    double one;   /* largest stable step of a body that a contact presses by a thousandth of the reach, */
    double all;   /* and that as many contacts as it has spheres press so (ms_stable.h) */
    double end;   /* time for one particle to fall and come to rest; n of them get sqrt(1 + n/4) times that */
    double side;  /* half the width of the box */
} ms_script_drop;

ms_script_drop ms_script_drop_of(const ms_content *content);

/** That of the largest particle, with a step that the lightest bears. @param mixture not empty, with masses */
ms_script_drop ms_script_drop_of_mixture(const ms_packing *mixture);

/** The first line, a comment: "Drops NAME into a box: COMMAND NAME", the suffix of the script, and what drops fifty. */
void ms_script_title(FILE *stream, const char *name, const char *command, const char *suffix, const char *fifty);

/** Likewise of a mixture: "Drops particles of the mixture NAME into a box: ...; five hundred of them: ...". */
void ms_script_mixture_title(FILE *stream, const char *name, const char *command, const char *suffix, const char *more);

/** A comment: which steps the body would bear. */
void ms_script_drop_steps(FILE *stream, const ms_script_drop *drop);

/** The end of a drop in LIGGGHTS and LAMMPS: its steps, by the number n of particles, and their run. */
void ms_script_drop_run(FILE *stream, const ms_script_drop *drop);

/** How a packing comes to rest in the box around it: first the clumps that overlap come apart, without weight and
 * slowed down, then they settle under gravity. What swings in a contact is the mass of the bodies, not that of spheres,
 * and no sphere makes a stiffer contact than a ball as large as its body: the step is that of the lightest body as a
 * ball. A tenth of its Rayleigh time leaves room for some ten pairs of spheres in one contact. */
typedef struct ms_script_settle {
    double lo[3], hi[3]; /* box around the spheres */
    double reach;        /* of the largest clump around its centre of mass */
    double least;        /* radius */
    double young;        /* stiff enough for overlaps of a per mille under the height of the packing */
    double step;         /* a tenth of the Rayleigh time of a ball of the least mass */
    double drag;         /* of each sphere, kg/s: slows the lightest body down within 5 steps */
    double loosen, end;  /* steps of both stages */
} ms_script_settle;

/** @param packing not empty, with masses */
ms_script_settle ms_script_settle_of(const ms_packing *packing);

/** The first line of the script, a comment. */
void ms_script_settle_title(FILE *stream, const char *name, const char *command, const char *suffix);

/** Ends of its domain along an axis: a reach around the box, above it a height more. */
void ms_script_settle_domain(double *lo, double *hi, const ms_script_settle *settle, int axis);

/** The number as text, which stands in `room`. */
const char *ms_script_number(double value, ms_number *room);

#endif
