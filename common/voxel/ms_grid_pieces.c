/* Connected components by runs of voxels along x, joined as they are read (He, Chao & Suzuki 2008). */
#include <stdlib.h>

#include "ms_grid.h"

/* Voxels from to to-1 of a row. */
typedef struct span {
    int from, to;
    size_t parent; /* a span before it of the same piece; itself if it is the first */
} span;

typedef struct span_list {
    span *span;
    size_t n, room;
    size_t *first; /* of each row; one more for the end of the last */
} span_list;

static size_t find_first(span_list *list, size_t s)
{
    span *all = list->span;
    while (all[s].parent != s) {
        s = all[s].parent = all[all[s].parent].parent;
    }
    return s;
}

static void join_spans(span_list *list, size_t a, size_t b)
{
    const size_t p = find_first(list, a), q = find_first(list, b);
    list->span[p > q ? p : q].parent = p > q ? q : p;
}

/* Joins the spans of two neighbouring rows that touch, be it at a corner. */
static void join_rows(span_list *list, size_t row, size_t other)
{
    size_t a = list->first[row], b = list->first[other];
    const size_t a_end = list->n, b_end = list->first[other + 1];
    while (a < a_end && b < b_end) {
        const span *s = &list->span[a], *t = &list->span[b];
        if (s->from <= t->to && t->from <= s->to) {
            join_spans(list, a, b);
        }
        if (s->to < t->to) {
            a++;
        } else {
            b++;
        }
    }
}

static ms_status add_span(span_list *list, int from, int to, ms_error *err)
{
    if (list->n == list->room) {
        const size_t room = 2 * list->room + 1024;
        span *grown = realloc(list->span, room * sizeof *grown);
        if (!grown) {
            return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu runs of voxels; crop the volume", room);
        }
        list->span = grown;
        list->room = room;
    }
    list->span[list->n] = (span){from, to, list->n};
    list->n++;
    return MS_OK;
}

static ms_status add_row_spans(span_list *list, const uint8_t *inside, int n, ms_error *err)
{
    ms_status status = MS_OK;
    for (int i = 0; i < n && status == MS_OK; i++) {
        const int from = i;
        while (i < n && inside[i]) {
            i++;
        }
        status = i > from ? add_span(list, from, i, err) : MS_OK;
    }
    return status;
}

static ms_status list_spans(span_list *list, const ms_grid *grid, ms_error *err)
{
    const size_t ny = (size_t)grid->n[1], rows = ny * (size_t)grid->n[2];
    ms_status status = MS_OK;
    list->first = malloc((rows + 1) * sizeof *list->first);
    if (!list->first) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for %zu rows of voxels; crop the volume", rows);
    }
    for (size_t row = 0; row < rows && status == MS_OK; row++) {
        const size_t j = row % ny, k = row / ny;
        list->first[row] = list->n;
        status = add_row_spans(list, grid->inside + (size_t)grid->n[0] * row, grid->n[0], err);
        if (status == MS_OK && j > 0) {
            join_rows(list, row, row - 1);
        }
        for (int d = -1; d <= 1 && status == MS_OK && k > 0; d++) {
            if ((d >= 0 || j > 0) && (d <= 0 || j + 1 < ny)) {
                join_rows(list, row, row - ny + (size_t)d);
            }
        }
    }
    list->first[rows] = list->n;
    return status;
}

ms_status ms_grid_pieces(size_t *pieces, size_t *largest, const ms_grid *grid, ms_error *err)
{
    span_list list = {0};
    *pieces = *largest = 0;
    ms_status status = list_spans(&list, grid, err);
    size_t *voxels = status == MS_OK ? calloc(list.n + 1, sizeof *voxels) : NULL;
    if (status == MS_OK && !voxels) {
        status = ms_fail(err, MS_ERR_NOMEM, "no memory for the sizes of pieces; crop the volume");
    }
    for (size_t s = 0; s < list.n && status == MS_OK; s++) {
        const size_t first = find_first(&list, s);
        *pieces += first == s;
        voxels[first] += (size_t)(list.span[s].to - list.span[s].from);
        *largest = voxels[first] > *largest ? voxels[first] : *largest;
    }
    free(voxels);
    free(list.span);
    free(list.first);
    return status;
}
