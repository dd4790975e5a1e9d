/* Flags about the shape and its grid. */
#include <stdio.h>
#include <string.h>

#include "base/ms_choice.h"
#include "base/ms_text.h"
#include "ms_input.h"

void ms_input_defaults(ms_input_flags *flags)
{
    memset(flags, 0, sizeof *flags);
    flags->max_memory = ms_target_default_bytes();
    flags->mending.weld = MS_MESH_WELD;
    flags->scan = ms_scan_defaults();
}

static ms_status parse_size(double *size, const char *name, const char *text, const char *of, ms_error *err)
{
    static const char UNITS[] = "kMGT";
    const size_t length = strlen(text);
    const char *unit = length ? strchr(UNITS, text[length - 1]) : NULL;
    const ms_word number = {text, length - (unit != NULL)};
    double factor = 1, value;
    for (const char *u = UNITS; unit && u <= unit; u++) {
        factor *= 1000;
    }
    if (number.length == 0 || !ms_text_to_double(&value, &number) || !(value * factor <= 1e18) || value < 0) {
        return ms_fail(err, MS_ERR_ARG, "--%s '%s' is not a size like 500M or 8G (k, M, G or T %s)", name, text, of);
    }
    *size = value * factor;
    return MS_OK;
}

static ms_status parse_max_voxels(double *voxels, const char *text, ms_error *err)
{
    const ms_status status = parse_size(voxels, "max-voxels", text, "voxels", err);
    return status == MS_OK && *voxels < 1 ? ms_fail(err, MS_ERR_ARG, "--max-voxels %s is below 1", text) : status;
}

static ms_status parse_rule(ms_voxel_rule *rule, const char *text, ms_error *err)
{
    ms_choice choice = {.typed = text};
    *rule = MS_VOXEL_HALF;
    if (ms_choice_offer(&choice, "half")) {
        return MS_OK;
    }
    *rule = MS_VOXEL_CENTRE;
    return ms_choice_offer(&choice, "centre") ? MS_OK : ms_choice_fail(&choice, err, "there is no --rule '%s'", text);
}

/* Takes a flag if it is one of MS_INPUT_MENDING_FLAGS. */
static ms_status take_mending_flag(int *taken, ms_mesh_mending *mending, const char *name, const char *value,
                                   ms_error *err)
{
    double number = 0;
    *taken = 1;
    if (strcmp(name, "weld") == 0) {
        return ms_flags_number(&mending->weld, name, value, 0, MS_MESH_MOST_WELD, err);
    }
    if (strcmp(name, "drop-bodies") == 0) {
        return ms_flags_number(&mending->drop_bodies, name, value, 0, 1, err);
    }
    *taken = strcmp(name, "fill-holes") == 0;
    const ms_status status = *taken ? ms_flags_whole(&number, name, value, 0, UINT32_MAX, err) : MS_OK;
    mending->fill_holes = *taken && status == MS_OK ? (size_t)number : mending->fill_holes;
    return status;
}

/* Takes a flag if it is one of the grid. */
static ms_status take_grid_flag(int *taken, ms_input_flags *flags, const char *name, const char *value, ms_error *err)
{
    *taken = 1;
    if (strcmp(name, "cells") == 0) {
        return ms_flags_whole(&flags->cells, name, value, 1, MS_GRID_MAX_EXTENT, err);
    }
    if (strcmp(name, "deq") == 0) {
        return ms_flags_number(&flags->deq, name, value, 1, MS_GRID_MAX_EXTENT, err);
    }
    if (strcmp(name, "voxel-size") == 0) {
        return ms_flags_number(&flags->voxel_size, name, value, 1e-300, 1e300, err);
    }
    if (strcmp(name, "max-voxels") == 0) {
        return parse_max_voxels(&flags->max_voxels, value, err);
    }
    if (strcmp(name, "rule") == 0) {
        return parse_rule(&flags->rule, value, err);
    }
    *taken = 0;
    return MS_OK;
}

ms_status ms_input_flag(int *taken, ms_input_flags *flags, const char *name, const char *value, ms_error *err)
{
    double number;
    ms_status status = take_mending_flag(taken, &flags->mending, name, value, err);
    if (!*taken) {
        status = ms_input_volume_flag(taken, &flags->scan, name, value, err);
    }
    if (!*taken) {
        status = take_grid_flag(taken, flags, name, value, err);
    }
    if (*taken) {
        return status;
    }
    *taken = 1;
    if (strcmp(name, "cut") == 0) {
        flags->cut = 1;
        return MS_OK;
    }
    if (strcmp(name, "allow-open") == 0) {
        flags->allow_open = 1;
        return MS_OK;
    }
    if (strcmp(name, "max-memory") == 0) {
        return parse_size(&flags->max_memory, name, value, "bytes", err);
    }
    if (strcmp(name, "label") == 0) {
        status = ms_flags_whole(&number, name, value, 1, UINT32_MAX, err);
        flags->label = status == MS_OK ? (uint32_t)number : 0;
    } else if (strcmp(name, "threads") == 0) {
        status = ms_flags_whole(&number, name, value, 1, MS_INPUT_MAX_THREADS, err);
        flags->threads = status == MS_OK ? (int)number : 0;
    } else {
        *taken = 0;
    }
    return status;
}

/* Adds a word, with its value if it has one. */
static void add_word(ms_input_text *to, int is_given, const char *name, const char *value)
{
    const size_t used = strlen(to->text);
    if (is_given) {
        snprintf(to->text + used, sizeof to->text - used, "%s%s%s%s", used ? " " : "", name, value ? "=" : "",
                 value ? value : "");
    }
}

static void add_number(ms_input_text *to, double value, double usual, const char *name)
{
    add_word(to, value != usual, name, ms_text_of_number(value).text);
}

static void add_three(ms_input_text *to, const double value[3], const char *name)
{
    char text[128];
    snprintf(text, sizeof text, "%s,%s,%s", ms_text_of_number(value[0]).text, ms_text_of_number(value[1]).text,
             ms_text_of_number(value[2]).text);
    add_word(to, value[0] > 0, name, text);
}

static void add_scan(ms_input_text *to, const ms_scan_options *scan)
{
    static const char KINDS[] = {
        [MS_SAMPLE_BOOL] = 'b', [MS_SAMPLE_UNSIGNED] = 'u', [MS_SAMPLE_SIGNED] = 'i', [MS_SAMPLE_FLOAT] = 'f'};
    const double raw_n[3] = {(double)scan->raw_n[0], (double)scan->raw_n[1], (double)scan->raw_n[2]};
    char type[32];
    snprintf(type, sizeof type, "%c%d%s", KINDS[scan->raw_sample.kind], 8 * (int)scan->raw_sample.size,
             scan->raw_big_endian ? "be" : "");
    add_word(to, scan->values == MS_SCAN_THRESHOLD, "threshold", ms_text_of_number(scan->threshold).text);
    add_word(to, scan->values == MS_SCAN_OTSU, "otsu", NULL);
    add_number(to, scan->connectivity, ms_scan_defaults().connectivity, "connectivity");
    add_three(to, scan->spacing, "voxel-spacing");
    add_three(to, raw_n, "raw-size");
    add_word(to, scan->raw_sample.size > 0, "raw-type", type);
    add_number(to, (double)scan->raw_skip, 0, "raw-skip");
}

ms_input_text ms_input_flags_text(const ms_input_flags *flags)
{
    ms_input_text to = {""};
    add_number(&to, flags->cells, 0, "cells");
    add_number(&to, flags->deq, 0, "deq");
    add_number(&to, flags->voxel_size, 0, "voxel-size");
    add_number(&to, flags->max_voxels, 0, "max-voxels");
    add_word(&to, flags->rule == MS_VOXEL_CENTRE, "rule", "centre");
    add_word(&to, flags->allow_open, "allow-open", NULL);
    add_word(&to, flags->cut, "cut", NULL);
    add_number(&to, flags->mending.weld, MS_MESH_WELD, "weld");
    add_number(&to, (double)flags->mending.fill_holes, 0, "fill-holes");
    add_number(&to, flags->mending.drop_bodies, 0, "drop-bodies");
    add_scan(&to, &flags->scan);
    return to;
}

void ms_input_text_add(ms_input_text *to, const char *name, double value)
{
    add_number(to, value, 0, name);
}

ms_status ms_input_check_flags(const ms_input *input, const ms_input_flags *flags, ms_error *err)
{
    const int given = (flags->cells > 0) + (flags->deq > 0) + (flags->voxel_size > 0);
    if (given > 1) {
        return ms_fail(err, MS_ERR_ARG, "--cells, --deq and --voxel-size exclude one another");
    }
    if (input->is_volume && (given > 0 || flags->max_voxels > 0)) {
        return ms_fail(
            err, MS_ERR_ARG,
            "%s is a volume with voxels of its own; --cells, --deq, --voxel-size and --max-voxels do not apply",
            input->path);
    }
    if (input->is_volume && (flags->mending.fill_holes > 0 || flags->mending.drop_bodies > 0)) {
        return ms_fail(err, MS_ERR_ARG, "%s is a volume; --fill-holes and --drop-bodies are for meshes", input->path);
    }
    if (!input->is_volume && flags->label) {
        return ms_fail(err, MS_ERR_ARG, "%s is a mesh; --label is for volumes", input->path);
    }
    if (!input->is_volume && flags->scan.values != MS_SCAN_LABELS) {
        return ms_fail(err, MS_ERR_ARG, "%s is a mesh; --threshold and --otsu are for volumes", input->path);
    }
    return MS_OK;
}
