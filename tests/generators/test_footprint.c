/*
 * The memory that is announced before a run (ms_target_bytes, by the generator's bytes_per_voxel) is not exceeded, with
 * whatever option, and of a large grid by default it is not four times what the run takes. Each run is a process of its
 * own, this program with arguments, which asks the kernel for its peak (VmHWM: that of wait4 has the memory of this
 * process, too, which was forked). That of the same run on a coarse grid is taken off: the program, the mesh, and what
 * a method makes for each corner or sphere.
 */
#include "support/test_support.h"

#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include "support/run_samples.h"

enum { REFUSED = 3 }; /* exit code of a child that takes no such option alone */

static const char *program;

typedef struct body {
    const char *kind, *values;
    double cells; /* along its shortest side */
} body;

static const body FAT = {"ball", "fineness=12", 70}, THIN = {"plate", "a=5 b=5 c=0.2", 12},
                  LARGE = {"grain", "fineness=16", 80}, SMALL = {"grain", "fineness=16", 60};

/* kB of this process at its peak; 0 if the kernel does not tell. */
static long own_peak(void)
{
    char line[256];
    long peak = 0;
    FILE *stream = fopen("/proc/self/status", "r");
    while (stream && fgets(line, sizeof line, stream)) {
        sscanf(line, "VmHWM: %ld", &peak);
    }
    if (stream) {
        fclose(stream);
    }
    return peak;
}

/* The whole program of a child, which prints its peak. @param argument method, options, kind of shape, values, cells */
static int run_alone(char *const *argument)
{
    ms_mesh mesh;
    ms_target target;
    ms_clump clump;
    ms_stop_reason reason;
    ms_error err;
    make_shape(&mesh, argument[2], argument[3]);
    make_target(&target, &mesh, strtod(argument[4], NULL), MS_VOXEL_HALF);
    ms_stop stop = {0};
    stop.spheres = 10;
    const ms_status status = try_generator(&clump, &reason, ms_generator_find(argument[0], &err), &target, stop,
                                           argument[1], NULL, NULL, &err);
    ms_clump_free(&clump);
    ms_target_free(&target);
    ms_mesh_free(&mesh);
    printf("%ld\n", own_peak());
    /* a grid may be too coarse for a method */
    return status == MS_OK || status == MS_ERR_SHAPE ? 0 : status == MS_ERR_ARG ? REFUSED : 1;
}

/* Bytes at the peak of a child; 0 if it was refused. */
static double find_peak(const ms_generator *g, const char *options, const body *shape, double cells)
{
    char number[32], said[64] = "";
    int status = 0, way[2];
    snprintf(number, sizeof number, "%g", cells);
    assert_int_equal(pipe(way), 0);
    const pid_t child = fork();
    if (child == 0) {
        dup2(way[1], STDOUT_FILENO);
        execl(program, program, g->name, options, shape->kind, shape->values, number, (char *)NULL);
        _exit(127);
    }
    close(way[1]);
    FILE *stream = fdopen(way[0], "r");
    assert_true(child > 0 && stream && fgets(said, sizeof said, stream));
    fclose(stream);
    assert_int_equal(waitpid(child, &status, 0), child);
    if (!WIFEXITED(status) || (WEXITSTATUS(status) != 0 && WEXITSTATUS(status) != REFUSED)) {
        fail_msg("%s %s, %s of %g cells: failed", g->name, options, shape->kind, cells);
    }
    return WEXITSTATUS(status) == REFUSED ? 0 : 1024 * strtod(said, NULL);
}

/* What is announced for a run. */
static double find_announced(const ms_generator *g, const char *option, const char *value, const body *shape,
                             double cells)
{
    ms_mesh mesh;
    ms_settings settings;
    ms_error err;
    double lo[3], hi[3], n[3];
    make_shape(&mesh, shape->kind, shape->values);
    ms_mesh_box(lo, hi, &mesh);
    const double h = fmin(hi[0] - lo[0], fmin(hi[1] - lo[1], hi[2] - lo[2])) / cells;
    ms_voxelize_extents(n, &mesh, h);
    assert_int_equal(ms_option_settings_init(&settings, g->options, &err), MS_OK);
    if (option) {
        assert_int_equal(ms_option_settings_set(&settings, option, value, &err), MS_OK);
    }
    const double bytes = ms_target_bytes(n, ms_mesh_area(&mesh) / (h * h), ms_generator_need(g, &settings, 0));
    ms_option_settings_free(&settings);
    ms_mesh_free(&mesh);
    return bytes;
}

/*
 * The kernel counts pages in batches, one for each processor, so that a peak is off by some hundred kB either way
 * (proc(5): "this value is inaccurate"). What is above the announced is measured again: a true excess stays.
 */
enum { ATTEMPTS = 3 };

/* What a run takes more than one on a third of the cells, over what is announced for that; 0 if it was refused. */
static double find_share(const ms_generator *g, const char *option, const char *value, const body *shape)
{
    char options[128];
    snprintf(options, sizeof options, "%s%s%s", option ? option : "", value ? "=" : "", value ? value : "");
    const double few = shape->cells / 3;
    const double announced =
        find_announced(g, option, value, shape, shape->cells) - find_announced(g, option, value, shape, few);
    double peak = HUGE_VAL;
    for (int k = 0; k < ATTEMPTS && peak > announced; k++) {
        peak = fmin(peak, find_peak(g, options, shape, shape->cells) - find_peak(g, options, shape, few));
    }
    if (peak > announced) {
        fail_msg("%s %s, %s of %g cells: %.3g MB are announced, and it takes %.3g MB", g->name, options, shape->kind,
                 shape->cells, announced / 1e6, peak / 1e6);
    }
    return peak / announced;
}

static void announced_memory_is_enough(void **state)
{
    (void)state;
    for (const ms_generator *const *g = ms_generators; *g; g++) {
        find_share(*g, NULL, NULL, &FAT);
        find_share(*g, NULL, NULL, &THIN);
        assert_true(find_share(*g, NULL, NULL, &LARGE) > 0.25);
    }
}

/* With each flag set, and each value of each choice but the one that stands by default. */
static void options_are_announced_too(void **state)
{
    (void)state;
    for (const ms_generator *const *g = ms_generators; *g; g++) {
        for (const ms_option *o = (*g)->options; o->name; o++) {
            char values[256];
            int rank = 0;
            snprintf(values, sizeof values, "%s", o->type == MS_OPTION_CHOICE ? o->choices : "");
            for (char *value = strtok(values, "|"); value; value = strtok(NULL, "|")) {
                if (rank++ != (int)o->fallback) {
                    find_share(*g, o->name, value, &SMALL);
                }
            }
            if (o->type == MS_OPTION_FLAG) {
                find_share(*g, o->name, NULL, &SMALL);
            }
        }
    }
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(announced_memory_is_enough),
                                       cmocka_unit_test(options_are_announced_too)};
    program = argv[0];
    unsetenv("MALLOC_PERTURB_"); /* meson's: it writes to all that is allocated, needed or not */
    return argc > 5 ? run_alone(argv + 1) : cmocka_run_group_tests(tests, NULL, NULL);
}
