#include "ms_split.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_vector.h"
#include "ms_surface_tally.h"

/* Neighbours that have to make room. */
enum { NEIGHBOURS = 8 };

/* Of the way to the nearest neighbour: in a row of even steps, where each of two takes half of the sphere's own. */
static const double APART = 0.25;

static size_t find_worst(const ms_surface_worth *worth, size_t count)
{
    size_t worst = 0;
    for (size_t b = 1; b < count; b++) {
        worst = worth[b].mismatch > worth[worst].mismatch ? b : worst;
    }
    return worst;
}

/* The nearest before `first`, in order. */
static size_t list_nearest(size_t nearest[NEIGHBOURS], const ms_ball *ball, size_t first, const ms_ball *of)
{
    double square[NEIGHBOURS];
    size_t found = 0;
    for (size_t b = 0; b < first; b++) {
        const double here = ms_squared_distance(ball[b].centre, of->centre);
        if (found == NEIGHBOURS && !(here < square[found - 1])) {
            continue;
        }
        size_t at = found < NEIGHBOURS ? found++ : found - 1;
        for (; at > 0 && square[at - 1] > here; at--) {
            square[at] = square[at - 1];
            nearest[at] = nearest[at - 1];
        }
        square[at] = here;
        nearest[at] = b;
    }
    return found;
}

/* Two in place of one, one towards the nearest other sphere, one away from it: centres and radii. */
static void split_ball(ms_ball *ball, ms_ball *added, size_t which, size_t count)
{
    size_t nearest[NEIGHBOURS];
    ms_ball *one = &ball[which];
    const ms_ball whole = *one;
    const size_t found = list_nearest(nearest, ball, count, &whole);
    const size_t other = found > 0 && nearest[0] == which ? 1 : 0;
    *added = whole;
    if (other >= found) {
        return;
    }
    const ms_ball *to = &ball[nearest[other]];
    for (int c = 0; c < 3; c++) {
        const double way = APART * (to->centre[c] - whole.centre[c]);
        one->centre[c] += way;
        added->centre[c] -= way;
    }
    const double wider = APART * (to->radius - whole.radius);
    one->radius += wider;
    added->radius -= wider;
}

ms_status ms_split_worst(ms_ball *ball, size_t *count, size_t more, const ms_surface_fit *fit, ms_error *err)
{
    const size_t before = *count;
    ms_surface_worth *worth = malloc((before + 1) * sizeof *worth);
    const ms_status status = worth ? ms_surface_tally(worth, NULL, NULL, fit, ball, before, err)
                                   : ms_fail(err, MS_ERR_NOMEM, "no memory to choose among %zu spheres", before);
    for (size_t a = 0; status == MS_OK && a < more && a < before; a++) {
        const size_t worst = find_worst(worth, before);
        split_ball(ball, &ball[(*count)++], worst, before);
        worth[worst].mismatch = -1;
    }
    free(worth);
    return status;
}

void ms_split_mark_near(uint8_t *near, const ms_ball *ball, size_t count, size_t first)
{
    memset(near, 0, first);
    memset(near + first, 1, count - first);
    for (size_t a = first; a < count; a++) {
        size_t nearest[NEIGHBOURS];
        const size_t found = list_nearest(nearest, ball, first, &ball[a]);
        for (size_t i = 0; i < found; i++) {
            near[nearest[i]] = 1;
        }
    }
}
