/** What the scripts of YADE share. Private to the writers of formats. */
#ifndef MS_YADE_H
#define MS_YADE_H

#include <stdio.h>

/** The function particle(file, scale, mass, inertia, position, turn), as that of a single template. */
void ms_yade_particle(FILE *stream);

#endif
