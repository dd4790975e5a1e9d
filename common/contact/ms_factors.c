#include "ms_factors.h"

#include <math.h>

#include "ms_touch.h"

/* The price where the clump meets the same thing in the orientations of another row. */
static void add_price(ms_factors *f, const ms_contact_row *row)
{
    for (size_t s = 0; s < row->samples; s++) {
        const ms_touch *touch = &row->sample[s].touch;
        if (touch->count > 0) {
            f->softest = fmin(f->softest, f->modulus * touch->stiffness);
            const double e = f->restitution > 0 ? ms_touch_restitution(f->restitution, ms_touch_number(touch)) : 0;
            f->bounciest = fmax(f->bounciest, e);
        }
    }
}

ms_factors ms_factors_of(const ms_contact *contact, const ms_contact_row *row, double single)
{
    const ms_touch mean = {.stiffness = row->stiffness, .damping = row->damping};
    ms_factors f = {.modulus = 1 / row->stiffness,
                    .restitution = ms_touch_restitution(single, 1 / ms_touch_number(&mean)), /* b / root(N) */
                    .softest = HUGE_VAL};
    for (size_t r = 0; r < contact->n_rows; r++) {
        const ms_contact_row *other = &contact->row[r];
        if (other->against == row->against && other->overlap == row->overlap) {
            add_price(&f, other);
        }
    }
    return f;
}
