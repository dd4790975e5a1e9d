/* A host that uses GLPK itself keeps all that it holds when GLPK fails for the library. */
#include <glpk.h>
#include <setjmp.h>
#include <unistd.h>

#include "clump/ms_density.h"
#include "support/body_samples.h"
#include "support/clump_samples.h"

/* Stands before GLPK's own: an allocation in the midst of the simplex method fails. */
int glp_simplex(glp_prob *problem, const glp_smcp *how)
{
    (void)problem;
    (void)how;
    glp_mem_limit(1); /* megabytes */
    glp_free(glp_alloc(4, 1 << 20));
    return 0;
}

static jmp_buf hooked;

static void host_hook(void *info)
{
    longjmp(*(jmp_buf *)info, 1);
}

/* x + y <= 3, at most x + 2y: 6. */
static glp_prob *make_problem(void)
{
    glp_prob *problem = glp_create_prob();
    const int column[] = {0, 1, 2};
    const double one[] = {0, 1, 1};
    glp_set_obj_dir(problem, GLP_MAX);
    glp_add_rows(problem, 1);
    glp_add_cols(problem, 2);
    glp_set_row_bnds(problem, 1, GLP_UP, 0, 3);
    glp_set_mat_row(problem, 1, 2, column, one);
    for (int c = 1; c <= 2; c++) {
        glp_set_col_bnds(problem, c, GLP_LO, 0, 0);
        glp_set_obj_coef(problem, c, c);
    }
    return problem;
}

static void fail_to_solve(void)
{
    ms_error err = {{0}};
    ms_clump clump = {0};
    ms_particle particle;
    ms_density_report report;
    const ms_density_options options = {0};
    for (int c = 0; c < 8; c++) {
        add_sphere(&clump, c & 1, c >> 1 & 1, c >> 2, 0.5);
    }
    assert_int_equal(ms_clump_alloc_masses(&clump, &err), MS_OK);
    for (int s = 0; s < 8; s++) {
        clump.mass[s] = 1;
    }
    assert_int_equal(ms_particle_from_spheres(&particle, &clump, 1, &err), MS_OK);
    assert_int_equal(ms_density_solve(&clump, &report, &particle, &options, &err), MS_ERR_NOMEM);
    assert_non_null(strstr(err.text, "GLPK"));
    assert_null(clump.mass);
    ms_clump_free(&clump);
}

static int is_said;

static int listen(void *info, const char *text)
{
    (void)info;
    (void)text;
    is_said = 1;
    return 1;
}

/* What GLPK says before an error goes nowhere: neither to the host's own hook nor to standard output. */
static void nothing_is_printed(void **state)
{
    (void)state;
    FILE *file = tmpfile();
    fflush(stdout);
    const int before = dup(STDOUT_FILENO);
    assert_true(file && before >= 0 && dup2(fileno(file), STDOUT_FILENO) >= 0);
    glp_term_hook(listen, NULL);
    fail_to_solve();
    glp_term_hook(NULL, NULL);
    fflush(stdout);
    dup2(before, STDOUT_FILENO);
    close(before);
    assert_int_equal(fseek(file, 0, SEEK_END), 0);
    assert_int_equal(ftell(file), 0);
    assert_false(is_said);
    fclose(file);
    glp_free_env();
}

static void what_the_host_holds_stays(void **state)
{
    (void)state;
    int blocks, blocks_after;
    size_t bytes, bytes_after;
    glp_term_out(GLP_OFF);
    glp_prob *problem = make_problem();
    glp_error_hook(host_hook, &hooked);
    glp_mem_usage(&blocks, NULL, &bytes, NULL);
    for (int time = 0; time < 3; time++) {
        fail_to_solve();
    }
    glp_mem_usage(&blocks_after, NULL, &bytes_after, NULL);
    assert_int_equal(blocks_after, blocks);
    assert_int_equal(bytes_after, bytes);
    assert_int_equal(glp_term_out(GLP_OFF), GLP_OFF);
    assert_int_equal(glp_exact(problem, NULL), 0);
    expect_close(glp_get_obj_val(problem), 6, 1e-12);
    if (setjmp(hooked) == 0) {
        glp_error("the host's hook takes this\n"); /* is printed */
        fail_msg("the host's hook was taken away");
    }
    glp_error_hook(NULL, NULL);
    glp_delete_prob(problem);
    glp_free_env();
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(nothing_is_printed),
                                       cmocka_unit_test(what_the_host_holds_stays)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
