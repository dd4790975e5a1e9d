/** When a run is to end: flags of the commands that run a generator. */
#ifndef MS_UNTIL_H
#define MS_UNTIL_H

#include "ms_flags.h"
#include "ms_stop.h"

/* clang-format off */
#define MS_MIN_RADIUS_FLAG {"min-radius", 0, "R", "no sphere smaller than this, for the sake of the time step"}

#define MS_UNTIL_FLAGS \
    {"spheres", 'n', "N", "at most N spheres (50, if no --until is given)"}, \
    {"until", 0, "MEASURE=VALUE", \
     "end when " MS_MEASURE_GOAL_NAMES \
     "whichever is named, is as good, or spheres would be smaller than radius; may be repeated"}, \
    {"min-radius", 0, "R", "no sphere smaller than this, for the sake of the time step; as --until radius=R"}
/* clang-format on */

/** Takes a flag if it is one of MS_UNTIL_FLAGS. @param[out] taken 0 if it is not */
ms_status ms_until_flag(int *taken, ms_stop *stop, const char *name, const char *value, ms_error *err);

/** Takes the value of MS_MIN_RADIUS_FLAG, for commands that have it without the others. */
ms_status ms_until_min_radius(double *radius, const char *value, ms_error *err);

/** 50 spheres, where nothing else is asked for. */
void ms_until_resolve(ms_stop *stop);

#endif
