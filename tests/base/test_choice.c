/* Which word was meant. */
#include <string.h>

#include "base/ms_choice.h"
#include "support/reader_samples.h"

static size_t distance(const char *a, const char *b)
{
    return ms_choice_distance(a, strlen(a), b, strlen(b));
}

static int lower(char c)
{
    return c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c;
}

/* By the definition: over the last letters of both. */
static size_t brute(const char *a, size_t n, const char *b, size_t m)
{
    if (n == 0 || m == 0) {
        return n + m;
    }
    const int same = lower(a[n - 1]) == lower(b[m - 1]);
    size_t best = brute(a, n - 1, b, m - 1) + !same;
    const size_t left_out = brute(a, n - 1, b, m) + 1, put_in = brute(a, n, b, m - 1) + 1;
    best = left_out < best ? left_out : best;
    best = put_in < best ? put_in : best;
    if (n > 1 && m > 1 && lower(a[n - 1]) == lower(b[m - 2]) && lower(a[n - 2]) == lower(b[m - 1])) {
        const size_t exchanged = brute(a, n - 2, b, m - 2) + 1;
        best = exchanged < best ? exchanged : best;
    }
    return best;
}

static void distances_known_by_hand(void **state)
{
    (void)state;
    assert_int_equal(distance("", ""), 0);
    assert_int_equal(distance("", "cells"), 5);
    assert_int_equal(distance("cells", "cells"), 0);
    assert_int_equal(distance("CELLS", "cells"), 0);
    assert_int_equal(distance("clels", "cells"), 1);  /* exchanged */
    assert_int_equal(distance("cell", "cells"), 1);   /* left out */
    assert_int_equal(distance("cellss", "cells"), 1); /* put in */
    assert_int_equal(distance("cekls", "cells"), 1);  /* replaced */
    assert_int_equal(distance("kitten", "sitting"), 3);
    assert_int_equal(distance("ca", "abc"), 3); /* no letter is moved twice */
}

/* All words of up to five letters a, b, C. */
static void distances_by_brute_force(void **state)
{
    (void)state;
    char word[364][6];
    size_t count = 0;
    for (int length = 0; length <= 5; length++) {
        int many = 1;
        for (int k = 0; k < length; k++) {
            many *= 3;
        }
        for (int code = 0; code < many; code++, count++) {
            int rest = code;
            for (int k = 0; k < length; k++, rest /= 3) {
                word[count][k] = "abC"[rest % 3];
            }
            word[count][length] = '\0';
        }
    }
    for (size_t i = 0; i < count; i += 3) {
        for (size_t j = 0; j < count; j += 2) {
            const size_t n = strlen(word[i]), m = strlen(word[j]);
            assert_int_equal(distance(word[i], word[j]), brute(word[i], n, word[j], m));
        }
    }
}

static void offer_all(ms_choice *choice)
{
    static const char *const WORDS[] = {"mss", "setcover", "fcm", "variational"};
    for (size_t w = 0; w < 4; w++) {
        assert_int_equal(ms_choice_offer(choice, WORDS[w]), strcmp(choice->typed, WORDS[w]) == 0);
    }
}

static void the_nearest_is_meant(void **state)
{
    (void)state;
    static const struct {
        const char *typed, *nearest;
    } cases[] = {{"mms", "mss"},
                 {"fcn", "fcm"},
                 {"setcovr", "setcover"},
                 {"SETCOVER", "setcover"},
                 {"var", "variational"},
                 {"va", ""},
                 {"x", ""},
                 {"", ""},
                 {"nonsense", ""},
                 {"mss", "mss"},
                 {"variatoinall", "variational"}};
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        ms_choice choice = {.typed = cases[c].typed};
        offer_all(&choice);
        assert_string_equal(choice.nearest, cases[c].nearest);
        assert_string_equal(choice.list, "mss, setcover, fcm, variational");
    }
}

static void messages(void **state)
{
    (void)state;
    ms_error err;
    ms_choice choice = {.typed = "mms"}, far = {.typed = "xyz"}, none = {.typed = "xyz"};
    offer_all(&choice);
    offer_all(&far);
    assert_int_equal(ms_choice_fail(&choice, &err, "there is no method '%s'", "mms"), MS_ERR_ARG);
    assert_string_equal(err.text, "there is no method 'mms'; did you mean mss? choose from mss, setcover, fcm, "
                                  "variational");
    ms_choice_fail(&far, &err, "no");
    assert_string_equal(err.text, "no; choose from mss, setcover, fcm, variational");
    assert_string_equal(ms_choice_hint(&far).text, "");
    ms_choice_fail(&none, &err, "no");
    assert_string_equal(err.text, "no; choose from none");
    assert_int_equal(ms_choice_fail(&none, NULL, "no"), MS_ERR_ARG);
}

/* A part of a longer text, on either side; and words beyond any length. */
static void parts_and_long_words(void **state)
{
    (void)state;
    char word[4000];
    memset(word, 'a', sizeof word - 1);
    word[sizeof word - 1] = '\0';
    ms_choice part = {.typed = "half=1", .length = 4};
    assert_true(ms_choice_offer_part(&part, "half|centre", 4));
    assert_false(ms_choice_offer_part(&part, "half|centre", 5));
    ms_choice longest = {.typed = word};
    assert_false(ms_choice_offer(&longest, "aaa"));
    assert_true(ms_choice_offer(&longest, word));
    assert_string_equal(longest.nearest, "");
    for (int k = 0; k < 500; k++) {
        ms_choice_offer(&longest, "a list that is cut");
    }
    assert_true(strlen(longest.list) < sizeof longest.list);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(distances_known_by_hand), cmocka_unit_test(distances_by_brute_force),
        cmocka_unit_test(the_nearest_is_meant),    cmocka_unit_test(messages),
        cmocka_unit_test(parts_and_long_words),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
