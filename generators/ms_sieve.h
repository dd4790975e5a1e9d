/** A sieve curve by mass: its classes of size, and how many particles of a scene are of each. Sizes are diameters of
 * balls of equal volume, in the unit of the shapes, so that a particle's mass goes with their cube. */
#ifndef MS_SIEVE_H
#define MS_SIEVE_H

#include "ms_manifest.h"

MS_C_BEGIN

enum { MS_SIEVE_MAX_ROWS = 1000, MS_SIEVE_MAX_CLASSES = 100, MS_SIEVE_MAX_KINDS = 10000 };

/** One class of size. */
typedef struct ms_sieve_class {
    double size;    /* as many particles of it as the class really has would have its mass */
    double share;   /* of the mass, by the curve */
    uint64_t count; /* of particles, after ms_sieve_apply */
    double mass;    /* the share that these have of the mass of all */
} ms_sieve_class;

/** A zeroed struct is empty. */
typedef struct ms_sieve {
    size_t count;
    ms_sieve_class *of; /* by ascending size */
} ms_sieve;

/**
 * Reads the header `size,passing` and, by ascending size, the share of the mass that is finer: from 0 to 1. Between two
 * rows it grows with the logarithm of the size.
 *
 * @param[out] sieve   the caller frees it; empty on failure
 * @param      classes 0: one between each row and the next, without those that hold nothing; else as many of equal
 *                     mass, MS_SIEVE_MAX_CLASSES at most
 * @return MS_OK; MS_ERR_IO; MS_ERR_FORMAT with the line: another header, a size that is not above the one before, a
 *         share that falls or is none from 0 to 1, a curve that does not begin with 0 or end with 1, more rows
 *         than MS_SIEVE_MAX_ROWS; MS_ERR_ARG for too many classes; MS_ERR_NOMEM
 */
MS_API ms_status ms_sieve_read(ms_sieve *sieve, const char *path, size_t classes, ms_error *err);

/** The same of a curve in memory, whose rows messages count from 0. @param size, passing count values each */
MS_API ms_status ms_sieve_make(ms_sieve *sieve, const double *size, const double *passing, size_t count, size_t classes,
                               ms_error *err);

/**
 * Gives the particles of each row sizes: the row becomes one for each class that it has particles of. The numbers of
 * rows are kept, those of classes are the best whole ones for all rows together (ms_sieve_counts.h).
 *
 * @param[out]    made     the rows, one of the manifest after the other; the caller frees it; empty on failure
 * @param[in,out] sieve    gets the counts of its classes, and their shares of the mass
 * @param         manifest without sizes
 * @return MS_OK; MS_ERR_ARG for a sieve without classes or a manifest without particles; MS_ERR_LIMIT for more than
 *         MS_SIEVE_MAX_KINDS kinds or MS_MANIFEST_MAX_PARTICLES particles; MS_ERR_NOMEM
 */
MS_API ms_status ms_sieve_apply(ms_manifest *made, ms_sieve *sieve, const ms_manifest *manifest, ms_error *err);

MS_API void ms_sieve_free(ms_sieve *sieve);

MS_C_END

#endif
