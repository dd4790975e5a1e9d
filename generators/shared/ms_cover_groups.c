#include "ms_cover_groups.h"

#include <math.h>
#include <stdlib.h>

/* In a group lie the centres of balls within this part of their radius, rounded down to a power of two. */
static const double GROUP_SIDE = 0.0625;

int ms_cover_groups_class(double radius)
{
    int exponent;
    frexp(radius, &exponent);
    return exponent - 1;
}

static int compare_members(const void *one, const void *other)
{
    const ms_cover_groups_member *a = one, *b = other;
    if (a->cell != b->cell) {
        return a->cell < b->cell ? -1 : 1;
    }
    if (a->radius != b->radius) {
        return a->radius > b->radius ? -1 : 1;
    }
    return a->index < b->index ? -1 : 1;
}

void ms_cover_groups_sort(ms_cover_groups_member *member, size_t count)
{
    qsort(member, count, sizeof *member, compare_members);
}

static uint64_t find_group_cell(const ms_ball *ball, int class)
{
    const double side = ldexp(GROUP_SIDE, class);
    uint64_t cell = (uint64_t) class;
    for (int a = 0; a < 3; a++) {
        cell = cell << 19 | (uint64_t)fmin(fmax(floor(ball->centre[a] / side), 0), 0x7ffff);
    }
    return cell;
}

ms_status ms_cover_groups_form(uint32_t **next, int *largest_class, const ms_ball *candidate, size_t count,
                               ms_error *err)
{
    ms_cover_groups_member *member = malloc((count + 1) * sizeof *member);
    *next = malloc((count + 1) * sizeof **next);
    *largest_class = 0;
    if (!member || !*next) {
        free(member);
        free(*next);
        *next = NULL;
        return ms_fail(err, MS_ERR_NOMEM, "no memory to group %zu spheres; use fewer cells", count);
    }
    for (size_t c = 0; c < count; c++) {
        const ms_ball *ball = &candidate[c];
        const int class = ball->radius >= 1 ? ms_cover_groups_class(ball->radius) : 0;
        *largest_class = class > *largest_class ? class : *largest_class;
        member[c] = (ms_cover_groups_member){find_group_cell(ball, class), ball->radius, c};
    }
    ms_cover_groups_sort(member, count);
    for (size_t c = 0; c < count; c++) {
        const int follows = c + 1 < count && member[c + 1].cell == member[c].cell;
        (*next)[member[c].index] = follows ? (uint32_t)member[c + 1].index : MS_COVER_GROUPS_END;
    }
    free(member);
    return MS_OK;
}
