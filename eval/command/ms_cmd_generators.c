/* mskit generators */
#include <stdio.h>
#include <string.h>

#include "cli/ms_json_object.h"
#include "cli/ms_report.h"
#include "ms_commands.h"
#include "ms_generator.h"

static const ms_flag JSON_FLAGS[] = {{"json", 0, NULL, "as JSON"}, {0}};

static ms_status take_json(void *context, const char *name, const char *value, ms_error *err)
{
    (void)name;
    (void)value;
    (void)err;
    *(int *)context = 1;
    return MS_OK;
}

static int run_generators(const ms_command *command, int argc, char **argv)
{
    int first, json = 0;
    ms_error err;
    const int code = ms_flags_parse(&first, command, 0, argc, argv, take_json, &json);
    if (code != MS_FLAGS_GO_ON) {
        return code;
    }
    if (first < argc) {
        return ms_flags_wrong_words(command, "takes no words", 0, argc - first, argv + first);
    }
    json_t *list = json ? json_array() : NULL;
    for (const ms_generator *const *g = ms_generators; *g; g++) {
        if (json) {
            ms_json_object_append(&list, json_pack("{s:s,s:s,s:s,s:b,s:b}", "name", (*g)->name, "summary",
                                                   (*g)->summary, "source", (*g)->source, "nested", (*g)->nested,
                                                   "baseline", (*g)->baseline));
        } else {
            printf("%-12s %s%s\n%-12s %s\n", (*g)->name, (*g)->summary,
                   strcmp((*g)->name, MS_GENERATOR_DEFAULT) == 0 ? " (the default)" : "", "", (*g)->source);
        }
    }
    if (json && ms_report_print(stdout, list, &err) != MS_OK) {
        return ms_flags_fail(command, &err);
    }
    return EXIT_DONE;
}

const ms_command ms_command_generators = {
    .name = "generators",
    .summary = "list the methods",
    .usage = "[--json]",
    .example = "mskit generators",
    .flags = JSON_FLAGS,
    .run = run_generators,
};
