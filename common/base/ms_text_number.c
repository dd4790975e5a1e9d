/* Numbers in text, in the "C" locale whatever the program has set. */
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ms_text.h"

/* The number read digit by digit: mantissa * 10^exponent. */
typedef struct decimal {
    uint64_t mantissa;
    int64_t exponent;
    int negative;
    int cut; /* the mantissa does not hold all digits */
} decimal;

static const char *scan_sign(int *negative, const char *at, const char *end)
{
    *negative = at < end && *at == '-';
    return at < end && (*at == '-' || *at == '+') ? at + 1 : at;
}

static int is_digit(const char *at, const char *end)
{
    return at < end && *at >= '0' && *at <= '9';
}

/* Digits onto the mantissa; `scale` is what each moves the exponent: 0, or -1 behind the point. */
static const char *scan_digits(decimal *number, int scale, const char *at, const char *end)
{
    for (; is_digit(at, end); at++) {
        if (number->mantissa < UINT64_C(1000000000000000000)) {
            number->mantissa = number->mantissa * 10 + (uint64_t)(*at - '0');
            number->exponent += scale;
        } else {
            number->cut = 1;
            number->exponent += scale + 1;
        }
    }
    return at;
}

/* What follows an e; NULL if that is no exponent. */
static const char *scan_exponent(decimal *number, const char *at, const char *end)
{
    int negative;
    int64_t exponent = 0;
    at = scan_sign(&negative, at, end);
    if (!is_digit(at, end)) {
        return NULL;
    }
    for (; is_digit(at, end); at++) {
        /* Far out of a double's range already: more digits change nothing. */
        exponent = exponent < 1000000000 ? exponent * 10 + (*at - '0') : exponent;
    }
    number->exponent += negative ? -exponent : exponent;
    return at;
}

static int scan_decimal(decimal *number, const char *at, const char *end)
{
    *number = (decimal){0};
    at = scan_sign(&number->negative, at, end);
    const char *whole = at;
    at = scan_digits(number, 0, at, end);
    int has_digits = at > whole;
    if (at < end && *at == '.') {
        const char *fraction = ++at;
        at = scan_digits(number, -1, at, end);
        has_digits |= at > fraction;
    }
    if (has_digits && at < end && (*at == 'e' || *at == 'E')) {
        at = scan_exponent(number, at + 1, end);
    }
    return has_digits && at == end;
}

static int scan_special(double *value, const ms_word *word)
{
    int negative;
    const char *end = word->start + word->length;
    const char *start = scan_sign(&negative, word->start, end);
    ms_word name = {start, (size_t)(end - start)};
    if (ms_text_word_is(&name, "inf") || ms_text_word_is(&name, "infinity")) {
        *value = negative ? -(double)INFINITY : (double)INFINITY;
        return 1;
    }
    if (ms_text_word_is(&name, "nan") || ms_text_word_is(&name, "nan(ind)")) {
        *value = (double)NAN;
        return 1;
    }
    return 0;
}

/* The slow way for numbers that the short one cannot round correctly. */
static int convert_with_strtod(double *value, const ms_word *word)
{
    locale_t plain = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (plain == (locale_t)0) {
        return 0;
    }
    locale_t before = uselocale(plain);
    char *stop;
    *value = strtod(word->start, &stop);
    uselocale(before);
    freelocale(plain);
    return stop == word->start + word->length;
}

int ms_text_to_double(double *value, const ms_word *word)
{
    static const double power[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                   1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    decimal number;
    if (!scan_decimal(&number, word->start, word->start + word->length)) {
        return scan_special(value, word);
    }
    /* Both factors are exact doubles, so that one operation rounds once. Source: Clinger 1990. */
    if (number.cut || number.mantissa > (UINT64_C(1) << 53) || number.exponent < -22 || number.exponent > 22) {
        return convert_with_strtod(value, word);
    }
    double magnitude = (double)number.mantissa;
    magnitude = number.exponent < 0 ? magnitude / power[-number.exponent] : magnitude * power[number.exponent];
    *value = number.negative ? -magnitude : magnitude;
    return 1;
}

int ms_text_to_integer(int64_t *value, const ms_word *word)
{
    int negative;
    const char *end = word->start + word->length;
    const char *at = scan_sign(&negative, word->start, end);
    int64_t magnitude = 0;
    if (at == end || end - at > 18) {
        return 0;
    }
    for (; is_digit(at, end); at++) {
        magnitude = magnitude * 10 + (*at - '0');
    }
    *value = negative ? -magnitude : magnitude;
    return at == end;
}

ms_number ms_text_of_number(double value)
{
    ms_number number;
    for (int digits = 15; digits <= 17; digits++) {
        double restored;
        snprintf(number.text, sizeof number.text, "%.*g", digits, value);
        for (char *at = number.text; *at; at++) {
            *at = strchr("0123456789+-einfa", *at) ? *at : '.'; /* the locale's decimal point */
        }
        const ms_word word = {number.text, strlen(number.text)};
        if (ms_text_to_double(&restored, &word) && restored == value) {
            break;
        }
    }
    return number;
}
