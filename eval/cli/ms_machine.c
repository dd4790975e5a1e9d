#include "ms_machine.h"

#include <stdio.h>
#include <string.h>
#include <sys/utsname.h>
#include <unistd.h>

enum { NAME = 96 };

/* What stands behind the first "model name	:" of /proc/cpuinfo; empty where there is none. */
static void read_processor(char name[NAME])
{
    char line[512];
    FILE *stream = fopen("/proc/cpuinfo", "r");
    name[0] = '\0';
    while (stream && !name[0] && fgets(line, sizeof line, stream)) {
        const char *colon = strchr(line, ':');
        if (strncmp(line, "model name", strlen("model name")) == 0 && colon) {
            snprintf(name, NAME, "%.*s", (int)strcspn(colon + 2, "\n"), colon + 2);
        }
    }
    if (stream) {
        fclose(stream);
    }
}

ms_machine ms_machine_read(void)
{
    char name[NAME];
    ms_machine machine;
    struct utsname system;
    const long cores = sysconf(_SC_NPROCESSORS_ONLN);
    read_processor(name);
    if (!name[0] && uname(&system) == 0) {
        snprintf(name, NAME, "%.60s %.30s", system.sysname, system.machine);
    }
    snprintf(machine.text, sizeof machine.text, "%s, %ld core%s", name[0] ? name : "unknown machine", cores,
             cores == 1 ? "" : "s");
    return machine;
}
