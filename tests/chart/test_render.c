/* Pictures of bodies whose outlines have a formula. */
#include "chart/ms_render.h"
#include "support/test_support.h"

enum { SIZE = 200 };

static void start(ms_picture *picture, ms_view *view, const ms_target *target)
{
    ms_error err;
    assert_int_equal(ms_render_picture_alloc(picture, 2 * SIZE, SIZE, &err), MS_OK);
    assert_int_equal(ms_render_view(view, target, 0, 0, SIZE, &err), MS_OK);
}

/* Pixels of a square where something is. */
static double covered(const ms_picture *picture, const ms_view *view)
{
    double count = 0;
    for (int j = 0; j < view->size; j++) {
        for (int i = 0; i < view->size; i++) {
            count += isfinite(picture->depth[(view->y + j) * picture->width + view->x + i]);
        }
    }
    return count;
}

/* A ball fills a disc of radius 0.46 of the square: as a mesh, as a sphere. */
static void discs(void **state)
{
    (void)state;
    ms_mesh mesh;
    ms_target target;
    ms_picture picture;
    ms_view view;
    const double disc = acos(-1.0) * 0.46 * 0.46 * SIZE * SIZE;
    ms_sphere ball = {{0, 0, 0}, 2.385};
    const ms_clump clump = {.n_spheres = 1, .capacity = 1, .sphere = &ball};
    make_shape(&mesh, "ball", "r=2.385");
    make_target(&target, &mesh, 20, MS_VOXEL_HALF);
    start(&picture, &view, &target);
    ms_render_target(&picture, &view, &target);
    assert_close(covered(&picture, &view), disc, 0.005 * disc);
    assert_close((double)picture.depth[SIZE / 2 * picture.width + SIZE / 2], 0.46 * SIZE, 0.5);
    view.x = SIZE;
    ms_render_clump(&picture, &view, &clump);
    assert_close(covered(&picture, &view), disc, 0.005 * disc);
    assert_close((double)picture.depth[SIZE / 2 * picture.width + SIZE + SIZE / 2], 0.46 * SIZE, 0.5);
    ms_render_picture_free(&picture);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
}

/* Of spheres behind one another the nearest is seen, in whatever order they come; what is beyond the square is cut. */
static void nearest_is_seen(void **state)
{
    (void)state;
    ms_picture picture;
    ms_error err;
    const ms_view view = {.axis = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, .scale = SIZE / 2, .size = SIZE};
    for (int order = 0; order < 2; order++) {
        ms_sphere ball[3] = {{{0, 0, 0}, 0.5}, {{0, 0, 3}, 0.25}, {{1, 0.5, -3}, 0.4}};
        ms_sphere swapped[3] = {ball[1], ball[0], ball[2]};
        const ms_clump clump = {.n_spheres = 3, .capacity = 3, .sphere = order ? swapped : ball};
        assert_int_equal(ms_render_picture_alloc(&picture, 2 * SIZE, SIZE, &err), MS_OK);
        ms_render_clump(&picture, &view, &clump);
        const uint32_t *row = picture.part + SIZE / 2 * picture.width;
        assert_int_equal(row[SIZE / 2], order ? 1 : 2);
        assert_int_equal(row[SIZE / 2 + 40], order ? 2 : 1);
        assert_int_equal(row[SIZE / 2 + 60], 0);
        assert_int_equal(picture.part[SIZE / 4 * picture.width + SIZE - 1], 3);
        assert_int_equal(picture.part[SIZE / 4 * picture.width + SIZE], 0); /* beyond */
        ms_render_picture_free(&picture);
    }
}

/* The voxels of a box, seen along an axis, fill its rectangle; turned by the view they do not leave the square. */
static void voxels(void **state)
{
    (void)state;
    ms_error err;
    ms_picture picture;
    ms_target target = {.closed = 1};
    const int n[3] = {12, 8, 6};
    const double origin[3] = {-5.5, -3.5, -2.5};
    const ms_view view = {.axis = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, .scale = 10, .size = SIZE};
    assert_int_equal(ms_grid_alloc(&target.grid, n, 1, origin, &err), MS_OK);
    for (int k = 2; k < 4; k++) {
        for (int j = 2; j < 6; j++) {
            for (int i = 2; i < 10; i++) {
                target.grid.inside[ms_grid_index(&target.grid, i, j, k)] = 1;
            }
        }
    }
    assert_int_equal(ms_render_picture_alloc(&picture, SIZE, SIZE, &err), MS_OK);
    ms_render_target(&picture, &view, &target);
    assert_close(covered(&picture, &view), 8 * 4 * 100, 1);
    assert_close((double)picture.depth[SIZE / 2 * SIZE + SIZE / 2], 10, 1e-9);
    ms_render_picture_free(&picture);
    ms_grid_free(&target.grid);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(discs),
        cmocka_unit_test(nearest_is_seen),
        cmocka_unit_test(voxels),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
