/** Meshes whose nodes are too far apart for spheres that reach to them. */
#ifndef MS_LONG_EDGES_H
#define MS_LONG_EDGES_H

#include "ms_generator.h"

MS_C_BEGIN

/** Tells the run's listener where edges are long for n spheres, which reach through a face as far as they are long. */
void ms_long_edges_remark(const ms_run *run, size_t n);

MS_C_END

#endif
