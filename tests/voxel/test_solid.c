/* Unions of boxes and balls against formulas; bodies that touch keep their integrals. */
#include "voxel/ms_solid.h"

#include "support/overlap_samples.h"

static ms_solid solid_of(const ms_mesh *mesh)
{
    ms_solid solid;
    ms_error err = {{0}};
    if (ms_solid_mesh(&solid, mesh, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
    return solid;
}

static ms_body box_body(const box_sample *box)
{
    ms_body body = {.volume = 1};
    double side[3];
    for (int a = 0; a < 3; a++) {
        side[a] = box->hi[a] - box->lo[a];
        body.centroid[a] = 0.5 * (box->lo[a] + box->hi[a]);
        body.volume *= side[a];
    }
    for (int a = 0; a < 3; a++) {
        const double b = side[(a + 1) % 3], c = side[(a + 2) % 3];
        body.inertia[a][a] = body.volume * (b * b + c * c) / 12;
    }
    return body;
}

/* Sum of the boxes in an odd number less those in an even: inclusion and exclusion over all sets of boxes. */
static ms_body union_body(const box_sample *box, unsigned n)
{
    double volume = 0, first[3] = {0}, second[3][3] = {{0}}; /* about the origin */
    for (unsigned set = 1; set < 1u << n; set++) {
        box_sample common = {{-1e9, -1e9, -1e9}, {1e9, 1e9, 1e9}};
        int members = 0, empty = 0;
        for (unsigned k = 0; k < n; k++) {
            for (int a = 0; a < 3 && set >> k & 1; a++) {
                common.lo[a] = fmax(common.lo[a], box[k].lo[a]);
                common.hi[a] = fmin(common.hi[a], box[k].hi[a]);
            }
            members += set >> k & 1;
        }
        for (int a = 0; a < 3; a++) {
            empty |= common.hi[a] <= common.lo[a];
        }
        if (empty) {
            continue;
        }
        const ms_body part = box_body(&common);
        const double sign = members % 2 ? 1 : -1, *c = part.centroid;
        volume += sign * part.volume;
        for (int i = 0; i < 3; i++) {
            first[i] += sign * part.volume * c[i];
            for (int j = 0; j < 3; j++) {
                const double square = c[0] * c[0] + c[1] * c[1] + c[2] * c[2];
                second[i][j] += sign * (part.inertia[i][j] + part.volume * ((i == j ? square : 0) - c[i] * c[j]));
            }
        }
    }
    ms_body body = {.volume = volume};
    for (int i = 0; i < 3; i++) {
        body.centroid[i] = first[i] / volume;
    }
    const double *c = body.centroid, square = c[0] * c[0] + c[1] * c[1] + c[2] * c[2];
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            body.inertia[i][j] = second[i][j] - volume * ((i == j ? square : 0) - c[i] * c[j]);
        }
    }
    return body;
}

static void turn_exact(ms_body *body, const double turn[3][3])
{
    const ms_body b = *body;
    for (int i = 0; i < 3; i++) {
        body->centroid[i] = 0;
        for (int j = 0; j < 3; j++) {
            body->centroid[i] += turn[i][j] * b.centroid[j];
            body->inertia[i][j] = 0;
            for (int k = 0; k < 9; k++) {
                body->inertia[i][j] += turn[i][k / 3] * b.inertia[k / 3][k % 3] * turn[j][k % 3];
            }
        }
    }
}

static void expect_body(const ms_body *got, const ms_body *expected, double tolerance)
{
    const double trace = expected->inertia[0][0] + expected->inertia[1][1] + expected->inertia[2][2];
    expect_close(got->volume, expected->volume, tolerance * expected->volume);
    for (int i = 0; i < 3; i++) {
        expect_close(got->centroid[i], expected->centroid[i], tolerance * sqrt(trace / expected->volume));
        for (int j = 0; j < 3; j++) {
            expect_close(got->inertia[i][j], expected->inertia[i][j], 2 * tolerance * trace);
        }
    }
}

/* Of the samples the last ones lie in three boxes at once, share planes, and make a bar of very unequal sides. */
static const box_sample overlapping[][3] = {
    {{{0, 0, 0}, {2, 1, 1}}, {{1, 0.25, 0.25}, {3, 0.75, 0.75}}, {{5, 5, 5}, {6, 6, 6.5}}},
    {{{0, 0, 0}, {1, 1, 1}}, {{0.5, 0.25, 0.1}, {1.5, 1.25, 1.1}}, {{0.75, 0.5, 0.3}, {1.25, 2, 0.9}}},
    {{{0, 0, 0}, {2, 1, 1}}, {{1, 0, 0}, {3, 1, 1}}, {{0.5, 0, -1}, {1.5, 1, 2}}},
    {{{0, 0, 0}, {30, 1, 0.2}}, {{20, 0.2, 0.1}, {40, 0.8, 0.4}}, {{10, -3, 0.05}, {10.5, 3, 0.15}}},
};
enum { OVERLAPPING = sizeof overlapping / sizeof overlapping[0] };

static void boxes_that_overlap_unite(void **state)
{
    (void)state;
    for (int k = 0; k < OVERLAPPING; k++) {
        for (int turned = 0; turned < 2; turned++) {
            ms_mesh mesh = boxes_together(overlapping[k], 3, turned ? askew : upright);
            ms_body exact = union_body(overlapping[k], 3);
            turn_exact(&exact, turned ? askew : upright);
            for (int far = 0; far < 2; far++) {
                const double by = far * 1e4;
                move_body(&mesh, by, -by, by);
                exact.centroid[0] += by;
                exact.centroid[1] -= by;
                exact.centroid[2] += by;
                const ms_solid solid = solid_of(&mesh);
                assert_int_equal(solid.overlapping, 1);
                assert_true(solid.inside_out == 0);
                expect_close(solid.more_often, volume_of(&mesh) - exact.volume, 1e-3 * exact.volume);
                expect_body(&solid.body, &exact, 2e-4);
            }
            ms_mesh_free(&mesh);
        }
    }
}

/* So far off a third box that most planes of rays between meet nothing. */
static void boxes_far_apart_unite(void **state)
{
    static const box_sample boxes[3] = {
        {{0, 0, 0}, {1, 1, 1}}, {{0.5, 0.3, 0.2}, {1.5, 1.4, 1.3}}, {{0, 0, 6}, {1, 1, 7}}};
    (void)state;
    ms_mesh mesh = boxes_together(boxes, 3, upright);
    const ms_body exact = union_body(boxes, 3);
    const ms_solid solid = solid_of(&mesh);
    assert_int_equal(solid.overlapping, 1);
    expect_body(&solid.body, &exact, 2e-4);
    ms_mesh_free(&mesh);
}

/* Two balls of radius 1 whose centres are d apart have a lens of pi (4 + d) (2 - d)^2 / 12 in common. */
static void balls_that_overlap_unite(void **state)
{
    (void)state;
    for (double d = 0.3; d < 2; d += 0.4) {
        ms_mesh mesh = {0};
        for (int k = 0; k < 2; k++) {
            ms_mesh ball = make_body("ball", (const double[]){1, 96});
            turn_body(&ball, k ? askew : upright);
            move_body(&ball, (k - 0.5) * d * 2 / 7, (k - 0.5) * d * 3 / 7, (k - 0.5) * d * 6 / 7);
            add_part(&mesh, ball);
        }
        const double flat = volume_of(&mesh) / (8 * pi / 3); /* by which the facets fall short */
        const ms_solid solid = solid_of(&mesh);
        const double lens = pi * (4 + d) * (2 - d) * (2 - d) / 12;
        assert_int_equal(solid.overlapping, 1);
        expect_close(solid.body.volume, flat * (8 * pi / 3 - lens), 3e-4); /* the lens has facets too */
        for (int k = 0; k < 3; k++) {
            expect_close(solid.body.centroid[k], 0, 1e-5);
        }
        ms_mesh_free(&mesh);
    }
}

/* Boxes in contact by face, edge and corner; and a shape beside its neighbour by a slanted face. */
static void bodies_that_touch_keep_their_integrals(void **state)
{
    (void)state;
    static const box_sample touching[][3] = {
        {{{0, 0, 0}, {1, 1, 1}}, {{1, 0.2, 0.3}, {2, 0.7, 2.1}}, {{0.1, 1, 0.2}, {0.9, 2, 0.8}}},
        {{{0, 0, 0}, {1, 1, 1}}, {{1, 1, 0.3}, {2, 2, 2.1}}, {{-1, -1, -1}, {0, 0, 0}}},
        {{{0, 0, 0}, {1, 1, 1}}, {{1, 0, 0}, {2, 1, 1}}, {{1, 1, 0}, {2, 2, 1}}},
    };
    for (size_t k = 0; k < sizeof touching / sizeof touching[0]; k++) {
        for (int turned = 0; turned < 2; turned++) {
            ms_mesh mesh = boxes_together(touching[k], 3, turned ? askew : upright);
            const ms_solid solid = solid_of(&mesh);
            const ms_body exact = body_of(&mesh);
            assert_int_equal(solid.overlapping, 0);
            assert_int_equal(solid.touches, k < 2);
            assert_memory_equal(&solid.body, &exact, sizeof exact);
            ms_mesh_free(&mesh);
        }
    }
}

/* A prism on an outline that crosses itself: triangles of area 4 and 1, the lesser one inside out. */
static void what_is_inside_out_is_left_out(void **state)
{
    (void)state;
    static const double outline[4][2] = {{-1, -1}, {2, 2}, {2, -2}, {-1, 1}};
    for (int turned = 0; turned < 2; turned++) {
        ms_mesh mesh = {0};
        for (int k = 0; k < 8; k++) {
            add_vertex(&mesh, outline[k % 4][0], outline[k % 4][1], k / 4);
        }
        for (uint32_t k = 0; k < 4; k++) {
            const uint32_t next = (k + 1) % 4;
            add_triangle(&mesh, k, next, next + 4);
            add_triangle(&mesh, k, next + 4, k + 4);
        }
        add_triangle(&mesh, 0, 2, 1);
        add_triangle(&mesh, 0, 3, 2);
        add_triangle(&mesh, 4, 5, 6);
        add_triangle(&mesh, 4, 6, 7);
        turn_body(&mesh, turned ? askew : upright);
        repair_body(&mesh);
        /* A triangle of base 4 and height 2, one unit thick. */
        ms_body exact = {.volume = 4, .centroid = {4.0 / 3, 0, 0.5}};
        const double xx = 4 * 2.0 * 2.0 / 18, yy = 4 * 4.0 * 4.0 / 24, zz = 4 / 12.0;
        exact.inertia[0][0] = yy + zz;
        exact.inertia[1][1] = zz + xx;
        exact.inertia[2][2] = xx + yy;
        turn_exact(&exact, turned ? askew : upright);
        const ms_solid solid = solid_of(&mesh);
        assert_int_equal(solid.overlapping, 1);
        expect_close(solid.inside_out, 1, 1e-3);
        expect_body(&solid.body, &exact, 2e-4);
        ms_mesh_free(&mesh);
    }
}

static void threads_change_no_bit(void **state)
{
    (void)state;
    ms_mesh mesh = boxes_together(overlapping[1], 3, askew);
    const int threads = omp_get_max_threads();
    ms_solid first = {0};
    for (int n = 1; n < 6; n++) {
        omp_set_num_threads(n);
        const ms_solid solid = solid_of(&mesh);
        first = n == 1 ? solid : first;
        assert_memory_equal(&solid.body, &first.body, sizeof first.body);
    }
    omp_set_num_threads(threads);
    ms_mesh_free(&mesh);
}

static void what_encloses_nothing_is_refused(void **state)
{
    (void)state;
    ms_solid solid;
    ms_error err = {{0}};
    ms_mesh flat = cuboid(0, 1, 0, 1, 0, 0);
    assert_int_equal(ms_solid_mesh(&solid, &flat, &err), MS_ERR_SHAPE);
    expect_message(&err, "encloses no volume");
    assert_true(solid.body.volume == 0 && !solid.overlapping);
    ms_mesh_free(&flat);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes_that_overlap_unite),         cmocka_unit_test(boxes_far_apart_unite),
        cmocka_unit_test(balls_that_overlap_unite),         cmocka_unit_test(bodies_that_touch_keep_their_integrals),
        cmocka_unit_test(what_is_inside_out_is_left_out),   cmocka_unit_test(threads_change_no_bit),
        cmocka_unit_test(what_encloses_nothing_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
