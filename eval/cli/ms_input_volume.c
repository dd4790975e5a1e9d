#include "ms_input_volume.h"

#include <stdio.h>
#include <string.h>

#include "base/ms_text.h"
#include "ms_flags.h"
#include "ms_json_object.h"
#include "ms_progress.h"

/* Three numbers above 0, separated by commas. */
static ms_status take_three(double value[3], const char *name, const char *text, ms_error *err)
{
    const char *at = text;
    for (int a = 0; a < 3; a++) {
        const ms_word word = {at, strcspn(at, ",")};
        at += word.length;
        if (!ms_text_to_double(&value[a], &word) || !(value[a] > 0 && value[a] <= 1e300) || *at != (a < 2 ? ',' : 0)) {
            return ms_fail(err, MS_ERR_ARG, "--%s '%.60s' is not three numbers above 0, as 0.5,0.5,1", name, text);
        }
        at += a < 2;
    }
    return MS_OK;
}

static ms_status take_size(int64_t n[3], const char *name, const char *text, ms_error *err)
{
    double value[3];
    ms_status status = take_three(value, name, text, err);
    for (int a = 0; a < 3 && status == MS_OK; a++) {
        n[a] = value[a] <= INT32_MAX ? (int64_t)value[a] : 0;
        if ((double)n[a] != value[a]) {
            status = ms_fail(err, MS_ERR_ARG, "--%s '%.60s' is not three whole numbers, as 512,512,300", name, text);
        }
    }
    return status;
}

static ms_status take_connectivity(int *connectivity, const char *text, ms_error *err)
{
    static const int ALL[] = {6, 18, 26};
    char name[4];
    for (size_t i = 0; i < sizeof ALL / sizeof *ALL; i++) {
        snprintf(name, sizeof name, "%d", ALL[i]);
        if (strcmp(text, name) == 0) {
            *connectivity = ALL[i];
            return MS_OK;
        }
    }
    return ms_fail(err, MS_ERR_ARG, "--connectivity %.40s is none of 6, 18 and 26", text);
}

static ms_status take_values(ms_scan_options *options, ms_scan_values values, ms_error *err)
{
    if (options->values != MS_SCAN_LABELS && options->values != values) {
        return ms_fail(err, MS_ERR_ARG, "--threshold and --otsu exclude one another");
    }
    options->values = values;
    return MS_OK;
}

ms_status ms_input_volume_flag(int *taken, ms_scan_options *options, const char *name, const char *value, ms_error *err)
{
    *taken = 1;
    if (strcmp(name, "threshold") == 0) {
        const ms_status status = ms_flags_number(&options->threshold, name, value, -1e300, 1e300, err);
        return status == MS_OK ? take_values(options, MS_SCAN_THRESHOLD, err) : status;
    }
    if (strcmp(name, "otsu") == 0) {
        return take_values(options, MS_SCAN_OTSU, err);
    }
    if (strcmp(name, "connectivity") == 0) {
        return take_connectivity(&options->connectivity, value, err);
    }
    if (strcmp(name, "voxel-spacing") == 0) {
        return take_three(options->spacing, name, value, err);
    }
    if (strcmp(name, "raw-size") == 0) {
        return take_size(options->raw_n, name, value, err);
    }
    if (strcmp(name, "raw-type") == 0) {
        return ms_scan_raw_type(&options->raw_sample, &options->raw_big_endian, value, err);
    }
    *taken = strcmp(name, "raw-skip") == 0;
    double skip = 0;
    const ms_status status = *taken ? ms_flags_whole(&skip, name, value, 0, 9007199254740992.0, err) : MS_OK;
    options->raw_skip = *taken && status == MS_OK ? (int64_t)skip : options->raw_skip;
    return status;
}

static void say_origin(const ms_scan *scan, const ms_scan_options *options, const ms_labels *labels)
{
    const double *s = scan->stored_spacing;
    ms_progress_wipe();
    if (scan->is_resampled) {
        fprintf(stderr, "%s: its voxels are %.6g x %.6g x %.6g; resampled to %d x %d x %d cubes of %.6g (%s)\n",
                scan->path, s[0], s[1], s[2], scan->n[0], scan->n[1], scan->n[2], scan->spacing,
                options->values == MS_SCAN_LABELS ? "the nearest voxel's label" : "linear");
    }
    if (options->values != MS_SCAN_LABELS) {
        fprintf(stderr, "%s: %zu components of %d neighbours above %s%.9g\n", scan->path, labels->count,
                options->connectivity, options->values == MS_SCAN_OTSU ? "Otsu's threshold " : "", scan->threshold);
    }
}

ms_status ms_input_volume_open(ms_scan *scan, ms_labels *labels, ms_input_origin *origin, const char *path,
                               const ms_scan_options *options, size_t max_voxels, ms_error *err)
{
    ms_status status = ms_scan_open(scan, path, options, max_voxels, err);
    *labels = (ms_labels){0};
    *origin = (ms_input_origin){.values = options->values,
                                .threshold = scan->threshold,
                                .connectivity = options->connectivity,
                                .is_resampled = scan->is_resampled};
    memcpy(origin->stored_spacing, scan->stored_spacing, sizeof origin->stored_spacing);
    if (status == MS_OK) {
        status = ms_labels_find_in_scan(labels, scan, err);
        if (status == MS_OK) {
            say_origin(scan, options, labels);
        } else {
            ms_scan_close(scan);
        }
    }
    return status;
}

json_t *ms_input_volume_json(const ms_input_origin *origin)
{
    json_t *json = json_object();
    const double *s = origin->stored_spacing;
    if (origin->is_resampled) {
        ms_json_object_set(&json, "stored_spacing", json_pack("[f,f,f]", s[0], s[1], s[2]));
        ms_json_object_set(&json, "resampling", json_string(origin->values == MS_SCAN_LABELS ? "nearest" : "linear"));
    }
    if (origin->values != MS_SCAN_LABELS) {
        ms_json_object_set(&json, "segmentation", json_string(origin->values == MS_SCAN_OTSU ? "otsu" : "threshold"));
        ms_json_object_set(&json, "threshold", json_real(origin->threshold));
    }
    if (origin->values != MS_SCAN_LABELS || origin->largest_piece) {
        ms_json_object_set(&json, "connectivity", json_integer(origin->connectivity));
    }
    if (origin->largest_piece) {
        ms_json_object_set(&json, "largest_piece", json_true());
    }
    return json;
}
