#include "ms_compare_verdict.h"

#include <math.h>
#include <stdlib.h>

#include "ms_compare_population.h"

/* The method that is best on most shapes; of those the one with the largest factor. n_methods if none has a rival. */
static size_t find_winner(const ms_compare_standing *standing, size_t n_methods)
{
    size_t winner = n_methods;
    for (size_t m = 0; m < n_methods; m++) {
        const ms_compare_standing *one = &standing[m], *best = winner < n_methods ? &standing[winner] : NULL;
        if (one->shapes &&
            (!best || one->best > best->best || (one->best == best->best && one->factor > best->factor))) {
            winner = m;
        }
    }
    return winner;
}

/*
 * The factor with its interval, or why it means little. The others are each shape's best, so that who wins most often
 * may lose more where it loses than it gains where it wins.
 */
static void say_factor(FILE *stream, const ms_compare_standing *s, const char *what)
{
    const int is_known = isfinite(s->low);
    fputs(is_known && s->high < 1 ? ", but loses by more than it wins" : "", stream);
    fprintf(stream, "; the best of the others has %.3g times its %s", s->factor, what);
    fputs(s->shapes > 1 ? " on average" : "", stream);
    if (is_known) {
        fprintf(stream, " (95 %%: %.3g to %.3g)", s->low, s->high);
    }
    if (is_known ? s->low <= 1 && s->high >= 1 : s->factor <= 1) {
        fputs(": by this not to be told apart", stream);
    } else if (!is_known && s->shapes > 1) {
        fprintf(stream, "; fewer than %d shapes give no interval", MS_COMPARE_SPREAD_LEAST);
    }
}

static ms_status say_winner(FILE *stream, const ms_compare_population *p, size_t number, ms_column column,
                            ms_compare_standing *standing, ms_error *err)
{
    const ms_status status = ms_compare_population_judge(standing, p, number, column, err);
    const size_t winner = status == MS_OK ? find_winner(standing, p->n_methods) : p->n_methods;
    if (winner == p->n_methods) {
        return status;
    }
    const ms_compare_standing *best = &standing[winner];
    char *name = ms_compare_record_method(p->method[winner]);
    fprintf(stream, "n = %g: %s %s", p->number[number], name ? name : p->method[winner]->field[MS_COLUMN_GENERATOR],
            column == MS_COLUMN_DICE ? "has the least D" : "is the quickest");
    if (p->n_shapes > 1) {
        fprintf(stream, " on %zu of %zu shapes", best->best, best->shapes);
    }
    if (best->shapes < p->n_shapes) {
        fprintf(stream, " (of %zu; on the rest it or all others have none)", p->n_shapes);
    }
    say_factor(stream, best, column == MS_COLUMN_DICE ? "D" : "time");
    fputs(column == MS_COLUMN_GENERATE && ms_compare_population_is_beside(p, number)
              ? " (times of runs side by side; -j 1: in turn)\n"
              : "\n",
          stream);
    free(name);
    return MS_OK;
}

static ms_status say_all(FILE *stream, const ms_compare_population *p, ms_compare_standing *standing, ms_error *err)
{
    const size_t last = p->n_numbers - 1, at[] = {0, last / 2, last};
    ms_status status = MS_OK;
    for (size_t k = 0; k < sizeof at / sizeof *at && status == MS_OK; k++) {
        if (k == 0 || at[k] != at[k - 1]) {
            status = say_winner(stream, p, at[k], MS_COLUMN_DICE, standing, err);
        }
    }
    if (status == MS_OK) {
        status = say_winner(stream, p, last, MS_COLUMN_GENERATE, standing, err);
    }
    if (p->left_out) {
        fprintf(stream, "%zu clumps of more spheres than any number asked for are compared with nothing\n",
                p->left_out);
    }
    return status;
}

ms_status ms_compare_verdict_say(FILE *stream, const ms_compare_records *all, ms_error *err)
{
    ms_compare_population p;
    if (all->count == 0) {
        return MS_OK;
    }
    ms_status status = ms_compare_population_make(&p, all, all->record[all->count - 1].field[MS_COLUMN_CELLS], err);
    if (status == MS_OK && p.n_methods > 1 && p.n_numbers > 0) {
        ms_compare_standing *standing = calloc(p.n_methods, sizeof *standing);
        status = standing ? say_all(stream, &p, standing, err)
                          : ms_fail(err, MS_ERR_NOMEM, "no memory for %zu methods", p.n_methods);
        free(standing);
    }
    ms_compare_population_free(&p);
    return status;
}
