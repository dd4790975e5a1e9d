/** A scene for DEM engines: masses of its templates, a vessel, and a script of each engine that inserts all particles
 * and lets them come to rest. */
#ifndef MS_SCENE_ENGINES_H
#define MS_SCENE_ENGINES_H

#include "cli/ms_outputs.h"
#include "clump/formats/ms_scene_script.h"
#include "ms_scene.h"

/* clang-format off */
#define MS_SCENE_ENGINE_FLAGS \
    MS_MASS_FLAGS, \
    {"box", 0, "X,Y", "inner widths of the scripts' box, in the unit of the shapes (as wide as the bed is high)"}, \
    {"cylinder", 0, "D", "a cylinder of this inner diameter instead"}
/* clang-format on */

typedef struct ms_scene_engines {
    ms_mass_flags mass; /* density 0: no masses, and no engines */
    ms_scene_vessel vessel;
} ms_scene_engines;

/** Takes a flag if it is one of MS_SCENE_ENGINE_FLAGS. @param[out] taken 0 if it is not */
ms_status ms_scene_engines_flag(int *taken, ms_scene_engines *e, const char *name, const char *value, ms_error *err);

/** What follows from the flags together. @return MS_OK; MS_ERR_ARG */
ms_status ms_scene_engines_resolve(ms_scene_engines *e, const ms_format *const *format, size_t formats, ms_error *err);

/**
 * Gives the templates chosen their masses; nothing without density.
 *
 * @return MS_OK; as ms_mass_correct, with the shape
 */
ms_status ms_scene_engines_correct(ms_scene *scene, const ms_scene_engines *e, size_t max_voxels, ms_error *err);

/**
 * Can each format take each template, and has the vessel room for each particle, however it is turned?
 *
 * @param outputs of each shape
 * @return MS_OK; MS_ERR_ARG; as ms_template_make
 */
ms_status ms_scene_engines_check(const ms_scene *scene, const ms_scene_engines *e, const ms_outputs *outputs,
                                 ms_error *err);

/**
 * Writes the scripts of all formats that have one, and says so on `words`.
 *
 * @param outputs of each shape: its files are those of the formats, one after the other
 * @return MS_OK; MS_ERR_IO; MS_ERR_NOMEM
 */
ms_status ms_scene_engines_write(const ms_scene *scene, const ms_scene_engines *e, const ms_outputs *outputs,
                                 const char *folder, FILE *words, ms_error *err);

#endif
