/* Descriptors of bodies whose form is known: as meshes, as voxels, as clumps. */
#include "measure/ms_descriptors.h"

#include "mesh/ms_hull.h"
#include "support/clump_samples.h"
#include "support/overlap_samples.h"
#include "support/test_support.h"

/* What a body has; NAN: not known, or not looked at. */
typedef struct form {
    double volume, area, elongation, flatness, feret[3], hull;
} form;

/* Against what is known; Feret dimensions and convexity without qhull not. */
static void expect_form(const ms_descriptors *d, const form *f, double tolerance)
{
    const double diameter = cbrt(6 * f->volume / pi);
    expect_close(d->volume, f->volume, tolerance * f->volume);
    expect_close(d->equivalent_diameter, diameter, tolerance * diameter);
    expect_close(d->area, f->area, tolerance * f->area);
    expect_close(d->sphericity, cbrt(pi) * pow(6 * f->volume, 2 / 3.0) / f->area, 2 * tolerance);
    expect_close(d->elongation, f->elongation, tolerance);
    expect_close(d->flatness, f->flatness, tolerance);
    if (!ms_hull_is_built()) {
        assert_true(isnan(d->feret[0]) && isnan(d->feret_elongation) && isnan(d->feret_flatness) && isnan(d->corey) &&
                    isnan(d->convexity));
        return;
    }
    for (int a = 0; a < 3; a++) {
        expect_close(d->feret[a], f->feret[a], tolerance * f->feret[0]);
    }
    expect_close(d->feret_elongation, f->feret[1] / f->feret[0], 2 * tolerance);
    expect_close(d->feret_flatness, f->feret[2] / f->feret[1], 2 * tolerance);
    expect_close(d->corey, f->feret[2] / sqrt(f->feret[0] * f->feret[1]), 2 * tolerance);
    expect_close(d->convexity, f->volume / f->hull, 2 * tolerance);
}

/* A mesh, askew and far from the origin. */
static void expect_mesh(const char *kind, const char *parameters, const form *f, double tolerance)
{
    ms_mesh mesh;
    ms_solid solid;
    ms_descriptors d;
    ms_error err = {{0}};
    make_shape(&mesh, kind, parameters);
    turn_body(&mesh, askew);
    for (size_t v = 0; v < mesh.n_vertices; v++) {
        mesh.vertex[v][1] += 100;
    }
    assert_int_equal(ms_solid_mesh(&solid, &mesh, &err), MS_OK);
    if (ms_descriptors_of_mesh(&d, &mesh, &solid, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
    expect_form(&d, f, tolerance);
    ms_mesh_free(&mesh);
}

/* The surface of the ellipsoid 3:2:1 is from the incomplete elliptic integrals, to 6 digits; all else is exact. */
static void meshes(void **state)
{
    (void)state;
    const double ball = 4 * pi / 3, s = sqrt(3), spheroid = 2 * pi * (1 + 2 / (s / 2) * asin(s / 2));
    const form ball_form = {ball, 4 * pi, 1, 1, {2, 2, 2}, ball};
    const form spheroid_form = {2 * ball, spheroid, 0.5, 1, {4, 2, 2}, 2 * ball};
    const form ellipsoid_form = {6 * ball, 48.882155, 2 / 3.0, 0.5, {6, 4, 2}, 6 * ball};
    const form box_form = {8, 28, 0.5, 0.5, {4, 2, 1}, 8};
    const form plate_form = {25 * 0.1, 52, 1, 0.1 / 5, {5, 5, 0.1}, 2.5};
    /* The hull of a ring is a disc with a round rim; means of z^2 and x^2: r^2 / 4, (R^2 + 3/4 r^2) / 2. */
    const double ring = 2 * pi * pi * 3, z = 1 / 4.0, x = (9 + 3 / 4.0) / 2;
    const form ring_form = {ring, 4 * pi * pi * 3, 1, sqrt(z / x), {8, 8, 2}, pi * (2 * 9 + pi * 3 + 4 / 3.0)};
    /* Band and two caps of height k on a base of radius r: the caps' own radius is (r^2 + k^2) / 2k. */
    const double r = 5.675, h = 4, k = 1.23, cap = pi * k / 6 * (3 * r * r + k * k), cap_area = pi * (r * r + k * k);
    double zz = pi * r * r * h * h * h / 12, xx = pi * r * r * r * r * h / 4;
    for (int m = 0; m < 100000; m++) {
        const double q = (r * r + k * k) / (2 * k), t = (m + 0.5) / 100000 * k, square = q * q - pow(q - k + t, 2);
        zz += 2 * pi * square * pow(h / 2 + t, 2) * k / 100000;
        xx += 2 * pi * square * square / 4 * k / 100000;
    }
    const double tablet = pi * r * r * h + 2 * cap;
    const form tablet_form = {tablet,        2 * pi * r * h + 2 * cap_area, 1,
                              sqrt(zz / xx), {2 * r, 2 * r, h + 2 * k},     tablet};
    expect_mesh("ball", "", &ball_form, 1e-3);
    expect_mesh("ellipsoid", "a=2 b=1 c=1", &spheroid_form, 1e-3);
    expect_mesh("ellipsoid", "a=3 b=2 c=1", &ellipsoid_form, 1e-3);
    expect_mesh("box", "a=4 b=2 c=1", &box_form, 1e-9);
    expect_mesh("plate", "", &plate_form, 1e-9);
    expect_mesh("torus", "", &ring_form, 3e-3);
    expect_mesh("tablet", "", &tablet_form, 4e-3); /* least across facets that lie a little askew */
}

/* Voxels of bodies, as a target of a volume has them: 2 % of the area, a voxel of the Feret dimensions. */
static void expect_voxels(const char *kind, const char *parameters, double cells, const form *f, double tolerance)
{
    ms_mesh mesh;
    ms_target target;
    ms_descriptors d;
    make_shape(&mesh, kind, parameters);
    turn_body(&mesh, askew);
    make_target(&target, &mesh, cells, MS_VOXEL_CENTRE);
    const ms_grid grid = target.grid;
    ms_volume volume = {.n = {grid.n[0], grid.n[1], grid.n[2]}, .spacing = grid.h};
    volume.label = calloc(ms_grid_voxels(&grid), sizeof *volume.label);
    for (size_t v = 0; v < ms_grid_voxels(&grid); v++) {
        volume.label[v] = grid.inside[v] ? 4 : 0;
    }
    ms_target label;
    assert_int_equal(ms_target_from_volume(&label, &volume, 4, NULL), MS_OK);
    assert_int_equal(ms_descriptors_of_target(&d, &label, NULL), MS_OK);
    expect_form(&d, f, tolerance);
    ms_volume_free(&volume);
    ms_target_free(&label);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

static void voxels(void **state)
{
    (void)state;
    const double ball = 4 * pi / 3;
    const form ball_form = {ball, 4 * pi, 1, 1, {2, 2, 2}, ball};
    const form ellipsoid_form = {6 * ball, 48.882155, 2 / 3.0, 0.5, {6, 4, 2}, 6 * ball};
    const form box_form = {8, 28, 0.5, 0.5, {4, 2, 1}, 8};
    const form ring_form = {
        6 * pi * pi, 12 * pi * pi, 1, sqrt(2 / (9 + 3 / 4.0) / 4), {8, 8, 2}, pi * (2 * 9 + pi * 3 + 4 / 3.0)};
    expect_voxels("ball", "", 60, &ball_form, 0.02);
    expect_voxels("ellipsoid", "a=3 b=2 c=1", 70, &ellipsoid_form, 0.02);
    expect_voxels("box", "a=4 b=2 c=1", 70, &box_form, 0.03); /* edges are rounded off */
    expect_voxels("torus", "", 80, &ring_form, 0.02);
}

/* A grain of few voxels has a volume and a form, but no area; a flat one has Feret dimensions, but no convexity. */
static void few_voxels(void **state)
{
    (void)state;
    ms_descriptors d;
    for (int side = 1; side <= 9; side += 2) {
        ms_grid grid = empty_grid(13, 13, 13, 0.5);
        for (int v = 0; v < side * side * side; v++) {
            grid.inside[ms_grid_index(&grid, 2 + v % side, 2 + v / side % side, 2 + v / side / side)] = 1;
        }
        const double edge = 0.5 * side, moment = pow(edge, 5) / 6;
        const ms_body body = {pow(edge, 3), {0}, {{moment, 0, 0}, {0, moment, 0}, {0, 0, moment}}};
        assert_int_equal(ms_descriptors_of_grid(&d, &grid, &body, NULL), MS_OK);
        const int enough = cbrt(6 / pi) * side >= MS_DESCRIPTORS_LEAST_DIAMETER;
        assert_int_equal(isfinite(d.area), enough);
        assert_int_equal(isfinite(d.sphericity), enough);
        assert_int_equal(isfinite(ms_descriptors_voxel_limit(&d, 0.5)), enough);
        expect_close(d.elongation, 1, 1e-12);
        assert_int_equal(isfinite(d.convexity), side > 1 && ms_hull_is_built());
        if (ms_hull_is_built()) { /* by the centres of faces: a box lacks its corners */
            assert_true(d.feret[2] <= edge && d.feret[2] > 0.5 * edge);
        }
        ms_grid_free(&grid);
    }
}

/* Of an open mesh the hull is known; in a target what its voxels have. Of bodies that overlap the area of the mesh is
 * not that of the union. */
static void open_and_overlapping(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_descriptors d;
    ms_target target;
    make_shape(&mesh, "box", "a=4 b=2 c=1");
    mesh.n_triangles -= 1;
    assert_int_equal(ms_descriptors_of_mesh(&d, &mesh, NULL, NULL), MS_OK);
    assert_true(isnan(d.volume) && isnan(d.area) && isnan(d.sphericity) && isnan(d.elongation) && isnan(d.convexity));
    if (ms_hull_is_built()) {
        expect_close(d.feret_elongation, 0.5, 1e-9);
    }
    assert_int_equal(ms_target_from_mesh(&target, &mesh, 0, 0.05, MS_VOXEL_CENTRE, NULL), MS_OK);
    assert_int_equal(ms_descriptors_of_target(&d, &target, NULL), MS_OK);
    expect_close(d.volume, 8, 1e-2);
    expect_close(d.elongation, 0.5, 1e-3);
    assert_true(d.area > 24 && d.area < 30);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
    const box_sample box[2] = {{{0, 0, 0}, {2, 1, 1}}, {{1, 0, 0}, {4, 1, 1}}};
    mesh = boxes_together(box, 2, askew);
    target = target_of(&mesh, 0.04, MS_VOXEL_CENTRE);
    assert_int_equal(ms_descriptors_of_target(&d, &target, NULL), MS_OK);
    expect_close(d.volume, 4, 1e-2);
    expect_close(d.area, 18,
                 0.05 * 18); /* of one box, 24 by the mesh; edges and large flat faces are Crofton's worst */
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* Two equal spheres: less two caps; the hull is a cylinder with two half balls. */
static void clumps(void **state)
{
    (void)state;
    for (double d = 0; d < 3; d += 0.5) {
        ms_clump clump = {0};
        ms_descriptors found;
        const double u[3] = {6 / 7.0, -2 / 7.0, 3 / 7.0}, cap = fmax(0, 1 - d / 2);
        add_sphere(&clump, 5, 5, 5, 1);
        add_sphere(&clump, 5 + d * u[0], 5 + d * u[1], 5 + d * u[2], 1);
        /* Of the union of both, by slices: an integral of x^2 over a slice and of z^2. */
        double volume = 0, xx = 0, zz = 0;
        for (int m = 0; m < 200000; m++) {
            const double z = (m + 0.5) / 200000 * (d / 2 + 1), square = 1 - pow(z - d / 2, 2);
            const double part = square > 0 ? 2 * pi * square * (d / 2 + 1) / 200000 : 0;
            volume += part;
            xx += part * square / 4;
            zz += part * z * z;
        }
        const double axis[3][3] = {{u[0], u[1], u[2]}, {0}, {0}};
        ms_body body = {.volume = volume};
        for (int a = 0; a < 3; a++) {
            for (int b = 0; b < 3; b++) { /* (xx + zz) 1 + (xx - zz) u u */
                body.inertia[a][b] = (a == b ? xx + zz : 0) + (xx - zz) * axis[0][a] * axis[0][b];
            }
        }
        const double hull = pi * d + ball_volume(1);
        const form f = {2 * ball_volume(1) - 2 * pi * cap * cap * (3 - cap) / 3,
                        8 * pi - 4 * pi * cap,
                        sqrt(xx / zz),
                        1,
                        {2 + d, 2, 2},
                        hull};
        assert_int_equal(ms_descriptors_of_clump(&found, &clump, &body, NULL), MS_OK);
        expect_form(&found, &f, 1e-3);
        ms_clump_free(&clump);
    }
}

static void without_voxels_no_axes(void **state)
{
    (void)state;
    const ms_body none = {0};
    ms_descriptors d;
    ms_clump clump = {0};
    add_sphere(&clump, 0, 0, 0, 0.1);
    assert_int_equal(ms_descriptors_of_clump(&d, &clump, &none, NULL), MS_OK);
    assert_true(isnan(d.elongation) && isnan(d.flatness));
    expect_close(d.sphericity, 1, 1e-12);
    ms_clump_free(&clump);
}

/* What the measures have is what is found here, whether the target brings it or not. */
static void they_are_measures(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_clump clump = {0};
    ms_descriptors of_shape, of_clump;
    make_shape(&mesh, "box", "a=4 b=2 c=1");
    ms_target target = target_of(&mesh, 0.1, MS_VOXEL_HALF);
    add_sphere(&clump, 2, 1, 0.5, 0.5);
    add_sphere(&clump, 1, 1, 0.5, 0.6);
    assert_int_equal(ms_descriptors_of_target(&of_shape, &target, NULL), MS_OK);
    for (int brought = 0; brought < 2; brought++) {
        const ms_metrics m = measure(&target, &clump, NULL);
        assert_int_equal(ms_descriptors_of_clump(&of_clump, &clump, &m.body, NULL), MS_OK);
#define SAME(X, CODE, name, ...)                                                \
    assert_memory_equal(&m.shape_##name, &of_shape.name, sizeof of_shape.name); \
    assert_memory_equal(&m.clump_##name, &of_clump.name, sizeof of_clump.name);
        MS_DESCRIPTOR_LIST(SAME, )
#undef SAME
        expect_close(m.voxel_limit, 28 * 0.1 / (4 * 8), 1e-12);
        if (!brought) {
            assert_int_equal(ms_descriptors_add(&target, NULL), MS_OK);
        }
    }
    ms_target_free(&target);
    ms_clump_free(&clump);
    ms_mesh_free(&mesh);
}

/* D of a digitised ball and the ball, and of two digitised balls, both by cells of a fifth of a voxel. */
static void mismatch_of_images(double mismatch[2], double radius, uint64_t *seed)
{
    const int n = 2 * (int)radius + 7;
    double off[2][3];
    size_t both[2] = {0}, sum[2] = {0};
    for (int a = 0; a < 6; a++) {
        off[a / 3][a % 3] = between(seed, -0.5, 0.5);
    }
    for (int p = 0; p < 125 * n * n * n; p++) {
        const int cell[3] = {p % (5 * n), p / (5 * n) % (5 * n), p / (25 * n * n)};
        double square[3] = {0};
        for (int a = 0; a < 3; a++) {
            const double at = (cell[a] + 0.5) / 5 - n / 2.0;
            square[2] += at * at;
            for (int g = 0; g < 2; g++) {
                square[g] += pow(rint(at - off[g][a]) + off[g][a], 2);
            }
        }
        for (int other = 1; other < 3; other++) {
            const int in = square[0] < radius * radius, in_other = square[other] < radius * radius;
            both[other - 1] += (size_t)(in && in_other);
            sum[other - 1] += (size_t)(in + in_other);
        }
    }
    for (int m = 0; m < 2; m++) {
        mismatch[m] += 1 - 2 * (double)both[m] / (double)sum[m];
    }
}

/* The limit is about what two images of one body differ by, twice what an image and its body do. */
static void the_voxel_limit(void **state)
{
    (void)state;
    enum { PAIRS = 6 };
    uint64_t seed = 3;
    for (double radius = 5; radius < 15; radius += 4.4) {
        const ms_descriptors ball = {.volume = ball_volume(radius), .area = 4 * pi * radius * radius};
        const double limit = ms_descriptors_voxel_limit(&ball, 1);
        double mismatch[2] = {0};
        for (int pair = 0; pair < PAIRS; pair++) {
            mismatch_of_images(mismatch, radius, &seed);
        }
        expect_close(mismatch[0] / PAIRS / limit, 0.7, 0.2);
        expect_close(mismatch[1] / PAIRS / limit, 0.48, 0.03);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(meshes),
        cmocka_unit_test(voxels),
        cmocka_unit_test(few_voxels),
        cmocka_unit_test(open_and_overlapping),
        cmocka_unit_test(clumps),
        cmocka_unit_test(without_voxels_no_axes),
        cmocka_unit_test(they_are_measures),
        cmocka_unit_test(the_voxel_limit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
