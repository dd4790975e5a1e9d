/** Which template each shape of a scene gets. */
#ifndef MS_SCENE_CHOOSE_H
#define MS_SCENE_CHOOSE_H

#include "ms_scene.h"

/** Chooses a template of each shape. @return MS_OK; MS_ERR_LIMIT; MS_ERR_NOMEM; as ms_allocate_budget and _error */
ms_status ms_scene_choose(ms_scene *scene, const ms_goal *goal, ms_error *err);

#endif
