/** The one list of methods, from which the table of them is made. */
#ifndef MS_GENERATOR_LIST_H
#define MS_GENERATOR_LIST_H

#include "ms_generator.h"

MS_C_BEGIN

/* In the order in which they are shown. Each NAME is a folder with ms_NAME.c, which defines ms_generator_NAME. */
#define MS_GENERATOR_LIST(X) X(mss) X(setcover) X(fcm) X(variational) X(favier) X(ferellec) X(euclid)

#define MS_GENERATOR_DECLARE(name) extern const ms_generator ms_generator_##name;
MS_GENERATOR_LIST(MS_GENERATOR_DECLARE)
#undef MS_GENERATOR_DECLARE

MS_C_END

#endif
