/** Which of the whole numbers 0 to n - 1 lie between two places. Private. */
#ifndef MS_WINDOW_H
#define MS_WINDOW_H

/** The least whole number not below the value, from 0 to n. */
static inline int ms_window_first(double value, int n)
{
    if (!(value > 0)) {
        return 0;
    }
    return value >= n ? n : (int)value + ((int)value < value);
}

/** One more than the largest whole number not above the value, from 0 to n. */
static inline int ms_window_end(double value, int n)
{
    if (!(value >= 0)) {
        return 0;
    }
    return value >= n ? n : (int)value + 1;
}

#endif
