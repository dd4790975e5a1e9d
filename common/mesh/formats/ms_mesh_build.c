/* A mesh as the readers build it: polygons, checks and welding. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/ms_mesh_polygon.h"
#include "ms_mesh_formats.h"

#define MAX_TRIANGLES (UINT64_C(1) << 31)
#define MAX_VERTICES ((uint64_t)UINT32_MAX)

static ms_status grow_array(void **array, size_t *room, size_t wanted, size_t item_size, const char *name,
                            ms_error *err)
{
    if (wanted <= *room) {
        return MS_OK;
    }
    void *larger = wanted > SIZE_MAX / item_size ? NULL : realloc(*array, wanted * item_size);
    if (!larger) {
        return ms_fail(err, MS_ERR_NOMEM, "%s: no memory for its mesh", name);
    }
    *array = larger;
    *room = wanted;
    return MS_OK;
}

static ms_status grow_vertices(ms_mesh_builder *builder, size_t wanted, ms_error *err)
{
    void *array = builder->mesh.vertex;
    if (wanted > MAX_VERTICES) {
        return ms_fail(err, MS_ERR_LIMIT, "%s: has more than %llu vertices; make the mesh coarser", builder->name,
                       (unsigned long long)MAX_VERTICES);
    }
    ms_status status =
        grow_array(&array, &builder->vertex_room, wanted, sizeof *builder->mesh.vertex, builder->name, err);
    builder->mesh.vertex = array;
    return status;
}

static ms_status grow_triangles(ms_mesh_builder *builder, size_t wanted, ms_error *err)
{
    void *array = builder->mesh.triangle;
    if (wanted > MAX_TRIANGLES) {
        return ms_fail(err, MS_ERR_LIMIT, "%s: has more than %llu triangles; make the mesh coarser", builder->name,
                       (unsigned long long)MAX_TRIANGLES);
    }
    ms_status status =
        grow_array(&array, &builder->triangle_room, wanted, sizeof *builder->mesh.triangle, builder->name, err);
    builder->mesh.triangle = array;
    return status;
}

ms_status ms_mesh_build_reserve(ms_mesh_builder *builder, size_t n_vertices, size_t n_triangles, ms_error *err)
{
    ms_status status = grow_vertices(builder, n_vertices, err);
    return status ? status : grow_triangles(builder, n_triangles, err);
}

/* Doubled, so that appending n items moves O(n) of them; up to the limit. */
static size_t next_room(size_t room, uint64_t limit)
{
    uint64_t doubled = room < 512 ? 1024 : 2 * (uint64_t)room;
    return (size_t)(doubled <= limit || room >= limit ? doubled : limit);
}

ms_status ms_mesh_build_vertex(ms_mesh_builder *builder, const double position[3], size_t place, ms_error *err)
{
    ms_mesh *mesh = &builder->mesh;
    if (mesh->n_vertices == builder->vertex_room) {
        ms_status status = grow_vertices(builder, next_room(builder->vertex_room, MAX_VERTICES), err);
        if (status) {
            return status;
        }
    }
    if (!isfinite(position[0]) || !isfinite(position[1]) || !isfinite(position[2])) {
        if (builder->n_not_finite++ == 0) {
            builder->first_not_finite = place;
        }
    }
    memcpy(mesh->vertex[mesh->n_vertices++], position, sizeof mesh->vertex[0]);
    return MS_OK;
}

void ms_mesh_build_face_begin(ms_mesh_builder *builder, size_t place)
{
    builder->n_corners = 0;
    builder->place = place;
}

static ms_status append_triangle(ms_mesh_builder *builder, uint32_t third, ms_error *err)
{
    ms_mesh *mesh = &builder->mesh;
    if (mesh->n_triangles == builder->triangle_room) {
        ms_status status = grow_triangles(builder, next_room(builder->triangle_room, MAX_TRIANGLES), err);
        if (status) {
            return status;
        }
    }
    uint32_t *corner = mesh->triangle[mesh->n_triangles++];
    corner[0] = builder->fan[0];
    corner[1] = builder->fan[1];
    corner[2] = third;
    return MS_OK;
}

static ms_status fail_index(ms_mesh_builder *builder, int64_t index, size_t place, ms_error *err)
{
    return ms_fail(
        err, MS_ERR_FORMAT,
        "%s: %s %zu: the face names vertex %lld but the file has vertices %lld to %lld; export the mesh again",
        builder->name, builder->place_word, place, (long long)(index + builder->first_index),
        (long long)builder->first_index, (long long)builder->mesh.n_vertices - 1 + builder->first_index);
}

/* Takes note of an index, which may be that of a vertex to come. */
static ms_status check_index(uint32_t *corner, ms_mesh_builder *builder, int64_t index, ms_error *err)
{
    *corner = (uint32_t)index;
    if (index < 0 || index >= (int64_t)MAX_VERTICES) {
        return fail_index(builder, index, builder->place, err);
    }
    if (*corner > builder->largest || builder->largest_place == 0) {
        builder->largest = *corner;
        builder->largest_place = builder->place;
    }
    return MS_OK;
}

ms_status ms_mesh_build_face_corner(ms_mesh_builder *builder, int64_t index, ms_error *err)
{
    uint32_t corner;
    ms_status status = check_index(&corner, builder, index, err);
    if (!status && builder->n_corners >= 2) {
        status = append_triangle(builder, corner, err);
    }
    builder->fan[builder->n_corners > 0] = corner;
    builder->n_corners++;
    return status;
}

/* Its corners may come later in the file: how to cut it is decided at the end. */
static ms_status append_polygon(ms_mesh_builder *builder, ms_error *err)
{
    if (builder->n_polygons == builder->polygon_room) {
        void *array = builder->polygon;
        ms_status status = grow_array(&array, &builder->polygon_room, next_room(builder->polygon_room, MAX_TRIANGLES),
                                      sizeof *builder->polygon, builder->name, err);
        builder->polygon = array;
        if (status) {
            return status;
        }
    }
    const size_t n = builder->n_corners - 2;
    builder->polygon[builder->n_polygons++] =
        (ms_mesh_fan){.first = builder->mesh.n_triangles - n, .n = n, .place = builder->place};
    return MS_OK;
}

ms_status ms_mesh_build_face_end(ms_mesh_builder *builder, ms_error *err)
{
    if (builder->n_corners < 3) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: %s %zu: a face has %zu corners and needs at least 3; remove it",
                       builder->name, builder->place_word, builder->place, builder->n_corners);
    }
    return builder->n_corners > 3 ? append_polygon(builder, err) : MS_OK;
}

ms_status ms_mesh_build_strip_end(const ms_mesh_builder *builder, ms_error *err)
{
    if (builder->n_corners == 1 || builder->n_corners == 2) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: %s %zu: a strip has %zu corners and needs at least 3; remove it",
                       builder->name, builder->place_word, builder->place, builder->n_corners);
    }
    return MS_OK;
}

ms_status ms_mesh_build_strip_corner(ms_mesh_builder *builder, int64_t index, ms_error *err)
{
    uint32_t corner, *fan = builder->fan;
    if (index < 0) {
        const ms_status status = ms_mesh_build_strip_end(builder, err);
        builder->n_corners = 0;
        return status;
    }
    ms_status status = check_index(&corner, builder, index, err);
    if (!status && builder->n_corners >= 2 && corner != fan[0] && corner != fan[1] && fan[0] != fan[1]) {
        status = append_triangle(builder, corner, err);
    }
    /* v0 v1 v2, then v2 v1 v3, then v2 v3 v4: every other one the other way round. */
    fan[builder->n_corners++ % 2] = corner;
    return status;
}

void ms_mesh_build_remark(ms_mesh_builder *builder, const char *format, ...)
{
    if (builder->n_remarks++ == 0) {
        va_list args;
        va_start(args, format);
        vsnprintf(builder->remark.text, sizeof builder->remark.text, format, args);
        va_end(args);
    }
}

int ms_mesh_build_is_padding(const uint8_t *bytes, size_t size)
{
    size_t i = 0;
    while (i < size && memchr(" \t\r\n", bytes[i], 5)) { /* and the 0 behind them */
        i++;
    }
    return i == size;
}

static size_t count_not_finite_triangles(const ms_mesh *mesh)
{
    size_t n = 0;
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        int finite = 1;
        for (int k = 0; k < 3; k++) {
            const double *p = mesh->vertex[mesh->triangle[t][k]];
            finite = finite && isfinite(p[0]) && isfinite(p[1]) && isfinite(p[2]);
        }
        n += !finite;
    }
    return n;
}

static ms_status check_mesh(ms_mesh_builder *builder, ms_error *err)
{
    const ms_mesh *mesh = &builder->mesh;
    if (mesh->n_triangles == 0) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: has no triangles (and %zu vertices); export the surface of the body",
                       builder->name, mesh->n_vertices);
    }
    if (builder->largest >= mesh->n_vertices) {
        return fail_index(builder, builder->largest, builder->largest_place, err);
    }
    if (builder->n_not_finite > 0) {
        return ms_fail(err, MS_ERR_FORMAT,
                       "%s: %zu of %zu triangles have a corner that is not finite (inf or nan), %s %zu is the first; "
                       "export the mesh again",
                       builder->name, count_not_finite_triangles(mesh), mesh->n_triangles, builder->place_word,
                       builder->first_not_finite);
    }
    return MS_OK;
}

static ms_status cut_polygons(ms_mesh_builder *builder, ms_error *err)
{
    ms_status status = MS_OK;
    ms_error cause;
    ms_polygon_work work = {0};
    const ms_mesh *mesh = &builder->mesh;
    for (size_t k = 0; k < builder->n_polygons && !status; k++) {
        const ms_mesh_fan *polygon = &builder->polygon[k];
        status = ms_mesh_polygon_cut(mesh->triangle + polygon->first, polygon->n, (const double(*)[3])mesh->vertex,
                                     &work, &cause);
        if (status) {
            ms_fail(err, status, "%s: %s %zu: %s", builder->name, builder->place_word, polygon->place, cause.text);
        }
    }
    ms_mesh_polygon_free(&work);
    return status;
}

static uint64_t hash_position(const double position[3])
{
    uint64_t bits[3];
    uint64_t hash = UINT64_C(0x9E3779B97F4A7C15);
    memcpy(bits, position, sizeof bits);
    for (int k = 0; k < 3; k++) {
        hash = (hash ^ bits[k]) * UINT64_C(0xFF51AFD7ED558CCD);
        hash ^= hash >> 32;
    }
    return hash;
}

/* A slot of the hash table holds 1 + the index of a vertex, or 0. */
static uint32_t find_or_add(ms_mesh *welded, const double position[3], uint32_t *table, size_t mask)
{
    size_t slot = (size_t)hash_position(position) & mask;
    while (table[slot] != 0) {
        if (memcmp(welded->vertex[table[slot] - 1], position, 3 * sizeof(double)) == 0) {
            return table[slot] - 1;
        }
        slot = (slot + 1) & mask;
    }
    /* Never behind the vertex that is being read: the array is packed in place. */
    memmove(welded->vertex[welded->n_vertices], position, 3 * sizeof(double));
    table[slot] = (uint32_t)++welded->n_vertices;
    return table[slot] - 1;
}

/* `new_index` has one item per vertex of the file; it comes in nonzero where a triangle uses the vertex. */
static void weld_vertices(ms_mesh *mesh, uint32_t *new_index, uint32_t *table, size_t mask)
{
    size_t n = mesh->n_vertices;
    mesh->n_vertices = 0;
    for (size_t i = 0; i < n; i++) {
        if (new_index[i]) {
            /* Adding 0 turns -0 into 0, so that equal numbers have equal bits. */
            double position[3] = {mesh->vertex[i][0] + 0.0, mesh->vertex[i][1] + 0.0, mesh->vertex[i][2] + 0.0};
            new_index[i] = find_or_add(mesh, position, table, mask);
        }
    }
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        for (int k = 0; k < 3; k++) {
            mesh->triangle[t][k] = new_index[mesh->triangle[t][k]];
        }
    }
}

static ms_status weld_mesh(ms_mesh *mesh, const char *name, ms_error *err)
{
    ms_status status = MS_OK;
    size_t slots = 64;
    while (slots < SIZE_MAX / 8 && slots / 2 < mesh->n_vertices) {
        slots *= 2;
    }
    uint32_t *table = calloc(slots, sizeof *table);
    uint32_t *new_index = calloc(mesh->n_vertices, sizeof *new_index);
    if (!table || !new_index) {
        status = ms_fail(err, MS_ERR_NOMEM, "%s: no memory to weld its %zu vertices", name, mesh->n_vertices);
        goto cleanup;
    }
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        for (int k = 0; k < 3; k++) {
            new_index[mesh->triangle[t][k]] = 1;
        }
    }
    weld_vertices(mesh, new_index, table, slots - 1);
cleanup:
    free(table);
    free(new_index);
    return status;
}

/* Gives back what the arrays have too much; a failure to do so loses nothing. */
static void trim_arrays(ms_mesh *mesh)
{
    void *vertex = realloc(mesh->vertex, mesh->n_vertices * sizeof *mesh->vertex);
    void *triangle = realloc(mesh->triangle, mesh->n_triangles * sizeof *mesh->triangle);
    mesh->vertex = vertex ? vertex : mesh->vertex;
    mesh->triangle = triangle ? triangle : mesh->triangle;
}

/* What is told of the remarks to who listens. */
static void pass_on_remark(ms_error *remark, const ms_mesh_builder *builder)
{
    if (builder->n_remarks > 1) {
        snprintf(remark->text, sizeof remark->text, "%.900s (the first of %zu such places)", builder->remark.text,
                 builder->n_remarks);
    } else {
        *remark = builder->remark;
    }
}

ms_status ms_mesh_build_finish(ms_mesh *mesh, ms_error *remark, ms_mesh_builder *builder, ms_status status,
                               ms_error *err)
{
    *mesh = (ms_mesh){0};
    if (remark) {
        pass_on_remark(remark, builder);
    }
    if (!status) {
        status = check_mesh(builder, err);
    }
    if (!status) {
        status = cut_polygons(builder, err);
    }
    if (!status) {
        status = weld_mesh(&builder->mesh, builder->name, err);
    }
    if (status) {
        ms_mesh_free(&builder->mesh);
    } else {
        trim_arrays(&builder->mesh);
        *mesh = builder->mesh;
    }
    free(builder->polygon);
    *builder = (ms_mesh_builder){0};
    return status;
}
