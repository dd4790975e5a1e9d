/** From a file to a clump in one call. */
#ifndef MS_GENERATE_H
#define MS_GENERATE_H

#include <stdint.h>

#include "measure/ms_metrics.h"
#include "ms_stop.h"

MS_C_BEGIN

/** An option of a generator as ms_option_settings_set takes it. */
typedef struct ms_generate_option {
    const char *name, *text;
} ms_generate_option;

/** What is asked for; all borrowed. A zeroed struct asks for what `mskit generate FILE` does. */
typedef struct ms_generate_request {
    const char *generator;             /* ms_generator_find; NULL: MS_GENERATOR_DEFAULT */
    const ms_generate_option *options; /* ends with a NULL name; NULL: those of the generator */
    ms_stop stop;                      /* asks for nothing: 50 spheres */
    double cells;                      /* voxels along the shortest side of a mesh's box; 0: 100 */
    uint32_t label;                    /* of a volume; 0: the only one that it has */
    uint64_t seed;                     /* 0: 1 */
    double max_bytes;                  /* larger grids are refused; 0: ms_target_default_bytes */
} ms_generate_request;

/**
 * Reads a mesh or a volume, mends a mesh, cuts it into voxels, makes a clump and judges it.
 *
 * @param[out] clump   in the unit and frame of the file; freed by ms_clump_free; empty on failure
 * @param[out] metrics how good it is; may be NULL
 * @param      path    its ending tells what it is (ms_mesh_read, ms_volume_read)
 * @param      request NULL: all defaults
 * @return MS_OK; MS_ERR_FORMAT for an ending that names no shape; MS_ERR_SHAPE for an open mesh; MS_ERR_LIMIT for too
 *         large a grid; as ms_mesh_read, ms_volume_read, ms_target_from_mesh, ms_generator_run
 */
MS_API ms_status ms_generate_file(ms_clump *clump, ms_metrics *metrics, const char *path,
                                  const ms_generate_request *request, ms_error *err);

MS_C_END

#endif
