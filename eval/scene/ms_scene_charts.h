/** Charts of a scene: how good the templates of each shape are by number of spheres, and which was chosen. */
#ifndef MS_SCENE_CHARTS_H
#define MS_SCENE_CHARTS_H

#include "cli/ms_files.h"
#include "ms_scene.h"

/**
 * Draws FOLDER/NUMBER-SHAPE-MEASURE.svg and .png with data and script beside them, numbered as in the manifest: D of
 * the templates of a shape by number of spheres, or the measure whose tolerance is asked for, and that tolerance. Those
 * that a run before left there are removed.
 *
 * @param scene  after ms_scene_choose
 * @param folder is made if it is not there
 * @param words  where it says what it drew
 * @return MS_OK; as ms_files_make_folder, ms_files_remove, ms_chart_make: without gnuplot all scripts are written
 */
ms_status ms_scene_charts_draw(const ms_scene *scene, const ms_goal *goal, const char *folder, FILE *words,
                               ms_error *err);

/** Adds the files of these charts. @return MS_OK; MS_ERR_NOMEM */
ms_status ms_scene_charts_list(ms_files *files, const char *folder, const ms_manifest_row *row, size_t number,
                               const ms_goal *goal, ms_error *err);

#endif
