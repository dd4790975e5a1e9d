#include "ms_signals.h"

#include <signal.h>
#include <stddef.h>

#include "base/ms_file.h"

/* The second of two does what it would without this, as SA_RESETHAND has put that back. */
static void end_cleanly(int number)
{
    ms_output_discard_all();
    raise(number);
}

void ms_signals_catch(int number, void (*handler)(int number))
{
    struct sigaction before, action = {.sa_flags = (int)SA_RESETHAND};
    action.sa_handler = handler ? handler : end_cleanly;
    sigemptyset(&action.sa_mask);
    if (sigaction(number, NULL, &before) == 0 && before.sa_handler != SIG_IGN) {
        sigaction(number, &action, NULL);
    }
}

void ms_signals_end_cleanly(void)
{
    const int numbers[] = {SIGHUP, SIGINT, SIGQUIT, SIGABRT, SIGPIPE, SIGTERM, SIGXCPU};
    for (size_t s = 0; s < sizeof numbers / sizeof *numbers; s++) {
        ms_signals_catch(numbers[s], NULL);
    }
}
