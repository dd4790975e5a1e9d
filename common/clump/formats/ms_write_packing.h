/** Files of a whole packing: every clump in its place, by its own template, and a script that lets it come to rest; of
 * a mixture; and of a scene. */
#ifndef MS_WRITE_PACKING_H
#define MS_WRITE_PACKING_H

#include "clump/ms_packing.h"
#include "ms_write.h"

/** Nonzero if packings of this format are written. */
int ms_write_packing_is(const ms_format *format);

/**
 * Writes the packing, each file under a temporary name that is then renamed. The templates stand beside it, by the
 * names of the clumps.
 *
 * @param packing not empty, of clumps with masses
 * @param path    of its first file, whose name fits scripts
 * @return MS_OK; MS_ERR_IO; MS_ERR_NOMEM
 */
ms_status ms_write_packing(const ms_packing *packing, const char *path, const ms_format *format, ms_error *err);

/**
 * Writes a script that drops particles of a mixture into a box, each of a kind by its share, and what it needs beside
 * it: as above. Nothing if the format has none (ms_format.mixture).
 *
 * @param mixture not empty, of clumps with masses; places and turns are not heeded
 */
ms_status ms_write_mixture(const ms_packing *mixture, const char *path, const ms_format *format, ms_error *err);

/**
 * Writes the script PATH with the format's suffix, which inserts all particles of a scene into its vessel and lets them
 * come to rest. The templates stand beside it, by the names of the kinds.
 *
 * @param scene  not empty, of clumps with masses and counts; the vessel, where it is given, is wider than the largest
 *               particle
 * @param path   a name that fits scripts
 * @param format one with a script of scenes (ms_format.scene)
 * @return MS_OK; MS_ERR_IO; MS_ERR_NOMEM
 */
ms_status ms_write_scene(const ms_packing *scene, const char *path, const ms_format *format, ms_error *err);

#endif
