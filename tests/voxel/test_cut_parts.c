/* Cells cut by the surface, one by one: parts of voxels by tetrahedra clipped with planes, joined in a dense array. */
#include "support/clump_samples.h"
#include "voxel/ms_cut_left.h"

enum { MOST_FACES = 12, MOST_CORNERS = 2 * MOST_FACES };

/* A convex body by its faces; corners counter-clockwise seen from outside. */
typedef struct convex {
    int faces, corners[MOST_FACES];
    double at[MOST_FACES][MOST_CORNERS][3];
} convex;

static double depth(const double at[3], int axis, double bound, double sign)
{
    return sign * (at[axis] - bound);
}

/* Corners of the new face lie around its middle; puts them in order. */
static void close_cut(convex *body, double cap[][3], int n, int axis, double sign)
{
    double middle[3] = {0}, angle[2 * MOST_FACES];
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int c = 0; c < n; c++) {
        for (int a = 0; a < 3; a++) {
            middle[a] += cap[c][a] / n;
        }
    }
    for (int c = 0; c < n; c++) { /* outward is -sign along the axis */
        angle[c] = -sign * atan2(cap[c][v] - middle[v], cap[c][u] - middle[u]);
    }
    for (int c = 0; c < n; c++) { /* by growing angle; each corner comes from two faces, and is put twice */
        int least = c;
        for (int d = c + 1; d < n; d++) {
            least = angle[d] < angle[least] ? d : least;
        }
        double swap[3], kept = angle[c];
        memcpy(swap, cap[c], sizeof swap);
        memcpy(cap[c], cap[least], sizeof swap);
        memcpy(cap[least], swap, sizeof swap);
        angle[c] = angle[least];
        angle[least] = kept;
    }
    assert_true(body->faces < MOST_FACES && n <= MOST_CORNERS);
    body->corners[body->faces] = n;
    memcpy(body->at[body->faces++], cap, (size_t)n * sizeof *cap);
}

/* Keeps what is at sign * (x - bound) > 0. */
static void keep_side(convex *body, int axis, double bound, double sign)
{
    double cap[2 * MOST_FACES][3];
    int n_cap = 0, faces = 0;
    for (int f = 0; f < body->faces; f++) {
        double kept[MOST_CORNERS][3];
        int n = 0;
        for (int c = 0; c < body->corners[f]; c++) {
            const double *one = body->at[f][c], *next = body->at[f][(c + 1) % body->corners[f]];
            const double d = depth(one, axis, bound, sign), e = depth(next, axis, bound, sign);
            if (d > 0) {
                assert_true(n < MOST_CORNERS);
                memcpy(kept[n++], one, sizeof kept[0]);
            }
            if ((d > 0) != (e > 0)) {
                assert_true(n < MOST_CORNERS && n_cap < 2 * MOST_FACES);
                for (int a = 0; a < 3; a++) {
                    kept[n][a] = (d * next[a] - e * one[a]) / (d - e);
                }
                memcpy(cap[n_cap++], kept[n++], sizeof cap[0]);
            }
        }
        if (n > 2) {
            memcpy(body->at[faces], kept, (size_t)n * sizeof kept[0]);
            body->corners[faces++] = n;
        }
    }
    body->faces = faces;
    if (n_cap > 2) {
        close_cut(body, cap, n_cap, axis, sign);
    }
}

/* Adds volume and moments, by tetrahedra from the origin. */
static void add_convex(double sum[4], const convex *body, double sign)
{
    for (int f = 0; f < body->faces; f++) {
        const double *a = body->at[f][0];
        for (int c = 1; c + 1 < body->corners[f]; c++) {
            const double *b = body->at[f][c], *d = body->at[f][c + 1];
            const double six = a[0] * (b[1] * d[2] - b[2] * d[1]) + a[1] * (b[2] * d[0] - b[0] * d[2]) +
                               a[2] * (b[0] * d[1] - b[1] * d[0]);
            sum[3] += sign * six / 6;
            for (int k = 0; k < 3; k++) {
                sum[k] += sign * six / 24 * (a[k] + b[k] + d[k]);
            }
        }
    }
}

/* Parts of voxels of a grid, x fastest; of each the moments and the volume. */
typedef struct dense {
    int n[3]; /* in parts */
    double (*sum)[4];
} dense;

static double *part_of(const dense *d, int x, int y, int z)
{
    const int at[3] = {x, y, z};
    for (int a = 0; a < 3; a++) {
        if (at[a] < 0 || at[a] >= d->n[a]) {
            return NULL;
        }
    }
    return d->sum[(size_t)x + (size_t)d->n[0] * ((size_t)y + (size_t)d->n[1] * (size_t)z)];
}

/* The tetrahedron of a triangle and the origin, in parts of voxels; the mesh is their sum with signs. */
static void add_tetrahedron(dense *d, double corner[3][3], const double apex[3])
{
    int from[3], to[3];
    double six = 0;
    for (int a = 0; a < 3; a++) {
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        double lo = apex[a], hi = apex[a];
        for (int k = 0; k < 3; k++) {
            lo = fmin(lo, corner[k][a]);
            hi = fmax(hi, corner[k][a]);
        }
        six += (corner[0][a] - apex[a]) * ((corner[1][b] - apex[b]) * (corner[2][c] - apex[c]) -
                                           (corner[1][c] - apex[c]) * (corner[2][b] - apex[b]));
        from[a] = (int)floor(lo);
        to[a] = (int)floor(hi);
    }
    const double sign = six > 0 ? 1 : -1;
    const int order[4][3] = {{0, 1, 2}, {3, 1, 0}, {3, 2, 1}, {3, 0, 2}};
    convex whole = {.faces = 4};
    for (int f = 0; f < 4; f++) {
        whole.corners[f] = 3;
        for (int c = 0; c < 3; c++) {
            const int k = order[f][sign > 0 ? c : 2 - c];
            memcpy(whole.at[f][c], k < 3 ? corner[k] : apex, sizeof whole.at[f][c]);
        }
    }
    for (int z = from[2]; z <= to[2]; z++) {
        convex slab = whole;
        keep_side(&slab, 2, z, 1);
        keep_side(&slab, 2, z + 1, -1);
        for (int y = from[1]; y <= to[1] && slab.faces > 0; y++) {
            convex row = slab;
            keep_side(&row, 1, y, 1);
            keep_side(&row, 1, y + 1, -1);
            for (int x = from[0]; x <= to[0] && row.faces > 0; x++) {
                convex part = row;
                keep_side(&part, 0, x, 1);
                keep_side(&part, 0, x + 1, -1);
                add_convex(part_of(d, x, y, z), &part, sign);
            }
        }
    }
}

static dense cut_densely(const ms_grid *grid, const ms_mesh *mesh)
{
    dense d = {.n = {2 * grid->n[0], 2 * grid->n[1], 2 * grid->n[2]}};
    const double apex[3] = {grid->n[0] + 0.123, grid->n[1] - 0.237, grid->n[2] + 0.331};
    d.sum = calloc((size_t)d.n[0] * (size_t)d.n[1] * (size_t)d.n[2], sizeof *d.sum);
    assert_non_null(d.sum);
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        double corner[3][3];
        for (int c = 0; c < 3; c++) {
            ms_grid_at(corner[c], grid, mesh->vertex[mesh->triangle[t][c]]);
            for (int a = 0; a < 3; a++) {
                corner[c][a] = 2 * corner[c][a] + 1;
            }
        }
        add_tetrahedron(&d, corner, apex);
    }
    return d;
}

static double volume_at(const dense *d, int x, int y, int z)
{
    const double *part = part_of(d, x, y, z);
    return part ? part[3] : 0;
}

static int is_whole_voxel(const dense *d, int i, int j, int k)
{
    double least = 1;
    for (int p = 0; p < 8; p++) {
        least = fmin(least, volume_at(d, 2 * i + (p & 1), 2 * j + (p >> 1 & 1), 2 * k + (p >> 2)));
    }
    return least > 1 - 1e-9;
}

/* Whole, and so are all six across its faces. */
static int is_deep(const dense *d, int i, int j, int k)
{
    return is_whole_voxel(d, i, j, k) && is_whole_voxel(d, i - 1, j, k) && is_whole_voxel(d, i + 1, j, k) &&
           is_whole_voxel(d, i, j - 1, k) && is_whole_voxel(d, i, j + 1, k) && is_whole_voxel(d, i, j, k - 1) &&
           is_whole_voxel(d, i, j, k + 1);
}

/* The neighbour that takes a sliver, or NULL: ms_cut_cells.h. */
static double *find_taker(const dense *d, const dense *before, int x, int y, int z)
{
    double *taker = NULL, most = 0.5 - 1e-12;
    for (int apart = 1; apart <= 3 && !taker; apart++) {
        for (int dz = -1; dz <= 1; dz++) {
            for (int dy = -1; dy <= 1; dy++) {
                for (int dx = -1; dx <= 1; dx++) {
                    const double volume = volume_at(before, x + dx, y + dy, z + dz);
                    if (dx * dx + dy * dy + dz * dz == apart && volume > most + (taker ? 1e-9 : 0)) {
                        most = volume;
                        taker = part_of(d, x + dx, y + dy, z + dz);
                    }
                }
            }
        }
    }
    return taker;
}

static dense join_densely(const dense *before)
{
    const size_t parts = (size_t)before->n[0] * (size_t)before->n[1] * (size_t)before->n[2];
    dense d = *before;
    d.sum = malloc(parts * sizeof *d.sum);
    assert_non_null(d.sum);
    memcpy(d.sum, before->sum, parts * sizeof *d.sum);
    for (int z = 0; z < d.n[2]; z++) {
        for (int y = 0; y < d.n[1]; y++) {
            for (int x = 0; x < d.n[0]; x++) {
                const double *sliver = part_of(before, x, y, z);
                double *taker = sliver[3] > 1e-9 && sliver[3] < 0.5 ? find_taker(&d, before, x, y, z) : NULL;
                for (int m = 0; taker && m < 4; m++) {
                    taker[m] += sliver[m];
                    part_of(&d, x, y, z)[m] = 0;
                }
            }
        }
    }
    return d;
}

/* The cell at a centroid, in voxels. */
static const ms_cut_cell *find_cell(const ms_cut_cells *cells, const double at[3])
{
    for (size_t c = 0; c < cells->count; c++) {
        double off = 0;
        for (int a = 0; a < 3; a++) {
            off = fmax(off, fabs((double)cells->cell[c].at[a] - at[a]));
        }
        if (off < 1e-5) {
            return &cells->cell[c];
        }
    }
    fail_msg("no cell at %g %g %g", at[0], at[1], at[2]);
    return cells->cell;
}

/* @return how many cells were joined of more than one part */
static size_t compare_cells(const ms_grid *grid, const ms_mesh *mesh)
{
    ms_cut_cells *cells;
    ms_error err = {{0}};
    assert_int_equal(ms_cut_cells_build(&cells, grid, mesh, &err), MS_OK);
    dense parts = cut_densely(grid, mesh), joined = join_densely(&parts);
    size_t found = 0, larger = 0;
    for (int z = 0; z < joined.n[2]; z++) {
        for (int y = 0; y < joined.n[1]; y++) {
            for (int x = 0; x < joined.n[0]; x++) {
                const int i = x / 2, j = y / 2, k = z / 2, deep = is_deep(&parts, i, j, k);
                const double *sum = part_of(&joined, x, y, z);
                assert_int_equal(cells->whole[ms_grid_index(grid, i, j, k)], deep);
                if (deep || sum[3] < 1e-7) {
                    continue;
                }
                const double at[3] = {sum[0] / sum[3] / 2 - 0.5, sum[1] / sum[3] / 2 - 0.5, sum[2] / sum[3] / 2 - 0.5};
                const ms_cut_cell *cell = find_cell(cells, at);
                expect_close(cell->weight / (double)MS_CUT_WHOLE, sum[3] / 8, 1e-6);
                larger += sum[3] > volume_at(&parts, x, y, z) + 1e-9;
                found++;
            }
        }
    }
    assert_true(cells->count >= found && cells->count < found + 20); /* a cell of 1e-9 is not looked for */
    free(parts.sum);
    free(joined.sum);
    ms_cut_cells_free(cells);
    return larger;
}

static void turn_about(ms_mesh *mesh, double angle, int axis)
{
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (size_t c = 0; c < mesh->n_vertices; c++) {
        double *at = mesh->vertex[c];
        const double x = at[u], y = at[v];
        at[u] = cos(angle) * x - sin(angle) * y;
        at[v] = sin(angle) * x + cos(angle) * y;
    }
}

/* Convex and concave bodies, thin and thick, turned. */
static void cells_are_those_of_tetrahedra(void **state)
{
    (void)state;
    const struct {
        const char *name;
        double value[MS_SHAPE_MAX_PARAMETERS], h;
    } BODY[] = {{"box", {1, 0.7, 0.5, 2}, 0.13},
                {"octahedron", {1, 2}, 0.19},
                {"torus", {1, 0.4, 2}, 0.27},
                {"ball", {1, 3}, 0.23},
                {"box", {1, 0.8, 0.05, 2}, 0.11}};
    for (size_t s = 0; s < sizeof BODY / sizeof *BODY; s++) {
        ms_mesh mesh = make_body(BODY[s].name, BODY[s].value);
        for (int turn = 0; turn < 3; turn++) {
            turn_about(&mesh, 0.7 + 0.4 * turn, turn);
            ms_target target = target_of(&mesh, BODY[s].h, MS_VOXEL_CENTRE);
            assert_true(compare_cells(&target.grid, &mesh) > 10 || s == 4);
            ms_target_free(&target);
        }
        ms_mesh_free(&mesh);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(cells_are_those_of_tetrahedra)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
