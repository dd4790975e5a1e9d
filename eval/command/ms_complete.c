#include "ms_complete.h"

#include <string.h>

#include "clump/formats/ms_write.h"
#include "measure/ms_measure.h"
#include "ms_commands.h"
#include "ms_generator.h"
#include "shape/ms_shape.h"
#include "stability/ms_change.h"
#include "stability/ms_hard_shapes.h"
#include "view/ms_view_formats.h"

/* The place that is completed. */
typedef struct place {
    FILE *stream;
    const ms_command *const *all;
    const ms_command *command;
    char *const *word; /* the last is being typed */
    size_t count;
    const char *typed; /* of a flag's argument, what stands behind '=' */
    char before[64];   /* what stands there as it is: "--rule=", or "" */
} place;

/* Offers before + dashes + word + behind. */
static void offer_part(const place *p, const char *dashes, const char *word, size_t length, const char *behind)
{
    const size_t n = strlen(p->typed), d = strlen(dashes);
    const size_t rest = n > d ? n - d : 0;
    if (strncmp(p->typed, dashes, n < d ? n : d) == 0 && rest <= length &&
        memcmp(p->typed + n - rest, word, rest) == 0) {
        fprintf(p->stream, "%s%s%.*s%s\n", p->before, dashes, (int)length, word, behind);
    }
}

static void offer(const place *p, const char *word, const char *behind)
{
    offer_part(p, "", word, strlen(word), behind);
}

static void offer_files(const place *p)
{
    fputs("/\n", p->stream);
}

/* Words with bars between, as "half|centre". */
static void offer_choices(const place *p, const char *choices)
{
    for (const char *at = choices; *at;) {
        const size_t length = strcspn(at, "|");
        offer_part(p, "", at, length, "");
        at += length + (at[length] == '|');
    }
}

static void offer_generators(const place *p)
{
    for (const ms_generator *const *g = ms_generators; *g; g++) {
        offer(p, (*g)->name, "");
    }
}

static void offer_formats(const place *p)
{
    for (const ms_format *f = ms_formats; f->name; f++) {
        offer(p, f->name, "");
    }
    for (const ms_format *f = ms_view_formats; f->name; f++) {
        offer(p, f->name, "");
    }
}

static void offer_goals(const place *p)
{
    for (const ms_measure *m = ms_measures; m->name; m++) {
        if (m->kind == MS_MEASURE_KIND_GOAL) {
            offer(p, m->name, "=");
        }
    }
}

static void offer_stops(const place *p)
{
    offer_goals(p);
    offer(p, "radius", "=");
}

static void offer_mean(const place *p)
{
    offer(p, ms_measures[MS_MEASURE_DICE].name, "=");
}

static void offer_changes(const place *p)
{
    for (const ms_change *c = ms_changes + 1; c->name; c++) {
        offer(p, c->name, "");
    }
}

/* An option that several methods share comes once. */
static int was_offered(const ms_generator *const *now, const char *name)
{
    for (const ms_generator *const *g = ms_generators; g < now; g++) {
        if (ms_option_find((*g)->options, name)) {
            return 1;
        }
    }
    return 0;
}

static void offer_options(const place *p, const char *dashes, const char *behind)
{
    for (const ms_generator *const *g = ms_generators; *g; g++) {
        for (const ms_option *o = (*g)->options; o->name; o++) {
            if (!was_offered(g, o->name)) {
                offer_part(p, dashes, o->name, strlen(o->name), behind);
            }
        }
    }
}

static void offer_settings(const place *p)
{
    offer_options(p, "", "=");
}

static void offer_commands(const place *p)
{
    for (const ms_command *const *c = p->all; *c; c++) {
        offer(p, (*c)->name, "");
    }
}

/* Kinds, and behind one its parameters. */
static void offer_shapes(const place *p)
{
    const ms_shape_kind *kind = p->count > 2 ? ms_shape_find(p->word[1], NULL) : NULL;
    for (const ms_shape_kind *k = ms_shape_kinds; !kind && k->name; k++) {
        offer(p, k->name, "");
    }
    for (const ms_shape_parameter *q = kind ? kind->parameters : NULL; q && q->name; q++) {
        offer(p, q->name, "=");
    }
}

static void offer_hard_shapes(const place *p)
{
    for (const ms_hard_shape *s = ms_hard_shapes; s->name; s++) {
        offer(p, s->name, "");
    }
    offer_files(p);
}

static void offer_help(const place *p)
{
    offer_commands(p);
    offer_generators(p);
}

static void offer_shells(const place *p)
{
    offer_choices(p, MS_COMPLETION_SHELLS);
}

static void offer_nothing(const place *p)
{
    (void)p;
}

typedef struct words_of {
    const char *name;
    void (*offer)(const place *p);
} words_of;

/* What the argument of a flag is. Of others the table of flags says it: one of "a|b", a file, or a number. */
static const words_of ARGUMENTS[] = {
    {"generator", offer_generators}, {"format", offer_formats},      {"until", offer_stops},
    {"tolerance", offer_goals},      {"mean-tolerance", offer_mean}, {"least-work", offer_mean},
    {"set", offer_settings},         {"perturb", offer_changes},     {0},
};

/* What the words of a command are; files where it does not stand here. */
static const words_of WORDS[] = {
    {"shape", offer_shapes},
    {"stability", offer_hard_shapes},
    {"help", offer_help},
    {"completion", offer_shells},
    {"generators", offer_nothing},
    {"version", offer_nothing},
    {0},
};

static const words_of *find_words(const words_of *table, const char *name)
{
    for (const words_of *w = table; w->name; w++) {
        if (strcmp(w->name, name) == 0) {
            return w;
        }
    }
    return NULL;
}

static void offer_argument(const place *p, const ms_flag *flag)
{
    static const char *const FILES[] = {"FILE", "DIR", "SHAPE", "NAME=FILE"};
    const words_of *words = find_words(ARGUMENTS, flag->name);
    if (words) {
        words->offer(p);
    } else if (strchr(flag->argument, '|')) {
        offer_choices(p, flag->argument);
    }
    for (size_t f = 0; f < sizeof FILES / sizeof *FILES; f++) {
        if (strcmp(flag->argument, FILES[f]) == 0) {
            offer_files(p);
        }
    }
}

static int takes_options(const ms_command *command)
{
    for (const ms_flag *f = command->flags; f->name; f++) {
        if (strcmp(f->name, "set") == 0) {
            return 1;
        }
    }
    return 0;
}

static void offer_flags(const place *p)
{
    for (const ms_flag *f = p->command->flags; f->name; f++) {
        offer_part(p, "--", f->name, strlen(f->name), "");
    }
    offer_part(p, "--", "help", strlen("help"), "");
    if (takes_options(p->command)) {
        offer_options(p, "--", "");
    }
}

/* Nonzero if the word, of `length`, is a flag that takes an argument, of which the words are offered. */
static int offer_after(const place *p, const char *word, size_t length)
{
    for (const ms_flag *f = p->command->flags; f->name; f++) {
        const int is_long = length == strlen(f->name) + 2 && memcmp(word + 2, f->name, length - 2) == 0;
        if (f->argument && word[0] == '-' && (is_long || (length == 2 && f->letter == word[1]))) {
            offer_argument(p, f);
            return 1;
        }
    }
    for (const ms_generator *const *g = ms_generators; takes_options(p->command) && *g; g++) {
        for (const ms_option *o = (*g)->options; o->name; o++) {
            const int is_it = length == strlen(o->name) + 2 && memcmp(word + 2, o->name, length - 2) == 0;
            if (is_it && o->type != MS_OPTION_FLAG) {
                offer_choices(p, o->choices ? o->choices : "");
                if (o->type == MS_OPTION_CLUMP) {
                    offer_files(p);
                }
                return 1;
            }
        }
    }
    return 0;
}

/* Behind "--flag=". */
static int offer_behind_equals(place *p)
{
    const char *word = p->typed, *equals = strchr(word, '=');
    if (strncmp(word, "--", 2) != 0 || !equals || equals - word + 2 > (ptrdiff_t)sizeof p->before) {
        return 0;
    }
    memcpy(p->before, word, (size_t)(equals - word) + 1);
    p->typed = equals + 1;
    return offer_after(p, word, (size_t)(equals - word));
}

void ms_complete_print(FILE *stream, const ms_command *const *all, char *const *word, size_t count)
{
    place p = {.stream = stream, .all = all, .word = word, .count = count, .typed = word[count - 1]};
    if (count == 1) {
        offer_commands(&p);
        offer(&p, "--help", "");
        offer(&p, "--version", "");
        return;
    }
    ms_choice choice = {.typed = word[0]};
    p.command = ms_flags_find_command(&choice, all);
    if (!p.command || offer_behind_equals(&p) || offer_after(&p, word[count - 2], strlen(word[count - 2]))) {
        return;
    }
    if (p.typed[0] == '-') {
        offer_flags(&p);
        return;
    }
    const words_of *words = find_words(WORDS, p.command->name);
    (words ? words->offer : offer_files)(&p);
}
