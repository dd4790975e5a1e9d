/** All commands of the program, one file each. */
#ifndef MS_COMMANDS_H
#define MS_COMMANDS_H

#include "cli/ms_flags.h"

/* Shells that mskit completion knows. */
#define MS_COMPLETION_SHELLS "bash|zsh"

extern const ms_command ms_command_compare;
extern const ms_command ms_command_completion;
extern const ms_command ms_command_contact;
extern const ms_command ms_command_convert;
extern const ms_command ms_command_correct;
extern const ms_command ms_command_generate;
extern const ms_command ms_command_generators;
extern const ms_command ms_command_grains;
extern const ms_command ms_command_help;
extern const ms_command ms_command_info;
extern const ms_command ms_command_scene;
extern const ms_command ms_command_score;
extern const ms_command ms_command_shape;
extern const ms_command ms_command_stability;
extern const ms_command ms_command_version;

#endif
