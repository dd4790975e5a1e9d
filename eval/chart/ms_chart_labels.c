#include <math.h>
#include <string.h>

#include "ms_chart_parts.h"

/* Pixels: half a point, half the height of a label and half the width of one of its letters, and room around. */
static const double POINT = 7, HALF_HEIGHT = 6.5, HALF_LETTER = 3.6, ROOM = 2;

/* A box, or half a side of it. */
typedef struct label_box {
    double x, y, half_width, half_height;
} label_box;

static double part_of(const ms_chart_range *r, int is_log, double value)
{
    return is_log ? log(value / r->lo) / log(r->hi / r->lo) : (value - r->lo) / (r->hi - r->lo);
}

/* Where a point is drawn, pixels from the lower left corner of the box. */
static void find_pixel(double out[2], const ms_chart_frame *f, const ms_chart *chart, double x, double y)
{
    out[0] = f->width * part_of(&f->x, chart->x_log, x);
    out[1] = f->height * part_of(&f->y, chart->y_log, y);
}

static int do_boxes_meet(const label_box *a, const label_box *b)
{
    return fabs(a->x - b->x) < a->half_width + b->half_width && fabs(a->y - b->y) < a->half_height + b->half_height;
}

/* The line from p to q, cut by the slabs of the box one after the other (Liang and Barsky 1984). */
static int does_line_meet(const label_box *box, const double p[2], const double q[2])
{
    const double middle[2] = {box->x, box->y}, half[2] = {box->half_width, box->half_height};
    double from = 0, to = 1;
    for (int a = 0; a < 2; a++) {
        const double along = q[a] - p[a], lo = middle[a] - half[a] - p[a], hi = middle[a] + half[a] - p[a];
        if (along == 0) {
            if (lo > 0 || hi < 0) {
                return 0;
            }
            continue;
        }
        from = fmax(from, fmin(lo / along, hi / along));
        to = fmin(to, fmax(lo / along, hi / along));
    }
    return from <= to;
}

static int meets_step(const label_box *box, ms_chart_style style, const double p[2], const double q[2])
{
    const double corner[2] = {q[0], p[1]};
    if (style == MS_CHART_FRONT) {
        return does_line_meet(box, p, corner) || does_line_meet(box, corner, q);
    }
    return style != MS_CHART_POINTS && style != MS_CHART_BAND && does_line_meet(box, p, q);
}

static int meets_bar(const label_box *box, const ms_chart_frame *f, const ms_chart *chart, const ms_chart_point *point)
{
    double lo[2], hi[2];
    if (!(point->high > 0)) {
        return 0;
    }
    find_pixel(lo, f, chart, point->low, ms_chart_parts_height(chart, point));
    find_pixel(hi, f, chart, point->high, ms_chart_parts_height(chart, point));
    return does_line_meet(box, lo, hi);
}

static int meets_series(const label_box *box, const ms_chart_frame *f, const ms_chart *chart, const ms_chart_series *s)
{
    const int is_marked = s->style == MS_CHART_CURVE || s->style == MS_CHART_POINTS;
    double before[2];
    int begun = 0;
    for (size_t p = 0; p < s->count; p++) {
        double at[2];
        if (!ms_chart_parts_has_place(chart, s, &s->point[p])) {
            continue;
        }
        find_pixel(at, f, chart, s->point[p].x, ms_chart_parts_height(chart, &s->point[p]));
        const label_box mark = {at[0], at[1], POINT, POINT};
        const double left[2] = {0, at[1]}, right[2] = {f->width, at[1]};
        if ((is_marked && do_boxes_meet(box, &mark)) || (begun && meets_step(box, s->style, before, at)) ||
            (s->style == MS_CHART_LEVEL && does_line_meet(box, left, right)) ||
            meets_bar(box, f, chart, &s->point[p])) {
            return 1;
        }
        memcpy(before, at, sizeof before);
        begun = s->style != MS_CHART_LEVEL;
    }
    return 0;
}

/* Whether a label may stand there. */
static int is_free(const label_box *box, const ms_chart_frame *f, const ms_chart *chart, const ms_chart_place *place,
                   size_t count)
{
    if (box->x < box->half_width || box->x > f->width - box->half_width || box->y < box->half_height ||
        box->y > f->height - box->half_height) {
        return 0;
    }
    for (size_t k = 0; k < count; k++) {
        const label_box other = {place[k].x * f->width, place[k].y * f->height,
                                 HALF_LETTER * (double)strlen(place[k].text) + ROOM, HALF_HEIGHT};
        if (do_boxes_meet(box, &other)) {
            return 0;
        }
    }
    for (size_t s = 0; s < chart->n_series; s++) {
        if (meets_series(box, f, chart, &chart->series[s])) {
            return 0;
        }
    }
    return 1;
}

/* Above, below, to the sides, then aslant; at first close by. Zero if there is no room. */
static int find_place(ms_chart_place *found, const ms_chart_frame *f, const ms_chart *chart, const double at[2],
                      const ms_chart_place *place, size_t count)
{
    static const double WAY[8][2] = {{0, 1}, {0, -1}, {1, 0}, {-1, 0}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}};
    label_box box = {.half_width = HALF_LETTER * (double)strlen(found->text) + ROOM, .half_height = HALF_HEIGHT + ROOM};
    for (double from = POINT + 1; from < 3 * POINT; from += POINT / 2) {
        for (int w = 0; w < 8; w++) {
            box.x = at[0] + WAY[w][0] * (from + box.half_width);
            box.y = at[1] + WAY[w][1] * (from + box.half_height);
            if (is_free(&box, f, chart, place, count)) {
                found->x = box.x / f->width;
                found->y = box.y / f->height;
                return 1;
            }
        }
    }
    return 0;
}

/* Whether a point before it in the series, as good as at the same place, has the same label. */
static int is_labelled(const ms_chart_frame *f, const ms_chart *chart, const ms_chart_series *series, size_t p)
{
    double at[2], before[2];
    if (p == 0 || strcmp(series->point[p].label, series->point[p - 1].label) != 0 ||
        !ms_chart_parts_has_place(chart, series, &series->point[p - 1])) {
        return 0;
    }
    find_pixel(at, f, chart, series->point[p].x, ms_chart_parts_height(chart, &series->point[p]));
    find_pixel(before, f, chart, series->point[p - 1].x, ms_chart_parts_height(chart, &series->point[p - 1]));
    return hypot(at[0] - before[0], at[1] - before[1]) < 2 * POINT;
}

size_t ms_chart_labels_place(ms_chart_place *place, const ms_chart_frame *frame, const ms_chart *chart)
{
    size_t count = 0;
    for (size_t s = 0; s < chart->n_series; s++) {
        const ms_chart_series *series = &chart->series[s];
        for (size_t p = 0; p < series->count; p++) {
            const ms_chart_point *point = &series->point[p];
            double at[2];
            if (point->label[0] && series->style != MS_CHART_LEVEL && ms_chart_parts_has_place(chart, series, point) &&
                !is_labelled(frame, chart, series, p)) {
                place[count] = (ms_chart_place){.series = s, .text = point->label};
                find_pixel(at, frame, chart, point->x, ms_chart_parts_height(chart, point));
                count += (size_t)find_place(&place[count], frame, chart, at, place, count);
            }
        }
    }
    return count;
}
