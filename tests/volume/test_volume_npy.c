/* NumPy arrays: what is read and what is refused. */
#include <math.h>

#include "support/volume_samples.h"

static sample npy(int version, const char *dictionary)
{
    sample made = {.size = 0};
    put_bytes(&made, "\x93NUMPY", 6);
    put_integer(&made, (uint64_t)version, 1, 0);
    put_integer(&made, 0, 1, 0);
    put_integer(&made, strlen(dictionary), version == 1 ? 2 : 4, 0);
    put_text(&made, dictionary);
    return made;
}

static void every_type_order_and_version_is_read(void **state)
{
    static const char *const types[] = {"|b1", "|u1", "<u2", ">u2", "<u4", ">u4", "<u8", ">u8", "|i1", "<i1",
                                        "<i2", ">i2", "<i4", ">i4", "<i8", ">i8", "<f4", ">f4", "<f8", ">f8"};
    (void)state;
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++) {
        for (int fortran = 0; fortran < 2; fortran++) {
            char text[160];
            const char *type = types[i];
            uint32_t largest = type[1] == 'b' ? 1 : 100;
            snprintf(text, sizeof text, "{'descr': '%s', 'fortran_order': %s, 'shape': %s, }      \n", type,
                     fortran ? "True" : "False", fortran ? "(2, 3, 4)" : "(4, 3, 2)");
            sample made = npy(1 + (int)i % 3, text);
            put_voxels(&made, type[1], (size_t)(type[2] - '0'), type[0] == '>', largest);
            expect_volume(ms_volume_parse_npy, &made, "sample", largest);
        }
    }
}

static void other_spellings_of_the_header_are_read(void **state)
{
    static const char *const headers[] = {
        "{\"shape\":(4L,3L,2L),\"descr\":\"|u1\",\"fortran_order\":False}",
        " { 'fortran_order' : False , 'shape' : ( 4 , 3 , 2 , ) , 'descr' : '|u1' } \n",
    };
    (void)state;
    for (int i = 0; i < 2; i++) {
        sample made = npy(1, headers[i]);
        put_voxels(&made, 'u', 1, 0, 100);
        expect_volume(ms_volume_parse_npy, &made, "sample", 100);
    }
}

static void malformed_headers_are_refused(void **state)
{
    static const refused_header cases[] = {
        {"", "a dictionary belongs here"},
        {"{", "a string belongs here"},
        {"{'descr", "a closing quote belongs here"},
        {"{'descr' '<u2'}", "a colon belongs here"},
        {"{'descr': '<u2' 'shape': 1}", "a comma or '}' belongs here"},
        {"{'descr': '<u2', 'colour': 1}", "descr, fortran_order or shape belongs here"},
        {"{'fortran_order': Maybe}", "True or False belongs here"},
        {"{'shape': 5}", "the tuple of the shape belongs here"},
        {"{'shape': (4, x, 2)}", "byte 24 of the header: an extent belongs here"},
        {"{'shape': (4, -3, 2)}", "an extent belongs here"},
        {"{'shape': (4 3 2)}", "a comma or ')' belongs here"},
        {"{'shape': (4, 3", "a comma or ')' belongs here"},
        {"{'shape': (4, 3)}", "its array has 2 axes and a volume has 3"},
        {"{'shape': (4, 3, 2, 1)}", "its array has 4 axes and a volume has 3"},
        {"{'shape': ()}", "its array has 0 axes"},
        {"{'descr': '<f2'}", "the type '<f2', which is not read"},
        {"{'descr': '<c8'}", "the type '<c8'"},
        {"{'descr': '|O'}", "the type '|O'"},
        {"{'descr': '|u2'}", "the type '|u2'"},
        {"{'descr': ''}", "the type ''"},
        {"{'descr': [('a', '<u2')]}", "a string belongs here"},
        {"{'descr': '<u2', 'shape': (4, 3, 2)}", "which is missing"},
        {"{'fortran_order': False, 'shape': (4, 3, 2)}", "which is missing"},
        {"{'descr': '<u2', 'fortran_order': False}", "which is missing"},
        {"{'descr': '<u2', 'fortran_order': False, 'shape': (4, 3, 2)} x", "the end of the header belongs here"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        sample made = npy(1, cases[i].text);
        expect_volume_refused(ms_volume_parse_npy, &made, MS_ERR_FORMAT, cases[i].message);
    }
}

static void malformed_beginnings_are_refused(void **state)
{
    sample text = {.size = 0};
    sample version = npy(4, "{}");
    sample cut = npy(2, "{}");
    (void)state;
    put_text(&text, "\x93NUMPX 1234567");
    expect_volume_refused(ms_volume_parse_npy, &text, MS_ERR_FORMAT, "does not begin as NumPy arrays do");
    expect_volume_refused(ms_volume_parse_npy, &version, MS_ERR_FORMAT, "version 4 of .npy is not read");
    cut.size--;
    expect_volume_refused(ms_volume_parse_npy, &cut, MS_ERR_FORMAT, "a header of 2 bytes is claimed");
    cut.size = 11;
    expect_volume_refused(ms_volume_parse_npy, &cut, MS_ERR_FORMAT, "a header of 2 bytes is claimed");
    cut.size = 6;
    expect_volume_refused(ms_volume_parse_npy, &cut, MS_ERR_FORMAT, "does not begin as NumPy arrays do");
}

static sample array(const char *type, const char *shape)
{
    char text[160];
    snprintf(text, sizeof text, "{'descr': '%s', 'fortran_order': False, 'shape': %s}\n", type, shape);
    return npy(1, text);
}

static void data_of_a_wrong_size_are_refused(void **state)
{
    sample made = array("<u2", "(4, 3, 2)");
    sample huge = array("<u8", "(2147483647, 2147483647, 2147483647)");
    sample wide = array("|u1", "(1, 1, 2147483648)");
    sample large = array("|u1", "(100000, 100000, 100)");
    sample none = array("|u1", "(4, 0, 2)");
    (void)state;
    put_voxels(&made, 'u', 2, 0, 100);
    made.size--;
    expect_volume_refused(ms_volume_parse_npy, &made, MS_ERR_FORMAT,
                          "claims 2 x 3 x 4 voxels of 2 bytes (48) but there are 47 bytes");
    made.size += 2;
    expect_volume_refused(ms_volume_parse_npy, &made, MS_ERR_FORMAT, "(48) but there are 49 bytes");
    expect_volume_refused(ms_volume_parse_npy, &huge, MS_ERR_LIMIT, "2147483647 voxels, too many");
    expect_volume_refused(ms_volume_parse_npy, &wide, MS_ERR_LIMIT, "claims 2147483648 x 1 x 1 voxels, too many");
    expect_volume_refused(ms_volume_parse_npy, &large, MS_ERR_FORMAT, "(1000000000000) but there are 0 bytes");
    expect_volume_refused(ms_volume_parse_npy, &none, MS_ERR_FORMAT, "its extents are 2 x 0 x 4");
}

static void grey_values_are_refused_with_their_voxel(void **state)
{
    static const double values[] = {0.5, -1.0, (double)NAN, (double)INFINITY, 4294967296.0};
    static const char *const shown[] = {"holds 0.5,", "holds -1,", "nan,", "holds inf,", "holds 4.2949673e+09,"};
    (void)state;
    for (int i = 0; i < 5; i++) {
        sample made = array("<f8", "(2, 2, 2)");
        for (int k = 0; k < 8; k++) {
            put_float64(&made, k == 6 ? values[i] : 1.0, 0);
        }
        expect_volume_refused(ms_volume_parse_npy, &made, MS_ERR_FORMAT, "voxel (0, 1, 1) holds ");
        expect_volume_refused(ms_volume_parse_npy, &made, MS_ERR_FORMAT, shown[i]);
    }
}

static void integers_that_are_no_labels_are_refused(void **state)
{
    sample negative = array("<i2", "(1, 1, 2)");
    sample wide = array(">u8", "(1, 1, 1)");
    sample truth = array("|b1", "(1, 1, 1)");
    (void)state;
    put_integer(&negative, 1, 2, 0);
    put_integer(&negative, 0xFFFE, 2, 0);
    expect_volume_refused(ms_volume_parse_npy, &negative, MS_ERR_FORMAT, "voxel (1, 0, 0) holds -2");
    put_integer(&wide, UINT64_C(1) << 32, 8, 1);
    expect_volume_refused(ms_volume_parse_npy, &wide, MS_ERR_FORMAT, "voxel (0, 0, 0) holds 4.2949673e+09");
    put_integer(&truth, 2, 1, 0);
    expect_volume_refused(ms_volume_parse_npy, &truth, MS_ERR_FORMAT,
                          "holds 2, which is no label (0, 1, 2, ... up to 1");
}

static void the_largest_label_is_read(void **state)
{
    sample made = array("<i8", "(1, 1, 1)");
    ms_volume volume;
    (void)state;
    put_integer(&made, UINT32_MAX, 8, 0);
    assert_int_equal(parse_volume(&volume, ms_volume_parse_npy, &made, "sample", NULL), MS_OK);
    assert_int_equal(volume.label[0], UINT32_MAX);
    assert_true(volume.spacing == 1.0 && volume.origin[0] == 0.0);
    ms_volume_free(&volume);
}

static void background_alone_is_no_shape(void **state)
{
    sample made = array("|u1", "(1, 2, 2)");
    (void)state;
    put_integer(&made, 0, 4, 0);
    expect_volume_refused(ms_volume_parse_npy, &made, MS_ERR_SHAPE, "has no label: all 2 x 2 x 1 voxels are 0");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_type_order_and_version_is_read),
        cmocka_unit_test(other_spellings_of_the_header_are_read),
        cmocka_unit_test(malformed_headers_are_refused),
        cmocka_unit_test(malformed_beginnings_are_refused),
        cmocka_unit_test(data_of_a_wrong_size_are_refused),
        cmocka_unit_test(grey_values_are_refused_with_their_voxel),
        cmocka_unit_test(integers_that_are_no_labels_are_refused),
        cmocka_unit_test(the_largest_label_is_read),
        cmocka_unit_test(background_alone_is_no_shape),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
