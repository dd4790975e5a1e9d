#include "ms_mesh_read.h"

#include <string.h>

#include "base/ms_text.h"
#include "ms_mesh_formats.h"

typedef struct mesh_reader {
    const char *ending;
    ms_status (*parse)(ms_mesh *mesh, ms_error *remark, const ms_bytes *bytes, const char *name, ms_error *err);
} mesh_reader;

static const mesh_reader FORMATS[] = {
    {"stl", ms_mesh_parse_stl}, {"obj", ms_mesh_parse_obj}, {"ply", ms_mesh_parse_ply}, {"off", ms_mesh_parse_off}, {0},
};

static const mesh_reader *find_by_ending(const char *ending)
{
    for (const mesh_reader *format = FORMATS; format->ending; format++) {
        if (strcmp(ending, format->ending) == 0) {
            return format;
        }
    }
    return NULL;
}

static const mesh_reader *find_mesh_reader(const char *path)
{
    char ending[16];
    ms_file_ending(ending, path);
    return find_by_ending(ending);
}

/* The ending of a format whose files begin like these bytes. Only a binary STL begins with anything; 0 bytes tell it
 * from text, though its comment may say "solid", too. */
static const char *guess_ending(const ms_bytes *bytes)
{
    static const char *const OBJ[] = {"v", "vn", "vt", "f", "o", "g", "s", "mtllib", "usemtl"};
    ms_text text;
    ms_word word;
    if (bytes->size >= 4 && memcmp(bytes->data, "ply", 3) == 0 && strchr("\r\n", bytes->data[3])) {
        return "ply";
    }
    if (memchr(bytes->data, 0, bytes->size)) {
        return "stl";
    }
    ms_text_start(&text, bytes, "");
    text.comment = '#';
    if (!ms_text_seek(&text) || !ms_text_word(&word, &text)) {
        return "";
    }
    for (size_t k = 0; k < sizeof OBJ / sizeof *OBJ; k++) {
        if (ms_text_word_is(&word, OBJ[k])) {
            return "obj";
        }
    }
    const ms_word tail = {word.start + word.length - (word.length < 3 ? 0 : 3), 3};
    return ms_text_word_is(&word, "solid") ? "stl" : word.length >= 3 && ms_text_word_is(&tail, "off") ? "off" : "";
}

/* What a volume begins with. */
static int begins_volume(const ms_bytes *bytes)
{
    static const char *const STARTS[] = {"\x93NUMPY", "NRRD000", "ObjectType", "NDims"};
    for (size_t k = 0; k < sizeof STARTS / sizeof *STARTS; k++) {
        const size_t length = strlen(STARTS[k]);
        if (bytes->size >= length && memcmp(bytes->data, STARTS[k], length) == 0) {
            return 1;
        }
    }
    return 0;
}

/* Of standard input, which has no ending. */
static const mesh_reader *find_by_content(const ms_bytes *bytes, ms_error *err)
{
    if (begins_volume(bytes)) {
        ms_fail(err, MS_ERR_FORMAT,
                "standard input: is a volume; volumes are read from files alone: save it and name the file");
        return NULL;
    }
    const mesh_reader *found = find_by_ending(guess_ending(bytes));
    if (!found) {
        ms_fail(err, MS_ERR_FORMAT, "standard input: does not begin like a mesh; STL, OBJ, PLY and OFF are read");
    }
    return found;
}

int ms_mesh_read_is_mesh_path(const char *path)
{
    return find_mesh_reader(path) != NULL;
}

ms_status ms_mesh_parse(ms_mesh *mesh, ms_error *remark, const ms_bytes *bytes, const char *path, ms_error *err)
{
    const int is_standard = ms_file_is_standard(path);
    const mesh_reader *found = find_mesh_reader(path);
    *mesh = (ms_mesh){0};
    if (remark) {
        remark->text[0] = '\0';
    }
    if (!found && !is_standard) {
        return ms_fail(err, MS_ERR_FORMAT,
                       "%s: its ending names no mesh format; meshes are read from .stl, .obj, .ply and .off", path);
    }
    if (bytes->size == 0) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: is empty (0 bytes); export the mesh again", ms_file_name(path));
    }
    found = found ? found : find_by_content(bytes, err);
    return found ? found->parse(mesh, remark, bytes, ms_file_name(path), err) : MS_ERR_FORMAT;
}

ms_status ms_mesh_read(ms_mesh *mesh, const char *path, ms_error *err)
{
    ms_bytes bytes = {0};
    *mesh = (ms_mesh){0};
    ms_status status =
        find_mesh_reader(path) ? ms_file_read(&bytes, path, err) : MS_OK; /* without one, parse says so */
    if (status == MS_OK) {
        status = ms_mesh_parse(mesh, NULL, &bytes, path, err);
    }
    ms_file_free(&bytes);
    return status;
}
