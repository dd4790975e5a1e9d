/* The JSON of a clump, and of the frame beside a template. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ms_particle_json.h"
#include "ms_read_formats.h"

ms_status ms_read_sphere(ms_clump *clump, const double v[4], const char *name, ms_error *err)
{
    const ms_sphere sphere = {.centre = {v[0], v[1], v[2]}, .radius = v[3]};
    if (!isfinite(v[0]) || !isfinite(v[1]) || !isfinite(v[2]) || !isfinite(v[3]) || !(v[3] > 0)) {
        return ms_fail(err, MS_ERR_FORMAT,
                       "%s: sphere %zu is (%g, %g, %g) with radius %g; centres must be finite and radii above 0", name,
                       clump->n_spheres + 1, v[0], v[1], v[2], v[3]);
    }
    return ms_clump_add(clump, &sphere, err);
}

/* Reads n numbers; returns 0 if the value is no list that begins with as many. */
static int take_numbers(double *out, size_t n, const json_t *list)
{
    if (json_array_size(list) < n) {
        return 0;
    }
    for (size_t k = 0; k < n; k++) {
        if (!json_is_number(json_array_get(list, k))) {
            return 0;
        }
        out[k] = json_number_value(json_array_get(list, k));
    }
    return 1;
}

static int take_number(double *out, const json_t *object, const char *key)
{
    const json_t *value = json_object_get(object, key);
    *out = json_number_value(value);
    return json_is_number(value);
}

ms_status ms_particle_json_read(ms_particle *particle, const json_t *json, const char *name, ms_error *err)
{
    ms_particle p = {0};
    const json_t *rows = json_object_get(json, "inertia");
    int whole = take_number(&p.scale, json, "scale") && take_number(&p.density, json, "density") &&
                take_number(&p.mass, json, "mass") && take_numbers(p.centre, 3, json_object_get(json, "centre"));
    for (size_t k = 0; k < 3; k++) {
        whole = whole && take_numbers(p.inertia[k], 3, json_array_get(rows, k)) && p.inertia[k][k] > 0;
    }
    if (!whole || !(p.scale > 0) || !(p.mass > 0) || !(p.density >= 0)) {
        memset(particle, 0, sizeof *particle);
        return ms_fail(err, MS_ERR_FORMAT,
                       "%s: its particle has not all of scale, density, mass, centre and inertia as numbers of their "
                       "ranges; write it again with mskit correct",
                       name);
    }
    *particle = p;
    return MS_OK;
}

static ms_status parse_root(json_t **root, const ms_bytes *bytes, const char *name, ms_error *err)
{
    json_error_t where;
    *root = json_loadb((const char *)bytes->data, bytes->size, 0, &where);
    return *root ? MS_OK
                 : ms_fail(err, MS_ERR_FORMAT, "%s: line %d: %s; this is no JSON", name, where.line, where.text);
}

/* Do the columns say that a mass follows the radius? */
static int has_masses(const json_t *root)
{
    const char *fifth = json_string_value(json_array_get(json_object_get(root, "columns"), 4));
    return fifth && strcmp(fifth, "mass") == 0;
}

static ms_status take_spheres(ms_clump *clump, const json_t *root, const char *name, ms_error *err)
{
    const json_t *list = json_object_get(root, "spheres");
    const size_t n = json_array_size(list), columns = has_masses(root) ? 5 : 4;
    double v[5];
    ms_status status = n ? MS_OK : ms_fail(err, MS_ERR_FORMAT, "%s: holds no list 'spheres'", name);
    for (size_t s = 0; s < n && status == MS_OK; s++) {
        status = take_numbers(v, columns, json_array_get(list, s))
                     ? ms_read_sphere(clump, v, name, err)
                     : ms_fail(err, MS_ERR_FORMAT, "%s: sphere %zu is no list of %zu numbers", name, s + 1, columns);
    }
    if (status == MS_OK && columns == 5) {
        status = ms_clump_alloc_masses(clump, err);
        for (size_t s = 0; s < n && status == MS_OK; s++) {
            take_numbers(v, 5, json_array_get(list, s));
            clump->mass[s] = v[4];
        }
    }
    return status;
}

ms_status ms_read_json(ms_clump *clump, ms_particle *particle, ms_bytes *bytes, const char *name, ms_error *err)
{
    json_t *root;
    ms_status status = parse_root(&root, bytes, name, err);
    if (status == MS_OK) {
        status = take_spheres(clump, root, name, err);
    }
    if (status == MS_OK && json_object_get(root, "particle")) {
        status = ms_particle_json_read(particle, json_object_get(root, "particle"), name, err);
    }
    json_decref(root);
    return status;
}

ms_status ms_read_particle(ms_particle *particle, const char *path, ms_error *err)
{
    ms_bytes bytes;
    json_t *root = NULL;
    memset(particle, 0, sizeof *particle);
    ms_status status = ms_file_read(&bytes, path, err);
    if (status != MS_OK) {
        return status;
    }
    status = parse_root(&root, &bytes, path, err);
    if (status == MS_OK) {
        status = ms_particle_json_read(particle, json_object_get(root, "particle"), path, err);
    }
    json_decref(root);
    ms_file_free(&bytes);
    return status;
}
