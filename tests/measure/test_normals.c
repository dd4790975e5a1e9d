/* Angles between the surfaces of spheres and shapes: where a formula gives them, and by brute force. */
#include "support/clump_samples.h"

#include "base/ms_vector.h"

static const double degrees = 180 / 3.14159265358979323846;

/* Without the descriptors, which take their time. */
static ms_metrics measure_normals(const ms_target *target, const ms_clump *clump)
{
    ms_metrics metrics;
    assert_int_equal(
        ms_metrics_compute_kinds(&metrics, NULL, MS_METRICS_KIND(NORMAL), target, clump, MANY_VOXELS, NULL), MS_OK);
    return metrics;
}

static ms_metrics measure_one(const ms_target *target, double x, double y, double z, double radius)
{
    ms_clump clump = {0};
    add_sphere(&clump, x, y, z, radius);
    const ms_metrics metrics = measure_normals(target, &clump);
    ms_clump_free(&clump);
    return metrics;
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Of n values, which are sorted. */
static double quantile(double *value, int n, double part)
{
    qsort(value, (size_t)n, sizeof *value, ascending);
    return value[(int)(part * n)];
}

static void a_ball_in_a_ball_has_its_normals(void **state)
{
    (void)state;
    ms_mesh mesh = make_body("ball", (double[]){1, 64});
    move_body(&mesh, 3, -4, 5);
    ms_target target = target_of(&mesh, 0.1, MS_VOXEL_HALF);
    for (double radius = 0.4; radius < 1.5; radius += 0.385) {
        const ms_metrics m = measure_one(&target, 3, -4, 5, radius);
        assert_true(m.normal_median < 0.6 && m.normal_95 < 1); /* facets are 1.4 degrees across */
        assert_true(m.edge_part == 0 && isnan(m.edge_normal_median) && isnan(m.edge_normal_95));
    }
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* In a cube the nearest face is that of the largest coordinate z of the normal, and z is spread evenly over a sphere: 6
 * (1 - z) / 2 of it have more, up to where the caps overlap. */
static void a_ball_in_a_cube_is_turned_from_its_faces(void **state)
{
    (void)state;
    ms_mesh mesh = make_body("cube", (double[]){4, 2});
    double lo[3], hi[3];
    ms_mesh_box(lo, hi, &mesh);
    ms_target target = target_of(&mesh, 0.06, MS_VOXEL_HALF);
    const ms_metrics m = measure_one(&target, (lo[0] + hi[0]) / 2, (lo[1] + hi[1]) / 2, (lo[2] + hi[2]) / 2, 1);
    expect_close(m.normal_median, degrees * acos(5.0 / 6), 0.3);
    assert_true(m.normal_95 > 45 && m.normal_95 < degrees * acos(1 / sqrt(3)));
    assert_true(m.edge_part == 0);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* One that comes near the edges: they are at (b, b, z) to (b, b, -z) and so on. */
static void what_is_near_an_edge_is_apart(void **state)
{
    enum { POINTS = 200000 };
    static double away[POINTS], near[POINTS];
    const double b = 1.2;
    int n_away = 0, n_near = 0;
    (void)state;
    ms_mesh mesh = make_body("cube", (double[]){2 * b, 2});
    double lo[3], hi[3];
    ms_mesh_box(lo, hi, &mesh);
    move_body(&mesh, -b - lo[0], -b - lo[1], -b - lo[2]);
    ms_target target = target_of(&mesh, 0.05, MS_VOXEL_HALF);
    const ms_metrics m = measure_one(&target, 0, 0, 0, 1);
    uint64_t seed = 12;
    for (int p = 0; p < POINTS; p++) {
        const double z = 2 * next_uniform(&seed) - 1, turn = 2 * pi * next_uniform(&seed), ring = sqrt(1 - z * z);
        double x[3] = {fabs(ring * cos(turn)), fabs(ring * sin(turn)), fabs(z)};
        qsort(x, 3, sizeof *x, ascending);
        if (hypot(b - x[1], b - x[2]) < 1) {
            near[n_near++] = degrees * acos(x[2]);
        } else {
            away[n_away++] = degrees * acos(x[2]);
        }
    }
    expect_close(m.edge_part, (double)n_near / POINTS, 0.004);
    assert_true(n_near > POINTS / 3 && n_away > POINTS / 10);
    expect_close(m.normal_median, quantile(away, n_away, 0.5), 0.4);
    expect_close(m.normal_95, quantile(away, n_away, 0.95), 0.4);
    expect_close(m.edge_normal_median, quantile(near, n_near, 0.5), 0.4);
    expect_close(m.edge_normal_95, quantile(near, n_near, 0.95), 0.4);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/*
 * Spheres of radius 1 along the axis of a capsule, d apart: at s from the nearest centre the normal is turned by asin
 * s, and s is spread evenly over their surface (Archimedes). The half balls at the ends fit. Over a straight part of
 * length l so much of the surface is turned by less than a: (2 + l 2 sin a / d) / (2 + l).
 */
static void a_chain_in_a_capsule_is_turned_by_an_arc_sine(void **state)
{
    (void)state;
    ms_mesh mesh = make_body("needle", (double[]){12, 1, 64});
    ms_target target = target_of(&mesh, 0.06, MS_VOXEL_HALF);
    for (int spheres = 6; spheres < 24; spheres += 5) {
        ms_clump clump = {0};
        const double l = 10, d = l / (spheres - 1);
        for (int s = 0; s < spheres; s++) {
            add_sphere(&clump, s * d - l / 2, 0, 0, 1);
        }
        const ms_metrics m = measure_normals(&target, &clump);
        expect_close(m.normal_median, degrees * asin(d / 2 * (0.5 * (2 + l) - 2) / l), 0.6);
        expect_close(m.normal_95, degrees * asin(d / 2 * (0.95 * (2 + l) - 2) / l), 0.6);
        expect_close(m.work, spheres * cbrt((4.0 / 3 + l) * 3 / 4), 0.01 * m.work); /* r_eq^3 = (4/3 + l) 3/4 */
        ms_clump_free(&clump);
    }
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* Two spheres that stick out of a slab on both sides: the normal is turned from its faces by acos |z|, z even. */
static void spheres_through_a_slab_are_turned_up_to_a_right_angle(void **state)
{
    (void)state;
    ms_mesh mesh = make_body("plate", (double[]){8, 8, 1, 4});
    double lo[3], hi[3];
    ms_mesh_box(lo, hi, &mesh);
    ms_target target = target_of(&mesh, 0.06, MS_VOXEL_HALF);
    ms_clump clump = {0};
    for (int s = -1; s <= 1; s += 2) {
        add_sphere(&clump, (lo[0] + hi[0]) / 2 + 1.2 * s, (lo[1] + hi[1]) / 2, (lo[2] + hi[2]) / 2, 1);
    }
    const ms_metrics m = measure_normals(&target, &clump);
    expect_close(m.normal_median, 60, 0.3);
    expect_close(m.normal_95, degrees * acos(0.05), 0.3);
    expect_close(m.work, 2 * cbrt(64 * 3 / (4 * pi)), 1e-9);
    ms_clump_free(&clump);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

static void nearest_on_segment(double out[3], const double p[3], const double a[3], const double b[3])
{
    const double ab[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, ap[3] = {p[0] - a[0], p[1] - a[1], p[2] - a[2]};
    const double t = fmax(0, fmin(1, ms_dot(ab, ap) / ms_dot(ab, ab)));
    for (int k = 0; k < 3; k++) {
        out[k] = a[k] + t * ab[k];
    }
}

/* The projection on the plane, if it lies within, or the nearest point of a side. */
static void nearest_on_triangle(double out[3], const double p[3], const double *corner[3], const double normal[3])
{
    const double from[3] = {p[0] - corner[0][0], p[1] - corner[0][1], p[2] - corner[0][2]};
    double least = HUGE_VAL;
    int within = 1;
    for (int k = 0; k < 3; k++) {
        out[k] = p[k] - ms_dot(from, normal) * normal[k];
    }
    for (int k = 0; k < 3; k++) {
        double area[3];
        ms_vector_triangle(area, corner[k], corner[(k + 1) % 3], out);
        within &= ms_dot(area, normal) >= 0;
    }
    for (int k = 0; k < 3 && !within; k++) {
        double on[3];
        nearest_on_segment(on, p, corner[k], corner[(k + 1) % 3]);
        if (ms_squared_distance(on, p) < least) {
            least = ms_squared_distance(on, p);
            memcpy(out, on, sizeof on);
        }
    }
}

/* The mean of the normals of the nearest faces; of the many triangles of a plane each but once. */
static void brute_normal(double normal[3], const ms_mesh *mesh, const double p[3])
{
    double least = HUGE_VAL, sum[3] = {0}, last[3] = {0};
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        const double *corner[3];
        double own[3], on[3];
        for (int k = 0; k < 3; k++) {
            corner[k] = mesh->vertex[mesh->triangle[t][k]];
        }
        ms_vector_triangle(own, corner[0], corner[1], corner[2]);
        const double length = sqrt(ms_dot(own, own));
        for (int k = 0; k < 3; k++) {
            own[k] /= length;
        }
        nearest_on_triangle(on, p, corner, own);
        const double away = sqrt(ms_squared_distance(on, p));
        const int nearer = away < least - 1e-9, other = ms_dot(own, last) < 1 - 1e-9;
        for (int k = 0; k < 3 && away < least + 1e-9 && (nearer || other); k++) {
            sum[k] = nearer ? own[k] : sum[k] + own[k];
            last[k] = own[k];
        }
        least = fmin(least, away);
    }
    for (int k = 0; k < 3; k++) {
        normal[k] = sum[k] / sqrt(ms_dot(sum, sum));
    }
}

/* A point of the lattice of ms_surface.h. @return 0 if it is in another sphere */
static int exposed_point(double p[3], double normal[3], const ms_clump *clump, size_t s, int m, int samples)
{
    const ms_sphere *sphere = &clump->sphere[s];
    const double z = 1 - (2 * m + 1.0) / samples, ring = sqrt(1 - z * z), turn = pi * (3 - sqrt(5)) * m;
    int exposed = 1;
    normal[0] = ring * cos(turn);
    normal[1] = ring * sin(turn);
    normal[2] = z;
    for (int k = 0; k < 3; k++) {
        p[k] = sphere->centre[k] + sphere->radius * normal[k];
    }
    for (size_t o = 0; o < clump->n_spheres; o++) {
        const ms_sphere *other = &clump->sphere[o];
        exposed &= other == sphere || ms_squared_distance(p, other->centre) > other->radius * other->radius;
    }
    return exposed;
}

static int is_on_rim(const double p[3])
{
    return fabs(hypot(p[0], p[1]) - 1) < 1e-9 && fabs(fabs(p[2]) - 1) < 1e-9;
}

/* From the rims of a cylinder about z of radius 1 and height 2, which are its sharp edges: chords of 32 sides. */
static double distance_from_rims(const ms_mesh *mesh, const double p[3])
{
    double least = HUGE_VAL;
    for (size_t side = 0; side < 3 * mesh->n_triangles; side++) {
        const uint32_t *t = mesh->triangle[side / 3];
        const double *a = mesh->vertex[t[side % 3]], *b = mesh->vertex[t[(side % 3 + 1) % 3]];
        double on[3];
        if (is_on_rim(a) && is_on_rim(b) && a[2] == b[2]) {
            nearest_on_segment(on, p, a, b);
            least = fmin(least, sqrt(ms_squared_distance(on, p)));
        }
    }
    return least;
}

/* An angle and the area that has it. */
typedef struct weighed_angle {
    double angle, area;
} weighed_angle;

static double quantile_of_area(weighed_angle *list, int n, double part)
{
    double total = 0, below = 0;
    int at = 0;
    qsort(list, (size_t)n, sizeof *list, ascending); /* by the angle, which is first */
    for (int k = 0; k < n; k++) {
        total += list[k].area;
    }
    while (below + list[at].area < part * total) {
        below += list[at++].area;
    }
    return list[at].angle;
}

/* Spheres that stick out of the cylinder and do not reach all of it. */
static void scatter_spheres(ms_clump *clump, uint64_t *seed)
{
    for (int s = 0; s < 14; s++) {
        const double turn = 2 * pi * next_uniform(seed), out = 0.6 * next_uniform(seed);
        const double z = 1.6 * next_uniform(seed) - 0.8;
        add_sphere(clump, out * cos(turn), out * sin(turn), z, 0.25 + 0.5 * next_uniform(seed));
    }
}

static void normals_agree_with_brute_force(void **state)
{
    static weighed_angle list[2][14 * 1000];
    int count[2] = {0};
    double sum[2] = {0};
    uint64_t seed = 77;
    (void)state;
    ms_mesh mesh = make_body("cylinder", (double[]){1, 2, 8});
    double lo[3], hi[3], p[3], normal[3], own[3];
    const double h = 0.03;
    ms_mesh_box(lo, hi, &mesh);
    move_body(&mesh, 0, 0, -1 - lo[2]);
    ms_target target = target_of(&mesh, h, MS_VOXEL_HALF);
    ms_clump clump = {0};
    scatter_spheres(&clump, &seed);
    const ms_metrics m = measure_normals(&target, &clump);
    for (size_t s = 0; s < clump.n_spheres; s++) {
        const double r = clump.sphere[s].radius, area = 4 * pi * r * r;
        const int samples = (int)fmin(1000, ceil(area / (4 * h * h)));
        for (int k = 0; k < samples; k++) {
            if (exposed_point(p, normal, &clump, s, k, samples)) {
                brute_normal(own, &mesh, p);
                const int near = distance_from_rims(&mesh, p) < ms_clump_smallest_radius(&clump);
                list[near][count[near]++] =
                    (weighed_angle){degrees * acos(fmin(1, ms_dot(own, normal))), area / samples};
                sum[near] += area / samples;
            }
        }
    }
    assert_true(count[0] > 300 && count[1] > 300);
    expect_close(m.edge_part, sum[1] / (sum[0] + sum[1]), 1e-9);
    expect_close(m.normal_median, quantile_of_area(list[0], count[0], 0.5), 0.03);
    expect_close(m.normal_95, quantile_of_area(list[0], count[0], 0.95), 0.03);
    expect_close(m.edge_normal_median, quantile_of_area(list[1], count[1], 0.5), 0.03);
    expect_close(m.edge_normal_95, quantile_of_area(list[1], count[1], 0.95), 0.03);
    ms_clump_free(&clump);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* Voxels of an ellipsoid that lies askew on the lattice, and its mesh. */
static void normals_of_voxels_are_those_of_the_body(void **state)
{
    (void)state;
    ms_mesh mesh = make_body("ellipsoid", (double[]){2, 1.3, 1, 40});
    for (size_t v = 0; v < mesh.n_vertices; v++) { /* about z, then about x */
        double *p = mesh.vertex[v];
        const double x = 0.8 * p[0] - 0.6 * p[1], y = 0.6 * p[0] + 0.8 * p[1], z = p[2];
        p[0] = x;
        p[1] = 0.28 * y - 0.96 * z;
        p[2] = 0.96 * y + 0.28 * z;
    }
    ms_target body = target_of(&mesh, 0.05, MS_VOXEL_HALF), voxels;
    uint32_t *label = calloc(ms_grid_voxels(&body.grid), sizeof *label);
    ms_volume volume = {.spacing = 0.05, .label = label};
    for (size_t v = 0; v < ms_grid_voxels(&body.grid); v++) {
        label[v] = body.grid.inside[v];
    }
    memcpy(volume.n, body.grid.n, sizeof volume.n);
    memcpy(volume.origin, body.grid.origin, sizeof volume.origin);
    assert_int_equal(ms_target_from_volume(&voxels, &volume, 0, NULL), MS_OK);
    ms_clump clump = {0};
    for (int s = -2; s <= 2; s++) {
        add_sphere(&clump, 0.5 * s * 0.8, 0.5 * s * 0.6 * 0.28, 0.5 * s * 0.6 * 0.96, 1.05 - 0.15 * abs(s));
    }
    const ms_metrics of_mesh = measure_normals(&body, &clump), of_voxels = measure_normals(&voxels, &clump);
    expect_close(of_voxels.normal_median, of_mesh.normal_median, 0.5);
    expect_close(of_voxels.normal_95, of_mesh.normal_95, 1);
    assert_true(of_mesh.normal_median > 5 && of_voxels.edge_part == 0 && isnan(of_voxels.edge_normal_median));
    ms_clump_free(&clump);
    ms_target_free(&voxels);
    ms_target_free(&body);
    ms_mesh_free(&mesh);
    free(label);
}

/* Deep within a digitised ball, and far beyond its grid, the nearest place of its surface lies along the radius. */
static void voxels_are_found_from_anywhere(void **state)
{
    enum { SIDE = 44 };
    static uint32_t label[SIDE * SIDE * SIDE];
    const double middle = 21.3, radius = 18.7;
    (void)state;
    for (int v = 0; v < SIDE * SIDE * SIDE; v++) {
        const double x = v % SIDE - middle, y = v / SIDE % SIDE - middle, z = v / SIDE / SIDE - middle;
        label[v] = x * x + y * y + z * z < radius * radius;
    }
    const ms_volume volume = {.n = {SIDE, SIDE, SIDE}, .spacing = 0.5, .origin = {-3, 4, 5}, .label = label};
    ms_target target;
    assert_int_equal(ms_target_from_volume(&target, &volume, 0, NULL), MS_OK);
    const double at[3] = {-3 + middle / 2, 4 + middle / 2, 5 + middle / 2};
    for (int k = 0; k < 9; k++) { /* far off many voxels are about as near as the nearest */
        static const double PARTS[] = {0.15, 0.3, 0.6, 0.9, 1, 1.1, 1.7, 2.6, 4.2};
        const ms_metrics m = measure_one(&target, at[0], at[1], at[2], PARTS[k] * radius / 2);
        const int close = fabs(PARTS[k] - 1) < 0.2;
        assert_true(m.normal_median < (close ? 2.5 : 7) && m.normal_95 < (close ? 5 : 11));
    }
    /* So far off that only one place is the nearest: normals are turned evenly, by the cosine. */
    const ms_metrics m = measure_one(&target, at[0] + 50, at[1], at[2], 1);
    expect_close(m.normal_median, 90, 6);
    ms_target_free(&target);
}

/* What is not asked for is not known, and what is asked for is the same. */
static void kinds_are_measured_as_they_are_asked_for(void **state)
{
    static const unsigned KINDS[] = {MS_METRICS_KIND(SURFACE), MS_METRICS_KIND(NORMAL), MS_METRICS_KIND(DESCRIPTOR)};
    (void)state;
    ms_mesh mesh = make_body("ellipsoid", (double[]){2, 1, 1, 16});
    ms_target target = target_of(&mesh, 0.1, MS_VOXEL_HALF);
    ms_clump clump = {0};
    add_sphere(&clump, -0.7, 0, 0, 0.95);
    add_sphere(&clump, 0.7, 0, 0, 0.95);
    const ms_metrics all = measure(&target, &clump, NULL);
    for (unsigned bits = 0; bits < 8; bits++) {
        unsigned kinds = 0;
        ms_metrics some;
        for (int k = 0; k < 3; k++) {
            kinds |= bits >> k & 1 ? KINDS[k] : 0;
        }
        assert_int_equal(ms_metrics_compute_kinds(&some, NULL, kinds, &target, &clump, MANY_VOXELS, NULL), MS_OK);
        for (const ms_measure *m = ms_measures; m->name; m++) {
            const unsigned kind = (1u << m->kind) & MS_METRICS_ALL;
            const double have = m->of_metrics(&some), want = kind & ~kinds ? (double)NAN : m->of_metrics(&all);
            assert_true(have == want || (isnan(have) && isnan(want)));
        }
        assert_memory_equal(&some.inertia, &all.inertia, sizeof all.inertia);
    }
    ms_clump_free(&clump);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

static void an_open_mesh_has_no_outside(void **state)
{
    (void)state;
    ms_mesh mesh = make_body("cube", (double[]){2, 2});
    ms_target target;
    mesh.n_triangles -= 1;
    assert_int_equal(ms_target_from_mesh(&target, &mesh, 0, 0.1, MS_VOXEL_HALF, NULL), MS_OK);
    const ms_metrics m = measure_sphere(&target, 0, 0, 0, 1);
    assert_true(isnan(m.normal_median) && isnan(m.normal_95) && isnan(m.edge_part) && isnan(m.edge_normal_95));
    assert_true(isnan(m.protrusion_max) && isfinite(m.gap_max));
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ball_in_a_ball_has_its_normals),
        cmocka_unit_test(a_ball_in_a_cube_is_turned_from_its_faces),
        cmocka_unit_test(what_is_near_an_edge_is_apart),
        cmocka_unit_test(a_chain_in_a_capsule_is_turned_by_an_arc_sine),
        cmocka_unit_test(spheres_through_a_slab_are_turned_up_to_a_right_angle),
        cmocka_unit_test(normals_agree_with_brute_force),
        cmocka_unit_test(normals_of_voxels_are_those_of_the_body),
        cmocka_unit_test(voxels_are_found_from_anywhere),
        cmocka_unit_test(kinds_are_measured_as_they_are_asked_for),
        cmocka_unit_test(an_open_mesh_has_no_outside),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
