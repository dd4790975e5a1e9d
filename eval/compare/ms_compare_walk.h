/** A comparison: every method on every shape, at every resolution, to every number of spheres. */
#ifndef MS_COMPARE_WALK_H
#define MS_COMPARE_WALK_H

#include "chart/ms_csv.h"
#include "cli/ms_files.h"
#include "cli/ms_input.h"
#include "cli/ms_methods.h"

enum { MS_NUMBERS_MAX = 256 };

/** A list of whole numbers, ascending, each once. */
typedef struct ms_numbers {
    double value[MS_NUMBERS_MAX];
    size_t count;
} ms_numbers;

/** What is compared. */
typedef struct ms_comparison {
    char **shape; /* paths */
    size_t n_shapes;
    ms_input_flags input; /* without its resolution */
    double min_radius;    /* 0: none; of generators, not of clumps */
    ms_input_text flags;  /* both as text */
    ms_methods methods;
    ms_numbers asked, cells; /* numbers of spheres; resolutions, which a volume does not take */
    char label[20];          /* as text; "" for none */
    double repeats, seed;
    FILE *words;            /* where rows are said */
    const char *charts;     /* folder, which exists; NULL for none */
    const char *population; /* the same, of tables and charts of all shapes together */
    const char *report;     /* path of the page, which takes the clumps kept beside the charts; NULL for none */
    int argc;               /* the command as it was typed, for the page: without the program's name */
    char *const *argv;
} ms_comparison;

/** Adds what is read, shapes and clumps, and the files of the charts. @return MS_OK; MS_ERR_ARG for two shapes of one
 * name, whose charts would be the same; MS_ERR_NOMEM */
ms_status ms_compare_list_files(ms_files *files, const ms_comparison *comparison, ms_error *err);

/**
 * Adds the rows of all runs, in a fixed order; those that are there already must be its first rows, and are not run
 * again. Runs go side by side (ms_queue.h), unless times are the result: with charts, or repeats. Says each row.
 * Then draws the charts, writes the tables of the population and the page, and says on stderr what it comes to.
 *
 * @param csv with ms_compare_header
 * @return MS_OK, also where some runs failed: that is in their rows; MS_ERR_SHAPE where each of the new ones did, when
 *         all else is done; MS_ERR_ARG for rows of another comparison; as
 *         ms_csv_add; of charts and tables, as ms_compare_charts, ms_compare_sheet_draw
 *         and ms_compare_population_write, when all else is done
 */
ms_status ms_compare_walk(ms_csv *csv, const ms_comparison *comparison, ms_error *err);

#endif
