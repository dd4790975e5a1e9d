/** A scene: how good the templates of each shape are, and how many spheres each gets. */
#ifndef MS_SCENE_H
#define MS_SCENE_H

#include <jansson.h>
#include <stdio.h>

#include "cli/ms_input.h"
#include "cli/ms_mass.h"
#include "cli/ms_recipe.h"
#include "ms_allocate.h"
#include "ms_sieve.h"
#include "ms_templates.h"

enum { MS_SCENE_MAX_SPHERES = 1000 };

typedef enum ms_goal_kind {
    MS_GOAL_NONE,
    MS_GOAL_TOLERANCE, /* a measure for each shape */
    MS_GOAL_MEAN,      /* mean D over the particles */
    MS_GOAL_BUDGET,    /* spheres in the scene */
    MS_GOAL_KNEE       /* of each shape: a part of D that a further sphere has to take away */
} ms_goal_kind;

/** What the templates have to reach, or may cost. */
typedef struct ms_goal {
    ms_goal_kind kind;
    double value;  /* NAN: the tolerance of each row, or the length */
    double length; /* of MS_GOAL_TOLERANCE, mean distance of the surfaces in the unit of the shapes; 0: none */
    const ms_measure *measure; /* of MS_GOAL_TOLERANCE */
} ms_goal;

/** A row of the manifest: a shape in a size. All rows of a shape share its templates, which have its own size. */
typedef struct ms_scene_shape {
    const ms_manifest_row *row; /* borrowed */
    size_t first;               /* row of the same shape */
    ms_templates templates;     /* of the shape in its own size; its first row owns them */
    json_t *input;              /* as ms_report_input_json */
    double surface;             /* area / volume of the shape in its own size, where a length is tolerated */
    double factor;              /* from its own size to that of the row; 1 without */
    ms_body body;               /* of the shape, in the size of the row */
    double tolerance;           /* to be reached: of the row, of the length, or of the goal */
    size_t chosen;              /* number of spheres, after ms_scene_choose */
    ms_clump sized;             /* the template chosen, in the size of the row; likewise */
    ms_mass mass;               /* of it, where masses were asked for (ms_scene_engines.h) */
} ms_scene_shape;

/** A zeroed struct is empty. */
typedef struct ms_scene {
    size_t count;
    ms_scene_shape *shape;
    ms_allocation sum;     /* of the templates chosen; slack of MS_GOAL_MEAN and MS_GOAL_BUDGET */
    double least_gain;     /* ms_allocate_gain */
    int has_sizes;         /* some rows have one */
    const ms_sieve *sieve; /* that they are of, for the report; borrowed; NULL: none */
    int is_searched;    /* ms_scene_is_searched: most numbers of spheres were not run, and nothing is spread evenly */
    double even_each;   /* as many spheres, the same number for each particle: one more for a part of each shape's */
    ms_allocation even; /* what that comes to */
} ms_scene;

/** How the templates are made. */
typedef struct ms_scene_run {
    const ms_recipe *recipe;
    const ms_input_flags *input;
    size_t max_spheres;
    double min_radius; /* 0: none */
} ms_scene_run;

/**
 * Makes the templates of all shapes (ms_curve_clumps), several side by side (ms_queue.h). What the goal can say of a
 * shape alone is settled as soon as its templates are known.
 *
 * @param[out] scene    the caller frees it; empty on failure
 * @param      manifest borrowed until then
 * @return MS_OK; MS_ERR_LIMIT if a shape does not reach the goal; as ms_input_read, ms_input_target, ms_generator_run
 *         and ms_curve_clumps
 */
ms_status ms_scene_make(ms_scene *scene, const ms_manifest *manifest, const ms_scene_run *run, const ms_goal *goal,
                        ms_error *err);

/** Nonzero where just those numbers of spheres are run that tell which is the least to reach a tolerance: with a method
 * whose numbers are runs of their own. Then one sphere less was run, too, and did not reach it. */
int ms_scene_is_searched(const ms_goal *goal, const ms_recipe *recipe);

/** The template chosen, in its size. */
const ms_clump *ms_scene_clump(const ms_scene_shape *shape);
const ms_score *ms_scene_score(const ms_scene_shape *shape);

/** By how much the last sphere of the template lessened D; NAN for one of a single sphere. */
double ms_scene_gain(const ms_scene_shape *shape);

/** D of its templates for the choice among shapes; borrowed from it. */
ms_share ms_scene_share(const ms_scene_shape *shape);

/** The shape with the smallest sphere. */
const ms_scene_shape *ms_scene_smallest(const ms_scene *scene);

/** What is remarked on the templates chosen (ms_templates), on standard error. */
void ms_scene_say_remarks(const ms_scene *scene);

/** The goal, a line for each shape, and what they come to. */
void ms_scene_print(FILE *stream, const ms_scene *scene, const ms_goal *goal);

/** What they come to alone. */
void ms_scene_print_sums(FILE *stream, const ms_scene *scene, const ms_goal *goal);

/** How the templates are made; the caller owns it. */
json_t *ms_scene_record_json(const ms_recipe *recipe, size_t max_spheres, double min_radius);

/** Scores of the template of a shape; the caller owns it. */
json_t *ms_scene_scores_json(const ms_scene_shape *shape);

/** Mean distance of the surfaces of template and shape in its size, 2 V D / A, where a length is tolerated. */
double ms_scene_distance(const ms_scene_shape *shape);

/** Adds what ms_scene_print says, and the curves, to an object. */
void ms_scene_add_json(json_t **json, const ms_scene *scene, const ms_goal *goal);

void ms_scene_free(ms_scene *scene);

#endif
