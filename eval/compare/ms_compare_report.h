/** The page of a comparison. */
#ifndef MS_COMPARE_REPORT_H
#define MS_COMPARE_REPORT_H

#include "chart/ms_csv.h"
#include "ms_compare_walk.h"

/**
 * Writes a page with all rows, the charts in the folder of the comparison, and the clumps that were kept there, each
 * with its shape (ms_view_report.h). After the charts; reads each shape once more.
 *
 * @return MS_OK; as ms_input_read, ms_input_target, ms_read_spheres, ms_view_scene_write; MS_ERR_IO; MS_ERR_NOMEM
 */
ms_status ms_compare_report_write(const ms_csv *csv, const ms_comparison *comparison, ms_error *err);

#endif
