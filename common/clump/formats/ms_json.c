/* The JSON of a clump, of its particle, and of the frame beside a template. */
#include "ms_json.h"

#include <string.h>

#include "base/ms_version.h"
#include "ms_columns.h"
#include "ms_fields.h"
#include "ms_formats.h"

/* Reads n numbers; returns 0 if the value is no list that begins with as many. */
static int take_number_list(double *out, size_t n, const json_t *list)
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

static ms_status take_particle(ms_particle *particle, const json_t *json, const char *name, ms_error *err)
{
    ms_particle p = {0};
    ms_error cause;
    const json_t *rows = json_object_get(json, "inertia");
    int whole = take_number(&p.scale, json, "scale") && take_number(&p.density, json, "density") &&
                take_number(&p.mass, json, "mass") && take_number_list(p.centre, 3, json_object_get(json, "centre"));
    for (size_t k = 0; k < 3; k++) {
        whole = whole && take_number_list(p.inertia[k], 3, json_array_get(rows, k)) && p.inertia[k][k] > 0;
    }
    if (!whole || !(p.scale > 0) || !(p.mass > 0) || !(p.density >= 0)) {
        memset(particle, 0, sizeof *particle);
        return ms_fail(err, MS_ERR_FORMAT,
                       "%s: its particle has not all of scale, density, mass, centre and inertia as numbers of their "
                       "ranges; write it again with mskit correct",
                       name);
    }
    if (ms_particle_check(&p, &cause) != MS_OK) {
        memset(particle, 0, sizeof *particle);
        return ms_fail(err, MS_ERR_FORMAT, "%s: %s", name, cause.text);
    }
    *particle = p;
    return MS_OK;
}

/*
 * Parses a text twice and takes it if both readings are alike: jansson (2.14) drops a character of a word that it
 * has no memory for, and goes on. NULL if it is no JSON, as `where` tells, or without memory.
 */
static json_t *parse_text(const char *text, size_t size, json_error_t *where)
{
    json_t *first = json_loadb(text, size, 0, where), *second = first ? json_loadb(text, size, 0, where) : NULL;
    if (first && second && !json_equal(first, second)) {
        json_decref(second);
        second = NULL;
        snprintf(where->text, sizeof where->text, "no memory to parse it");
    }
    json_decref(first);
    return second;
}

static ms_status parse_root(json_t **root, const ms_bytes *bytes, const char *name, ms_error *err)
{
    json_error_t where;
    *root = parse_text((const char *)bytes->data, bytes->size, &where);
    return *root ? MS_OK
                 : ms_fail(err, MS_ERR_FORMAT, "%s: line %d: %s; this is no JSON", name, where.line, where.text);
}

/* What the columns are called, where the file says it. */
static ms_status take_columns(ms_columns *columns, const json_t *root, const char *name, ms_error *err)
{
    const json_t *list = json_object_get(root, "columns");
    ms_word word[MS_COLUMNS_MOST];
    ms_error cause;
    size_t n = 0;
    for (; n < json_array_size(list) && n < MS_COLUMNS_MOST; n++) {
        const char *text = json_string_value(json_array_get(list, n));
        word[n] = (ms_word){text ? text : "", text ? strlen(text) : 0};
    }
    if (list && n < 4) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: its 'columns' are no list that begins with x, y, z, r", name);
    }
    const ms_status status = ms_columns_read(columns, word, n, &cause);
    return status == MS_OK ? MS_OK : ms_fail(err, status, "%s: 'columns': %s", name, cause.text);
}

static ms_status take_list(ms_clump *clump, const json_t *list, int are_carriers, size_t columns, const char *name,
                           ms_error *err)
{
    ms_status status = MS_OK;
    double v[5];
    for (size_t s = 0; s < json_array_size(list) && status == MS_OK; s++) {
        status = take_number_list(v, columns, json_array_get(list, s))
                     ? ms_fields_add_sphere(clump, are_carriers, v, name, err)
                     : ms_fail(err, MS_ERR_FORMAT, "%s: %s %zu is no list of %zu numbers", name,
                               are_carriers ? "carrier" : "sphere", s + 1, columns);
    }
    return status;
}

static ms_status take_spheres(ms_clump *clump, const json_t *root, const char *name, ms_error *err)
{
    const json_t *list = json_object_get(root, "spheres"), *carriers = json_object_get(root, "carriers");
    ms_columns named = {0};
    double v[5];
    ms_status status = take_columns(&named, root, name, err);
    const size_t columns = named.mass ? 5 : 4;
    if (status == MS_OK && json_array_size(list) == 0) {
        status = ms_fail(err, MS_ERR_FORMAT, "%s: holds no list 'spheres'", name);
    }
    if (status == MS_OK && columns == 4 && json_array_size(carriers) > 0) {
        status = ms_fail(err, MS_ERR_FORMAT, "%s: has carriers, but 'columns' tells of no masses", name);
    }
    if (status == MS_OK) {
        status = take_list(clump, list, 0, columns, name, err);
    }
    if (status == MS_OK) {
        status = take_list(clump, carriers, 1, columns, name, err);
    }
    if (status == MS_OK && columns == 5) {
        status = ms_clump_alloc_masses(clump, err);
        for (size_t s = 0; s < ms_clump_count_masses(clump) && status == MS_OK; s++) {
            const int is_carrier = s >= clump->n_spheres;
            take_number_list(v, 5, json_array_get(is_carrier ? carriers : list, s - is_carrier * clump->n_spheres));
            clump->mass[s] = v[4];
        }
    }
    return status;
}

ms_status ms_json_read(ms_clump *clump, ms_particle *particle, ms_bytes *bytes, const char *name, ms_error *err)
{
    json_t *root;
    ms_status status = parse_root(&root, bytes, name, err);
    if (status == MS_OK) {
        status = take_spheres(clump, root, name, err);
    }
    if (status == MS_OK && json_object_get(root, "particle")) {
        status = take_particle(particle, json_object_get(root, "particle"), name, err);
    }
    json_decref(root);
    return status;
}

ms_status ms_json_read_particle(ms_particle *particle, const ms_bytes *bytes, const char *name, ms_error *err)
{
    json_t *root;
    memset(particle, 0, sizeof *particle);
    ms_status status = parse_root(&root, bytes, name, err);
    if (status == MS_OK) {
        status = take_particle(particle, json_object_get(root, "particle"), name, err);
    }
    json_decref(root);
    return status;
}

static json_t *vector_to_json(const double v[3])
{
    return json_pack("[f,f,f]", v[0], v[1], v[2]);
}

static json_t *matrix_to_json(double m[3][3])
{
    return json_pack("[o,o,o]", vector_to_json(m[0]), vector_to_json(m[1]), vector_to_json(m[2]));
}

json_t *ms_json_from_particle(const ms_particle *p)
{
    ms_principal principal;
    ms_body body = {.volume = 1};
    memcpy(body.inertia, p->inertia, sizeof body.inertia);
    if (ms_inertia_principal(&principal, &body, NULL) != MS_OK) {
        return NULL;
    }
    return json_pack("{s:f,s:f,s:f,s:o,s:o,s:o,s:o}", "scale", p->scale, "density", p->density, "mass", p->mass,
                     "centre", vector_to_json(p->centre), "inertia", matrix_to_json(body.inertia), "principal_moments",
                     vector_to_json(principal.moment), "principal_axes", matrix_to_json(principal.axis));
}

static json_t *columns_to_json(int masses)
{
    return masses ? json_pack("[s,s,s,s,s,s]", "x", "y", "z", "r", "mass", "density")
                  : json_pack("[s,s,s,s]", "x", "y", "z", "r");
}

static json_t *sphere_to_json(const ms_content *content, size_t s, int masses)
{
    const ms_sphere *b = &content->clump->sphere[s];
    const double *c = b->centre;
    return masses ? json_pack("[f,f,f,f,f,f]", c[0], c[1], c[2], b->radius, content->clump->mass[s],
                              ms_fields_density(content, s))
                  : json_pack("[f,f,f,f]", c[0], c[1], c[2], b->radius);
}

/* {"mskit": version, <the record>, "particle": {...}, "columns": [...], "spheres": [[x, y, z, r], ...]}, and "carriers"
 * likewise where there are any */
ms_status ms_json_write(FILE *stream, const ms_content *content, ms_error *err)
{
    const int masses = ms_fields_has_masses(content);
    json_t *root = json_pack("{s:s}", "mskit", MS_VERSION), *spheres = json_array(), *carriers = json_array();
    json_error_t where;
    json_t *how = content->record ? parse_text(content->record, strlen(content->record), &where) : json_object();
    int failed = !root || !how || json_object_update(root, how) != 0;
    if (content->particle) {
        failed |= json_object_set_new(root, "particle", ms_json_from_particle(content->particle)) != 0;
    }
    failed |= json_object_set_new(root, "columns", columns_to_json(masses)) != 0;
    for (size_t s = 0; s < ms_fields_count(content); s++) {
        json_t *list = s < content->clump->n_spheres ? spheres : carriers;
        failed |= json_array_append_new(list, sphere_to_json(content, s, masses)) != 0;
    }
    failed |= json_object_set_new(root, "spheres", spheres) != 0;
    if (json_array_size(carriers) > 0) {
        failed |= json_object_set(root, "carriers", carriers) != 0;
    }
    json_decref(carriers);
    failed = failed || json_dumpf(root, stream, JSON_INDENT(2)) != 0 || fputc('\n', stream) == EOF;
    json_decref(how);
    json_decref(root);
    return failed ? ms_fail(err, MS_ERR_IO, "the clump could not be written as JSON") : MS_OK;
}

/* {"mskit": version, "frame": in words, "particle": {...}}: the way from a template back to the shape. */
ms_status ms_json_write_frame(FILE *stream, const ms_content *content, ms_error *err)
{
    json_t *root = json_pack("{s:s,s:s,s:o*}", "mskit", MS_VERSION, "frame",
                             "shape = centre + (x axis0 + y axis1 + z axis2) / scale, for x, y, z of the template and "
                             "the rows of principal_axes",
                             "particle", ms_json_from_particle(content->particle));
    const int failed = !json_object_get(root, "particle") || json_dumpf(root, stream, JSON_INDENT(2)) != 0 ||
                       fputc('\n', stream) == EOF;
    json_decref(root);
    return failed ? ms_fail(err, MS_ERR_IO, "the frame of the template could not be written as JSON") : MS_OK;
}
