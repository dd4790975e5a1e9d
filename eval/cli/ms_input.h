/** From a path on the command line to a target: reading, mending, voxelising. */
#ifndef MS_INPUT_H
#define MS_INPUT_H

#include "mesh/ms_mesh.h"
#include "ms_flags.h"
#include "ms_input_volume.h"
#include "voxel/ms_solid.h"
#include "voxel/ms_target.h"

enum { MS_INPUT_MAX_THREADS = 1024 };

/** From this part of the volume on it is said that voxels do not hold it. */
#define MS_INPUT_MISFIT 0.01

/** Flags about the shape and its grid, common to several commands; see MS_INPUT_FLAGS. */
typedef struct ms_input_flags {
    double cells, deq, voxel_size; /* 0: not given */
    double max_voxels;             /* 0: not given */
    ms_mesh_mending mending;
    ms_voxel_rule rule;
    int allow_open;
    ms_scan_options scan; /* of a volume */
    int cut;              /* nonzero: coverage_cut is counted */
    uint32_t label;
    double max_memory;   /* bytes */
    ms_target_need need; /* what the method takes beyond the target (ms_generator_need) */
    int threads;         /* 0: all */
    int quiet;           /* nonzero: the size of the grid is not said */
} ms_input_flags;

/* clang-format off */
#define MS_INPUT_MENDING_FLAGS \
    {"weld", 0, "SHARE", "join corners of open edges within this part of the longest side (1e-7); 0: none"}, \
    {"fill-holes", 0, "EDGES", "fill holes of at most so many edges (0: none)"}, \
    {"drop-bodies", 0, "SHARE", "drop pieces that hold less than this part of the largest (0: none)"}

#define MS_INPUT_RULE_FLAG \
    {"rule", 0, "half|centre", "a voxel is inside if more than half of it is, or if its centre is (half)"}

#define MS_INPUT_CUT_FLAG \
    {"cut", 0, NULL, "count coverage_cut, too, which takes about as long as the other measures"}

#define MS_INPUT_FLAGS \
    {"cells", 0, "N", "cells along the shortest side of the shape's box (100)"}, \
    {"deq", 0, "N", "voxel size = diameter of the ball of equal volume / N"}, \
    {"voxel-size", 0, "H", "voxel size in the shape's unit"}, \
    {"max-voxels", 0, "N", "voxels of the whole grid at most, as 500k or 20M; alone: the finest such grid"}, \
    MS_INPUT_RULE_FLAG, \
    {"allow-open", 0, NULL, "take a mesh with holes: majority of the parities along three axes"}, \
    MS_INPUT_CUT_FLAG, \
    MS_INPUT_MENDING_FLAGS, \
    MS_INPUT_VOLUME_FLAGS, \
    {"max-memory", 0, "SIZE", "refuse grids beyond this, as 500M or 8G (3/4 of the machine's)"}, \
    {"threads", 'j', "T", "threads (all cores)"}
/* clang-format on */

void ms_input_defaults(ms_input_flags *flags);

/** Takes a flag if it is one of MS_INPUT_FLAGS. @param[out] taken 0 if it is not */
ms_status ms_input_flag(int *taken, ms_input_flags *flags, const char *name, const char *value, ms_error *err);

/** Flags as words, for the rows of a table. */
typedef struct ms_input_text {
    char text[768];
} ms_input_text;

/** Those that change what is measured and are not at their defaults, as "weld=0.001 allow-open"; not the label. */
ms_input_text ms_input_flags_text(const ms_input_flags *flags);

/** Adds a flag of the command's own that is given: a number above 0. */
void ms_input_text_add(ms_input_text *to, const char *name, double value);

/** A shape that was read. */
typedef struct ms_input {
    const char *path;  /* "standard input" for "-" */
    uint64_t checksum; /* FNV-1a of the file */
    ms_mesh mesh;      /* empty for a volume */
    ms_mesh_report report;
    ms_solid solid; /* of a closed mesh */
    int is_volume;
    ms_scan scan; /* of a volume */
    ms_labels labels;
    ms_input_origin origin;
    ms_volume volume; /* the box of the label that was asked for, or of the only one; empty if there is no such one */
    ms_target target; /* after ms_input_target */
    uint32_t label;   /* that was asked for; 0: none */
    double read_seconds, voxelize_seconds, distance_seconds, describe_seconds;
} ms_input;

/**
 * Reads a mesh or a volume; mends a mesh, and if it is closed takes its volume, centre and
 * inertia. What was mended, and whether bodies overlap, is said on stderr. "-" is standard input, which is a mesh of up
 * to --max-memory bytes.
 */
ms_status ms_input_read(ms_input *input, const char *path, const ms_input_flags *flags, ms_error *err);

/** Refuses flags that do not apply to what was read. @return MS_OK; MS_ERR_ARG */
ms_status ms_input_check_flags(const ms_input *input, const ms_input_flags *flags, ms_error *err);

/** Bytes of the target that ms_input_target would make, and of a generator on it; 0 where it would fail before. */
double ms_input_bytes(const ms_input *input, const ms_input_flags *flags);

/**
 * Makes the target; says the size of the grid on stderr, and if its voxels do not hold the shape. Refuses open meshes
 * unless allowed.
 */
ms_status ms_input_target(ms_input *input, const ms_input_flags *flags, ms_error *err);

/**
 * The shape as pages show it: a mesh as it was read, a volume as the voxels of a label (0: the only one) alone. Nothing
 * is said on stderr.
 *
 * @param[out] shown borrowed from the input, whose target becomes that of a volume
 * @return MS_OK; as ms_target_voxels_from_volume
 */
ms_status ms_input_show(ms_target *shown, ms_input *input, uint32_t label, ms_error *err);

/** The descriptors of the target, once for all clumps that are measured against it. After ms_input_target. */
ms_status ms_input_describe(ms_input *input, ms_error *err);

/**
 * Says on stderr that the voxels do not hold the shape, with the figures and a number of cells to try, if they are
 * off by 1 % or more of its volume.
 *
 * @param misfit        as ms_target_misfit
 * @param shortest_side of the shape's box
 */
void ms_input_say_misfit(const char *name, double misfit, double voxel_size, double shortest_side);

double ms_input_shortest_side(const ms_mesh *mesh);

/** The largest grid that the memory allowed admits. */
size_t ms_input_max_voxels(const ms_input_flags *flags);

void ms_input_free(ms_input *input);

#endif
