/** What the columns of a table of spheres are called. Private to the readers of clumps. */
#ifndef MS_COLUMNS_H
#define MS_COLUMNS_H

#include "base/ms_text.h"

enum { MS_COLUMNS_MOST = 32 }; /* that are looked at */

/** What stands behind x, y, z, r. */
typedef struct ms_columns {
    int mass;    /* the fifth column is the mass */
    int carrier; /* the seventh, behind mass and density, is 1 for a carrier, else 0 */
    int clump;   /* the fifth column, where a line has one, is the id of the sphere's clump */
} ms_columns;

/**
 * Splits a line at commas and semicolons, or at blanks where it has neither; blanks and quotation marks around a name
 * are no part of it.
 *
 * @param[out] name borrowed from the line
 * @param      mark one more character that separates, 0 for none
 * @return how many columns, MS_COLUMNS_MOST at most
 */
size_t ms_columns_split(ms_word name[MS_COLUMNS_MOST], const ms_word *line, char mark);

/** Nonzero if x, y and z, in some order, are the names of three columns in a row. */
int ms_columns_name_axes(const ms_word *name, size_t n);

/**
 * Is what the first four columns are called x, y, z, r? Names of places may be any words that do not contradict this
 * order, the fourth must be that of a radius: r, rad or radius, with or without a unit in brackets. Masses and
 * carriers have their places behind; what else stands there may be anything.
 *
 * @param      n     fewer than four say nothing
 * @param[out] cause what is wrong, without file and place
 * @return MS_OK; MS_ERR_FORMAT
 */
ms_status ms_columns_read(ms_columns *columns, const ms_word *name, size_t n, ms_error *cause);

#endif
