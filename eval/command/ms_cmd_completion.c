/* mskit completion bash|zsh */
#include <stdio.h>
#include <string.h>

#include "ms_commands.h"
#include "ms_complete.h"

static const ms_flag NO_FLAGS[] = {{0}};

/* Both ask the program for the words, so that they know what it knows. */
static const char BASH[] =
    "# mskit's completion for bash, made by: mskit completion bash\n"
    "_mskit() {\n"
    "    local line=${COMP_LINE:0:COMP_POINT} words current found\n"
    "    read -ra words <<<\"$line\"\n"
    "    [[ $line == *[[:space:]] ]] && words+=(\"\")\n"
    "    current=${words[${#words[@]} - 1]}\n"
    "    COMPREPLY=()\n"
    "    while IFS= read -r found; do\n"
    "        case $found in\n"
    "        /) compopt -o default ;; # files, where no word fits\n"
    "        *)\n"
    "            [[ $found == *= ]] && compopt -o nospace\n"
    "            COMPREPLY+=(\"${found#\"${current%\"${current##*[=:]}\"}\"}\") # bash puts it behind a '=' or ':'\n"
    "            ;;\n"
    "        esac\n"
    "    done < <(\"${words[0]/#\\~/$HOME}\" completion words -- \"${words[@]:1}\" 2>/dev/null)\n"
    "}\n"
    "complete -F _mskit mskit\n";

static const char ZSH[] = "#compdef mskit\n"
                          "# mskit's completion for zsh, made by: mskit completion zsh\n"
                          "_mskit() {\n"
                          "    local found files=0\n"
                          "    for found in ${(f)\"$(${~words[1]} completion words -- \"${(@Q)words[2,CURRENT-1]}\" "
                          "\"$PREFIX\" 2>/dev/null)\"}; do\n"
                          "        case $found in\n"
                          "        /) files=1 ;;\n"
                          "        *=) compadd -S '' -- \"$found\" ;;\n"
                          "        *) compadd -- \"$found\" ;;\n"
                          "        esac\n"
                          "    done\n"
                          "    if (( files )); then\n"
                          "        [[ $PREFIX == --*=* ]] && compset -P '*='\n"
                          "        _files\n"
                          "    fi\n"
                          "}\n"
                          "if [[ $funcstack[1] == _mskit ]]; then\n"
                          "    _mskit \"$@\"\n"
                          "else\n"
                          "    compdef _mskit mskit\n"
                          "fi\n";

static int run_completion(const ms_command *command, const ms_command *const *all, int argc, char **argv)
{
    int first;
    ms_error err;
    /* How the scripts call: with what is typed so far, which may end with an empty word. */
    if (argc > 3 && strcmp(argv[1], "words") == 0 && strcmp(argv[2], "--") == 0) {
        ms_complete_print(stdout, all, argv + 3, (size_t)argc - 3);
        return EXIT_DONE;
    }
    const int code = ms_flags_parse(&first, command, 0, argc, argv, NULL, NULL);
    if (code != MS_FLAGS_GO_ON) {
        return code;
    }
    if (argc - first != 1) {
        return ms_flags_wrong_words(command, "takes the name of a shell", 1, argc - first, argv + first);
    }
    ms_choice choice = {.typed = argv[first]};
    if (ms_choice_offer(&choice, "bash")) {
        fputs(BASH, stdout);
    } else if (ms_choice_offer(&choice, "zsh")) {
        fputs(ZSH, stdout);
    } else {
        ms_choice_fail(&choice, &err, "there is no completion for the shell '%s'", argv[first]);
        return ms_flags_wrong_usage(command, err.text);
    }
    return EXIT_DONE;
}

const ms_command ms_command_completion = {
    .name = "completion",
    .summary = "print what completes commands, flags and their words in a shell",
    .usage = MS_COMPLETION_SHELLS,
    .example = "mskit completion bash",
    .flags = NO_FLAGS,
    .run_of_all = run_completion,
};
