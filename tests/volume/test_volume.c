/* Volume files by their paths: the shared volumes, the broken inputs, and data files beside a header. */
#include <sys/stat.h>
#include <unistd.h>

#include "support/volume_samples.h"
#include "volume/ms_scan.h"

static void expect_refused(const char *path, ms_status status, const char *message)
{
    ms_volume volume;
    ms_error err = {{0}};
    assert_int_equal(ms_volume_read(&volume, path, SIZE_MAX, &err), status);
    expect_message(&err, path);
    expect_message(&err, message);
    assert_null(volume.label);
}

static void what_is_no_volume_file_is_refused(void **state)
{
    char folder[64];
    char path[128];
    (void)state;
    make_folder(folder);
    expect_refused("a.vox", MS_ERR_FORMAT, "volumes are read from .npy, .mhd, .mha, .nrrd, .nhdr, .tif,");
    expect_refused("none/a.npy", MS_ERR_IO, "cannot be opened: No such file or directory");
    write_file(path, folder, "empty.nrrd", "", 0);
    expect_refused(path, MS_ERR_FORMAT, "is empty (0 bytes)");
    unlink(path);
    rmdir(folder);
    assert_true(ms_volume_is_volume_path("a.NPY") && ms_volume_is_volume_path("b/a.mha"));
    assert_true(ms_volume_is_volume_path("a.mhd") && ms_volume_is_volume_path("a.nhdr"));
    assert_true(ms_volume_is_volume_path("a.nii.GZ") && ms_volume_is_volume_path("a.b.tiff"));
    assert_true(ms_volume_is_volume_path("a.raw") && !ms_scan_has_header("a.raw") && !ms_scan_has_header("a.raw.gz"));
    assert_true(ms_scan_has_header("a.npy.gz") && ms_scan_has_header("a.nrrd"));
    assert_false(ms_volume_is_volume_path("a.gz") || ms_volume_is_volume_path("a.stl") ||
                 ms_volume_is_volume_path("a.mhd.gz") || ms_volume_is_volume_path("a.vol"));
    ms_volume_free(NULL);
}

/* The same voxels beside a header of either format. */
static void data_beside_a_header_are_read(void **state)
{
    static const char *const headers[][2] = {
        {"a.mhd", "NDims = 3\nDimSize = 2 3 4\nElementType = MET_UCHAR\nElementSpacing = .5 .5 .5\nOffset = 1 2 3\n"
                  "ElementDataFile = my voxels.raw\n"},
        {"a.nhdr", "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 3 4\nspacings: .5 .5 .5\nspace origin: (1,2,3)\n"
                   "encoding: raw\ndata file: my voxels.raw\n"},
        {"b.nhdr", "NRRD0001\ndatafile: ./my voxels.raw\ntype: uint8\ndimension: 3\nsizes: 2 3 4\nencoding: raw\n"
                   "space directions: (.5,0,0) (0,.5,0) (0,0,.5)\nspace origin: (1, 2, 3)\n\n"},
    };
    char folder[64];
    char raw[128];
    char path[128];
    sample voxels = {.size = 0};
    (void)state;
    make_folder(folder);
    put_voxels(&voxels, 'u', 1, 0, 100);
    for (int i = 0; i < 3; i++) {
        ms_volume volume;
        write_file(raw, folder, "my voxels.raw", voxels.data, voxels.size);
        write_file(path, folder, headers[i][0], headers[i][1], strlen(headers[i][1]));
        assert_int_equal(ms_volume_read(&volume, path, SIZE_MAX, NULL), MS_OK);
        assert_true(volume.n[0] == NX && volume.n[1] == NY && volume.n[2] == NZ && volume.spacing == 0.5);
        assert_true(volume.origin[0] == 1.0 && volume.origin[1] == 2.0 && volume.origin[2] == 3.0);
        assert_int_equal(volume.label[7], known_label(7, 100));
        ms_volume_free(&volume);
        assert_int_equal(ms_volume_read(&volume, path, N_VOXELS, NULL), MS_OK);
        ms_volume_free(&volume);
        assert_int_equal(ms_volume_read(&volume, path, N_VOXELS - 1, NULL), MS_ERR_LIMIT);
        assert_null(volume.label);
        write_file(raw, folder, "my voxels.raw", voxels.data, voxels.size - 1);
        expect_refused(path, MS_ERR_FORMAT, "23");
        unlink(raw);
        expect_refused(path, MS_ERR_IO, i == 2 ? "line 2: names a data file" : "my voxels.raw: cannot be opened");
        unlink(path);
    }
    rmdir(folder);
}

/* Writes a header with that data file and reads it. */
static ms_status read_with(const char *folder, const char *data_file, ms_error *err)
{
    char text[512], path[128];
    ms_volume volume;
    snprintf(text, sizeof text, "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 3 4\nencoding: raw\ndata file: %s\n",
             data_file);
    write_file(path, folder, "a.nhdr", text, strlen(text));
    const ms_status status = ms_volume_read(&volume, path, SIZE_MAX, err);
    ms_volume_free(&volume);
    unlink(path);
    return status;
}

/* In a folder with the folders `in` and `out`, each with the voxels, and links from `in`. */
static void data_files_stay_in_the_folder_of_the_header(void **state)
{
    char folder[64], in[96], sub[96], out[96], raw[128], here[128], below[128], link[128], twin[128], all[128];
    sample voxels = {.size = 0};
    ms_error err = {{0}};
    (void)state;
    make_folder(folder);
    put_voxels(&voxels, 'u', 1, 0, 100);
    snprintf(in, sizeof in, "%s/in", folder);
    snprintf(sub, sizeof sub, "%s/in/sub", folder);
    snprintf(out, sizeof out, "%s/inner", folder); /* begins as `in` does */
    assert_true(mkdir(in, 0700) == 0 && mkdir(sub, 0700) == 0 && mkdir(out, 0700) == 0);
    write_file(here, in, "v.raw", voxels.data, voxels.size);
    write_file(below, sub, "..v.raw", voxels.data, voxels.size);
    write_file(raw, out, "v.raw", voxels.data, voxels.size);
    snprintf(link, sizeof link, "%s/link.raw", in);
    snprintf(twin, sizeof twin, "%s/twin.raw", in);
    snprintf(all, sizeof all, "%s/all", in);
    assert_true(symlink("../inner/v.raw", link) == 0 && symlink("v.raw", twin) == 0 && symlink("../inner", all) == 0);
    const char *const allowed[] = {"v.raw", "./v.raw", "sub/..v.raw", "twin.raw", "sub//..v.raw"};
    const char *const refused[] = {"../inner/v.raw", raw, here, "sub/../v.raw", "..", "link.raw", "all/v.raw"};
    for (size_t f = 0; f < sizeof allowed / sizeof *allowed; f++) {
        if (read_with(in, allowed[f], &err) != MS_OK) {
            fail_msg("%s: %s", allowed[f], err.text);
        }
    }
    for (size_t f = 0; f < sizeof refused / sizeof *refused; f++) {
        if (read_with(in, refused[f], &err) != MS_ERR_FORMAT) {
            fail_msg("%s is read", refused[f]);
        }
        expect_message(&err, "a.nhdr: line 6: the data file '");
        expect_message(&err, "is not in the folder of the header");
    }
    const char *const files[] = {here, below, raw, link, twin, all};
    for (size_t f = 0; f < sizeof files / sizeof *files; f++) {
        assert_int_equal(unlink(files[f]), 0);
    }
    assert_true(rmdir(sub) == 0 && rmdir(in) == 0 && rmdir(out) == 0 && rmdir(folder) == 0);
}

static void shared_volumes_are_the_same(void **state)
{
    static const char *const endings[] = {"npy", "mhd", "nrrd"};
    uint64_t checksum[3];
    (void)state;
    for (int i = 0; i < 3; i++) {
        char name[64];
        char path[512];
        ms_volume volume;
        ms_error err = {{0}};
        uint32_t largest = 0;
        snprintf(name, sizeof name, "nmc_ct_labels.%s", endings[i]);
        shared_path(path, name);
        if (ms_volume_read(&volume, path, SIZE_MAX, &err) != MS_OK) {
            fail_msg("%s", err.text);
        }
        assert_true(volume.n[0] == 128 && volume.n[1] == 128 && volume.n[2] == 128 && volume.spacing == 1.0);
        size_t count = (size_t)128 * 128 * 128;
        for (size_t k = 0; k < count; k++) {
            largest = volume.label[k] > largest ? volume.label[k] : largest;
        }
        assert_int_equal(largest, 192);
        ms_bytes bytes = copy_bytes(volume.label, count * sizeof *volume.label);
        checksum[i] = ms_file_checksum(&bytes);
        ms_file_free(&bytes);
        ms_volume_free(&volume);
    }
    assert_true(checksum[0] == checksum[1] && checksum[0] == checksum[2]);
}

static void broken_shared_volumes_are_refused(void **state)
{
    static const struct {
        const char *name;
        ms_status status;
        const char *message;
    } broken[] = {
        {"bad/v1_all_background.npy", MS_ERR_SHAPE, "has no label: all 20 x 20 x 20 voxels are 0"},
        {"bad/v3_grey_float_nan.npy", MS_ERR_FORMAT, "which is no label"},
        {"bad/v4_truncated.npy", MS_ERR_FORMAT, "(16000) but there are 8872 bytes of data"},
        {"bad/v7_missing_raw.mhd", MS_ERR_IO, "does_not_exist.raw: cannot be opened: No such file or directory"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof broken / sizeof broken[0]; i++) {
        char path[512];
        shared_path(path, broken[i].name);
        expect_refused(path, broken[i].status, broken[i].message);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_no_volume_file_is_refused),           cmocka_unit_test(data_beside_a_header_are_read),
        cmocka_unit_test(data_files_stay_in_the_folder_of_the_header), cmocka_unit_test(shared_volumes_are_the_same),
        cmocka_unit_test(broken_shared_volumes_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
