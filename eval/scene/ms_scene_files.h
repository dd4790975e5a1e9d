/** The files of a scene: their names, and whether they can be written. */
#ifndef MS_SCENE_FILES_H
#define MS_SCENE_FILES_H

#include "cli/ms_outputs.h"
#include "ms_scene.h"

enum { MS_SCENE_FILES_READ = 3 };

/** What the command says of them. Everything is borrowed. */
typedef struct ms_scene_files {
    const char *read[MS_SCENE_FILES_READ]; /* beside the shapes; NULL: not given */
    const char *folder;                    /* of templates and scripts; NULL: none are written */
    const ms_format *const *format;
    size_t n_formats;
    const char *charts;  /* folder; NULL: none are drawn */
    const char *report;  /* a page; NULL: none */
    const ms_goal *goal; /* that the charts are of */
} ms_scene_files;

/**
 * Names the files of each template: FOLDER/NAME.ENDING, where NAME is that of the shape without folder and ending, and
 * behind it its size, if it has one, as NAME-0.5.
 *
 * @param[out] outputs of each row, zeroed before
 * @return MS_OK; MS_ERR_ARG for two of one name; MS_ERR_NOMEM
 */
ms_status ms_scene_files_plan(ms_outputs *outputs, const ms_scene_files *asked, const ms_manifest *manifest,
                              ms_error *err);

/** Holds them against what is read, and tries them. @return as ms_outputs_list and ms_files_check */
ms_status ms_scene_files_check(const ms_outputs *outputs, const ms_scene_files *asked, const ms_manifest *manifest,
                               ms_error *err);

#endif
