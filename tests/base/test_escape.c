/* Text from outside: what each language reads back, and that nothing ends a string before its end. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/ms_escape.h"

typedef void writer(FILE *stream, const char *text);

static void check_written(writer *write, const char *text, const char *wanted)
{
    char *out = NULL;
    size_t size;
    FILE *stream = open_memstream(&out, &size);
    assert_non_null(stream);
    write(stream, text);
    assert_int_equal(fclose(stream), 0);
    assert_string_equal(out, wanted);
    free(out);
}

static void test_comment(void **state)
{
    (void)state;
    check_written(ms_escape_comment, "grain-1_a.stl", "grain-1_a.stl");
    check_written(ms_escape_comment, "a\nshell x\r#\"'`$&\\ %\x7f", "a?shell?x???????????");
    check_written(ms_escape_comment, "k\u00f6rn \u7c92", "k\u00f6rn?\u7c92");
    check_written(ms_escape_comment,
                  "a\u2028b\u201cc\xc2\x85"
                  "d\xff",
                  "a?b?c?d?");
    check_written(ms_escape_name, "a b\"]", "a_b__");
}

/* Overlong, cut, surrogate, beyond the last: one substitute for each byte that begins no character. */
static void test_bytes_that_are_no_utf8(void **state)
{
    (void)state;
    check_written(ms_escape_name, "\xc3\xa4\xf0\x9f\x98\x80", "\xc3\xa4\xf0\x9f\x98\x80");
    check_written(ms_escape_name, "\xc0\xaf", "__");
    check_written(ms_escape_name, "\xe0\x80\xaf", "___");
    check_written(ms_escape_name, "\xed\xa0\x80", "___");
    check_written(ms_escape_name, "\xf4\x90\x80\x80", "____");
    check_written(ms_escape_name, "\xe2\x82", "__");
    check_written(ms_escape_name, "\xff\x80z", "__z");
}

static void test_html(void **state)
{
    (void)state;
    check_written(ms_escape_html, "grain 1.stl", "grain 1.stl");
    check_written(ms_escape_html, "</script><b a=\"x\" b='y' c=`z`>&amp;",
                  "&#60;/script&#62;&#60;b a=&#34;x&#34; b=&#39;y&#39; c=&#96;z&#96;&#62;&#38;amp;");
    check_written(ms_escape_html, "k\u00f6rn\n\u202e\xff", "k\u00f6rn???");
    check_written(ms_escape_html_json, "{\"a\":\"</script><!--&\\\"\"}",
                  "{\"a\":\"\\u003c/script\\u003e\\u003c!--\\u0026\\\"\"}");
}

/* A shell would read these words back; the test of the program lets one do so. */
static void test_shell(void **state)
{
    (void)state;
    check_written(ms_escape_shell, "generate", "generate");
    check_written(ms_escape_shell, "a=1.5,b", "a=1.5,b");
    check_written(ms_escape_shell, "", "''");
    check_written(ms_escape_shell, "O'Brien $(x) `y`", "'O'\\''Brien $(x) `y`'");
    check_written(ms_escape_shell, "k\u00f6rn", "'k\u00f6rn'");
    check_written(ms_escape_shell, "a\nb", "'a?b'");
}

static void test_gnuplot(void **state)
{
    (void)state;
    check_written(ms_escape_gnuplot, "mss:a=1, D (b)", "'mss:a=1, D (b)'");
    check_written(ms_escape_gnuplot, "O'Brien", "\"O\\047Brien\"");
    check_written(ms_escape_gnuplot, "'a\\n\n\"`y` $z@", "\"\\047a\\134n?\\042\\140y\\140 \\044z\\100\"");
    char *out = NULL;
    size_t size;
    FILE *stream = open_memstream(&out, &size);
    assert_non_null(stream);
    ms_escape_gnuplot_file(stream, "@a", ".dat");
    assert_int_equal(fclose(stream), 0);
    assert_string_equal(out, "\"./\\100a.dat\"");
    free(out);
    check_written(ms_escape_gnuplot_data, "a\"b\\n'c'\t", "\"a?b?n'c'?\"");
}

static void test_python(void **state)
{
    (void)state;
    check_written(ms_escape_python, "a b", "'a b'");
    check_written(ms_escape_python, "a');x('\\\n", "'a\\');x(\\'\\\\\\U0000000a'");
    check_written(ms_escape_python, "\u00fc\xe9", "'\\U000000fc\\udce9'");
}

static void test_lammps(void **state)
{
    (void)state;
    check_written(ms_escape_lammps, "a $x & #", "\"a $x & #\"");
    check_written(ms_escape_lammps, "say \"no\"", "'say \"no\"'");
    assert_true(ms_escape_fits_lammps("a 'b' $x & # %"));
    assert_true(ms_escape_fits_liggghts("\u00fc \u7c92"));
    assert_false(ms_escape_fits_liggghts("\xff"));
    static const char *const UNFIT[] = {"a\nb", "'\"", "\xff", "\u201cx", "\u00a0", "\ufeff", "a\x7f", "\u00fc"};
    for (size_t u = 0; u < sizeof UNFIT / sizeof *UNFIT; u++) {
        assert_false(ms_escape_fits_lammps(UNFIT[u]));
    }
}

static void test_csv(void **state)
{
    (void)state;
    check_written(ms_escape_csv, "plain", "plain");
    check_written(ms_escape_csv, "a,b \"c\"", "\"a,b \"\"c\"\"\"");
    check_written(ms_escape_csv, "=1+1", "'=1+1");
    check_written(ms_escape_csv, "@x y", "\"'@x y\"");
    check_written(ms_escape_csv, "a\nb\xff", "a?b?");
    check_written(ms_escape_csv, "", "");
    for (const char *sign = "=+-@"; *sign; sign++) {
        const char text[] = {*sign, 'a', 0}, wanted[] = {'.', '/', *sign, 'a', 0};
        check_written(ms_escape_csv_path, text, wanted);
    }
    check_written(ms_escape_csv_path, "/x/=a", "/x/=a");
}

static void test_json(void **state)
{
    (void)state;
    char *copy = ms_escape_utf8("\u00fc\xe9\n");
    assert_string_equal(copy, "\u00fc?\n");
    free(copy);
}

/* Every byte and every pair of signs: the name of a file is one that a script of LAMMPS can hold. */
static void test_file_name(void **state)
{
    (void)state;
    char name[] = "a\n\"$`\\<>|*?:/\xff\u201cO'Brien\u00fc =";
    ms_escape_file_name(name);
    assert_string_equal(name, "a______________O'Brien\u00fc =");
    for (int a = 1; a < 256; a++) {
        for (int b = 1; b < 256; b++) {
            char pair[] = {'\'', (char)a, (char)b, 0};
            ms_escape_script_name(pair);
            assert_true(ms_escape_fits_lammps(pair));
            assert_null(strpbrk(pair, "/\"\n"));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_comment), cmocka_unit_test(test_bytes_that_are_no_utf8),
        cmocka_unit_test(test_html),    cmocka_unit_test(test_shell),
        cmocka_unit_test(test_gnuplot), cmocka_unit_test(test_python),
        cmocka_unit_test(test_lammps),  cmocka_unit_test(test_csv),
        cmocka_unit_test(test_json),    cmocka_unit_test(test_file_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
