/* Every kind of shape: sound, of the right volume, its own mirror image. */
#include "support/body_samples.h"

static void expect_sound(const ms_shape_kind *kind, const double *value, double tolerance)
{
    ms_mesh mesh = make_body(kind->name, value);
    size_t n_triangles = mesh.n_triangles;
    size_t n_vertices = mesh.n_vertices;
    int hollow = strcmp(kind->name, "hollow") == 0;
    ms_mesh_report r = repair_body(&mesh);
    if (!r.closed || r.flipped > 0 || mesh.n_triangles != n_triangles || mesh.n_vertices != n_vertices) {
        fail_msg("%s: %zu flipped, %zu dropped, %zu odd edges", kind->name, r.flipped, n_triangles - mesh.n_triangles,
                 r.odd_edges);
    }
    assert_int_equal(r.nonmanifold_edges, 0);
    assert_int_equal(r.shells, hollow ? 2 : 1);
    assert_int_equal(r.cavities, hollow);
    ms_body body = body_of(&mesh);
    double size = cbrt(body.volume);
    for (int k = 0; k < 3; k++) {
        expect_close(body.centroid[k], 0, 1e-12 * size);
    }
    assert_non_null(kind->volume);
    expect_close(body.volume, kind->volume(value), tolerance * body.volume);
    ms_mesh_free(&mesh);
}

static void defaults_are_sound_and_of_the_right_volume(void **state)
{
    (void)state;
    for (const ms_shape_kind *kind = ms_shape_kinds; kind->name; kind++) {
        double value[MS_SHAPE_MAX_PARAMETERS];
        default_values(value, kind);
        expect_sound(kind, value, 1e-3);
        ms_mesh mesh = make_body(kind->name, value);
        assert_in_range(mesh.n_triangles, 500, 41000);
        ms_mesh_free(&mesh);
    }
}

static void any_fineness_is_sound(void **state)
{
    (void)state;
    for (const ms_shape_kind *kind = ms_shape_kinds; kind->name; kind++) {
        double value[MS_SHAPE_MAX_PARAMETERS];
        default_values(value, kind);
        for (int fineness = 2; fineness < 12; fineness++) {
            value[fineness_at(kind)] = fineness;
            expect_sound(kind, value, 0.9);
        }
    }
}

static void other_sizes_are_sound(void **state)
{
    (void)state;
    static const double scale[] = {1e-6, 2.385, 1e6};
    for (const ms_shape_kind *kind = ms_shape_kinds; kind->name; kind++) {
        for (size_t s = 0; s < sizeof scale / sizeof *scale; s++) {
            double value[MS_SHAPE_MAX_PARAMETERS];
            default_values(value, kind);
            for (int k = 0; kind->parameters[k].name; k++) {
                if (kind->parameters[k].max == 1e12) { /* a length */
                    value[k] *= scale[s];
                }
            }
            expect_sound(kind, value, 1e-3);
        }
    }
}

/* Known by other means than the kinds' own formulas. */
static void volumes_are_the_known_ones(void **state)
{
    typedef struct known {
        const char *kind;
        double value[MS_SHAPE_MAX_PARAMETERS];
        double volume;
    } known;
    static const known list[] = {
        {"torus", {3, 1, 34}, 59.21762640653615},        /* 6 pi^2 */
        {"ellipsoid", {2, 1, 1, 56}, 8.377580409572781}, /* 8 pi / 3 */
        {"hollow", {2, 1, 48}, 29.321531433504735},      /* 28 pi / 3 */
        {"octahedron", {1, 16}, 1.3333333333333333},
        {"tetrahedron", {6, 16}, 25.45584412271571},   /* 18 sqrt 2 */
        {"needle", {4, 1, 32}, 10.471975511965978},    /* 2 pi + 4 pi / 3 */
        {"tablet", {1, 2, 1, 48}, 10.471975511965978}, /* half balls as caps: a needle again */
        {"cone", {1, 3, 48}, 3.141592653589793},
        {"bowl", {1, 0.5, 48}, 1.8325957145940461}, /* 7 pi / 12 */
        {"cross", {10, 1, 40}, 28},
    };
    (void)state;
    for (size_t k = 0; k < sizeof list / sizeof *list; k++) {
        const ms_shape_kind *kind = ms_shape_find(list[k].kind, NULL);
        expect_close(kind->volume(list[k].value), list[k].volume, 1e-13 * list[k].volume);
        expect_sound(kind, list[k].value, 1e-3);
    }
}

/* Vertices in the order of their coordinates, and triangles as sorted triples of places in
   that order: two meshes are one set of triangles if these are equal. */
typedef struct canonical {
    double (*vertex)[3];
    uint32_t (*triangle)[3];
} canonical;

static int compare_points(const void *a, const void *b)
{
    const double *x = a;
    const double *y = b;
    for (int k = 0; k < 3; k++) {
        if (x[k] != y[k]) {
            return x[k] < y[k] ? -1 : 1;
        }
    }
    return 0;
}

static int compare_corners(const void *a, const void *b)
{
    const uint32_t *x = a;
    const uint32_t *y = b;
    for (int k = 0; k < 3; k++) {
        if (x[k] != y[k]) {
            return x[k] < y[k] ? -1 : 1;
        }
    }
    return 0;
}

static canonical make_canonical(const ms_mesh *mesh)
{
    canonical c = {malloc(mesh->n_vertices * sizeof *c.vertex), malloc(mesh->n_triangles * sizeof *c.triangle)};
    assert_non_null(c.vertex);
    assert_non_null(c.triangle);
    memcpy(c.vertex, mesh->vertex, mesh->n_vertices * sizeof *c.vertex);
    qsort(c.vertex, mesh->n_vertices, sizeof *c.vertex, compare_points);
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        uint32_t p[3];
        for (int k = 0; k < 3; k++) {
            double(*found)[3] = bsearch(mesh->vertex[mesh->triangle[t][k]], c.vertex, mesh->n_vertices,
                                        sizeof *c.vertex, compare_points);
            p[k] = (uint32_t)(found - c.vertex);
        }
        int least = p[0] < p[1] ? (p[0] < p[2] ? 0 : 2) : (p[1] < p[2] ? 1 : 2);
        for (int k = 0; k < 3; k++) {
            c.triangle[t][k] = p[(least + k) % 3];
        }
    }
    qsort(c.triangle, mesh->n_triangles, sizeof *c.triangle, compare_corners);
    return c;
}

/* `plane` 0 to 2: across that axis; 3: x and y exchanged. */
static void expect_mirror_image(const char *kind, const ms_mesh *mesh, int plane)
{
    ms_mesh image = {0};
    ms_mesh copy;
    assert_int_equal(ms_mesh_alloc(&copy, mesh->n_vertices, mesh->n_triangles, NULL), MS_OK);
    memcpy(copy.vertex, mesh->vertex, mesh->n_vertices * sizeof *copy.vertex);
    memcpy(copy.triangle, mesh->triangle, mesh->n_triangles * sizeof *copy.triangle);
    add_part(&image, copy);
    for (size_t v = 0; v < image.n_vertices; v++) {
        double *p = image.vertex[v];
        if (plane < 3) {
            p[plane] = 0.0 - p[plane];
        } else {
            double swap = p[0];
            p[0] = p[1];
            p[1] = swap;
        }
    }
    reverse_all(&image);
    canonical a = make_canonical(mesh);
    canonical b = make_canonical(&image);
    for (size_t v = 0; v < 3 * mesh->n_vertices; v++) {
        if (a.vertex[v / 3][v % 3] != b.vertex[v / 3][v % 3]) {
            fail_msg("%s: the vertices are not symmetric in plane %d", kind, plane);
        }
    }
    if (memcmp(a.triangle, b.triangle, mesh->n_triangles * sizeof *a.triangle) != 0) {
        fail_msg("%s: the triangles are not symmetric in plane %d", kind, plane);
    }
    free(a.vertex);
    free(a.triangle);
    free(b.vertex);
    free(b.triangle);
    ms_mesh_free(&image);
}

static void mirror_symmetry_is_exact(void **state)
{
    typedef struct symmetry {
        const char *kind;
        const char *planes;
    } symmetry;
    static const symmetry list[] = {
        {"ball", "0123"},     {"ellipsoid", "012"},   {"hollow", "0123"},   {"tablet", "0123"},
        {"torus", "0123"},    {"needle", "012"},      {"cylinder", "0123"}, {"cone", "013"},
        {"dumbbell", "012"},  {"cube", "0123"},       {"box", "012"},       {"plate", "0123"},
        {"tetrahedron", "3"}, {"octahedron", "0123"}, {"bowl", "013"},      {"cross", "0123"},
    };
    (void)state;
    for (size_t k = 0; k < sizeof list / sizeof *list; k++) {
        for (int odd = 0; odd < 2; odd++) {
            double value[MS_SHAPE_MAX_PARAMETERS];
            const ms_shape_kind *kind = ms_shape_find(list[k].kind, NULL);
            default_values(value, kind);
            value[fineness_at(kind)] -= odd;
            ms_mesh mesh = make_body(kind->name, value);
            for (const char *plane = list[k].planes; *plane; plane++) {
                expect_mirror_image(kind->name, &mesh, *plane - '0');
            }
            ms_mesh_free(&mesh);
        }
    }
}

static void vertices_lie_on_the_body(void **state)
{
    (void)state;
    ms_mesh mesh = make_body("ellipsoid", (double[]){2.385, 1.1, 0.7, 20});
    for (size_t v = 0; v < mesh.n_vertices; v++) {
        const double *p = mesh.vertex[v];
        expect_close(pow(p[0] / 2.385, 2) + pow(p[1] / 1.1, 2) + pow(p[2] / 0.7, 2), 1, 1e-14);
    }
    ms_mesh_free(&mesh);
    mesh = make_body("torus", (double[]){3, 1.1, 20});
    for (size_t v = 0; v < mesh.n_vertices; v++) {
        const double *p = mesh.vertex[v];
        expect_close(hypot(hypot(p[0], p[1]) - 3, p[2]), 1.1, 1e-14);
    }
    ms_mesh_free(&mesh);
}

static void a_grain_is_what_its_seed_and_noise_say(void **state)
{
    (void)state;
    double value[] = {1, 1.3, 1.2, 0.1, 16, 3, 7, 16};
    ms_mesh a = make_body("grain", value);
    ms_mesh b = make_body("grain", value);
    assert_memory_equal(a.vertex, b.vertex, a.n_vertices * sizeof *a.vertex);
    ms_mesh_free(&b);
    value[6] = 8;
    b = make_body("grain", value);
    assert_true(memcmp(a.vertex, b.vertex, a.n_vertices * sizeof *a.vertex) != 0);
    ms_mesh_free(&a);
    ms_mesh_free(&b);
    /* Without noise an ellipsoid of the wanted volume and proportions. */
    a = make_body("grain", (double[]){1, 1.5, 1.4, 0, 16, 3, 7, 32});
    double lo[3], hi[3];
    ms_mesh_box(lo, hi, &a);
    expect_close(hi[0] / hi[1], 1.5, 1e-12);
    expect_close(hi[1] / hi[2], 1.4, 1e-12);
    ms_mesh_free(&a);
}

static void expect_refused(const char *name, const double *value, const char *message)
{
    ms_mesh mesh;
    ms_error err = {{0}};
    const ms_shape_kind *kind = ms_shape_find(name, NULL);
    assert_non_null(kind);
    assert_int_equal(ms_shape_make(&mesh, kind, value, &err), MS_ERR_ARG);
    expect_message(&err, message);
    assert_null(mesh.vertex);
    assert_int_equal(mesh.n_triangles, 0);
    assert_int_equal(ms_shape_make(&mesh, kind, value, NULL), MS_ERR_ARG);
}

static void contradictions_are_refused(void **state)
{
    (void)state;
    expect_refused("torus", (double[]){1, 1, 16}, "r = 1 must be below the ring's radius R = 1");
    expect_refused("hollow", (double[]){1, 1.5, 16}, "r = 1.5 must be below the ball's radius R = 1");
    expect_refused("tablet", (double[]){1, 1, 1.5, 16}, "cap_height = 1.5 must not be above band_radius = 1");
    expect_refused("needle", (double[]){1, 0.5, 16}, "length = 1 must be above 2 r = 1");
    expect_refused("dumbbell", (double[]){1, 3, 1, 16}, "neck = 1 must be below the balls' radius R = 1");
    expect_refused("dumbbell", (double[]){1, 1, 0.4, 16}, "leaves no neck");
    expect_refused("box", (double[]){1e4, 1, 1e-4, 16}, "too unlike");
}

static void every_range_is_checked(void **state)
{
    (void)state;
    for (const ms_shape_kind *kind = ms_shape_kinds; kind->name; kind++) {
        for (int k = 0; kind->parameters[k].name; k++) {
            const ms_shape_parameter *p = &kind->parameters[k];
            double value[MS_SHAPE_MAX_PARAMETERS];
            default_values(value, kind);
            assert_true(p->min <= p->fallback && p->fallback <= p->max);
            assert_true(strlen(p->help) > 0);
            const double bad[] = {(double)NAN, HUGE_VAL, -HUGE_VAL, p->min - 1, p->max * 1.5};
            for (size_t b = 0; b < sizeof bad / sizeof *bad; b++) {
                value[k] = bad[b];
                expect_refused(kind->name, value, p->name);
            }
            if (p->whole) {
                value[k] = p->fallback + 0.5;
                expect_refused(kind->name, value, "must be a whole number");
            }
        }
    }
}

static void an_unknown_kind_names_the_known(void **state)
{
    ms_error err;
    (void)state;
    assert_null(ms_shape_find("cubus", &err));
    expect_message(&err, "no shape is called 'cubus'; choose from ball, ellipsoid, ");
    expect_message(&err, ", grain");
    assert_null(ms_shape_find("", NULL));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(defaults_are_sound_and_of_the_right_volume),
        cmocka_unit_test(any_fineness_is_sound),
        cmocka_unit_test(other_sizes_are_sound),
        cmocka_unit_test(volumes_are_the_known_ones),
        cmocka_unit_test(mirror_symmetry_is_exact),
        cmocka_unit_test(vertices_lie_on_the_body),
        cmocka_unit_test(a_grain_is_what_its_seed_and_noise_say),
        cmocka_unit_test(contradictions_are_refused),
        cmocka_unit_test(every_range_is_checked),
        cmocka_unit_test(an_unknown_kind_names_the_known),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
