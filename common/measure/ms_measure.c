#include "ms_measure.h"

#include "base/ms_choice.h"
#include "ms_metrics.h"

/* What gives the value of each: of a field of ms_score both, of one of ms_metrics alone the second. */
#define SCORE_GETTERS(name)                                 \
    static double score_##name(const ms_score *score)       \
    {                                                       \
        return score->name;                                 \
    }                                                       \
    static double metrics_##name(const ms_metrics *metrics) \
    {                                                       \
        return metrics->score.name;                         \
    }
#define METRICS_GETTER(name)                                \
    static double metrics_##name(const ms_metrics *metrics) \
    {                                                       \
        return (double)metrics->name;                       \
    }
#define GETTERS_GOAL SCORE_GETTERS
#define GETTERS_UNION SCORE_GETTERS
#define GETTERS_SURFACE METRICS_GETTER
#define GETTERS_NORMAL METRICS_GETTER
#define GETTERS_SPHERES METRICS_GETTER
#define GETTERS_COUNT METRICS_GETTER
#define GETTERS_DESCRIPTOR METRICS_GETTER
#define GETTERS(kind, CODE, name, ...) GETTERS_##kind(name)
MS_MEASURE_LIST(GETTERS)

#define OF_SCORE_GOAL(name) score_##name
#define OF_SCORE_UNION(name) score_##name
#define OF_SCORE_SURFACE(name) NULL
#define OF_SCORE_NORMAL(name) NULL
#define OF_SCORE_SPHERES(name) NULL
#define OF_SCORE_COUNT(name) NULL
#define OF_SCORE_DESCRIPTOR(name) NULL

#define ROW(kind_, CODE, name_, better_, digits_, curve_, unit_, axis_, label_, source_, help_, compare_, stability_) \
    [MS_MEASURE_##CODE] = {.name = #name_,                                                                            \
                           .kind = MS_MEASURE_KIND_##kind_,                                                           \
                           .better = MS_BETTER_##better_,                                                             \
                           .digits = digits_,                                                                         \
                           .curve = curve_,                                                                           \
                           .unit = unit_,                                                                             \
                           .axis = axis_,                                                                             \
                           .label = label_,                                                                           \
                           .source = source_,                                                                         \
                           .help = help_,                                                                             \
                           .in_compare = compare_,                                                                    \
                           .in_stability = stability_,                                                                \
                           .of_score = OF_SCORE_##kind_(name_),                                                       \
                           .of_metrics = metrics_##name_},

const ms_measure ms_measures[] = {MS_MEASURE_LIST(ROW){0}};

const char *ms_measure_column(const ms_measure *measure, const char *published)
{
    return published ? published : measure->name;
}

int ms_measure_is_of_score(const ms_measure *measure)
{
    return measure->of_score != NULL;
}

int ms_measure_is_reached(const ms_measure *measure, double value, double asked)
{
    return measure->better == MS_BETTER_MORE ? value >= asked : value <= asked;
}

const ms_measure *ms_measure_find_goal(const char *name, ms_error *err)
{
    ms_choice choice = {.typed = name};
    for (const ms_measure *m = ms_measures; m->name; m++) {
        if (m->kind == MS_MEASURE_KIND_GOAL && ms_choice_offer(&choice, m->name)) {
            return m;
        }
    }
    ms_choice_fail(&choice, err, "there is no measure '%s'", name);
    return NULL;
}
