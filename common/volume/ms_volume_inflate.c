/* Unpacks zlib and gzip streams whose unpacked size is known and not believed. */
#include <stdlib.h>
#include <string.h>

#define ZLIB_CONST
#include <zlib.h>

#include "ms_volume_formats.h"

/* Deflate packs at most 258 bytes into 2 bits. */
#define DEFLATE_MAX_RATIO 1032

/* zlib counts in unsigned int. */
#define INFLATE_STEP ((size_t)1 << 30)

/* Room for more output, up to one byte more than expected so that too much is noticed. */
static ms_status grow_output(ms_bytes *out, size_t *room, size_t expected, const char *path, ms_error *err)
{
    size_t wanted = *room < ((size_t)1 << 20) ? (size_t)1 << 20 : 2 * *room;
    wanted = wanted < expected + 1 ? wanted : expected + 1;
    uint8_t *larger = realloc(out->data, wanted);
    if (!larger) {
        return ms_fail(err, MS_ERR_NOMEM, "%s: no memory to unpack %zu bytes of it; crop it", path, wanted);
    }
    out->data = larger;
    *room = wanted;
    return MS_OK;
}

/* One call of zlib, in steps that its counters can hold. */
static int inflate_step(z_stream *stream, ms_bytes *out, size_t room, const uint8_t *data, size_t size, size_t *used)
{
    size_t in = size - *used < INFLATE_STEP ? size - *used : INFLATE_STEP;
    size_t space = room - out->size < INFLATE_STEP ? room - out->size : INFLATE_STEP;
    stream->next_in = data + *used;
    stream->avail_in = (uInt)in;
    stream->next_out = out->data + out->size;
    stream->avail_out = (uInt)space;
    int code = inflate(stream, Z_NO_FLUSH);
    *used += in - stream->avail_in;
    out->size += space - stream->avail_out;
    return code;
}

/* What zlib says of the byte where it stops. */
static ms_status fail_inflate(int code, const z_stream *stream, size_t used, size_t size, const char *path,
                              ms_error *err)
{
    if (code == Z_MEM_ERROR) {
        return ms_fail(err, MS_ERR_NOMEM, "%s: no memory to unpack it", path);
    }
    const char *why = code == Z_DATA_ERROR && stream->msg ? stream->msg : "";
    const int sum = strcmp(why, "incorrect data check") == 0 || strcmp(why, "incorrect length check") == 0;
    return ms_fail(err, MS_ERR_FORMAT, "%s: its packed data %s at byte %zu of %zu; fetch or save it again", path,
                   sum                   ? "do not match the checksum that ends"
                   : code == Z_BUF_ERROR ? "are cut"
                                         : "are damaged",
                   used, size);
}

/* A gzip file may hold several members one after the other, which together are the data (RFC 1952, 2.2). */
static int next_member(z_stream *stream, const uint8_t *data, size_t size, size_t used)
{
    static const uint8_t GZIP[] = {0x1f, 0x8b};
    return data[0] == GZIP[0] && size - used >= sizeof GZIP && memcmp(data + used, GZIP, sizeof GZIP) == 0 &&
           inflateReset(stream) == Z_OK;
}

/* Until the stream ends or more comes out than `most`; all of the bytes must have been used. */
static ms_status inflate_all(ms_bytes *out, size_t *used, z_stream *stream, const uint8_t *data, size_t size,
                             size_t most, const char *path, ms_error *err)
{
    size_t room = 0;
    int code = Z_OK;
    while (code != Z_STREAM_END && out->size <= most) {
        ms_status status = out->size == room ? grow_output(out, &room, most, path, err) : MS_OK;
        if (status) {
            return status;
        }
        code = inflate_step(stream, out, room, data, size, used);
        if (code != Z_OK && code != Z_STREAM_END) {
            return fail_inflate(code, stream, *used, size, path, err);
        }
        if (code == Z_STREAM_END && next_member(stream, data, size, *used)) {
            code = Z_OK;
        }
    }
    return MS_OK;
}

static ms_status run_inflate(ms_bytes *out, size_t *used, const uint8_t *data, size_t size, size_t most,
                             const char *path, ms_error *err)
{
    z_stream stream = {0};
    *out = (ms_bytes){0};
    *used = 0;
    /* 32 lets zlib tell its own header from that of gzip. */
    if (inflateInit2(&stream, 32 + MAX_WBITS) != Z_OK) {
        return ms_fail(err, MS_ERR_NOMEM, "%s: no memory to unpack it", path);
    }
    const ms_status status = inflate_all(out, used, &stream, data, size, most, path, err);
    inflateEnd(&stream);
    return status;
}

ms_status ms_volume_inflate(ms_bytes *out, const uint8_t *data, size_t size, size_t expected, const char *path,
                            ms_error *err)
{
    size_t used;
    *out = (ms_bytes){0};
    if (expected / DEFLATE_MAX_RATIO > size) {
        return ms_fail(err, MS_ERR_FORMAT,
                       "%s: its %zu packed bytes cannot hold the %zu that its header claims; fetch or save it again",
                       path, size, expected);
    }
    ms_status status = run_inflate(out, &used, data, size, expected, path, err);
    if (status == MS_OK && (out->size != expected || used != size)) {
        status =
            ms_fail(err, MS_ERR_FORMAT,
                    "%s: its packed data hold %s bytes than the %zu that its header claims; fetch or save it again",
                    path, out->size < expected ? "fewer" : "more", expected);
    }
    if (status) {
        ms_file_free(out);
    }
    return status;
}

ms_status ms_volume_gunzip(ms_bytes *out, const ms_bytes *packed, size_t most, const char *path, ms_error *err)
{
    size_t used;
    ms_status status = run_inflate(out, &used, packed->data, packed->size, most, path, err);
    if (status == MS_OK && out->size > most) {
        status =
            ms_fail(err, MS_ERR_LIMIT,
                    "%s: unpacked it has more than the %zu bytes allowed; crop it, or allow more memory", path, most);
    } else if (status == MS_OK && used != packed->size) {
        status = ms_fail(err, MS_ERR_FORMAT, "%s: %zu bytes follow behind its packed data; fetch or save it again",
                         path, packed->size - used);
    }
    uint8_t *larger = status == MS_OK ? realloc(out->data, out->size + 1) : NULL;
    if (larger) {
        out->data = larger;
        out->data[out->size] = 0;
    } else if (status == MS_OK) {
        status = ms_fail(err, MS_ERR_NOMEM, "%s: no memory to unpack it", path);
    }
    if (status) {
        ms_file_free(out);
    }
    return status;
}
