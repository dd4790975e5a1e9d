/* MetaImage and NRRD: what is read and what is refused. */
#include <zlib.h>

#include "support/volume_samples.h"

/* The voxels as uint16, packed; window bits as zlib takes them: 15 for zlib, 31 for gzip. */
static void put_packed(sample *to, int window_bits)
{
    sample voxels = {.size = 0};
    z_stream stream = {0};
    put_voxels(&voxels, 'u', 2, 0, 100);
    assert_int_equal(deflateInit2(&stream, 9, Z_DEFLATED, window_bits, 8, Z_DEFAULT_STRATEGY), Z_OK);
    stream.next_in = voxels.data;
    stream.avail_in = (uInt)voxels.size;
    stream.next_out = to->data + to->size;
    stream.avail_out = (uInt)(sizeof to->data - to->size);
    assert_int_equal(deflate(&stream, Z_FINISH), Z_STREAM_END);
    to->size += stream.total_out;
    deflateEnd(&stream);
}

#define MHD "ObjectType = Image\nNDims = 3\nDimSize = 2 3 4\n"

static void every_type_of_mhd_is_read(void **state)
{
    static const struct {
        const char *name;
        char kind;
        size_t size;
    } types[] = {{"CHAR", 'i', 1},      {"UCHAR", 'u', 1},      {"SHORT", 'i', 2}, {"USHORT", 'u', 2},
                 {"INT", 'i', 4},       {"UINT", 'u', 4},       {"LONG", 'i', 4},  {"ULONG", 'u', 4},
                 {"LONG_LONG", 'i', 8}, {"ULONG_LONG", 'u', 8}, {"FLOAT", 'f', 4}, {"DOUBLE", 'f', 8}};
    (void)state;
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++) {
        for (int big = 0; big < 2; big++) {
            sample made = {.size = 0};
            put_text(&made, MHD "ElementType = MET_");
            put_text(&made, types[i].name);
            put_text(&made, i % 2 ? "\nBinaryDataByteOrderMSB = " : "\nElementByteOrderMSB=");
            put_text(&made, big ? "True\r\nElementDataFile=Local\r\n" : "False\nElementDataFile = LOCAL\n");
            put_voxels(&made, types[i].kind, types[i].size, big, 100);
            expect_volume(ms_volume_parse_mhd, &made, "sample", 100);
        }
    }
}

static void fields_of_mhd_are_understood(void **state)
{
    const char *text = MHD "BinaryData = True\nElementSize = 9 9 9\nElementSpacing = 0.25 0.25 0.25\n"
                           "Position = 1 -2 3.5\n"
                           "Orientation = 1 0 0 0 1 0 0 0 1\nCenterOfRotation = 5 5 5\nAnatomicalOrientation = RAI\n"
                           "Comment = a = b\nElementNumberOfChannels = 1\nHeaderSize = -1\nElementType = MET_UCHAR\n"
                           "ElementDataFile = LOCAL\nthese bytes are passed over";
    sample made = {.size = 0};
    ms_volume volume;
    (void)state;
    put_text(&made, text);
    put_voxels(&made, 'u', 1, 0, 100);
    assert_int_equal(parse_volume(&volume, ms_volume_parse_mhd, &made, "sample", NULL), MS_OK);
    assert_true(volume.spacing == 0.25 && volume.origin[0] == 1.0 && volume.origin[1] == -2.0);
    assert_true(volume.origin[2] == 3.5);
    ms_volume_free(&volume);
    expect_volume(ms_volume_parse_mhd, &made, "sample", 100);
}

static void packed_mhd_is_read(void **state)
{
    sample packed = {.size = 0};
    sample made = {.size = 0};
    char text[256];
    (void)state;
    put_packed(&packed, 15);
    snprintf(text, sizeof text,
             MHD "CompressedData = True\nCompressedDataSize = %zu\nElementType = MET_USHORT\nElementDataFile = LOCAL\n",
             packed.size);
    put_text(&made, text);
    put_bytes(&made, packed.data, packed.size);
    expect_volume(ms_volume_parse_mhd, &made, "sample", 100);
    made.size--;
    expect_volume_refused(ms_volume_parse_mhd, &made, MS_ERR_FORMAT, "bytes of data behind 0 others but there are");
}

#define MHD_END "ElementType = MET_UCHAR\nElementDataFile = LOCAL\n"

static void malformed_mhd_is_refused_with_its_line(void **state)
{
    static const refused_header cases[] = {
        {"ObjectType = Mesh\n", "line 1: only the ObjectType Image is read"},
        {"NDims = 2\n", "line 1: the image has 2 axes and a volume has 3"},
        {"NDims = x\n", "line 1: 'x' stands where an integer belongs"},
        {"junk\n", "line 1: 'junk' is no line 'Key = Value'"},
        {MHD "ElementType = MET_STRING\n", "line 4: the type 'MET_STRING' is not read"},
        {MHD "BinaryData = False\n", "line 4: voxels as text are not read"},
        {MHD "CompressedData = maybe\n", "line 4: 'maybe' stands where True or False belongs"},
        {MHD "ElementSpacing = 1 1\n", "line 4: the spacing needs 3 numbers but the line has 2"},
        {MHD "ElementSpacing = 1 1 1 1\n", "line 4: '1' stands where the line should end"},
        {MHD "ElementSize = 1 1 a\n", "line 4: the size has 'a' where a number belongs"},
        {MHD "Offset = 1 2\n", "line 4: the origin needs 3 numbers"},
        {MHD "TransformMatrix = 0.8 0.6 0 -0.6 0.8 0 0 0 1\n", "line 4: the axes are oblique; resample"},
        {MHD "TransformMatrix = 1 0 0 1 0 0 0 0 1\n", "line 4: the axes are oblique"},
        {MHD "TransformMatrix = 2 0 0 0 1 0 0 0 1\n", "line 4: the rows of the matrix are not of length 1"},
        {MHD "TransformMatrix = nan 0 0 0 1 0 0 0 1\n", "line 4: the rows of the matrix are not of length 1"},
        {MHD "ElementNumberOfChannels = 3\n", "line 4: voxels of 3 channels are colours"},
        {MHD "HeaderSize = -2\n", "line 4: HeaderSize is -2"},
        {MHD "ElementDataFile = LIST\na.raw\n", "line 4: a volume in one file per slice is not read"},
        {MHD "ElementDataFile = a%03d.raw 1 4 1\n", "line 4: a volume in one file per slice is not read"},
        {MHD "ElementDataFile = \n", "line 4: no data file is named"},
        {MHD "ElementType = MET_UCHAR\nElementDataFile = ../a.raw\n",
         "line 5: the data file '../a.raw' is not in the folder"},
        {MHD "ElementDataFile = LOCAL\n", "line 4: the header lacks ElementType"},
        {"NDims = 3\n" MHD_END, "the header lacks DimSize"},
        {MHD "ElementType = MET_UCHAR\n", "the header ends without ElementDataFile"},
        {MHD MHD_END "12345678901234567890123", "claims 24 bytes of data behind 0 others but there are 23"},
        {MHD MHD_END "1234567890123456789012345", "claims 24 bytes of data behind 0 others but there are 25"},
        {MHD "HeaderSize = 30\n" MHD_END "123456789012345678901234", "behind 30 others but there are 24"},
        {MHD "HeaderSize = -1\n" MHD_END "1", "claims 24 bytes of data behind 0 others but there are 1"},
        {MHD "CompressedDataSize = 9\nCompressedData = True\n" MHD_END "1", "claims 9 bytes of data behind 0 others"},
        {MHD "CompressedData = True\n" MHD_END "123456", "its packed data are damaged at byte"},
        {"DimSize = 2 0 4\n" MHD_END, "its extents are 2 x 0 x 4"},
        {"DimSize = 2 -3 4\n" MHD_END, "its extents are 2 x -3 x 4"},
        {"DimSize = 2000 2000 2000\nCompressedData = True\n" MHD_END "x",
         "its 1 packed bytes cannot hold the 8000000000"},
        {MHD "ElementSpacing = 0 0 0\n" MHD_END "123456789012345678901234", "along axis 0 it has the spacing 0"},
        {MHD "ElementSpacing = 1e-300 1e-300 1e-300\n" MHD_END "123456789012345678901234",
         "spacing 1e-300 and the origin 0; spacings must be from 1e-50 to 1e+50"},
        {MHD "ElementSpacing = 1e51 1e51 1e51\n" MHD_END "123456789012345678901234", "it has the spacing 1e+51"},
        {MHD "Offset = 0 0 1e17\n" MHD_END "123456789012345678901234",
         "along axis 2 it has the spacing 1 and the origin"},
        {MHD "ElementSpacing = 1 nan 1\n" MHD_END "123456789012345678901234", "along axis 1 it has the spacing"},
        {MHD "Offset = 0 inf 1\n" MHD_END "123456789012345678901234", "the spacing 1 and the origin inf"},
    };
    (void)state;
    expect_headers_refused(ms_volume_parse_mhd, cases, sizeof cases / sizeof cases[0]);
}

#define NRRD "NRRD0004\ndimension: 3\nsizes: 2 3 4\n"

static void every_type_of_nrrd_is_read(void **state)
{
    static const struct {
        const char *name;
        char kind;
        size_t size;
    } types[] = {
        {"signed char", 'i', 1}, {"uint8_t", 'u', 1}, {"short int", 'i', 2},     {"unsigned short", 'u', 2},
        {"int", 'i', 4},         {"uint32", 'u', 4},  {"long long int", 'i', 8}, {"signed long long int", 'i', 8},
        {"ulonglong", 'u', 8},   {"float", 'f', 4},   {"double", 'f', 8}};
    (void)state;
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++) {
        for (int big = 0; big < 2; big++) {
            sample made = {.size = 0};
            put_text(&made, NRRD "# a comment\nkey:=value: x\nkinds: domain domain space\nspace: RAS\ntype: ");
            put_text(&made, types[i].name);
            put_text(&made, big ? "\r\nendian: big\r\nencoding: raw\r\n\r\n" : "\nendian: little\nencoding: RAW\n\n");
            put_voxels(&made, types[i].kind, types[i].size, big, 100);
            expect_volume(ms_volume_parse_nrrd, &made, "sample", 100);
        }
    }
}

static void every_encoding_of_nrrd_is_read(void **state)
{
    sample packed = {.size = 0};
    sample text = {.size = 0};
    sample skipped = {.size = 0};
    sample last = {.size = 0};
    (void)state;
    put_text(&packed, NRRD "type: ushort\nendian: little\nencoding: gzip\n\n");
    put_packed(&packed, 31);
    expect_volume(ms_volume_parse_nrrd, &packed, "sample", 100);
    packed.size--;
    expect_volume_refused(ms_volume_parse_nrrd, &packed, MS_ERR_FORMAT, "its packed data are cut at byte");
    packed.size += 2;
    expect_volume_refused(ms_volume_parse_nrrd, &packed, MS_ERR_FORMAT, "hold more bytes than the 48");
    put_text(&text, NRRD "type: int\nencoding: text\n\n");
    for (int i = 0; i < N_VOXELS; i++) {
        char value[16];
        snprintf(value, sizeof value, "%u%c", known_label(i, 100), i % 2 ? '\n' : ' ');
        put_text(&text, value);
    }
    expect_volume(ms_volume_parse_nrrd, &text, "sample", 100);
    put_text(&text, "1");
    expect_volume_refused(ms_volume_parse_nrrd, &text, MS_ERR_FORMAT, "more data follow after its 24 values");
    put_text(&skipped, NRRD "type: uchar\nencoding: raw\nline skip: 2\nbyte skip: 3\n\none\ntwo\nabc");
    put_voxels(&skipped, 'u', 1, 0, 100);
    expect_volume(ms_volume_parse_nrrd, &skipped, "sample", 100);
    put_text(&last, NRRD "type: uchar\nencoding: raw\nbyte skip: -1\n\nwhatever stands before");
    put_voxels(&last, 'u', 1, 0, 100);
    expect_volume(ms_volume_parse_nrrd, &last, "sample", 100);
}

/* The voxels as uint16 in two gzip members, as joining two files of slices gives them. */
static void put_two_members(sample *to)
{
    sample voxels = {.size = 0};
    put_voxels(&voxels, 'u', 2, 0, 100);
    for (int half = 0; half < 2; half++) {
        const size_t from = half ? 20 : 0, end = half ? voxels.size : 20;
        z_stream stream = {0};
        assert_int_equal(deflateInit2(&stream, 9, Z_DEFLATED, 31, 8, Z_DEFAULT_STRATEGY), Z_OK);
        stream.next_in = voxels.data + from;
        stream.avail_in = (uInt)(end - from);
        stream.next_out = to->data + to->size;
        stream.avail_out = (uInt)(sizeof to->data - to->size);
        assert_int_equal(deflate(&stream, Z_FINISH), Z_STREAM_END);
        to->size += stream.total_out;
        deflateEnd(&stream);
    }
}

static void members_of_gzip_follow_each_other(void **state)
{
    sample made = {.size = 0};
    (void)state;
    put_text(&made, NRRD "type: ushort\nendian: little\nencoding: gzip\n\n");
    put_two_members(&made);
    expect_volume(ms_volume_parse_nrrd, &made, "sample", 100);
    made.size -= 3;
    expect_volume_refused(ms_volume_parse_nrrd, &made, MS_ERR_FORMAT, "its packed data are cut at byte");
    made.size += 3;
    put_two_members(&made); /* the same voxels once more */
    expect_volume_refused(ms_volume_parse_nrrd, &made, MS_ERR_FORMAT, "hold more bytes than the 48");
    made.size -= 1;
    put_text(&made, "\x1f");
    expect_volume_refused(ms_volume_parse_nrrd, &made, MS_ERR_FORMAT, "hold more bytes than the 48");
}

/* Of zlib the sum ends the stream, of gzip the sum and the length: 4 bytes each. */
static void a_wrong_checksum_is_named(void **state)
{
    static const struct {
        const char *header;
        volume_parser *parse;
        int window_bits;
        size_t from_end;
    } cases[] = {
        {MHD "CompressedData = True\nElementType = MET_USHORT\nElementDataFile = LOCAL\n", ms_volume_parse_mhd, 15, 1},
        {NRRD "type: ushort\nendian: little\nencoding: gzip\n\n", ms_volume_parse_nrrd, 31, 5},
        {NRRD "type: ushort\nendian: little\nencoding: gzip\n\n", ms_volume_parse_nrrd, 31, 1},
    };
    (void)state;
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        sample made = {.size = 0};
        put_text(&made, cases[c].header);
        put_packed(&made, cases[c].window_bits);
        expect_volume(cases[c].parse, &made, "sample", 100);
        made.data[made.size - cases[c].from_end] ^= 1;
        expect_volume_refused(cases[c].parse, &made, MS_ERR_FORMAT, "do not match the checksum");
        made.data[made.size - cases[c].from_end] ^= 1;
        made.size -= 2; /* without the end of it */
        expect_volume_refused(cases[c].parse, &made, MS_ERR_FORMAT, "its packed data are cut at byte");
    }
}

static void packed_data_of_another_size_are_refused(void **state)
{
    static const char *const sizes[] = {"sizes: 2 3 3\n", "sizes: 2 3 5\n"};
    static const char *const messages[] = {"hold more bytes than the 36", "hold fewer bytes than the 60"};
    (void)state;
    for (int i = 0; i < 2; i++) {
        sample made = {.size = 0};
        put_text(&made, "NRRD0005\ntype: ushort\ndimension: 3\nendian: little\nencoding: gz\n");
        put_text(&made, sizes[i]);
        put_text(&made, "\n");
        put_packed(&made, 31);
        expect_volume_refused(ms_volume_parse_nrrd, &made, MS_ERR_FORMAT, messages[i]);
    }
}

#define NRRD_END "type: uchar\nencoding: raw\n\n"

static void malformed_headers_of_nrrd_are_refused_with_their_line(void **state)
{
    static const refused_header cases[] = {
        {"NRRD\n", "line 1: 'NRRD' stands where NRRD0001 to NRRD0005 belongs"},
        {"NRRD0006\n", "line 1: 'NRRD0006' stands where"},
        {"NRRD0004", "the file ends before the empty line that ends the header"},
        {NRRD "junk\n", "line 4: 'junk' is no line 'field: value'"},
        {"NRRD0004\ndimension: 2\n", "line 2: the array has 2 axes and a volume has 3"},
        {"NRRD0004\nsizes: 2 3\n", "line 2: 3 integers are needed but there are 2"},
        {"NRRD0004\nsizes: 2 3 4 5\n", "line 2: '5' stands where the line should end"},
        {NRRD "type: block\n", "line 4: the type 'block' is not read"},
        {NRRD "encoding: bzip2\n", "line 4: the encoding 'bzip2' is not read, only raw, gzip and text are"},
        {NRRD "endian: middle\n", "line 4: 'middle' stands where little or big belongs"},
        {NRRD "spacings: 1 1 x\n", "line 4: the spacing has 'x' where a number belongs"},
        {NRRD "space directions: (1,0,0) (0,1,0)\n", "line 4: a vector (x,y,z) of three numbers belongs here"},
        {NRRD "space directions: (1,0) (0,1) (0,0)\n", "line 4: a vector (x,y,z) of three numbers belongs here"},
        {NRRD "space directions: (1,0.01,0) (0,1,0) (0,0,1)\n", "line 4: the axes are oblique; resample"},
        {NRRD "space directions: (0,1,0) (0,1,0) (0,0,1)\n", "line 4: the axes are oblique"},
        {NRRD "space directions: (0,0,0) (0,1,0) (0,0,1)\n", "line 4: the axes are oblique"},
        {NRRD "space directions: (1,0,nan) (0,1,0) (0,0,1)\n", "line 4: the axes are oblique"},
        {NRRD "space directions: (1,0,0) (0,1,0) (0,0,1) none\n", "line 4: 'none' stands where the line should end"},
        {NRRD "space origin: 1 2 3\n", "line 4: a vector (x,y,z) of three numbers belongs here"},
        {NRRD "kinds: RGB-color domain domain\n", "line 4: an axis of the kind 'RGB-color' is none of space"},
        {NRRD "axis mins: 0 0 0\n", "line 4: axis mins and maxs are not read"},
        {NRRD "line skip: -1\n", "line 4: the line skip is negative"},
        {NRRD "byte skip: -2\n", "line 4: the byte skip is less than -1"},
        {NRRD "data file: LIST\na.raw\n", "line 4: a volume in one file per slice is not read"},
        {NRRD "data file: a%d.raw 1 4 1\n", "line 4: a volume in one file per slice is not read"},
        {NRRD "data file:\n", "line 4: no data file is named"},
        {NRRD "\n", "the header ends without 'type'"},
        {NRRD "type: uchar\n\n", "the header ends without 'encoding'"},
        {NRRD "type: short\nencoding: raw\n\n", "the header ends without 'endian'"},
        {"NRRD0004\nsizes: 2 3 4\n" NRRD_END, "the header ends without 'dimension'"},
        {"NRRD0004\ndimension: 3\n" NRRD_END, "the header ends without 'sizes'"},
        {NRRD "type: uchar\nencoding: gzip\nbyte skip: 1\n\n", "a byte skip is read only with the encoding raw"},
    };
    (void)state;
    expect_headers_refused(ms_volume_parse_nrrd, cases, sizeof cases / sizeof cases[0]);
}

#define ONES " 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1"

static void bad_data_of_nrrd_are_refused(void **state)
{
    static const refused_header cases[] = {
        {NRRD "byte skip: 2\n" NRRD_END "1", "2 bytes are to be skipped and there are 1"},
        {NRRD NRRD_END "12345678901234567890123", "(24) but there are 23 bytes of data"},
        {NRRD NRRD_END "1234567890123456789012345", "(24) but there are 25 bytes of data"},
        {NRRD "type: uchar\nencoding: text\n\n1 2 3", "(24) but there are 5 bytes of data"},
        {NRRD "type: uchar\nencoding: text\n\n100000000000000000000 1 1 1" ONES, "which is no label"},
        {NRRD "type: uchar\nencoding: text\n\n1000000000 1000000000 1000000000 100000000000000" ONES,
         "voxel (1, 1, 0) holds 1e+14, which is no label"},
        {NRRD "type: uchar\nencoding: text\n\n1000000000 1000000000 1000000000 1000000000 1000000000",
         "its data end after 5 of 24 values"},
        {NRRD "type: uchar\nencoding: text\n\n1 2 3 4 5 6 x 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1",
         "value 7 of its data is 'x' and no number"},
    };
    (void)state;
    expect_headers_refused(ms_volume_parse_nrrd, cases, sizeof cases / sizeof cases[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_type_of_mhd_is_read),
        cmocka_unit_test(fields_of_mhd_are_understood),
        cmocka_unit_test(packed_mhd_is_read),
        cmocka_unit_test(malformed_mhd_is_refused_with_its_line),
        cmocka_unit_test(every_type_of_nrrd_is_read),
        cmocka_unit_test(every_encoding_of_nrrd_is_read),
        cmocka_unit_test(members_of_gzip_follow_each_other),
        cmocka_unit_test(a_wrong_checksum_is_named),
        cmocka_unit_test(packed_data_of_another_size_are_refused),
        cmocka_unit_test(malformed_headers_of_nrrd_are_refused_with_their_line),
        cmocka_unit_test(bad_data_of_nrrd_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
