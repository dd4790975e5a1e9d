"""Writes the C source of mskit._library: what the Python module takes of the library's public header.

    interface.py OUTPUT.c

Each declaration is held against mskit.h by the compiler, which also fills in what `...` leaves open: fields that are
not used here, sizes, values of enumerators. Nothing here says a second time what a table of the library says.
"""
import sys

from cffi import FFI

DECLARATIONS = """
typedef enum { MS_OK, MS_ERR_ARG, MS_ERR_NOMEM, MS_ERR_IO, MS_ERR_FORMAT, MS_ERR_SHAPE, MS_ERR_LIMIT,
               MS_ERR_INTERRUPTED, ... } ms_status;
typedef struct { char text[...]; } ms_error;
typedef struct { uint8_t *data; size_t size; ...; } ms_bytes;
const char *ms_version(void);
void omp_set_num_threads(int threads);
int omp_get_max_threads(void);

/* meshes */
static const double MS_MESH_WELD;
typedef struct { size_t n_vertices, n_triangles; double (*vertex)[3]; uint32_t (*triangle)[3]; ...; } ms_mesh;
typedef struct { double weld; size_t fill_holes; double drop_bodies; ...; } ms_mesh_mending;
typedef struct {
    size_t joined, dropped_degenerate, dropped_duplicate, flipped, filled, dropped_bodies;
    double dropped_volume;
    size_t open_edges, odd_edges, holes, largest_hole, shells, cavities, bodies;
    int closed;
    ...;
} ms_mesh_report;
typedef struct { double volume; double centroid[3]; double inertia[3][3]; ...; } ms_body;
typedef struct { ms_body body; int overlapping; ...; } ms_solid;
ms_status ms_mesh_parse(ms_mesh *mesh, ms_error *remark, const ms_bytes *bytes, const char *path, ms_error *err);
ms_status ms_mesh_mend(ms_mesh *mesh, ms_mesh_report *report, const ms_mesh_mending *how, ms_error *err);
void ms_mesh_box(double *lo, double *hi, const ms_mesh *mesh);
double ms_mesh_area(const ms_mesh *mesh);
ms_status ms_mesh_decimate(ms_mesh *out, const ms_mesh *mesh, size_t most_triangles, ms_error *err);
void ms_mesh_free(ms_mesh *mesh);
int ms_mesh_read_is_mesh_path(const char *path);
ms_status ms_solid_mesh(ms_solid *solid, const ms_mesh *mesh, ms_error *err);
ms_status ms_file_read(ms_bytes *bytes, const char *path, ms_error *err);
void ms_file_free(ms_bytes *bytes);
typedef struct { ...; } ms_output;
ms_status ms_output_open(ms_output *output, const char *path, ms_error *err);
ms_status ms_output_close(ms_output *output, ms_status status, ms_error *err);

/* bodies to test with */
typedef struct { const char *name; double fallback, min, max; const char *help; ...; } ms_shape_parameter;
typedef struct { const char *name, *summary; const ms_shape_parameter *parameters; ...; } ms_shape_kind;
extern const ms_shape_kind ms_shape_kinds[];
const ms_shape_kind *ms_shape_find(const char *name, ms_error *err);
ms_status ms_shape_make(ms_mesh *mesh, const ms_shape_kind *kind, const double *value, ms_error *err);

/* volumes */
typedef struct { int n[3]; double spacing; double origin[3]; int first[3]; uint32_t *label; ...; } ms_volume;
typedef enum { MS_SCAN_LABELS, MS_SCAN_THRESHOLD, MS_SCAN_OTSU, ... } ms_scan_values;
typedef struct { ms_scan_values values; double threshold; int connectivity; double spacing[3]; ...; } ms_scan_options;
typedef struct { int n[3]; double spacing; double origin[3]; double threshold; ...; } ms_scan;
typedef struct { uint32_t label; size_t voxels; int lo[3]; int hi[3]; int cut; ...; } ms_label_entry;
typedef struct { ms_label_entry *entry; size_t count; ...; } ms_labels;
int ms_volume_is_volume_path(const char *path);
const char *ms_volume_endings(void);
void ms_volume_free(ms_volume *volume);
ms_scan_options ms_scan_defaults(void);
ms_status ms_scan_open(ms_scan *scan, const char *path, const ms_scan_options *options, size_t max_voxels,
                       ms_error *err);
ms_status ms_scan_parse(ms_scan *scan, const ms_bytes *bytes, const char *path, const ms_scan_options *options,
                        size_t max_voxels, ms_error *err);
void ms_scan_close(ms_scan *scan);
ms_status ms_labels_find_in_scan(ms_labels *labels, const ms_scan *scan, ms_error *err);
const ms_label_entry *ms_labels_entry(const ms_labels *labels, uint32_t label);
ms_status ms_labels_crop_scan(ms_volume *crop, const ms_scan *scan, const ms_label_entry *entry, ms_error *err);
void ms_labels_free(ms_labels *labels);

/* targets */
typedef enum { MS_VOXEL_HALF, MS_VOXEL_CENTRE, ... } ms_voxel_rule;
#define MS_GRID_HULL ...
#define MS_GRID_MAX_EXTENT ...
typedef struct { int n[3]; double h; double origin[3]; uint8_t *inside; ...; } ms_grid;
typedef struct { ms_voxel_rule rule; ms_grid grid; size_t voxels; ms_body body; int count_cut; ...; } ms_target;
typedef struct { double voxel, square; } ms_target_need;
ms_status ms_voxelize_size(double *h, const ms_mesh *mesh, double cells, ms_error *err);
ms_status ms_voxelize_size_within(double *h, const ms_mesh *mesh, double max_voxels, ms_error *err);
void ms_voxelize_extents(double *n, const ms_mesh *mesh, double h);
double ms_target_bytes(const double *n, double squares, ms_target_need need);
double ms_target_box_squares(const double *n);
double ms_target_default_bytes(void);
ms_status ms_target_voxels_from_solid(ms_target *target, const ms_mesh *mesh, const ms_solid *solid, double h,
                                      ms_voxel_rule rule, ms_error *err);
ms_status ms_target_voxels_from_volume(ms_target *target, const ms_volume *volume, uint32_t label, ms_error *err);
ms_status ms_target_add_distance(ms_target *target, ms_error *err);
double ms_target_misfit(const ms_target *target);
void ms_target_free(ms_target *target);

/* clumps */
#define MS_CLUMP_MAX_SPHERES ...
typedef struct { double centre[3]; double radius; } ms_sphere;
typedef struct { size_t n_spheres, n_carriers; ms_sphere *sphere; double *mass; ...; } ms_clump;
ms_status ms_clump_add(ms_clump *clump, const ms_sphere *sphere, ms_error *err);
void ms_clump_free(ms_clump *clump);

/* measures */
typedef enum { MS_MEASURE_KIND_COUNT, ... } ms_measure_kind;
typedef struct { ...; } ms_score;
typedef struct { size_t spheres; ...; } ms_metrics;
typedef struct {
    const char *name;
    ms_measure_kind kind;
    const char *unit, *label, *source, *help;
    double (*of_score)(const ms_score *score);
    double (*of_metrics)(const ms_metrics *metrics);
    ...;
} ms_measure;
extern const ms_measure ms_measures[];
enum { MS_MEASURE_DICE, MS_MEASURE_COVERAGE_CUT, ... };
const ms_measure *ms_measure_find_goal(const char *name, ms_error *err);
int ms_measure_is_of_score(const ms_measure *measure);
ms_status ms_metrics_compute(ms_metrics *metrics, ms_score *curve, const ms_target *target, const ms_clump *clump,
                             size_t max_voxels, ms_error *err);
ms_status ms_metrics_score_clump(ms_score *score, ms_score *curve, const ms_target *target, const ms_clump *clump,
                                 size_t max_voxels, ms_error *err);

/* methods */
typedef enum {
    MS_OPTION_FLAG, MS_OPTION_INTEGER, MS_OPTION_REAL, MS_OPTION_CHOICE, MS_OPTION_PLANE, MS_OPTION_CLUMP, ...
} ms_option_type;
typedef struct {
    const char *name;
    ms_option_type type;
    double fallback, min, max;
    const char *choices, *unit, *help;
    ...;
} ms_option;
typedef struct { const ms_option *options; ms_clump clump; ...; } ms_settings;
typedef enum { MS_STOP_INTERRUPTED, ... } ms_stop_reason;
typedef struct { size_t spheres; double radius, coverage_cut; ...; } ms_stop;
typedef struct {
    const char *name, *summary, *source;
    int nested, baseline;
    const ms_option *options;
    const char *volume_by;
    ...;
} ms_generator;
typedef struct {
    const ms_target *target;
    ms_stop stop;
    const ms_settings *settings;
    uint64_t seed;
    int (*progress)(void *context, size_t spheres, double dice);
    void *progress_context;
    int (*stage)(void *context, const char *stage, double share);
    void *stage_context;
    void (*remark)(void *context, const char *sentence);
    void *remark_context;
    ...;
} ms_run;
static const char *const MS_GENERATOR_DEFAULT;
extern const ms_generator *const ms_generators[];
const ms_generator *ms_generator_find(const char *name, ms_error *err);
int ms_generator_is_nested(const ms_generator *generator, const ms_settings *settings);
ms_target_need ms_generator_need(const ms_generator *generator, const ms_settings *settings, int cut);
ms_status ms_generator_run(ms_clump *clump, ms_stop_reason *reason, const ms_generator *generator, const ms_run *run,
                           ms_error *err);
ms_status ms_option_settings_init(ms_settings *settings, const ms_option *options, ms_error *err);
ms_status ms_option_settings_set(ms_settings *settings, const char *name, const char *text, ms_error *err);
void ms_option_settings_free(ms_settings *settings);
int ms_stop_is_none(const ms_stop *stop);
ms_status ms_stop_set(ms_stop *stop, const char *measure, double value, ms_error *err);
const char *ms_stop_name(ms_stop_reason reason);
ms_status ms_curve_compute(ms_score *curve, const ms_clump *clump, const ms_generator *generator, const ms_run *run,
                           size_t max_voxels, ms_error *err);
extern "Python" {
    int tell_progress(void *context, size_t spheres, double dice);
    int tell_stage(void *context, const char *stage, double share);
    void tell_remark(void *context, const char *sentence);
}

/* masses */
typedef struct { double scale, density, mass; double centre[3]; double inertia[3][3]; ...; } ms_particle;
typedef struct { int input_frame; double least, most, centre_tolerance; ...; } ms_density_options;
typedef struct { ms_density_options masses; double depth; ...; } ms_carriers_options;
typedef struct {
    double centre, epsilon, products;
    int optimal;
    double least_mass, most_mass, error_mass, error_centre;
    double error_moment[3];
    double error_product[3];
    ...;
} ms_density_report;
typedef struct { double scale, volume, error, mean_width; ...; } ms_equal_volume;
ms_status ms_particle_from_body(ms_particle *particle, const ms_body *body, double density, double scale,
                                ms_error *err);
ms_status ms_density_solve(ms_clump *clump, ms_density_report *report, const ms_particle *particle,
                           const ms_density_options *options, ms_error *err);
ms_status ms_carriers_solve(ms_clump *clump, ms_density_report *report, const ms_particle *particle,
                            const ms_carriers_options *options, ms_error *err);
ms_status ms_equal_volume_scale(ms_clump *clump, ms_equal_volume *done, const ms_body *body, ms_error *err);
void ms_equal_volume_remark(ms_error *remarks, const ms_equal_volume *done);

/* what is expected */
typedef struct { ...; } ms_expect;
typedef enum { MS_EXPECT_FREE, MS_EXPECT_INSCRIBED, ... } ms_expect_kind;
static const double MS_EXPECT_RANGE;
static const double MS_EXPECT_RANGE_MANY;
ms_status ms_expect_mesh(ms_expect *expect, const ms_mesh *mesh, ms_error *err);
ms_status ms_expect_grid(ms_expect *expect, const ms_grid *grid, ms_error *err);
double ms_expect_dice(const ms_expect *expect, ms_expect_kind kind, double spheres);
double ms_expect_spheres(const ms_expect *expect, ms_expect_kind kind, double dice);
double ms_expect_least_spheres(const ms_expect *expect, ms_expect_kind kind);
double ms_expect_round(double spheres);

/* scenes */
typedef struct { uint64_t particles; size_t most; const double *error; } ms_share;
typedef struct { uint64_t particles, spheres; double error, slack; } ms_allocation;
ms_allocation ms_allocate_sum(const ms_share *share, const size_t *n, size_t count);
double ms_allocate_gain(const ms_share *share, const size_t *n, size_t count);
ms_status ms_allocate_budget(size_t *n, ms_allocation *allocated, const ms_share *share, size_t count, uint64_t budget,
                             ms_error *err);
ms_status ms_allocate_error(size_t *n, ms_allocation *allocated, const ms_share *share, size_t count, double error,
                            ms_error *err);
size_t ms_allocate_knee(const ms_share *share, double part);
typedef struct { char *path; uint64_t particles; double tolerance, size; ...; } ms_manifest_row;
typedef struct { ms_manifest_row *row; size_t count; ...; } ms_manifest;
typedef struct { double size, share; uint64_t count; double mass; ...; } ms_sieve_class;
typedef struct { size_t count; ms_sieve_class *of; ...; } ms_sieve;
enum { MS_MANIFEST_MAX_SHAPES, MS_MANIFEST_MAX_PARTICLES, MS_SIEVE_MAX_CLASSES, ... };
static const double MS_MANIFEST_LEAST_SIZE;
static const double MS_MANIFEST_MOST_SIZE;
ms_status ms_manifest_read(ms_manifest *manifest, const char *path, ms_error *err);
void ms_manifest_free(ms_manifest *manifest);
ms_status ms_sieve_read(ms_sieve *sieve, const char *path, size_t classes, ms_error *err);
ms_status ms_sieve_make(ms_sieve *sieve, const double *size, const double *passing, size_t count, size_t classes,
                        ms_error *err);
ms_status ms_sieve_apply(ms_manifest *made, ms_sieve *sieve, const ms_manifest *manifest, ms_error *err);
void ms_sieve_free(ms_sieve *sieve);
typedef struct { size_t most; ms_clump *clump; ms_score *score; double *dice; ms_error *remarks; } ms_templates;
typedef struct {
    const ms_generator *generator;
    const ms_run *run;
    const ms_body *equal;
    size_t max_voxels;
} ms_templates_how;
ms_status ms_templates_make(ms_templates *templates, const ms_templates_how *how, ms_error *err);
ms_status ms_templates_alloc(ms_templates *templates, size_t most, ms_error *err);
ms_status ms_templates_search(ms_templates *templates, size_t *reached, const ms_templates_how *how,
                              const ms_measure *measure, double value, size_t first, ms_error *err);
size_t ms_templates_least(double *best, const ms_templates *templates, const ms_measure *measure, double value);
ms_status ms_templates_surface(double *surface, const ms_target *target, ms_error *err);
double ms_templates_dice(double length, double surface, double factor);
double ms_templates_length(double dice, double surface, double factor);
void ms_templates_free(ms_templates *templates);
double ms_inertia_factor(const ms_body *body, double size);
void ms_inertia_scale(ms_body *body, double factor);
ms_status ms_clump_scale(ms_clump *scaled, const ms_clump *clump, double factor, ms_error *err);

/* contacts */
#define MS_CONTACT_MAX_OVERLAPS ...
static const double MS_CONTACT_MOST_OVERLAP;
typedef struct { size_t count; ...; } ms_support;
typedef struct {
    size_t orientations;
    double restitution;
    double overlap[...];
    size_t n_overlaps;
    unsigned long seed;
    ...;
} ms_contact_options;
typedef struct { size_t count; ...; } ms_touch;
typedef enum { MS_CONTACT_PLANE, MS_CONTACT_PARTICLE, ... } ms_contact_against;
typedef enum { MS_CONTACT_RANDOM, MS_CONTACT_POSES, ... } ms_contact_where;
typedef struct { ms_touch touch; double weight; ...; } ms_contact_sample;
typedef struct {
    ms_contact_against against;
    ms_contact_where where;
    double overlap;
    size_t samples;
    ms_contact_sample *sample;
    double whole, missed, mean;
    size_t median, most;
    double stiffness, most_stiffness, damping, most_damping, restitution, least_restitution, overdamped;
    ...;
} ms_contact_row;
typedef struct { double friction, mean, largest, slope_mean, slope_largest, jammed, missed; ...; } ms_sled;
typedef struct { double overlap; ms_sled sled[...]; ...; } ms_contact_sled;
typedef struct { double direction[3]; double height, barrier, share; ...; } ms_pose;
typedef struct { double mean_width; ms_pose *pose; size_t n_poses; ...; } ms_contact_form;
typedef struct {
    double r_eq;
    ms_contact_form clump, shape;
    double rms;
    size_t n_rows;
    ms_contact_row row[...];
    const ms_pose *face;
    size_t n_sleds;
    ms_contact_sled sled[...];
    ...;
} ms_contact;
typedef struct { double modulus, restitution, softest, bounciest; ...; } ms_factors;
ms_contact_options ms_contact_defaults(void);
ms_status ms_contact_study(ms_contact *contact, const ms_clump *clump, const ms_body *body, const ms_support *shape,
                           const ms_contact_options *options, ms_error *err);
const ms_pose *ms_contact_nearest(double *angle, const ms_contact_form *from, const double *direction);
void ms_contact_free(ms_contact *contact);
typedef struct { double volume, error; } ms_envelope;
ms_status ms_envelope_clump(ms_envelope *out, double *volume, const ms_clump *clump, const double *radius, size_t count,
                            ms_error *err);
ms_status ms_envelope_mesh(ms_envelope *out, const ms_mesh *mesh, double volume, const double *radius, size_t count,
                           ms_error *err);
ms_factors ms_factors_of(const ms_contact *contact, const ms_contact_row *row, double single);
ms_status ms_support_from_mesh(ms_support *body, const ms_mesh *mesh, const double *centre, ms_error *err);
ms_status ms_support_from_grid(ms_support *body, const ms_grid *grid, const double *centre, ms_error *err);
void ms_support_free(ms_support *body);
ms_status ms_particle_union(ms_body *body, const ms_clump *clump, size_t max_voxels, ms_error *err);

/* files */
#define MS_WRITE_REMARK ...
typedef struct {
    const ms_clump *clump;
    const ms_particle *particle;
    const char *record;
    ...;
} ms_content;
typedef struct { const char *suffix; ...; } ms_packing_part;
typedef struct { const char *name, *ending, *summary; ms_packing_part scene; ...; } ms_format;
typedef struct {
    const ms_clump *clump;
    const ms_particle *particle;
    const char *path, *name;
    size_t count;
} ms_scene_kind;
typedef struct { double width[2]; int is_round; } ms_scene_vessel;
extern const ms_format ms_formats[];
const ms_format *ms_write_format_find(const char *name, ms_error *err);
const ms_format *ms_write_format_of_path(const char *path, ms_error *err);
ms_status ms_write_remark(char *text, const ms_content *content, const ms_format *format, ms_error *err);
ms_status ms_write_check(const ms_content *content, const ms_format *format, ms_error *err);
int ms_write_format_is_folder(const ms_format *format);
ms_status ms_write_list(const char *path, const ms_format *format,
                        ms_status (*take)(void *context, const char *path, int is_frame, ms_error *err), void *context,
                        ms_error *err);
extern "Python" ms_status take_file(void *context, const char *path, int is_frame, ms_error *err);
ms_status ms_write_check_path(const char *path, const ms_format *format, ms_error *err);
char *ms_write_path(const char *folder, const char *source, const char *behind, const ms_format *format);
char *ms_scene_script_path(const char *folder, const ms_format *format);
ms_status ms_scene_script_check(const ms_scene_kind *kind, size_t count, const ms_scene_vessel *vessel, ms_error *err);
ms_status ms_scene_script_write(const ms_scene_kind *kind, size_t count, const ms_scene_vessel *vessel,
                                const char *folder, const ms_format *format, ms_error *err);
void free(void *memory);
ms_status ms_write_clump(const ms_content *content, const char *path, const ms_format *format, ms_error *err);
ms_status ms_read_clump(ms_clump *clump, ms_particle *particle, const char *path, ms_error *err);
"""

if __name__ == "__main__":
    library = FFI()
    library.cdef(DECLARATIONS)
    library.set_source("mskit._library", '#include <omp.h>\n#include <stdlib.h>\n#include "mskit.h"\n')
    library.emit_c_code(sys.argv[1])
