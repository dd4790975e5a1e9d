/** MSS: spheres at the maxima of distance fields (Buchele, Poeschel & Mueller 2026). */
#ifndef MS_MSS_H
#define MS_MSS_H

#include "ms_generator.h"

MS_C_BEGIN

extern const ms_generator ms_generator_mss;

MS_C_END

#endif
