/* The table of perturbations: each row is complete, told in the docs, and does change something. */
#include "support/test_support.h"

#include <stdlib.h>
#include <string.h>

#include "stability/ms_change.h"

enum { SEED = 7 };

static ms_changed begin_change(const ms_mesh *mesh)
{
    ms_changed c = {.motion = ms_perturb_motion_none(), .seed = SEED, .voxel_size = 0.25, .threads = 100};
    assert_int_equal(ms_perturb_copy(&c.mesh, mesh, NULL), MS_OK);
    return c;
}

static int differs(const ms_changed *a, const ms_changed *b)
{
    return a->seed != b->seed || a->voxel_size != b->voxel_size || a->threads != b->threads ||
           memcmp(&a->motion, &b->motion, sizeof a->motion) != 0 ||
           memcmp(a->lattice, b->lattice, sizeof a->lattice) != 0 || a->mesh.n_vertices != b->mesh.n_vertices ||
           a->mesh.n_triangles != b->mesh.n_triangles ||
           memcmp(a->mesh.vertex, b->mesh.vertex, a->mesh.n_vertices * sizeof *a->mesh.vertex) != 0 ||
           memcmp(a->mesh.triangle, b->mesh.triangle, a->mesh.n_triangles * sizeof *a->mesh.triangle) != 0;
}

/* At every level but the first row changes something: a run with nothing changed would look stable. */
static void every_level_changes_something(void **state)
{
    (void)state;
    ms_mesh grain;
    make_shape(&grain, "grain", "");
    for (const ms_change *change = ms_changes; change->name; change++) {
        const int asked = 6, runs = ms_change_runs(change, asked);
        assert_true(runs >= 1 && runs <= asked);
        for (int number = 1; number <= runs; number++) {
            ms_error err;
            ms_changed before = begin_change(&grain), after = begin_change(&grain);
            const ms_change_order order = {.level = ms_change_level(change, SEED, number, asked),
                                           .number = number,
                                           .seed = SEED,
                                           .diameter = 2,
                                           .closed = 0};
            assert_int_equal(change->apply(&after, &order, &err), MS_OK);
            assert_int_equal(differs(&before, &after), change != ms_changes);
            ms_mesh_free(&before.mesh);
            ms_mesh_free(&after.mesh);
        }
    }
    ms_mesh_free(&grain);
}

static void levels_are_as_the_table_says(void **state)
{
    (void)state;
    ms_error err = {{0}};
    const ms_change *axes = ms_change_find("axes", &err), *noise = ms_change_find("noise", &err);
    const ms_change *refine = ms_change_find("refine", &err), *order = ms_change_find("order", &err);
    assert_int_equal(ms_change_runs(axes, 1000), 23);
    assert_int_equal(ms_change_runs(refine, 5), 2);
    assert_int_equal(ms_change_runs(ms_changes, 5), 1);
    for (int number = 1; number <= 23; number++) {
        assert_true(ms_change_level(axes, SEED, number, 1000) == number);
    }
    assert_true(ms_change_level(axes, SEED, 2, 3) == 8);
    assert_close(ms_change_level(noise, SEED, 1, 5), 0.001, 1e-15);
    assert_close(ms_change_level(noise, SEED, 5, 5), 0.03, 1e-15);
    assert_close(ms_change_level(noise, SEED, 3, 5), sqrt(0.001 * 0.03), 1e-15);
    assert_close(ms_change_level(noise, SEED, 1, 1), sqrt(0.001 * 0.03), 1e-15);
    assert_true(ms_change_level(order, SEED, 3, 5) == SEED + 3);
    assert_null(ms_change_find("none", &err)); /* always there, not to be asked for */
    assert_non_null(strstr(err.text, "axes, rotation, shift, lattice"));
}

static void the_docs_name_each(void **state)
{
    (void)state;
    static char text[131072];
    char path[512];
    snprintf(path, sizeof path, "%s/formats.md", getenv("MSKIT_DOCS"));
    FILE *docs = fopen(path, "r");
    assert_non_null(docs);
    text[fread(text, 1, sizeof text - 1, docs)] = 0;
    fclose(docs);
    const char *table = strstr(text, "| perturbation | what is done");
    assert_non_null(table);
    for (const ms_change *change = ms_changes; change->name; change++) {
        char row[64];
        snprintf(row, sizeof row, "\n| `%s` | ", change->name);
        const char *at = strstr(table, row);
        if (!at || !strstr(at, change->level) || strchr(at + 1, '\n') < strstr(at, change->level)) {
            fail_msg("docs/formats.md lacks the row '| `%s` | ... | %s |'", change->name, change->level);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_level_changes_something),
        cmocka_unit_test(levels_are_as_the_table_says),
        cmocka_unit_test(the_docs_name_each),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
