#include "ms_grain_row.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_escape.h"
#include "base/ms_file.h"
#include "base/ms_text.h"
#include "chart/ms_csv.h"

#define STATUS_NAME(code, name) name,
static const char *const STATUS[] = {MS_GRAIN_STATUS_LIST(STATUS_NAME)};

enum { A_THOUSAND = 1000 };

void ms_grain_row_path(char *out, size_t size, const char *folder, const ms_grain_row *row)
{
    snprintf(out, size, "%s%s%04zu/%s", folder, folder[0] ? "/" : "", (row->number - 1) / A_THOUSAND, row->grain->name);
}

static void put_options(FILE *stream, const ms_recipe *recipe)
{
    char text[1024] = "";
    for (int w = 0; w < recipe->n_wishes; w++) {
        const ms_wish *wish = &recipe->wish[w];
        const size_t used = strlen(text);
        snprintf(text + used, sizeof text - used, "%s%s%s%s", used ? "," : "", wish->name ? wish->name : "",
                 wish->name && wish->text ? "=" : "", wish->text ? wish->text : "");
    }
    fputc(',', stream);
    ms_escape_csv(stream, text);
}

/* The stop rule, as eta=0.1 dice=0.05. */
static void put_until(FILE *stream, const ms_stop *stop)
{
    const char *before = "";
    fputc(',', stream);
    for (const ms_measure *m = ms_measures; m->name; m++) {
        if (ms_stop_asked(stop, m) > 0) {
            fprintf(stream, "%s%s=%s", before, m->name, ms_text_of_number(ms_stop_asked(stop, m)).text);
            before = " ";
        }
    }
    if (stop->radius > 0) {
        fprintf(stream, "%sradius=%s", before, ms_text_of_number(stop->radius).text);
    }
}

static void print_key(FILE *stream, const ms_grain_row *row)
{
    const ms_grain_how *how = row->grain->how;
    fprintf(stream, "%zu,%zu,%016" PRIx64 ",", row->number, row->count, row->run);
    ms_escape_csv_path(stream, row->grain->source->path);
    fprintf(stream, ",%016" PRIx64 ",", row->checksum);
    if (row->grain->label) {
        fprintf(stream, "%lu", (unsigned long)row->grain->label);
    }
    fprintf(stream, ",%s", how->recipe.generator->name);
    put_options(stream, &how->recipe);
    ms_csv_put_number(stream, how->recipe.seed);
    ms_csv_put_number(stream, how->stop.spheres ? (double)how->stop.spheres : (double)NAN);
    put_until(stream, &how->stop);
    fputc(',', stream);
}

static void print_masses(FILE *stream, const ms_mass *mass)
{
    const int corrected = mass && mass->corrected;
    ms_csv_put_number(stream, corrected ? mass->report.epsilon : (double)NAN);
    ms_csv_put_number(stream, corrected ? mass->report.products : (double)NAN);
    ms_csv_put_number(stream, corrected ? mass->report.centre : (double)NAN);
}

/* The columns of a place, in the order of its numbers. */
static const char *const PLACE[] = {"mass",         "moment_1",     "moment_2",    "moment_3",
                                    "centre_x",     "centre_y",     "centre_z",    "quaternion_w",
                                    "quaternion_x", "quaternion_y", "quaternion_z"};
enum { PLACE_COLUMNS = sizeof PLACE / sizeof *PLACE };

/* Where the number of a column stands. */
static double *place_number(ms_grain_place *place, int column)
{
    double *const number[PLACE_COLUMNS] = {&place->mass,      &place->moment[0], &place->moment[1], &place->moment[2],
                                           &place->centre[0], &place->centre[1], &place->centre[2], &place->turn[0],
                                           &place->turn[1],   &place->turn[2],   &place->turn[3]};
    return number[column];
}

static void print_place(FILE *stream, const ms_grain_place *place)
{
    ms_grain_place copy = *place;
    for (int c = 0; c < PLACE_COLUMNS; c++) {
        ms_csv_put_number(stream, *place_number(&copy, c));
    }
}

static void print_results(FILE *stream, const ms_grain_row *row)
{
    const ms_result *r = row->result;
    char path[512] = "";
    const ms_label_entry *entry = ms_labels_entry(&row->grain->source->labels, row->grain->label);
    if (r) {
        ms_grain_row_path(path, sizeof path, "", row);
        snprintf(path + strlen(path), sizeof path - strlen(path), ".%s", row->ending);
    }
    fprintf(stream, "%s,", STATUS[row->status]);
    ms_escape_csv_path(stream, path);
    ms_csv_put_number(stream, r ? (double)r->clump.n_spheres : (double)NAN);
    fprintf(stream, ",%s", r ? ms_stop_name(r->reason) : "");
    ms_csv_put_number(stream, entry ? (double)entry->voxels : (double)NAN);
    ms_csv_put_number(stream, row->pieces);
    ms_csv_put_number(stream, entry ? (double)entry->cut : (double)NAN);
    ms_csv_put_number(stream, row->voxel_size);
    ms_csv_put_number(stream, row->volume);
    ms_csv_put_number(stream, cbrt(6 * row->volume / acos(-1.0)));
    for (const ms_measure *m = ms_measures; m->name; m++) {
        ms_csv_put_number(stream, r ? m->of_metrics(&r->metrics) : (double)NAN);
    }
    ms_csv_put_number(stream, r && r->volume.scale > 0 ? r->volume.scale : (double)NAN);
    ms_csv_put_number(stream, r && r->mass.corrected ? (double)r->clump.n_carriers : (double)NAN);
    print_masses(stream, r ? &r->mass : NULL);
    print_place(stream, &row->place);
    ms_csv_put_number(stream, row->seconds);
    fprintf(stream, ",%d,", row->beside);
    if (r) {
        const ms_bytes bytes = {.data = (uint8_t *)r->clump.sphere,
                                .size = r->clump.n_spheres * sizeof *r->clump.sphere};
        fprintf(stream, "%016" PRIx64, ms_file_checksum(&bytes));
    }
    fputc(',', stream);
    ms_escape_csv(stream, row->cause.text);
}

static void print_header(FILE *stream)
{
    fputs("grain,grains,run,source,checksum,label,generator,options,seed,n_asked,until,status,file,n,stopped_by,voxels,"
          "shape_pieces,cut_by_border,voxel_size,volume,equivalent_diameter",
          stream);
    for (const ms_measure *m = ms_measures; m->name; m++) {
        fprintf(stream, ",%s", ms_measure_column(m, m->in_compare));
    }
    fputs(",scale,carriers,epsilon,products_epsilon,centre_epsilon", stream);
    for (int c = 0; c < PLACE_COLUMNS; c++) {
        fprintf(stream, ",%s", PLACE[c]);
    }
    fputs(",seconds,beside,spheres_fnv1a,cause", stream);
}

char *ms_grain_row_line(const ms_grain_row *row)
{
    char *line = NULL;
    size_t size;
    FILE *stream = open_memstream(&line, &size);
    if (!stream) {
        return NULL;
    }
    if (row) {
        print_key(stream, row);
        print_results(stream, row);
    } else {
        print_header(stream);
    }
    return fclose(stream) == 0 ? line : NULL;
}

enum { MOST_COLUMNS = 64 + MS_MEASURES };

/* A line, cut, beside the names of its columns. */
typedef struct row_fields {
    char *field[MOST_COLUMNS], *name[MOST_COLUMNS], *copy, *header;
    size_t count; /* 0: it is no row */
} row_fields;

static void cut_row(row_fields *fields, const char *line)
{
    fields->copy = strdup(line);
    fields->header = ms_grain_row_line(NULL);
    const int ok = fields->copy && fields->header;
    const size_t count = ok ? ms_csv_split(fields->field, MOST_COLUMNS, fields->copy) : 0;
    const size_t columns = ok ? ms_csv_split(fields->name, MOST_COLUMNS, fields->header) : 0;
    fields->count = count == columns ? count : 0;
}

static void free_fields(row_fields *fields)
{
    free(fields->copy);
    free(fields->header);
}

/* The field of a column; NULL if it is not there. */
static const char *find_field(const row_fields *fields, const char *column)
{
    const char *found = NULL;
    for (size_t c = 0; c < fields->count; c++) {
        found = strcmp(fields->name[c], column) == 0 ? fields->field[c] : found;
    }
    return found;
}

static int read_status(ms_grain_status *status, const char *named)
{
    int found = 0;
    for (int s = 0; s < MS_GRAIN_STATUSES && named; s++) {
        if (strcmp(named, STATUS[s]) == 0) {
            *status = (ms_grain_status)s;
            found = 1;
        }
    }
    return found;
}

ms_status ms_grain_row_read(ms_grain_status *status, int *is_remarked, double *spheres, const char *line, ms_error *err)
{
    row_fields fields;
    cut_row(&fields, line);
    const char *n = find_field(&fields, "n");
    const int found = read_status(status, find_field(&fields, "status"));
    const char *cause = find_field(&fields, "cause");
    *is_remarked = found && *status == MS_GRAIN_OK && cause && cause[0];
    *spheres = n ? strtod(n, NULL) : 0;
    free_fields(&fields);
    return found ? MS_OK : ms_fail(err, MS_ERR_FORMAT, "has no status of a grain");
}

/* NAN where the field is empty or is no number. */
static double read_number(const row_fields *fields, const char *column)
{
    const char *text = find_field(fields, column);
    return text ? ms_csv_number(text) : (double)NAN;
}

ms_status ms_grain_row_find(ms_grain_found *found, const char *line, ms_error *err)
{
    row_fields fields;
    cut_row(&fields, line);
    const char *file = find_field(&fields, "file");
    const char *source = find_field(&fields, "source");
    found->number = read_number(&fields, "grain");
    const int is_row = file && strlen(file) < sizeof found->file && source && strlen(source) < sizeof found->source &&
                       found->number >= 1 && found->number <= 9007199254740992.0 &&
                       read_status(&found->status, find_field(&fields, "status"));
    if (is_row) {
        snprintf(found->file, sizeof found->file, "%s", file);
        snprintf(found->source, sizeof found->source, "%s", source);
        found->label = read_number(&fields, "label");
        found->volume = read_number(&fields, "volume");
        for (int c = 0; c < PLACE_COLUMNS; c++) {
            *place_number(&found->place, c) = read_number(&fields, PLACE[c]);
        }
    }
    free_fields(&fields);
    return is_row ? MS_OK : ms_fail(err, MS_ERR_FORMAT, "'%.60s' is no row of a grain", line);
}

char *ms_grain_row_stem(const ms_grain_found *found, const char *ending)
{
    const size_t length = strlen(found->file), behind = strlen(ending) + 1;
    char *stem = strdup(found->file);
    if (stem && length > behind) {
        stem[length - behind] = '\0';
    }
    return stem;
}

ms_status ms_grain_row_number(double *value, const char *column, const char *line, ms_error *err)
{
    row_fields fields;
    cut_row(&fields, line);
    const int is_row = fields.count > 0;
    *value = read_number(&fields, column);
    free_fields(&fields);
    return is_row ? MS_OK : ms_fail(err, MS_ERR_FORMAT, "'%.60s' is no row of a grain", line);
}

char *ms_grain_row_key(const ms_grain_row *row)
{
    char *key = NULL;
    size_t size;
    FILE *stream = open_memstream(&key, &size);
    if (!stream) {
        return NULL;
    }
    print_key(stream, row);
    return fclose(stream) == 0 ? key : NULL;
}
