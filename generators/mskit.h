/**
 * mskit: multi-sphere clumps for discrete element simulation.
 *
 * All of the library but what stands under dev/, which is for authors of generators and promises nothing. A short way
 * from a file to a clump is ms_generate_file.
 *
 * Everywhere: out-parameters come first, the message of a failure last (it may be NULL); inputs are borrowed for the
 * call; what a function gives is the caller's, freed by the ms_..._free beside it; a zeroed struct is the neutral one.
 * Nothing prints, exits or aborts, and there is no global state: threads may use the library side by side.
 */
#ifndef MSKIT_H
#define MSKIT_H

#include "base/ms_error.h"
#include "base/ms_file.h"
#include "base/ms_sphere.h"
#include "base/ms_version.h"
#include "clump/formats/ms_read.h"
#include "clump/formats/ms_scene_script.h"
#include "clump/formats/ms_write.h"
#include "clump/ms_carriers.h"
#include "clump/ms_clump.h"
#include "clump/ms_density.h"
#include "clump/ms_equal_volume.h"
#include "clump/ms_particle.h"
#include "clump/ms_template.h"
#include "clump/ms_union.h"
#include "contact/ms_contact.h"
#include "contact/ms_envelope.h"
#include "contact/ms_factors.h"
#include "contact/ms_support.h"
#include "expect/ms_expect.h"
#include "measure/ms_descriptors.h"
#include "measure/ms_measure.h"
#include "measure/ms_metrics.h"
#include "mesh/formats/ms_mesh_read.h"
#include "mesh/formats/ms_mesh_write.h"
#include "mesh/ms_inertia.h"
#include "mesh/ms_mesh.h"
#include "mesh/ms_mesh_decimate.h"
#include "ms_allocate.h"
#include "ms_curve.h"
#include "ms_generate.h"
#include "ms_generator.h"
#include "ms_manifest.h"
#include "ms_option.h"
#include "ms_sieve.h"
#include "ms_stop.h"
#include "ms_templates.h"
#include "shape/ms_shape.h"
#include "volume/ms_components.h"
#include "volume/ms_labels.h"
#include "volume/ms_scan.h"
#include "volume/ms_volume.h"
#include "voxel/ms_grid.h"
#include "voxel/ms_solid.h"
#include "voxel/ms_target.h"
#include "voxel/ms_voxel_area.h"
#include "voxel/ms_voxelize.h"

#endif
