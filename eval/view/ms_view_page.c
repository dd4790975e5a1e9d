#include "ms_view_page.h"

#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_escape.h"
#include "base/ms_version.h"
#include "ms_view_embedded.h"

void ms_view_page_begin(FILE *stream, const char *title)
{
    fprintf(stream,
            "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n"
            "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src 'sha256-%s'; "
            "style-src 'sha256-%s'; img-src data:; base-uri 'none'; form-action 'none'\">\n"
            "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
            "<meta name=\"generator\" content=\"mskit " MS_VERSION "\">\n<title>",
            ms_view_script_hash, ms_view_style_hash);
    ms_escape_html(stream, title);
    fprintf(stream, "</title>\n<style>%s</style>\n<h1>", ms_view_style);
    ms_escape_html(stream, title);
    fputs("</h1>\n", stream);
}

void ms_view_page_viewer(FILE *stream)
{
    fputs(ms_view_frame, stream);
    fputs("<noscript><p>The picture takes JavaScript; the tables hold without it.</p></noscript>\n", stream);
}

void ms_view_page_measures(FILE *stream, const ms_metrics *metrics)
{
    fprintf(stream, "<table id=\"measures\">\n<tr><th>spheres<td class=\"number\">%zu<td>\n", metrics->spheres);
    for (const ms_measure *m = ms_measures; m->name; m++) {
        const double value = m->of_metrics(metrics);
        if (!isfinite(value)) {
            continue;
        }
        fputs("<tr title=\"", stream);
        ms_escape_html(stream, m->help);
        fputs("\"><th>", stream);
        /* elsewhere it follows the error of each moment */
        ms_escape_html(stream,
                       m == &ms_measures[MS_MEASURE_INERTIA] ? "error of the moments, weighted mean" : m->label);
        if (m->unit) {
            fprintf(stream, "<td class=\"number\">%.5g<td>%s\n", value, m->unit);
        } else {
            fprintf(stream, "<td class=\"number\">%.*f<td>\n", m->digits, value);
        }
    }
    fputs("</table>\n", stream);
}

/* For a shell first, then for HTML. */
static void put_words(FILE *stream, int argc, char *const *argv)
{
    fputs("mskit", stream);
    for (int w = 0; w < argc; w++) {
        putc(' ', stream);
        ms_escape_shell(stream, argv[w]);
    }
}

ms_status ms_view_page_command(FILE *stream, int argc, char *const *argv, ms_error *err)
{
    char *line = NULL;
    size_t size;
    FILE *words = open_memstream(&line, &size);
    int written = 0;
    if (words) {
        put_words(words, argc, argv);
        written = fclose(words) == 0 && line; /* glibc closes well without memory, too */
    }
    if (written) {
        fputs("<pre id=\"command\">", stream);
        ms_escape_html(stream, line);
        fputs("</pre>\n", stream);
    }
    free(line);
    return written ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for the command of the run");
}

/* Line by line: their ends are no text from outside. */
static void put_lines(FILE *stream, char *text)
{
    for (char *end; text; text = end) {
        end = strchr(text, '\n');
        if (end) {
            *end++ = '\0';
        }
        ms_escape_html(stream, text);
        putc('\n', stream);
    }
}

void ms_view_page_text(FILE *stream, char *text)
{
    fputs("<pre>", stream);
    put_lines(stream, text);
    fputs("</pre>\n", stream);
}

ms_status ms_view_page_record(FILE *stream, const char *json, ms_error *err)
{
    json_t *record = json_loads(json, 0, NULL);
    char *text = record ? json_dumps(record, JSON_INDENT(1)) : NULL;
    json_decref(record);
    if (!text) {
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the record of the run");
    }
    fputs("<details id=\"record\"><summary>all settings and scores</summary>", stream);
    ms_view_page_text(stream, text);
    fputs("</details>\n", stream);
    free(text);
    return MS_OK;
}

void ms_view_page_begin_scenes(FILE *stream)
{
    fputs("<script type=\"application/json\" id=\"scenes\">[", stream);
}

void ms_view_page_end(FILE *stream)
{
    fprintf(stream, "]</script>\n<script>%s</script>\n</html>\n", ms_view_script);
}
