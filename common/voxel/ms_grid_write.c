#include <stdio.h>

#include "base/ms_file.h"
#include "base/ms_text.h"
#include "base/ms_version.h"
#include "ms_grid.h"

ms_status ms_grid_write(const ms_grid *grid, const char *path, ms_error *err)
{
    ms_output output;
    ms_number at[3], h = ms_text_of_number(grid->h);
    ms_status status = ms_output_open(&output, path, err);
    if (status != MS_OK) {
        return status;
    }
    for (int a = 0; a < 3; a++) {
        at[a] = ms_text_of_number(grid->origin[a]);
    }
    fputs("# vtk DataFile Version 3.0\ntarget by mskit " MS_VERSION "\nBINARY\nDATASET STRUCTURED_POINTS\n",
          output.stream);
    fprintf(output.stream, "DIMENSIONS %d %d %d\nORIGIN %s %s %s\nSPACING %s %s %s\n", grid->n[0], grid->n[1],
            grid->n[2], at[0].text, at[1].text, at[2].text, h.text, h.text, h.text);
    fprintf(output.stream, "POINT_DATA %zu\nSCALARS inside unsigned_char 1\nLOOKUP_TABLE default\n",
            ms_grid_voxels(grid));
    fwrite(grid->inside, 1, ms_grid_voxels(grid), output.stream);
    return ms_output_close(&output, MS_OK, err);
}
