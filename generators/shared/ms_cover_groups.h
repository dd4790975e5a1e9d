/** Candidates of a cover whose centres lie close together beside their radii. Private. */
#ifndef MS_COVER_GROUPS_H
#define MS_COVER_GROUPS_H

#include <stddef.h>
#include <stdint.h>

#include "base/ms_error.h"
#include "base/ms_sphere.h"

/** What the last of a group leads to. */
#define MS_COVER_GROUPS_END UINT32_MAX

/** A ball and the cell of its centre. */
typedef struct ms_cover_groups_member {
    uint64_t cell;
    double radius;
    size_t index; /* differs between any two */
} ms_cover_groups_member;

/** Sorts by cell, in it the largest first, of equal ones that of least index. */
void ms_cover_groups_sort(ms_cover_groups_member *member, size_t count);

/** The class of a radius from 2^class on, below 2^(class + 1). */
int ms_cover_groups_class(double radius);

/**
 * Puts balls of one class into groups, those whose centres lie in one cell of a sixteenth of the class' least radius.
 *
 * @param[out] next          of each ball the next smaller one of its group, or MS_COVER_GROUPS_END; the largest is no
 *                           other's next. The caller frees it; NULL on failure
 * @param[out] largest_class of them all, 0 at least
 * @param      candidate     `count` balls, in voxels, fewer than UINT32_MAX
 * @return MS_OK; MS_ERR_NOMEM
 *
 * Cost: one sort.
 */
ms_status ms_cover_groups_form(uint32_t **next, int *largest_class, const ms_ball *candidate, size_t count,
                               ms_error *err);

#endif
