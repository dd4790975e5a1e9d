/* MercuryDPM: the folder that its ClumpInput reads. */
#include "ms_fields.h"
#include "ms_formats.h"

ms_status ms_mercury_write_clump(FILE *stream, const ms_content *content, ms_error *err)
{
    (void)err;
    ms_fields_spheres(stream, content->clump, ",", "\n");
    return MS_OK;
}

ms_status ms_mercury_write_mass(FILE *stream, const ms_content *content, ms_error *err)
{
    (void)err;
    fprintf(stream, "%s\n", ms_text_of_number(content->particle->mass).text);
    return MS_OK;
}

ms_status ms_mercury_write_inertia(FILE *stream, const ms_content *content, ms_error *err)
{
    (void)err;
    for (int m = 0; m < 3; m++) {
        ms_fields_numbers(stream, content->particle->inertia[m], 3, ",");
        fputc('\n', stream);
    }
    return MS_OK;
}

ms_status ms_mercury_write_axes(FILE *stream, const ms_content *content, ms_error *err)
{
    (void)content;
    (void)err;
    fputs("1,0,0\n0,1,0\n0,0,1\n", stream);
    return MS_OK;
}
