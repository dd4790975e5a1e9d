/** A scene in a DEM engine: one script that inserts particles of several kinds, lets them come to rest and prints
 * figures of the bed. */
#ifndef MS_SCENE_SCRIPT_H
#define MS_SCENE_SCRIPT_H

#include "ms_write.h"

MS_C_BEGIN

/** One kind of particles. All borrowed. */
typedef struct ms_scene_kind {
    const ms_clump *clump;       /* as in the ms_content of its template: in the unit of the shape */
    const ms_particle *particle; /* likewise, with its mass; the scale is that of all kinds */
    const char *path;            /* of its template, which stands in the folder of the script (ms_write_path) */
    const char *name;            /* what messages call it */
    size_t count;                /* of particles */
} ms_scene_kind;

/** Into what they fall. A zeroed struct is a box as wide as the bed is high. */
typedef struct ms_scene_vessel {
    double width[2]; /* of a box along x and y, or a cylinder's diameter twice, in the unit of the clumps; 0: chosen */
    int is_round;    /* it is a cylinder */
} ms_scene_vessel;

/**
 * Has the vessel room for each particle, however it is turned?
 *
 * @return MS_OK; MS_ERR_ARG where it has not, or for a width that is neither 0 nor a number above; MS_ERR_NOMEM; as
 *         ms_template_make
 */
MS_API ms_status ms_scene_script_check(const ms_scene_kind *kind, size_t count, const ms_scene_vessel *vessel,
                                       ms_error *err);

/**
 * Writes the script, FOLDER/scene.ENDING and the suffix of the format's scripts, which inserts all particles: the
 * largest first, since they find no room among small ones. The templates are to stand beside it (ms_write_clump).
 *
 * @param count  of kinds, at least 1
 * @param vessel with room for each (ms_scene_script_check)
 * @param format one with a script of scenes (ms_format.scene)
 * @return MS_OK; MS_ERR_ARG for no kinds, a particle without mass or another format; MS_ERR_IO; MS_ERR_NOMEM; as
 *         ms_template_make
 */
MS_API ms_status ms_scene_script_write(const ms_scene_kind *kind, size_t count, const ms_scene_vessel *vessel,
                                       const char *folder, const ms_format *format, ms_error *err);

/** Where it stands. @param format one with a script of scenes @return the caller frees it; NULL without memory */
MS_API char *ms_scene_script_path(const char *folder, const ms_format *format);

MS_C_END

#endif
