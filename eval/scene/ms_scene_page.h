/** A scene as one page: its sums, a row for each shape, and the templates chosen in 3-D. */
#ifndef MS_SCENE_PAGE_H
#define MS_SCENE_PAGE_H

#include "ms_scene.h"

/** What it is made of. Everything is borrowed. */
typedef struct ms_scene_page {
    const ms_scene *scene; /* after ms_scene_choose */
    const ms_goal *goal;
    const ms_scene_run *run;
    const char *charts; /* folder of ms_scene_charts_draw; NULL: none */
    int argc;           /* the command, without the program's name */
    char *const *argv;
} ms_scene_page;

/**
 * Writes the page. Reads each shape once more.
 *
 * @return MS_OK; MS_ERR_IO; MS_ERR_NOMEM; as ms_input_read, ms_input_show, ms_view_scene_write
 */
ms_status ms_scene_page_write(const char *path, const ms_scene_page *page, ms_error *err);

#endif
