/* Geomview's OFF as text, with the prefixes ST, C and N; normals, colours and texture are passed over. */
#include <string.h>

#include "base/ms_text.h"
#include "ms_mesh_formats.h"

/* The first word: OFF behind prefixes. `extras` is set where vertices carry more than x, y, z. */
static ms_status parse_keyword(int *extras, ms_text *text, ms_error *err)
{
    static const char *const plain[] = {"stoff", "coff", "noff", "cnoff", "stcoff", "stnoff", "stcnoff"};
    ms_word word;
    *extras = 0;
    if (!ms_text_seek(text)) {
        return ms_text_fail(err, text, "the file ends where OFF belongs");
    }
    ms_text_word(&word, text);
    for (size_t i = 0; i < sizeof plain / sizeof plain[0]; i++) {
        *extras |= ms_text_word_is(&word, plain[i]);
    }
    if (!*extras && !ms_text_word_is(&word, "off")) {
        return ms_text_fail(err, text, "'%s' stands where OFF belongs (four-dimensional kinds are not read)",
                            ms_text_quote(&word).text);
    }
    ms_text peek = *text;
    if (ms_text_word(&word, &peek) && ms_text_word_is(&word, "binary")) {
        return ms_text_fail(err, text, "binary OFF is not read; save it as text or as PLY");
    }
    return MS_OK;
}

static ms_status parse_count(int64_t *value, const char *what, ms_text *text, ms_error *err)
{
    ms_word word;
    if (!ms_text_word(&word, text)) {
        return ms_text_fail(err, text, "the line ends where %s belongs", what);
    }
    if (!ms_text_to_integer(value, &word) || *value < 0) {
        return ms_text_fail(err, text, "'%s' stands where %s belongs", ms_text_quote(&word).text, what);
    }
    return MS_OK;
}

/* Vertices, faces and, as some programs leave it out and none uses it, perhaps edges. */
static ms_status parse_counts(size_t *n_vertices, size_t *n_faces, ms_text *text, ms_error *err)
{
    int64_t count[2] = {0, 0};
    int64_t edges;
    ms_word word;
    if (!ms_text_seek(text)) {
        return ms_text_fail(err, text, "the file ends where the numbers of vertices and faces belong");
    }
    ms_status status = parse_count(&count[0], "the number of vertices", text, err);
    if (!status) {
        status = parse_count(&count[1], "the number of faces", text, err);
    }
    if (!status && ms_text_word(&word, text) && !ms_text_to_integer(&edges, &word)) {
        return ms_text_fail(err, text, "'%s' stands where the number of edges belongs", ms_text_quote(&word).text);
    }
    if (!status) {
        status = ms_text_end_line(text, err);
    }
    /* Every vertex and every face takes at least 6 characters, such as "0 0 0" and the end of the line. */
    int64_t room = (text->end - text->at) / 6 + 1;
    if (!status && (count[0] > room || count[1] > room - count[0])) {
        return ms_text_fail(err, text, "%lld vertices and %lld faces are claimed but only %td bytes follow",
                            (long long)count[0], (long long)count[1], text->end - text->at);
    }
    *n_vertices = (size_t)count[0];
    *n_faces = (size_t)count[1];
    return status;
}

/* Numbers that are not used, up to the end of the line. */
static ms_status pass_over_numbers(ms_text *text, ms_error *err)
{
    ms_word word;
    double ignored;
    while (ms_text_word(&word, text)) {
        if (!ms_text_to_double(&ignored, &word)) {
            return ms_text_fail(err, text, "'%s' stands where a number belongs", ms_text_quote(&word).text);
        }
    }
    return MS_OK;
}

static ms_status parse_off_vertex(ms_mesh_builder *builder, int extras, ms_text *text, ms_error *err)
{
    double position[3];
    size_t place = text->line;
    ms_status status = ms_text_doubles(position, 3, text, "a vertex", err);
    if (!status) {
        status = extras ? pass_over_numbers(text, err) : ms_text_end_line(text, err);
    }
    return status ? status : ms_mesh_build_vertex(builder, position, place, err);
}

static ms_status parse_off_face(ms_mesh_builder *builder, ms_text *text, ms_error *err)
{
    int64_t n_corners = 0;
    ms_status status = parse_count(&n_corners, "the number of corners", text, err);
    ms_mesh_build_face_begin(builder, text->line);
    for (int64_t k = 0; k < n_corners && !status; k++) {
        int64_t index;
        status = parse_count(&index, "the index of a vertex", text, err);
        if (!status) {
            status = ms_mesh_build_face_corner(builder, index, err);
        }
    }
    if (!status) {
        status = ms_mesh_build_face_end(builder, err);
    }
    return status ? status : pass_over_numbers(text, err);
}

static ms_status parse_body(ms_mesh_builder *builder, int extras, ms_text *text, ms_error *err)
{
    size_t n_vertices = 0;
    size_t n_faces = 0;
    ms_status status = parse_counts(&n_vertices, &n_faces, text, err);
    for (size_t i = 0; i < n_vertices + n_faces && !status; i++) {
        if (!ms_text_seek(text)) {
            return ms_text_fail(err, text, "the file ends after %zu of %zu %s", i < n_vertices ? i : i - n_vertices,
                                i < n_vertices ? n_vertices : n_faces, i < n_vertices ? "vertices" : "faces");
        }
        status = i < n_vertices ? parse_off_vertex(builder, extras, text, err) : parse_off_face(builder, text, err);
    }
    if (!status && ms_text_seek(text)) {
        return ms_text_fail(err, text, "more follows after the last of %zu faces", n_faces);
    }
    return status;
}

ms_status ms_mesh_parse_off(ms_mesh *mesh, ms_error *remark, const ms_bytes *bytes, const char *name, ms_error *err)
{
    int extras;
    ms_text text;
    ms_mesh_builder builder = {.name = name, .place_word = "line"};
    ms_text_start(&text, bytes, name);
    text.comment = '#';
    ms_status status = parse_keyword(&extras, &text, err);
    if (!status) {
        status = parse_body(&builder, extras, &text, err);
    }
    return ms_mesh_build_finish(mesh, remark, &builder, status, err);
}
