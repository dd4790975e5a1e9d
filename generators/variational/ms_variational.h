/** The variational generator: see docs/methods/variational.md. */
#ifndef MS_VARIATIONAL_H
#define MS_VARIATIONAL_H

#include "ms_generator.h"

extern const ms_generator ms_generator_variational;

#endif
