/** Status codes and the one-sentence message that goes with a failure. */
#ifndef MS_ERROR_H
#define MS_ERROR_H

/* Public headers serve C++ too, as most DEM engines are written in it. */
#ifdef __cplusplus
#define MS_C_BEGIN extern "C" {
#define MS_C_END }
#else
#define MS_C_BEGIN
#define MS_C_END
#endif

/* What a public header declares, and nothing else, is a symbol of the shared library. */
#if defined(__GNUC__)
#define MS_API __attribute__((visibility("default")))
#else
#define MS_API
#endif

MS_C_BEGIN

/* The one list from which the codes and their texts are made. */
#define MS_STATUS_LIST(X)                        \
    X(MS_OK, "success")                          \
    X(MS_ERR_ARG, "invalid argument")            \
    X(MS_ERR_NOMEM, "out of memory")             \
    X(MS_ERR_IO, "cannot read or write")         \
    X(MS_ERR_FORMAT, "malformed file")           \
    X(MS_ERR_SHAPE, "the shape cannot be used")  \
    X(MS_ERR_LIMIT, "a limit would be exceeded") \
    X(MS_ERR_INTERRUPTED, "interrupted")

#define MS_STATUS_ENUM(code, text) code,
typedef enum ms_status { MS_STATUS_LIST(MS_STATUS_ENUM) } ms_status;
#undef MS_STATUS_ENUM

/** The message of a failure: one sentence that names the file, the place and what to do. */
typedef struct ms_error {
    char text[1024];
} ms_error;

/** The general text of a status code; never NULL. */
MS_API const char *ms_status_text(ms_status status);

#if defined(__GNUC__)
#define MS_PRINTF(format_at, first_at) __attribute__((format(printf, format_at, first_at)))
#else
#define MS_PRINTF(format_at, first_at)
#endif

/**
 * Writes a message and returns the status, so that a failure is one line:
 * `return ms_fail(err, MS_ERR_ARG, "extent %d is 0", axis);`
 * Who detects an error writes the message; who calls only hands it on.
 *
 * @param[out] err    may be NULL
 * @param      status what is returned
 * @param      format as printf; cut at the size of the message
 */
MS_API ms_status ms_fail(ms_error *err, ms_status status, const char *format, ...) MS_PRINTF(3, 4);

/** Adds a sentence to what a text says already, "; " between; cut at the size of the message. */
MS_API void ms_error_add(ms_error *text, const char *sentence);

MS_C_END

#endif
