#include "ms_mesh_write.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/ms_file.h"

/* Little-endian bytes, whatever the machine: `n` of them. Returns 0 if they could not be written. */
static int put_bytes(FILE *stream, uint64_t bits, int n)
{
    unsigned char byte[8];
    for (int k = 0; k < n; k++) {
        byte[k] = (unsigned char)(bits >> (8 * k) & 0xff);
    }
    return fwrite(byte, 1, (size_t)n, stream) == (size_t)n;
}

static int put_float(FILE *stream, double value)
{
    float single = (float)value;
    uint32_t bits;
    memcpy(&bits, &single, sizeof bits);
    return put_bytes(stream, bits, 4);
}

static int put_double(FILE *stream, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return put_bytes(stream, bits, 8);
}

static void unit_normal(double normal[3], const ms_mesh *mesh, size_t t)
{
    double ab[3], ac[3], square = 0;
    for (int k = 0; k < 3; k++) {
        ab[k] = mesh->vertex[mesh->triangle[t][1]][k] - mesh->vertex[mesh->triangle[t][0]][k];
        ac[k] = mesh->vertex[mesh->triangle[t][2]][k] - mesh->vertex[mesh->triangle[t][0]][k];
    }
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3;
        int j = (k + 2) % 3;
        normal[k] = ab[i] * ac[j] - ab[j] * ac[i];
        square += normal[k] * normal[k];
    }
    for (int k = 0; k < 3; k++) {
        normal[k] = square > 0 ? normal[k] / sqrt(square) : 0;
    }
}

static ms_status check_single_precision(const ms_mesh *mesh, ms_error *err)
{
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        for (int k = 0; k < 3; k++) {
            if (!(fabs(mesh->vertex[v][k]) <= (double)FLT_MAX)) {
                return ms_fail(err, MS_ERR_ARG, "vertex %zu has the coordinate %g, which STL cannot hold; write .ply",
                               v, mesh->vertex[v][k]);
            }
        }
    }
    return mesh->n_triangles <= UINT32_MAX
               ? MS_OK
               : ms_fail(err, MS_ERR_LIMIT, "%zu triangles are more than STL can count", mesh->n_triangles);
}

static ms_status write_stl(const ms_mesh *mesh, FILE *stream, ms_error *err)
{
    /* A header that began with "solid" would announce the text format. */
    char header[80] = "binary STL by mskit";
    ms_status status = check_single_precision(mesh, err);
    if (status != MS_OK) {
        return status;
    }
    int good = fwrite(header, 1, sizeof header, stream) == sizeof header;
    good = good && put_bytes(stream, mesh->n_triangles, 4);
    for (size_t t = 0; good && t < mesh->n_triangles; t++) {
        double normal[3];
        unit_normal(normal, mesh, t);
        for (int k = 0; k < 3; k++) {
            good = good && put_float(stream, normal[k]);
        }
        for (int k = 0; k < 9; k++) {
            good = good && put_float(stream, mesh->vertex[mesh->triangle[t][k / 3]][k % 3]);
        }
        good = good && put_bytes(stream, 0, 2);
    }
    return good ? MS_OK : MS_ERR_IO;
}

static ms_status write_ply(const ms_mesh *mesh, FILE *stream, ms_error *err)
{
    (void)err;
    int good = fprintf(stream,
                       "ply\nformat binary_little_endian 1.0\ncomment mskit\n"
                       "element vertex %zu\nproperty double x\nproperty double y\nproperty double z\n"
                       "element face %zu\nproperty list uchar uint vertex_indices\nend_header\n",
                       mesh->n_vertices, mesh->n_triangles) > 0;
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        for (int k = 0; k < 3; k++) {
            good = good && put_double(stream, mesh->vertex[v][k]);
        }
    }
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        good = good && put_bytes(stream, 3, 1);
        for (int k = 0; k < 3; k++) {
            good = good && put_bytes(stream, mesh->triangle[t][k], 4);
        }
    }
    return good ? MS_OK : MS_ERR_IO;
}

/* OBJ and OFF differ in what stands before a vertex and a face, and in where counting begins.
   17 digits restore a double exactly. */
static ms_status write_text(const ms_mesh *mesh, FILE *stream, const char *vertex, const char *face,
                            unsigned long first)
{
    int good = 1;
    for (size_t v = 0; good && v < mesh->n_vertices; v++) {
        const double *p = mesh->vertex[v];
        good = fprintf(stream, "%s%.17g %.17g %.17g\n", vertex, p[0], p[1], p[2]) > 0;
    }
    for (size_t t = 0; good && t < mesh->n_triangles; t++) {
        const uint32_t *c = mesh->triangle[t];
        good = fprintf(stream, "%s%lu %lu %lu\n", face, c[0] + first, c[1] + first, c[2] + first) > 0;
    }
    return good ? MS_OK : MS_ERR_IO;
}

static ms_status write_obj(const ms_mesh *mesh, FILE *stream, ms_error *err)
{
    (void)err;
    return fprintf(stream, "# mskit\n") > 0 ? write_text(mesh, stream, "v ", "f ", 1) : MS_ERR_IO;
}

static ms_status write_off(const ms_mesh *mesh, FILE *stream, ms_error *err)
{
    (void)err;
    int good = fprintf(stream, "OFF\n%zu %zu 0\n", mesh->n_vertices, mesh->n_triangles) > 0;
    return good ? write_text(mesh, stream, "", "3 ", 0) : MS_ERR_IO;
}

typedef struct mesh_writer {
    const char *ending;
    ms_status (*write)(const ms_mesh *mesh, FILE *stream, ms_error *err); /* MS_ERR_IO without a message */
} mesh_writer;

static const mesh_writer formats[] = {{"stl", write_stl}, {"obj", write_obj}, {"ply", write_ply}, {"off", write_off}};

static const mesh_writer *find_mesh_writer(const char *ending)
{
    for (size_t k = 0; k < sizeof formats / sizeof *formats; k++) {
        if (strcmp(ending, formats[k].ending) == 0) {
            return &formats[k];
        }
    }
    return NULL;
}

ms_status ms_mesh_write_stream(const ms_mesh *mesh, FILE *stream, const char *ending, ms_error *err)
{
    const mesh_writer *found = find_mesh_writer(ending);
    return found ? found->write(mesh, stream, err) : ms_fail(err, MS_ERR_ARG, "there is no mesh format '%s'", ending);
}

ms_status ms_mesh_write(const ms_mesh *mesh, const char *path, ms_error *err)
{
    char ending[16];
    ms_file_ending(ending, strcmp(path, "-") == 0 ? "-.off" : path);
    const mesh_writer *found = find_mesh_writer(ending);
    if (!found) {
        return ms_fail(err, MS_ERR_ARG, "%s: a mesh is written as .stl, .obj, .ply or .off; give one of these endings",
                       path);
    }
    ms_output output;
    ms_status status = ms_output_open(&output, path, err);
    if (status != MS_OK) {
        return status;
    }
    status = found->write(mesh, output.stream, err);
    if (status == MS_ERR_IO) {
        ms_fail(err, MS_ERR_IO, "%s: could not be written; is the disk full, or the size of files limited?", path);
    }
    return ms_output_close(&output, status, err);
}
