/* Meshes to voxels against brute force on unions of convex bodies. */
#include "support/grid_samples.h"

/* A convex body as its planes: inside where n.x < d for all. */
typedef struct convex {
    int planes;
    double plane[8][4];
} convex;

enum { MAX_BODIES = 40 };

/* A tetrahedron: its outward faces into the mesh, its planes into the body. */
static convex add_tetrahedron(ms_mesh *mesh, double corner[4][3])
{
    static const uint32_t face[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    convex body = {.planes = 4};
    ms_mesh part;
    double e[3][3];
    for (int m = 0; m < 3; m++) {
        for (int a = 0; a < 3; a++) {
            e[m][a] = corner[m + 1][a] - corner[0][a];
        }
    }
    const double volume = e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) +
                          e[0][1] * (e[1][2] * e[2][0] - e[1][0] * e[2][2]) +
                          e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
    assert_int_equal(ms_mesh_alloc(&part, 4, 4, NULL), MS_OK);
    memcpy(part.vertex, corner, 4 * sizeof *part.vertex);
    for (int f = 0; f < 4; f++) {
        const uint32_t t[3] = {face[f][0], face[f][volume > 0 ? 1 : 2], face[f][volume > 0 ? 2 : 1]};
        const double *p = corner[t[0]], *q = corner[t[1]], *r = corner[t[2]];
        memcpy(part.triangle[f], t, sizeof t);
        for (int a = 0; a < 3; a++) {
            const int b = (a + 1) % 3, c = (a + 2) % 3;
            body.plane[f][a] = (q[b] - p[b]) * (r[c] - p[c]) - (q[c] - p[c]) * (r[b] - p[b]);
            body.plane[f][3] += body.plane[f][a] * p[a];
        }
    }
    add_part(mesh, part);
    return body;
}

/* The stretch of the line (y, z) along x in the body; 0 if none. */
static int clip_line(double *from, double *to, const convex *body, double y, double z)
{
    *from = -HUGE_VAL;
    *to = HUGE_VAL;
    for (int p = 0; p < body->planes; p++) {
        const double *n = body->plane[p], rest = n[3] - n[1] * y - n[2] * z;
        if (n[0] > 0) {
            *to = fmin(*to, rest / n[0]);
        } else if (n[0] < 0) {
            *from = fmax(*from, rest / n[0]);
        } else if (rest <= 0) {
            return 0;
        }
    }
    return *from < *to;
}

/* Length of the union of the bodies on the line (y, z) between lo and hi. */
static double line_cover(const convex *bodies, int count, double y, double z, double lo, double hi)
{
    double from[MAX_BODIES], to[MAX_BODIES], length = 0, at = lo;
    int cuts = 0;
    for (int b = 0; b < count; b++) {
        cuts += clip_line(&from[cuts], &to[cuts], &bodies[b], y, z);
    }
    while (at < hi) { /* `at` is covered up to here, or the next body begins */
        double covered = at, next = hi;
        for (int c = 0; c < cuts; c++) {
            if (from[c] <= at && to[c] > covered) {
                covered = to[c];
            }
            if (from[c] > at && from[c] < next) {
                next = from[c];
            }
        }
        if (covered > at) {
            length += fmin(covered, hi) - at;
            at = covered;
        } else {
            at = next;
        }
    }
    return length;
}

/* Share of a voxel that the union covers, by rays x rays lines along x. */
static double voxel_cover(const convex *bodies, int count, const double centre[3], double h, int rays)
{
    double sum = 0;
    for (int c = 0; c < rays; c++) {
        for (int b = 0; b < rays; b++) {
            const double y = centre[1] + h * ((b + 0.5) / rays - 0.5), z = centre[2] + h * ((c + 0.5) / rays - 0.5);
            sum += line_cover(bodies, count, y, z, centre[0] - 0.5 * h, centre[0] + 0.5 * h);
        }
    }
    return sum / (h * rays * rays);
}

/* Every voxel whose cover by brute force is not within `margin` of a half. */
static void compare(const ms_grid *grid, const convex *bodies, int count, int rays, double margin)
{
    for (int k = 0; k < grid->n[2]; k++) {
        for (int j = 0; j < grid->n[1]; j++) {
            for (int i = 0; i < grid->n[0]; i++) {
                double centre[3];
                centre_of(centre, grid, i, j, k);
                const double cover = voxel_cover(bodies, count, centre, grid->h, rays);
                if (fabs(cover - 0.5) > margin && inside_at(grid, i, j, k) != (cover > 0.5)) {
                    fail_msg("voxel (%d, %d, %d), covered by %.4f, is %d", i, j, k, cover, inside_at(grid, i, j, k));
                }
            }
        }
    }
}

static int random_soup(ms_mesh *mesh, convex *bodies, int count, double reach, uint64_t *state)
{
    *mesh = (ms_mesh){0};
    for (int b = 0; b < count; b++) {
        double middle[3], corner[4][3];
        for (int a = 0; a < 3; a++) {
            middle[a] = between(state, -1, 1);
        }
        for (int c = 0; c < 12; c++) {
            corner[c / 3][c % 3] = middle[c % 3] + between(state, -reach, reach);
        }
        bodies[b] = add_tetrahedron(mesh, corner);
    }
    return count;
}

static void a_tetrahedron_agrees_with_dense_lines(void **state)
{
    (void)state;
    uint64_t seed = 7;
    for (int run = 0; run < 12; run++) {
        ms_mesh mesh;
        convex body[1];
        random_soup(&mesh, body, 1, 1, &seed);
        ms_grid grid;
        if (ms_voxelize(&grid, &mesh, 0.13, MS_VOXEL_HALF, NULL) == MS_OK) {
            compare(&grid, body, 1, 4, 0.001);
            compare(&grid, body, 1, 32, 0.05); /* what 4x4 lines may miss of the truth */
            ms_grid_free(&grid);
        }
        ms_mesh_free(&mesh);
    }
}

static void bodies_that_overlap_unite(void **state)
{
    (void)state;
    uint64_t seed = 11;
    for (int run = 0; run < 12; run++) {
        ms_mesh mesh;
        convex bodies[MAX_BODIES];
        const int count = random_soup(&mesh, bodies, run < 6 ? 12 : MAX_BODIES, run % 2 ? 0.5 : 1, &seed);
        ms_grid grid = voxels_of(&mesh, 0.11, MS_VOXEL_HALF);
        compare(&grid, bodies, count, 4, 0.001);
        ms_grid_free(&grid);
        grid = voxels_of(&mesh, 0.07, MS_VOXEL_CENTRE);
        for (size_t v = 0; v < ms_grid_voxels(&grid); v++) {
            double centre[3];
            centre_of(centre, &grid, (int)(v % grid.n[0]), (int)(v / grid.n[0] % grid.n[1]),
                      (int)(v / grid.n[0] / grid.n[1]));
            const double speck = 1e-3 * grid.h;
            const double cover = line_cover(bodies, count, centre[1], centre[2], centre[0] - speck, centre[0] + speck);
            if ((cover <= 0 || cover >= 1.999 * speck) && grid.inside[v] != (cover > 0)) {
                fail_msg("the centre (%g, %g, %g) is not %d", centre[0], centre[1], centre[2], cover > 0);
            }
        }
        ms_grid_free(&grid);
        ms_mesh_free(&mesh);
    }
}

/* Matter that two bodies share counts once: here 0.3 of the outermost voxels, and twice. */
static void what_bodies_share_counts_once(void **state)
{
    (void)state;
    ms_mesh mesh = cuboid(-0.5, 0.5, -0.5, 0.5, -0.5, 0.5);
    add_part(&mesh, cuboid(9.5, 10.5, 9.5, 10.5, 9.5, 10.5));
    add_part(&mesh, cuboid(2.5, 7.8, 2.5, 7.5, 2.5, 7.5));
    add_part(&mesh, cuboid(4.5, 7.8, 2.5, 7.5, 2.5, 7.5));
    ms_grid grid = voxels_of(&mesh, 1, MS_VOXEL_HALF);
    assert_int_equal(ms_grid_count(&grid), 2 + 125);
    ms_grid_free(&grid);
    ms_mesh_free(&mesh);
}

/* The winding number is 1 - 1 where the cubes overlap and -1 in the rest of the second. */
static void what_is_wound_inward_takes_away(void **state)
{
    (void)state;
    const ms_voxel_rule rules[] = {MS_VOXEL_HALF, MS_VOXEL_CENTRE};
    for (int r = 0; r < 2; r++) {
        ms_mesh mesh = cuboid(0, 6, 0, 6, 0, 6), hole = cuboid(3, 9, 2, 8, 1, 7);
        reverse_all(&hole);
        add_part(&mesh, hole);
        ms_grid grid = voxels_of(&mesh, 1, rules[r]);
        assert_int_equal(ms_grid_count(&grid), 216 - 3 * 4 * 5);
        ms_grid_free(&grid);
        ms_mesh_free(&mesh);
    }
}

static void two_cubes_unite_and_stay_apart(void **state)
{
    (void)state;
    const ms_voxel_rule rules[] = {MS_VOXEL_HALF, MS_VOXEL_CENTRE};
    for (int r = 0; r < 2; r++) {
        ms_mesh mesh = cuboid(0, 6, 0, 6, 0, 6);
        add_part(&mesh, cuboid(3, 9, 2, 8, 1, 7));
        ms_grid grid = voxels_of(&mesh, 1, rules[r]);
        assert_int_equal(ms_grid_count(&grid), 2 * 216 - 3 * 4 * 5);
        ms_grid_free(&grid);
        ms_mesh_free(&mesh);
        mesh = cuboid(0, 3, 0, 3, 0, 3);
        add_part(&mesh, cuboid(8, 10, 5, 9, -4, 1));
        grid = voxels_of(&mesh, 1, rules[r]);
        assert_int_equal(ms_grid_count(&grid), 27 + 40);
        ms_grid_free(&grid);
        ms_mesh_free(&mesh);
    }
}

/* More faces on each ray than are sorted by insertion: a staircase of slabs that overlap. */
static void a_heap_of_bodies_unites(void **state)
{
    (void)state;
    enum { SLABS = 120 };
    ms_mesh mesh = cuboid(0, 3, 0, 4, 0, 4);
    for (int s = 1; s < SLABS; s++) {
        const double x = (s * 37 % SLABS) * 0.25; /* out of order */
        add_part(&mesh, cuboid(x, x + 3, 0, 4, 0, 4));
    }
    ms_grid grid = voxels_of(&mesh, 0.25, MS_VOXEL_HALF);
    assert_int_equal(ms_grid_count(&grid), (SLABS - 1 + 12) * 16 * 16);
    ms_grid_free(&grid);
    ms_mesh_free(&mesh);
}

/* By 24x24x24 points in each voxel, of the ellipsoid itself. */
static void an_ellipsoid_agrees_with_dense_points(void **state)
{
    (void)state;
    enum { POINTS = 24 };
    ms_mesh mesh = make_body("ellipsoid", (double[]){1.7, 1.1, 0.9, 96});
    ms_grid grid = voxels_of(&mesh, 0.23, MS_VOXEL_HALF), centred = voxels_of(&mesh, 0.23, MS_VOXEL_CENTRE);
    for (size_t v = 0; v < ms_grid_voxels(&grid); v++) {
        double c[3];
        int points = 0;
        centre_of(c, &grid, (int)(v % grid.n[0]), (int)(v / grid.n[0] % grid.n[1]), (int)(v / grid.n[0] / grid.n[1]));
        for (int p = 0; p < POINTS * POINTS * POINTS; p++) {
            const double x = c[0] + 0.23 * ((p % POINTS + 0.5) / POINTS - 0.5);
            const double y = c[1] + 0.23 * ((p / POINTS % POINTS + 0.5) / POINTS - 0.5);
            const double z = c[2] + 0.23 * ((p / POINTS / POINTS + 0.5) / POINTS - 0.5);
            points += x * x / 2.89 + y * y / 1.21 + z * z / 0.81 < 1;
        }
        const double cover = (double)points / (POINTS * POINTS * POINTS);
        const double level = c[0] * c[0] / 2.89 + c[1] * c[1] / 1.21 + c[2] * c[2] / 0.81 - 1;
        assert_true(fabs(cover - 0.5) < 0.02 || grid.inside[v] == (cover > 0.5));
        assert_true(fabs(level) < 0.002 || centred.inside[v] == (level < 0));
    }
    ms_grid_free(&grid);
    ms_grid_free(&centred);
    ms_mesh_free(&mesh);
}

/* The voxels on which two grids differ. */
static size_t differences(const ms_grid *a, const ms_grid *b)
{
    size_t count = 0;
    assert_memory_equal(a->n, b->n, sizeof a->n);
    for (size_t v = 0; v < ms_grid_voxels(a); v++) {
        count += a->inside[v] != b->inside[v];
    }
    return count;
}

/* Three holes of one triangle each, on different sides. */
static void a_ball_with_small_holes_is_nearly_whole(void **state)
{
    (void)state;
    ms_mesh ball = make_body("ball", (double[]){1, 24});
    ms_grid whole = voxels_of(&ball, 0.06, MS_VOXEL_CENTRE), open;
    size_t disagree = 0;
    for (int hole = 0; hole < 3; hole++) {
        ball.n_triangles--;
        memcpy(ball.triangle[100 + 900 * (size_t)hole], ball.triangle[ball.n_triangles], sizeof *ball.triangle);
    }
    assert_int_equal(ms_voxelize_open(&open, &disagree, &ball, 0.06, NULL), MS_OK);
    assert_true(disagree > 0);
    assert_true(differences(&whole, &open) < 5);
    ms_grid_free(&whole);
    ms_grid_free(&open);
    ms_mesh_free(&ball);
}

/* Rays along z have lost their way out everywhere in the box and above it; x and y outvote them. */
static void a_box_without_a_lid_is_whole(void **state)
{
    (void)state;
    ms_mesh box = cuboid(0, 6, 0, 5, 0, 4);
    size_t kept = 0, disagree = 0;
    ms_grid open;
    for (size_t t = 0; t < box.n_triangles; t++) {
        int lid = 1;
        for (int c = 0; c < 3; c++) {
            lid &= box.vertex[box.triangle[t][c]][2] > 3;
        }
        if (!lid) {
            memmove(box.triangle[kept++], box.triangle[t], sizeof *box.triangle);
        }
    }
    assert_int_equal(kept, 10);
    box.n_triangles = kept;
    assert_int_equal(ms_voxelize_open(&open, &disagree, &box, 1, NULL), MS_OK);
    assert_int_equal(ms_grid_count(&open), 120);
    assert_int_equal(disagree, 30 * MS_GRID_HULL); /* above the missing lid */
    ms_grid_free(&open);
    ms_mesh_free(&box);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_tetrahedron_agrees_with_dense_lines),
        cmocka_unit_test(bodies_that_overlap_unite),
        cmocka_unit_test(what_bodies_share_counts_once),
        cmocka_unit_test(what_is_wound_inward_takes_away),
        cmocka_unit_test(two_cubes_unite_and_stay_apart),
        cmocka_unit_test(a_heap_of_bodies_unites),
        cmocka_unit_test(an_ellipsoid_agrees_with_dense_points),
        cmocka_unit_test(a_ball_with_small_holes_is_nearly_whole),
        cmocka_unit_test(a_box_without_a_lid_is_whole),
    };
    omp_set_num_threads(1); /* many small grids: what threads change is tested in test_voxelize.c */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
