/** What several tests need: targets made from the shapes that ship with the project. */
#ifndef TEST_SUPPORT_H
#define TEST_SUPPORT_H

/* clang-format off */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
/* clang-format on */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "shape/ms_shape.h"
#include "voxel/ms_target.h"

/* cmocka 1.1.5 compares floats only. */
#define assert_close(a, b, tolerance)                                                            \
    do {                                                                                         \
        const double close_a = (a), close_b = (b);                                               \
        if (!(fabs(close_a - close_b) <= (tolerance))) {                                         \
            fail_msg("%s is %.17g, not %.17g +- %g", #a, close_a, close_b, (double)(tolerance)); \
        }                                                                                        \
    } while (0)

/** A mesh of a kind; parameters not named in "name=value name=value" keep their defaults. */
static inline void make_shape(ms_mesh *mesh, const char *kind_name, const char *parameters)
{
    ms_error err;
    double value[MS_SHAPE_MAX_PARAMETERS];
    char padded[256];
    snprintf(padded, sizeof padded, " %s", parameters);
    const ms_shape_kind *kind = ms_shape_find(kind_name, &err);
    assert_non_null(kind);
    for (size_t p = 0; kind->parameters[p].name; p++) {
        char key[40];
        snprintf(key, sizeof key, " %s=", kind->parameters[p].name);
        const char *at = strstr(padded, key);
        value[p] = at ? strtod(at + strlen(key), NULL) : kind->parameters[p].fallback;
    }
    if (ms_shape_make(mesh, kind, value, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
}

/** The target of a mesh with that many cells along the shortest side. */
static inline void make_target(ms_target *target, const ms_mesh *mesh, double cells, ms_voxel_rule rule)
{
    ms_error err;
    double lo[3], hi[3];
    ms_mesh_box(lo, hi, mesh);
    const double side = fmin(hi[0] - lo[0], fmin(hi[1] - lo[1], hi[2] - lo[2]));
    if (ms_target_from_mesh(target, mesh, 1, side / cells, rule, &err) != MS_OK) {
        fail_msg("%s", err.text);
    }
}

#endif
