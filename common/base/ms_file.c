/* madvise and MAP_ANONYMOUS are not in POSIX. */
#define _DEFAULT_SOURCE
#include "ms_file.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "ms_choice.h"

ms_status ms_file_fail_open(ms_error *err, const char *path, int why)
{
    if (ms_file_is_standard(path)) {
        return ms_fail(err, MS_ERR_IO, "standard input is not read here; name a file");
    }
    if (path[0] == '\0') {
        return ms_fail(err, MS_ERR_IO, "the name of the file to read is empty; name a file");
    }
    const ms_hint hint = why == ENOENT ? ms_choice_file_hint(path) : (ms_hint){""};
    return ms_fail(err, MS_ERR_IO, "%s: cannot be opened: %s%s", path, strerror(why),
                   hint.text[0] ? hint.text : "; check the path");
}

static ms_status read_all(ms_bytes *bytes, int fd, size_t size, const char *path, ms_error *err)
{
    if (size > SIZE_MAX - 1 || !(bytes->data = malloc(size + 1))) {
        return ms_fail(err, MS_ERR_NOMEM, "%s: no memory for its %zu bytes", path, size);
    }
    while (bytes->size < size) {
        ssize_t got = read(fd, bytes->data + bytes->size, size - bytes->size);
        if (got < 0 && errno == EINTR) {
            continue;
        }
        if (got < 0) {
            return ms_fail(err, MS_ERR_IO, "%s: cannot be read at byte %zu: %s", path, bytes->size, strerror(errno));
        }
        if (got == 0) {
            return ms_fail(
                err, MS_ERR_IO,
                "%s: became shorter while it was read (%zu of %zu bytes); try again when it is no longer written", path,
                bytes->size, size);
        }
        bytes->size += (size_t)got;
    }
    bytes->data[size] = 0;
    return MS_OK;
}

/* Opens a regular file. */
static ms_status open_regular(int *fd, size_t *size, const char *path, ms_error *err)
{
    struct stat info;
    /* Not to wait here for the writer of a pipe: it is refused below. */
    *fd = open(path, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (*fd < 0 || fstat(*fd, &info) != 0) {
        return ms_file_fail_open(err, path, errno);
    }
    if (S_ISDIR(info.st_mode)) {
        return ms_fail(err, MS_ERR_IO, "%s: is a folder; name a file in it", path);
    }
    if (!S_ISREG(info.st_mode)) {
        return ms_fail(err, MS_ERR_IO, "%s: is a device or a pipe; name a regular file, or - for standard input", path);
    }
    if ((uintmax_t)info.st_size > SIZE_MAX - 1) {
        return ms_fail(err, MS_ERR_NOMEM, "%s: is larger than the memory of this machine", path);
    }
    *size = (size_t)info.st_size;
    return MS_OK;
}

/* The file lies over the first pages of anonymous memory, of which one more byte than it has is 0. */
static ms_status map_all(ms_bytes *bytes, int fd, size_t size, const char *path, ms_error *err)
{
    const size_t page = (size_t)sysconf(_SC_PAGESIZE);
    const size_t room = size < SIZE_MAX - page ? (size / page + 1) * page : SIZE_MAX;
    void *at = mmap(NULL, room, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (at == MAP_FAILED) {
        return ms_fail(err, MS_ERR_NOMEM, "%s: no room to map its %zu bytes", path, size);
    }
    *bytes = (ms_bytes){.data = at, .size = size, .mapped = room};
    if (size > 0 && mmap(at, size, PROT_READ, MAP_PRIVATE | MAP_FIXED, fd, 0) == MAP_FAILED) {
        return ms_fail(err, MS_ERR_IO, "%s: cannot be mapped: %s", path, strerror(errno));
    }
    return MS_OK;
}

/* The first `most` bytes, or the whole mapped. */
static ms_status load_bytes(ms_bytes *bytes, const char *path, size_t most, int is_mapped, ms_error *err)
{
    size_t size = 0;
    int fd;
    *bytes = (ms_bytes){0};
    ms_status status = open_regular(&fd, &size, path, err);
    if (status == MS_OK) {
        status =
            is_mapped ? map_all(bytes, fd, size, path, err) : read_all(bytes, fd, size < most ? size : most, path, err);
    }
    if (fd >= 0) {
        close(fd);
    }
    if (status) {
        ms_file_free(bytes);
    }
    return status;
}

ms_status ms_file_read(ms_bytes *bytes, const char *path, ms_error *err)
{
    return load_bytes(bytes, path, SIZE_MAX, 0, err);
}

ms_status ms_file_read_start(ms_bytes *bytes, const char *path, size_t most, ms_error *err)
{
    return load_bytes(bytes, path, most, 0, err);
}

ms_status ms_file_map(ms_bytes *bytes, const char *path, ms_error *err)
{
    return load_bytes(bytes, path, SIZE_MAX, 1, err);
}

void ms_file_unneeded(const ms_bytes *bytes, size_t from, size_t size)
{
    enum { BESIDE = 1 << 16 }; /* what Linux maps together with a page that is touched (fault_around_bytes) */
    const size_t page = (size_t)sysconf(_SC_PAGESIZE);
    const size_t first = from > BESIDE ? (from - BESIDE) / page * page : 0;
    const size_t end = bytes->mapped - from > size + BESIDE ? from + size + BESIDE : bytes->mapped;
    if (bytes->mapped && from < bytes->mapped) {
        /* Advice: no harm where it is not taken; what is touched again is fetched again. */
        (void)madvise(bytes->data + first, end - first, MADV_DONTNEED);
    }
}

int ms_file_is_standard(const char *path)
{
    return strcmp(path, "-") == 0;
}

/* How many characters of a name are not its ending, .gz and what is before that included. */
static size_t measure_stem(const char *base, size_t length)
{
    for (int packed = 0; packed < 2; packed++) {
        size_t dot = length > 0 ? length - 1 : 0;
        while (dot > 0 && base[dot] != '.') {
            dot--;
        }
        const int is_packed = length - dot == 3 && strncmp(base + dot, ".gz", 3) == 0;
        length = dot > 0 ? dot : length;
        if (!is_packed) {
            break;
        }
    }
    return length;
}

const char *ms_file_stem(size_t *length, const char *path)
{
    const char *whole = ms_file_is_standard(path) ? "stdin" : path;
    size_t end = strlen(whole);
    while (end > 1 && whole[end - 1] == '/') { /* a folder of slices */
        end--;
    }
    size_t begin = end;
    while (begin > 0 && whole[begin - 1] != '/') {
        begin--;
    }
    *length = measure_stem(whole + begin, end - begin);
    return whole + begin;
}

const char *ms_file_name(const char *path)
{
    return ms_file_is_standard(path) ? "standard input" : path;
}

/* Room for a byte more than the 0 byte takes, so that the end is seen without growing once more. */
static ms_status grow(ms_bytes *bytes, size_t *room, size_t most, ms_error *err)
{
    enum { FIRST = 1 << 16 };
    const size_t wanted = !*room ? FIRST : *room < most / 2 ? 2 * *room : most;
    uint8_t *grown = realloc(bytes->data, wanted + 2);
    if (!grown) {
        return ms_fail(err, MS_ERR_NOMEM, "standard input: no memory for more than %zu bytes", bytes->size);
    }
    bytes->data = grown;
    *room = wanted;
    return MS_OK;
}

/* One read; whoever made the pipe may have said that it is not to be waited for. */
static ssize_t read_some(void *to, size_t count)
{
    struct pollfd wait = {.fd = STDIN_FILENO, .events = POLLIN};
    ssize_t got = read(STDIN_FILENO, to, count);
    while (got < 0 && (errno == EINTR || errno == EAGAIN)) {
        poll(&wait, 1, -1);
        got = read(STDIN_FILENO, to, count);
    }
    return got;
}

ms_status ms_file_read_standard(ms_bytes *bytes, size_t most, ms_error *err)
{
    ms_status status = MS_OK;
    size_t room = 0;
    ssize_t got = 1;
    *bytes = (ms_bytes){0};
    most = most < SIZE_MAX / 2 ? most : SIZE_MAX / 2;
    while (status == MS_OK && got > 0 && bytes->size <= most) {
        if (bytes->size >= room) {
            status = grow(bytes, &room, most, err);
        }
        got = status == MS_OK ? read_some(bytes->data + bytes->size, room + 1 - bytes->size) : 0;
        bytes->size += got > 0 ? (size_t)got : 0;
    }
    if (got < 0) {
        status =
            ms_fail(err, MS_ERR_IO, "standard input: cannot be read at byte %zu: %s", bytes->size, strerror(errno));
    } else if (status == MS_OK && bytes->size > most) {
        status =
            ms_fail(err, MS_ERR_LIMIT, "standard input: is longer than the %.3g MB allowed; save it and name the file",
                    (double)most / 1e6);
    }
    if (status != MS_OK) {
        ms_file_free(bytes);
        return status;
    }
    bytes->data[bytes->size] = 0;
    return MS_OK;
}

void ms_file_free(ms_bytes *bytes)
{
    if (bytes && bytes->mapped) {
        munmap(bytes->data, bytes->mapped);
    } else if (bytes) {
        free(bytes->data);
    }
    if (bytes) {
        *bytes = (ms_bytes){0};
    }
}

uint64_t ms_file_checksum_add(uint64_t hash, const ms_bytes *bytes)
{
    enum { STEP = 1 << 24 }; /* what a mapped file has in memory meanwhile */
    for (size_t i = 0; i < bytes->size; i++) {
        hash = (hash ^ bytes->data[i]) * UINT64_C(1099511628211);
        if (i % STEP == STEP - 1) {
            ms_file_unneeded(bytes, i + 1 - STEP, STEP);
        }
    }
    return hash;
}

uint64_t ms_file_checksum(const ms_bytes *bytes)
{
    return ms_file_checksum_add(MS_FILE_CHECKSUM, bytes);
}

/* Names of the temporary files that are open, for a signal that ends the process. A name that is taken out while a
 * signal reads is not freed. */
enum { MOST_NOTED = 2048 };
static _Atomic(char *) noted_files[MOST_NOTED];
static atomic_int readers;

/* @return one more than its place in the list; 0: there is none left, or no memory, and a signal leaves the file */
static size_t note_file(const char *path)
{
    char *name = strdup(path);
    for (size_t n = 0; name && n < MOST_NOTED; n++) {
        char *none = NULL;
        if (atomic_compare_exchange_strong(&noted_files[n], &none, name)) {
            return n + 1;
        }
    }
    free(name);
    return 0;
}

static void forget_file(size_t noted)
{
    char *name = noted > 0 ? atomic_exchange(&noted_files[noted - 1], NULL) : NULL;
    if (atomic_load(&readers) == 0) {
        free(name);
    }
}

void ms_output_discard_all(void)
{
    const int before = errno;
    atomic_fetch_add(&readers, 1);
    for (size_t n = 0; n < MOST_NOTED; n++) {
        const char *name = atomic_load(&noted_files[n]);
        if (name) {
            unlink(name);
        }
    }
    atomic_fetch_sub(&readers, 1);
    errno = before;
}

static void free_output(ms_output *output)
{
    forget_file(output->noted);
    free(output->path);
    free(output->temporary);
    *output = (ms_output){0};
}

/* A link is followed, so that the file it names is replaced and not the link. */
static ms_status resolve_link(char **resolved, const char *path, ms_error *err)
{
    struct stat info;
    const int is_link = lstat(path, &info) == 0 && S_ISLNK(info.st_mode);
    *resolved = is_link ? realpath(path, NULL) : strdup(path);
    if (is_link && !*resolved && errno != ENOMEM) {
        return ms_fail(err, MS_ERR_IO,
                       "%s: is a symbolic link that leads to no file: %s; remove it or name another file", path,
                       strerror(errno));
    }
    return *resolved ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "%s: no memory to write it", path);
}

/* Noted before it is there, so that no signal comes between. */
static int make_temporary(ms_output *output)
{
    output->noted = note_file(output->temporary);
    const int fd = open(output->temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666), why = errno;
    if (fd < 0) {
        forget_file(output->noted);
        output->noted = 0;
    }
    errno = why;
    return fd;
}

static ms_status open_temporary(ms_output *output, ms_error *err)
{
    size_t room = strlen(output->path) + 48;
    int fd = -1;
    output->temporary = malloc(room);
    if (!output->temporary) {
        return ms_fail(err, MS_ERR_NOMEM, "%s: no memory to write it", output->path);
    }
    /* The counter tells apart two writers in one process. */
    for (int attempt = 0; attempt < 100 && fd < 0; attempt++) {
        snprintf(output->temporary, room, "%s.%ld-%d.tmp", output->path, (long)getpid(), attempt);
        fd = make_temporary(output);
        if (fd < 0 && errno != EEXIST) {
            break;
        }
    }
    output->stream = fd < 0 ? NULL : fdopen(fd, "w");
    if (output->stream) {
        return MS_OK;
    }
    ms_status status =
        ms_fail(err, MS_ERR_IO, "%s: cannot be written: %s; check that its folder exists and may be written to",
                output->path, strerror(errno));
    if (fd >= 0) {
        close(fd);
        unlink(output->temporary);
    }
    return status;
}

/* A device or a pipe cannot be replaced by a file: it is written to directly. */
static ms_status open_special(ms_output *output, ms_error *err)
{
    output->stream = fopen(output->path, "w");
    if (!output->stream) {
        return ms_fail(err, MS_ERR_IO, "%s: cannot be written: %s", output->path, strerror(errno));
    }
    return MS_OK;
}

static ms_status open_path(ms_output *output, const char *path, ms_error *err)
{
    struct stat info;
    if (path[0] == '\0') {
        return ms_fail(
            err, MS_ERR_IO,
            "the name of the file to write is empty, and it cannot be written; name a file, or - for standard output");
    }
    const ms_status status = resolve_link(&output->path, path, err);
    if (status) {
        return status;
    }
    if (stat(output->path, &info) != 0) {
        return open_temporary(output, err);
    }
    if (S_ISDIR(info.st_mode)) {
        return ms_fail(err, MS_ERR_IO, "%s: is a folder; name a file in it", path);
    }
    if (!S_ISREG(info.st_mode)) {
        return open_special(output, err);
    }
    if (access(output->path, W_OK) != 0) {
        return ms_fail(err, MS_ERR_IO, "%s: cannot be written over: %s; choose another name", path, strerror(errno));
    }
    return open_temporary(output, err);
}

ms_status ms_output_open(ms_output *output, const char *path, ms_error *err)
{
    *output = (ms_output){0};
    if (ms_file_is_standard(path)) {
        output->stream = stdout;
        return MS_OK;
    }
    ms_status status = open_path(output, path, err);
    if (status) {
        free_output(output);
    }
    return status;
}

/* Nonzero if every byte has left the stream and, of a file, reached the disk; errno says why not. */
static int flush_stream(const ms_output *output)
{
    if (fflush(output->stream) != 0 || ferror(output->stream)) {
        return 0;
    }
    return !output->temporary || fsync(fileno(output->stream)) == 0;
}

ms_status ms_output_close(ms_output *output, ms_status status, ms_error *err)
{
    if (!output->stream) {
        free_output(output);
        return status;
    }
    errno = 0;
    int written = flush_stream(output);
    int why = errno;
    if (output->stream != stdout && fclose(output->stream) != 0 && written) {
        written = 0;
        why = errno;
    }
    if (!status && written && output->temporary && rename(output->temporary, output->path) != 0) {
        written = 0;
        why = errno;
    }
    if (output->temporary && (status || !written)) {
        unlink(output->temporary);
    }
    if (!status && !written) {
        status =
            ms_fail(err, MS_ERR_IO, "%s: could not be written: %s; is the disk full, or the size of files limited?",
                    output->path ? output->path : "standard output", why ? strerror(why) : "a write failed");
    }
    free_output(output);
    return status;
}

char *ms_file_beside(const char *path, const char *name, size_t length)
{
    const size_t folder = name[0] != '/' ? (size_t)(ms_file_base_name(path) - path) : 0;
    char *beside = malloc(folder + length + 1);
    if (beside) {
        memcpy(beside, path, folder);
        memcpy(beside + folder, name, length);
        beside[folder + length] = '\0';
    }
    return beside;
}

const char *ms_file_base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

void ms_file_ending(char out[16], const char *path)
{
    const char *dot = strrchr(ms_file_base_name(path), '.');
    out[0] = '\0';
    if (!dot || strlen(dot + 1) >= 16) {
        return;
    }
    size_t i = 0;
    for (; dot[i + 1]; i++) {
        out[i] = (char)tolower((unsigned char)dot[i + 1]);
    }
    out[i] = '\0';
}
