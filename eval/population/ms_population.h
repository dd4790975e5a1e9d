/** A population as a table of descriptors: what distributions and correlations it has. */
#ifndef MS_POPULATION_H
#define MS_POPULATION_H

#include <stddef.h>

#include "base/ms_error.h"

enum { MS_POPULATION_DESCRIPTORS = 8 };

/** Grains with a share each, by number or by mass, and what follows from their order along each descriptor. */
typedef struct ms_population {
    size_t n, n_descriptors, n_pairs; /* pairs of descriptors: (1,0), (2,0), (2,1), (3,0) ... */
    double *share;                    /* n; their sum is 1 */
    double *value;                    /* n x n_descriptors */
    double *up_to, *below;            /* n x n_descriptors: share of grains of at most this value; of less */
    double *product;     /* n x n_pairs: of the standardised ranks; its mean by share is the correlation of ranks */
    double *correlation; /* n_pairs: Spearman's, 0 where a descriptor has one value alone */
} ms_population;

/**
 * @param[out] p     the caller frees it; empty on failure
 * @param      value n x n_descriptors, finite; copied
 * @param      share n, above 0; NULL: all alike; copied, over their sum
 * @return MS_OK; MS_ERR_NOMEM. Cost: O(n log n) for each descriptor.
 */
ms_status ms_population_make(ms_population *p, const double *value, const double *share, size_t n, size_t n_descriptors,
                             ms_error *err);

void ms_population_free(ms_population *p);

#endif
