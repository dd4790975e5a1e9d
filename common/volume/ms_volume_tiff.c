/* TIFF by libtiff: pages of grey values or labels, one slice each. */
#include <stdlib.h>
#include <string.h>

#include "ms_volume_formats.h"

#if MS_WITH_TIFF

#include <tiffio.h>

/* A file in memory, as libtiff reads it. */
typedef struct tiff_source {
    const ms_bytes *bytes;
    toff_t at;
    char cause[256]; /* what libtiff said first */
} tiff_source;

static tmsize_t read_tiff(thandle_t handle, void *to, tmsize_t size)
{
    tiff_source *source = handle;
    const toff_t left = source->at < source->bytes->size ? source->bytes->size - source->at : 0;
    const size_t count = (toff_t)size < left ? (size_t)size : (size_t)left;
    if (count > 0) {
        memcpy(to, source->bytes->data + source->at, count);
    }
    source->at += count;
    if (count < (size_t)size && source->cause[0] == '\0') { /* of a link to the next page libtiff says nothing */
        snprintf(source->cause, sizeof source->cause, "the file ends before");
    }
    return (tmsize_t)count;
}

static tmsize_t write_nothing(thandle_t handle, void *from, tmsize_t size)
{
    (void)handle;
    (void)from;
    (void)size;
    return -1;
}

static toff_t seek_tiff(thandle_t handle, toff_t offset, int whence)
{
    tiff_source *source = handle;
    source->at = offset + (whence == SEEK_CUR ? source->at : whence == SEEK_END ? source->bytes->size : 0);
    return source->at;
}

static int close_nothing(thandle_t handle)
{
    (void)handle;
    return 0;
}

static toff_t measure_tiff(thandle_t handle)
{
    return ((tiff_source *)handle)->bytes->size;
}

static int keep_cause(TIFF *tiff, void *context, const char *module, const char *format, va_list list) MS_PRINTF(4, 0);

static int keep_cause(TIFF *tiff, void *context, const char *module, const char *format, va_list list)
{
    tiff_source *source = context;
    (void)tiff;
    (void)module;
    if (source->cause[0] == '\0') {
        vsnprintf(source->cause, sizeof source->cause, format, list);
    }
    return 1; /* nothing is printed */
}

static int ignore_warning(TIFF *tiff, void *context, const char *module, const char *format, va_list list)
{
    (void)tiff;
    (void)context;
    (void)module;
    (void)format;
    (void)list;
    return 1;
}

static TIFF *open_tiff(tiff_source *source, const ms_bytes *bytes)
{
    *source = (tiff_source){.bytes = bytes};
    TIFFOpenOptions *options = TIFFOpenOptionsAlloc();
    if (!options) {
        return NULL;
    }
    TIFFOpenOptionsSetErrorHandlerExtR(options, keep_cause, source);
    TIFFOpenOptionsSetWarningHandlerExtR(options, ignore_warning, NULL);
    /* "m": not mapped once more. */
    TIFF *tiff = TIFFClientOpenExt("", "rm", source, read_tiff, write_nothing, seek_tiff, close_nothing, measure_tiff,
                                   NULL, NULL, options);
    TIFFOpenOptionsFree(options);
    return tiff;
}

static ms_status fail_tiff(const tiff_source *source, size_t page, const char *path, ms_error *err)
{
    return ms_fail(err, MS_ERR_FORMAT, "%s: page %zu cannot be read: %s; fetch or save it again", path, page,
                   source->cause[0] ? source->cause : "it is damaged");
}

/* What a page says of itself. */
typedef struct tiff_page {
    uint32_t width, height;
    ms_sample sample;
} tiff_page;

static ms_status describe_page(tiff_page *page, TIFF *tiff, size_t number, const char *path, ms_error *err)
{
    uint16_t bits = 1, format = SAMPLEFORMAT_UINT, samples = 1, photometric = PHOTOMETRIC_MINISBLACK;
    TIFFGetFieldDefaulted(tiff, TIFFTAG_BITSPERSAMPLE, &bits);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLEFORMAT, &format);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLESPERPIXEL, &samples);
    TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &photometric);
    *page = (tiff_page){0};
    if (!TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &page->width) ||
        !TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &page->height) || page->width == 0 || page->height == 0) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: page %zu has no extents; save it again", path, number);
    }
    if (samples != 1 || photometric == PHOTOMETRIC_RGB || photometric == PHOTOMETRIC_YCBCR) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: page %zu has %d channels, which are colours; save one channel of grey",
                       path, number, samples);
    }
    const int whole = format == SAMPLEFORMAT_UINT || format == SAMPLEFORMAT_INT || format == SAMPLEFORMAT_VOID;
    if (!(bits == 8 || bits == 16 || bits == 32 || (bits == 64 && !whole)) ||
        !(whole || (format == SAMPLEFORMAT_IEEEFP && bits >= 32))) {
        return ms_fail(
            err, MS_ERR_FORMAT,
            "%s: page %zu has %d bits of the sample format %d; save it with whole numbers of 8, 16 or 32 bits "
            "or floats of 32",
            path, number, bits, format);
    }
    page->sample = (ms_sample){.kind = format == SAMPLEFORMAT_INT ? MS_SAMPLE_SIGNED
                                       : whole                    ? MS_SAMPLE_UNSIGNED
                                                                  : MS_SAMPLE_FLOAT,
                               .size = bits / 8};
    return MS_OK;
}

/* The first page says what all are like. */
static ms_status match_page(ms_volume_header *header, const tiff_page *page, size_t number, const char *path,
                            ms_error *err)
{
    if (header->n[2] == 0) {
        header->n[0] = page->width;
        header->n[1] = page->height;
        header->sample = page->sample;
        return MS_OK;
    }
    if (header->n[0] != page->width || header->n[1] != page->height || header->sample.size != page->sample.size ||
        header->sample.kind != page->sample.kind) {
        return ms_fail(
            err, MS_ERR_FORMAT,
            "%s: page %zu is of %u x %u voxels of %zu bytes and those before are of %lld x %lld of %zu, or of "
            "another type; a volume has slices of one kind",
            path, number, page->width, page->height, page->sample.size, (long long)header->n[0],
            (long long)header->n[1], header->sample.size);
    }
    return MS_OK;
}

/* Room for one more page. */
static ms_status grow_stored(ms_stored *stored, size_t page_bytes, const char *path, ms_error *err)
{
    const size_t used = page_bytes * (size_t)stored->header.n[2], wanted = used + page_bytes;
    if (wanted > stored->owned.size) {
        const size_t room = wanted > stored->owned.size + stored->owned.size / 2 ? wanted : wanted + wanted / 2;
        uint8_t *grown = realloc(stored->owned.data, room);
        if (!grown) {
            return ms_fail(err, MS_ERR_NOMEM, "%s: no memory for %zu bytes of voxels; crop it", path, room);
        }
        stored->owned.data = grown;
        stored->owned.size = room;
    }
    return MS_OK;
}

static int read_strips(uint8_t *to, TIFF *tiff, size_t page_bytes)
{
    const uint32_t strips = TIFFNumberOfStrips(tiff);
    size_t done = 0;
    for (uint32_t s = 0; s < strips && done < page_bytes; s++) {
        const tmsize_t got = TIFFReadEncodedStrip(tiff, s, to + done, (tmsize_t)(page_bytes - done));
        if (got <= 0) {
            return 0;
        }
        done += (size_t)got;
    }
    return done == page_bytes;
}

/* Copies what of a tile lies within the page. */
static void place_tile(uint8_t *to, const uint8_t *tile, const tiff_page *page, const uint32_t at[2],
                       const uint32_t size[2])
{
    const size_t voxel = page->sample.size;
    const uint32_t columns = page->width - at[0] < size[0] ? page->width - at[0] : size[0],
                   rows = page->height - at[1] < size[1] ? page->height - at[1] : size[1];
    for (uint32_t r = 0; r < rows; r++) {
        memcpy(to + ((size_t)(at[1] + r) * page->width + at[0]) * voxel, tile + (size_t)r * size[0] * voxel,
               columns * voxel);
    }
}

/* Deflate packs 1 : 1032 and LZW 1 : 1365, LZMA some 1 : 7000; a run of 128 kB takes Zstandard 4 bytes. */
static int can_hold(TIFF *tiff, size_t file, size_t page_bytes)
{
    enum { MOST_RATIO = 2048, MOST_RATIO_OF_LATER = 1 << 15 };
    uint16_t compression = COMPRESSION_NONE;
    TIFFGetFieldDefaulted(tiff, TIFFTAG_COMPRESSION, &compression);
    const int later = compression == COMPRESSION_ZSTD || compression == COMPRESSION_LZMA;
    return page_bytes / (later ? MOST_RATIO_OF_LATER : MOST_RATIO) <= file;
}

static int read_tiles(uint8_t *to, TIFF *tiff, const tiff_page *page, size_t file)
{
    uint32_t size[2] = {0, 0};
    const tmsize_t bytes = TIFFTileSize(tiff);
    TIFFGetField(tiff, TIFFTAG_TILEWIDTH, &size[0]);
    TIFFGetField(tiff, TIFFTAG_TILELENGTH, &size[1]);
    if (bytes <= 0 || (size_t)bytes != (size_t)size[0] * size[1] * page->sample.size ||
        !can_hold(tiff, file, (size_t)bytes)) {
        return 0;
    }
    uint8_t *tile = malloc((size_t)bytes);
    int ok = tile != NULL;
    for (uint64_t y = 0; y < page->height && ok; y += size[1]) {
        for (uint64_t x = 0; x < page->width && ok; x += size[0]) {
            const uint32_t at[2] = {(uint32_t)x, (uint32_t)y};
            ok = TIFFReadTile(tiff, tile, at[0], at[1], 0, 0) == bytes;
            if (ok) {
                place_tile(to, tile, page, at, size);
            }
        }
    }
    free(tile);
    return ok;
}

static ms_status add_page(ms_stored *stored, TIFF *tiff, const tiff_source *source, const char *path, size_t max_voxels,
                          size_t number, ms_error *err)
{
    tiff_page page;
    size_t bytes;
    ms_status status = describe_page(&page, tiff, number, path, err);
    if (status == MS_OK) {
        status = match_page(&stored->header, &page, number, path, err);
    }
    if (status != MS_OK) {
        return status;
    }
    ms_volume_header whole = stored->header;
    whole.n[2]++;
    whole.coding = MS_CODING_DEFLATE; /* it is held */
    whole.max_voxels = max_voxels;
    status = ms_volume_data_size(&bytes, &whole, path, err);
    bytes /= (size_t)whole.n[2];
    if (status == MS_OK && !can_hold(tiff, source->bytes->size, bytes)) {
        status = ms_fail(err, MS_ERR_FORMAT, "%s: its %zu bytes cannot hold page %zu of %u x %u voxels; fetch it again",
                         path, source->bytes->size, number, page.width, page.height);
    }
    if (status == MS_OK) {
        status = grow_stored(stored, bytes, path, err);
    }
    if (status != MS_OK) {
        return status;
    }
    uint8_t *to = stored->owned.data + bytes * (size_t)stored->header.n[2];
    if (!(TIFFIsTiled(tiff) ? read_tiles(to, tiff, &page, source->bytes->size) : read_strips(to, tiff, bytes))) {
        return fail_tiff(source, number, path, err);
    }
    stored->header.n[2]++;
    return MS_OK;
}

/* What follows behind a word in ImageJ's description; 0 without it, and for what is no count or length. */
static double find_number(const char *text, const char *word)
{
    const char *at = strstr(text, word);
    const double value = at ? strtod(at + strlen(word), NULL) : 0;
    return value > 0 && value < 1e15 ? value : 0;
}

/* ImageJ says the distances of voxels, and writes stacks above 4 GB with one page for all slices. */
static ms_status heed_imagej(ms_stored *stored, TIFF *tiff, long long *images, const char *path, ms_error *err)
{
    const char *text = NULL;
    float x = 0, y = 0;
    *images = 0;
    if (!TIFFGetField(tiff, TIFFTAG_IMAGEDESCRIPTION, &text) || strncmp(text, "ImageJ=", 7) != 0) {
        return MS_OK;
    }
    *images = (long long)find_number(text, "\nimages=");
    /* Slices are often called times or channels; but one thing they must be. */
    if ((find_number(text, "\nslices=") > 1) + (find_number(text, "\nframes=") > 1) +
            (find_number(text, "\nchannels=") > 1) >
        1) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: is a hyperstack of slices by channels or times; save one of these",
                       path);
    }
    const double z = find_number(text, "\nspacing=");
    if (z > 0 && TIFFGetField(tiff, TIFFTAG_XRESOLUTION, &x) && TIFFGetField(tiff, TIFFTAG_YRESOLUTION, &y) && x > 0 &&
        y > 0) {
        const double d[3] = {1 / (double)x, 1 / (double)y, z};
        memcpy(stored->header.spacing, d, sizeof d);
    }
    return MS_OK;
}

static int is_preview(TIFF *tiff)
{
    uint32_t kind = 0;
    return TIFFGetField(tiff, TIFFTAG_SUBFILETYPE, &kind) && (kind & FILETYPE_REDUCEDIMAGE);
}

static ms_status read_pages(ms_stored *stored, TIFF *tiff, const tiff_source *source, const char *path,
                            size_t max_voxels, ms_error *err)
{
    long long images;
    size_t number = 1;
    ms_status status = heed_imagej(stored, tiff, &images, path, err);
    for (int more = 1; more && status == MS_OK; number++) {
        status = is_preview(tiff) ? MS_OK : add_page(stored, tiff, source, path, max_voxels, number, err);
        more = status == MS_OK && TIFFReadDirectory(tiff);
    }
    if (status == MS_OK && source->cause[0]) {
        status = fail_tiff(source, number, path, err);
    }
    if (status == MS_OK && images > stored->header.n[2]) {
        status = ms_fail(err, MS_ERR_FORMAT,
                         "%s: ImageJ wrote %lld slices and pages for %lld; save it as BigTIFF, as .nrrd or raw", path,
                         images, (long long)stored->header.n[2]);
    }
    return status;
}

/* All pages of a file behind what is there. */
static ms_status add_pages(ms_stored *stored, const ms_bytes *bytes, const char *path, size_t max_voxels, ms_error *err)
{
    tiff_source source;
    if (stored->header.n[2] == 0) {
        stored->header = ms_volume_header_start(max_voxels);
        stored->header.big_endian = ms_volume_is_big_endian(); /* libtiff swaps */
    }
    TIFF *tiff = open_tiff(&source, bytes);
    if (!tiff) {
        return fail_tiff(&source, 1, path, err);
    }
    const ms_status status = read_pages(stored, tiff, &source, path, max_voxels, err);
    TIFFClose(tiff);
    stored->data = stored->owned.data;
    return status;
}

int ms_volume_tiff_is_slice(const ms_bytes *bytes)
{
    tiff_source source;
    TIFF *tiff = open_tiff(&source, bytes);
    const int is_slice = tiff && !TIFFReadDirectory(tiff);
    if (tiff) {
        TIFFClose(tiff);
    }
    return is_slice;
}

#else

static ms_status refuse_file(ms_stored *stored, const ms_bytes *bytes, const char *path, size_t max_voxels,
                             ms_error *err)
{
    (void)stored;
    (void)bytes;
    (void)max_voxels;
    return ms_fail(err, MS_ERR_FORMAT,
                   "%s: TIFF is not read by this mskit, which was built without libtiff; build it with libtiff 4.5 or "
                   "later (-Dtiff=enabled), or save the volume as .npy or .nrrd",
                   path);
}

/* A folder of what may be slices is taken for one, and the first of them says what is missing. */
int ms_volume_tiff_is_slice(const ms_bytes *bytes)
{
    return bytes->size > 0;
}

#endif

static ms_status load_pages(ms_stored *stored, const ms_bytes *bytes, const char *path, size_t max_voxels,
                            ms_error *err)
{
#if MS_WITH_TIFF
    return add_pages(stored, bytes, path, max_voxels, err);
#else
    return refuse_file(stored, bytes, path, max_voxels, err);
#endif
}

ms_status ms_volume_tiff_add(ms_stored *stored, const ms_bytes *bytes, const char *path, size_t max_voxels,
                             ms_error *err)
{
    const int64_t before = stored->header.n[2];
    const ms_status status = load_pages(stored, bytes, path, max_voxels, err);
    return status == MS_OK && stored->header.n[2] != before + 1
               ? ms_fail(err, MS_ERR_FORMAT,
                         "%s: has %lld pages among files of one slice each; name it alone if it is a volume", path,
                         (long long)(stored->header.n[2] - before))
               : status;
}

ms_status ms_volume_parse_tiff(ms_stored *stored, const ms_bytes *bytes, const char *path, size_t max_voxels,
                               ms_error *err)
{
    *stored = (ms_stored){0};
    const ms_status status = load_pages(stored, bytes, path, max_voxels, err);
    if (status != MS_OK) {
        ms_volume_stored_free(stored);
    }
    return status;
}
