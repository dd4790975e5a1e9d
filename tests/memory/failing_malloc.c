/*
 * Preloaded into a program, makes its k-th allocation fail: FAIL_AT=k, counted from 1. FAIL_COUNT=FILE gets how many
 * there were. Of glibc, whose own functions stand behind.
 */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *old, size_t size);

static long fail_at, allocations;

__attribute__((constructor)) static void read_environment(void)
{
    const char *text = getenv("FAIL_AT");
    fail_at = text ? atol(text) : 0;
    allocations = 0;        /* those of the loader do not count */
    unsetenv("LD_PRELOAD"); /* programs that this one starts are not meant */
}

__attribute__((destructor)) static void write_count(void)
{
    const char *path = getenv("FAIL_COUNT");
    FILE *file = path ? fopen(path, "w") : NULL;
    if (file) {
        fprintf(file, "%ld\n", allocations);
        fclose(file);
    }
}

static int fails(void)
{
    const int yes = __atomic_add_fetch(&allocations, 1, __ATOMIC_RELAXED) == fail_at;
    errno = yes ? ENOMEM : errno;
    return yes;
}

void *malloc(size_t size)
{
    return fails() ? NULL : __libc_malloc(size);
}

void *calloc(size_t count, size_t size)
{
    return fails() ? NULL : __libc_calloc(count, size);
}

void *realloc(void *old, size_t size)
{
    return fails() ? NULL : __libc_realloc(old, size);
}
