/* MetaImage .mhd and .mha: lines "Key = Value" up to ElementDataFile, voxels there or in another file. */
#include <math.h>
#include <string.h>

#include "ms_volume_formats.h"

typedef struct mhd {
    ms_volume_header header;
    int has_size;
    int has_spacing;
    int64_t packed_size; /* -1 where the file does not say */
    int64_t skip;        /* bytes before the voxels; -1: they are the last of the file */
    ms_word data_file;
} mhd;

typedef ms_status mhd_field_parser(mhd *image, ms_text *value, ms_error *err);

static ms_status parse_object(mhd *image, ms_text *value, ms_error *err)
{
    ms_word word = ms_text_rest(value);
    (void)image;
    return ms_text_word_is(&word, "image") ? MS_OK : ms_text_fail(err, value, "only the ObjectType Image is read");
}

static ms_status parse_dimensions(mhd *image, ms_text *value, ms_error *err)
{
    int64_t n = 0;
    (void)image;
    ms_status status = ms_volume_text_integers(&n, 1, value, err);
    if (!status && n != 3) {
        return ms_text_fail(err, value, "the image has %lld axes and a volume has 3", (long long)n);
    }
    return status;
}

static ms_status parse_mhd_size(mhd *image, ms_text *value, ms_error *err)
{
    image->has_size = 1;
    return ms_volume_text_integers(image->header.n, 3, value, err);
}

static ms_status parse_three(double numbers[3], const char *what, ms_text *value, ms_error *err)
{
    ms_status status = ms_text_doubles(numbers, 3, value, what, err);
    return status ? status : ms_text_end_line(value, err);
}

static ms_status parse_spacing(mhd *image, ms_text *value, ms_error *err)
{
    image->has_spacing = 1;
    return parse_three(image->header.spacing, "the spacing", value, err);
}

/* The extent of a voxel stands for the spacing only where that is missing. */
static ms_status parse_element_size(mhd *image, ms_text *value, ms_error *err)
{
    double size[3];
    ms_status status = parse_three(size, "the size", value, err);
    if (!status && !image->has_spacing) {
        memcpy(image->header.spacing, size, sizeof size);
    }
    return status;
}

static ms_status parse_mhd_origin(mhd *image, ms_text *value, ms_error *err)
{
    return parse_three(image->header.origin, "the origin", value, err);
}

/* A row for each axis of the file: where it leads, of length 1. */
static ms_status parse_matrix(mhd *image, ms_text *value, ms_error *err)
{
    double direction[3][3];
    ms_status status = ms_text_doubles(direction[0], 9, value, "the matrix", err);
    if (status) {
        return status;
    }
    for (int f = 0; f < 3; f++) {
        const double *d = direction[f];
        if (!(fabs(sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) - 1) <= 1e-4)) {
            return ms_text_fail(err, value, "the rows of the matrix are not of length 1; save the image again");
        }
    }
    return ms_volume_header_set_axes(&image->header, (const double(*)[3])direction)
               ? MS_OK
               : ms_text_fail(err, value, "the axes are oblique; resample the image to axes along x, y and z");
}

static ms_status parse_mhd_type(mhd *image, ms_text *value, ms_error *err)
{
    static const struct {
        const char *name;
        ms_sample sample;
    } types[] = {
        {"met_char", {MS_SAMPLE_SIGNED, 1}},      {"met_uchar", {MS_SAMPLE_UNSIGNED, 1}},
        {"met_short", {MS_SAMPLE_SIGNED, 2}},     {"met_ushort", {MS_SAMPLE_UNSIGNED, 2}},
        {"met_int", {MS_SAMPLE_SIGNED, 4}},       {"met_uint", {MS_SAMPLE_UNSIGNED, 4}},
        {"met_long", {MS_SAMPLE_SIGNED, 4}},      {"met_ulong", {MS_SAMPLE_UNSIGNED, 4}},
        {"met_long_long", {MS_SAMPLE_SIGNED, 8}}, {"met_ulong_long", {MS_SAMPLE_UNSIGNED, 8}},
        {"met_float", {MS_SAMPLE_FLOAT, 4}},      {"met_double", {MS_SAMPLE_FLOAT, 8}},
    };
    ms_word word = ms_text_rest(value);
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++) {
        if (ms_text_word_is(&word, types[i].name)) {
            image->header.sample = types[i].sample;
            return MS_OK;
        }
    }
    return ms_text_fail(err, value, "the type '%s' is not read; save the labels as MET_USHORT or MET_UINT",
                        ms_text_quote(&word).text);
}

static ms_status parse_bool(int *truth, ms_text *value, ms_error *err)
{
    ms_word word = ms_text_rest(value);
    *truth = ms_text_word_is(&word, "true") || ms_text_word_is(&word, "t") || ms_text_word_is(&word, "1");
    if (!*truth && !ms_text_word_is(&word, "false") && !ms_text_word_is(&word, "f") && !ms_text_word_is(&word, "0")) {
        return ms_text_fail(err, value, "'%s' stands where True or False belongs", ms_text_quote(&word).text);
    }
    return MS_OK;
}

static ms_status parse_mhd_binary(mhd *image, ms_text *value, ms_error *err)
{
    int binary = 1;
    (void)image;
    ms_status status = parse_bool(&binary, value, err);
    return status || binary ? status : ms_text_fail(err, value, "voxels as text are not read; save them as binary");
}

static ms_status parse_byte_order(mhd *image, ms_text *value, ms_error *err)
{
    return parse_bool(&image->header.big_endian, value, err);
}

static ms_status parse_compressed(mhd *image, ms_text *value, ms_error *err)
{
    int packed = 0;
    ms_status status = parse_bool(&packed, value, err);
    image->header.coding = packed ? MS_CODING_DEFLATE : MS_CODING_RAW;
    return status;
}

static ms_status parse_packed_size(mhd *image, ms_text *value, ms_error *err)
{
    return ms_volume_text_integers(&image->packed_size, 1, value, err);
}

static ms_status parse_channels(mhd *image, ms_text *value, ms_error *err)
{
    int64_t n = 0;
    (void)image;
    ms_status status = ms_volume_text_integers(&n, 1, value, err);
    if (!status && n != 1) {
        return ms_text_fail(err, value, "voxels of %lld channels are colours and not labels", (long long)n);
    }
    return status;
}

static ms_status parse_skip(mhd *image, ms_text *value, ms_error *err)
{
    ms_status status = ms_volume_text_integers(&image->skip, 1, value, err);
    if (!status && image->skip < -1) {
        return ms_text_fail(err, value, "HeaderSize is %lld; it must be -1 or more", (long long)image->skip);
    }
    return status;
}

static ms_status parse_mhd_data_file(mhd *image, ms_text *value, ms_error *err)
{
    return ms_volume_data_file(&image->data_file, value, err);
}

static mhd_field_parser *find_mhd_field(const ms_word *key)
{
    static const struct {
        const char *key;
        mhd_field_parser *parse;
    } fields[] = {
        {"objecttype", parse_object},
        {"ndims", parse_dimensions},
        {"dimsize", parse_mhd_size},
        {"elementspacing", parse_spacing},
        {"elementsize", parse_element_size},
        {"offset", parse_mhd_origin},
        {"position", parse_mhd_origin},
        {"origin", parse_mhd_origin},
        {"transformmatrix", parse_matrix},
        {"orientation", parse_matrix},
        {"rotation", parse_matrix},
        {"elementtype", parse_mhd_type},
        {"binarydata", parse_mhd_binary},
        {"binarydatabyteordermsb", parse_byte_order},
        {"elementbyteordermsb", parse_byte_order},
        {"compresseddata", parse_compressed},
        {"compresseddatasize", parse_packed_size},
        {"elementnumberofchannels", parse_channels},
        {"headersize", parse_skip},
        {"elementdatafile", parse_mhd_data_file},
    };
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; i++) {
        if (ms_text_word_is(key, fields[i].key)) {
            return fields[i].parse;
        }
    }
    return NULL;
}

/* One line; keys that say nothing about the labels, such as a patient's name, are passed over. */
static ms_status parse_mhd_line(mhd *image, ms_text *text, ms_error *err)
{
    ms_word line = ms_text_rest(text);
    const char *equals = memchr(line.start, '=', line.length);
    if (!equals) {
        return ms_text_fail(err, text, "'%s' is no line 'Key = Value'", ms_text_quote(&line).text);
    }
    ms_word left = {line.start, (size_t)(equals - line.start)};
    ms_word right = {equals + 1, line.length - left.length - 1};
    ms_text before = ms_volume_text_of_word(&left, text);
    ms_text value = ms_volume_text_of_word(&right, text);
    ms_word key = ms_text_rest(&before);
    mhd_field_parser *parse = find_mhd_field(&key);
    return parse ? parse(image, &value, err) : MS_OK;
}

static ms_status parse_mhd_header(mhd *image, ms_text *text, ms_error *err)
{
    while (!image->data_file.length) {
        if (!ms_text_seek(text)) {
            return ms_text_fail(err, text, "the header ends without ElementDataFile");
        }
        ms_status status = parse_mhd_line(image, text, err);
        if (status) {
            return status;
        }
    }
    if (!image->has_size || image->header.sample.size == 0) {
        return ms_text_fail(err, text, "the header lacks %s", image->has_size ? "ElementType" : "DimSize");
    }
    return MS_OK;
}

/* `data` begins with what the header may tell to skip. */
static ms_status store_mhd(ms_stored *stored, const mhd *image, const uint8_t *data, size_t size, const char *path,
                           ms_error *err)
{
    size_t voxels = 0;
    ms_status status = ms_volume_data_size(&voxels, &image->header, path, err);
    if (status) {
        return status;
    }
    size_t packed = image->header.coding == MS_CODING_RAW ? voxels
                    : image->packed_size >= 0             ? (size_t)image->packed_size
                                                          : size;
    size_t skip = image->skip >= 0 ? (size_t)image->skip : size > packed ? size - packed : 0;
    if (skip > size || size - skip != packed) {
        return ms_fail(
            err, MS_ERR_FORMAT,
            "%s: its header claims %zu bytes of data behind %zu others but there are %zu; fetch or save it again", path,
            packed, skip, size);
    }
    return ms_volume_store(stored, &image->header, data + skip, packed, path, err);
}

ms_status ms_volume_parse_mhd(ms_stored *stored, const ms_bytes *bytes, const char *path, size_t max_voxels,
                              ms_error *err)
{
    ms_text text;
    ms_bytes beside = {0};
    mhd image = {.header = ms_volume_header_start(max_voxels), .packed_size = -1};
    *stored = (ms_stored){0};
    ms_text_start(&text, bytes, path);
    ms_status status = parse_mhd_header(&image, &text, err);
    if (status) {
        return status;
    }
    if (ms_text_word_is(&image.data_file, "local")) {
        text.at += text.at < text.end;
        return store_mhd(stored, &image, (const uint8_t *)text.at, (size_t)(text.end - text.at), path, err);
    }
    status = ms_volume_read_beside(&beside, &image.data_file, &text, err);
    if (!status) {
        status = store_mhd(stored, &image, beside.data, beside.size, path, err);
    }
    return ms_volume_keep_beside(stored, &beside, status);
}

ms_status ms_volume_find_data_mhd(ms_word *file, const ms_bytes *bytes, const char *path, ms_error *err)
{
    ms_text text;
    mhd image = {.header = ms_volume_header_start(SIZE_MAX), .packed_size = -1};
    ms_text_start(&text, bytes, path);
    const ms_status status = parse_mhd_header(&image, &text, err);
    *file = status || ms_text_word_is(&image.data_file, "local") ? (ms_word){0} : image.data_file;
    return status;
}
