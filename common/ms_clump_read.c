#include <math.h>
#include <string.h>

#include "ms_clump.h"
#include "ms_file.h"
#include "ms_text.h"

/* Other tools write commas, semicolons, tabs or blanks: all become blanks. */
static void blank_separators(ms_bytes *bytes)
{
    for (size_t at = 0; at < bytes->size; at++) {
        if (bytes->data[at] == ',' || bytes->data[at] == ';') {
            bytes->data[at] = ' ';
        }
    }
}

static int first_word_is_number(const ms_text *text)
{
    ms_text ahead = *text;
    ms_word word;
    double value;
    return ms_text_word(&word, &ahead) && ms_word_double(&value, &word);
}

static ms_status read_sphere(ms_clump *clump, ms_text *text, ms_error *err)
{
    double v[4];
    ms_status status = ms_text_doubles(v, 4, text, "a sphere (x y z r)", err);
    if (status != MS_OK) {
        return status;
    }
    if (!isfinite(v[0]) || !isfinite(v[1]) || !isfinite(v[2]) || !isfinite(v[3]) || !(v[3] > 0)) {
        return ms_text_fail(err, text, "sphere (%g, %g, %g) with radius %g; centres must be finite and radii above 0",
                            v[0], v[1], v[2], v[3]);
    }
    const ms_sphere sphere = {.centre = {v[0], v[1], v[2]}, .radius = v[3]};
    return ms_clump_add(clump, &sphere, err);
}

static ms_status parse(ms_clump *clump, ms_bytes *bytes, const char *name, ms_error *err)
{
    ms_text text = {.comment = '#'};
    int header_allowed = 1;
    if (memchr(bytes->data, 0, bytes->size)) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: this is not a text file of spheres x,y,z,r", name);
    }
    blank_separators(bytes);
    ms_text_start(&text, bytes, name);
    text.comment = '#';
    while (ms_text_seek(&text)) {
        if (header_allowed && !first_word_is_number(&text)) {
            header_allowed = 0;
            ms_text_skip_line(&text);
            continue;
        }
        header_allowed = 0;
        ms_status status = read_sphere(clump, &text, err);
        if (status != MS_OK) {
            return status;
        }
        ms_text_skip_line(&text);
    }
    if (clump->n_spheres == 0) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: no spheres; give one line x,y,z,r for each", name);
    }
    return MS_OK;
}

ms_status ms_clump_read(ms_clump *clump, const char *path, ms_error *err)
{
    ms_bytes bytes;
    memset(clump, 0, sizeof *clump);
    ms_status status = ms_file_read(&bytes, path, err);
    if (status == MS_OK) {
        status = parse(clump, &bytes, path, err);
        ms_bytes_free(&bytes);
    }
    if (status != MS_OK) {
        ms_clump_free(clump);
    }
    return status;
}
