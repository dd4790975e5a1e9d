/** Pictures of a stability run. */
#ifndef MS_STABILITY_CHARTS_H
#define MS_STABILITY_CHARTS_H

#include "ms_stability.h"

/**
 * For each method, numbered as in the runs: NUMBER-METHOD-all, D of the changed shape over D of the unchanged one, and
 * of each change that has an axis NUMBER-METHOD-KIND, the ratio of the two over the level, a line for each shape. A
 * chart without points is left out.
 *
 * @param folder exists
 * @return MS_OK; as ms_chart_write and ms_chart_draw
 */
ms_status ms_stability_charts(const char *folder, const ms_stability_run *runs, size_t n_runs, ms_error *err);

#endif
