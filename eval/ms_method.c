#include "ms_method.h"

#include <stdlib.h>
#include <string.h>

/* Cuts `text` in two at the first `mark`. @return what stands behind it; NULL if there is none */
static char *cut(char *text, char mark)
{
    char *at = text ? strchr(text, mark) : NULL;
    if (at) {
        *at++ = 0;
    }
    return at;
}

static ms_status parse_words(ms_method *method, char *words, ms_error *err)
{
    char *option = cut(words, ':');
    method->generator = ms_generator_find(words, err);
    ms_status status = method->generator ? ms_settings_init(&method->settings, method->generator->options, err)
                                         : MS_ERR_ARG;
    while (option && status == MS_OK) {
        char *next = cut(option, ',');
        const char *value = cut(option, '=');
        status = ms_settings_set(&method->settings, option, value, err);
        option = next;
    }
    return status;
}

ms_status ms_method_parse(ms_method *method, const char *text, ms_error *err)
{
    char *words = strdup(text);
    *method = (ms_method){.text = strdup(text)};
    ms_status status = words && method->text ? parse_words(method, words, err)
                                             : ms_fail(err, MS_ERR_NOMEM, "no memory for the method %s", text);
    free(words);
    if (status != MS_OK) {
        ms_method_free(method);
    }
    return status;
}

void ms_method_free(ms_method *method)
{
    free(method->text);
    ms_settings_free(&method->settings);
    *method = (ms_method){0};
}
