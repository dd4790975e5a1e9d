/** Greedy set cover by inscribed spheres on the thinned medial surface (Yuan 2019). */
#ifndef MS_SETCOVER_H
#define MS_SETCOVER_H

#include "ms_generator.h"

MS_C_BEGIN

extern const ms_generator ms_generator_setcover;

MS_C_END

#endif
