/** A library for a powder: few grains with weights, and their sizes, that stand for many. */
#ifndef MS_LIBRARY_H
#define MS_LIBRARY_H

#include "ms_library_table.h"
#include "ms_population_choose.h"
#include "ms_population_distance.h"
#include "ms_population_split.h"

/** The energy distance takes the time of the square of the number of grains. */
enum { MS_LIBRARY_MAX_CLASSES = 100, MS_LIBRARY_MOST_FOR_ENERGY = 20000 };

/** What is asked for. */
typedef struct ms_library_goal {
    size_t k;       /* grains */
    int by_mass;    /* distributions by mass, otherwise by number */
    int with_size;  /* size is a descriptor, and each grain keeps its own; otherwise it goes by classes */
    size_t classes; /* of size */
    uint64_t seed;
} ms_library_goal;

/** Sizes: the masses of all classes are alike. */
typedef struct ms_library_class {
    double diameter; /* of the mean volume of its grains, in the unit of the source */
    double number;   /* share by number; their sum is 1 */
} ms_library_class;

/** How well a library stands for its table. */
typedef struct ms_library_distances {
    ms_population_distance grains; /* of the chosen grains to all */
    ms_population_distance clumps; /* of their clumps to all grains */
    ms_population_distance noise;  /* of samples of as many grains as there are: what chance does */
    double energy; /* energy distance of the chosen grains; NAN above MS_LIBRARY_MOST_FOR_ENERGY grains */
    ms_population_split split;
    double size, sieve; /* Kolmogorov-Smirnov distances of the equivalent diameter, by number and by mass */
    double of_all[3], of_library[3]; /* D5, D50, D95 by mass: diameters */
} ms_library_distances;

/** A library. */
typedef struct ms_library {
    const ms_library_table *table; /* borrowed */
    ms_library_goal goal;
    int first;                   /* descriptor: MS_LIBRARY_SIZE or the next */
    ms_population_choice choice; /* of grains of the table */
    ms_library_class *size;      /* goal.classes; NULL where size is a descriptor */
    ms_library_distances far;
} ms_library;

/**
 * Chooses it and says how good it is.
 *
 * @param[out] library the caller frees it; empty on failure
 * @return as ms_population_choose; MS_ERR_ARG for more classes than grains
 * Cost: about 10 s of one core for 20 of some hundred grains.
 */
ms_status ms_library_make(ms_library *library, const ms_library_table *table, const ms_library_goal *goal,
                          ms_error *err);

void ms_library_free(ms_library *library);

/** Share by number of a grain of the choice, of all particles. */
double ms_library_number(const ms_library *library, size_t chosen);

/** What all particles of that grain weigh, in some unit. */
double ms_library_mass(const ms_library *library, size_t chosen);

/** A choice that is this many times as far from the other half of the grains as the halves are from each other is
 * fitted to chance. */
#define MS_LIBRARY_OVERFITTED 1.2

/** Nonzero if that is so. */
int ms_library_is_overfitted(const ms_library *library);

#endif
