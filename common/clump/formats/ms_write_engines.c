/* Templates of the engines, in the frame of the particle: the inertia is diagonal. */
#include <math.h>

#include "ms_version.h"
#include "ms_write_formats.h"

static void write_moments(FILE *stream, const ms_particle *particle, double over, const char *mark)
{
    double moment[3];
    for (int m = 0; m < 3; m++) {
        moment[m] = particle->inertia[m][m] / over;
    }
    ms_write_numbers(stream, moment, 3, mark);
}

/* A comment or an empty line in it crashes LIGGGHTS. */
ms_status ms_write_liggghts(FILE *stream, const ms_content *content, ms_error *err)
{
    if (content->clump->n_spheres < 2) {
        return ms_fail(err, MS_ERR_ARG, "LIGGGHTS takes no multisphere of one sphere; use its particletemplate/sphere");
    }
    ms_write_spheres(stream, content->clump, " ", "\n");
    return MS_OK;
}

static void write_section(FILE *stream, const char *name, const ms_clump *clump)
{
    fprintf(stream, "\n%s\n\n", name);
    for (size_t s = 0; s < clump->n_spheres; s++) {
        fprintf(stream, "%zu ", s + 1);
        switch (name[0]) {
        case 'C':
            ms_write_numbers(stream, clump->sphere[s].centre, 3, " ");
            break;
        case 'T':
            fputc('1', stream);
            break;
        case 'D':
            ms_write_numbers(stream, (const double[]){2 * clump->sphere[s].radius}, 1, " ");
            break;
        default:
            ms_write_numbers(stream, &clump->mass[s], 1, " ");
        }
        fputc('\n', stream);
    }
}

/* Zeros for the products of inertia: their order differs between LAMMPS's manual and its code. */
ms_status ms_write_lammps(FILE *stream, const ms_content *content, ms_error *err)
{
    static const char *const SECTIONS[] = {"Coords", "Types", "Diameters", "Masses"};
    (void)err;
    fputs("clump by mskit " MS_VERSION ", SI, from the centre of mass along the principal axes\n\n", stream);
    fprintf(stream, "%zu atoms\n", content->clump->n_spheres);
    fprintf(stream, "%s mass\n0 0 0 com\n", ms_text_of_number(content->particle->mass).text);
    write_moments(stream, content->particle, 1, " ");
    fputs(" 0 0 0 inertia\n", stream);
    for (int k = 0; k < 4; k++) {
        write_section(stream, SECTIONS[k], content->clump);
    }
    return MS_OK;
}

ms_status ms_write_yade(FILE *stream, const ms_content *content, ms_error *err)
{
    (void)err;
    fputs("# x y z r clumpId\n", stream); /* with #format x_y_z_r_clumpId, ymport.text would refuse it */
    ms_write_spheres(stream, content->clump, " ", " 0\n");
    return MS_OK;
}

ms_status ms_write_mercury_clump(FILE *stream, const ms_content *content, ms_error *err)
{
    (void)err;
    ms_write_spheres(stream, content->clump, ",", "\n");
    return MS_OK;
}

ms_status ms_write_mercury_mass(FILE *stream, const ms_content *content, ms_error *err)
{
    (void)err;
    fprintf(stream, "%s\n", ms_text_of_number(content->particle->mass).text);
    return MS_OK;
}

ms_status ms_write_mercury_tensor(FILE *stream, const ms_content *content, ms_error *err)
{
    (void)err;
    for (int m = 0; m < 3; m++) {
        ms_write_numbers(stream, content->particle->inertia[m], 3, ",");
        fputc('\n', stream);
    }
    return MS_OK;
}

ms_status ms_write_mercury_axes(FILE *stream, const ms_content *content, ms_error *err)
{
    (void)content;
    (void)err;
    fputs("1,0,0\n0,1,0\n0,0,1\n", stream);
    return MS_OK;
}

ms_status ms_write_deme(FILE *stream, const ms_content *content, ms_error *err)
{
    (void)err;
    fputs("x,y,z,r\n", stream);
    ms_write_spheres(stream, content->clump, ",", "\n");
    return MS_OK;
}

static double equivalent_diameter(const ms_particle *particle)
{
    return cbrt(6 * particle->mass / (particle->density * acos(-1.0)));
}

ms_status ms_write_kratos(FILE *stream, const ms_content *content, ms_error *err)
{
    const ms_particle *p = content->particle;
    const ms_number size = ms_text_of_number(2 * ms_template_reach(content->clump));
    (void)err;
    fprintf(stream, "Name\n%s\n\nBegin centers_and_radii\n", content->name);
    ms_write_spheres(stream, content->clump, " ", "\n");
    fprintf(stream, "End centers_and_radii\n\nParticle_center_and_diameter\n0 0 0 %s\n\nSize\n%s\n\nVolume\n%s\n\n",
            ms_text_of_number(equivalent_diameter(p)).text, size.text, ms_text_of_number(p->mass / p->density).text);
    fputs("Inertia per unit mass\n", stream);
    write_moments(stream, p, p->mass, "\n");
    fputc('\n', stream);
    return MS_OK;
}

/* Lengths over the diameter of the ball around the particle. Areas and neighbours serve heat transfer alone; each
 * sphere has its own surface and no neighbours. */
ms_status ms_write_mfix(FILE *stream, const ms_content *content, ms_error *err)
{
    const ms_clump *clump = content->clump;
    const double bound = 2 * ms_template_reach(clump);
    (void)err;
    fputs("#version = 1\nx,y,z,rel_d,rel_sa,w,e,s,n,t,b,w_na,e_na,s_na,n_na,t_na,b_na,pid\n", stream);
    for (size_t s = 0; s < clump->n_spheres; s++) {
        const double *c = clump->sphere[s].centre, d = 2 * clump->sphere[s].radius / bound;
        const double row[5] = {c[0] / bound, c[1] / bound, c[2] / bound, d, acos(-1.0) * d * d};
        ms_write_numbers(stream, row, 5, ",");
        fputs(",-1,-1,-1,-1,-1,-1,0,0,0,0,0,0,1\n", stream);
    }
    return MS_OK;
}

/* Volume and inertia at unit density. */
ms_status ms_write_pfc(FILE *stream, const ms_content *content, ms_error *err)
{
    const ms_particle *p = content->particle;
    (void)err;
    fprintf(stream, "clump template create name \"%s\" pebbles %zu ...\n", content->name, content->clump->n_spheres);
    for (size_t s = 0; s < content->clump->n_spheres; s++) {
        const ms_sphere *b = &content->clump->sphere[s];
        ms_write_numbers(stream, (const double[]){b->radius, b->centre[0], b->centre[1], b->centre[2]}, 4, " ");
        fputs(" ...\n", stream);
    }
    fprintf(stream, "volume %s inertia ", ms_text_of_number(p->mass / p->density).text);
    write_moments(stream, p, p->density, " ");
    fputs(" 0 0 0\n", stream);
    return MS_OK;
}
