/* Volumes that stay on the disk: axes, spacings, grey values, raw and packed files. */
#include <math.h>
#include <unistd.h>
#include <zlib.h>

#include "support/volume_samples.h"
#include "volume/ms_labels.h"

static const double ORIGIN[3] = {1, -2, 3.5};

static ms_scan open_sample(const sample *made, ms_bytes *bytes, const char *path, const ms_scan_options *options)
{
    ms_scan scan;
    ms_error err = {{0}};
    *bytes = copy_bytes(made->data, made->size);
    if (ms_scan_parse(&scan, bytes, path, options, SIZE_MAX, &err) != MS_OK) {
        fail_msg("refused: %s", err.text);
    }
    return scan;
}

static void expect_refused(const sample *made, const char *path, const ms_scan_options *options, size_t max_voxels,
                           ms_status status, const char *message)
{
    ms_scan scan;
    ms_error err = {{0}};
    ms_bytes bytes = copy_bytes(made->data, made->size);
    assert_int_equal(ms_scan_parse(&scan, &bytes, path, options, max_voxels, &err), status);
    expect_message(&err, path);
    expect_message(&err, message);
    assert_null(scan.store);
    ms_file_free(&bytes);
}

/* Which way the axes of a file lead, one of 48. */
typedef struct turn {
    double direction[3][3]; /* of each axis of the file */
} turn;

static turn make_turn(int which)
{
    static const int ORDER[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    turn t = {{{0}}};
    for (int f = 0; f < 3; f++) {
        t.direction[f][ORDER[which / 8][f]] = which >> f & 1 ? -1 : 1;
    }
    return t;
}

/* Each voxel of the file must lie in space where the header says, by hand; sign is that of x. */
static void assert_places(const ms_scan *scan, const turn *t, double h, double sign)
{
    ms_volume v;
    assert_int_equal(ms_scan_volume(&v, scan, SIZE_MAX, NULL), MS_OK);
    assert_true(v.spacing == h);
    for (int i = 0; i < N_VOXELS; i++) {
        const int at[3] = {i % NX, i / NX % NY, i / NX / NY};
        int voxel[3];
        for (int a = 0; a < 3; a++) {
            double p = ORIGIN[a];
            for (int f = 0; f < 3; f++) {
                p += h * t->direction[f][a] * at[f];
            }
            voxel[a] = (int)lround(((a == 0 ? sign * p : p) - v.origin[a]) / h);
            assert_true(voxel[a] >= 0 && voxel[a] < v.n[a]);
        }
        assert_int_equal(v.label[(voxel[2] * v.n[1] + voxel[1]) * v.n[0] + voxel[0]], known_label(i, 100));
    }
    ms_volume_free(&v);
}

static void put_turned_nrrd(sample *made, const turn *t, double h, const char *space)
{
    char text[512];
    const double(*d)[3] = (const double(*)[3])t->direction;
    snprintf(text, sizeof text,
             "NRRD0004\ntype: uchar\ndimension: 3\n%ssizes: 2 3 4\nencoding: raw\nspace origin: (1,-2,3.5)\n"
             "space directions: (%g,%g,%g) (%g,%g,%g) (%g,%g,%g)\n\n",
             space, h * d[0][0], h * d[0][1], h * d[0][2], h * d[1][0], h * d[1][1], h * d[1][2], h * d[2][0],
             h * d[2][1], h * d[2][2]);
    put_text(made, text);
    put_voxels(made, 'u', 1, 0, 100);
}

static void put_turned_mhd(sample *made, const turn *t, double h)
{
    char text[512];
    const double(*d)[3] = (const double(*)[3])t->direction;
    snprintf(text, sizeof text,
             "NDims = 3\nDimSize = 2 3 4\nElementType = MET_UCHAR\nOffset = 1 -2 3.5\nElementSpacing = %g %g %g\n"
             "TransformMatrix = %g %g %g %g %g %g %g %g %g\nElementDataFile = LOCAL\n",
             h, h, h, d[0][0], d[0][1], d[0][2], d[1][0], d[1][1], d[1][2], d[2][0], d[2][1], d[2][2]);
    put_text(made, text);
    put_voxels(made, 'u', 1, 0, 100);
}

static void turned_and_mirrored_axes_are_those_of_space(void **state)
{
    const ms_scan_options options = ms_scan_defaults();
    (void)state;
    for (int which = 0; which < 48; which++) {
        const turn t = make_turn(which);
        for (int format = 0; format < 4; format++) {
            sample made = {.size = 0};
            ms_bytes bytes;
            if (format == 0) {
                put_turned_mhd(&made, &t, 0.25);
            } else {
                put_turned_nrrd(&made, &t, 0.25,
                                format == 1   ? "space: left-posterior-superior\n"
                                : format == 2 ? "space: left-anterior-superior\n"
                                              : "space: 3D-left-handed\n");
            }
            ms_scan scan = open_sample(&made, &bytes, format == 0 ? "s.mha" : "s.nrrd", &options);
            assert_places(&scan, &t, 0.25, format > 1 ? -1 : 1); /* a left-handed space is turned round in x */
            ms_scan_close(&scan);
            ms_file_free(&bytes);
        }
    }
}

/* A volume of one kind of number with spacings. */
static void put_spaced(sample *made, const char *type, const char *spacings)
{
    char text[256];
    snprintf(text, sizeof text,
             "NRRD0004\ntype: %s\ndimension: 3\nsizes: 2 3 4\nencoding: raw\nendian: little\n"
             "spacings: %s\nspace origin: (1,-2,3.5)\n\n",
             type, spacings);
    put_text(made, text);
}

/* Centre of a voxel of the grid along an axis, in voxels of the file from the first one. */
static double place_in_file(const ms_scan *scan, int a, int i)
{
    return (scan->origin[a] + scan->spacing * i - ORIGIN[a]) / scan->stored_spacing[a];
}

static void labels_of_unequal_spacings_are_the_nearest(void **state)
{
    static const char *const SPACINGS[] = {"1 3 1", "0.7 1 1.9", "2 2 0.5"};
    static const int EXTENTS[][3] = {{2, 9, 4}, {2, 4, 11}, {8, 12, 4}};
    const ms_scan_options options = ms_scan_defaults();
    (void)state;
    for (int s = 0; s < 3; s++) {
        sample made = {.size = 0};
        ms_bytes bytes;
        ms_volume v;
        put_spaced(&made, "uchar", SPACINGS[s]);
        put_voxels(&made, 'u', 1, 0, 100);
        ms_scan scan = open_sample(&made, &bytes, "s.nrrd", &options);
        assert_true(scan.is_resampled);
        assert_memory_equal(scan.n, EXTENTS[s], sizeof scan.n);
        assert_int_equal(ms_scan_volume(&v, &scan, SIZE_MAX, NULL), MS_OK);
        const int n[3] = {NX, NY, NZ};
        for (int a = 0; a < 3; a++) { /* both boxes have one middle */
            const double middle = place_in_file(&scan, a, 0) + place_in_file(&scan, a, v.n[a] - 1);
            assert_true(fabs(middle - (n[a] - 1)) < 1e-12);
        }
        for (int i = 0; i < v.n[0] * v.n[1] * v.n[2]; i++) {
            const int at[3] = {i % v.n[0], i / v.n[0] % v.n[1], i / v.n[0] / v.n[1]};
            int nearest[3] = {0, 0, 0};
            for (int a = 0; a < 3; a++) {
                const double p = place_in_file(&scan, a, at[a]);
                for (int k = 1; k < n[a]; k++) {
                    nearest[a] = fabs(p - k) < fabs(p - nearest[a]) ? k : nearest[a];
                }
            }
            assert_int_equal(v.label[i], known_label((nearest[2] * NY + nearest[1]) * NX + nearest[0], 100));
        }
        ms_volume_free(&v);
        ms_scan_close(&scan);
        ms_file_free(&bytes);
    }
}

/* Of values that are linear in space, voxels above a number are those of the formula, up to the outermost centres. */
static void grey_values_of_unequal_spacings_are_linear(void **state)
{
    ms_scan_options options = ms_scan_defaults();
    sample made = {.size = 0};
    ms_bytes bytes;
    ms_volume v;
    const int n[3] = {NX, NY, NZ};
    const double slope[3] = {2.385, -3.1, 1.7};
    (void)state;
    put_spaced(&made, "float", "1.9 0.6 1.3");
    for (int i = 0; i < N_VOXELS; i++) {
        put_float32(&made, slope[0] * (i % NX) + slope[1] * (i / NX % NY) + slope[2] * (i / NX / NY), 0);
    }
    options.values = MS_SCAN_THRESHOLD;
    options.threshold = 0.777;
    ms_scan scan = open_sample(&made, &bytes, "s.nrrd", &options);
    assert_true(scan.is_resampled && scan.threshold == 0.777);
    assert_int_equal(ms_scan_volume(&v, &scan, SIZE_MAX, NULL), MS_OK);
    size_t inside = 0;
    for (int i = 0; i < v.n[0] * v.n[1] * v.n[2]; i++) {
        const int at[3] = {i % v.n[0], i / v.n[0] % v.n[1], i / v.n[0] / v.n[1]};
        double value = 0;
        for (int a = 0; a < 3; a++) {
            value += slope[a] * fmin(fmax(place_in_file(&scan, a, at[a]), 0), n[a] - 1);
        }
        assert_true(fabs(value - 0.777) > 1e-5); /* no doubt by rounding */
        assert_int_equal(v.label[i] != 0, value > 0.777);
        inside += v.label[i] != 0;
    }
    assert_true(inside > 0 && inside < (size_t)(v.n[0] * v.n[1] * v.n[2]));
    ms_volume_free(&v);
    ms_scan_close(&scan);
    ms_file_free(&bytes);
}

static ms_scan_options raw_options(const char *type)
{
    ms_scan_options options = ms_scan_defaults();
    assert_int_equal(ms_scan_raw_type(&options.raw_sample, &options.raw_big_endian, type, NULL), MS_OK);
    options.raw_n[0] = NX;
    options.raw_n[1] = NY;
    options.raw_n[2] = NZ;
    return options;
}

static void raw_files_are_what_is_said(void **state)
{
    static const struct {
        const char *type;
        char kind;
        size_t size;
        int big;
    } types[] = {{"u8", 'u', 1, 0},    {"i8", 'i', 1, 0},    {"u16", 'u', 2, 0},   {"u16be", 'u', 2, 1},
                 {"i16le", 'i', 2, 0}, {"u32", 'u', 4, 0},   {"u32be", 'u', 4, 1}, {"i32be", 'i', 4, 1},
                 {"u64", 'u', 8, 0},   {"i64be", 'i', 8, 1}, {"f32", 'f', 4, 0},   {"f64be", 'f', 8, 1}};
    (void)state;
    for (size_t t = 0; t < sizeof types / sizeof *types; t++) {
        ms_scan_options options = raw_options(types[t].type);
        sample made = {.size = 0};
        ms_bytes bytes;
        ms_volume v;
        put_text(&made, "skip");
        put_voxels(&made, types[t].kind, types[t].size, types[t].big, 100);
        options.raw_skip = 4;
        for (int a = 0; a < 3; a++) {
            options.spacing[a] = 0.125;
        }
        ms_scan scan = open_sample(&made, &bytes, "s.raw", &options);
        assert_int_equal(ms_scan_volume(&v, &scan, SIZE_MAX, NULL), MS_OK);
        assert_true(v.spacing == 0.125 && v.n[0] == NX && v.n[2] == NZ);
        for (int i = 0; i < N_VOXELS; i++) {
            assert_int_equal(v.label[i], known_label(i, 100));
        }
        ms_volume_free(&v);
        ms_scan_close(&scan);
        ms_file_free(&bytes);
        options.raw_skip = 3;
        expect_refused(&made, "s.raw", &options, SIZE_MAX, MS_ERR_FORMAT, "check raw-size, raw-type and raw-skip");
    }
    sample made = {.size = 0};
    const ms_scan_options none = ms_scan_defaults();
    put_text(&made, "abc");
    expect_refused(&made, "s.raw", &none, SIZE_MAX, MS_ERR_FORMAT, "say what it holds (raw-size");
    static const char *const BAD[] = {"", "u", "u12", "f16", "u16xe", "16", "u16leb", "d8"};
    for (size_t b = 0; b < sizeof BAD / sizeof *BAD; b++) {
        ms_sample kind;
        int big;
        assert_int_equal(ms_scan_raw_type(&kind, &big, BAD[b], NULL), MS_ERR_ARG);
    }
}

static void put_gzip(sample *to, const sample *from)
{
    z_stream stream = {0};
    assert_int_equal(deflateInit2(&stream, 9, Z_DEFLATED, 31, 8, Z_DEFAULT_STRATEGY), Z_OK);
    sample copy = *from;
    stream.next_in = copy.data;
    stream.avail_in = (uInt)copy.size;
    stream.next_out = to->data + to->size;
    stream.avail_out = (uInt)(sizeof to->data - to->size);
    assert_int_equal(deflate(&stream, Z_FINISH), Z_STREAM_END);
    to->size += stream.total_out;
    deflateEnd(&stream);
}

static void packed_files_are_unpacked(void **state)
{
    const ms_scan_options options = raw_options("u16");
    sample made = {.size = 0}, packed = {.size = 0};
    ms_bytes bytes;
    ms_volume v;
    (void)state;
    put_voxels(&made, 'u', 2, 0, 100);
    put_gzip(&packed, &made);
    ms_scan scan = open_sample(&packed, &bytes, "s.raw.gz", &options);
    assert_int_equal(scan.held, 2 * N_VOXELS);
    ms_file_free(&bytes); /* not needed any more */
    assert_int_equal(ms_scan_volume(&v, &scan, SIZE_MAX, NULL), MS_OK);
    assert_int_equal(v.label[5], known_label(5, 100));
    ms_volume_free(&v);
    ms_scan_close(&scan);
    put_text(&packed, "x");
    expect_refused(&packed, "s.raw.gz", &options, SIZE_MAX, MS_ERR_FORMAT, "1 bytes follow behind its packed data");
    packed.size -= 9;
    expect_refused(&packed, "s.raw.gz", &options, SIZE_MAX, MS_ERR_FORMAT, "are cut at byte");
    expect_refused(&made, "s.npy.gz", &options, SIZE_MAX, MS_ERR_FORMAT, "its packed data are damaged");
}

/* What is unpacked is bounded before it fills the memory. */
static void packed_files_are_bounded(void **state)
{
    const ms_scan_options options = raw_options("u8");
    ms_scan scan;
    ms_error err;
    const size_t many = (size_t)8 << 20;
    (void)state;
    uint8_t *zeros = calloc(many, 1), *packed = malloc(many);
    z_stream stream = {0};
    assert_true(zeros && packed);
    assert_int_equal(deflateInit2(&stream, 9, Z_DEFLATED, 31, 8, Z_DEFAULT_STRATEGY), Z_OK);
    stream.next_in = zeros;
    stream.avail_in = (uInt)many;
    stream.next_out = packed;
    stream.avail_out = (uInt)many;
    assert_int_equal(deflate(&stream, Z_FINISH), Z_STREAM_END);
    const ms_bytes bytes = {.data = packed, .size = stream.total_out};
    deflateEnd(&stream);
    assert_int_equal(ms_scan_parse(&scan, &bytes, "s.raw.gz", &options, N_VOXELS, &err), MS_ERR_LIMIT);
    expect_message(&err, "s.raw.gz: unpacked it has more than");
    free(zeros);
    free(packed);
}

/* Two grains, of 9 and 10 among noise of 1 to 3, that touch at an edge. */
static void put_grey(sample *made, const char *type)
{
    static const int VALUE[N_VOXELS] = {9, 1, 2, 9, 3, 1, 10, 1, 2, 9, 1, 1, 1, 2, 1, 3, 2, 1, 1, 1, 2, 1, 9, 9};
    put_spaced(made, type, "1 1 1");
    for (int i = 0; i < N_VOXELS; i++) {
        if (strcmp(type, "float") == 0) {
            put_float32(made, VALUE[i] - 5.5, 0);
        } else {
            put_integer(made, (uint64_t)VALUE[i], 1, 0);
        }
    }
}

static void grey_values_become_labels(void **state)
{
    static const char *const TYPES[] = {"uchar", "float"};
    static const struct {
        int connectivity;
        size_t labels;
    } CASES[] = {{6, 3}, {18, 2}, {26, 2}};
    (void)state;
    for (int t = 0; t < 2; t++) {
        sample made = {.size = 0};
        put_grey(&made, TYPES[t]);
        for (int c = 0; c < 3; c++) {
            for (int otsu = 0; otsu < 2; otsu++) {
                ms_scan_options options = ms_scan_defaults();
                ms_bytes bytes;
                ms_labels labels;
                options.values = otsu ? MS_SCAN_OTSU : MS_SCAN_THRESHOLD;
                options.threshold = t ? 0.5 : 6;
                options.connectivity = CASES[c].connectivity;
                ms_scan scan = open_sample(&made, &bytes, "s.nrrd", &options);
                ms_file_free(&bytes); /* the labels are the scan's own */
                assert_true(fabs(scan.threshold - (t ? 0.5 : 6)) < (t && otsu ? 1e-3 : 1e-300));
                assert_int_equal(scan.held, 4 * N_VOXELS);
                assert_int_equal(ms_labels_find_in_scan(&labels, &scan, NULL), MS_OK);
                assert_int_equal(labels.count, CASES[c].labels);
                ms_labels_free(&labels);
                ms_scan_close(&scan);
            }
        }
    }
}

static void grey_values_that_cannot_be_divided_are_refused(void **state)
{
    ms_scan_options options = ms_scan_defaults();
    sample made = {.size = 0}, even = {.size = 0}, holed = {.size = 0};
    (void)state;
    put_grey(&made, "uchar");
    options.values = MS_SCAN_THRESHOLD;
    options.threshold = 10;
    expect_refused(&made, "s.nrrd", &options, SIZE_MAX, MS_ERR_SHAPE,
                   "no voxel is above 10; its values are from 1 to 10");
    expect_refused(&made, "s.nrrd", &options, N_VOXELS - 1, MS_ERR_LIMIT, "more than the 23 allowed");
    options.threshold = 5;
    options.connectivity = 7;
    expect_refused(&made, "s.nrrd", &options, SIZE_MAX, MS_ERR_ARG, "a connectivity of 7");
    options = ms_scan_defaults();
    options.values = MS_SCAN_OTSU;
    put_spaced(&even, "uchar", "1 1 1");
    put_spaced(&holed, "float", "1 1 1");
    for (int i = 0; i < N_VOXELS; i++) {
        put_integer(&even, 4, 1, 0);
        put_float32(&holed, i == 7 ? (double)NAN : i, 0);
    }
    expect_refused(&even, "s.nrrd", &options, SIZE_MAX, MS_ERR_SHAPE, "all its voxels hold 4");
    expect_refused(&holed, "s.nrrd", &options, SIZE_MAX, MS_ERR_FORMAT, "voxel (1, 0, 1) holds nan");
}

/* Of a mapped file, boxes and slices are those of the whole. */
static void boxes_are_those_of_the_whole(void **state)
{
    char folder[64], path[128];
    const ms_scan_options options = raw_options("u16be");
    sample made = {.size = 0};
    ms_scan scan;
    ms_labels labels;
    ms_error err = {{0}};
    (void)state;
    make_folder(folder);
    put_voxels(&made, 'u', 2, 1, 100);
    write_file(path, folder, "s.raw", made.data, made.size);
    assert_int_equal(ms_scan_open(&scan, path, &options, 0, &err), MS_OK); /* not one voxel need be unpacked */
    assert_int_equal(scan.held, 0);
    for (int z = 0; z < NZ; z++) {
        for (int hi = z + 1; hi <= NZ; hi++) {
            const int lo[3] = {1, 0, z}, end[3] = {NX, 2, hi};
            uint32_t label[N_VOXELS];
            assert_int_equal(ms_scan_take(label, &scan, lo, end, NULL), MS_OK);
            for (int i = 0; i < 2 * (hi - z); i++) {
                assert_int_equal(label[i], known_label(((z + i / 2) * NY + i % 2) * NX + 1, 100));
            }
        }
    }
    assert_int_equal(ms_labels_find_in_scan(&labels, &scan, NULL), MS_OK);
    for (size_t l = 0; l < labels.count; l++) {
        ms_volume crop;
        size_t voxels = 0;
        assert_int_equal(ms_labels_crop_scan(&crop, &scan, &labels.entry[l], NULL), MS_OK);
        for (int i = 0; i < crop.n[0] * crop.n[1] * crop.n[2]; i++) {
            assert_true(crop.label[i] == 0 || crop.label[i] == labels.entry[l].label);
            voxels += crop.label[i] != 0;
        }
        assert_int_equal(voxels, labels.entry[l].voxels);
        assert_memory_equal(crop.first, labels.entry[l].lo, sizeof crop.first);
        ms_volume_free(&crop);
    }
    ms_labels_free(&labels);
    ms_volume v;
    assert_int_equal(ms_scan_volume(&v, &scan, N_VOXELS - 1, &err), MS_ERR_LIMIT);
    ms_scan_close(&scan);
    unlink(path);
    assert_int_equal(ms_scan_open(&scan, path, &options, 0, &err), MS_ERR_IO);
    expect_message(&err, "cannot be opened");
    rmdir(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(turned_and_mirrored_axes_are_those_of_space),
        cmocka_unit_test(labels_of_unequal_spacings_are_the_nearest),
        cmocka_unit_test(grey_values_of_unequal_spacings_are_linear),
        cmocka_unit_test(raw_files_are_what_is_said),
        cmocka_unit_test(packed_files_are_unpacked),
        cmocka_unit_test(packed_files_are_bounded),
        cmocka_unit_test(grey_values_become_labels),
        cmocka_unit_test(grey_values_that_cannot_be_divided_are_refused),
        cmocka_unit_test(boxes_are_those_of_the_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
