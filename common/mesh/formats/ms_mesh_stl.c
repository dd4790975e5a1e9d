/* STL, the format of 3D Systems 1989: ASCII and binary. Normals and attributes are ignored. */
#include <string.h>

#include "base/ms_text.h"
#include "ms_mesh_formats.h"

#define HEADER_SIZE 84 /* a comment of 80 bytes and the number of triangles */
#define RECORD_SIZE 50 /* normal and corners as float32, and 2 bytes of attributes */

static uint32_t load_u32(const uint8_t *at)
{
    return (uint32_t)at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

static double load_f32(const uint8_t *at)
{
    uint32_t bits = load_u32(at);
    float value;
    memcpy(&value, &bits, sizeof value);
    return (double)value;
}

/* One triangle from the latest three vertices. */
static ms_status add_facet(ms_mesh_builder *builder, size_t place, ms_error *err)
{
    ms_status status = MS_OK;
    int64_t first = (int64_t)builder->mesh.n_vertices - 3;
    ms_mesh_build_face_begin(builder, place);
    for (int64_t k = 0; k < 3 && !status; k++) {
        status = ms_mesh_build_face_corner(builder, first + k, err);
    }
    return status ? status : ms_mesh_build_face_end(builder, err);
}

/* A file may end with less than a further triangle, or with padding: of more there is no telling what it is. */
static ms_status check_stl_size(ms_mesh_builder *builder, const ms_bytes *bytes, uint32_t count, ms_error *err)
{
    const char *name = builder->name;
    const uint64_t size = bytes->size, wanted = HEADER_SIZE + (uint64_t)count * RECORD_SIZE;
    if (size < wanted) {
        return ms_fail(
            err, MS_ERR_FORMAT,
            "%s: binary STL cut after %llu of %lu triangles: its header claims %llu bytes and the file has %llu; "
            "fetch or export it again",
            name, (unsigned long long)((size - HEADER_SIZE) / RECORD_SIZE), (unsigned long)count,
            (unsigned long long)wanted, (unsigned long long)size);
    }
    if (size - wanted >= RECORD_SIZE && !ms_mesh_build_is_padding(bytes->data + wanted, (size_t)(size - wanted))) {
        return ms_fail(
            err, MS_ERR_FORMAT,
            "%s: binary STL whose header claims %lu triangles (%llu bytes) has %llu bytes more behind byte %llu; "
            "export it again",
            name, (unsigned long)count, (unsigned long long)wanted, (unsigned long long)(size - wanted),
            (unsigned long long)wanted);
    }
    if (size > wanted) {
        ms_mesh_build_remark(builder, "%s: %llu bytes behind the last of its %lu triangles were passed over", name,
                             (unsigned long long)(size - wanted), (unsigned long)count);
    }
    return MS_OK;
}

static ms_status parse_binary_stl(ms_mesh_builder *builder, const ms_bytes *bytes, ms_error *err)
{
    builder->place_word = "byte";
    uint32_t count = load_u32(bytes->data + HEADER_SIZE - 4);
    ms_status status = check_stl_size(builder, bytes, count, err);
    if (!status) {
        status = ms_mesh_build_reserve(builder, 3 * (size_t)count, count, err);
    }
    for (size_t t = 0; t < count && !status; t++) {
        size_t place = HEADER_SIZE + t * RECORD_SIZE;
        for (size_t k = 0; k < 3 && !status; k++) {
            const uint8_t *corner = bytes->data + place + 12 + 12 * k;
            double position[3] = {load_f32(corner), load_f32(corner + 4), load_f32(corner + 8)};
            status = ms_mesh_build_vertex(builder, position, place + 12 + 12 * k, err);
        }
        if (!status) {
            status = add_facet(builder, place, err);
        }
    }
    return status;
}

/* Over line ends to the next word, which must be the expected one. */
static ms_status expect_word(ms_text *text, const char *expected, ms_error *err)
{
    ms_word word;
    if (!ms_text_seek(text)) {
        return ms_text_fail(err, text, "the file ends where '%s' belongs", expected);
    }
    ms_text_word(&word, text);
    if (!ms_text_word_is(&word, expected)) {
        return ms_text_fail(err, text, "'%s' stands where '%s' belongs", ms_text_quote(&word).text, expected);
    }
    return MS_OK;
}

/* Nonzero if the word, with one more where it is `end` alone, is "end" and `what`. */
static int is_end_of(ms_mesh_builder *builder, const ms_word *word, const char *what, ms_text *text)
{
    ms_text ahead = *text;
    ms_word second;
    if (word->length == 3 + strlen(what) && ms_text_word_is(&(ms_word){word->start, 3}, "end")) {
        return ms_text_word_is(&(ms_word){word->start + 3, word->length - 3}, what);
    }
    if (!ms_text_word_is(word, "end") || !ms_text_word(&second, &ahead) || !ms_text_word_is(&second, what)) {
        return 0;
    }
    *text = ahead;
    ms_mesh_build_remark(builder, "%s: line %zu: 'end %s' was read as 'end%s'", builder->name, text->line, what, what);
    return 1;
}

/* Over line ends to the next word, which must be the end of `what`. */
static ms_status expect_end(ms_mesh_builder *builder, ms_text *text, const char *what, ms_error *err)
{
    ms_word word;
    if (!ms_text_seek(text)) {
        return ms_text_fail(err, text, "the file ends where 'end%s' belongs", what);
    }
    ms_text_word(&word, text);
    return is_end_of(builder, &word, what, text)
               ? MS_OK
               : ms_text_fail(err, text, "'%s' stands where 'end%s' belongs", ms_text_quote(&word).text, what);
}

static ms_status expect_two(ms_text *text, const char *first, const char *second, ms_error *err)
{
    ms_status status = expect_word(text, first, err);
    return status ? status : expect_word(text, second, err);
}

/* What stands between "facet" and "endfacet". */
static ms_status parse_facet(ms_mesh_builder *builder, ms_text *text, ms_error *err)
{
    double numbers[3];
    size_t place = text->line;
    ms_status status = expect_word(text, "normal", err);
    if (!status) {
        status = ms_text_doubles(numbers, 3, text, "a normal", err);
    }
    if (!status) {
        status = expect_two(text, "outer", "loop", err);
    }
    for (int k = 0; k < 3 && !status; k++) {
        status = expect_word(text, "vertex", err);
        if (!status) {
            status = ms_text_doubles(numbers, 3, text, "a vertex", err);
        }
        if (!status) {
            status = ms_mesh_build_vertex(builder, numbers, text->line, err);
        }
    }
    if (!status) {
        status = expect_end(builder, text, "loop", err);
    }
    if (!status) {
        status = expect_end(builder, text, "facet", err);
    }
    return status ? status : add_facet(builder, place, err);
}

/* A file without its last line; if more is lost, what is left is open. */
static ms_status end_early(ms_mesh_builder *builder, const ms_text *text, ms_error *err)
{
    const size_t n = builder->mesh.n_triangles;
    if (n == 0) {
        return ms_text_fail(err, text, "the file ends without 'endsolid' after 0 triangles");
    }
    ms_mesh_build_remark(builder, "%s: line %zu: the file ends without 'endsolid' after %zu triangles; it may be cut",
                         builder->name, text->line, n);
    return MS_OK;
}

/* What follows "solid": its name, facets, "endsolid" and a name again. */
static ms_status parse_solid(ms_mesh_builder *builder, ms_text *text, ms_error *err)
{
    ms_text_skip_line(text);
    for (;;) {
        ms_word word;
        if (!ms_text_seek(text)) {
            return end_early(builder, text, err);
        }
        ms_text_word(&word, text);
        if (is_end_of(builder, &word, "solid", text)) {
            ms_text_skip_line(text);
            return MS_OK;
        }
        if (!ms_text_word_is(&word, "facet")) {
            return ms_text_fail(err, text, "'%s' stands where 'facet' or 'endsolid' belongs",
                                ms_text_quote(&word).text);
        }
        ms_status status = parse_facet(builder, text, err);
        if (status) {
            return status;
        }
    }
}

static ms_status parse_ascii(ms_mesh_builder *builder, ms_text *text, ms_error *err)
{
    ms_status status = MS_OK;
    while (!status && ms_text_seek(text)) {
        status = expect_word(text, "solid", err);
        if (!status) {
            status = parse_solid(builder, text, err);
        }
    }
    return status;
}

static int begins_with_solid(const ms_text *start)
{
    ms_text text = *start;
    ms_word word;
    return ms_text_seek(&text) && ms_text_word(&word, &text) && ms_text_word_is(&word, "solid");
}

ms_status ms_mesh_parse_stl(ms_mesh *mesh, ms_error *remark, const ms_bytes *bytes, const char *name, ms_error *err)
{
    ms_status status;
    ms_text text;
    ms_mesh_builder builder = {.name = name, .place_word = "line"};
    ms_text_start(&text, bytes, name);
    /* Binary headers may begin with "solid" too; text has no 0 byte and the first binary numbers nearly always do. */
    size_t looked_at = bytes->size < 512 ? bytes->size : 512;
    int is_text = begins_with_solid(&text) && !memchr(bytes->data, 0, looked_at);
    int has_header = bytes->size >= HEADER_SIZE;
    if (has_header) {
        uint64_t wanted = HEADER_SIZE + (uint64_t)load_u32(bytes->data + HEADER_SIZE - 4) * RECORD_SIZE;
        is_text = is_text && bytes->size != wanted;
    }
    if (is_text) {
        status = parse_ascii(&builder, &text, err);
    } else if (has_header) {
        status = parse_binary_stl(&builder, bytes, err);
    } else {
        status = ms_fail(
            err, MS_ERR_FORMAT,
            "%s: is no STL: it does not begin with 'solid' and its %zu bytes are too few for a binary header of %d; "
            "export the mesh again",
            name, bytes->size, HEADER_SIZE);
    }
    return ms_mesh_build_finish(mesh, remark, &builder, status, err);
}
