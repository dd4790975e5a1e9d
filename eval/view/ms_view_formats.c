#include "ms_view_formats.h"

#include <math.h>
#include <string.h>

#include "base/ms_choice.h"
#include "base/ms_file.h"
#include "chart/ms_render.h"
#include "clump/ms_clump_surface.h"
#include "clump/ms_union.h"
#include "mesh/formats/ms_mesh_write.h"
#include "ms_view_page.h"
#include "ms_view_scene.h"
#include "ms_view_vtp.h"

/* Triangles of a shape on a page at most, and pixels of a picture of the clump or the shape. */
enum { PAGE_TRIANGLES = 100000, PIXELS = 600 };

/* Cells along the shortest side where no one says how many, and points of the lattice. */
static const double CELLS = 100;
static const size_t MAX_POINTS = (size_t)1 << 31;

static const ms_view_about *about_of(const ms_content *content)
{
    static const ms_view_about NOTHING = {0};
    return content->more ? content->more : &NOTHING;
}

static double shortest_side(const ms_clump *clump)
{
    double lo[3], hi[3];
    ms_clump_box(lo, hi, clump);
    return fmin(hi[0] - lo[0], fmin(hi[1] - lo[1], hi[2] - lo[2]));
}

static ms_status make_surface(ms_mesh *mesh, const ms_content *content, ms_error *err)
{
    const ms_view_about *about = about_of(content);
    const double h = about->h > 0 ? about->h : shortest_side(content->clump) / CELLS;
    return ms_clump_surface(mesh, content->clump, h, about->max_points ? about->max_points : MAX_POINTS, err);
}

/* What the surface does not show; its mesh is linked anew for that. */
static ms_status remark_on(char remark[MS_WRITE_REMARK], ms_mesh *mesh, const ms_clump *clump, ms_error *err)
{
    ms_mesh_report report;
    ms_body body;
    double volume, area;
    size_t pieces;
    ms_status status = ms_mesh_repair(mesh, &report, err);
    if (status == MS_OK) {
        status = ms_inertia_mesh(&body, mesh, err);
    }
    if (status == MS_OK) {
        status = ms_union_measure(&volume, &area, clump, err);
    }
    if (status == MS_OK) {
        status = ms_clump_pieces(&pieces, clump, err);
    }
    if (status == MS_OK && (report.bodies != pieces || body.volume < 0.98 * volume)) {
        snprintf(remark, MS_WRITE_REMARK,
                 "the surface has %zu pieces and %.1f %% of the volume of the spheres, which are %zu pieces; more "
                 "--cells show more of them",
                 report.bodies, 100 * body.volume / volume, pieces);
    }
    return status;
}

static ms_status write_surface(FILE *stream, const ms_content *content, const char *ending, ms_error *err)
{
    ms_mesh mesh;
    char *remark = about_of(content)->remark;
    ms_status status = make_surface(&mesh, content, err);
    if (status != MS_OK) {
        return status;
    }
    status = ms_mesh_write_stream(&mesh, stream, ending, err);
    if (status == MS_OK && remark) {
        status = remark_on(remark, &mesh, content->clump, err);
    }
    ms_mesh_free(&mesh);
    return status == MS_ERR_IO ? MS_OK : status; /* who closes the stream says why it failed */
}

static ms_status write_stl(FILE *stream, const ms_content *content, ms_error *err)
{
    return write_surface(stream, content, "stl", err);
}

static ms_status write_ply(FILE *stream, const ms_content *content, ms_error *err)
{
    return write_surface(stream, content, "ply", err);
}

static ms_status write_obj(FILE *stream, const ms_content *content, ms_error *err)
{
    return write_surface(stream, content, "obj", err);
}

/* The shape, if it is known, and beside it the clump, seen alike. */
static ms_status write_png(FILE *stream, const ms_content *content, ms_error *err)
{
    const ms_target *target = about_of(content)->target;
    ms_picture picture;
    ms_view view;
    ms_status status = ms_render_picture_alloc(&picture, target ? 2 * PIXELS : PIXELS, PIXELS, err);
    if (status != MS_OK) {
        return status;
    }
    status = target ? ms_render_view(&view, target, 0, 0, PIXELS, err)
                    : ms_render_clump_view(&view, content->clump, 0, 0, PIXELS, err);
    if (status == MS_OK) {
        if (target) {
            ms_render_target(&picture, &view, target);
            view.x = PIXELS;
        }
        ms_render_clump(&picture, &view, content->clump);
        status = ms_render_picture_put(stream, &picture, err);
    }
    ms_render_picture_free(&picture);
    return status;
}

/* What stands beside the picture. */
static ms_status write_words(FILE *stream, const ms_content *content, const ms_view_about *about, ms_error *err)
{
    ms_status status = MS_OK;
    fputs("<div id=\"about\">\n", stream);
    if (about->metrics) {
        fputs("<h2>measures</h2>\n", stream);
        ms_view_page_measures(stream, about->metrics);
    }
    if (about->argv || content->record) {
        fputs("<h2>how it was made</h2>\n", stream);
    }
    if (about->argv) {
        status = ms_view_page_command(stream, about->argc, about->argv, err);
    }
    if (status == MS_OK && content->record) {
        status = ms_view_page_record(stream, content->record, err);
    }
    fputs("</div>\n", stream);
    return status;
}

static ms_status write_html(FILE *stream, const ms_content *content, ms_error *err)
{
    const ms_view_about *about = about_of(content);
    const ms_view_scene scene = {.name = about->shape ? about->shape : "the clump alone",
                                 .clump = content->clump,
                                 .target = about->target,
                                 .ordered = about->ordered,
                                 .most_triangles = PAGE_TRIANGLES,
                                 .with_field = 1};
    ms_view_page_begin(stream, content->name);
    fputs("<main>\n", stream);
    ms_view_page_viewer(stream);
    ms_status status = write_words(stream, content, about, err);
    fputs("</main>\n", stream);
    ms_view_page_begin_scenes(stream);
    if (status == MS_OK) {
        status = ms_view_scene_write(stream, &scene, err);
    }
    ms_view_page_end(stream);
    return status;
}

const ms_format ms_view_formats[] = {
    {"html", "html", "a page that shows spheres and shape in a browser, with the measures", MS_NEED_SPHERES, NULL,
     .part = {{"", write_html}}},
    {"stl", "stl", "the closed surface of the union", MS_NEED_SPHERES, NULL, .part = {{"", write_stl}}},
    {"ply", "ply", "likewise", MS_NEED_SPHERES, NULL, .part = {{"", write_ply}}},
    {"obj", "obj", "likewise", MS_NEED_SPHERES, NULL, .part = {{"", write_obj}}},
    {"vtp", "vtp", "the spheres as surfaces, for ParaView", MS_NEED_SPHERES, NULL, .part = {{"", ms_view_vtp_write}}},
    {"png", "png", "a picture of shape and spheres", MS_NEED_SPHERES, NULL, .part = {{"", write_png}}},
    {0},
};

const ms_format *ms_view_format_find(const char *name, ms_error *err)
{
    static const ms_format *const TABLES[] = {ms_formats, ms_view_formats};
    ms_choice choice = {.typed = name};
    for (int t = 0; t < 2; t++) {
        for (const ms_format *f = TABLES[t]; f->name; f++) {
            if (ms_choice_offer(&choice, f->name)) {
                return f;
            }
        }
    }
    ms_choice_fail(&choice, err, "there is no clump format '%s'", name);
    return NULL;
}

const ms_format *ms_view_format_of_path(const char *path, ms_error *err)
{
    ms_error none;
    char ending[16];
    const ms_format *found = ms_write_format_of_path(path, &none);
    ms_file_ending(ending, path);
    return found ? found : ms_view_format_find(ending, err);
}

int ms_view_format_is(const ms_format *format)
{
    return format >= ms_view_formats && format < ms_view_formats + sizeof ms_view_formats / sizeof *ms_view_formats;
}
