#include "ms_view_vtp.h"

#include <math.h>

/* Rings of points between the poles, and points on each. */
enum { RINGS = 9, SECTORS = 18, POINTS = RINGS * SECTORS + 2, TRIANGLES = 2 * RINGS * SECTORS };

static const double PI = 3.14159265358979323846;

/* Point of the unit sphere: the poles are the last two. */
static void unit_point(double out[3], int p)
{
    if (p >= RINGS * SECTORS) {
        out[0] = out[1] = 0;
        out[2] = p == RINGS * SECTORS ? 1 : -1;
        return;
    }
    const double down = PI * (p / SECTORS + 1) / (RINGS + 1), around = 2 * PI * (p % SECTORS) / SECTORS;
    out[0] = sin(down) * cos(around);
    out[1] = sin(down) * sin(around);
    out[2] = cos(down);
}

/* Corners of a triangle, seen from outside counter-clockwise: caps at the poles, two in each field between rings. */
static void corners(int out[3], int t)
{
    const int sector = t % SECTORS, next = (sector + 1) % SECTORS, row = t / SECTORS;
    if (row == 0) {
        out[0] = RINGS * SECTORS;
        out[1] = sector;
        out[2] = next;
    } else if (row == 2 * RINGS - 1) {
        out[0] = RINGS * SECTORS + 1;
        out[1] = (RINGS - 1) * SECTORS + next;
        out[2] = (RINGS - 1) * SECTORS + sector;
    } else {
        const int above = (row - 1) / 2 * SECTORS, below = above + SECTORS;
        out[0] = above + (row % 2 ? sector : next);
        out[1] = below + sector;
        out[2] = row % 2 ? above + next : below + next;
    }
}

static void put_points(FILE *stream, const ms_clump *clump, int normals)
{
    fprintf(stream, "<DataArray type=\"Float64\" Name=\"%s\" NumberOfComponents=\"3\" format=\"ascii\">\n",
            normals ? "Normals" : "Points");
    for (size_t p = 0; p < clump->n_spheres * POINTS; p++) {
        const ms_sphere *s = &clump->sphere[p / POINTS];
        double u[3];
        unit_point(u, (int)(p % POINTS));
        if (normals) {
            fprintf(stream, "%.5f %.5f %.5f\n", u[0], u[1], u[2]);
        } else {
            fprintf(stream, "%.9g %.9g %.9g\n", s->centre[0] + s->radius * u[0], s->centre[1] + s->radius * u[1],
                    s->centre[2] + s->radius * u[2]);
        }
    }
    fputs("</DataArray>\n", stream);
}

static void put_triangles(FILE *stream, size_t spheres)
{
    fputs("<Polys>\n<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">\n", stream);
    for (size_t t = 0; t < spheres * TRIANGLES; t++) {
        const size_t first = t / TRIANGLES * POINTS;
        int c[3];
        corners(c, (int)(t % TRIANGLES));
        fprintf(stream, "%zu %zu %zu\n", first + (size_t)c[0], first + (size_t)c[1], first + (size_t)c[2]);
    }
    fputs("</DataArray>\n<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">\n", stream);
    for (size_t t = 1; t <= spheres * TRIANGLES; t++) {
        fprintf(stream, "%zu\n", 3 * t);
    }
    fputs("</DataArray>\n</Polys>\n", stream);
}

static void put_values(FILE *stream, const ms_clump *clump, const char *name)
{
    fprintf(stream, "<DataArray type=\"Float64\" Name=\"%s\" format=\"ascii\">\n", name);
    for (size_t t = 0; t < clump->n_spheres * TRIANGLES; t++) {
        const size_t s = t / TRIANGLES;
        fprintf(stream, "%.9g\n",
                name[0] == 'i'   ? (double)(s + 1)
                : name[0] == 'r' ? clump->sphere[s].radius
                                 : clump->mass[s]);
    }
    fputs("</DataArray>\n", stream);
}

ms_status ms_view_vtp_write(FILE *stream, const ms_content *content, ms_error *err)
{
    const ms_clump *clump = content->clump;
    (void)err;
    fprintf(stream,
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
            "header_type=\"UInt64\">\n<PolyData>\n<Piece NumberOfPoints=\"%zu\" NumberOfPolys=\"%zu\">\n<Points>\n",
            clump->n_spheres * POINTS, clump->n_spheres * TRIANGLES);
    put_points(stream, clump, 0);
    fputs("</Points>\n<PointData Normals=\"Normals\">\n", stream);
    put_points(stream, clump, 1);
    fputs("</PointData>\n<CellData Scalars=\"index\">\n", stream);
    put_values(stream, clump, "index");
    put_values(stream, clump, "radius");
    if (clump->mass) {
        put_values(stream, clump, "mass");
    }
    fputs("</CellData>\n", stream);
    put_triangles(stream, clump->n_spheres);
    fputs("</Piece>\n</PolyData>\n</VTKFile>\n", stream);
    return MS_OK;
}
