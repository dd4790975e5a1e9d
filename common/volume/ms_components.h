/** Connected components: which voxels belong to one piece. */
#ifndef MS_COMPONENTS_H
#define MS_COMPONENTS_H

#include "ms_volume.h"

MS_C_BEGIN

/**
 * Numbers the components of the voxels that are not 0.
 *
 * @param[in,out] label        n[0]*n[1]*n[2], x fastest; becomes 1, 2, ... in the order of the components' first voxels
 * @param[out]    count        of components
 * @param         connectivity 6: voxels of one piece share faces; 18: or edges; 26: or corners
 * @return MS_OK; MS_ERR_ARG for another connectivity; MS_ERR_LIMIT; MS_ERR_NOMEM, with labels as they were
 *
 * Source: union-find over runs of voxels along x, Rosenfeld & Pfaltz 1966, He, Chao & Suzuki 2008
 * (doi:10.1109/TIP.2008.917204). Cost: O(voxels), 12 bytes for each run.
 */
MS_API ms_status ms_components_label(uint32_t *label, size_t *count, const int n[3], int connectivity, ms_error *err);

/**
 * Sets the voxels of all components but the largest to 0; of equal ones the first stays.
 *
 * @param[in,out] volume of one label
 * @param[out]    count  of components that there were
 * @return as ms_components_label
 */
MS_API ms_status ms_components_keep_largest(ms_volume *volume, size_t *count, int connectivity, ms_error *err);

MS_C_END

#endif
