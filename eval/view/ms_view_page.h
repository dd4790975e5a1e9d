/** Pages of HTML that need no other file and no network, and allow none: their content security policy names the hashes
 * of their own script and style. */
#ifndef MS_VIEW_PAGE_H
#define MS_VIEW_PAGE_H

#include <stdio.h>

#include "measure/ms_metrics.h"

/** The start of a page, up to its heading. @param title text from outside */
void ms_view_page_begin(FILE *stream, const char *title);

/** The viewer itself; once on a page. */
void ms_view_page_viewer(FILE *stream);

/** All measures that apply, a row each. */
void ms_view_page_measures(FILE *stream, const ms_metrics *metrics);

/** The words of a command as a line for a shell. @param argv without the program's name @return MS_OK; MS_ERR_NOMEM */
ms_status ms_view_page_command(FILE *stream, int argc, char *const *argv, ms_error *err);

/** Lines as they are. @param text from outside; cut apart */
void ms_view_page_text(FILE *stream, char *text);

/** A JSON object as text, laid out for reading. @return MS_OK; MS_ERR_NOMEM */
ms_status ms_view_page_record(FILE *stream, const char *json, ms_error *err);

/** Around the scenes (ms_view_scene.h), with commas between; then the page is over. */
void ms_view_page_begin_scenes(FILE *stream);
void ms_view_page_end(FILE *stream);

#endif
