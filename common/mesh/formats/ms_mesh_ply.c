/* PLY, the Stanford polygon format: text and binary of both byte orders. */
#include "ms_mesh_ply.h"

#include <math.h>
#include <string.h>

#include "ms_mesh_formats.h"

/* The rows of a file, one value after the other. */
typedef struct source {
    ms_ply_encoding encoding;
    ms_text text; /* `at` serves binary files too */
} source;

static size_t place_of(const source *from, const ms_bytes *bytes)
{
    if (from->encoding == MS_PLY_ASCII) {
        return from->text.line;
    }
    return (size_t)(from->text.at - (const char *)bytes->data);
}

static uint64_t load_bits(const source *from, size_t size)
{
    uint64_t bits = 0;
    for (size_t i = 0; i < size; i++) {
        size_t k = from->encoding == MS_PLY_BIG_ENDIAN ? i : size - 1 - i;
        bits = bits << 8 | (uint8_t)from->text.at[k];
    }
    return bits;
}

static double bits_to_double(uint64_t bits, ms_ply_type type)
{
    double wide;
    float narrow;
    uint32_t half = (uint32_t)bits;
    switch (type) {
    case MS_PLY_INT8:
        return (double)(int8_t)(uint8_t)bits;
    case MS_PLY_INT16:
        return (double)(int16_t)(uint16_t)bits;
    case MS_PLY_INT32:
        return (double)(int32_t)half;
    case MS_PLY_FLOAT32:
        memcpy(&narrow, &half, sizeof narrow);
        return (double)narrow;
    case MS_PLY_FLOAT64:
        memcpy(&wide, &bits, sizeof wide);
        return wide;
    default:
        return (double)half;
    }
}

/* Every type of PLY fits into a double exactly. */
static ms_status next_value(double *value, source *from, ms_ply_type type, const ms_bytes *bytes, ms_error *err)
{
    if (from->encoding == MS_PLY_ASCII) {
        return ms_text_doubles(value, 1, &from->text, "a row", err);
    }
    size_t size = ms_mesh_ply_type_size(type);
    if ((size_t)(from->text.end - from->text.at) < size) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: byte %zu: the file is cut inside its rows; fetch or export it again",
                       from->text.name, place_of(from, bytes));
    }
    *value = bits_to_double(load_bits(from, size), type);
    from->text.at += size;
    return MS_OK;
}

static ms_status next_whole(int64_t *whole, source *from, ms_ply_type type, const ms_bytes *bytes, ms_error *err)
{
    double value = 0.0;
    size_t place = place_of(from, bytes);
    ms_status status = next_value(&value, from, type, bytes, err);
    /* The negation also catches nan. */
    if (!status && !(value >= -4294967296.0 && value <= 4294967296.0 && value == floor(value))) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: %s %zu: %g is no index or length; export the mesh again",
                       from->text.name, from->encoding == MS_PLY_ASCII ? "line" : "byte", place, value);
    }
    *whole = status ? 0 : (int64_t)value;
    return status;
}

/* A list: its corners go into the face under way, others are passed over. */
static ms_status parse_list(ms_mesh_builder *builder, source *from, const ms_ply_property *property,
                            const ms_bytes *bytes, ms_error *err)
{
    int64_t length = 0;
    size_t place = place_of(from, bytes);
    ms_status status = next_whole(&length, from, property->count_type, bytes, err);
    if (!status && length < 0) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: %s %zu: a list has the length %lld; export the mesh again",
                       from->text.name, builder->place_word, place, (long long)length);
    }
    for (int64_t i = 0; i < length && !status; i++) {
        double ignored;
        int64_t corner = 0;
        if (property->role == MS_PLY_IGNORED) {
            status = next_value(&ignored, from, property->type, bytes, err);
            continue;
        }
        status = next_whole(&corner, from, property->type, bytes, err);
        if (!status) {
            status = property->role == MS_PLY_STRIP ? ms_mesh_build_strip_corner(builder, corner, err)
                                                    : ms_mesh_build_face_corner(builder, corner, err);
        }
    }
    return status;
}

/* One row; `position` takes the values whose role is x, y or z. */
static ms_status parse_properties(double position[3], ms_mesh_builder *builder, source *from,
                                  const ms_ply_header *header, const ms_ply_element *element, const ms_bytes *bytes,
                                  ms_error *err)
{
    ms_status status = MS_OK;
    for (size_t i = 0; i < element->n_properties && !status; i++) {
        const ms_ply_property *property = &header->property[element->first + i];
        double value = 0.0;
        if (property->count_type) {
            status = parse_list(builder, from, property, bytes, err);
            continue;
        }
        status = next_value(&value, from, property->type, bytes, err);
        if (property->role != MS_PLY_IGNORED) {
            position[property->role - MS_PLY_X] = value;
        }
    }
    return status;
}

static ms_status parse_element(ms_mesh_builder *builder, source *from, const ms_ply_header *header,
                               const ms_ply_element *element, const ms_bytes *bytes, ms_error *err)
{
    ms_status status = MS_OK;
    for (size_t row = 0; row < element->count && !status; row++) {
        double position[3] = {0.0, 0.0, 0.0};
        if (from->encoding == MS_PLY_ASCII && !ms_text_seek(&from->text)) {
            return ms_text_fail(err, &from->text, "the file ends after %zu of %zu rows", row, element->count);
        }
        size_t place = place_of(from, bytes);
        ms_mesh_build_face_begin(builder, place);
        status = parse_properties(position, builder, from, header, element, bytes, err);
        if (!status && from->encoding == MS_PLY_ASCII) {
            status = ms_text_end_line(&from->text, err);
        }
        if (!status && element->kind == MS_PLY_VERTEX) {
            status = ms_mesh_build_vertex(builder, position, place, err);
        } else if (!status && element->kind == MS_PLY_FACE) {
            status = ms_mesh_build_face_end(builder, err);
        } else if (!status && element->kind == MS_PLY_STRIPS) {
            status = ms_mesh_build_strip_end(builder, err);
        }
    }
    return status;
}

static ms_status check_end(ms_mesh_builder *builder, source *from, const ms_bytes *bytes, ms_error *err)
{
    if (from->encoding == MS_PLY_ASCII) {
        return ms_text_seek(&from->text) ? ms_text_fail(err, &from->text, "more follows after the last row") : MS_OK;
    }
    const size_t place = place_of(from, bytes), left = (size_t)(from->text.end - from->text.at);
    if (!ms_mesh_build_is_padding((const uint8_t *)from->text.at, left)) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: byte %zu: %zu bytes follow after the last row; export the mesh again",
                       from->text.name, place, left);
    }
    if (left > 0) {
        ms_mesh_build_remark(builder, "%s: %zu bytes behind its last row were passed over", builder->name, left);
    }
    return MS_OK;
}

static ms_status parse_rows(ms_mesh_builder *builder, source *from, const ms_ply_header *header, const ms_bytes *bytes,
                            ms_error *err)
{
    ms_status status = MS_OK;
    for (size_t i = 0; i < header->n_elements && !status; i++) {
        const ms_ply_element *element = &header->element[i];
        if (element->kind == MS_PLY_VERTEX) {
            status = ms_mesh_build_reserve(builder, element->count, 0, err);
        } else if (element->kind == MS_PLY_FACE) {
            status = ms_mesh_build_reserve(builder, 0, element->count, err);
        } else if (element->kind == MS_PLY_STRIPS && element->count > 0) {
            ms_mesh_build_remark(builder, "%s: its triangle strips were read as triangles", builder->name);
        }
        if (!status) {
            status = parse_element(builder, from, header, element, bytes, err);
        }
    }
    return status ? status : check_end(builder, from, bytes, err);
}

ms_status ms_mesh_parse_ply(ms_mesh *mesh, ms_error *remark, const ms_bytes *bytes, const char *name, ms_error *err)
{
    ms_ply_header header;
    source from;
    ms_mesh_builder builder = {.name = name};
    ms_text_start(&from.text, bytes, name);
    ms_status status = ms_mesh_ply_parse_header(&header, &from.text, err);
    if (!status) {
        from.encoding = header.encoding;
        builder.place_word = header.encoding == MS_PLY_ASCII ? "line" : "byte";
        status = parse_rows(&builder, &from, &header, bytes, err);
    }
    return ms_mesh_build_finish(mesh, remark, &builder, status, err);
}
