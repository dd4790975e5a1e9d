/* Legacy VTK, for ParaView. */
#include "base/ms_version.h"
#include "ms_fields.h"
#include "ms_formats.h"

static void write_scalars(FILE *stream, const char *name)
{
    fprintf(stream, "SCALARS %s double 1\nLOOKUP_TABLE default\n", name);
}

/* Legacy VTK: points with their radius; in ParaView, a Glyph of spheres scaled by it. */
ms_status ms_vtk_write(FILE *stream, const ms_content *content, ms_error *err)
{
    const ms_clump *clump = content->clump;
    const size_t n = ms_fields_count(content);
    (void)err;
    fputs("# vtk DataFile Version 3.0\nclump by mskit " MS_VERSION "\nASCII\nDATASET POLYDATA\n", stream);
    fprintf(stream, "POINTS %zu double\n", n);
    for (size_t s = 0; s < n; s++) {
        ms_fields_numbers(stream, clump->sphere[s].centre, 3, " ");
        fputc('\n', stream);
    }
    fprintf(stream, "VERTICES %zu %zu\n", n, 2 * n);
    for (size_t s = 0; s < n; s++) {
        fprintf(stream, "1 %zu\n", s);
    }
    fprintf(stream, "POINT_DATA %zu\n", n);
    for (int array = 0; array < 3; array++) {
        if (array > 0 && !ms_fields_has_masses(content)) {
            break;
        }
        write_scalars(stream, array == 0 ? "radius" : array == 1 ? "mass" : "density");
        for (size_t s = 0; s < n; s++) {
            const double value = array == 0   ? clump->sphere[s].radius
                                 : array == 1 ? clump->mass[s]
                                              : ms_fields_density(content, s);
            fprintf(stream, "%s\n", ms_text_of_number(value).text);
        }
    }
    if (n > clump->n_spheres) {
        write_scalars(stream, "carrier");
        for (size_t s = 0; s < n; s++) {
            fputs(s < clump->n_spheres ? "0\n" : "1\n", stream);
        }
    }
    return MS_OK;
}
