/* mskit: which command. */
#include <fcntl.h>
#include <gsl/gsl_errno.h>
#include <omp.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/ms_input.h"
#include "cli/ms_signals.h"
#include "command/ms_commands.h"

static const ms_command *const COMMANDS[] = {
    &ms_command_generate,  &ms_command_score,   &ms_command_contact,    &ms_command_correct,
    &ms_command_convert,   &ms_command_info,    &ms_command_shape,      &ms_command_compare,
    &ms_command_stability, &ms_command_scene,   &ms_command_grains,     &ms_command_generators,
    &ms_command_help,      &ms_command_version, &ms_command_completion, NULL,
};

static void print_usage(FILE *stream)
{
    fputs("mskit: multi-sphere clumps for discrete element simulation\n\nusage: mskit COMMAND [...]\n\n", stream);
    for (const ms_command *const *c = COMMANDS; *c; c++) {
        fprintf(stream, "  %-12s %s\n", (*c)->name, (*c)->summary);
    }
    fputs("\n'mskit COMMAND --help' tells more.\n"
          "example: mskit generate grain.stl --spheres 50 -o grain.csv\n",
          stream);
}

static int run_command(int argc, char **argv)
{
    ms_error err;
    ms_choice choice = {.typed = argv[1]};
    const ms_command *command = ms_flags_find_command(&choice, COMMANDS);
    if (!command) {
        if (argv[1][0] == '-') {
            choice = (ms_choice){.typed = argv[1]};
            ms_choice_offer(&choice, "--help");
            ms_choice_offer(&choice, "--version");
        }
        ms_choice_fail(&choice, &err, "there is no %s '%s'", argv[1][0] == '-' ? "flag" : "command", argv[1]);
        fprintf(stderr, "mskit: %s; flags follow a command (mskit generate --help)\n", err.text);
        return EXIT_USAGE;
    }
    return command->run ? command->run(command, argc - 1, argv + 1)
                        : command->run_of_all(command, COMMANDS, argc - 1, argv + 1);
}

/* A file must not be opened under the number of a stream that the caller has closed: what is
 * printed would go into it. */
static void occupy_streams(void)
{
    int fd;
    do {
        fd = open("/dev/null", O_RDONLY);
    } while (fd >= 0 && fd <= STDERR_FILENO);
    if (fd >= 0) {
        close(fd);
    }
}

/* How often a thread of gcc's OpenMP looks for work before it sleeps: some ten microseconds. */
static const char LOOKS[] = "500";

/*
 * Threads that spin while they wait lose where others want the cores, too: two runs side by side took 30 times as long.
 * Those that sleep at once are late for the thousands of short loops of a choice. OpenMP reads its policy when it is
 * loaded, before any code of ours, so the program starts itself once more with the policy set. Where that fails it goes
 * on as it is.
 */
static void wait_passively(char **argv)
{
    char program[4096];
    if (getenv("OMP_WAIT_POLICY") || getenv("GOMP_SPINCOUNT")) {
        return;
    }
    const ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1); /* by its name, for ps and kill */
    if (length > 0 && setenv("OMP_WAIT_POLICY", "passive", 1) == 0 && setenv("GOMP_SPINCOUNT", LOOKS, 1) == 0) {
        program[length] = '\0';
        execv(program, argv);
    }
}

/* The bound of --threads holds for the environment, too: more have no stack to run on. */
static int check_threads(void)
{
    if (omp_get_max_threads() <= MS_INPUT_MAX_THREADS) {
        return 1;
    }
    if (getenv("OMP_NUM_THREADS")) {
        fprintf(stderr, "mskit: OMP_NUM_THREADS asks for %d threads; set it to a number from 1 to %d\n",
                omp_get_max_threads(), MS_INPUT_MAX_THREADS);
        return 0;
    }
    omp_set_num_threads(MS_INPUT_MAX_THREADS); /* a machine of more cores */
    return 1;
}

int main(int argc, char **argv)
{
    int code = EXIT_DONE;
    wait_passively(argv);
    gsl_set_error_handler_off(); /* its default is to abort */
    occupy_streams();
    ms_signals_end_cleanly();
    signal(SIGXFSZ, SIG_IGN); /* a file that may not grow is a failed write, which is reported */
    if (argc < 2) {
        print_usage(stderr);
        return EXIT_USAGE;
    }
    if (strcmp(argv[1], "--version") == 0 || strcmp(argv[1], "-V") == 0) {
        static char version[] = "version";
        argv[1] = version;
    }
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0 || (argc == 2 && strcmp(argv[1], "help") == 0)) {
        print_usage(stdout);
    } else {
        code = check_threads() ? run_command(argc, argv) : EXIT_USAGE;
    }
    if ((fflush(stdout) != 0 || ferror(stdout)) && code == EXIT_DONE) {
        fputs("mskit: standard output cannot be written\n", stderr);
        return EXIT_FAILED;
    }
    return code;
}
