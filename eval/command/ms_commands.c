/* The table of commands: help, completion and main look there. */
#include "ms_commands.h"

#include <string.h>

const ms_command *const ms_commands[] = {
    &ms_command_generate,   &ms_command_score,
    &ms_command_correct,    &ms_command_convert,
    &ms_command_info,       &ms_command_shape,
    &ms_command_compare,    &ms_command_stability,
    &ms_command_scene,      &ms_command_generators,
    &ms_command_help,       &ms_command_version,
    &ms_command_completion, NULL,
};

const ms_command *ms_commands_find(ms_choice *choice)
{
    for (const ms_command *const *c = ms_commands; *c; c++) {
        if (ms_choice_offer(choice, (*c)->name)) {
            return *c;
        }
    }
    return NULL;
}
