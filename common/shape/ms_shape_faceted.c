/* Bodies of flat faces, first laid out on integer lattice points (seams are then welded
   without any tolerance) and scaled at the end. */
#include <math.h>
#include <stdlib.h>

#include "ms_shape_build.h"

typedef struct soup {
    uint64_t *corner; /* 3 per triangle: a lattice point packed into one word */
    size_t n, capacity;
} soup;

enum { LATTICE_BITS = 21, LATTICE_MIDDLE = 1 << 20 };

static uint64_t pack_lattice(const int p[3])
{
    uint64_t word = 0;
    for (int axis = 0; axis < 3; axis++) {
        word = word << LATTICE_BITS | (uint64_t)(p[axis] + LATTICE_MIDDLE);
    }
    return word;
}

static int unpack_lattice(uint64_t word, int axis)
{
    uint64_t mask = ((uint64_t)1 << LATTICE_BITS) - 1;
    return (int)(word >> (LATTICE_BITS * (2 - axis)) & mask) - LATTICE_MIDDLE;
}

static void add_triangle(soup *faces, uint64_t a, uint64_t b, uint64_t c)
{
    if (faces->n + 3 <= faces->capacity) {
        faces->corner[faces->n++] = a;
        faces->corner[faces->n++] = b;
        faces->corner[faces->n++] = c;
    }
}

static ms_status soup_begin(soup *faces, size_t n_triangles, ms_error *err)
{
    *faces = (soup){.corner = malloc(3 * n_triangles * sizeof *faces->corner), .capacity = 3 * n_triangles};
    if (!faces->corner) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu triangles; use a smaller fineness", n_triangles);
    }
    return MS_OK;
}

static int compare_words(const void *a, const void *b)
{
    uint64_t x = *(const uint64_t *)a;
    uint64_t y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

static size_t sort_unique(uint64_t *word, size_t n)
{
    qsort(word, n, sizeof *word, compare_words);
    size_t kept = 0;
    for (size_t k = 0; k < n; k++) {
        if (kept == 0 || word[k] != word[kept - 1]) {
            word[kept++] = word[k];
        }
    }
    return kept;
}

/* Lattice number i of `half_count` becomes half[axis] * i / half_count[axis]. */
static ms_status weld_faces(ms_mesh *mesh, const soup *faces, const double half[3], const int half_count[3],
                            ms_error *err)
{
    uint64_t *point = malloc(faces->n * sizeof *point);
    if (!point) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu triangles; use a smaller fineness", faces->n / 3);
    }
    for (size_t k = 0; k < faces->n; k++) {
        point[k] = faces->corner[k];
    }
    size_t n_points = sort_unique(point, faces->n);
    ms_status status = ms_mesh_alloc(mesh, n_points, faces->n / 3, err);
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        for (int axis = 0; axis < 3; axis++) {
            mesh->vertex[v][axis] = half[axis] * ((double)unpack_lattice(point[v], axis) / half_count[axis]);
        }
    }
    for (size_t k = 0; k < 3 * mesh->n_triangles; k++) {
        const uint64_t *found = bsearch(faces->corner + k, point, n_points, sizeof *point, compare_words);
        mesh->triangle[k / 3][k % 3] = (uint32_t)(found - point);
    }
    free(point);
    return status;
}

/* One square of a face; (u, v) is its lower corner, its sides are `step` of the lattice. */
static void add_square(soup *faces, int axis, int side, int level, int u, int v, int step)
{
    uint64_t corner[4];
    for (int k = 0; k < 4; k++) {
        int p[3];
        p[axis] = side * level;
        p[(axis + 1) % 3] = u + (k == 1 || k == 2 ? step : 0);
        p[(axis + 2) % 3] = v + (k >= 2 ? step : 0);
        corner[k] = pack_lattice(p);
    }
    /* The diagonals of neighbouring quarters are mirror images, as the body is. */
    int start = (u < 0) != (v < 0);
    uint64_t a = corner[start];
    uint64_t b = corner[start + 1];
    uint64_t c = corner[(start + 2) % 4];
    uint64_t d = corner[(start + 3) % 4];
    add_triangle(faces, a, side > 0 ? b : c, side > 0 ? c : b);
    add_triangle(faces, a, side > 0 ? c : d, side > 0 ? d : c);
}

static ms_status make_box(ms_mesh *mesh, const double edge[3], double fineness, ms_error *err)
{
    *mesh = (ms_mesh){0};
    double longest = fmax(edge[0], fmax(edge[1], edge[2]));
    double half[3];
    int count[3]; /* even, so that the middle planes are cut; 1: the corners alone */
    for (int axis = 0; axis < 3; axis++) {
        half[axis] = edge[axis] / 2;
        count[axis] = fineness < 2 ? 1 : 2 * (int)fmax(1, ceil(fineness * edge[axis] / longest / 2));
    }
    size_t squares = 0;
    for (int axis = 0; axis < 3; axis++) {
        squares += 2 * (size_t)count[axis] * (size_t)count[(axis + 1) % 3];
    }
    soup faces;
    ms_status status = soup_begin(&faces, 2 * squares, err);
    if (status != MS_OK) {
        return status;
    }
    for (int face = 0; face < 6; face++) {
        int axis = face / 2;
        int n_u = count[(axis + 1) % 3];
        int n_v = count[(axis + 2) % 3];
        for (int u = -n_u; u < n_u; u += 2) {
            for (int v = -n_v; v < n_v; v += 2) {
                add_square(&faces, axis, face % 2 ? 1 : -1, count[axis], u, v, 2);
            }
        }
    }
    status = weld_faces(mesh, &faces, half, count, err);
    free(faces.corner);
    return status;
}

/* value: a, b, c, fineness */
ms_status ms_shape_box(ms_mesh *mesh, const double *value, ms_error *err)
{
    return make_box(mesh, value, value[3], err);
}

double ms_shape_box_volume(const double *value)
{
    return value[0] * value[1] * value[2];
}

/* value: a, fineness */
ms_status ms_shape_cube(ms_mesh *mesh, const double *value, ms_error *err)
{
    const double edge[3] = {value[0], value[0], value[0]};
    return make_box(mesh, edge, value[1], err);
}

double ms_shape_cube_volume(const double *value)
{
    return value[0] * value[0] * value[0];
}

/* The limb of the bar along `axis` towards `side`: its end, and its four sides. */
static void add_limb(soup *faces, int axis, int side, int across, int limb)
{
    for (int u = -across; u < across; u++) {
        for (int v = -across; v < across; v++) {
            add_square(faces, axis, side, across + limb, u, v, 1);
        }
        for (int k = 0; k < limb; k++) {
            const int from = side > 0 ? across + k : -across - k - 1;
            for (int face = -1; face <= 1;
                 face += 2) { /* of add_square's u and v the limb is once one, once the other */
                add_square(faces, (axis + 2) % 3, face, across, from, u, 1);
                add_square(faces, (axis + 1) % 3, face, across, u, from, 1);
            }
        }
    }
}

/* Lattice steps are `across` to half the width of a bar, and `limb` from there to its end. */
static void stretch_limbs(ms_mesh *mesh, int across, int limb, double half_width, double half_length)
{
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        for (int axis = 0; axis < 3; axis++) {
            const double at = fabs(mesh->vertex[v][axis]), beyond = at - across;
            const double length =
                beyond > 0 ? half_width + (half_length - half_width) * (beyond / limb) : half_width * (at / across);
            mesh->vertex[v][axis] = copysign(length, mesh->vertex[v][axis]);
        }
    }
}

/* value: length, width, fineness */
ms_status ms_shape_cross(ms_mesh *mesh, const double *value, ms_error *err)
{
    *mesh = (ms_mesh){0};
    const double length = value[0], width = value[1];
    if (width >= length) {
        return ms_fail(err, MS_ERR_ARG, "width = %g leaves no limbs to bars of length = %g", width, length);
    }
    const int across = (int)fmax(1, round(0.5 * value[2] * width / length));
    const int limb = (int)fmax(1, round(0.5 * value[2] * (1 - width / length)));
    soup faces;
    ms_status status = soup_begin(&faces, 6 * 2 * (size_t)(4 * across * across + 8 * across * limb), err);
    if (status != MS_OK) {
        return status;
    }
    for (int end = 0; end < 6; end++) {
        add_limb(&faces, end / 2, end % 2 ? 1 : -1, across, limb);
    }
    status = weld_faces(mesh, &faces, (const double[3]){1, 1, 1}, (const int[3]){1, 1, 1}, err);
    stretch_limbs(mesh, across, limb, width / 2, length / 2);
    free(faces.corner);
    return status;
}

double ms_shape_cross_volume(const double *value)
{
    return value[1] * value[1] * (3 * value[0] - 2 * value[1]);
}

/* Every second corner of a cube, and the faces between them, wound outward. */
static const int tetrahedron_corner[4][3] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
static const int tetrahedron_face[4][3] = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};

/* The point of a face that is i steps from its first corner to the second and j to the third. */
static uint64_t face_point(const int face[3], int n, int i, int j)
{
    int p[3];
    for (int axis = 0; axis < 3; axis++) {
        p[axis] = (n - i - j) * tetrahedron_corner[face[0]][axis] + i * tetrahedron_corner[face[1]][axis] +
                  j * tetrahedron_corner[face[2]][axis];
    }
    return pack_lattice(p);
}

static void add_face(soup *faces, const int face[3], int n)
{
    for (int i = 0; i < n; i++) {
        for (int j = 0; i + j < n; j++) {
            uint64_t right = face_point(face, n, i + 1, j);
            uint64_t up = face_point(face, n, i, j + 1);
            add_triangle(faces, face_point(face, n, i, j), right, up);
            if (i + j + 1 < n) {
                add_triangle(faces, right, face_point(face, n, i + 1, j + 1), up);
            }
        }
    }
}

/* value: a, fineness */
ms_status ms_shape_tetrahedron(ms_mesh *mesh, const double *value, ms_error *err)
{
    *mesh = (ms_mesh){0};
    int n = (int)value[1];
    soup faces;
    ms_status status = soup_begin(&faces, 4 * (size_t)n * (size_t)n, err);
    if (status != MS_OK) {
        return status;
    }
    for (int face = 0; face < 4; face++) {
        add_face(&faces, tetrahedron_face[face], n);
    }
    double half = value[0] / sqrt(8);
    status = weld_faces(mesh, &faces, (const double[3]){half, half, half}, (const int[3]){n, n, n}, err);
    free(faces.corner);
    return status;
}

double ms_shape_tetrahedron_volume(const double *value)
{
    return value[0] * value[0] * value[0] / (6 * sqrt(2));
}
