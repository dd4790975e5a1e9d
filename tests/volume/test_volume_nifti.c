/* NIfTI-1: what is read and what is refused. */
#include <math.h>

#include "support/volume_samples.h"

/* What a header is made of; all else is 0. */
typedef struct nifti_fields {
    int big;
    int dim[8], datatype, bits;
    double offset, slope, intercept, pixdim[4];
    int qform, sform;
    double quatern[3], qoffset[3], row[3][4];
    const char *magic;
} nifti_fields;

static nifti_fields usual(void)
{
    return (nifti_fields){.dim = {3, NX, NY, NZ, 1, 1, 1, 1},
                          .datatype = 2,
                          .bits = 8,
                          .offset = 352,
                          .pixdim = {1, 0.5, 0.5, 0.5},
                          .magic = "n+1"};
}

static void pad(sample *to, size_t size)
{
    while (to->size < size) {
        put_bytes(to, "", 1);
    }
}

/* By the offsets of nifti1.h. */
static void put_header(sample *to, const nifti_fields *f)
{
    put_integer(to, 348, 4, f->big);
    pad(to, 40);
    for (int i = 0; i < 8; i++) {
        put_integer(to, (uint64_t)f->dim[i], 2, f->big);
    }
    pad(to, 70);
    put_integer(to, (uint64_t)f->datatype, 2, f->big);
    put_integer(to, (uint64_t)f->bits, 2, f->big);
    pad(to, 76);
    for (int i = 0; i < 4; i++) {
        put_float32(to, f->pixdim[i], f->big);
    }
    pad(to, 108);
    put_float32(to, f->offset, f->big);
    put_float32(to, f->slope, f->big);
    put_float32(to, f->intercept, f->big);
    pad(to, 252);
    put_integer(to, (uint64_t)f->qform, 2, f->big);
    put_integer(to, (uint64_t)f->sform, 2, f->big);
    for (int i = 0; i < 3; i++) {
        put_float32(to, f->quatern[i], f->big);
    }
    for (int i = 0; i < 3; i++) {
        put_float32(to, f->qoffset[i], f->big);
    }
    for (int i = 0; i < 12; i++) {
        put_float32(to, f->row[i / 4][i % 4], f->big);
    }
    pad(to, 344);
    put_bytes(to, f->magic, 4);
    pad(to, 352);
}

#if MS_WITH_NIFTI

static void every_type_is_read(void **state)
{
    static const struct {
        int code;
        char kind;
        size_t size;
    } types[] = {{2, 'u', 1}, {256, 'i', 1},  {512, 'u', 2},  {4, 'i', 2},  {768, 'u', 4},
                 {8, 'i', 4}, {1280, 'u', 8}, {1024, 'i', 8}, {16, 'f', 4}, {64, 'f', 8}};
    (void)state;
    for (size_t t = 0; t < sizeof types / sizeof *types; t++) {
        for (int big = 0; big < 2; big++) {
            sample made = {.size = 0};
            nifti_fields f = usual();
            f.big = big;
            f.datatype = types[t].code;
            f.bits = (int)(8 * types[t].size);
            f.dim[0] = t % 2 ? 4 : 3; /* with a fourth axis of length 1 */
            put_header(&made, &f);
            put_voxels(&made, types[t].kind, types[t].size, big, 100);
            expect_volume(ms_volume_parse_nifti, &made, "sample", 100);
        }
    }
}

static ms_volume read_fields(const nifti_fields *f)
{
    sample made = {.size = 0};
    ms_volume v;
    ms_error err = {{0}};
    put_header(&made, f);
    put_voxels(&made, 'u', 1, f->big, 100);
    if (parse_volume(&v, ms_volume_parse_nifti, &made, "sample", &err) != MS_OK) {
        fail_msg("refused: %s", err.text);
    }
    return v;
}

/* The label at a place in space. */
static uint32_t label_at(const ms_volume *v, double x, double y, double z)
{
    const double p[3] = {x, y, z};
    int at[3];
    for (int a = 0; a < 3; a++) {
        at[a] = (int)lround((p[a] - v->origin[a]) / v->spacing);
        assert_true(at[a] >= 0 && at[a] < v->n[a] && fabs(v->origin[a] + v->spacing * at[a] - p[a]) < 1e-5);
    }
    return v->label[(at[2] * v->n[1] + at[1]) * v->n[0] + at[0]];
}

/* All 48 ways that axes can lead, by the sform; the qform says another, and is not heeded. */
static void the_sform_says_where_voxels_are(void **state)
{
    static const int ORDER[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    (void)state;
    for (int which = 0; which < 48; which++) {
        nifti_fields f = usual();
        f.big = which % 2;
        f.sform = f.qform = 1;
        for (int axis = 0; axis < 3; axis++) {
            f.row[ORDER[which / 8][axis]][axis] = which >> axis & 1 ? -0.5 : 0.5;
            f.row[axis][3] = 10 * axis + 0.25;
        }
        ms_volume v = read_fields(&f);
        for (int i = 0; i < N_VOXELS; i++) {
            const int at[3] = {i % NX, i / NX % NY, i / NX / NY};
            double p[3];
            for (int a = 0; a < 3; a++) {
                p[a] = f.row[a][0] * at[0] + f.row[a][1] * at[1] + f.row[a][2] * at[2] + f.row[a][3];
            }
            assert_int_equal(label_at(&v, p[0], p[1], p[2]), known_label(i, 100));
        }
        ms_volume_free(&v);
    }
}

/* Half a turn about z, by hand: x and y become -x and -y; with qfac -1 z is mirrored as well. */
static void the_qform_says_it_where_there_is_no_sform(void **state)
{
    (void)state;
    for (int qfac = -1; qfac <= 1; qfac += 2) {
        nifti_fields f = usual();
        f.qform = 1;
        f.pixdim[0] = qfac;
        f.quatern[2] = 1;
        f.qoffset[0] = 3;
        f.qoffset[1] = -4;
        f.qoffset[2] = 5;
        ms_volume v = read_fields(&f);
        for (int i = 0; i < N_VOXELS; i++) {
            const double x = 3 - 0.5 * (i % NX), y = -4 - 0.5 * (i / NX % NY), z = 5 + 0.5 * qfac * (i / NX / NY);
            assert_int_equal(label_at(&v, x, y, z), known_label(i, 100));
        }
        ms_volume_free(&v);
    }
    nifti_fields none = usual();
    ms_volume v = read_fields(&none);
    assert_true(v.spacing == 0.5 && v.origin[0] == 0 && v.origin[1] == 0 && v.origin[2] == 0);
    assert_int_equal(v.label[9], known_label(9, 100));
    ms_volume_free(&v);
}

/* 2 s - 1 of every sample: whole numbers stay labels, fractions are none. */
static void scaled_values_are_scaled(void **state)
{
    nifti_fields f = usual();
    f.slope = 2;
    f.intercept = -1;
    sample made = {.size = 0};
    ms_volume v;
    (void)state;
    put_header(&made, &f);
    for (int i = 0; i < N_VOXELS; i++) {
        put_integer(&made, (uint64_t)(i + 1), 1, 0);
    }
    assert_int_equal(parse_volume(&v, ms_volume_parse_nifti, &made, "sample", NULL), MS_OK);
    assert_int_equal(v.label[7], 15);
    ms_volume_free(&v);
    f.slope = 0.5;
    made.size = 0;
    put_header(&made, &f);
    put_voxels(&made, 'u', 1, 0, 100);
    expect_volume_refused(ms_volume_parse_nifti, &made, MS_ERR_FORMAT, "which is no label");
}

static void refuse(nifti_fields f, const char *message)
{
    sample made = {.size = 0};
    put_header(&made, &f);
    put_voxels(&made, 'u', 1, 0, 100);
    expect_volume_refused(ms_volume_parse_nifti, &made, MS_ERR_FORMAT, message);
}

static void broken_files_are_refused(void **state)
{
    nifti_fields f = usual();
    sample made = {.size = 0};
    (void)state;
    put_header(&made, &f);
    made.size = 351;
    expect_volume_refused(ms_volume_parse_nifti, &made, MS_ERR_FORMAT, "byte 351: ends within the header");
    made.size = 352;
    expect_volume_refused(ms_volume_parse_nifti, &made, MS_ERR_FORMAT, "(24) but there are 0 bytes of data");
    f.magic = "ni1";
    refuse(f, "its voxels are in a file apart");
    f.magic = "abc";
    refuse(f, "does not begin as NIfTI-1 files do");
    f = usual();
    f.dim[0] = 2;
    refuse(f, "its array has 2 axes");
    f.dim[0] = 4;
    f.dim[4] = 5;
    refuse(f, "its array has 4 axes");
    f.dim[0] = 0;
    refuse(f, "its array has 0 axes");
    f = usual();
    f.dim[2] = -3;
    refuse(f, "extents are 2 x -3 x 4");
    f = usual();
    f.datatype = 128; /* colours */
    refuse(f, "its datatype 128 is not read");
    f.datatype = 1;
    refuse(f, "its datatype 1 is not read");
    f = usual();
    f.offset = 100;
    refuse(f, "cannot begin at 100");
    f.offset = 352.5;
    refuse(f, "cannot begin at 352.5");
    f.offset = 1e30;
    refuse(f, "cannot begin at 1e+30");
    f.offset = (double)NAN;
    refuse(f, "cannot begin at nan");
    f = usual();
    f.sform = 1;
    f.row[0][0] = f.row[1][1] = f.row[2][2] = 0.5;
    f.row[0][1] = 0.01;
    refuse(f, "oblique by its sform");
    f = usual();
    f.qform = 1;
    f.quatern[0] = 0.1;
    refuse(f, "oblique by its qform");
    sample two = {.size = 0};
    put_integer(&two, 540, 4, 0);
    put_text(&two, "n+2");
    pad(&two, 600);
    expect_volume_refused(ms_volume_parse_nifti, &two, MS_ERR_FORMAT, "NIfTI-2 is not read");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_type_is_read),
        cmocka_unit_test(the_sform_says_where_voxels_are),
        cmocka_unit_test(the_qform_says_it_where_there_is_no_sform),
        cmocka_unit_test(scaled_values_are_scaled),
        cmocka_unit_test(broken_files_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#else

static void what_is_missing_is_said(void **state)
{
    const nifti_fields f = usual();
    sample made = {.size = 0};
    (void)state;
    put_header(&made, &f);
    expect_volume_refused(ms_volume_parse_nifti, &made, MS_ERR_FORMAT, "built without the nifti library");
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(what_is_missing_is_said)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#endif
