#include <string.h>

#include "ms_particle_json.h"
#include "ms_version.h"
#include "ms_write_formats.h"

static json_t *vector(const double v[3])
{
    return json_pack("[f,f,f]", v[0], v[1], v[2]);
}

static json_t *matrix(double m[3][3])
{
    return json_pack("[o,o,o]", vector(m[0]), vector(m[1]), vector(m[2]));
}

json_t *ms_particle_json_write(const ms_particle *p)
{
    ms_principal principal;
    ms_body body = {.volume = 1};
    memcpy(body.inertia, p->inertia, sizeof body.inertia);
    if (ms_inertia_principal(&principal, &body, NULL) != MS_OK) {
        return NULL;
    }
    return json_pack("{s:f,s:f,s:f,s:o,s:o,s:o,s:o}", "scale", p->scale, "density", p->density, "mass", p->mass,
                     "centre", vector(p->centre), "inertia", matrix(body.inertia), "principal_moments",
                     vector(principal.moment), "principal_axes", matrix(principal.axis));
}

static json_t *columns_json(int masses)
{
    return masses ? json_pack("[s,s,s,s,s,s]", "x", "y", "z", "r", "mass", "density")
                  : json_pack("[s,s,s,s]", "x", "y", "z", "r");
}

static json_t *sphere_json(const ms_content *content, size_t s, int masses)
{
    const ms_sphere *b = &content->clump->sphere[s];
    json_t *row = json_pack("[f,f,f,f]", b->centre[0], b->centre[1], b->centre[2], b->radius);
    if (row && masses) {
        json_array_append_new(row, json_real(content->clump->mass[s]));
        json_array_append_new(row, json_real(ms_write_density(content, s)));
    }
    return row;
}

/* {"mskit": version, <the record>, "particle": {...}, "columns": [...], "spheres": [[x, y, z, r], ...]} */
ms_status ms_write_json(FILE *stream, const ms_content *content, ms_error *err)
{
    const int masses = content->clump->mass && content->particle;
    json_t *root = json_pack("{s:s}", "mskit", MS_VERSION), *spheres = json_array();
    json_t *how = content->record ? json_loads(content->record, 0, NULL) : json_object();
    int failed = !root || !how || json_object_update(root, how) != 0;
    if (content->particle) {
        failed |= json_object_set_new(root, "particle", ms_particle_json_write(content->particle)) != 0;
    }
    failed |= json_object_set_new(root, "columns", columns_json(masses)) != 0;
    for (size_t s = 0; s < content->clump->n_spheres; s++) {
        failed |= json_array_append_new(spheres, sphere_json(content, s, masses)) != 0;
    }
    failed |= json_object_set_new(root, "spheres", spheres) != 0;
    failed = failed || json_dumpf(root, stream, JSON_INDENT(2)) != 0 || fputc('\n', stream) == EOF;
    json_decref(how);
    json_decref(root);
    return failed ? ms_fail(err, MS_ERR_IO, "the clump could not be written as JSON") : MS_OK;
}

/* {"mskit": version, "frame": in words, "particle": {...}}: the way from a template back to the shape. */
ms_status ms_write_frame(FILE *stream, const ms_content *content, ms_error *err)
{
    json_t *root = json_pack("{s:s,s:s,s:o*}", "mskit", MS_VERSION, "frame",
                             "shape = centre + (x axis0 + y axis1 + z axis2) / scale, for x, y, z of the template and "
                             "the rows of principal_axes",
                             "particle", ms_particle_json_write(content->particle));
    const int failed = !json_object_get(root, "particle") || json_dumpf(root, stream, JSON_INDENT(2)) != 0 ||
                       fputc('\n', stream) == EOF;
    json_decref(root);
    return failed ? ms_fail(err, MS_ERR_IO, "the frame of the template could not be written as JSON") : MS_OK;
}
