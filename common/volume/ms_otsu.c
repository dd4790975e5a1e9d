#include "ms_otsu.h"

int ms_otsu_cut(size_t *below, size_t *above, const uint64_t *histogram, size_t bins)
{
    double count = 0, sum = 0, lower = 0, lower_sum = 0, best = -1;
    size_t last = bins; /* the bin before that holds something */
    for (size_t b = 0; b < bins; b++) {
        count += (double)histogram[b];
        sum += (double)histogram[b] * (double)b;
    }
    for (size_t b = 0; b < bins; b++) {
        if (histogram[b] == 0) {
            continue;
        }
        if (last < bins) { /* a cut between the two */
            const double upper = count - lower, apart = (sum - lower_sum) / upper - lower_sum / lower;
            const double variance = lower * upper * apart * apart;
            if (variance > best) {
                best = variance;
                *below = last;
                *above = b;
            }
        }
        lower += (double)histogram[b];
        lower_sum += (double)histogram[b] * (double)b;
        last = b;
    }
    return best >= 0;
}
