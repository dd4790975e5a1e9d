#include "ms_compare_sheet.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/ms_escape.h"
#include "base/ms_file.h"
#include "chart/ms_chart.h"
#include "chart/ms_render.h"
#include "clump/formats/ms_read.h"
#include "clump/formats/ms_write.h"
#include "measure/ms_metrics.h"

enum { TILE = 220, CAPTION = 26, ROW = TILE + CAPTION, MOST_ROWS = 4, HEAD = 40 };

/* What stands under a tile: its true number of spheres and D; empty without a clump. */
typedef struct sheet_caption {
    char text[48];
} sheet_caption;

/* FOLDER/SHAPE-NAME; the caller frees it. */
static char *make_path(const ms_compare_sheet *sheet, const char *name, ms_error *err)
{
    const size_t room = strlen(sheet->folder) + strlen(sheet->shape) + strlen(name) + 3;
    char *path = malloc(room);
    if (path) {
        snprintf(path, room, "%s/%s-%s", sheet->folder, sheet->shape, name);
    } else {
        ms_fail(err, MS_ERR_NOMEM, "no memory for the contact sheet");
    }
    return path;
}

char *ms_compare_sheet_path(const ms_compare_sheet *sheet, const ms_method *method, double asked, ms_error *err)
{
    char name[256];
    snprintf(name, sizeof name, "%.80s%s%.120s-%g.csv", method->name, method->options[0] ? "-" : "", method->options,
             asked);
    for (char *c = name; *c; c++) {
        if (!isalnum((unsigned char)*c) && !strchr(".,=_-", *c)) {
            *c = '_';
        }
    }
    return make_path(sheet, name, err);
}

ms_status ms_compare_sheet_keep(const ms_compare_sheet *sheet, const ms_method *method, double asked,
                                const ms_clump *clump, ms_error *err)
{
    const ms_content content = {.clump = clump};
    char *path = ms_compare_sheet_path(sheet, method, asked, err);
    const ms_status status =
        path ? ms_write_clump(&content, path, ms_write_format_find("csv", err), err) : MS_ERR_NOMEM;
    free(path);
    return status;
}

ms_status ms_compare_sheet_drop(const ms_compare_sheet *sheet, const ms_method *method, double asked, ms_error *err)
{
    char *path = ms_compare_sheet_path(sheet, method, asked, err);
    ms_status status = path ? MS_OK : MS_ERR_NOMEM;
    if (path && remove(path) != 0 && errno != ENOENT) {
        status = ms_fail(err, MS_ERR_IO, "%s: the clump of a run before cannot be removed: %s", path, strerror(errno));
    }
    free(path);
    return status;
}

ms_status ms_compare_sheet_list(ms_files *files, const ms_compare_sheet *sheet, ms_error *err)
{
    static const char *const ENDINGS[] = {"-sheet.gp", "-sheet.png", "-tiles.png", NULL};
    ms_status status = ms_files_add_charts(files, sheet->folder, sheet->shape, ENDINGS, err);
    for (size_t m = 0; m < sheet->methods->count; m++) {
        const ms_method *method = &sheet->methods->method[m];
        for (size_t k = 0; method->generator && k < sheet->n_asked && status == MS_OK; k++) {
            char *path = ms_compare_sheet_path(sheet, method, sheet->asked[k], err);
            status = path ? ms_files_add(files, path, MS_FILE_LATER, err) : MS_ERR_NOMEM;
            free(path);
        }
    }
    return status;
}

static size_t count_rows(const ms_compare_sheet *sheet)
{
    return sheet->n_asked < MOST_ROWS ? sheet->n_asked : MOST_ROWS;
}

/* Which number a row shows: the first, the last, and others between. */
static double row_number(const ms_compare_sheet *sheet, size_t row)
{
    const size_t rows = count_rows(sheet);
    return sheet->asked[rows > 1 ? row * (sheet->n_asked - 1) / (rows - 1) : 0];
}

static ms_status draw_clump(ms_picture *picture, sheet_caption *caption, const ms_view *view,
                            const ms_compare_sheet *sheet, const ms_target *target, const ms_clump *clump,
                            ms_error *err)
{
    ms_score score;
    ms_render_clump(picture, view, clump);
    const ms_status status = ms_metrics_score_clump(&score, NULL, target, clump, sheet->max_voxels, err);
    snprintf(caption->text, sizeof caption->text, "n = %zu, D = %.4f", clump->n_spheres, score.dice);
    return status;
}

static ms_status draw_tile(ms_picture *picture, sheet_caption *caption, const ms_view *view,
                           const ms_compare_sheet *sheet, const ms_target *target, const ms_method *method,
                           double asked, ms_error *err)
{
    ms_clump clump;
    if (!method->generator) {
        return draw_clump(picture, caption, view, sheet, target, &method->clump[sheet->at].clump, err);
    }
    char *path = ms_compare_sheet_path(sheet, method, asked, err);
    ms_status status = path ? MS_OK : MS_ERR_NOMEM;
    if (path && access(path, F_OK) != 0) {
        fprintf(stderr, "%s is not there: its place on the contact sheet is empty\n", path);
    } else if (path && (status = ms_read_spheres(&clump, path, err)) == MS_OK) {
        status = draw_clump(picture, caption, view, sheet, target, &clump, err);
        ms_clump_free(&clump);
    }
    free(path);
    return status;
}

/* @param[out] caption rows x methods; empty before */
static ms_status draw_tiles(ms_picture *picture, sheet_caption *caption, const ms_compare_sheet *sheet,
                            const ms_target *target, ms_error *err)
{
    ms_view view;
    ms_status status = ms_render_view(&view, target, 0, 0, TILE, err);
    if (status == MS_OK) {
        ms_render_target(picture, &view, target);
    }
    for (size_t row = 0; row < count_rows(sheet); row++) {
        for (size_t m = 0; m < sheet->methods->count && status == MS_OK; m++) {
            const ms_method *method = &sheet->methods->method[m];
            if (method->generator || row == 0) { /* a clump of another tool is there once */
                view.x = (int)(m + 1) * TILE;
                view.y = (int)row * ROW;
                status = draw_tile(picture, &caption[row * sheet->methods->count + m], &view, sheet, target, method,
                                   row_number(sheet, row), err);
            }
        }
    }
    return status;
}

static void put_sheet_label(FILE *stream, const char *text, double x, double y)
{
    fputs("set label ", stream);
    ms_escape_gnuplot(stream, text);
    fprintf(stream, " at %g,%g center front noenhanced\n", x, y);
}

/* Puts words to the tiles; y of gnuplot's picture goes upward. */
static void put_sheet_script(FILE *stream, const ms_compare_sheet *sheet, const ms_picture *picture,
                             const sheet_caption *caption)
{
    const int width = picture->width, height = picture->height + HEAD;
    fputs("# Draws the contact sheet of ", stream);
    ms_escape_comment(stream, sheet->shape);
    fprintf(stream,
            ": gnuplot, here, with the name of this file\nset encoding utf8\n"
            "if (strstrt(GPVAL_TERMINALS, 'pngcairo') > 0) { set terminal pngcairo size %d,%d font 'DejaVu Sans,11' }\n"
            "if (strstrt(GPVAL_TERMINALS, 'pngcairo') == 0) { set terminal png size %d,%d }\nset output ",
            width, height, width, height);
    ms_escape_gnuplot_file(stream, sheet->shape, "-sheet.png");
    fprintf(stream,
            "\nunset border\nunset tics\nunset key\nset margins 0,0,0,0\nset xrange [0:%d]\nset yrange [0:%d]\n", width,
            height);
    put_sheet_label(stream, sheet->shape, 0.5 * TILE, picture->height + 0.5 * HEAD);
    for (size_t m = 0; m < sheet->methods->count; m++) {
        char name[256];
        const ms_method *method = &sheet->methods->method[m];
        snprintf(name, sizeof name, "%.80s%s%.120s", method->name, method->generator && method->options[0] ? ":" : "",
                 method->generator ? method->options : "");
        put_sheet_label(stream, name, ((double)m + 1.5) * TILE, picture->height + 0.5 * HEAD);
    }
    for (size_t row = 0; row < count_rows(sheet); row++) {
        char number[64];
        snprintf(number, sizeof number, "asked for: %g", row_number(sheet, row));
        const double below = picture->height - (double)(row + 1) * ROW + 0.5 * CAPTION;
        put_sheet_label(stream, number, 0.5 * TILE, below);
        for (size_t m = 0; m < sheet->methods->count; m++) {
            put_sheet_label(stream, caption[row * sheet->methods->count + m].text, ((double)m + 1.5) * TILE, below);
        }
    }
    fputs("plot ", stream);
    ms_escape_gnuplot_file(stream, sheet->shape, "-tiles.png");
    fputs(" binary filetype=png with rgbimage\n", stream);
}

static ms_status write_script(const ms_compare_sheet *sheet, const ms_picture *picture, const sheet_caption *caption,
                              ms_error *err)
{
    ms_output output;
    char *path = make_path(sheet, "sheet.gp", err);
    ms_status status = path ? ms_output_open(&output, path, err) : MS_ERR_NOMEM;
    if (status == MS_OK) {
        put_sheet_script(output.stream, sheet, picture, caption);
        status = ms_output_close(&output, MS_OK, err);
    }
    free(path);
    return status;
}

ms_status ms_compare_sheet_draw(const ms_compare_sheet *sheet, const ms_target *target, FILE *words, ms_error *err)
{
    ms_picture picture = {0};
    char *tiles = make_path(sheet, "tiles.png", err), *stem = make_path(sheet, "sheet", err);
    sheet_caption *caption = calloc(count_rows(sheet) * sheet->methods->count, sizeof *caption);
    ms_status status = tiles && stem ? MS_OK : MS_ERR_NOMEM;
    if (status == MS_OK && !caption) {
        status = ms_fail(err, MS_ERR_NOMEM, "no memory for the contact sheet");
    }
    if (status == MS_OK) {
        status = ms_render_picture_alloc(&picture, (int)(sheet->methods->count + 1) * TILE,
                                         (int)count_rows(sheet) * ROW, err);
    }
    if (status == MS_OK) {
        status = draw_tiles(&picture, caption, sheet, target, err);
    }
    if (status == MS_OK) {
        status = ms_render_picture_write(&picture, tiles, err);
    }
    if (status == MS_OK) {
        status = write_script(sheet, &picture, caption, err);
    }
    if (status == MS_OK) {
        status = ms_chart_draw(stem, err);
    }
    if (status == MS_OK) {
        fprintf(words, "drew %s.png\n", stem);
    }
    ms_render_picture_free(&picture);
    free(caption);
    free(tiles);
    free(stem);
    return status;
}
