#include "ms_chart_look.h"

#include <stdint.h>

/* Colours that stay apart for the colour blind (Okabe and Ito 2008); dashes and points do it without. */
static const char *const COLOUR[] = {"#000000", "#d55e00", "#0072b2", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"};
static const char *const GREY = "#777777";
static const int POINT[] = {7, 4, 8, 10, 12, 5, 9, 6, 1, 2, 3};

enum { COLOURS = sizeof COLOUR / sizeof *COLOUR, POINTS = sizeof POINT / sizeof *POINT, DASHES = 5 };

/* By FNV-1a. */
int ms_chart_look_variant(const char *text)
{
    uint32_t sum = 2166136261u;
    for (; *text; text++) {
        sum = (sum ^ (uint8_t)*text) * 16777619u;
    }
    return 1 + (int)(sum % (POINTS - 1));
}

ms_chart_look ms_chart_look_next(ms_chart_look look)
{
    return (ms_chart_look){look.family, look.variant % (POINTS - 1) + 1};
}

/* Which of the points and dashes, from 0. */
static int find_mark(ms_chart_look look, int place)
{
    const int first = look.family > 0 ? look.family - 1 : look.family == 0 ? place : 0;
    return first + look.variant;
}

const char *ms_chart_look_colour(ms_chart_look look, int place)
{
    return look.family == MS_CHART_LOOK_OTHER ? GREY : COLOUR[(look.family > 0 ? look.family - 1 : place) % COLOURS];
}

int ms_chart_look_point(ms_chart_look look, int place)
{
    return POINT[find_mark(look, place) % POINTS];
}

int ms_chart_look_dash(ms_chart_look look, int place)
{
    return find_mark(look, place) % DASHES + 1;
}
