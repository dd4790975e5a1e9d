/* The header of PLY, after Turk's description of 1994 (Stanford). */
#include <string.h>

#include "ms_mesh_ply.h"

size_t ms_mesh_ply_type_size(ms_ply_type type)
{
    static const size_t size[] = {0, 1, 1, 2, 2, 4, 4, 4, 8};
    return size[type];
}

static ms_ply_type find_type(const ms_word *word)
{
    static const struct {
        const char *name;
        ms_ply_type type;
    } names[] = {
        {"char", MS_PLY_INT8},     {"int8", MS_PLY_INT8},       {"uchar", MS_PLY_UINT8},    {"uint8", MS_PLY_UINT8},
        {"short", MS_PLY_INT16},   {"int16", MS_PLY_INT16},     {"ushort", MS_PLY_UINT16},  {"uint16", MS_PLY_UINT16},
        {"int", MS_PLY_INT32},     {"int32", MS_PLY_INT32},     {"uint", MS_PLY_UINT32},    {"uint32", MS_PLY_UINT32},
        {"float", MS_PLY_FLOAT32}, {"float32", MS_PLY_FLOAT32}, {"double", MS_PLY_FLOAT64}, {"float64", MS_PLY_FLOAT64},
    };
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        if (ms_text_word_is(word, names[i].name)) {
            return names[i].type;
        }
    }
    return MS_PLY_NONE;
}

static ms_status next_word(ms_word *word, const char *what, ms_text *text, ms_error *err)
{
    if (!ms_text_word(word, text)) {
        return ms_text_fail(err, text, "the line ends where %s belongs", what);
    }
    return MS_OK;
}

static ms_status next_type(ms_ply_type *type, int is_count, ms_text *text, ms_error *err)
{
    ms_word word;
    ms_status status = next_word(&word, "a type", text, err);
    if (status) {
        return status;
    }
    *type = find_type(&word);
    if (*type == MS_PLY_NONE || (is_count && *type >= MS_PLY_FLOAT32)) {
        return ms_text_fail(err, text, "'%s' is no type for %s", ms_text_quote(&word).text,
                            is_count ? "the length of a list" : "a property");
    }
    return MS_OK;
}

static ms_status parse_format(ms_ply_header *header, ms_text *text, ms_error *err)
{
    ms_word word;
    ms_status status = next_word(&word, "the format", text, err);
    if (status) {
        return status;
    }
    if (ms_text_word_is(&word, "ascii")) {
        header->encoding = MS_PLY_ASCII;
    } else if (ms_text_word_is(&word, "binary_little_endian")) {
        header->encoding = MS_PLY_LITTLE_ENDIAN;
    } else if (ms_text_word_is(&word, "binary_big_endian")) {
        header->encoding = MS_PLY_BIG_ENDIAN;
    } else {
        return ms_text_fail(err, text, "the format '%s' is none of ascii, binary_little_endian and binary_big_endian",
                            ms_text_quote(&word).text);
    }
    status = next_word(&word, "the version 1.0", text, err);
    if (!status && !ms_text_word_is(&word, "1.0")) {
        return ms_text_fail(err, text, "version '%s' stands where 1.0 belongs", ms_text_quote(&word).text);
    }
    return status ? status : ms_text_end_line(text, err);
}

static ms_status parse_element_line(ms_ply_header *header, ms_text *text, ms_error *err)
{
    ms_word name;
    ms_word number;
    int64_t count;
    ms_status status = next_word(&name, "the name of an element", text, err);
    if (!status) {
        status = next_word(&number, "the number of elements", text, err);
    }
    if (status) {
        return status;
    }
    if (!ms_text_to_integer(&count, &number) || count < 0 || (uint64_t)count > SIZE_MAX) {
        return ms_text_fail(err, text, "'%s' is no number of elements", ms_text_quote(&number).text);
    }
    if (header->n_elements == MS_PLY_MAX_ELEMENTS) {
        return ms_text_fail(err, text, "more than %d elements are not read", MS_PLY_MAX_ELEMENTS);
    }
    ms_ply_kind kind = ms_text_word_is(&name, "vertex")      ? MS_PLY_VERTEX
                       : ms_text_word_is(&name, "face")      ? MS_PLY_FACE
                       : ms_text_word_is(&name, "tristrips") ? MS_PLY_STRIPS
                                                             : MS_PLY_OTHER;
    for (size_t i = 0; i < header->n_elements; i++) {
        if (kind != MS_PLY_OTHER && header->element[i].kind == kind) {
            return ms_text_fail(err, text, "a second element '%s'", ms_text_quote(&name).text);
        }
    }
    header->element[header->n_elements++] =
        (ms_ply_element){.kind = kind, .count = (size_t)count, .first = header->n_properties, .line = text->line};
    return ms_text_end_line(text, err);
}

static ms_ply_role find_role(ms_ply_kind kind, int is_list, const ms_word *name)
{
    if (kind == MS_PLY_VERTEX && !is_list) {
        return ms_text_word_is(name, "x")   ? MS_PLY_X
               : ms_text_word_is(name, "y") ? MS_PLY_Y
               : ms_text_word_is(name, "z") ? MS_PLY_Z
                                            : MS_PLY_IGNORED;
    }
    int is_corners = ms_text_word_is(name, "vertex_indices") || ms_text_word_is(name, "vertex_index");
    if (!is_list || !is_corners) {
        return MS_PLY_IGNORED;
    }
    return kind == MS_PLY_FACE ? MS_PLY_CORNERS : kind == MS_PLY_STRIPS ? MS_PLY_STRIP : MS_PLY_IGNORED;
}

static ms_status parse_property(ms_ply_header *header, ms_text *text, ms_error *err)
{
    ms_word name;
    ms_ply_property property = {MS_PLY_NONE, MS_PLY_NONE, MS_PLY_IGNORED};
    if (header->n_elements == 0) {
        return ms_text_fail(err, text, "a property stands before the first element");
    }
    if (header->n_properties == MS_PLY_MAX_PROPERTIES) {
        return ms_text_fail(err, text, "more than %d properties are not read", MS_PLY_MAX_PROPERTIES);
    }
    ms_ply_element *element = &header->element[header->n_elements - 1];
    ms_text peek = *text;
    int is_list = ms_text_word(&name, &peek) && ms_text_word_is(&name, "list");
    ms_status status = MS_OK;
    if (is_list) {
        *text = peek;
        status = next_type(&property.count_type, 1, text, err);
    }
    if (!status) {
        status = next_type(&property.type, 0, text, err);
    }
    if (!status) {
        status = next_word(&name, "the name of a property", text, err);
    }
    if (status) {
        return status;
    }
    property.role = find_role(element->kind, is_list, &name);
    for (size_t i = 0; i < element->n_properties; i++) {
        if (property.role != MS_PLY_IGNORED && header->property[element->first + i].role == property.role) {
            return ms_text_fail(err, text, "a second property '%s'", ms_text_quote(&name).text);
        }
    }
    element->n_properties++;
    header->property[header->n_properties++] = property;
    return ms_text_end_line(text, err);
}

/* Everything up to and with the line end_header; its end of line is consumed by no word. */
static ms_status parse_lines(ms_ply_header *header, ms_text *text, ms_error *err)
{
    ms_word word;
    int has_format = 0;
    for (;;) {
        ms_status status = MS_OK;
        if (!ms_text_seek(text)) {
            return ms_text_fail(err, text, "the file ends without 'end_header'");
        }
        ms_text_word(&word, text);
        if (ms_text_word_is(&word, "end_header")) {
            return has_format ? ms_text_end_line(text, err)
                              : ms_text_fail(err, text, "the header ends without 'format'");
        }
        if (ms_text_word_is(&word, "format")) {
            has_format = 1;
            status = parse_format(header, text, err);
        } else if (ms_text_word_is(&word, "element")) {
            status = parse_element_line(header, text, err);
        } else if (ms_text_word_is(&word, "property")) {
            status = parse_property(header, text, err);
        } else if (ms_text_word_is(&word, "comment") || ms_text_word_is(&word, "obj_info")) {
            ms_text_skip_line(text);
        } else {
            return ms_text_fail(err, text, "'%s' is no line of a PLY header", ms_text_quote(&word).text);
        }
        if (status) {
            return status;
        }
    }
}

/* The fewest bytes that a row can take: in text a digit and a blank per value. */
static size_t least_row_size(const ms_ply_header *header, const ms_ply_element *element)
{
    size_t size = 0;
    for (size_t i = 0; i < element->n_properties; i++) {
        const ms_ply_property *property = &header->property[element->first + i];
        ms_ply_type type = property->count_type ? property->count_type : property->type;
        size += header->encoding == MS_PLY_ASCII ? 2 : ms_mesh_ply_type_size(type);
    }
    return size;
}

static ms_status check_sizes(const ms_ply_header *header, const ms_text *text, ms_error *err)
{
    /* The last line of a text may lack its end. */
    size_t left = (size_t)(text->end - text->at) + (header->encoding == MS_PLY_ASCII);
    for (size_t i = 0; i < header->n_elements; i++) {
        const ms_ply_element *element = &header->element[i];
        ms_text place = *text;
        place.line = element->line;
        if (element->n_properties == 0 && element->count > 0) {
            return ms_text_fail(err, &place, "an element has %zu rows and no property", element->count);
        }
        size_t row = least_row_size(header, element);
        if (element->count > 0 && element->count > left / row) {
            return ms_text_fail(err, &place, "%zu rows of at least %zu bytes are claimed but only %zu bytes follow",
                                element->count, row, left);
        }
        left -= element->count * row;
    }
    return MS_OK;
}

static ms_status check_roles(const ms_ply_header *header, const ms_text *text, ms_error *err)
{
    int has_role[6] = {0};
    size_t n_points = 0;
    size_t n_faces = 0;
    for (size_t i = 0; i < header->n_elements; i++) {
        const ms_ply_element *element = &header->element[i];
        n_points += element->kind == MS_PLY_VERTEX ? element->count : 0;
        n_faces += element->kind == MS_PLY_FACE || element->kind == MS_PLY_STRIPS ? element->count : 0;
    }
    if (n_faces == 0) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: has no faces (and %zu points); export the surface of the body",
                       text->name, n_points);
    }
    for (size_t i = 0; i < header->n_properties; i++) {
        has_role[header->property[i].role] = 1;
    }
    if (!has_role[MS_PLY_X] || !has_role[MS_PLY_Y] || !has_role[MS_PLY_Z] ||
        !(has_role[MS_PLY_CORNERS] || has_role[MS_PLY_STRIP])) {
        return ms_text_fail(err, text, "the header lacks x, y, z of 'vertex' or the list 'vertex_indices' of 'face'");
    }
    return MS_OK;
}

ms_status ms_mesh_ply_parse_header(ms_ply_header *header, ms_text *text, ms_error *err)
{
    ms_word magic;
    memset(header, 0, sizeof *header);
    if (!ms_text_word(&magic, text) || !ms_text_word_is(&magic, "ply")) {
        return ms_text_fail(err, text, "'%s' stands where 'ply' belongs", ms_text_quote(&magic).text);
    }
    ms_status status = parse_lines(header, text, err);
    if (!status) {
        status = check_roles(header, text, err);
    }
    if (!status && text->at < text->end) {
        text->at++;
        text->line++;
    }
    return status ? status : check_sizes(header, text, err);
}
