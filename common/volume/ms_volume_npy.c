/* NumPy's .npy, versions 1 to 3: a magic word, the length of a header, a Python dictionary, the array. */
#include <string.h>

#include "ms_volume_formats.h"

#define MAGIC "\x93NUMPY"
#define MAGIC_SIZE 6

/* The dictionary of the header while it is scanned. */
typedef struct dictionary {
    const char *start; /* of the file */
    const char *at;
    const char *end;
    const char *path;
    ms_volume_header header;
    int has_shape;
    int fortran_order;
} dictionary;

static ms_status fail_at(const dictionary *dict, const char *expected, ms_error *err)
{
    return ms_fail(err, MS_ERR_FORMAT, "%s: byte %td of the header: %s belongs here; save the array with numpy.save",
                   dict->path, dict->at - dict->start, expected);
}

static void skip_npy_blanks(dictionary *dict)
{
    while (dict->at < dict->end && (*dict->at == ' ' || *dict->at == '\t' || *dict->at == '\n')) {
        dict->at++;
    }
}

static int take_npy_mark(dictionary *dict, char c)
{
    skip_npy_blanks(dict);
    if (dict->at == dict->end || *dict->at != c) {
        return 0;
    }
    dict->at++;
    return 1;
}

static ms_status parse_string(ms_word *string, dictionary *dict, ms_error *err)
{
    char quote = take_npy_mark(dict, '\'') ? '\'' : '"';
    if (quote == '"' && !take_npy_mark(dict, '"')) {
        return fail_at(dict, "a string", err);
    }
    const char *stop = memchr(dict->at, quote, (size_t)(dict->end - dict->at));
    if (!stop) {
        return fail_at(dict, "a closing quote", err);
    }
    *string = (ms_word){dict->at, (size_t)(stop - dict->at)};
    dict->at = stop + 1;
    return MS_OK;
}

static ms_word parse_letters(dictionary *dict)
{
    skip_npy_blanks(dict);
    const char *start = dict->at;
    while (dict->at < dict->end && ((*dict->at >= 'a' && *dict->at <= 'z') || (*dict->at >= 'A' && *dict->at <= 'Z') ||
                                    (*dict->at >= '0' && *dict->at <= '9'))) {
        dict->at++;
    }
    return (ms_word){start, (size_t)(dict->at - start)};
}

/* Such as <u2: byte order, kind, bytes. */
static ms_status parse_npy_type(dictionary *dict, ms_error *err)
{
    static const struct {
        const char *name;
        ms_sample sample;
    } types[] = {
        {"b1", {MS_SAMPLE_BOOL, 1}},     {"u1", {MS_SAMPLE_UNSIGNED, 1}}, {"u2", {MS_SAMPLE_UNSIGNED, 2}},
        {"u4", {MS_SAMPLE_UNSIGNED, 4}}, {"u8", {MS_SAMPLE_UNSIGNED, 8}}, {"i1", {MS_SAMPLE_SIGNED, 1}},
        {"i2", {MS_SAMPLE_SIGNED, 2}},   {"i4", {MS_SAMPLE_SIGNED, 4}},   {"i8", {MS_SAMPLE_SIGNED, 8}},
        {"f4", {MS_SAMPLE_FLOAT, 4}},    {"f8", {MS_SAMPLE_FLOAT, 8}},
    };
    ms_word name;
    ms_status status = parse_string(&name, dict, err);
    if (status) {
        return status;
    }
    char order = '\0';
    ms_word kind = name;
    if (name.length > 0) {
        order = name.start[0];
        kind = (ms_word){name.start + 1, name.length - 1};
    }
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++) {
        int has_order = order == '<' || order == '>';
        if (ms_text_word_is(&kind, types[i].name) && (has_order || (order == '|' && types[i].sample.size == 1))) {
            dict->header.sample = types[i].sample;
            dict->header.big_endian = order == '>';
            return MS_OK;
        }
    }
    return ms_fail(err, MS_ERR_FORMAT,
                   "%s: its values have the type '%s', which is not read; save the labels as uint8, uint16 or uint32",
                   dict->path, ms_text_quote(&name).text);
}

static ms_status parse_order(dictionary *dict, ms_error *err)
{
    ms_word word = parse_letters(dict);
    if (!ms_text_word_is(&word, "true") && !ms_text_word_is(&word, "false")) {
        return fail_at(dict, "True or False", err);
    }
    dict->fortran_order = ms_text_word_is(&word, "true");
    return MS_OK;
}

/* A tuple of three extents, as in the file: the axes are put in order when all is known. */
static ms_status parse_shape(dictionary *dict, ms_error *err)
{
    int n_axes = 0;
    if (!take_npy_mark(dict, '(')) {
        return fail_at(dict, "the tuple of the shape", err);
    }
    while (!take_npy_mark(dict, ')')) {
        int64_t extent;
        ms_word word = parse_letters(dict);
        /* Python 2 wrote its long integers as 20L. */
        word.length -= word.length > 0 && word.start[word.length - 1] == 'L';
        if (!ms_text_to_integer(&extent, &word) || extent < 0) {
            dict->at = word.start;
            return fail_at(dict, "an extent", err);
        }
        if (n_axes < 3) {
            dict->header.n[n_axes] = extent;
        }
        n_axes++;
        if (!take_npy_mark(dict, ',') && (dict->at == dict->end || *dict->at != ')')) {
            return fail_at(dict, "a comma or ')'", err);
        }
    }
    if (n_axes != 3) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: its array has %d axes and a volume has 3; save it as [z][y][x]",
                       dict->path, n_axes);
    }
    dict->has_shape = 1;
    return MS_OK;
}

static ms_status parse_item(dictionary *dict, ms_error *err)
{
    ms_word key;
    ms_status status = parse_string(&key, dict, err);
    if (status) {
        return status;
    }
    if (!take_npy_mark(dict, ':')) {
        return fail_at(dict, "a colon", err);
    }
    if (ms_text_word_is(&key, "descr")) {
        return parse_npy_type(dict, err);
    }
    if (ms_text_word_is(&key, "fortran_order")) {
        return parse_order(dict, err);
    }
    return ms_text_word_is(&key, "shape") ? parse_shape(dict, err)
                                          : fail_at(dict, "descr, fortran_order or shape", err);
}

static ms_status parse_dictionary(dictionary *dict, ms_error *err)
{
    dict->fortran_order = -1;
    if (!take_npy_mark(dict, '{')) {
        return fail_at(dict, "a dictionary", err);
    }
    while (!take_npy_mark(dict, '}')) {
        ms_status status = parse_item(dict, err);
        if (status) {
            return status;
        }
        if (!take_npy_mark(dict, ',') && (dict->at == dict->end || *dict->at != '}')) {
            return fail_at(dict, "a comma or '}'", err);
        }
    }
    skip_npy_blanks(dict);
    if (dict->at != dict->end) {
        return fail_at(dict, "the end of the header", err);
    }
    if (!dict->has_shape || dict->header.sample.size == 0 || dict->fortran_order < 0) {
        return fail_at(dict, "one of descr, fortran_order and shape, which is missing,", err);
    }
    if (!dict->fortran_order) {
        /* The last axis is the fastest: it is x. */
        int64_t slowest = dict->header.n[0];
        dict->header.n[0] = dict->header.n[2];
        dict->header.n[2] = slowest;
    }
    return MS_OK;
}

/* Where the header begins and ends. */
static ms_status find_header(size_t *start, size_t *end, const ms_bytes *bytes, const char *path, ms_error *err)
{
    const uint8_t *data = bytes->data;
    if (bytes->size < MAGIC_SIZE + 4 || memcmp(data, MAGIC, MAGIC_SIZE) != 0) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: byte 0: does not begin as NumPy arrays do; save it with numpy.save",
                       path);
    }
    uint8_t version = data[MAGIC_SIZE];
    if (version < 1 || version > 3) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: byte %d: version %d of .npy is not read, only 1, 2 and 3 are", path,
                       MAGIC_SIZE, version);
    }
    size_t length = (size_t)data[8] | (size_t)data[9] << 8;
    *start = 10;
    if (version > 1) {
        *start = 12;
        if (bytes->size >= *start) {
            length |= (size_t)data[10] << 16 | (size_t)data[11] << 24;
        }
    }
    if (bytes->size < *start || length > bytes->size - *start) {
        return ms_fail(
            err, MS_ERR_FORMAT,
            "%s: byte %zu: a header of %zu bytes is claimed but the file ends before; fetch or save it again", path,
            *start, length);
    }
    *end = *start + length;
    return MS_OK;
}

ms_status ms_volume_parse_npy(ms_stored *stored, const ms_bytes *bytes, const char *path, size_t max_voxels,
                              ms_error *err)
{
    size_t start = 0;
    size_t end = 0;
    *stored = (ms_stored){0};
    ms_status status = find_header(&start, &end, bytes, path, err);
    if (status) {
        return status;
    }
    const char *file = (const char *)bytes->data;
    dictionary dict = {.start = file, .at = file + start, .end = file + end, .path = path};
    dict.header = ms_volume_header_start(max_voxels);
    status = parse_dictionary(&dict, err);
    if (status) {
        return status;
    }
    return ms_volume_store(stored, &dict.header, bytes->data + end, bytes->size - end, path, err);
}
