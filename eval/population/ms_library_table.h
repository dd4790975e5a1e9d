/** The grains of a table grains.csv, as few of them are chosen from. */
#ifndef MS_LIBRARY_TABLE_H
#define MS_LIBRARY_TABLE_H

#include <stddef.h>

#include "grains/ms_grain_row.h"

/* Descriptors that a library keeps, in this order; the size is one of them on request. */
#define MS_LIBRARY_DESCRIPTOR_LIST(X) \
    X(SIZE, "equivalent_diameter")    \
    X(SPHERICITY, "sphericity")       \
    X(ELONGATION, "elongation")       \
    X(FLATNESS, "flatness")           \
    X(CONVEXITY, "convexity")

#define MS_LIBRARY_ENUM(code, name) MS_LIBRARY_##code,
typedef enum ms_library_descriptor {
    MS_LIBRARY_DESCRIPTOR_LIST(MS_LIBRARY_ENUM) MS_LIBRARY_DESCRIPTORS
} ms_library_descriptor;
#undef MS_LIBRARY_ENUM

/** Names of them, as in grains.csv behind shape_ and clump_. */
extern const char *const ms_library_descriptors[MS_LIBRARY_DESCRIPTORS];

/** A grain with a clump. */
typedef struct ms_library_grain {
    ms_grain_found found;
    double spheres;
    double shape[MS_LIBRARY_DESCRIPTORS], clump[MS_LIBRARY_DESCRIPTORS];
} ms_library_grain;

/** A zeroed struct is empty. */
typedef struct ms_library_table {
    ms_library_grain *grain;
    size_t count;
    size_t without;    /* grains that have no clump */
    size_t unmeasured; /* that have one, and lack a descriptor */
} ms_library_table;

/**
 * Reads FOLDER/grains.csv.
 *
 * @param[out] table  the caller frees it; empty on failure
 * @return MS_OK; MS_ERR_IO; MS_ERR_FORMAT; MS_ERR_SHAPE for a table without one such grain; MS_ERR_NOMEM
 */
ms_status ms_library_table_read(ms_library_table *table, const char *folder, ms_error *err);

void ms_library_table_free(ms_library_table *table);

#endif
