/** Few of many candidates that make masses exact, by linear programmes. Private. */
#ifndef MS_CARRIERS_SEARCH_H
#define MS_CARRIERS_SEARCH_H

#include "ms_density.h"
#include "ms_mass_equations.h"

/**
 * @param[out] pick      indices of the candidates taken, n_spheres or more; the caller frees it; NULL for none
 * @param[out] all_do    nonzero: all candidates together do, though some of them may have less than the least mass
 * @param      e         of all spheres and, behind them, all candidates
 * @param      options   bounds of masses
 * @return MS_OK, also where none are found; MS_ERR_NOMEM; MS_ERR_LIMIT as ms_linear_program_apart
 */
ms_status ms_carriers_search(size_t **pick, size_t *picked, int *all_do, const ms_mass_equations *e, size_t n_spheres,
                             const ms_density_options *options, ms_error *err);

#endif
