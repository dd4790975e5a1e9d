/** Charts of the distributions of a library and of all grains. Private to ms_library_write. */
#ifndef MS_LIBRARY_CHARTS_H
#define MS_LIBRARY_CHARTS_H

#include "ms_library.h"

/** distribution-NAME for each descriptor of the library, as ms_chart_write writes them. */
ms_status ms_library_charts_write(const ms_library *library, const char *folder, ms_error *err);

/** @return as ms_chart_draw */
ms_status ms_library_charts_draw(const ms_library *library, const char *folder, ms_error *err);

#endif
