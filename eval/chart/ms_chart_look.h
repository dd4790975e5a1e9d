/** Colour, point and dash of a series, which may stay the same from chart to chart. */
#ifndef MS_CHART_LOOK_H
#define MS_CHART_LOOK_H

/** Of zeros: by the place of the series in its chart. */
typedef struct ms_chart_look {
    int family;  /* from 1: which colour, point and dash; MS_CHART_LOOK_OTHER: grey */
    int variant; /* 0 or more: another point and dash in the same colour */
} ms_chart_look;

enum { MS_CHART_LOOK_OTHER = -1 };

/** From 1 to the number of points less 1: which variant a text goes with, as the options of a method. */
int ms_chart_look_variant(const char *text);

/** The next variant; from the last one the first. */
ms_chart_look ms_chart_look_next(ms_chart_look look);

/** The colour: a hash and six hexadecimal digits. @param place of the series in its chart, from 0 */
const char *ms_chart_look_colour(ms_chart_look look, int place);

/** Gnuplot's type of points. */
int ms_chart_look_point(ms_chart_look look, int place);

/** Gnuplot's type of dashes. */
int ms_chart_look_dash(ms_chart_look look, int place);

#endif
