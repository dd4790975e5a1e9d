/** The grains of a run, from the words of the command line: volumes, meshes, folders, patterns, manifests. */
#ifndef MS_GRAIN_LIST_H
#define MS_GRAIN_LIST_H

#include "ms_grain_how.h"
#include "ms_grain_source.h"

/** One of them. */
typedef struct ms_grain {
    ms_grain_source *source;
    uint32_t label;          /* 0: a mesh, or a volume that could not be read */
    char *name;              /* of its files, without folder and ending: made safe */
    const ms_grain_how *how; /* its own, or that of all */
    double size;             /* voxels, or bytes of the mesh file: what the work goes with, roughly */
} ms_grain;

/** All of them, in the order of the words; labels ascend, files of a folder are in the order of their names. A zeroed
 * struct is empty. */
typedef struct ms_grain_list {
    ms_grain *grain;
    size_t count, capacity;
    ms_grain_source **source;
    size_t n_sources;
    ms_grain_how **own; /* of rows of a manifest that say how */
    size_t n_own;
    char **text; /* of manifests, which those point into */
    size_t n_texts;
} ms_grain_list;

/**
 * Lists the grains.
 *
 * A word is a folder, of which all meshes and volumes are taken; a pattern (glob); a manifest, which ends in .csv and
 * begins with a header: `shape`, and if wanted `label`, `count` and `tolerance` (of scene; not heeded here) and any
 * flag of method, grid or stop rule, without its dashes; or a mesh or a volume. A volume is read, to list its labels:
 * if it cannot be, it stands as one grain, whose run says why.
 *
 * @param[out] list  the caller frees it; empty on failure
 * @param      words count of them
 * @param      how   of all grains whose row says nothing else; borrowed
 * @return MS_OK; MS_ERR_IO for a file, folder or pattern that is not there; MS_ERR_FORMAT for a manifest with the line;
 *         MS_ERR_ARG for two grains of one name, whose files would be the same, and for flags; MS_ERR_NOMEM
 */
ms_status ms_grain_list_make(ms_grain_list *list, char *const *words, size_t count, const ms_grain_how *how,
                             ms_error *err);

/** Names the list, and with it a run: a checksum of sources, labels, sizes and of the flags that were noted. */
uint64_t ms_grain_list_checksum(const ms_grain_list *list);

void ms_grain_list_free(ms_grain_list *list);

#endif
