/* TIFF, put together by hand: what is read and what is refused. */
#include <sys/stat.h>
#include <unistd.h>

#include "support/volume_samples.h"

#if MS_WITH_TIFF

enum { BYTE = 1, ASCII = 2, SHORT = 3, LONG = 4, RATIONAL = 5 };

/* One page; 0 of a field: as TIFF has it without. */
typedef struct tiff_fields {
    int big, width, height, bits, format, samples, photometric, compression, rows_per_strip, subfile;
    int resolution; /* voxels in a unit of length along x and y */
    const char *description;
    char kind;
} tiff_fields;

static tiff_fields usual(void)
{
    return (tiff_fields){.width = NX,
                         .height = NY,
                         .bits = 8,
                         .samples = 1,
                         .photometric = 1,
                         .compression = 1,
                         .rows_per_strip = 2,
                         .kind = 'u'};
}

static void patch(sample *to, size_t at, uint64_t value, size_t size, int big)
{
    sample bytes = {.size = 0};
    put_integer(&bytes, value, size, big);
    memcpy(to->data + at, bytes.data, size);
}

static void put_entry(sample *to, int tag, int type, size_t count, uint64_t value, int big)
{
    put_integer(to, (uint64_t)tag, 2, big);
    put_integer(to, (uint64_t)type, 2, big);
    put_integer(to, count, 4, big);
    if (type == SHORT && count == 1) {
        put_integer(to, value, 2, big);
        put_integer(to, 0, 2, big);
    } else {
        put_integer(to, value, 4, big);
    }
}

/* Where the offset of the first directory stands. */
static size_t begin_tiff(sample *to, int big)
{
    put_text(to, big ? "MM" : "II");
    put_integer(to, 42, 2, big);
    put_integer(to, 0, 4, big);
    return 4;
}

static void put_page_voxels(sample *to, const tiff_fields *f, int page)
{
    for (int i = page * f->width * f->height; i < (page + 1) * f->width * f->height; i++) {
        if (f->kind == 'f' && f->bits == 64) {
            put_float64(to, known_label(i, 100), f->big);
        } else if (f->kind == 'f') {
            put_float32(to, known_label(i, 100), f->big);
        } else {
            put_integer(to, known_label(i, 100), (size_t)f->bits / 8, f->big);
        }
    }
}

/* Where the strips are, and their sizes, both two or more; returns the place of the offsets. */
static size_t put_strips(sample *to, const tiff_fields *f, size_t voxels, size_t *strips)
{
    const size_t row = (size_t)f->width * (size_t)f->bits / 8, rows = (size_t)f->rows_per_strip;
    *strips = ((size_t)f->height + rows - 1) / rows;
    const size_t at = to->size;
    for (size_t s = 0; s < *strips; s++) {
        put_integer(to, voxels + s * rows * row, 4, f->big);
    }
    for (size_t s = 0; s < *strips; s++) {
        const size_t left = (size_t)f->height - s * rows;
        put_integer(to, row * (left < rows ? left : rows), 4, f->big);
    }
    return at;
}

/* Puts a page, to which the offset at `link` leads; returns where the next link stands. */
static size_t put_page(sample *to, const tiff_fields *f, int page, size_t link)
{
    size_t strips;
    const size_t voxels = to->size;
    put_page_voxels(to, f, page);
    const size_t table = put_strips(to, f, voxels, &strips);
    const size_t text = to->size, length = f->description ? strlen(f->description) + 1 : 0;
    put_bytes(to, f->description ? f->description : "", length);
    const size_t ratio = to->size;
    put_integer(to, (uint64_t)f->resolution, 4, f->big);
    put_integer(to, 1, 4, f->big);
    put_bytes(to, "", to->size % 2);
    patch(to, link, to->size, 4, f->big);
    const size_t count_at = to->size;
    int count = 0;
    put_integer(to, 0, 2, f->big);
#define ENTRY(wanted, ...)                  \
    if (wanted) {                           \
        put_entry(to, __VA_ARGS__, f->big); \
        count++;                            \
    }
    ENTRY(f->subfile, 254, LONG, 1, (uint64_t)f->subfile)
    ENTRY(f->width, 256, LONG, 1, (uint64_t)f->width)
    ENTRY(f->height, 257, LONG, 1, (uint64_t)f->height)
    ENTRY(1, 258, SHORT, 1, (uint64_t)f->bits)
    ENTRY(1, 259, SHORT, 1, (uint64_t)f->compression)
    ENTRY(1, 262, SHORT, 1, (uint64_t)f->photometric)
    ENTRY(length, 270, ASCII, length, text)
    ENTRY(1, 273, LONG, strips, table)
    ENTRY(1, 277, SHORT, 1, (uint64_t)f->samples)
    ENTRY(1, 278, LONG, 1, (uint64_t)f->rows_per_strip)
    ENTRY(1, 279, LONG, strips, table + 4 * strips)
    ENTRY(f->resolution, 282, RATIONAL, 1, ratio)
    ENTRY(f->resolution, 283, RATIONAL, 1, ratio)
    ENTRY(f->format, 339, SHORT, 1, (uint64_t)f->format)
#undef ENTRY
    patch(to, count_at, (uint64_t)count, 2, f->big);
    put_integer(to, 0, 4, f->big);
    return to->size - 4;
}

static void put_tiff(sample *to, const tiff_fields *f, int pages)
{
    size_t link = begin_tiff(to, f->big);
    for (int page = 0; page < pages; page++) {
        link = put_page(to, f, page, link);
    }
}

static void every_type_is_read(void **state)
{
    static const struct {
        char kind;
        int bits, format;
    } types[] = {{'u', 8, 0},  {'u', 8, 1},  {'u', 16, 1}, {'u', 32, 1}, {'i', 8, 2},
                 {'i', 16, 2}, {'i', 32, 2}, {'f', 32, 3}, {'f', 64, 3}, {'u', 16, 4}};
    (void)state;
    for (size_t t = 0; t < sizeof types / sizeof *types; t++) {
        for (int big = 0; big < 2; big++) {
            sample made = {.size = 0};
            tiff_fields f = usual();
            f.big = big;
            f.kind = types[t].kind;
            f.bits = types[t].bits;
            f.format = types[t].format;
            f.photometric = (int)t % 2; /* values as they are stored, whichever of them is drawn white */
            put_tiff(&made, &f, NZ);
            expect_volume(ms_volume_parse_tiff, &made, "sample", 100);
        }
    }
}

/* A preview among the pages is passed over. */
static void previews_are_no_slices(void **state)
{
    sample made = {.size = 0};
    tiff_fields f = usual(), preview = usual();
    (void)state;
    preview.subfile = 1;
    preview.width = 1;
    size_t link = begin_tiff(&made, 0);
    for (int page = 0; page < NZ; page++) {
        link = put_page(&made, &f, page, link);
        link = page == 1 ? put_page(&made, &preview, 0, link) : link;
    }
    expect_volume(ms_volume_parse_tiff, &made, "sample", 100);
}

static void imagej_says_spacings(void **state)
{
    sample made = {.size = 0};
    tiff_fields f = usual();
    ms_volume v;
    (void)state;
    f.description = "ImageJ=1.53t\nimages=4\nslices=4\nunit=micron\nspacing=0.5\n";
    f.resolution = 2;
    put_tiff(&made, &f, NZ);
    assert_int_equal(parse_volume(&v, ms_volume_parse_tiff, &made, "sample", NULL), MS_OK);
    assert_true(v.spacing == 0.5);
    ms_volume_free(&v);
    made.size = 0;
    f.description = "ImageJ=1.53t\nimages=4\nslices=4\nunit=micron\nspacing=1e-8\n";
    put_tiff(&made, &f, NZ);
    expect_volume_refused(ms_volume_parse_tiff, &made, MS_ERR_LIMIT, "cubes along one axis; resample it");
    made.size = 0;
    f.description = "ImageJ=1.53t\nimages=4\nslices=4\nunit=micron\nspacing=1e-60\n";
    put_tiff(&made, &f, NZ);
    expect_volume_refused(ms_volume_parse_tiff, &made, MS_ERR_FORMAT, "spacings must be from 1e-50");
    made.size = 0;
    put_tiff(&made, &f, NZ - 1);
    expect_volume_refused(ms_volume_parse_tiff, &made, MS_ERR_FORMAT, "ImageJ wrote 4 slices and pages for 3");
    made.size = 0;
    f.description = "ImageJ=1.53t\nimages=4\nslices=2\nframes=2\n";
    put_tiff(&made, &f, NZ);
    expect_volume_refused(ms_volume_parse_tiff, &made, MS_ERR_FORMAT, "is a hyperstack");
    made.size = 0;
    f.description = "ImageJ=1.53t\nimages=4\nframes=4\n"; /* slices that were called times */
    put_tiff(&made, &f, NZ);
    expect_volume(ms_volume_parse_tiff, &made, "sample", 100);
    made.size = 0;
    f.description = "ImageJ=1.53t\nimages=4\nchannels=2\nslices=2\n";
    put_tiff(&made, &f, NZ);
    expect_volume_refused(ms_volume_parse_tiff, &made, MS_ERR_FORMAT, "is a hyperstack");
}

static void refuse(tiff_fields f, const char *message)
{
    sample made = {.size = 0};
    put_tiff(&made, &f, 2);
    expect_volume_refused(ms_volume_parse_tiff, &made, MS_ERR_FORMAT, message);
}

static void broken_files_are_refused(void **state)
{
    tiff_fields f = usual();
    sample made = {.size = 0};
    (void)state;
    put_text(&made, "II");
    expect_volume_refused(ms_volume_parse_tiff, &made, MS_ERR_FORMAT, "page 1 cannot be read");
    f.samples = 3;
    refuse(f, "page 1 has 3 channels");
    f = usual();
    f.photometric = 2;
    refuse(f, "which are colours");
    f = usual();
    f.format = 6; /* complex */
    refuse(f, "page 1 has 8 bits of the sample format 6");
    f = usual();
    f.compression = 12345;
    refuse(f, "page 1 cannot be read");
    f = usual();
    f.width = 0;
    refuse(f, "page 1");
    /* Every cut of a good file. */
    f = usual();
    made.size = 0;
    put_tiff(&made, &f, NZ);
    for (size_t size = 1; size < made.size - 4; size += 3) {
        ms_volume v;
        sample cut = made;
        cut.size = size;
        if (parse_volume(&v, ms_volume_parse_tiff, &cut, "sample", NULL) != MS_ERR_FORMAT) {
            fail_msg("the first %zu of %zu bytes are read as %d slices", size, made.size, v.n[2]);
        }
    }
}

static void pages_are_of_one_kind(void **state)
{
    (void)state;
    for (int odd = 0; odd < 4; odd++) {
        sample made = {.size = 0};
        tiff_fields f = usual(), other = usual();
        other.width += odd == 0;
        other.height += odd == 1;
        other.bits = odd == 2 ? 16 : 8;
        other.format = odd == 3 ? 2 : 0;
        put_page(&made, &other, 0, put_page(&made, &f, 0, begin_tiff(&made, 0)));
        expect_volume_refused(ms_volume_parse_tiff, &made, MS_ERR_FORMAT, "a volume has slices of one kind");
    }
}

/* A page of 40000 x 40000 that a few bytes cannot hold is refused before memory is taken. */
static void claims_are_not_believed(void **state)
{
    sample made = {.size = 0};
    tiff_fields f = usual();
    (void)state;
    put_tiff(&made, &f, 1);
    const size_t directory = (size_t)made.data[4] | (size_t)made.data[5] << 8;
    patch(&made, directory + 2 + 8, 40000, 4, 0);
    patch(&made, directory + 2 + 12 + 8, 40000, 4, 0);
    expect_volume_refused(ms_volume_parse_tiff, &made, MS_ERR_FORMAT, "bytes cannot hold page 1 of 40000 x 40000");
}

static void write_slice(const char *folder, const char *name, int page, int pages)
{
    char path[128];
    sample made = {.size = 0};
    const tiff_fields f = usual();
    size_t link = begin_tiff(&made, 0);
    for (int p = 0; p < pages; p++) {
        link = put_page(&made, &f, page + p, link);
    }
    write_file(path, folder, name, made.data, made.size);
}

/* In the order of their numbers, with or without zeros in front. */
static void a_folder_of_slices_is_a_volume(void **state)
{
    static const char *const NAMES[][NZ] = {{"a1.tif", "a2.tif", "a010.tif", "a11.tif"},
                                            {"s0099.TIFF", "s0100.TIFF", "s0101.TIFF", "s1000.TIFF"}};
    char folder[64], path[160];
    (void)state;
    for (int set = 0; set < 2; set++) {
        ms_volume v;
        ms_error err = {{0}};
        make_folder(folder);
        assert_false(ms_volume_is_volume_path(folder));
        for (int page = 0; page < NZ; page++) {
            write_slice(folder, NAMES[set][page], page, 1);
        }
        write_file(path, folder, "notes.txt", "x", 1);
        assert_true(ms_volume_is_volume_path(folder));
        if (ms_volume_read(&v, folder, SIZE_MAX, &err) != MS_OK) {
            fail_msg("refused: %s", err.text);
        }
        for (int i = 0; i < N_VOXELS; i++) {
            assert_int_equal(v.label[i], known_label(i, 100));
        }
        ms_volume_free(&v);
        assert_int_equal(ms_volume_read(&v, folder, N_VOXELS - 1, &err), MS_ERR_LIMIT);
        write_slice(folder, NAMES[set][2], 0, 2);
        assert_int_equal(ms_volume_read(&v, folder, SIZE_MAX, &err), MS_ERR_FORMAT);
        expect_message(&err, "has 2 pages among files of one slice each");
        write_slice(folder, NAMES[set][0], 0, 2); /* several volumes, and no slices */
        assert_false(ms_volume_is_volume_path(folder));
        for (int page = 0; page < NZ; page++) {
            snprintf(path, sizeof path, "%s/%s", folder, NAMES[set][page]);
            unlink(path);
        }
        snprintf(path, sizeof path, "%s/notes.txt", folder);
        unlink(path);
        rmdir(folder);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_type_is_read),
        cmocka_unit_test(previews_are_no_slices),
        cmocka_unit_test(imagej_says_spacings),
        cmocka_unit_test(broken_files_are_refused),
        cmocka_unit_test(pages_are_of_one_kind),
        cmocka_unit_test(claims_are_not_believed),
        cmocka_unit_test(a_folder_of_slices_is_a_volume),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#else

static void what_is_missing_is_said(void **state)
{
    sample made = {.size = 0};
    (void)state;
    put_text(&made, "II");
    expect_volume_refused(ms_volume_parse_tiff, &made, MS_ERR_FORMAT, "built without libtiff");
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(what_is_missing_is_said)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#endif
