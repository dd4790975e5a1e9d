/* MFiX: gsp_config.csv. */
#include <math.h>

#include "ms_fields.h"
#include "ms_formats.h"

/* Lengths over the diameter of the ball around the particle. Areas and neighbours serve heat transfer alone; each
 * sphere has its own surface and no neighbours. */
ms_status ms_mfix_write(FILE *stream, const ms_content *content, ms_error *err)
{
    const ms_clump *clump = content->clump;
    const double bound = 2 * ms_template_reach(clump);
    (void)err;
    fputs("#version = 1\nx,y,z,rel_d,rel_sa,w,e,s,n,t,b,w_na,e_na,s_na,n_na,t_na,b_na,pid\n", stream);
    for (size_t s = 0; s < clump->n_spheres; s++) {
        const double *c = clump->sphere[s].centre, d = 2 * clump->sphere[s].radius / bound;
        const double row[5] = {c[0] / bound, c[1] / bound, c[2] / bound, d, acos(-1.0) * d * d};
        ms_fields_numbers(stream, row, 5, ",");
        fputs(",-1,-1,-1,-1,-1,-1,0,0,0,0,0,0,1\n", stream);
    }
    return MS_OK;
}
