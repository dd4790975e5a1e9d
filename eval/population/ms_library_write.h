/** The files of a library. */
#ifndef MS_LIBRARY_WRITE_H
#define MS_LIBRARY_WRITE_H

#include "ms_library.h"

/** Rows of a scene.csv: what a manifest of `scene` may have. */
enum { MS_LIBRARY_MAX_ROWS = 1000 };

/** What was written, beside library.csv and the charts. */
typedef struct ms_library_written {
    char scripts[256]; /* names of the engines' scripts, with commas; "" if there are none */
    int scene;         /* scene.csv: all grains are meshes, which are there, and it has not too many rows */
    int charts;        /* nonzero: gnuplot drew them */
    ms_error why_not;  /* of charts that were not drawn */
} ms_library_written;

/**
 * Writes into FOLDER, which is there: library.csv, a row for each grain of the choice; sizes.csv, where size goes by
 * classes; scene.csv, a manifest for `scene`, if all are meshes; the templates, and for each engine of which all have
 * one a script that inserts the mixture; charts of the distributions.
 *
 * @param from folder of the table
 * @return MS_OK; MS_ERR_ARG for a template whose name no script can hold; MS_ERR_IO; MS_ERR_FORMAT; MS_ERR_NOMEM
 */
ms_status ms_library_write(ms_library_written *written, const ms_library *library, const char *from, const char *folder,
                           ms_error *err);

#endif
