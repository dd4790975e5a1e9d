/* Surfaces that meet themselves, and such that do not. */
#include "mesh/ms_mesh_touch.h"

#include "support/overlap_samples.h"

static int touches(const ms_mesh *mesh)
{
    int found = -1;
    ms_error err = {{0}};
    if (ms_mesh_touch(&found, mesh, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
    return found;
}

static void no_shape_touches_itself(void **state)
{
    (void)state;
    for (const ms_shape_kind *kind = ms_shape_kinds; kind->name; kind++) {
        double value[MS_SHAPE_MAX_PARAMETERS];
        default_values(value, kind);
        ms_mesh mesh = make_body(kind->name, value);
        if (touches(&mesh)) {
            fail_msg("%s touches itself", kind->name);
        }
        turn_body(&mesh, askew);
        assert_int_equal(touches(&mesh), 0);
        ms_mesh_free(&mesh);
    }
}

/* A box beside another, with a gap, in contact, within; on all sides, by face, edge and corner. */
static void boxes_touch_where_they_do(void **state)
{
    (void)state;
    static const double gaps[] = {1e-6, 0, -1e-6, -0.25};
    for (int place = 0; place < 27; place++) {
        const int at[3] = {place % 3 - 1, place / 3 % 3 - 1, place / 9 - 1};
        for (size_t g = 0; g < sizeof gaps / sizeof gaps[0]; g++) {
            box_sample box[2] = {{{0, 0, 0}, {1, 1, 1}}, {{0.2, 0.3, 0.15}, {0.7, 0.65, 0.8}}};
            int sides = 0;
            for (int a = 0; a < 3; a++) {
                const double side = box[1].hi[a] - box[1].lo[a];
                if (at[a] != 0) {
                    box[1].lo[a] = at[a] > 0 ? 1 + gaps[g] : -gaps[g] - side;
                    box[1].hi[a] = box[1].lo[a] + side;
                    sides++;
                }
            }
            const int common_vertex = sides == 3 && gaps[g] == 0; /* that is no more than a joint */
            const int expected = sides > 0 && gaps[g] <= 0 && !common_vertex;
            for (int turned = 0; turned < 2; turned++) {
                ms_mesh mesh = boxes_together(box, 2, turned ? askew : upright);
                if (touches(&mesh) != (expected)) {
                    fail_msg("gap %g at %d %d %d, turned %d", gaps[g], at[0], at[1], at[2], turned);
                }
                ms_mesh_free(&mesh);
            }
        }
    }
}

/* A ball of many triangles, one vertex of which is drawn through the other side. */
static void a_spike_through_the_surface_is_found(void **state)
{
    (void)state;
    for (size_t v = 0; v < 40; v++) {
        ms_mesh mesh = make_body("ball", (const double[]){1, 8});
        double *p = mesh.vertex[v * mesh.n_vertices / 40];
        for (int k = 0; k < 3; k++) {
            p[k] *= -0.9;
        }
        assert_int_equal(touches(&mesh), 0);
        for (int k = 0; k < 3; k++) {
            p[k] *= 1.2;
        }
        assert_int_equal(touches(&mesh), 1);
        ms_mesh_free(&mesh);
    }
}

/* Two triangles with one common vertex, of which one passes through the other, or comes close. */
static void triangles_with_a_common_vertex(void **state)
{
    (void)state;
    for (int through = 0; through < 2; through++) {
        for (int flat = 0; flat < 2; flat++) {
            ms_mesh mesh = {0};
            const double x = through ? 0.5 : -0.5, height = flat ? 0 : 1;
            add_vertex(&mesh, 0, 0, 0);
            add_vertex(&mesh, 2, -1, 0);
            add_vertex(&mesh, 2, 1, 0);
            add_vertex(&mesh, x, -0.1, -height);
            add_vertex(&mesh, x, 0.1, height);
            add_triangle(&mesh, 0, 1, 2);
            add_triangle(&mesh, 0, 3, 4);
            turn_body(&mesh, askew);
            assert_int_equal(touches(&mesh), through);
            ms_mesh_free(&mesh);
        }
    }
}

static void a_mesh_without_triangles_is_refused(void **state)
{
    (void)state;
    int found;
    ms_error err = {{0}};
    assert_int_equal(ms_mesh_touch(&found, &(ms_mesh){0}, &err), MS_ERR_ARG);
    expect_message(&err, "no surface");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_shape_touches_itself),
        cmocka_unit_test(boxes_touch_where_they_do),
        cmocka_unit_test(a_spike_through_the_surface_is_found),
        cmocka_unit_test(triangles_with_a_common_vertex),
        cmocka_unit_test(a_mesh_without_triangles_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
