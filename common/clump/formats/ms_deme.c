/* Chrono DEM-Engine. */
#include "ms_fields.h"
#include "ms_formats.h"

ms_status ms_deme_write(FILE *stream, const ms_content *content, ms_error *err)
{
    (void)err;
    fputs("x,y,z,r\n", stream);
    ms_fields_spheres(stream, content->clump, ",", "\n");
    return MS_OK;
}
