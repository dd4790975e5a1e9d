/* Numbers and words of text files. */
#include <locale.h>
#include <math.h>

#include "base/ms_text.h"
#include "support/reader_samples.h"

static int parse(double *value, const char *text)
{
    ms_word word = {text, strlen(text)};
    return ms_text_to_double(value, &word);
}

/* strtod of the C library rounds correctly: it is the judge. */
static void numbers_are_rounded_as_strtod_does(void **state)
{
    static const char *const texts[] = {"0",
                                        "-0",
                                        "+1",
                                        "1.",
                                        ".5",
                                        "-2.385",
                                        "1e22",
                                        "1e23",
                                        "1e-22",
                                        "1e-23",
                                        "9007199254740992",
                                        "9007199254740993",
                                        "123456789012345678901234567890",
                                        "0.1",
                                        "0.30000000000000004",
                                        "1.7976931348623157e308",
                                        "4.9e-324",
                                        "2.2250738585072011e-308",
                                        "1e-400",
                                        "0e999999999999",
                                        "3.14159265358979",
                                        "8.41e21",
                                        "0.000000000000000000000000123",
                                        "1.00000000000000011102230246251565",
                                        "999999944.719430",
                                        "179769313486231580793728971405301e276",
                                        "0000000000000000000000000000001.5",
                                        "1E+5",
                                        "1e-5"};
    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        double value = 7.0;
        double wanted = strtod(texts[i], NULL);
        assert_true(parse(&value, texts[i]));
        assert_memory_equal(&value, &wanted, sizeof value);
    }
}

static void random_numbers_are_rounded_as_strtod_does(void **state)
{
    uint64_t seed = 2385;
    (void)state;
    for (int i = 0; i < 200000; i++) {
        char text[64];
        double value;
        seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
        int digits = 1 + (int)(seed >> 33) % 19;
        int exponent = (int)(seed >> 40) % 60 - 30;
        snprintf(text, sizeof text, "%.*e", digits, (double)(int64_t)seed * pow(10.0, exponent));
        double wanted = strtod(text, NULL);
        assert_true(parse(&value, text));
        assert_memory_equal(&value, &wanted, sizeof value);
    }
}

static void special_numbers_are_read(void **state)
{
    double value;
    (void)state;
    assert_true(parse(&value, "-Inf") && value < 0.0 && isinf(value));
    assert_true(parse(&value, "infinity") && isinf(value));
    assert_true(parse(&value, "NaN") && isnan(value));
    assert_true(parse(&value, "-nan(ind)") && isnan(value));
    assert_true(parse(&value, "1e999") && isinf(value));
}

static void what_is_no_number_is_refused(void **state)
{
    static const char *const texts[] = {"",    "+",  "-",   ".",    "e5",   "1e", "1e+",   "1,5", "0x10", "1.2.3",
                                        "--1", "1f", "abc", "1e5.", "nanx", "in", "1_000", " 1",  "1 "};
    double value;
    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        assert_false(parse(&value, texts[i]));
    }
}

static void a_locale_with_a_comma_changes_nothing(void **state)
{
    static const char *const names[] = {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "fr_FR.utf8"};
    const char *set = NULL;
    double value;
    (void)state;
    for (size_t i = 0; i < sizeof names / sizeof names[0] && !set; i++) {
        set = setlocale(LC_NUMERIC, names[i]);
    }
    int ok = parse(&value, "2.385") && value == 2.385;
    int ok_long = parse(&value, "2.38500000000000000000000001") && value == 2.385;
    int ok_comma = parse(&value, "2,385");
    setlocale(LC_NUMERIC, "C");
    assert_true(ok && ok_long && !ok_comma);
    if (!set) {
        print_message("skipped: no locale with a decimal comma is installed\n");
        skip();
    }
}

static void integers_are_strict(void **state)
{
    static const char *const bad[] = {"", "-", "1.0", "12a", "1234567890123456789", "0x1"};
    ms_word word = {"-999999999999", 13};
    int64_t value;
    (void)state;
    assert_true(ms_text_to_integer(&value, &word));
    assert_true(value == INT64_C(-999999999999));
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        word = (ms_word){bad[i], strlen(bad[i])};
        assert_false(ms_text_to_integer(&value, &word));
    }
}

static void lines_are_counted_over_comments_and_joints(void **state)
{
    const char *lines = "\xEF\xBB\xBF"
                        "a # x\r\n\n b \\\n c\\\r\nd\n\te";
    ms_bytes bytes = copy_bytes(lines, strlen(lines));
    ms_text text;
    ms_word word;
    (void)state;
    ms_text_start(&text, &bytes, "t");
    text.comment = '#';
    text.joins_lines = 1;
    assert_true(ms_text_word(&word, &text) && ms_text_word_is(&word, "a") && text.line == 1);
    assert_false(ms_text_word(&word, &text));
    assert_true(ms_text_seek(&text) && text.line == 3);
    assert_true(ms_text_word(&word, &text) && ms_text_word_is(&word, "b"));
    assert_true(ms_text_word(&word, &text) && ms_text_word_is(&word, "c") && text.line == 4);
    assert_true(ms_text_word(&word, &text) && ms_text_word_is(&word, "d") && text.line == 5);
    assert_false(ms_text_word(&word, &text));
    assert_true(ms_text_seek(&text) && ms_text_word(&word, &text) && ms_text_word_is(&word, "e") && text.line == 6);
    assert_false(ms_text_seek(&text));
    ms_file_free(&bytes);
}

static void quotes_are_printable_and_short(void **state)
{
    char wild[80];
    (void)state;
    memset(wild, 'x', sizeof wild);
    wild[0] = '\033';
    ms_word word = {wild, sizeof wild};
    ms_quote quote = ms_text_quote(&word);
    assert_int_equal(strlen(quote.text), 39);
    assert_int_equal(quote.text[0], '?');
    assert_string_equal(quote.text + 36, "...");
}

static void expect_word(const ms_word *word, const char *text)
{
    assert_int_equal(word->length, strlen(text));
    assert_memory_equal(word->start, text, word->length);
}

static void lines_are_cut_at_commas(void **state)
{
    (void)state;
    static const struct {
        const char *line, *first, *second;
        int fields;
    } CASES[] = {{"", "", NULL, 1},
                 {" a b ", "a b", NULL, 1},
                 {"a,\tb\t", "a", "b", 2},
                 {" , ", "", "", 2},
                 {"a,b,c,", "a", "b", 4}};
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        const ms_word line = {CASES[i].line, strlen(CASES[i].line)};
        ms_word field[2] = {{NULL, 0}};
        assert_int_equal(ms_text_split(field, 2, &line), CASES[i].fields);
        expect_word(&field[0], CASES[i].first);
        if (CASES[i].second) {
            expect_word(&field[1], CASES[i].second);
        } else {
            assert_null(field[1].start);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_are_rounded_as_strtod_does),
        cmocka_unit_test(random_numbers_are_rounded_as_strtod_does),
        cmocka_unit_test(special_numbers_are_read),
        cmocka_unit_test(what_is_no_number_is_refused),
        cmocka_unit_test(a_locale_with_a_comma_changes_nothing),
        cmocka_unit_test(integers_are_strict),
        cmocka_unit_test(lines_are_counted_over_comments_and_joints),
        cmocka_unit_test(lines_are_cut_at_commas),
        cmocka_unit_test(quotes_are_printable_and_short),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
