#include "ms_library_write.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/ms_escape.h"
#include "base/ms_file.h"
#include "base/ms_text.h"
#include "chart/ms_csv.h"
#include "clump/formats/ms_write.h"
#include "ms_library_charts.h"
#include "ms_library_mixture.h"

static const ms_library_grain *chosen_grain(const ms_library *l, size_t j)
{
    return &l->table->grain[l->choice.grain[j]];
}

static void print_library(FILE *stream, const ms_library *l)
{
    fputs("file,number,mass,source,label,n", stream);
    for (int d = 0; d < MS_LIBRARY_DESCRIPTORS; d++) {
        fprintf(stream, ",shape_%s,clump_%s", ms_library_descriptors[d], ms_library_descriptors[d]);
    }
    fputc('\n', stream);
    double mass = 0;
    for (size_t j = 0; j < l->choice.k; j++) {
        mass += ms_library_mass(l, j);
    }
    for (size_t j = 0; j < l->choice.k; j++) {
        const ms_library_grain *grain = chosen_grain(l, j);
        ms_escape_csv_path(stream, grain->found.file);
        ms_csv_put_number(stream, ms_library_number(l, j));
        ms_csv_put_number(stream, ms_library_mass(l, j) / mass);
        fputc(',', stream);
        ms_escape_csv_path(stream, grain->found.source);
        ms_csv_put_number(stream, grain->found.label);
        ms_csv_put_number(stream, grain->spheres);
        for (int d = 0; d < MS_LIBRARY_DESCRIPTORS; d++) {
            ms_csv_put_number(stream, grain->shape[d]);
            ms_csv_put_number(stream, grain->clump[d]);
        }
        fputc('\n', stream);
    }
}

static void print_sizes(FILE *stream, const ms_library *l)
{
    fputs("diameter,number,mass\n", stream);
    for (size_t c = 0; c < l->goal.classes; c++) {
        fprintf(stream, "%s", ms_text_of_number(l->size[c].diameter).text);
        ms_csv_put_number(stream, l->size[c].number);
        ms_csv_put_number(stream, 1 / (double)l->goal.classes);
        fputc('\n', stream);
    }
}

/* Diameters that differ by less are one: of grains of one volume they differ by rounding. */
static const double SAME_SIZE = 1e-9;

/* A row for each class; classes of one diameter are one, since a shape stands once in each of its sizes. */
static void print_grain_in_sizes(FILE *stream, const ms_library *l, const char *path, double number)
{
    for (size_t c = 0, next = 0; c < l->goal.classes; c = next) {
        const double diameter = l->size[c].diameter;
        double share = 0;
        do {
            share += l->size[next++].number;
        } while (next < l->goal.classes && fabs(l->size[next].diameter / diameter - 1) < SAME_SIZE);
        fprintf(stream, "%s,%.0f,%s\n", path, fmax(1, round(number * share)), ms_text_of_number(diameter).text);
    }
}

/* Counts of a million particles. Paths are whole: the manifest stands elsewhere. */
static void print_scene(FILE *stream, const ms_library *l, char *const *path)
{
    enum { OF = 1000000 };
    fputs(l->size ? "shape,count,size\n" : "shape,count\n", stream);
    for (size_t j = 0; j < l->choice.k; j++) {
        const double number = OF * ms_library_number(l, j);
        if (l->size) {
            print_grain_in_sizes(stream, l, path[j], number);
        } else {
            fprintf(stream, "%s,%.0f\n", path[j], fmax(1, round(number)));
        }
    }
}

typedef void (*print_work)(FILE *stream, const ms_library *l);

static ms_status write_table(const ms_library *l, const char *folder, const char *name, print_work print, ms_error *err)
{
    char path[4096];
    ms_output output;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    ms_status status = ms_output_open(&output, path, err);
    if (status == MS_OK) {
        print(output.stream, l);
        status = ms_output_close(&output, MS_OK, err);
    }
    return status;
}

/* A manifest takes names without commas and quotation marks, of files that are there. */
static int is_name_of_manifest(const char *path)
{
    return path && !strpbrk(path, ",\"\n\r#") && path[strlen(path) - 1] != ' ';
}

static ms_status write_scene(int *written, const ms_library *l, const char *folder, ms_error *err)
{
    char file[4096];
    char **path = calloc(l->choice.k, sizeof *path);
    ms_status status = path ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for %zu paths", l->choice.k);
    *written = path && l->choice.k * (l->size ? l->goal.classes : 1) <= MS_LIBRARY_MAX_ROWS;
    for (size_t j = 0; j < l->choice.k && *written; j++) {
        const ms_grain_found *found = &chosen_grain(l, j)->found;
        path[j] = isnan(found->label) ? realpath(found->source, NULL) : NULL;
        *written = is_name_of_manifest(path[j]);
    }
    if (*written) {
        ms_output output;
        snprintf(file, sizeof file, "%s/scene.csv", folder);
        status = ms_output_open(&output, file, err);
        if (status == MS_OK) {
            print_scene(output.stream, l, path);
            status = ms_output_close(&output, MS_OK, err);
        }
    }
    for (size_t j = 0; path && j < l->choice.k; j++) {
        free(path[j]);
    }
    free(path);
    return status;
}

ms_status ms_library_write(ms_library_written *written, const ms_library *l, const char *from, const char *folder,
                           ms_error *err)
{
    *written = (ms_library_written){.scene = 0};
    ms_status status = write_table(l, folder, "library.csv", print_library, err);
    if (status == MS_OK && l->size) {
        status = write_table(l, folder, "sizes.csv", print_sizes, err);
    }
    if (status == MS_OK) {
        status = write_scene(&written->scene, l, folder, err);
    }
    if (status == MS_OK) {
        status = ms_library_mixture_write(written->scripts, sizeof written->scripts, l, from, folder, err);
    }
    if (status == MS_OK) {
        status = ms_library_charts_write(l, folder, err);
    }
    if (status == MS_OK) {
        written->charts = ms_library_charts_draw(l, folder, &written->why_not) == MS_OK;
    }
    return status;
}
