#include "ms_view_report.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/ms_escape.h"
#include "base/ms_file.h"
#include "ms_view_base64.h"
#include "ms_view_page.h"

/* 100 shapes of the most take about 10 MB; with the least one is still known for what it is. */
enum { ALL_TRIANGLES = 800000, MOST_TRIANGLES = 8000, LEAST_TRIANGLES = 400 };

size_t ms_view_report_triangles(size_t scenes)
{
    const size_t share = ALL_TRIANGLES / (scenes > 0 ? scenes : 1);
    return share < LEAST_TRIANGLES ? LEAST_TRIANGLES : share < MOST_TRIANGLES ? share : MOST_TRIANGLES;
}

size_t ms_view_report_columns(size_t *shown, const char *const *wanted, size_t n_wanted, const char *const *column,
                              size_t n_columns)
{
    size_t count = 0;
    for (size_t w = 0; w < n_wanted; w++) {
        for (size_t c = 0; c < n_columns; c++) {
            if (strcmp(wanted[w], column[c]) == 0) {
                shown[count++] = c;
            }
        }
    }
    return count;
}

/* Short where it is a number; the whole of it is in the file. */
static void put_field(FILE *stream, const char *field)
{
    const double value = ms_csv_number(field);
    if (isfinite(value)) {
        fprintf(stream, "<td class=\"number\">%.5g", value);
    } else {
        fputs("<td>", stream);
        ms_escape_html(stream, field);
    }
}

static ms_status put_row(FILE *stream, const ms_view_report *report, size_t r, ms_error *err)
{
    char *line = strdup(report->csv->row[r]), **field = calloc(report->n_columns, sizeof *field);
    const int whole = line && field;
    if (whole && ms_csv_split(field, report->n_columns, line) == report->n_columns) {
        fputs("<tr", stream);
        if (report->scene[r] >= 0) {
            fprintf(stream, " data-scene=\"%ld\"", report->scene[r]);
        }
        putc('>', stream);
        for (size_t c = 0; c < report->n_shown; c++) {
            put_field(stream, field[report->shown[c]]);
        }
        putc('\n', stream);
    }
    free(line);
    free(field);
    return whole ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for the table of the report");
}

static ms_status put_table(FILE *stream, const ms_view_report *report, ms_error *err)
{
    ms_status status = MS_OK;
    fputs("<h2>results</h2>\n<p><label>only rows with <input id=\"filter\" type=\"search\"></label> A click on a row "
          "shows its clump, one on a heading sorts.</p>\n<div class=\"wide\"><table id=\"rows\"><thead><tr>",
          stream);
    for (size_t c = 0; c < report->n_shown; c++) {
        fputs("<th>", stream);
        ms_escape_html(stream, report->column[report->shown[c]]);
    }
    fputs("</thead><tbody>\n", stream);
    for (size_t r = 0; r < report->csv->n_rows && status == MS_OK; r++) {
        status = put_row(stream, report, r, err);
    }
    fputs("</tbody></table></div>\n", stream);
    return status;
}

/* As an image, in which no script runs. */
static ms_status put_chart(FILE *stream, const char *path, ms_error *err)
{
    ms_bytes bytes;
    const ms_status status = ms_file_read(&bytes, path, err);
    if (status == MS_OK) {
        fputs("<img class=\"chart\" alt=\"", stream);
        ms_escape_html(stream, ms_file_base_name(path));
        fputs("\" src=\"data:image/svg+xml;base64,", stream);
        ms_view_base64_put(stream, bytes.data, bytes.size, 1);
        fputs("\">\n", stream);
        ms_file_free(&bytes);
    }
    return status;
}

/* The script of a chart that gnuplot did not draw. */
static ms_status put_undrawn(FILE *stream, const char *path, ms_error *err)
{
    const char *ending = strrchr(path, '.');
    const size_t room = strlen(path) + sizeof ".gp";
    char *script = malloc(room);
    if (!script) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the charts of the report");
    }
    snprintf(script, room, "%.*s.gp", (int)(ending ? ending - path : (long)strlen(path)), path);
    if (access(script, F_OK) == 0) {
        fputs("<p>not drawn: ", stream);
        ms_escape_html(stream, script);
        fputs("; charts need gnuplot (package gnuplot-nox)</p>\n", stream);
    }
    free(script);
    return MS_OK;
}

static ms_status put_charts(FILE *stream, const ms_view_report *report, ms_error *err)
{
    ms_status status = MS_OK;
    fputs(report->n_charts > 0 ? "<h2>charts</h2>\n" : "", stream);
    for (size_t c = 0; c < report->n_charts && status == MS_OK; c++) {
        const char *path = report->chart[c];
        status = access(path, F_OK) == 0 ? put_chart(stream, path, err) : put_undrawn(stream, path, err);
    }
    return status;
}

ms_status ms_view_report_begin(FILE *stream, const ms_view_report *report, ms_error *err)
{
    ms_view_page_begin(stream, report->title);
    fputs("<h2>command</h2>\n", stream);
    ms_status status = ms_view_page_command(stream, report->argc, report->argv, err);
    ms_view_page_viewer(stream);
    fputs("<div id=\"tiles\"></div>\n", stream);
    if (report->sums) {
        ms_view_page_text(stream, report->sums);
    }
    if (status == MS_OK) {
        status = put_table(stream, report, err);
    }
    if (status == MS_OK) {
        status = put_charts(stream, report, err);
    }
    ms_view_page_begin_scenes(stream);
    return status;
}
