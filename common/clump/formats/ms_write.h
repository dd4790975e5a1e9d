/** Clump files: tables and pictures, and the templates of DEM engines. */
#ifndef MS_WRITE_H
#define MS_WRITE_H

#include <stdio.h>

#include "clump/ms_template.h"

MS_C_BEGIN

/** What is known of a clump when it is written. All borrowed. */
typedef struct ms_content {
    const ms_clump *clump;       /* masses are written where there are any; they need the particle */
    const ms_particle *particle; /* what the clump stands for; NULL where that is not known */
    const char *record;          /* a JSON object in text that says how the clump came about; NULL without */
    const void *more;            /* what formats of the caller's own take beside; NULL without */
    const char *name;            /* of the first file without its folder; ms_write_clump sets it */
} ms_content;

struct ms_bytes;
struct ms_packing;

/** One file of a format. */
typedef struct ms_part {
    const char *suffix; /* behind the path: "" for the first file, ".in" for a script, "/Clump/Clump.txt" in a folder */
    ms_status (*write)(FILE *stream, const ms_content *content, ms_error *err);
} ms_part;

/** One file of a whole packing, which names the templates. */
typedef struct ms_packing_part {
    const char *suffix; /* behind the path, as above */
    ms_status (*write)(FILE *stream, const struct ms_packing *packing, const char *name, ms_error *err);
} ms_packing_part;

/* What a format must know of a clump. */
typedef enum ms_need {
    MS_NEED_SPHERES,  /* written in the unit and frame of the shape */
    MS_NEED_PARTICLE, /* a template: in metres, from the centre of mass, along the principal axes */
    MS_NEED_MASSES    /* a template that also takes a mass for each sphere */
} ms_need;

/* What an engine sums, instead of taking mass, centre and inertia as they are given. */
typedef enum ms_sum {
    MS_SUM_NONE,
    MS_SUM_MASSES, /* solid spheres of the masses in the file */
    MS_SUM_VOLUMES /* solid spheres of the particle's density */
} ms_sum;

enum { MS_FORMAT_MAX_PARTS = 5, MS_FORMAT_MAX_PACKING = 4, MS_WRITE_REMARK = 512 };

/** A format of clump files. A table of them ends with a NULL name. */
typedef struct ms_format {
    const char *name;    /* what --format takes */
    const char *ending;  /* of its files */
    const char *summary; /* one line */
    ms_need need;

    /* The way back: on failure the caller frees what the clump holds; the particle stays zero where the file does not
     * know it. NULL: files of this format are not read. */
    ms_status (*read)(ms_clump *clump, ms_particle *particle, struct ms_bytes *bytes, const char *name, ms_error *err);

    ms_part part[MS_FORMAT_MAX_PARTS]; /* ends with a NULL suffix */

    ms_sum sum;
    const char *sums; /* when it does, in words */

    ms_packing_part packing[MS_FORMAT_MAX_PACKING]; /* ends with a NULL suffix; none: no packings are written */
    ms_packing_part mixture[MS_FORMAT_MAX_PACKING]; /* likewise, of mixtures */
    ms_packing_part scene;                          /* a script of a whole scene; without suffix there is none */
} ms_format;

MS_API extern const ms_format ms_formats[];

/** The format of that name, or NULL with a message that lists the names. */
MS_API const ms_format *ms_write_format_find(const char *name, ms_error *err);

/** The format that the ending of a path names, csv for "-"; or NULL with a message. */
MS_API const ms_format *ms_write_format_of_path(const char *path, ms_error *err);

/** Nonzero if its files stand in a folder of the path's name. */
MS_API int ms_write_format_is_folder(const ms_format *format);

/**
 * Can the format hold this clump?
 * @return MS_OK; MS_ERR_ARG where it needs what is not known
 */
MS_API ms_status ms_write_check(const ms_content *content, const ms_format *format, ms_error *err);

/**
 * What is off where the engine sums the spheres.
 *
 * @param[out] text a sentence with the errors of mass, centre and inertia; empty where there is nothing to say: the
 *                  engine does not sum, no error is above 1/1000, or the particle or the masses are not known
 * @return MS_OK; MS_ERR_NOMEM; as ms_particle_from_spheres
 */
MS_API ms_status ms_write_remark(char text[MS_WRITE_REMARK], const ms_content *content, const ms_format *format,
                                 ms_error *err);

/**
 * Names each file that ms_write_clump would write; none for "-".
 *
 * @param take told of each; `is_frame` of the frame beside a template, which is that of the clump, whatever the format
 * @return MS_OK; MS_ERR_NOMEM; as take
 */
MS_API ms_status ms_write_list(const char *path, const ms_format *format,
                               ms_status (*take)(void *context, const char *path, int is_frame, ms_error *err),
                               void *context, ms_error *err);

/** Can the script of LAMMPS or LIGGGHTS beside a template name it (ms_escape.h)? @return MS_OK; MS_ERR_ARG */
MS_API ms_status ms_write_check_path(const char *path, const ms_format *format, ms_error *err);

/**
 * Path of a file that is named after another one: FOLDER/STEM+BEHIND.ENDING, where STEM is of ms_file_stem. What the
 * name of a file, or the script of the format, cannot hold becomes '_'.
 *
 * @param folder "" for none
 * @param source the other file; "-" is "stdin"
 * @param behind what stands behind its stem, as "-2.5"; "" for nothing
 * @return the caller frees it; NULL without memory
 */
MS_API char *ms_write_path(const char *folder, const char *source, const char *behind, const ms_format *format);

/**
 * Writes a clump, each file under a temporary name that is then renamed. Beside a template stands the way back to the
 * frame of the shape, STEM.frame.json, where STEM is the path without its ending.
 *
 * @param path   "-" for standard output, which takes the first file of the format alone
 * @param format NULL: by the ending of the path; csv for standard output
 * @return MS_OK; MS_ERR_ARG for an unknown ending, a sphere so small beside its mass that its density is no number, or
 *         as ms_write_check; MS_ERR_IO; MS_ERR_NOMEM
 */
MS_API ms_status ms_write_clump(const ms_content *content, const char *path, const ms_format *format, ms_error *err);

MS_C_END

#endif
