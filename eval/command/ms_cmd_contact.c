/* mskit contact CLUMP [--target SHAPE] */
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <string.h>

#include "base/ms_file.h"
#include "base/ms_text.h"
#include "cli/ms_files.h"
#include "cli/ms_input.h"
#include "cli/ms_json_object.h"
#include "cli/ms_report.h"
#include "clump/formats/ms_read.h"
#include "clump/ms_particle.h"
#include "contact/ms_contact_report.h"
#include "contact/ms_envelope_report.h"
#include "ms_commands.h"

static const ms_flag FLAGS[] = {
    {"target", 't', "SHAPE", "the mesh or volume that the clump stands for: its volume, centre and poses"},
    {"poses", 0, "N", "orientations drawn at random, and pairs of faces (1000)"},
    {"overlap", 0, "PART[,PART]...", "largest overlap of a contact / r_eq (0.0005,0.002,0.01)"},
    {"envelope", 0, "PART[,PART]...",
     "also the volume that no ball of this radius / r_eq, kept outside, can enter; of clump and shape"},
    {"restitution", 0, "E", "coefficient of restitution of one contact (0.5)"},
    {"factors", 0, NULL, "also one modulus and one restitution that would undo it, with their price"},
    {"seed", 0, "S", "seed of the orientations (1)"},
    {"json", 0, NULL, "as JSON"},
    {"csv", 0, NULL, "the contacts as CSV; with --envelope the envelopes"},
    MS_INPUT_MENDING_FLAGS,
    MS_INPUT_VOLUME_FLAGS,
    {"max-memory", 0, "SIZE", "refuse grids beyond this, as 500M or 8G (3/4 of the machine's)"},
    {"threads", 'j', "T", "threads (all cores)"},
    {0},
};

typedef struct contact_arguments {
    ms_input_flags input;
    ms_contact_options options;
    ms_envelope_table envelopes; /* the radii alone */
    const char *clump, *target;
    const char *of_shape; /* a flag about the shape; NULL without */
    int json, csv, factors;
} contact_arguments;

/* A clump, and what it stands for. */
typedef struct contact_bodies {
    ms_clump clump;
    ms_body body;
    ms_support shape; /* empty without --target */
    ms_mesh mesh;     /* of the shape; empty without one */
} contact_bodies;

/* Parts of r_eq, as 0.001,0.01. @param list room for `most` */
static ms_status take_parts(double *list, size_t *count, size_t most, const char *name, const char *value,
                            const double range[2], ms_error *err)
{
    *count = 0;
    for (const char *at = value;; at++) {
        const ms_word word = {at, strcspn(at, ",")};
        double part;
        if (!ms_text_to_double(&part, &word) || !(part >= range[0] && part <= range[1])) {
            return ms_fail(err, MS_ERR_ARG, "--%s takes parts of r_eq from %g to %g, as %g,%g, not '%s'", name,
                           range[0], range[1], 0.01 * range[1], 0.1 * range[1], value);
        }
        if (*count == most) {
            return ms_fail(err, MS_ERR_ARG, "--%s takes %zu parts at most", name, most);
        }
        list[(*count)++] = part;
        at += word.length;
        if (*at == '\0') {
            return MS_OK;
        }
    }
}

static ms_status take_number(contact_arguments *a, const char *name, const char *value, ms_error *err)
{
    double number = 0;
    ms_status status;
    if (strcmp(name, "restitution") == 0) {
        return ms_flags_number(&a->options.restitution, name, value, 1e-6, 1, err);
    }
    if (strcmp(name, "poses") == 0) {
        status = ms_flags_whole(&number, name, value, 1, 1e6, err);
        a->options.orientations = (size_t)number;
    } else {
        status = ms_flags_whole(&number, name, value, 0, 4294967295.0, err);
        a->options.seed = (unsigned long)number;
    }
    return status;
}

static ms_status take_contact_flag(void *context, const char *name, const char *value, ms_error *err)
{
    contact_arguments *a = context;
    int taken;
    const ms_status status = ms_input_flag(&taken, &a->input, name, value, err);
    if (taken) {
        if (strcmp(name, "threads") != 0 && strcmp(name, "max-memory") != 0) {
            a->of_shape = name;
        }
        return status;
    }
    if (strcmp(name, "target") == 0) {
        a->target = value;
    } else if (strcmp(name, "overlap") == 0) {
        return take_parts(a->options.overlap, &a->options.n_overlaps, MS_CONTACT_MAX_OVERLAPS, name, value,
                          (const double[]){1e-9, MS_CONTACT_MOST_OVERLAP}, err);
    } else if (strcmp(name, "envelope") == 0) {
        return take_parts(a->envelopes.radius, &a->envelopes.count, MS_ENVELOPE_MOST, name, value,
                          (const double[]){0.01, 100}, err);
    } else if (strcmp(name, "json") == 0 || strcmp(name, "csv") == 0) {
        *(name[0] == 'j' ? &a->json : &a->csv) = 1;
    } else if (strcmp(name, "factors") == 0) {
        a->factors = 1;
    } else {
        return take_number(a, name, value, err);
    }
    return MS_OK;
}

static ms_status read_shape(contact_bodies *b, const contact_arguments *a, ms_error *err)
{
    ms_input input;
    ms_status status = ms_input_read(&input, a->target, &a->input, err);
    if (status != MS_OK) {
        return status;
    }
    status = ms_input_check_flags(&input, &a->input, err);
    if (status == MS_OK && input.is_volume) {
        status = ms_target_voxels_from_volume(&input.target, &input.volume, a->input.label, err);
    } else if (status == MS_OK && !input.report.closed) {
        status = ms_fail(err, MS_ERR_SHAPE,
                         "%s is not closed and has no centre of mass; mend it (--fill-holes, --weld)", input.path);
    }
    if (status == MS_OK && input.is_volume && a->envelopes.count > 0) {
        status = ms_fail(err, MS_ERR_ARG, "%s is a volume, on whose steps a ball would rest: --envelope takes a mesh",
                         input.path);
    }
    if (status == MS_OK) {
        b->body = input.is_volume ? input.target.body : input.solid.body;
        status = input.is_volume ? ms_support_from_grid(&b->shape, &input.target.grid, b->body.centroid, err)
                                 : ms_support_from_mesh(&b->shape, &input.mesh, b->body.centroid, err);
    }
    if (status == MS_OK) {
        b->mesh = input.mesh;
        input.mesh = (ms_mesh){0};
    }
    ms_input_free(&input);
    return status;
}

/* Volume and centre of mass: of the shape, of the particle that the file knows, or of the union of the spheres. */
static ms_status read_bodies(contact_bodies *b, const contact_arguments *a, ms_error *err)
{
    ms_particle particle;
    const ms_status status = ms_read_clump(&b->clump, &particle, a->clump, err);
    if (status != MS_OK) {
        return status;
    }
    if (a->target) {
        return read_shape(b, a, err);
    }
    if (particle.mass > 0 && particle.density > 0) {
        b->body.volume = particle.mass / particle.density / pow(particle.scale, 3);
        memcpy(b->body.centroid, particle.centre, sizeof b->body.centroid);
        return MS_OK;
    }
    return ms_particle_union(&b->body, &b->clump, ms_input_max_voxels(&a->input), err);
}

static ms_status study_contact(ms_contact *contact, const contact_bodies *b, const contact_arguments *a, ms_error *err)
{
    ms_error cause;
    const ms_status status =
        ms_contact_study(contact, &b->clump, &b->body, b->shape.count ? &b->shape : NULL, &a->options, &cause);
    return status == MS_OK ? MS_OK : ms_fail(err, status, "%s: %s", ms_file_name(a->clump), cause.text);
}

static ms_status find_envelopes(ms_envelope_table *table, const contact_bodies *b, const ms_contact *contact,
                                ms_error *err)
{
    double radius[MS_ENVELOPE_MOST];
    for (size_t r = 0; r < table->count; r++) {
        radius[r] = table->radius[r] * contact->r_eq;
    }
    table->r_eq = contact->r_eq;
    table->clump.mean_width = contact->clump.mean_width;
    table->shape.mean_width = contact->shape.mean_width;
    ms_status status =
        ms_envelope_clump(table->clump.envelope, &table->clump.volume, &b->clump, radius, table->count, err);
    if (status == MS_OK && b->mesh.n_triangles > 0) {
        table->shape.volume = b->body.volume;
        status = ms_envelope_mesh(table->shape.envelope, &b->mesh, b->body.volume, radius, table->count, err);
    }
    return status;
}

static json_t *contact_json(const contact_arguments *a, const ms_contact *contact, const ms_envelope_table *envelopes,
                            size_t spheres)
{
    json_t *json = json_pack("{s:o,s:o,s:I,s:I,s:f,s:I}", "path", ms_report_text(ms_file_name(a->clump)), "target",
                             a->target ? ms_report_text(ms_file_name(a->target)) : json_null(), "spheres",
                             (json_int_t)spheres, "orientations", (json_int_t)a->options.orientations,
                             "single_restitution", a->options.restitution, "seed", (json_int_t)a->options.seed);
    ms_json_object_merge(&json, ms_contact_report_json(contact));
    if (a->factors) {
        ms_json_object_merge(&json, ms_contact_report_factors_json(contact, a->options.restitution));
    }
    if (envelopes->count > 0) {
        ms_json_object_merge(&json, ms_envelope_report_json(envelopes));
    }
    return json;
}

static ms_status report_contact(const contact_arguments *a, const contact_bodies *b, const ms_contact *contact,
                                const ms_envelope_table *envelopes, ms_error *err)
{
    if (a->json) {
        return ms_report_print(stdout, contact_json(a, contact, envelopes, b->clump.n_spheres), err);
    }
    if (a->csv) {
        if (envelopes->count > 0) {
            ms_envelope_report_csv(stdout, envelopes);
        } else {
            ms_contact_report_csv(stdout, contact);
        }
        return MS_OK;
    }
    printf("%s, %zu spheres\n", ms_file_name(a->clump), b->clump.n_spheres);
    ms_contact_report_print(stdout, contact);
    if (a->factors) {
        ms_contact_report_factors(stdout, contact, a->options.restitution);
    }
    if (envelopes->count > 0) {
        ms_envelope_report_print(stdout, envelopes);
    }
    return MS_OK;
}

static ms_status execute_contact(const contact_arguments *a, ms_error *err)
{
    contact_bodies b = {.clump = {0}};
    ms_contact contact;
    ms_envelope_table envelopes = a->envelopes;
    if (a->input.threads) {
        omp_set_num_threads(a->input.threads);
    }
    ms_status status = read_bodies(&b, a, err);
    if (status == MS_OK) {
        status = study_contact(&contact, &b, a, err);
    }
    if (status == MS_OK) {
        if (envelopes.count > 0) {
            status = find_envelopes(&envelopes, &b, &contact, err);
        }
        if (status == MS_OK) {
            status = report_contact(a, &b, &contact, &envelopes, err);
        }
        ms_contact_free(&contact);
    }
    ms_support_free(&b.shape);
    ms_mesh_free(&b.mesh);
    ms_clump_free(&b.clump);
    return status;
}

static ms_status resolve_contact(const contact_arguments *a, ms_error *err)
{
    const char *const inputs[] = {a->clump, a->target};
    if (a->json && a->csv) {
        return ms_fail(err, MS_ERR_ARG, "--json and --csv write to standard output; choose one of them");
    }
    if (a->factors && a->csv) {
        return ms_fail(err, MS_ERR_ARG, "--factors are a table of their own; leave out --csv, or give --json");
    }
    if (a->of_shape && !a->target) {
        return ms_fail(err, MS_ERR_ARG, "--%s is of a shape; give --target SHAPE beside it", a->of_shape);
    }
    return ms_files_check_standard(inputs, 2, err);
}

static int run_contact(const ms_command *command, int argc, char **argv)
{
    contact_arguments a = {.options = ms_contact_defaults()};
    int first;
    ms_error err;
    ms_input_defaults(&a.input);
    const int code = ms_flags_parse(&first, command, 0, argc, argv, take_contact_flag, &a);
    if (code != MS_FLAGS_GO_ON) {
        return code;
    }
    if (argc - first != 1) {
        return ms_flags_wrong_words(command, "takes one clump file", 1, argc - first, argv + first);
    }
    a.clump = argv[first];
    const ms_status status = resolve_contact(&a, &err);
    if (status != MS_OK) {
        return ms_flags_refuse(command, status, &err);
    }
    return execute_contact(&a, &err) == MS_OK ? EXIT_DONE : ms_flags_fail(command, &err);
}

const ms_command ms_command_contact = {
    .name = "contact",
    .summary = "how many spheres of a clump touch at once, what rebounds, and how it lies beside its shape",
    .usage = "CLUMP [--target SHAPE] [--poses N] [--overlap PART] [--envelope PART] [--restitution E] [--factors] "
             "[--seed S] [--json | --csv]",
    .example = "mskit contact grain.csv --target grain.stl --overlap 0.001",
    .flags = FLAGS,
    .run = run_contact,
};
