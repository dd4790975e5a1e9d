#include "ms_choice.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static int lower(const char *word, size_t at)
{
    return tolower((unsigned char)word[at]);
}

static size_t least(size_t a, size_t b)
{
    return a < b ? a : b;
}

size_t ms_choice_distance(const char *a, size_t n, const char *b, size_t m)
{
    size_t row[3][MS_CHOICE_LONGEST]; /* edits from the first i letters of a to the first j of b; i in turn */
    for (size_t j = 0; j <= m; j++) {
        row[0][j] = j;
    }
    for (size_t i = 1; i <= n; i++) {
        size_t *now = row[i % 3];
        const size_t *before = row[(i - 1) % 3];
        now[0] = i;
        for (size_t j = 1; j <= m; j++) {
            now[j] = least(least(before[j], now[j - 1]) + 1, before[j - 1] + (lower(a, i - 1) != lower(b, j - 1)));
            if (i > 1 && j > 1 && lower(a, i - 1) == lower(b, j - 2) && lower(a, i - 2) == lower(b, j - 1)) {
                now[j] = least(now[j], row[(i - 2) % 3][j - 2] + 1);
            }
        }
    }
    return row[n % 3][m];
}

static size_t typed_length(const ms_choice *choice)
{
    return choice->length ? choice->length : strlen(choice->typed);
}

static int begins(const char *word, size_t length, const char *start, size_t n)
{
    size_t same = 0;
    while (same < n && same < length && lower(word, same) == lower(start, same)) {
        same++;
    }
    return same == n;
}

/* A third of the letters may be wrong; further words have nothing to do with one another. */
static void keep_if_nearer(ms_choice *choice, const char *word, size_t length)
{
    enum { LEAST_BEGINNING = 3 };
    const size_t n = typed_length(choice), longer = n > length ? n : length, shorter = least(n, length);
    if (longer >= MS_CHOICE_LONGEST) {
        return;
    }
    size_t distance = longer - shorter; /* at least */
    if (n >= LEAST_BEGINNING && begins(word, length, choice->typed, n)) {
        distance = 1;
    } else if (distance <= longer / 3) {
        distance = ms_choice_distance(choice->typed, n, word, length);
    }
    if (distance <= longer / 3 && (!choice->nearest[0] || distance < choice->distance)) {
        choice->distance = distance;
        memcpy(choice->nearest, word, length);
        choice->nearest[length] = '\0';
    }
}

int ms_choice_offer_part(ms_choice *choice, const char *word, size_t length)
{
    const size_t used = strlen(choice->list);
    snprintf(choice->list + used, sizeof choice->list - used, "%s%.*s", used ? ", " : "", (int)length, word);
    keep_if_nearer(choice, word, length);
    return typed_length(choice) == length && memcmp(choice->typed, word, length) == 0;
}

int ms_choice_offer(ms_choice *choice, const char *word)
{
    return ms_choice_offer_part(choice, word, strlen(word));
}

ms_hint ms_choice_hint(const ms_choice *choice)
{
    ms_hint hint = {""};
    if (choice->nearest[0]) {
        snprintf(hint.text, sizeof hint.text, "; did you mean %s?", choice->nearest);
    }
    return hint;
}

ms_status ms_choice_fail(const ms_choice *choice, ms_error *err, const char *format, ...)
{
    char what[256];
    va_list args;
    va_start(args, format);
    vsnprintf(what, sizeof what, format, args);
    va_end(args);
    return ms_fail(err, MS_ERR_ARG, "%s%s%s choose from %s", what, ms_choice_hint(choice).text,
                   choice->nearest[0] ? "" : ";", choice->list[0] ? choice->list : "none");
}
