/** What the scripts of LAMMPS share. Private to the writers of formats. */
#ifndef MS_LAMMPS_H
#define MS_LAMMPS_H

#include <stdio.h>

#include "clump/ms_packing.h"

/** The command `molecule clump` with a template of each kind, in its scale; the line is not ended. */
void ms_lammps_molecules(FILE *stream, const ms_packing *mixture);

/** Carriers, which are of type 2, are to meet no other sphere; walls know no types. */
void ms_lammps_exclude_carriers(FILE *stream);

#endif
