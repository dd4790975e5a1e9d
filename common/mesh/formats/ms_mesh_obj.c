/* Wavefront OBJ: vertices and polygons; what else a file holds (texture, normals, groups) is passed over. */
#include <string.h>

#include "base/ms_text.h"
#include "ms_mesh_formats.h"

/* x y z, then nothing, a weight, a colour, or a colour with opacity. */
static ms_status parse_obj_vertex(ms_mesh_builder *builder, ms_text *text, ms_error *err)
{
    double numbers[3];
    size_t place = text->line;
    size_t n_more = 0;
    ms_word word;
    ms_status status = ms_text_doubles(numbers, 3, text, "a vertex", err);
    while (!status && ms_text_word(&word, text)) {
        double ignored;
        if (!ms_text_to_double(&ignored, &word)) {
            return ms_text_fail(err, text, "a vertex has '%s' where a number belongs", ms_text_quote(&word).text);
        }
        n_more++;
    }
    if (!status && (n_more == 2 || n_more > 4)) {
        return ms_text_fail(err, text, "a vertex has %zu numbers; 3, 4, 6 or 7 are understood", 3 + n_more);
    }
    return status ? status : ms_mesh_build_vertex(builder, numbers, place, err);
}

/* The parts of i, i/t, i/t/n or i//n; of these only i is used. What some programs leave empty at the end, as in i// or
   i/t/, is noted. */
static int split_corner(int64_t *vertex, int *empty, const ms_word *word)
{
    const char *at = word->start;
    const char *end = at + word->length;
    for (int part = 0; part < 3; part++) {
        int64_t index = 0;
        const char *slash = memchr(at, '/', (size_t)(end - at));
        ms_word number = {at, (size_t)((slash ? slash : end) - at)};
        const int is_empty = part > 0 && number.length == 0;
        *empty |= is_empty && !slash;
        if (!is_empty && (!ms_text_to_integer(&index, &number) || index == 0)) {
            return 0;
        }
        if (part == 0) {
            *vertex = index;
        }
        if (!slash) {
            return 1;
        }
        at = slash + 1;
    }
    return 0;
}

static ms_status parse_obj_face(ms_mesh_builder *builder, ms_text *text, ms_error *err)
{
    ms_status status = MS_OK;
    ms_word word;
    ms_mesh_build_face_begin(builder, text->line);
    while (!status && ms_text_word(&word, text)) {
        int64_t index;
        int empty = 0;
        if (!split_corner(&index, &empty, &word)) {
            return ms_text_fail(err, text, "'%s' is no corner of a face", ms_text_quote(&word).text);
        }
        if (empty) {
            ms_mesh_build_remark(builder,
                                 "%s: line %zu: '%s' names a texture or normal and gives none; its vertex was read",
                                 builder->name, text->line, ms_text_quote(&word).text);
        }
        /* Negative ones count back from the latest vertex. */
        index = index > 0 ? index - 1 : index + (int64_t)builder->mesh.n_vertices;
        status = ms_mesh_build_face_corner(builder, index, err);
    }
    return status ? status : ms_mesh_build_face_end(builder, err);
}

/* Passes over statements that add nothing to the surface; refuses what adds to it but cannot be read. */
static ms_status pass_over(const ms_word *keyword, ms_text *text, ms_error *err)
{
    static const char *const refused[] = {"surf", "curv", "curv2", "call", "csh"};
    for (size_t i = 0; i < sizeof refused / sizeof refused[0]; i++) {
        if (ms_text_word_is(keyword, refused[i])) {
            return ms_text_fail(err, text, "'%s' is not read, only polygons are", refused[i]);
        }
    }
    for (size_t i = 0; i < keyword->length; i++) {
        char c = keyword->start[i];
        if (!(c >= 'a' && c <= 'z') && !(c >= 'A' && c <= 'Z') && c != '_' && !(i > 0 && c >= '0' && c <= '9')) {
            return ms_text_fail(err, text, "'%s' is no statement of OBJ", ms_text_quote(keyword).text);
        }
    }
    ms_text_skip_line(text);
    return MS_OK;
}

ms_status ms_mesh_parse_obj(ms_mesh *mesh, ms_error *remark, const ms_bytes *bytes, const char *name, ms_error *err)
{
    ms_status status = MS_OK;
    ms_text text;
    ms_word keyword;
    ms_mesh_builder builder = {.name = name, .place_word = "line", .first_index = 1};
    ms_text_start(&text, bytes, name);
    text.comment = '#';
    text.joins_lines = 1;
    while (!status && ms_text_seek(&text)) {
        ms_text_word(&keyword, &text);
        if (ms_text_word_is(&keyword, "v")) {
            status = parse_obj_vertex(&builder, &text, err);
        } else if (ms_text_word_is(&keyword, "f") || ms_text_word_is(&keyword, "fo")) {
            status = parse_obj_face(&builder, &text, err);
        } else {
            status = pass_over(&keyword, &text, err);
        }
    }
    return ms_mesh_build_finish(mesh, remark, &builder, status, err);
}
