/** Clustered random spheres (Westbrink & Schwung 2017): see docs/methods/fcm.md. */
#ifndef MS_FCM_H
#define MS_FCM_H

#include "ms_generator.h"

MS_C_BEGIN

extern const ms_generator ms_generator_fcm;

MS_C_END

#endif
