/** Pictures of a stability run. */
#ifndef MS_STABILITY_CHARTS_H
#define MS_STABILITY_CHARTS_H

#include "cli/ms_files.h"
#include "ms_stability.h"

/**
 * For each method, numbered as in the runs: NUMBER-METHOD-all, D of the changed shape over D of the unchanged one, and
 * of each change that has an axis NUMBER-METHOD-KIND, the ratio of the two over the level, a line for each shape. A
 * chart without points is left out. Those that a run before left there are removed.
 *
 * @param folder  exists
 * @param methods of the runs
 * @return MS_OK; as ms_files_remove, ms_chart_write and ms_chart_draw
 */
ms_status ms_stability_charts(const char *folder, const ms_methods *methods, const ms_stability_run *runs,
                              size_t n_runs, ms_error *err);

/** Adds the files of all charts that there can be of these methods. @return MS_OK; MS_ERR_NOMEM */
ms_status ms_stability_charts_list(ms_files *files, const char *folder, const ms_methods *methods, ms_error *err);

#endif
