/** One modulus and one restitution that would undo what many contacts at once do, and what that costs elsewhere. */
#ifndef MS_FACTORS_H
#define MS_FACTORS_H

#include "ms_contact.h"

MS_C_BEGIN

typedef struct ms_factors {
    double modulus;     /* times that of the material: the mean contact is as stiff as one of r_eq */
    double restitution; /* to ask for, that the contact of mean damping and stiffness has what one is to have; 0: none
                           damps as much */
    double softest;   /* the price, on what is touched, at random and in poses: the softest contact over one of r_eq, */
    double bounciest; /* and the greatest restitution of any */
} ms_factors;

/**
 * @param row    of the contact's, in which something touches
 * @param single restitution of one contact that is wanted, above 0 and at most 1
 */
MS_API ms_factors ms_factors_of(const ms_contact *contact, const ms_contact_row *row, double single);

MS_C_END

#endif
