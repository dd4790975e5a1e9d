/* A study of contacts whose results are known, supports of meshes and voxels, and what is refused. */
#include "contact/ms_contact.h"

#include "mesh/ms_hull.h"
#include "support/test_support.h"
#include "voxel/ms_voxelize.h"

static const double PI = 3.14159265358979323846;

/* A ball of radius 1 off the origin, and the body that it is. */
static void make_ball(ms_clump *clump, ms_body *body)
{
    const ms_sphere ball = {{1, 2, 3}, 1};
    *clump = (ms_clump){0};
    *body = (ms_body){.volume = 4 * PI / 3, .centroid = {1, 2, 3}};
    assert_int_equal(ms_clump_add(clump, &ball, NULL), MS_OK);
}

static void test_ball(void **state)
{
    (void)state;
    ms_clump clump;
    ms_body body;
    ms_contact contact;
    ms_contact_options options = ms_contact_defaults();
    options.orientations = 5;
    make_ball(&clump, &body);
    assert_int_equal(ms_contact_study(&contact, &clump, &body, NULL, &options, NULL), MS_OK);
    assert_close(contact.r_eq, 1, 1e-15);
    assert_close(contact.clump.mean_width, 2, 1e-12);
    assert_int_equal(contact.n_rows, 4 * options.n_overlaps);
    for (size_t r = 0; r < contact.n_rows; r++) {
        assert_int_equal(contact.row[r].most, 1);
        assert_close(contact.row[r].stiffness, 1, 1e-9);
        assert_close(contact.row[r].restitution, 0.5, 1e-9);
    }
    ms_contact_free(&contact);
    ms_clump_free(&clump);
}

/* What the box from 0 to 3, 2, 1 reaches from a point. @param cut edge of the voxels whose hull goes through the
 * centres of faces and misses the corner; 0: there is a corner */
static void check_box(const ms_support *body, double cut)
{
    const double up[3] = {0, 0, 1}, left[3] = {-1, 0, 0}, across[3] = {sqrt(1 / 3.0), sqrt(1 / 3.0), sqrt(1 / 3.0)};
    assert_close(ms_support_height(body, up), 0.75, 1e-12);
    assert_close(ms_support_height(body, left), 1, 1e-12);
    assert_close(ms_support_height(body, across), (2 + 1.5 + 0.75 - cut) / sqrt(3), 1e-12);
}

static void test_support_of_box(void **state)
{
    (void)state;
    if (!ms_hull_is_built()) {
        skip();
    }
    const double centre[3] = {1, 0.5, 0.25};
    ms_mesh mesh;
    ms_grid grid;
    ms_support body;
    double lo[3], hi[3];
    make_shape(&mesh, "box", "a=3 b=2 c=1");
    ms_mesh_box(lo, hi, &mesh);
    for (size_t v = 0; v < mesh.n_vertices; v++) {
        for (int k = 0; k < 3; k++) {
            mesh.vertex[v][k] -= lo[k];
        }
    }
    assert_int_equal(ms_support_from_mesh(&body, &mesh, centre, NULL), MS_OK);
    check_box(&body, 0);
    ms_support_free(&body);
    assert_int_equal(ms_voxelize(&grid, &mesh, 0.125, MS_VOXEL_HALF, NULL), MS_OK);
    assert_int_equal(ms_support_from_grid(&body, &grid, centre, NULL), MS_OK);
    check_box(&body, 0.125);
    ms_support_free(&body);
    ms_grid_free(&grid);
    ms_mesh_free(&mesh);
}

static void expect_refused(const ms_clump *clump, const ms_body *body, const ms_contact_options *options,
                           ms_status status, const char *words)
{
    ms_contact contact;
    ms_error err;
    assert_int_equal(ms_contact_study(&contact, clump, body, NULL, options, &err), status);
    assert_non_null(strstr(err.text, words));
    assert_null(contact.clump.pose);
}

static void test_refused(void **state)
{
    (void)state;
    const ms_contact_options usual = ms_contact_defaults();
    ms_contact_options options[7];
    ms_clump clump, empty = {0};
    ms_body body;
    make_ball(&clump, &body);
    for (size_t o = 0; o < 7; o++) {
        options[o] = usual;
    }
    options[0].orientations = 0;
    options[1].restitution = 0;
    options[2].restitution = 1.5;
    options[3].n_overlaps = 0;
    options[4].n_overlaps = MS_CONTACT_MAX_OVERLAPS + 1;
    options[5].overlap[2] = 0.2;
    options[6].overlap[0] = (double)NAN;
    for (size_t o = 0; o < 7; o++) {
        expect_refused(&clump, &body, &options[o], MS_ERR_ARG, "1 to 16 overlaps");
    }
    expect_refused(&empty, &body, &usual, MS_ERR_ARG, "no spheres");
    body.centroid[0] = 600;
    expect_refused(&clump, &body, &usual, MS_ERR_LIMIT, "check units and frame");
    body.centroid[0] = 1;
    body.volume = 1e9;
    expect_refused(&clump, &body, &usual, MS_ERR_LIMIT, "check units and frame");
    ms_clump_free(&clump);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ball),
        cmocka_unit_test(test_support_of_box),
        cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
