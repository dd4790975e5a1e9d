#include "ms_hull.h"

#ifndef MS_HAVE_QHULL

#include <string.h>

int ms_hull_is_built(void)
{
    return 0;
}

ms_status ms_hull_build(ms_mesh *hull, const double (*point)[3], size_t count, ms_error *err)
{
    (void)point, (void)count;
    memset(hull, 0, sizeof *hull);
    return ms_fail(
        err, MS_ERR_ARG,
        "this mskit was built without qhull and cannot make a convex hull; install libqhull-dev and build it "
        "with -Dqhull=enabled");
}

#else

#include <libqhull_r/qhull_ra.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int ms_hull_is_built(void)
{
    return 1;
}

/* The corners of a facet as point numbers, counter-clockwise seen from outside: qhull's order says how they lie. */
static void read_facet(uint32_t corner[3], qhT *qh, const facetT *facet)
{
    const int is_turned = !facet->toporient != !qh_ORIENTclock;
    for (int c = 0; c < 3; c++) {
        const vertexT *vertex = SETelemt_(facet->vertices, is_turned ? 2 - c : c, vertexT);
        corner[c] = (uint32_t)qh_pointid(qh, vertex->point);
    }
}

/* The number of a point among those of the hull; a new one where it has none yet. */
static uint32_t number_of(uint32_t *number, ms_mesh *hull, const double (*point)[3], uint32_t which)
{
    if (number[which] == UINT32_MAX) {
        memcpy(hull->vertex[hull->n_vertices], point[which], sizeof *point);
        number[which] = (uint32_t)hull->n_vertices++;
    }
    return number[which];
}

/* Facets of qhull, all of them triangles by its option Qt, as a mesh. */
static ms_status copy_facets(ms_mesh *hull, qhT *qh, const double (*point)[3], size_t count, ms_error *err)
{
    const facetT *facet;
    uint32_t *number = malloc(count * sizeof *number);
    ms_status status = ms_mesh_alloc(hull, (size_t)qh->num_vertices, (size_t)qh->num_facets, err);
    if (!number && status == MS_OK) {
        ms_mesh_free(hull);
        status = ms_fail(err, MS_ERR_NOMEM, "no memory for the convex hull of %zu points", count);
    }
    if (status == MS_OK) {
        memset(number, 0xff, count * sizeof *number);
        hull->n_vertices = hull->n_triangles = 0;
        for (facet = qh->facet_list; facet && facet->next; facet = facet->next) {
            uint32_t corner[3];
            read_facet(corner, qh, facet);
            for (int c = 0; c < 3; c++) {
                hull->triangle[hull->n_triangles][c] = number_of(number, hull, point, corner[c]);
            }
            hull->n_triangles++;
        }
    }
    free(number);
    return status;
}

/* `own`: the points, which qhull may move about; `messages`: what it has to say goes there. */
static ms_status run_qhull(ms_mesh *hull, double (*own)[3], const double (*point)[3], size_t count, FILE *messages,
                           ms_error *err)
{
    static char COMMAND[] = "qhull Qt";
    qhT qh;
    int current, total;
    qh_zero(&qh, messages);
    const int code = qh_new_qhull(&qh, 3, (int)count, own[0], False, COMMAND, NULL, messages);
    const ms_status status =
        code == qh_ERRmem ? ms_fail(err, MS_ERR_NOMEM, "no memory for the convex hull of %zu points", count)
        : code != qh_ERRnone
            ? ms_fail(err, MS_ERR_SHAPE, "the %zu points have no convex hull (qhull, error %d): they span no volume",
                      count, code)
            : copy_facets(hull, &qh, point, count, err);
    qh_freeqhull(&qh, !qh_ALL);
    qh_memfreeshort(&qh, &current, &total);
    return status;
}

ms_status ms_hull_build(ms_mesh *hull, const double (*point)[3], size_t count, ms_error *err)
{
    memset(hull, 0, sizeof *hull);
    for (size_t p = 0; p < count; p++) {
        if (!isfinite(point[p][0]) || !isfinite(point[p][1]) || !isfinite(point[p][2])) {
            return ms_fail(err, MS_ERR_SHAPE, "point %zu is not finite, so that there is no convex hull", p + 1);
        }
    }
    if (count < 4) {
        return ms_fail(err, MS_ERR_SHAPE, "%zu points have no convex hull: it takes four", count);
    }
    if (count > INT_MAX) {
        return ms_fail(err, MS_ERR_LIMIT, "%zu points are more than qhull takes", count);
    }
    double(*own)[3] = malloc(count * sizeof *own);
    char *text = NULL;
    size_t length;
    FILE *messages = open_memstream(&text, &length); /* else it prints */
    ms_status status = MS_OK;
    if (own && messages) {
        memcpy(own, point, count * sizeof *own);
        status = run_qhull(hull, own, point, count, messages, err);
    } else {
        status = ms_fail(err, MS_ERR_NOMEM, "no memory for the convex hull of %zu points", count);
    }
    if (messages) {
        fclose(messages);
    }
    free(text);
    free(own);
    return status;
}

#endif
