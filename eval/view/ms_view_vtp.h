/** Spheres as VTK's surfaces. */
#ifndef MS_VIEW_VTP_H
#define MS_VIEW_VTP_H

#include "clump/formats/ms_write.h"

/** XML polydata: each sphere as 324 triangles with normals, and for each triangle the index of its sphere from 1, its
 * radius and, where there are masses, its mass. As ms_part.write. @return MS_OK */
ms_status ms_view_vtp_write(FILE *stream, const ms_content *content, ms_error *err);

#endif
