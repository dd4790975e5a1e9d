/* Poses of rest and the support function: against the hull and bodies whose minima are known. */
#include "contact/ms_poses.h"

#include "base/ms_vector.h"
#include "clump/ms_clump_hull.h"
#include "mesh/ms_hull.h"
#include "support/test_support.h"

static const double ORIGIN[3] = {0};

typedef struct found {
    ms_support body;
    ms_directions directions;
    double *height;
    ms_pose *pose;
    size_t count;
} found;

static void find(found *f, double depth)
{
    ms_error err;
    assert_int_equal(ms_directions_make(&f->directions, 90, &err), MS_OK);
    f->height = malloc(f->directions.count * sizeof *f->height);
    assert_non_null(f->height);
    ms_poses_heights(f->height, &f->body, &f->directions);
    assert_int_equal(ms_poses_find(&f->pose, &f->count, &f->body, &f->directions, f->height, depth, &err), MS_OK);
}

static void find_of_shape(found *f, const char *kind, const char *parameters, double depth)
{
    ms_mesh mesh;
    ms_error err;
    make_shape(&mesh, kind, parameters);
    assert_int_equal(ms_support_from_mesh(&f->body, &mesh, ORIGIN, &err), MS_OK);
    ms_mesh_free(&mesh);
    find(f, depth);
}

static void find_of_spheres(found *f, const ms_sphere *sphere, size_t count, double depth)
{
    ms_error err;
    ms_clump clump = {.n_spheres = count, .sphere = malloc(count * sizeof *sphere)};
    memcpy(clump.sphere, sphere, count * sizeof *sphere);
    assert_int_equal(ms_support_from_clump(&f->body, &clump, ORIGIN, &err), MS_OK);
    ms_clump_free(&clump);
    find(f, depth);
}

static void free_found(found *f)
{
    ms_support_free(&f->body);
    ms_directions_free(&f->directions);
    free(f->height);
    free(f->pose);
}

static void test_directions(void **state)
{
    (void)state;
    ms_directions d;
    ms_error err;
    double sum = 0, squares[3] = {0};
    assert_int_equal(ms_directions_make(&d, 40, &err), MS_OK);
    for (size_t i = 0; i < d.count; i++) {
        sum += d.weight[i];
        assert_close(ms_dot(d.u[i], d.u[i]), 1, 1e-14);
        assert_in_range(d.start[i + 1] - d.start[i], 4, 6);
        for (int k = 0; k < 3; k++) {
            squares[k] += d.weight[i] * d.u[i][k] * d.u[i][k];
        }
        for (uint32_t e = d.start[i]; e < d.start[i + 1]; e++) {
            const uint32_t other = d.next[e];
            int back = 0;
            assert_true(ms_squared_distance(d.u[i], d.u[other]) < 4 * d.spacing * d.spacing);
            for (uint32_t b = d.start[other]; b < d.start[other + 1]; b++) {
                back += d.next[b] == i;
            }
            assert_int_equal(back, 1);
        }
    }
    assert_close(sum, 1, 1e-12);
    for (int k = 0; k < 3; k++) {
        assert_close(squares[k], 1.0 / 3, 1e-3);
    }
    ms_directions_free(&d);
    assert_int_equal(ms_directions_make(&d, 0, &err), MS_ERR_ARG);
    assert_null(d.u);
}

/* Six faces at a/2; an edge at a / root 2; a sixth of all directions each. Mean width 3 a / 2. */
static void test_cube(void **state)
{
    (void)state;
    found f;
    find_of_shape(&f, "cube", "a=1.7 fineness=2", 0.01);
    assert_int_equal(f.count, 6);
    for (size_t p = 0; p < 6; p++) {
        double largest = 0;
        for (int k = 0; k < 3; k++) {
            largest = fmax(largest, fabs(f.pose[p].direction[k]));
        }
        assert_close(largest, 1, 1e-12);
        assert_close(f.pose[p].height, 0.85, 1e-12);
        assert_close(f.pose[p].barrier, 0.85 * (sqrt(2) - 1), 2e-3);
        assert_close(f.pose[p].share, 1.0 / 6, 4e-3); /* directions of the lattice lie on the ridges */
    }
    assert_close(ms_poses_mean_width(f.height, &f.directions), 1.5 * 1.7, 1e-3);
    free_found(&f);
}

/* A box of other sides, turned so that no direction of the lattice is one of its own: two poses for each side. */
static void test_turned_box(void **state)
{
    (void)state;
    found f;
    ms_mesh mesh;
    ms_error err;
    const double side[3] = {1.2, 0.9, 0.7}; /* half */
    const double axis[3][3] = {{0.36, 0.48, -0.8}, {-0.8, 0.6, 0}, {0.48, 0.64, 0.6}};
    make_shape(&mesh, "box", "a=2.4 b=1.8 c=1.4 fineness=2");
    for (size_t v = 0; v < mesh.n_vertices; v++) {
        double at[3] = {0};
        for (int a = 0; a < 3; a++) {
            for (int k = 0; k < 3; k++) {
                at[k] += mesh.vertex[v][a] * axis[a][k];
            }
        }
        memcpy(mesh.vertex[v], at, sizeof at);
    }
    assert_int_equal(ms_support_from_mesh(&f.body, &mesh, ORIGIN, &err), MS_OK);
    ms_mesh_free(&mesh);
    find(&f, 0.01);
    assert_int_equal(f.count, 6);
    for (size_t p = 0; p < 6; p++) {
        const int a = 2 - (int)p / 2; /* lowest first */
        assert_close(f.pose[p].height, side[a], 1e-9);
        assert_close(fabs(ms_dot(f.pose[p].direction, axis[a])), 1, 1e-12);
    }
    assert_close(f.pose[0].barrier, hypot(0.7, 0.9) - 0.7, 3e-3);
    assert_close(f.pose[5].barrier, hypot(0.7, 1.2) - 1.2, 3e-3);
    free_found(&f);
}

/* A ball rests on everything: one pose, no barrier. So does one beside its centre of mass, at its lowest. */
static void test_ball(void **state)
{
    (void)state;
    found f;
    const ms_sphere one = {{0}, 1.3}, beside = {{0.12, -0.3, 0.2}, 1.3};
    find_of_spheres(&f, &one, 1, 0.013);
    assert_int_equal(f.count, 1);
    assert_true(isinf(f.pose[0].barrier));
    assert_close(f.pose[0].share, 1, 1e-12);
    assert_close(ms_poses_mean_width(f.height, &f.directions), 2.6, 1e-12);
    free_found(&f);
    const double away = sqrt(ms_dot(beside.centre, beside.centre));
    find_of_spheres(&f, &beside, 1, 0.013);
    assert_int_equal(f.count, 1);
    assert_close(f.pose[0].height, 1.3 - away, 1e-9);
    assert_close(ms_dot(f.pose[0].direction, beside.centre) / away, -1, 1e-9);
    free_found(&f);
}

/* Two spheres lie on any line of their girth: the circle is one pose, wherever the lattice finds it. */
static void test_needle_is_one_pose(void **state)
{
    (void)state;
    found f;
    const ms_sphere two[] = {{{1.1, 1.9, 2.3}, 0.5}, {{-1.1, -1.9, -2.3}, 0.5}};
    find_of_spheres(&f, two, 2, 0.01);
    assert_int_equal(f.count, 1);
    assert_close(f.pose[0].height, 0.5, 1e-9);
    assert_close(ms_dot(f.pose[0].direction, two[0].centre), 0, 1e-9);
    free_found(&f);
}

/* Four equal spheres at the corners of a tetrahedron stand on three of them, at each of its faces. */
static void test_four_spheres(void **state)
{
    (void)state;
    found f;
    const ms_sphere four[] = {{{1, 1, 1}, 0.6}, {{1, -1, -1}, 0.6}, {{-1, 1, -1}, 0.6}, {{-1, -1, 1}, 0.6}};
    find_of_spheres(&f, four, 4, 0.01);
    assert_int_equal(f.count, 4);
    for (size_t p = 0; p < 4; p++) {
        int touching = 0;
        for (int i = 0; i < 4; i++) {
            touching += fabs(ms_dot(four[i].centre, f.pose[p].direction) + 0.6 - f.pose[p].height) < 1e-9;
        }
        assert_int_equal(touching, 3);
        assert_close(f.pose[p].height, 1 / sqrt(3) + 0.6, 1e-9);
        assert_close(f.pose[p].barrier, 1 - 1 / sqrt(3), 2e-3);
        assert_close(f.pose[p].share, 0.25, 2e-3);
    }
    free_found(&f);
}

static double draw(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) / 16777216.0;
}

/* The direction in which three spheres reach equally far, h; `sign` chooses one of two. @return 0 for none */
static int solve_three(double u[3], double *h, const ms_sphere *a, const ms_sphere *b, const ms_sphere *c, int sign)
{
    double ab[3], ac[3], normal[3], side[2][3], base[3];
    for (int k = 0; k < 3; k++) {
        ab[k] = b->centre[k] - a->centre[k];
        ac[k] = c->centre[k] - a->centre[k];
    }
    ms_cross(normal, ab, ac);
    const double square = ms_dot(normal, normal), r[2] = {a->radius - b->radius, a->radius - c->radius};
    ms_cross(side[0], ac, normal); /* u.ab = r[0], u.ac = r[1] */
    ms_cross(side[1], normal, ab);
    for (int k = 0; k < 3; k++) {
        base[k] = (r[0] * side[0][k] + r[1] * side[1][k]) / square;
    }
    const double rest = 1 - ms_dot(base, base);
    for (int k = 0; k < 3; k++) {
        u[k] = base[k] + sign * sqrt(fmax(0, rest) / square) * normal[k];
    }
    *h = ms_dot(a->centre, u) + a->radius;
    return rest > 0;
}

/* h is lowest where three spheres reach equally far and no other farther: the lowest plane on any three of a heap. */
static void test_lowest_of_heaps(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 25; seed++) {
        found f;
        ms_sphere s[9];
        uint32_t at = seed;
        double lowest = (double)INFINITY;
        for (int i = 0; i < 9; i++) { /* on all sides, so that the origin is within the hull of the centres */
            double way[3], length = 0;
            for (int k = 0; k < 3; k++) {
                way[k] = draw(&at) - 0.5 + (i < 6 && i / 2 == k ? 4 * (i % 2) - 2 : 0);
                length += way[k] * way[k];
            }
            for (int k = 0; k < 3; k++) {
                s[i].centre[k] = way[k] / sqrt(length);
            }
            s[i].radius = 0.2 + 0.3 * draw(&at);
        }
        find_of_spheres(&f, s, 9, 0.01);
        for (int i = 0; i < 9 * 9 * 9 * 2; i++) {
            const int one = i / 2 % 9, two = i / 18 % 9, three = i / 162;
            double u[3], h;
            if (one < two && two < three && solve_three(u, &h, &s[one], &s[two], &s[three], i % 2 ? 1 : -1) &&
                ms_support_height(&f.body, u) < h + 1e-9) {
                lowest = fmin(lowest, h);
            }
        }
        assert_close(f.pose[0].height, lowest, 1e-9);
        for (size_t p = 0; p < f.count; p++) {
            int touching = 0;
            for (int i = 0; i < 9; i++) {
                touching += ms_dot(s[i].centre, f.pose[p].direction) + s[i].radius > f.pose[p].height - 1e-9;
            }
            assert_true(touching >= 3 && f.pose[p].barrier >= 0.01);
        }
        free_found(&f);
    }
}

/* A depth above the barrier leaves the deepest alone. */
static void test_depth(void **state)
{
    (void)state;
    found f;
    find_of_shape(&f, "box", "a=2 b=2 c=1 fineness=2", 0.5); /* on end: 1, over the edge: 1.118 */
    assert_int_equal(f.count, 2);
    assert_close(f.pose[0].share + f.pose[1].share, 1, 1e-12);
    free_found(&f);
}

/* h of a clump is that of the hull of points on its spheres, as near as these are. */
static void test_support_against_hull(void **state)
{
    (void)state;
    if (!ms_hull_is_built()) {
        skip();
    }
    found f;
    ms_support hull_body;
    ms_mesh hull;
    ms_error err;
    ms_sphere spheres[] = {{{1.2, 0.1, -0.3}, 0.6}, {{-0.8, 0.7, 0.2}, 0.5}, {{0.1, -0.9, 0.4}, 0.7}, {{0, 0, 0}, 0.8}};
    const ms_clump clump = {.n_spheres = 4, .sphere = spheres};
    find_of_spheres(&f, spheres, 4, 0.01);
    assert_int_equal(ms_clump_hull_build(&hull, &clump, &err), MS_OK);
    assert_int_equal(ms_support_from_mesh(&hull_body, &hull, ORIGIN, &err), MS_OK);
    ms_mesh_free(&hull);
    double *height = malloc(f.directions.count * sizeof *height), largest = 0;
    ms_poses_heights(height, &hull_body, &f.directions);
    for (size_t i = 0; i < f.directions.count; i++) {
        largest = fmax(largest, fabs(height[i] - f.height[i]));
    }
    assert_in_range((int)(largest * 1e6), 1, 3000);
    assert_true(ms_poses_rms(height, f.height, &f.directions) <= largest);
    free(height);
    ms_support_free(&hull_body);
    free_found(&f);
}

/* The root of the mean square of u.d is |d| / root 3: a body that is moved. */
static void test_rms(void **state)
{
    (void)state;
    found one, moved;
    const ms_sphere ball = {{0}, 1.1}, away = {{0.3, 0.2, -0.1}, 1.1};
    find_of_spheres(&one, &ball, 1, 0.01);
    find_of_spheres(&moved, &away, 1, 0.01);
    assert_close(ms_poses_rms(one.height, moved.height, &one.directions), sqrt(0.14 / 3), 1e-3);
    free_found(&one);
    free_found(&moved);
}

static void test_empty(void **state)
{
    (void)state;
    const ms_clump none = {0};
    const ms_mesh no_mesh = {0};
    ms_support body;
    ms_error err;
    assert_int_equal(ms_support_from_clump(&body, &none, ORIGIN, &err), MS_ERR_ARG);
    assert_int_equal(ms_support_from_mesh(&body, &no_mesh, ORIGIN, &err), MS_ERR_ARG);
    assert_null(body.sphere);
    ms_support_free(NULL);
    ms_directions_free(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_directions),
        cmocka_unit_test(test_cube),
        cmocka_unit_test(test_turned_box),
        cmocka_unit_test(test_ball),
        cmocka_unit_test(test_needle_is_one_pose),
        cmocka_unit_test(test_four_spheres),
        cmocka_unit_test(test_lowest_of_heaps),
        cmocka_unit_test(test_depth),
        cmocka_unit_test(test_support_against_hull),
        cmocka_unit_test(test_rms),
        cmocka_unit_test(test_empty),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
