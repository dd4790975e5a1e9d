/* Whole files: what is refused, and that a failed write leaves nothing behind. */
#include <dirent.h>
#include <sys/stat.h>
#include <unistd.h>

#include "support/reader_samples.h"

static char folder[64];

static int set_up(void **state)
{
    (void)state;
    make_folder(folder);
    return 0;
}

static int tear_down(void **state)
{
    char command[128];
    (void)state;
    snprintf(command, sizeof command, "rm -r -- %s", folder);
    return system(command);
}

static int count_files(void)
{
    int n = 0;
    DIR *dir = opendir(folder);
    assert_non_null(dir);
    for (struct dirent *entry = readdir(dir); entry; entry = readdir(dir)) {
        n += entry->d_name[0] != '.';
    }
    closedir(dir);
    return n;
}

static void read_back(const char *path, const char *wanted)
{
    ms_bytes bytes;
    assert_int_equal(ms_file_read(&bytes, path, NULL), MS_OK);
    assert_int_equal(bytes.size, strlen(wanted));
    assert_string_equal((const char *)bytes.data, wanted);
    ms_file_free(&bytes);
    assert_null(bytes.data);
    ms_file_free(NULL);
}

static ms_status write_text(const char *path, const char *text, ms_status end, ms_error *err)
{
    ms_output output;
    ms_status status = ms_output_open(&output, path, err);
    if (!status) {
        fputs(text, output.stream);
        status = ms_output_close(&output, end, err);
        assert_null(output.stream);
        assert_null(output.path);
    }
    return status;
}

static void a_file_is_written_and_read_back(void **state)
{
    char path[128];
    struct stat info;
    mode_t mask = umask(0027);
    (void)state;
    snprintf(path, sizeof path, "%s/a.csv", folder);
    assert_int_equal(write_text(path, "old", MS_OK, NULL), MS_OK);
    assert_int_equal(write_text(path, "x,y,z,r\n", MS_OK, NULL), MS_OK);
    umask(mask);
    read_back(path, "x,y,z,r\n");
    assert_int_equal(stat(path, &info), 0);
    assert_int_equal(info.st_mode & 0777, 0640);
    assert_int_equal(count_files(), 1);
}

static void a_failed_write_leaves_the_old_file(void **state)
{
    char path[128];
    ms_error err = {"what went wrong before"};
    (void)state;
    write_file(path, folder, "a.csv", "old", 3);
    assert_int_equal(write_text(path, "new", MS_ERR_SHAPE, &err), MS_ERR_SHAPE);
    assert_string_equal(err.text, "what went wrong before");
    read_back(path, "old");
    assert_int_equal(count_files(), 1);
}

static void two_writers_of_one_path_do_not_meet(void **state)
{
    char path[128];
    ms_output first;
    ms_output second;
    (void)state;
    snprintf(path, sizeof path, "%s/a.csv", folder);
    assert_int_equal(ms_output_open(&first, path, NULL), MS_OK);
    assert_int_equal(ms_output_open(&second, path, NULL), MS_OK);
    fputs("first", first.stream);
    fputs("second", second.stream);
    assert_int_equal(ms_output_close(&first, MS_OK, NULL), MS_OK);
    read_back(path, "first");
    assert_int_equal(ms_output_close(&second, MS_OK, NULL), MS_OK);
    read_back(path, "second");
    assert_int_equal(count_files(), 1);
}

/* As by a signal that ends the process; one of them has the place in the list of another that was closed. */
static void open_outputs_can_be_discarded(void **state)
{
    char path[128], other[128];
    ms_output output, done, more;
    ms_error err;
    (void)state;
    write_file(path, folder, "a.csv", "old", 3);
    snprintf(other, sizeof other, "%s/b.csv", folder);
    assert_int_equal(ms_output_open(&done, other, NULL), MS_OK);
    assert_int_equal(ms_output_open(&output, path, NULL), MS_OK);
    assert_int_equal(ms_output_close(&done, MS_OK, NULL), MS_OK);
    assert_int_equal(ms_output_open(&more, other, NULL), MS_OK);
    assert_int_equal(count_files(), 4);
    ms_output_discard_all();
    assert_int_equal(count_files(), 2);
    assert_int_equal(ms_output_close(&output, MS_OK, &err), MS_ERR_IO);
    assert_non_null(strstr(err.text, "could not be written"));
    assert_int_equal(ms_output_close(&more, MS_ERR_SHAPE, NULL), MS_ERR_SHAPE);
    read_back(path, "old");
    assert_int_equal(write_text(path, "new", MS_OK, NULL), MS_OK);
    assert_int_equal(unlink(other), 0);
    assert_int_equal(count_files(), 1);
}

static void a_link_stays_a_link(void **state)
{
    char path[128];
    char link[128];
    struct stat info;
    (void)state;
    write_file(path, folder, "a.csv", "old", 3);
    snprintf(link, sizeof link, "%s/link.csv", folder);
    assert_int_equal(symlink("a.csv", link), 0);
    assert_int_equal(write_text(link, "new", MS_OK, NULL), MS_OK);
    read_back(path, "new");
    assert_int_equal(lstat(link, &info), 0);
    assert_true(S_ISLNK(info.st_mode));
}

static void a_device_is_written_to_and_stays_one(void **state)
{
    struct stat info;
    ms_error err;
    (void)state;
    assert_int_equal(write_text("/dev/null", "x", MS_OK, NULL), MS_OK);
    assert_int_equal(stat("/dev/null", &info), 0);
    assert_true(S_ISCHR(info.st_mode));
    if (stat("/dev/full", &info) == 0) {
        assert_int_equal(write_text("/dev/full", "x", MS_OK, &err), MS_ERR_IO);
        expect_message(&err, "/dev/full: could not be written: No space left on device");
    }
}

static void what_cannot_be_written_is_refused(void **state)
{
    char path[128];
    ms_error err;
    (void)state;
    assert_int_equal(write_text(folder, "x", MS_OK, &err), MS_ERR_IO);
    expect_message(&err, "is a folder");
    snprintf(path, sizeof path, "%s/none/a.csv", folder);
    assert_int_equal(write_text(path, "x", MS_OK, &err), MS_ERR_IO);
    expect_message(&err, "none/a.csv: cannot be written: No such file or directory; check that its folder exists");
    assert_int_equal(write_text("", "x", MS_OK, &err), MS_ERR_IO);
    expect_message(&err, "empty");
    assert_int_equal(count_files(), 0);
}

/* The folder vanishes while the file is written. */
static void a_failed_rename_is_told(void **state)
{
    char sub[128];
    char path[160];
    char moved[128];
    ms_error err;
    ms_output output;
    (void)state;
    snprintf(sub, sizeof sub, "%s/sub", folder);
    snprintf(moved, sizeof moved, "%s/moved", folder);
    snprintf(path, sizeof path, "%s/a.csv", sub);
    assert_int_equal(mkdir(sub, 0777), 0);
    assert_int_equal(ms_output_open(&output, path, NULL), MS_OK);
    assert_int_equal(rename(sub, moved), 0);
    assert_int_equal(ms_output_close(&output, MS_OK, &err), MS_ERR_IO);
    expect_message(&err, "a.csv: could not be written: No such file or directory");
}

static void a_write_protected_file_is_not_replaced(void **state)
{
    char path[128];
    ms_error err;
    (void)state;
    write_file(path, folder, "a.csv", "old", 3);
    assert_int_equal(chmod(path, 0444), 0);
    if (access(path, W_OK) == 0) {
        print_message("skipped: this user may write to protected files\n");
        skip();
    }
    assert_int_equal(write_text(path, "new", MS_OK, &err), MS_ERR_IO);
    expect_message(&err, "cannot be written over");
    read_back(path, "old");
}

static void closing_what_is_not_open_does_nothing(void **state)
{
    ms_output output = {0};
    (void)state;
    assert_int_equal(ms_output_close(&output, MS_ERR_ARG, NULL), MS_ERR_ARG);
}

static void standard_output_stays_open(void **state)
{
    ms_output output;
    (void)state;
    assert_int_equal(ms_output_open(&output, "-", NULL), MS_OK);
    assert_ptr_equal(output.stream, stdout);
    assert_null(output.temporary);
    assert_int_equal(ms_output_close(&output, MS_OK, NULL), MS_OK);
    assert_true(fflush(stdout) == 0);
}

static void what_cannot_be_read_is_refused(void **state)
{
    char path[128];
    ms_bytes bytes;
    ms_error err;
    (void)state;
    snprintf(path, sizeof path, "%s/none.stl", folder);
    assert_int_equal(ms_file_read(&bytes, path, &err), MS_ERR_IO);
    expect_message(&err, "none.stl: cannot be opened: No such file or directory");
    assert_int_equal(ms_file_read(&bytes, folder, &err), MS_ERR_IO);
    expect_message(&err, "is a folder");
    assert_int_equal(ms_file_read(&bytes, "/dev/null", &err), MS_ERR_IO);
    expect_message(&err, "is a device or a pipe");
    assert_int_equal(ms_file_read(&bytes, "", &err), MS_ERR_IO);
    expect_message(&err, "the name of the file to read is empty");
    assert_int_equal(mkfifo(path, 0600), 0);
    assert_int_equal(ms_file_read(&bytes, path, &err), MS_ERR_IO);
    expect_message(&err, "is a device or a pipe");
    assert_null(bytes.data);
    assert_int_equal(bytes.size, 0);
}

static void an_empty_file_has_no_bytes(void **state)
{
    char path[128];
    (void)state;
    write_file(path, folder, "empty", "", 0);
    read_back(path, "");
}

/* Published test vectors of FNV-1a. */
static void checksums_are_fnv(void **state)
{
    ms_bytes bytes = copy_bytes("foobar", 6);
    (void)state;
    assert_true(ms_file_checksum(&bytes) == UINT64_C(0x85944171f73967e8));
    bytes.size = 0;
    assert_true(ms_file_checksum(&bytes) == UINT64_C(0xcbf29ce484222325));
    ms_file_free(&bytes);
}

static void a_base_name_is_behind_the_last_slash(void **state)
{
    static const char *const cases[][2] = {{"a", "a"}, {"./a.b", "a.b"}, {"/x/y.z/c", "c"}, {"x/", ""}, {"", ""}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        assert_string_equal(ms_file_base_name(cases[i][0]), cases[i][1]);
    }
}

static void endings_are_lower_case(void **state)
{
    static const char *const cases[][2] = {{"a.STL", "stl"},
                                           {"x/b.tar.Gz", "gz"},
                                           {"a.b/c", ""},
                                           {"none", ""},
                                           {"dot.", ""},
                                           {"a.123456789012345", "123456789012345"},
                                           {"a.1234567890123456", ""},
                                           {"", ""}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char ending[16];
        ms_file_ending(ending, cases[i][0]);
        assert_string_equal(ending, cases[i][1]);
    }
}

#define WITH_FOLDER(test) cmocka_unit_test_setup_teardown(test, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        WITH_FOLDER(a_file_is_written_and_read_back),
        WITH_FOLDER(a_failed_write_leaves_the_old_file),
        WITH_FOLDER(two_writers_of_one_path_do_not_meet),
        WITH_FOLDER(open_outputs_can_be_discarded),
        WITH_FOLDER(a_link_stays_a_link),
        cmocka_unit_test(a_device_is_written_to_and_stays_one),
        WITH_FOLDER(what_cannot_be_written_is_refused),
        WITH_FOLDER(a_failed_rename_is_told),
        WITH_FOLDER(a_write_protected_file_is_not_replaced),
        cmocka_unit_test(closing_what_is_not_open_does_nothing),
        cmocka_unit_test(standard_output_stays_open),
        WITH_FOLDER(what_cannot_be_read_is_refused),
        WITH_FOLDER(an_empty_file_has_no_bytes),
        cmocka_unit_test(checksums_are_fnv),
        cmocka_unit_test(a_base_name_is_behind_the_last_slash),
        cmocka_unit_test(endings_are_lower_case),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
