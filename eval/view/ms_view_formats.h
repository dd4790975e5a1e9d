/** What shows a clump instead of holding it: formats beside those of ms_write.h, written by the same functions. */
#ifndef MS_VIEW_FORMATS_H
#define MS_VIEW_FORMATS_H

#include "clump/formats/ms_write.h"
#include "measure/ms_metrics.h"

/** What they take beside the clump, as `more` of ms_content. All borrowed; zeros where it is not known. */
typedef struct ms_view_about {
    const char *shape;         /* path of the target */
    const ms_target *target;   /* with its distance structures; NULL: the clump alone */
    const ms_metrics *metrics; /* against it */
    int ordered;               /* the first k spheres are a clump, too */
    double h;                  /* lattice constant of surfaces */
    size_t max_points;         /* of that lattice */
    int argc;                  /* the command, without the program's name */
    char *const *argv;
    char *remark; /* room for MS_WRITE_REMARK, empty; NULL: not wanted. Takes what a surface does not show, if that is a
                   * piece or 2 % of the volume */
} ms_view_about;

/** html, stl, ply, obj, vtp, png; a row with a NULL name ends them. */
extern const ms_format ms_view_formats[];

/** The format of that name, of these or of ms_formats; NULL with a message that lists both. */
const ms_format *ms_view_format_find(const char *name, ms_error *err);

/** Likewise of a path, csv for "-". */
const ms_format *ms_view_format_of_path(const char *path, ms_error *err);

/** Nonzero if it is one of ms_view_formats. */
int ms_view_format_is(const ms_format *format);

#endif
