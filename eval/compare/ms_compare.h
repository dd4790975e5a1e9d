/** The rows of `mskit compare`: one for each shape, resolution, method and number of spheres. */
#ifndef MS_COMPARE_H
#define MS_COMPARE_H

#include "chart/ms_csv.h"

/* The one list of columns. Those before MS_COLUMN_SPHERES say what was asked for, the others what it gave. */
#define MS_COLUMN_LIST(X)                                                                                         \
    X(SHAPE, "shape")                                                                                             \
    X(CHECKSUM, "checksum")                                                                                       \
    X(LABEL, "label")                                                                                             \
    X(GENERATOR, "generator") X(OPTIONS, "options") X(SEED, "seed") X(CELLS, "cells") X(ASKED, "n_asked")         \
        X(SPHERES, "n") X(STOPPED, "stopped_by") X(ETA, "eta") X(DICE, "dice") X(COVERAGE, "coverage")            \
            X(OVERSHOOT, "overshoot") X(OFF_VOLUME, "off_volume") X(PROTRUSION, "protrusion_max")                 \
                X(PROTRUSION_RMS, "protrusion_rms") X(GAP, "gap_max") X(GAP_RMS, "gap_rms")                       \
                    X(RADIUS, "smallest_radius_ratio") X(PIECES, "pieces") X(INERTIA, "inertia_union")            \
                        X(CORRECTED, "inertia_corrected") X(EPSILON, "epsilon") X(PRODUCTS, "products_epsilon")   \
                            X(VOXEL, "voxel_size") X(READ, "seconds_read") X(VOXELIZE, "seconds_voxelize")        \
                                X(DISTANCE, "seconds_distance") X(GENERATE, "seconds_generate")                   \
                                    X(SCORE, "seconds_score") X(CORRECT, "seconds_correct") X(REPEATS, "repeats") \
                                        X(MEMORY, "peak_memory_kb") X(THREADS, "threads") X(VERSION, "version")   \
                                            X(CAUSE, "cause")

#define MS_COLUMN_ENUM(code, name) MS_COLUMN_##code,
typedef enum ms_column { MS_COLUMN_LIST(MS_COLUMN_ENUM) MS_COLUMNS } ms_column;
#undef MS_COLUMN_ENUM

/** One row. A field is its text; without one, its number; empty if that is not finite. */
typedef struct ms_compare_row {
    const char *text[MS_COLUMNS]; /* borrowed */
    double number[MS_COLUMNS];
} ms_compare_row;

/** All fields empty. */
ms_compare_row ms_compare_empty(void);

/** The line of column names; the caller frees it; NULL without memory. */
char *ms_compare_header(void);

/** The row as a line of CSV; the caller frees it; NULL without memory. */
char *ms_compare_line(const ms_compare_row *row);

/** How its line begins: the fields of what was asked for, with the comma behind them. Likewise. */
char *ms_compare_key(const ms_compare_row *row);

/** How the names of a shape's charts begin: its file without folder and ending, and the label. */
void ms_compare_name(char *out, size_t size, const char *shape, const char *label);

#endif
