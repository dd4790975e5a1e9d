/** What a generator works on: the shape, its voxels and its distance field, made once. */
#ifndef MS_TARGET_H
#define MS_TARGET_H

#include "mesh/ms_inertia.h"
#include "mesh/ms_mesh.h"
#include "ms_grid.h"
#include "ms_solid.h"
#include "ms_voxelize.h"
#include "volume/ms_volume.h"

MS_C_BEGIN

typedef struct ms_target {
    const ms_mesh *mesh;        /* borrowed; NULL for a volume */
    int closed;                 /* the mesh bounds a body; 1 for a volume */
    int overlapping;            /* the mesh passes through itself: part of it lies inside the body (ms_solid.h) */
    struct ms_closest *closest; /* nearest point on the mesh (ms_closest.h); NULL for a volume */
    ms_voxel_rule rule;         /* for the shape and for any union of spheres on its grid */
    ms_grid grid;               /* S, MSS eq. 5 */
    float *distance;            /* E, MSS eq. 8, in voxels */
    struct ms_signed_distance_store *signed_distance; /* what runs have needed of it (ms_signed_distance.h) */
    size_t voxels;                                    /* sum of S */
    ms_body body;                                     /* of a closed mesh by ms_solid_mesh, else of the voxels */
    int count_cut;                      /* nonzero: ms_metrics_compute counts coverage_cut, too; 0 unless set */
    size_t disagree;                    /* voxels on which the axes did not agree (open mesh) */
    size_t pieces;                      /* of a volume, ms_grid_pieces; 0 for a mesh */
    size_t largest_piece;               /* its voxels */
    struct ms_descriptors *descriptors; /* where ms_descriptors_add has put them; else NULL */
} ms_target;

/* S: 1, E: 4; a run, if it does not say: another field 4, first-cover index 2, flags 1. */
enum { MS_TARGET_OWN_BYTES = 5, MS_TARGET_METHOD_BYTES = 7 };
enum { MS_TARGET_BYTES_PER_VOXEL = MS_TARGET_OWN_BYTES + MS_TARGET_METHOD_BYTES };

/** Bytes that a run takes beyond the target's. */
typedef struct ms_target_need {
    double voxel;  /* for each voxel of the grid; 0: MS_TARGET_METHOD_BYTES */
    double square; /* for each square of the surface, a voxel's side wide: of cells and maxima by the surface */
} ms_target_need;

/**
 * Bytes that the grid, the fields of the target and a run take at their peak.
 *
 * @param squares area of the surface over that of a voxel's face
 * @param need    of the run (ms_generator_need)
 */
MS_API double ms_target_bytes(const double n[3], double squares, ms_target_need need);

/** The squares of a grid's outside: of the surface of a volume, of which only the box is known, a guess. */
MS_API double ms_target_box_squares(const double n[3]);

/** Three quarters of the machine's memory: how much a grid may take if no one says otherwise. */
MS_API double ms_target_default_bytes(void);

/**
 * Voxelises a mesh and computes its distance field.
 *
 * @param[out] target the caller frees it; empty on failure
 * @param      mesh   repaired (ms_mesh_repair); borrowed until ms_target_free
 * @param      closed nonzero: the mesh is closed; zero: take the majority of three axes
 * @param      h      lattice constant, in the mesh's unit
 * @return MS_OK; as ms_voxelize, ms_solid_mesh
 */
MS_API ms_status ms_target_from_mesh(ms_target *target, const ms_mesh *mesh, int closed, double h, ms_voxel_rule rule,
                                     ms_error *err);

/** As ms_target_from_mesh, with the lattice moved under the mesh (ms_voxelize_moved). @param shift voxels; NULL: not */
MS_API ms_status ms_target_from_mesh_moved(ms_target *target, const ms_mesh *mesh, int closed, double h,
                                           ms_voxel_rule rule, const double shift[3], ms_error *err);

/**
 * The box lo <= (i,j,k) < hi of the voxels of a label.
 *
 * @param[out] other another label in the volume, 0 if there is none; only sought for label 0
 * @param      label 0: any
 * @return 0 if no voxel has the label
 */
MS_API int ms_target_label_box(int lo[3], int hi[3], uint32_t *other, const ms_volume *volume, uint32_t label);

/**
 * Takes the voxels of one label of a volume, with a hull of background, on the volume's own
 * lattice.
 *
 * @param label 0: every labelled voxel, if the volume has one label only
 * @return MS_OK; MS_ERR_SHAPE without such voxels, or for label 0 and several labels; MS_ERR_NOMEM
 */
MS_API ms_status ms_target_from_volume(ms_target *target, const ms_volume *volume, uint32_t label, ms_error *err);

/**
 * The two steps of which ms_target_from_mesh and ms_target_from_volume consist, for who times or needs one
 * alone: everything but the distance field, and the distance field of a target that has its voxels.
 *
 * @return as the whole; on failure the target is empty
 */
MS_API ms_status ms_target_voxels_from_mesh(ms_target *target, const ms_mesh *mesh, int closed, double h,
                                            ms_voxel_rule rule, ms_error *err);
/** Of a mesh whose body is known; NULL: the mesh is open. */
MS_API ms_status ms_target_voxels_from_solid(ms_target *target, const ms_mesh *mesh, const ms_solid *solid, double h,
                                             ms_voxel_rule rule, ms_error *err);
MS_API ms_status ms_target_voxels_from_volume(ms_target *target, const ms_volume *volume, uint32_t label,
                                              ms_error *err);
MS_API ms_status ms_target_add_distance(ms_target *target, ms_error *err);

/**
 * What the voxels hold more than the body of the mesh, relative to it; negative if less. 0
 * where the voxels are the body: for an open mesh or a volume.
 */
MS_API double ms_target_misfit(const ms_target *target);

/** Radius of the ball of the target's volume, in the mesh's unit. */
MS_API double ms_target_equivalent_radius(const ms_target *target);

MS_API void ms_target_free(ms_target *target);

MS_C_END

#endif
