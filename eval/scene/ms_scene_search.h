/** The least number of spheres that reaches a tolerance, where each number is a run of its own. */
#ifndef MS_SCENE_SEARCH_H
#define MS_SCENE_SEARCH_H

#include "ms_scene.h"

/**
 * Runs the numbers that it takes, but none that is there already, and sets `chosen`; 0 where no number reaches it.
 *
 * @param shape with room for its templates and with its tolerance
 * @return as ms_templates_search
 */
ms_status ms_scene_search(ms_scene_shape *shape, const ms_input *input, const ms_templates_how *how,
                          const ms_goal *goal, ms_error *err);

#endif
