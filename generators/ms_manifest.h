/** What a scene is made of: a CSV file of shapes, how many there are of each, and in which size. */
#ifndef MS_MANIFEST_H
#define MS_MANIFEST_H

#include <stddef.h>
#include <stdint.h>

#include "base/ms_error.h"

MS_C_BEGIN

enum { MS_MANIFEST_MAX_SHAPES = 1000, MS_MANIFEST_MAX_PARTICLES = 1000000000 };

/* Of sizes, so that their fifth powers are numbers. */
#define MS_MANIFEST_LEAST_SIZE 1e-50
#define MS_MANIFEST_MOST_SIZE 1e50

/** One kind of particle. */
typedef struct ms_manifest_row {
    char *path; /* of the shape, as it can be opened */
    uint64_t particles;
    double tolerance; /* NAN: none is given */
    double size; /* diameter of the ball of equal volume to which the shape is scaled, in its unit; NAN: as it is */
} ms_manifest_row;

/** A zeroed struct is empty. A shape stands in it once in each of its sizes. */
typedef struct ms_manifest {
    ms_manifest_row *row;
    size_t count;
} ms_manifest;

/**
 * Reads a manifest: the header `shape,count`, behind it `tolerance`, `size` or both, then a line for each shape. Paths
 * are relative to the folder of the manifest. Empty lines and lines that begin with '#' are skipped.
 *
 * @param[out] manifest the caller frees it; empty on failure
 * @return MS_OK; MS_ERR_IO; MS_ERR_FORMAT with the line: another header, a shape that cannot be read or stands twice in
 *         one size, a count that is no whole number from 1 to MS_MANIFEST_MAX_PARTICLES, a tolerance that is none from
 *         0 to 1, a size that is none above 0, no shape or too many; MS_ERR_NOMEM
 */
MS_API ms_status ms_manifest_read(ms_manifest *manifest, const char *path, ms_error *err);

/** Particles of one shape. @return MS_OK; MS_ERR_NOMEM */
MS_API ms_status ms_manifest_of_shape(ms_manifest *manifest, const char *shape, uint64_t particles, ms_error *err);

/** What messages call it: "grain.stl", or "grain.stl, size 0.5". */
typedef struct ms_manifest_name {
    char text[512];
} ms_manifest_name;

MS_API ms_manifest_name ms_manifest_name_row(const ms_manifest_row *row);

/** Index of the first row of the same shape; its own for the first. */
MS_API size_t ms_manifest_first(const ms_manifest *manifest, size_t row);

/** Nonzero if a row has a size. */
MS_API int ms_manifest_has_sizes(const ms_manifest *manifest);

MS_API void ms_manifest_free(ms_manifest *manifest);

MS_C_END

#endif
