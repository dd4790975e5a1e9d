/* mskit: which command. */
#include <gsl/gsl_errno.h>
#include <stdio.h>
#include <string.h>

#include "ms_commands.h"
#include "ms_version.h"

static const ms_command *const COMMANDS[] = {
    &ms_command_generate, &ms_command_score, &ms_command_info, &ms_command_shape, &ms_command_generators,
    &ms_command_help,     NULL,
};

static void print_usage(FILE *stream)
{
    fputs("mskit: multi-sphere clumps for discrete element simulation\n\nusage: mskit COMMAND [...]\n\n", stream);
    for (const ms_command *const *c = COMMANDS; *c; c++) {
        fprintf(stream, "  %-12s %s\n", (*c)->name, (*c)->summary);
    }
    fputs("\n'mskit COMMAND --help' tells more, 'mskit --version' the version.\n"
          "example: mskit generate grain.stl --generator mss --spheres 50 -o grain.csv\n",
          stream);
}

int main(int argc, char **argv)
{
    gsl_set_error_handler_off(); /* its default is to abort */
    if (argc < 2) {
        print_usage(stderr);
        return EXIT_USAGE;
    }
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0) {
        print_usage(stdout);
        return EXIT_DONE;
    }
    if (strcmp(argv[1], "--version") == 0) {
        puts("mskit " MS_VERSION);
        return EXIT_DONE;
    }
    for (const ms_command *const *c = COMMANDS; *c; c++) {
        if (strcmp(argv[1], (*c)->name) == 0) {
            const int code = (*c)->run(*c, argc - 1, argv + 1);
            if (fflush(stdout) != 0 && code == EXIT_DONE) {
                fputs("mskit: standard output cannot be written\n", stderr);
                return EXIT_FAILED;
            }
            return code;
        }
    }
    fprintf(stderr, "mskit: there is no command '%s'; try mskit --help\n", argv[1]);
    return EXIT_USAGE;
}
