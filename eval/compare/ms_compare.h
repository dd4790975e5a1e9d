/** The rows of `mskit compare`: one for each shape, resolution, method and number of spheres. */
#ifndef MS_COMPARE_H
#define MS_COMPARE_H

#include <jansson.h>

#include "chart/ms_csv.h"
#include "measure/ms_measure.h"

/* The columns. Those before MS_COLUMN_SPHERES say what was asked for, the others what it gave: the measures, as their
 * table has them (ms_measure.h), between these two lists. */
/* clang-format off */
#define MS_COLUMN_LIST_BEFORE(X) \
    X(SHAPE, "shape") \
    X(CHECKSUM, "checksum") \
    X(LABEL, "label") \
    X(GENERATOR, "generator") \
    X(OPTIONS, "options") \
    X(SEED, "seed") \
    X(CELLS, "cells") \
    X(ASKED, "n_asked") \
    X(FLAGS, "flags") \
    X(SPHERES, "n") \
    X(STOPPED, "stopped_by")
#define MS_COLUMN_LIST_BEHIND(X) \
    X(EXPECTED, "expected") \
    X(CORRECTED, "inertia_corrected") \
    X(EPSILON, "epsilon") \
    X(PRODUCTS, "products_epsilon") \
    X(CENTRE, "centre_epsilon") \
    X(VOXEL, "voxel_size") \
    X(READ, "seconds_read") \
    X(VOXELIZE, "seconds_voxelize") \
    X(DISTANCE, "seconds_distance") \
    X(DESCRIBE, "seconds_describe") \
    X(GENERATE, "seconds_generate") \
    X(FASTEST, "seconds_least") \
    X(SLOWEST, "seconds_most") \
    X(SCORE, "seconds_score") \
    X(CORRECT, "seconds_correct") \
    X(REPEATS, "repeats") \
    X(MEMORY, "peak_memory_kb") \
    X(MACHINE, "machine") \
    X(THREADS, "threads") \
    X(BESIDE, "beside") \
    X(VERSION, "version") \
    X(CAUSE, "cause")
/* clang-format on */

#define MS_COLUMN_ENUM(code, name) MS_COLUMN_##code,
typedef enum ms_column {
    MS_COLUMN_LIST_BEFORE(MS_COLUMN_ENUM) /* MS_COLUMN_SHAPE, ... */
    MS_COLUMN_MEASURES,                   /* that of the first measure */
    MS_COLUMN_DICE = MS_COLUMN_MEASURES + MS_MEASURE_DICE,
    MS_COLUMN_WORK = MS_COLUMN_MEASURES + MS_MEASURE_WORK,
    MS_COLUMN_LAST_MEASURE = MS_COLUMN_MEASURES + MS_MEASURES - 1,
    MS_COLUMN_LIST_BEHIND(MS_COLUMN_ENUM) /* MS_COLUMN_CORRECTED, ... */
    MS_COLUMNS
} ms_column;
#undef MS_COLUMN_ENUM

/** One row. A field is its text; without one, its number; empty if that is not finite. */
typedef struct ms_compare_row {
    const char *text[MS_COLUMNS]; /* borrowed */
    double number[MS_COLUMNS];
} ms_compare_row;

/** The name of a column, of ms_column. */
const char *ms_compare_column(int column);

/** All fields empty. */
ms_compare_row ms_compare_empty(void);

/** The line of column names; the caller frees it; NULL without memory. */
char *ms_compare_header(void);

/** The row as a line of CSV; the caller frees it; NULL without memory. */
char *ms_compare_line(const ms_compare_row *row);

/** How its line begins: the fields of what was asked for, with the comma behind them. Likewise. */
char *ms_compare_key(const ms_compare_row *row);

/**
 * Rows of a file as a list of objects: a column is a number or text, null where it is empty.
 *
 * @param row lines as ms_compare_line makes them
 * @return the caller owns it; NULL without memory, or where a row has not these columns
 */
json_t *ms_compare_json(char *const *row, size_t count);

/** How the names of a shape's charts begin: its file without folder and ending, and the label. */
void ms_compare_name(char *out, size_t size, const char *shape, const char *label);

#endif
