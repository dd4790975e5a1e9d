/** Otsu's threshold between two classes of grey values. Private. */
#ifndef MS_OTSU_H
#define MS_OTSU_H

#include <stddef.h>
#include <stdint.h>

/**
 * The cut of a histogram with the largest variance between the two classes, sigma_B^2 = w0 w1 (mu1 - mu0)^2.
 *
 * @param[out] below the last bin of the lower class that is not empty
 * @param[out] above the first one of the upper class; what lies between does not matter to the variance
 * @return nonzero; 0 if fewer than two bins hold anything
 *
 * Source: N. Otsu, IEEE Trans. Syst. Man Cybern. 9 (1979) 62-66, eq. 14; MSS section 3.1 takes it. Of equal cuts the
 * lowest. Cost: O(bins).
 */
int ms_otsu_cut(size_t *below, size_t *above, const uint64_t *histogram, size_t bins);

#endif
