#include "ms_library_report.h"

#include <math.h>

#include "cli/ms_report.h"

static void print_distances(FILE *stream, const ms_library *l)
{
    const ms_library_distances *far = &l->far;
    fprintf(stream, "%-21s %9s %9s %9s\n", "distance", "library", "clumps", "chance");
    for (int d = l->first; d < MS_LIBRARY_DESCRIPTORS; d++) {
        const int at = d - l->first;
        fprintf(stream, "%-21s %9.3f %9.3f %9.3f\n", ms_library_descriptors[d], far->grains.ks[at], far->clumps.ks[at],
                far->noise.ks[at]);
    }
    fprintf(stream, "%-21s %9.3f %9.3f %9.3f\n", "largest", far->grains.largest, far->clumps.largest,
            far->noise.largest);
    fprintf(stream, "%-21s %9.3f %9.3f %9.3f\n", "correlations", far->grains.correlation, far->clumps.correlation,
            far->noise.correlation);
}

static void print_split(FILE *stream, const ms_library *l)
{
    const ms_population_split *split = &l->far.split;
    if (isnan(split->choice)) {
        fprintf(stream, "over-fitted?          half of %zu grains is fewer than %zu: not known\n", l->table->count,
                l->goal.k);
        return;
    }
    fprintf(stream,
            "over-fitted?          %s: chosen from half the grains, %.3f from the other half; the halves %.3f\n",
            ms_library_is_overfitted(l) ? "yes" : "no", split->choice, split->halves);
}

void ms_library_report_print(FILE *stream, const ms_library *l, const ms_library_written *written, const char *folder)
{
    const ms_library_distances *far = &l->far;
    fprintf(stream, "%zu of %zu grains, by %s", l->goal.k, l->table->count, l->goal.by_mass ? "mass" : "number");
    if (l->table->without + l->table->unmeasured > 0) {
        fprintf(stream, "; not chosen from: %zu without a clump, %zu without all descriptors", l->table->without,
                l->table->unmeasured);
    }
    fputs("\n\n", stream);
    print_distances(stream, l);
    if (isnan(far->energy)) {
        fprintf(stream, "energy distance       not told of more than %d grains\n", MS_LIBRARY_MOST_FOR_ENERGY);
    } else {
        fprintf(stream, "energy distance       %9.4f\n", far->energy);
    }
    fprintf(stream, "size, by number       %9.3f\nsieve curve, by mass  %9.3f\n", far->size, far->sieve);
    fprintf(stream, "D5, D50, D95 by mass  %.4g, %.4g, %.4g; of the library %.4g, %.4g, %.4g\n", far->of_all[0],
            far->of_all[1], far->of_all[2], far->of_library[0], far->of_library[1], far->of_library[2]);
    print_split(stream, l);
    fprintf(stream, "\nwrote %s/library.csv%s%s%s%s\n", folder, l->size ? ", sizes.csv" : "",
            written->scene ? ", scene.csv" : "", written->scripts[0] ? ", " : "", written->scripts);
    if (!written->scene) {
        fprintf(stream,
                "no scene.csv: it takes grains that are meshes, found from here by the paths in grains.csv, and has a "
                "row for each in each class of size, %d at most\n",
                MS_LIBRARY_MAX_ROWS);
    }
    if (!written->scripts[0]) {
        fputs("no script of an engine: it takes a run with --density and the engine's --format\n", stream);
    }
}

static json_t *distance_json(const ms_library *l, const ms_population_distance *distance)
{
    json_t *object = json_object();
    for (int d = l->first; d < MS_LIBRARY_DESCRIPTORS; d++) {
        json_object_set_new(object, ms_library_descriptors[d], ms_report_number(distance->ks[d - l->first]));
    }
    const int failed = json_object_set_new(object, "largest", ms_report_number(distance->largest)) |
                       json_object_set_new(object, "correlation", ms_report_number(distance->correlation));
    return ms_report_whole(object, failed);
}

json_t *ms_library_report_json(const ms_library *l, const ms_library_written *written)
{
    const ms_library_distances *far = &l->far;
    return json_pack(
        "{s:I,s:I,s:I,s:I,s:s,s:b,s:o,s:o,s:o,s:o,s:o,s:o,s:[o,o,o],s:[o,o,o],s:o,s:o,s:b,s:s,s:b}", "chosen",
        (json_int_t)l->goal.k, "grains", (json_int_t)l->table->count, "without_clump", (json_int_t)l->table->without,
        "without_descriptors", (json_int_t)l->table->unmeasured, "by", l->goal.by_mass ? "mass" : "number", "with_size",
        l->goal.with_size, "distance", distance_json(l, &far->grains), "distance_of_clumps",
        distance_json(l, &far->clumps), "distance_of_chance", distance_json(l, &far->noise), "energy_distance",
        ms_report_number(far->energy), "size_distance", ms_report_number(far->size), "sieve_distance",
        ms_report_number(far->sieve), "d5_d50_d95", ms_report_number(far->of_all[0]), ms_report_number(far->of_all[1]),
        ms_report_number(far->of_all[2]), "d5_d50_d95_of_library", ms_report_number(far->of_library[0]),
        ms_report_number(far->of_library[1]), ms_report_number(far->of_library[2]), "split_distance",
        ms_report_number(far->split.choice), "halves_distance", ms_report_number(far->split.halves), "over_fitted",
        ms_library_is_overfitted(l), "scripts", written->scripts, "scene", written->scene);
}
