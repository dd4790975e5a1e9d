/** The options of a generator: one table gives defaults, range checks, help and docs. */
#ifndef MS_OPTION_H
#define MS_OPTION_H

#include <stddef.h>

#include "base/ms_error.h"
#include "clump/ms_clump.h"

MS_C_BEGIN

typedef enum ms_option_type {
    MS_OPTION_FLAG, /* on or off */
    MS_OPTION_INTEGER,
    MS_OPTION_REAL,
    MS_OPTION_CHOICE, /* one of the words in `choices`; the value is its rank */
    MS_OPTION_PLANE,  /* a,b,c,d; may be given more than once; collected in ms_settings */
    MS_OPTION_CLUMP   /* a file of spheres (ms_read_clump), read into ms_settings; once per generator */
} ms_option_type;

/** One option. A table of them ends with a NULL name. */
typedef struct ms_option {
    const char *name;
    ms_option_type type;
    double fallback, min, max; /* of FLAG, INTEGER, REAL; of CHOICE only the fallback */
    const char *choices;       /* of CHOICE: "first|second" */
    const char *unit;          /* "voxels", ...; NULL without */
    const char *help;          /* one sentence */
} ms_option;

/** The values of a generator's options, in the order of its table. */
typedef struct ms_settings {
    const ms_option *options; /* borrowed */
    double *value;
    size_t n_planes;
    double (*plane)[4]; /* (a, b, c) of unit length, d scaled with it: a x + b y + c z = d */
    ms_clump clump;     /* empty unless given */
    char *clump_file;   /* from which it was read; NULL unless given */
} ms_settings;

/** All defaults. @param[out] settings the caller frees it @return MS_OK; MS_ERR_NOMEM */
MS_API ms_status ms_option_settings_init(ms_settings *settings, const ms_option *options, ms_error *err);

/**
 * Sets one option from text.
 *
 * @param text as the user wrote it; NULL or "" switches a FLAG on
 * @return MS_OK; MS_ERR_ARG for an unknown name (the message lists the names) or a bad value
 *         (the message gives type and range); as ms_read_clump; MS_ERR_NOMEM
 */
MS_API ms_status ms_option_settings_set(ms_settings *settings, const char *name, const char *text, ms_error *err);

/** The option of that name; NULL if there is none. */
MS_API const ms_option *ms_option_find(const ms_option *options, const char *name);

/** Writes the value as text that ms_option_settings_set reads; planes as "n planes", a clump as "n spheres". */
MS_API void ms_option_settings_text(char *out, size_t size, const ms_settings *settings, size_t option);

MS_API void ms_option_settings_free(ms_settings *settings);

MS_C_END

#endif
