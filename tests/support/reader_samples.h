/** What the tests of the readers share: bytes in memory, temporary files, the folder of shared data. */
#ifndef READER_SAMPLES_H
#define READER_SAMPLES_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/ms_file.h"

/** A file in memory that a test puts together. */
typedef struct sample {
    uint8_t data[8192];
    size_t size;
} sample;

static inline void put_bytes(sample *to, const void *bytes, size_t size)
{
    assert_true(to->size + size <= sizeof to->data);
    memcpy(to->data + to->size, bytes, size);
    to->size += size;
}

static inline void put_text(sample *to, const char *text)
{
    put_bytes(to, text, strlen(text));
}

static inline void put_integer(sample *to, uint64_t bits, size_t size, int big_endian)
{
    for (size_t i = 0; i < size; i++) {
        size_t shift = 8 * (big_endian ? size - 1 - i : i);
        uint8_t byte = (uint8_t)(bits >> shift);
        put_bytes(to, &byte, 1);
    }
}

static inline void put_float32(sample *to, double value, int big_endian)
{
    float narrow = (float)value;
    uint32_t bits;
    memcpy(&bits, &narrow, sizeof bits);
    put_integer(to, bits, sizeof bits, big_endian);
}

static inline void put_float64(sample *to, double value, int big_endian)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_integer(to, bits, sizeof bits, big_endian);
}

/** A copy of just its size, so that a sanitizer sees what is read behind it. */
static inline ms_bytes copy_bytes(const void *data, size_t size)
{
    ms_bytes bytes = {.data = malloc(size + 1), .size = size};
    assert_non_null(bytes.data);
    memcpy(bytes.data, data, size);
    bytes.data[size] = 0;
    return bytes;
}

static inline void expect_message(const ms_error *err, const char *part)
{
    if (!strstr(err->text, part)) {
        fail_msg("the message \"%s\" lacks \"%s\"", err->text, part);
    }
}

/** A fresh folder for one test. */
static inline void make_folder(char folder[64])
{
    strcpy(folder, "/tmp/mskit-test-XXXXXX");
    assert_non_null(mkdtemp(folder));
}

static inline void write_file(char path[128], const char *folder, const char *name, const void *data, size_t size)
{
    snprintf(path, 128, "%s/%s", folder, name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(data, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

/** The path of a shared data file; skips the test where the data are not there. */
static inline void shared_path(char path[512], const char *name)
{
    const char *folder = getenv("MSKIT_SHARED");
    snprintf(path, 512, "%s/data/%s", folder ? folder : "", name);
    FILE *file = folder ? fopen(path, "rb") : NULL;
    if (!file) {
        print_message("skipped: set MSKIT_SHARED to the folder with data/%s\n", name);
        skip();
    }
    fclose(file);
}

#endif
