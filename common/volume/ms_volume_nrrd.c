/* NRRD (teem), versions 1 to 5: lines "field: value" up to an empty line, voxels there or in another file. */
#include <math.h>
#include <string.h>

#include "ms_volume_formats.h"

typedef struct nrrd {
    ms_volume_header header;
    int has_dimension;
    int has_sizes;
    int has_encoding;
    int has_endian;
    int has_directions;
    int is_left_handed;
    int64_t skip_lines;
    int64_t skip_bytes; /* -1: the voxels are the last bytes of the file */
    ms_word data_file;  /* empty: the voxels follow the header */
    size_t data_line;   /* that names it */
} nrrd;

typedef ms_status nrrd_field_parser(nrrd *image, ms_text *value, ms_error *err);

static ms_status parse_nrrd_type(nrrd *image, ms_text *value, ms_error *err)
{
    static const struct {
        const char *names[6];
        ms_sample sample;
    } types[] = {
        {{"signed char", "int8", "int8_t"}, {MS_SAMPLE_SIGNED, 1}},
        {{"uchar", "unsigned char", "uint8", "uint8_t"}, {MS_SAMPLE_UNSIGNED, 1}},
        {{"short", "short int", "signed short", "signed short int", "int16", "int16_t"}, {MS_SAMPLE_SIGNED, 2}},
        {{"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"}, {MS_SAMPLE_UNSIGNED, 2}},
        {{"int", "signed int", "int32", "int32_t"}, {MS_SAMPLE_SIGNED, 4}},
        {{"uint", "unsigned int", "uint32", "uint32_t"}, {MS_SAMPLE_UNSIGNED, 4}},
        {{"longlong", "long long", "long long int", "signed long long", "int64", "int64_t"}, {MS_SAMPLE_SIGNED, 8}},
        {{"signed long long int"}, {MS_SAMPLE_SIGNED, 8}},
        {{"ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t"}, {MS_SAMPLE_UNSIGNED, 8}},
        {{"float"}, {MS_SAMPLE_FLOAT, 4}},
        {{"double"}, {MS_SAMPLE_FLOAT, 8}},
    };
    ms_word word = ms_text_rest(value);
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++) {
        for (size_t k = 0; k < 6 && types[i].names[k]; k++) {
            if (ms_text_word_is(&word, types[i].names[k])) {
                image->header.sample = types[i].sample;
                return MS_OK;
            }
        }
    }
    return ms_text_fail(err, value, "the type '%s' is not read; save the labels as uint16 or uint32",
                        ms_text_quote(&word).text);
}

static ms_status parse_dimension(nrrd *image, ms_text *value, ms_error *err)
{
    int64_t n = 0;
    ms_status status = ms_volume_text_integers(&n, 1, value, err);
    if (!status && n != 3) {
        return ms_text_fail(err, value, "the array has %lld axes and a volume has 3", (long long)n);
    }
    image->has_dimension = 1;
    return status;
}

static ms_status parse_sizes(nrrd *image, ms_text *value, ms_error *err)
{
    image->has_sizes = 1;
    return ms_volume_text_integers(image->header.n, 3, value, err);
}

static ms_status parse_encoding(nrrd *image, ms_text *value, ms_error *err)
{
    ms_word word = ms_text_rest(value);
    image->has_encoding = 1;
    if (ms_text_word_is(&word, "raw")) {
        image->header.coding = MS_CODING_RAW;
    } else if (ms_text_word_is(&word, "gzip") || ms_text_word_is(&word, "gz")) {
        image->header.coding = MS_CODING_DEFLATE;
    } else if (ms_text_word_is(&word, "text") || ms_text_word_is(&word, "txt") || ms_text_word_is(&word, "ascii")) {
        image->header.coding = MS_CODING_TEXT;
    } else {
        return ms_text_fail(err, value, "the encoding '%s' is not read, only raw, gzip and text are",
                            ms_text_quote(&word).text);
    }
    return MS_OK;
}

static ms_status parse_endian(nrrd *image, ms_text *value, ms_error *err)
{
    ms_word word = ms_text_rest(value);
    image->has_endian = 1;
    image->header.big_endian = ms_text_word_is(&word, "big");
    if (!image->header.big_endian && !ms_text_word_is(&word, "little")) {
        return ms_text_fail(err, value, "'%s' stands where little or big belongs", ms_text_quote(&word).text);
    }
    return MS_OK;
}

/* The directions say more and win over the spacings. */
static ms_status parse_spacings(nrrd *image, ms_text *value, ms_error *err)
{
    double spacing[3];
    ms_status status = ms_text_doubles(spacing, 3, value, "the spacing", err);
    if (!status) {
        status = ms_text_end_line(value, err);
    }
    if (!status && !image->has_directions) {
        memcpy(image->header.spacing, spacing, sizeof spacing);
    }
    return status;
}

static void skip_nrrd_blanks(ms_text *text)
{
    while (text->at < text->end && (*text->at == ' ' || *text->at == '\t')) {
        text->at++;
    }
}

static int take_nrrd_mark(ms_text *text, char c)
{
    skip_nrrd_blanks(text);
    if (text->at == text->end || *text->at != c) {
        return 0;
    }
    text->at++;
    return 1;
}

/* Such as (1,0,0). */
static ms_status parse_vector(double vector[3], ms_text *value, ms_error *err)
{
    int ok = take_nrrd_mark(value, '(');
    for (int k = 0; k < 3 && ok; k++) {
        skip_nrrd_blanks(value);
        const char *start = value->at;
        while (value->at < value->end && !strchr(",) \t", *value->at)) {
            value->at++;
        }
        ms_word word = {start, (size_t)(value->at - start)};
        ok = ms_text_to_double(&vector[k], &word) && take_nrrd_mark(value, k < 2 ? ',' : ')');
    }
    return ok ? MS_OK : ms_text_fail(err, value, "a vector (x,y,z) of three numbers belongs here");
}

static ms_status parse_directions(nrrd *image, ms_text *value, ms_error *err)
{
    double direction[3][3];
    image->has_directions = 1;
    for (int f = 0; f < 3; f++) {
        ms_status status = parse_vector(direction[f], value, err);
        if (status) {
            return status;
        }
    }
    if (!ms_volume_header_set_axes(&image->header, (const double(*)[3])direction)) {
        return ms_text_fail(err, value, "the axes are oblique; resample the volume to axes along x, y and z");
    }
    for (int f = 0; f < 3; f++) {
        image->header.spacing[f] = fabs(direction[f][image->header.axis[f]]);
    }
    return ms_text_end_line(value, err);
}

/* Of the named spaces two are left-handed; a grain read as if they were not would be its own mirror image. */
static ms_status parse_space(nrrd *image, ms_text *value, ms_error *err)
{
    static const char *const LEFT_HANDED[] = {"left-anterior-superior", "las", "3d-left-handed"};
    const ms_word word = ms_text_rest(value);
    (void)err;
    for (size_t i = 0; i < sizeof LEFT_HANDED / sizeof *LEFT_HANDED; i++) {
        image->is_left_handed |= ms_text_word_is(&word, LEFT_HANDED[i]);
    }
    return MS_OK;
}

/* x is turned round, so that left-anterior-superior becomes right-anterior-superior. */
static void make_right_handed(nrrd *image)
{
    image->header.origin[0] = 0.0 - image->header.origin[0];
    for (int f = 0; f < 3; f++) {
        if (image->header.axis[f] == 0) {
            image->header.mirrored[f] = !image->header.mirrored[f];
        }
    }
}

static ms_status parse_nrrd_origin(nrrd *image, ms_text *value, ms_error *err)
{
    ms_status status = parse_vector(image->header.origin, value, err);
    return status ? status : ms_text_end_line(value, err);
}

static ms_status parse_kinds(nrrd *image, ms_text *value, ms_error *err)
{
    ms_word word;
    (void)image;
    while (ms_text_word(&word, value)) {
        if (!ms_text_word_is(&word, "domain") && !ms_text_word_is(&word, "space") && !ms_text_word_is(&word, "none") &&
            !ms_text_word_is(&word, "???")) {
            return ms_text_fail(err, value, "an axis of the kind '%s' is none of space", ms_text_quote(&word).text);
        }
    }
    return MS_OK;
}

static ms_status parse_nrrd_data_file(nrrd *image, ms_text *value, ms_error *err)
{
    image->data_line = value->line;
    return ms_volume_data_file(&image->data_file, value, err);
}

static ms_status parse_line_skip(nrrd *image, ms_text *value, ms_error *err)
{
    ms_status status = ms_volume_text_integers(&image->skip_lines, 1, value, err);
    return status || image->skip_lines >= 0 ? status : ms_text_fail(err, value, "the line skip is negative");
}

static ms_status parse_byte_skip(nrrd *image, ms_text *value, ms_error *err)
{
    ms_status status = ms_volume_text_integers(&image->skip_bytes, 1, value, err);
    return status || image->skip_bytes >= -1 ? status : ms_text_fail(err, value, "the byte skip is less than -1");
}

static ms_status refuse_axis_mins(nrrd *image, ms_text *value, ms_error *err)
{
    (void)image;
    return ms_text_fail(err, value, "axis mins and maxs are not read; save 'spacings' and 'space origin' instead");
}

static nrrd_field_parser *find_nrrd_field(const ms_word *name)
{
    static const struct {
        const char *name;
        nrrd_field_parser *parse;
    } fields[] = {
        {"type", parse_nrrd_type},
        {"dimension", parse_dimension},
        {"sizes", parse_sizes},
        {"encoding", parse_encoding},
        {"endian", parse_endian},
        {"spacings", parse_spacings},
        {"space directions", parse_directions},
        {"space", parse_space},
        {"space origin", parse_nrrd_origin},
        {"kinds", parse_kinds},
        {"data file", parse_nrrd_data_file},
        {"datafile", parse_nrrd_data_file},
        {"line skip", parse_line_skip},
        {"lineskip", parse_line_skip},
        {"byte skip", parse_byte_skip},
        {"byteskip", parse_byte_skip},
        {"axis mins", refuse_axis_mins},
        {"axismins", refuse_axis_mins},
        {"axis maxs", refuse_axis_mins},
        {"axismaxs", refuse_axis_mins},
    };
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; i++) {
        if (ms_text_word_is(name, fields[i].name)) {
            return fields[i].parse;
        }
    }
    return NULL;
}

/* A comment, "key:=value" or "field: value"; what says nothing about the labels is passed over. */
static ms_status parse_nrrd_line(nrrd *image, const ms_word *line, ms_text *text, ms_error *err)
{
    const char *colon = memchr(line->start, ':', line->length);
    if (line->start[0] == '#') {
        return MS_OK;
    }
    if (!colon) {
        return ms_text_fail(err, text, "'%s' is no line 'field: value'", ms_text_quote(line).text);
    }
    ms_word name = {line->start, (size_t)(colon - line->start)};
    ms_word rest = {colon + 1, line->length - name.length - 1};
    if (rest.length > 0 && rest.start[0] == '=') {
        return MS_OK;
    }
    ms_text value = ms_volume_text_of_word(&rest, text);
    nrrd_field_parser *parse = find_nrrd_field(&name);
    return parse ? parse(image, &value, err) : MS_OK;
}

static ms_status check_header(const nrrd *image, const ms_text *text, ms_error *err)
{
    const char *missing = !image->header.sample.size ? "type"
                          : !image->has_dimension    ? "dimension"
                          : !image->has_sizes        ? "sizes"
                          : !image->has_encoding     ? "encoding"
                                                     : NULL;
    int has_order = image->has_endian || image->header.sample.size == 1 || image->header.coding == MS_CODING_TEXT;
    missing = missing || has_order ? missing : "endian";
    if (missing) {
        return ms_text_fail(err, text, "the header ends without '%s'", missing);
    }
    if (image->header.coding != MS_CODING_RAW && image->skip_bytes != 0) {
        return ms_text_fail(err, text, "a byte skip is read only with the encoding raw");
    }
    return MS_OK;
}

/* Up to the empty line, which ends the header of an attached volume, or to the end of a detached one. */
static ms_status parse_nrrd_header(nrrd *image, ms_text *text, ms_error *err)
{
    ms_word line = ms_text_rest(text);
    ms_word magic = {line.start, line.length < 7 ? line.length : 7};
    if (!ms_text_word_is(&magic, "nrrd000") || line.length != 8 || line.start[7] < '1' || line.start[7] > '5') {
        return ms_text_fail(err, text, "'%s' stands where NRRD0001 to NRRD0005 belongs", ms_text_quote(&line).text);
    }
    while (line.length > 0 && text->at < text->end) {
        text->at++;
        text->line++;
        line = ms_text_rest(text);
        ms_status status = line.length > 0 ? parse_nrrd_line(image, &line, text, err) : MS_OK;
        if (status) {
            return status;
        }
    }
    if (text->at < text->end) {
        text->at++;
    } else if (image->data_file.length == 0) {
        return ms_text_fail(err, text, "the file ends before the empty line that ends the header");
    }
    if (image->is_left_handed) {
        make_right_handed(image);
    }
    return check_header(image, text, err);
}

static ms_status store_nrrd(ms_stored *stored, const nrrd *image, const uint8_t *data, size_t size, const char *path,
                            ms_error *err)
{
    size_t voxels = 0;
    size_t skip = 0;
    ms_status status = ms_volume_data_size(&voxels, &image->header, path, err);
    if (status) {
        return status;
    }
    for (int64_t i = 0; i < image->skip_lines && skip < size; i++) {
        const uint8_t *newline = memchr(data + skip, '\n', size - skip);
        skip = newline ? (size_t)(newline + 1 - data) : size;
    }
    if (image->skip_bytes < 0) {
        skip = size > voxels ? size - voxels : 0;
    } else if ((uint64_t)image->skip_bytes > size - skip) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: %lld bytes are to be skipped and there are %zu; save it again", path,
                       (long long)image->skip_bytes, size - skip);
    } else {
        skip += (size_t)image->skip_bytes;
    }
    return ms_volume_store(stored, &image->header, data + skip, size - skip, path, err);
}

ms_status ms_volume_parse_nrrd(ms_stored *stored, const ms_bytes *bytes, const char *path, size_t max_voxels,
                               ms_error *err)
{
    ms_text text;
    ms_bytes beside = {0};
    nrrd image = {.header = ms_volume_header_start(max_voxels)};
    *stored = (ms_stored){0};
    ms_text_start(&text, bytes, path);
    ms_status status = parse_nrrd_header(&image, &text, err);
    if (status) {
        return status;
    }
    if (image.data_file.length == 0) {
        return store_nrrd(stored, &image, (const uint8_t *)text.at, (size_t)(text.end - text.at), path, err);
    }
    text.line = image.data_line;
    status = ms_volume_read_beside(&beside, &image.data_file, &text, err);
    if (!status) {
        status = store_nrrd(stored, &image, beside.data, beside.size, path, err);
    }
    return ms_volume_keep_beside(stored, &beside, status);
}

ms_status ms_volume_find_data_nrrd(ms_word *file, const ms_bytes *bytes, const char *path, ms_error *err)
{
    ms_text text;
    nrrd image = {.header = ms_volume_header_start(SIZE_MAX)};
    ms_text_start(&text, bytes, path);
    const ms_status status = parse_nrrd_header(&image, &text, err);
    *file = status ? (ms_word){0} : image.data_file;
    return status;
}
