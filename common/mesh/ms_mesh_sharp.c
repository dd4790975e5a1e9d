#include "ms_mesh_sharp.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/ms_vector.h"
#include "ms_mesh_edges.h"

/* Twice the area over the longest side squared, below which rounding makes the normal. */
static const double SLIVER = 1e-6;

/* Of length 1. @return 0 for a face that has none */
static int find_face_normal(double normal[3], const ms_mesh *mesh, size_t triangle)
{
    const uint32_t *t = mesh->triangle[triangle];
    double longest = 0;
    ms_vector_triangle(normal, mesh->vertex[t[0]], mesh->vertex[t[1]], mesh->vertex[t[2]]);
    for (int k = 0; k < 3; k++) {
        longest = fmax(longest, ms_squared_distance(mesh->vertex[t[k]], mesh->vertex[t[(k + 1) % 3]]));
    }
    const double length = sqrt(ms_dot(normal, normal));
    for (int a = 0; a < 3; a++) {
        normal[a] /= length;
    }
    return length > SLIVER * longest;
}

static int is_sharp(const ms_mesh *mesh, const ms_edges *edges, size_t e, double cosine)
{
    double one[3], other[3];
    const uint32_t *side = edges->side + edges->start[e];
    if (edges->start[e + 1] - edges->start[e] != 2) {
        return 1;
    }
    return find_face_normal(one, mesh, side[0] / 3) && find_face_normal(other, mesh, side[1] / 3) &&
           ms_dot(one, other) < cosine;
}

ms_status ms_mesh_sharp_edges(ms_mesh *edges, const ms_mesh *mesh, double degrees, ms_error *err)
{
    ms_edges all;
    size_t count = 0, at = 0;
    const double cosine = cos(degrees / MS_VECTOR_DEGREES);
    memset(edges, 0, sizeof *edges);
    ms_status status = ms_edges_build(&all, mesh, err);
    uint8_t *sharp = status == MS_OK ? calloc(all.n + 1, 1) : NULL;
    if (status == MS_OK && !sharp) {
        status = ms_fail(err, MS_ERR_NOMEM, "no memory for %zu edges", all.n);
    }
    for (size_t e = 0; status == MS_OK && e < all.n; e++) {
        sharp[e] = (uint8_t)is_sharp(mesh, &all, e, cosine);
        count += sharp[e];
    }
    if (status == MS_OK && count > 0) {
        status = ms_mesh_alloc(edges, 2 * count, count, err);
    }
    for (size_t e = 0; edges->n_triangles > 0 && e < all.n; e++) {
        if (sharp[e]) {
            const uint32_t side = all.side[all.start[e]], from = (uint32_t)(2 * at), to = from + 1;
            memcpy(edges->vertex[from], mesh->vertex[ms_mesh_edges_side_from(mesh, side)], sizeof *edges->vertex);
            memcpy(edges->vertex[to], mesh->vertex[ms_side_to(mesh, side)], sizeof *edges->vertex);
            memcpy(edges->triangle[at++], (const uint32_t[3]){from, to, to}, sizeof *edges->triangle);
        }
    }
    free(sharp);
    ms_mesh_edges_free(&all);
    return status;
}
