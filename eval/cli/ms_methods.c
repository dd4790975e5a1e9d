#include "ms_methods.h"

#include <stdlib.h>
#include <string.h>

#include "voxel/ms_target.h"

/* Room for one more, with its two texts. */
static ms_status begin_method(ms_method **out, ms_methods *methods, const char *name, size_t length,
                              const char *options, ms_error *err)
{
    if (methods->count == MS_METHODS_MAX) {
        return ms_fail(err, MS_ERR_LIMIT, "more than %d methods", MS_METHODS_MAX);
    }
    ms_method *m = *out = &methods->method[methods->count++];
    memset(m, 0, sizeof *m);
    m->name = strndup(name, length);
    m->options = strdup(options);
    return m->name && m->options ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for the name of a method");
}

/* Does an option of the generator, with or without a value, begin here? */
static int begins_option(const ms_generator *generator, const char *text)
{
    const size_t length = strcspn(text, "=,");
    for (const ms_option *o = generator->options; o->name; o++) {
        if (strlen(o->name) == length && memcmp(o->name, text, length) == 0) {
            return 1;
        }
    }
    return 0;
}

/* Sets one option from "name=value" or "name"; the text is cut in two. */
static ms_status set_option(ms_settings *settings, char *text, ms_error *err)
{
    char *equals = strchr(text, '=');
    if (equals) {
        *equals++ = '\0';
    }
    return ms_option_settings_set(settings, text, equals, err);
}

/* The comma in front of the next option; NULL if there is none. */
static char *find_next(const ms_generator *generator, char *text)
{
    char *comma = strchr(text, ',');
    while (comma && !begins_option(generator, comma + 1)) {
        comma = strchr(comma + 1, ',');
    }
    return comma;
}

static ms_status set_options(ms_method *m, ms_error *err)
{
    char *copy = strdup(m->options);
    ms_status status = copy ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for options");
    for (char *at = copy; status == MS_OK && at && *at;) {
        char *comma = find_next(m->generator, at);
        if (comma) {
            *comma = '\0';
        }
        status = set_option(&m->settings, at, err);
        at = comma ? comma + 1 : NULL;
    }
    free(copy);
    return status;
}

ms_status ms_methods_add(ms_methods *methods, const char *text, ms_error *err)
{
    ms_method *m = NULL;
    const size_t length = strcspn(text, ":");
    ms_status status = begin_method(&m, methods, text, length, text[length] ? text + length + 1 : "", err);
    if (status == MS_OK) {
        m->generator = ms_generator_find(m->name, err);
        status = m->generator ? ms_option_settings_init(&m->settings, m->generator->options, err) : MS_ERR_ARG;
    }
    return status == MS_OK ? set_options(m, err) : status;
}

ms_status ms_methods_add_clump(ms_methods *methods, const char *text, ms_error *err)
{
    ms_method *m = NULL;
    const size_t length = strcspn(text, "=");
    if (length == 0 || !text[length] || !text[length + 1]) {
        return ms_fail(err, MS_ERR_ARG, "--clump '%.200s' is not of the form NAME=FILE", text);
    }
    return begin_method(&m, methods, text, length, text + length + 1, err);
}

/* All but the baselines, by default options. */
static ms_status add_all_generators(ms_methods *methods, ms_error *err)
{
    ms_status status = MS_OK;
    for (const ms_generator *const *g = ms_generators; *g && status == MS_OK; g++) {
        status = (*g)->baseline ? MS_OK : ms_methods_add(methods, (*g)->name, err);
    }
    return status;
}

ms_status ms_methods_list_files(ms_files *files, const ms_methods *methods, ms_error *err)
{
    ms_status status = MS_OK;
    for (size_t m = 0; m < methods->count && status == MS_OK; m++) {
        const ms_method *method = &methods->method[m];
        const char *start = method->generator ? method->settings.clump_file : NULL;
        status = start ? ms_files_add(files, start, MS_FILE_READ, err) : MS_OK;
        for (size_t k = 0; k < method->n_clumps && status == MS_OK; k++) {
            status = ms_files_add(files, method->clump[k].file, MS_FILE_READ, err);
        }
    }
    return status;
}

/* What runs of the other methods may have left with the target, a voxel. */
static double find_kept_bytes(const ms_methods *methods, const ms_generator *of)
{
    double most = 0;
    for (size_t m = 0; m < methods->count; m++) {
        const ms_generator *other = methods->method[m].generator;
        most = other && other != of && other->kept_bytes > most ? other->kept_bytes : most;
    }
    return most;
}

ms_target_need ms_methods_need(const ms_methods *methods, int cut)
{
    ms_target_need most = {0};
    for (size_t m = 0; m < methods->count; m++) {
        const ms_method *method = &methods->method[m];
        if (method->generator) {
            const ms_target_need own = ms_generator_need(method->generator, &method->settings, cut);
            const double voxel = own.voxel + find_kept_bytes(methods, method->generator);
            most.voxel = voxel > most.voxel ? voxel : most.voxel;
            most.square = own.square > most.square ? own.square : most.square;
        }
    }
    return most;
}

size_t ms_methods_clumps(const ms_methods *methods)
{
    size_t found = 0;
    for (size_t m = 0; m < methods->count; m++) {
        found += methods->method[m].generator == NULL;
    }
    return found;
}

ms_status ms_methods_check(ms_methods *methods, ms_error *err)
{
    ms_status status = MS_OK;
    if (methods->count == ms_methods_clumps(methods)) {
        status = add_all_generators(methods, err);
    }
    for (size_t m = 0; m < methods->count && status == MS_OK; m++) {
        for (size_t k = 0; k < m && status == MS_OK; k++) {
            const ms_method *a = &methods->method[k], *b = &methods->method[m];
            if (strcmp(a->name, b->name) == 0 && strcmp(a->options, b->options) == 0) {
                status =
                    ms_fail(err, MS_ERR_ARG, "%s%s%s is there twice", a->name, a->options[0] ? ":" : "", a->options);
            }
        }
    }
    return status;
}

void ms_methods_free(ms_methods *methods)
{
    for (size_t m = 0; m < methods->count; m++) {
        free(methods->method[m].name);
        free(methods->method[m].options);
        ms_option_settings_free(&methods->method[m].settings);
        for (size_t k = 0; k < methods->method[m].n_clumps; k++) {
            ms_clump_free(&methods->method[m].clump[k].clump);
            free(methods->method[m].clump[k].file);
        }
        free(methods->method[m].clump);
    }
    memset(methods, 0, sizeof *methods);
}
