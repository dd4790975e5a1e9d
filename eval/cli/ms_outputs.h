/** Where a command writes its clump: flags, checks before the work, the writing. */
#ifndef MS_OUTPUTS_H
#define MS_OUTPUTS_H

#include "clump/formats/ms_write.h"
#include "ms_files.h"
#include "ms_flags.h"

enum { MS_OUTPUTS_MAX = 16, MS_OUTPUTS_FORMATS = 16 };

/* clang-format off */
#define MS_OUTPUT_FLAGS \
    {"output", 'o', "FILE", "the clump, its format by its ending, - for standard output; may be repeated"}, \
    {"format", 0, "F", "format of the outputs whatever their ending; repeated: one file of each, by default names"}, \
    {"all-formats", 0, "DIR", "one file of each format that can hold the clump into this folder"}
/* clang-format on */

/** One file to write. */
typedef struct ms_output_file {
    const char *path;
    char *owned; /* the same, if it was made here */
    const ms_format *format;
} ms_output_file;

/** A zeroed struct has no outputs. */
typedef struct ms_outputs {
    const char *asked[MS_OUTPUTS_MAX];
    size_t n_asked;
    const ms_format *format[MS_OUTPUTS_FORMATS];
    size_t n_formats;
    const char *folder;
    ms_output_file file[MS_OUTPUTS_MAX + MS_OUTPUTS_FORMATS];
    size_t n_files;
} ms_outputs;

/** Takes a flag if it is one of MS_OUTPUT_FLAGS. @param[out] taken 0 if it is not */
ms_status ms_outputs_flag(int *taken, ms_outputs *outputs, const char *name, const char *value, ms_error *err);

/**
 * Decides which files are written; may be done again, when more is known.
 *
 * @param source   the file that the clump comes from; its name without folder and ending begins default names
 * @param behind   follows it in default names, as "-mss"
 * @param need     what is known of the clump: formats that need more are refused, or left out of --all-formats
 * @param defaults nonzero: without any output, csv, json and vtk are written; zero: some output must be given
 * @return MS_OK; MS_ERR_ARG; MS_ERR_NOMEM. ms_outputs_free in any case
 */
ms_status ms_outputs_resolve(ms_outputs *outputs, const char *source, const char *behind, ms_need need, int defaults,
                             ms_error *err);

/** Number of files that show the clump (ms_view_formats.h) and take ms_view_about. */
int ms_outputs_shown(const ms_outputs *outputs);

/** Number of files that go to standard output. */
int ms_outputs_to_stdout(const ms_outputs *outputs);

/** Adds all files to those that the command writes; makes the folder of --all-formats. @return MS_OK; MS_ERR_ARG for a
 * name that a script cannot hold; MS_ERR_IO; MS_ERR_NOMEM */
ms_status ms_outputs_list(ms_files *files, const ms_outputs *outputs, ms_error *err);

/**
 * Holds the files of a command that reads a clump and writes it elsewhere against each other, and tries the outputs,
 * before the work.
 *
 * @param frame  another clump that is read; NULL for none
 * @param target a shape that is read; NULL for none
 * @return as ms_outputs_list and ms_files_check
 */
ms_status ms_outputs_check(const ms_outputs *outputs, const char *clump, const char *frame, const char *target,
                           ms_error *err);

/** Where the clump goes if none of the outputs can be written for lack of masses: as CSV, behind the first output's
  * name or to standard output. The caller frees it; NULL without memory. */
char *ms_outputs_spare(const ms_outputs *outputs, ms_error *err);

/**
 * Writes all files and says so on `words`. What is off where an engine sums the spheres, which of all formats cannot
 * hold this clump, and which take masses that are not known, goes to stderr; if no file is left for lack of masses,
 * ms_outputs_spare takes the spheres, so that they are not lost. A file that cannot be written does not keep back those
 * after it.
 *
 * @return MS_OK; as ms_write_clump of the first file that failed
 */
ms_status ms_outputs_write(const ms_outputs *outputs, const ms_content *content, FILE *words, ms_error *err);

void ms_outputs_free(ms_outputs *outputs);

#endif
