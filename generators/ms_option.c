#include "ms_option.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_choice.h"
#include "base/ms_text.h"
#include "clump/formats/ms_read.h"

static size_t count_options(const ms_option *options)
{
    size_t count = 0;
    while (options[count].name) {
        count++;
    }
    return count;
}

ms_status ms_option_settings_init(ms_settings *settings, const ms_option *options, ms_error *err)
{
    const size_t count = count_options(options);
    memset(settings, 0, sizeof *settings);
    settings->options = options;
    settings->value = malloc((count + 1) * sizeof *settings->value);
    if (!settings->value) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu options", count);
    }
    for (size_t o = 0; o < count; o++) {
        settings->value[o] = options[o].fallback;
    }
    return MS_OK;
}

void ms_option_settings_free(ms_settings *settings)
{
    if (settings) {
        free(settings->value);
        free(settings->plane);
        ms_clump_free(&settings->clump);
        free(settings->clump_file);
        memset(settings, 0, sizeof *settings);
    }
}

const ms_option *ms_option_find(const ms_option *options, const char *name)
{
    for (const ms_option *o = options; o->name; o++) {
        if (strcmp(o->name, name) == 0) {
            return o;
        }
    }
    return NULL;
}

static ms_status fail_unknown(ms_error *err, const ms_option *options, const char *name)
{
    ms_choice choice = {.typed = name};
    for (const ms_option *o = options; o->name; o++) {
        ms_choice_offer(&choice, o->name);
    }
    return ms_choice_fail(&choice, err, "this generator has no option '%s'", name);
}

static int parse_number(double *value, const char *text)
{
    const ms_word word = {.start = text, .length = strlen(text)};
    return word.length > 0 && ms_text_to_double(value, &word) && isfinite(*value);
}

static ms_status set_number(double *value, const ms_option *option, const char *text, ms_error *err)
{
    double number;
    const char *kind = option->type == MS_OPTION_INTEGER ? "a whole number" : "a number";
    if (!parse_number(&number, text) || number < option->min || number > option->max ||
        (option->type == MS_OPTION_INTEGER && number != floor(number))) {
        return ms_fail(err, MS_ERR_ARG, "%s=%s is not %s from %g to %g", option->name, text, kind, option->min,
                       option->max);
    }
    *value = number;
    return MS_OK;
}

static ms_status set_flag(double *value, const ms_option *option, const char *text, ms_error *err)
{
    static const char *const WORDS[] = {"on", "off", "1", "0", "yes", "no", "true", "false"};
    ms_choice choice = {.typed = text};
    for (size_t w = 0; w < sizeof WORDS / sizeof *WORDS; w++) {
        if (ms_choice_offer(&choice, WORDS[w])) {
            *value = w % 2 == 0;
            return MS_OK;
        }
    }
    if (text[0]) {
        return ms_choice_fail(&choice, err, "%s=%s is not 'on' or 'off'", option->name, text);
    }
    *value = 1; /* the name alone */
    return MS_OK;
}

/* The word of that rank in "first|second|..."; length 0 behind the last. */
static ms_word find_choice(const char *choices, int rank)
{
    const char *start = choices;
    for (; rank > 0; rank--) {
        const char *bar = strchr(start, '|');
        if (!bar) {
            return (ms_word){.start = start, .length = 0};
        }
        start = bar + 1;
    }
    return (ms_word){.start = start, .length = strcspn(start, "|")};
}

static ms_status set_choice(double *value, const ms_option *option, const char *text, ms_error *err)
{
    ms_choice choice = {.typed = text};
    for (int rank = 0;; rank++) {
        const ms_word word = find_choice(option->choices, rank);
        if (word.length == 0) {
            return ms_choice_fail(&choice, err, "there is no %s '%s'", option->name, text);
        }
        if (ms_choice_offer_part(&choice, word.start, word.length)) {
            *value = rank;
            return MS_OK;
        }
    }
}

static ms_status add_plane(ms_settings *settings, const ms_option *option, const char *text, ms_error *err)
{
    double plane[4], length;
    const char *at = text;
    for (int m = 0; m < 4; m++) {
        const ms_word word = {.start = at, .length = strcspn(at, ",")};
        if (word.length == 0 || !ms_text_to_double(&plane[m], &word) || !isfinite(plane[m]) ||
            (m < 3) != (at[word.length] == ',')) {
            return ms_fail(err, MS_ERR_ARG, "%s=%s is not four numbers a,b,c,d (the plane a x + b y + c z = d)",
                           option->name, text);
        }
        at += word.length + 1;
    }
    length = sqrt(plane[0] * plane[0] + plane[1] * plane[1] + plane[2] * plane[2]);
    if (!(length > 0) || !isfinite(length)) {
        return ms_fail(err, MS_ERR_ARG, "%s=%s has no direction; give a normal (a, b, c) that is not zero",
                       option->name, text);
    }
    double(*grown)[4] = realloc(settings->plane, (settings->n_planes + 1) * sizeof *grown);
    if (!grown) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu planes", settings->n_planes + 1);
    }
    settings->plane = grown;
    for (int m = 0; m < 4; m++) {
        grown[settings->n_planes][m] = plane[m] / length;
    }
    settings->n_planes++;
    return MS_OK;
}

static ms_status read_clump(ms_settings *settings, const char *path, ms_error *err)
{
    ms_clump clump;
    ms_particle unused;
    const ms_status status = ms_read_clump(&clump, &unused, path, err);
    if (status != MS_OK) {
        return status;
    }
    ms_clump_free(&settings->clump);
    free(settings->clump_file);
    settings->clump = clump;
    settings->clump_file = strdup(path);
    return settings->clump_file ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "%s: no memory for its name", path);
}

ms_status ms_option_settings_set(ms_settings *settings, const char *name, const char *text, ms_error *err)
{
    const ms_option *option = ms_option_find(settings->options, name);
    if (!option) {
        return fail_unknown(err, settings->options, name);
    }
    double *value = &settings->value[option - settings->options];
    text = text ? text : "";
    switch (option->type) {
    case MS_OPTION_FLAG:
        return set_flag(value, option, text, err);
    case MS_OPTION_INTEGER:
    case MS_OPTION_REAL:
        return set_number(value, option, text, err);
    case MS_OPTION_CHOICE:
        return set_choice(value, option, text, err);
    case MS_OPTION_PLANE:
        return add_plane(settings, option, text, err);
    case MS_OPTION_CLUMP:
        return read_clump(settings, text, err);
    }
    return ms_fail(err, MS_ERR_ARG, "option %s has an unknown type", name);
}

void ms_option_settings_text(char *out, size_t size, const ms_settings *settings, size_t option)
{
    const ms_option *o = &settings->options[option];
    const double value = settings->value[option];
    if (o->type == MS_OPTION_PLANE) {
        snprintf(out, size, "%zu planes", settings->n_planes);
    } else if (o->type == MS_OPTION_CLUMP) {
        snprintf(out, size, "%zu spheres", settings->clump.n_spheres);
    } else if (o->type == MS_OPTION_FLAG) {
        snprintf(out, size, "%s", value != 0 ? "on" : "off");
    } else if (o->type == MS_OPTION_CHOICE) {
        const ms_word word = find_choice(o->choices, (int)value);
        snprintf(out, size, "%.*s", (int)word.length, word.start);
    } else {
        snprintf(out, size, "%.15g", value); /* as it was written: 0.9, not 0.90000000000000002 */
        if (strtod(out, NULL) != value) {
            snprintf(out, size, "%.17g", value);
        }
    }
}
