/* Which file was meant. */
#include <dirent.h>
#include <stdlib.h>
#include <string.h>

#include "ms_choice.h"

/* Names that a terminal would not show as they are, and the folder itself and that above, are no suggestions. */
static int is_shown(const struct dirent *entry)
{
    for (const char *c = entry->d_name; *c; c++) {
        if ((unsigned char)*c < ' ' || *c == 127) {
            return 0;
        }
    }
    return entry->d_name[0] != '.';
}

ms_hint ms_choice_file_hint(const char *path)
{
    const char *slash = strrchr(path, '/');
    ms_choice choice = {.typed = slash ? slash + 1 : path};
    struct dirent **entry = NULL;
    char *folder = slash ? strndup(path, slash > path ? (size_t)(slash - path) : 1) : strdup(".");
    const int count = folder ? scandir(folder, &entry, is_shown, alphasort) : 0;
    for (int e = 0; e < count; e++) {
        ms_choice_offer(&choice, entry[e]->d_name);
        free(entry[e]);
    }
    free(entry);
    free(folder);
    return ms_choice_hint(&choice);
}
