#include "ms_mesh_read.h"

#include <string.h>

#include "ms_mesh_formats.h"

typedef struct mesh_reader {
    const char *ending;
    ms_status (*parse)(ms_mesh *mesh, ms_error *remark, const ms_bytes *bytes, const char *name, ms_error *err);
} mesh_reader;

static const mesh_reader *find_mesh_reader(const char *path)
{
    static const mesh_reader formats[] = {
        {"stl", ms_mesh_parse_stl},
        {"obj", ms_mesh_parse_obj},
        {"ply", ms_mesh_parse_ply},
        {"off", ms_mesh_parse_off},
    };
    char ending[16];
    ms_file_ending(ending, path);
    for (size_t i = 0; i < sizeof formats / sizeof formats[0]; i++) {
        if (strcmp(ending, formats[i].ending) == 0) {
            return &formats[i];
        }
    }
    return NULL;
}

int ms_mesh_read_is_mesh_path(const char *path)
{
    return find_mesh_reader(path) != NULL;
}

ms_status ms_mesh_parse(ms_mesh *mesh, ms_error *remark, const ms_bytes *bytes, const char *path, ms_error *err)
{
    const mesh_reader *found = find_mesh_reader(path);
    *mesh = (ms_mesh){0};
    if (remark) {
        remark->text[0] = '\0';
    }
    if (!found) {
        return ms_fail(err, MS_ERR_FORMAT,
                       "%s: its ending names no mesh format; meshes are read from .stl, .obj, .ply and .off", path);
    }
    if (bytes->size == 0) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: is empty (0 bytes); export the mesh again", path);
    }
    return found->parse(mesh, remark, bytes, path, err);
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
