#include "ms_long_edges.h"

#include <math.h>

#include "base/ms_vector.h"

/* Edges that are longer than so many times the size of a sphere's share, d_eq / n^(1/3), let the spheres reach out: D
 * of cubes of 8 to 3458 nodes by 2 to 1000 spheres is then above that of finer meshes (docs/methods/fcm.md). */
static const double EDGE_OF_SHARE = 1.5;

/* Mean over the surface of the longest edge of a triangle. */
static double mean_edge(const ms_mesh *mesh)
{
    double sum = 0, area = 0;
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        double side[3][3], normal[3], longest = 0;
        for (int s = 0; s < 3; s++) {
            const double *from = mesh->vertex[mesh->triangle[t][s]], *to = mesh->vertex[mesh->triangle[t][(s + 1) % 3]];
            for (int a = 0; a < 3; a++) {
                side[s][a] = to[a] - from[a];
            }
            longest = fmax(longest, ms_dot(side[s], side[s]));
        }
        ms_cross(normal, side[0], side[1]);
        const double twice = sqrt(ms_dot(normal, normal));
        sum += twice * sqrt(longest);
        area += twice;
    }
    return area > 0 ? sum / area : 0;
}

void ms_long_edges_remark(const ms_run *run, size_t n)
{
    const ms_mesh *mesh = run->target->mesh;
    const double deq = 2 * ms_target_equivalent_radius(run->target);
    const double most = deq * fmin(1, EDGE_OF_SHARE / cbrt((double)n)), edge = mesh ? mean_edge(mesh) : 0;
    if (edge > most) {
        ms_generator_remark(run,
                            "the edges of the mesh are long, %.2g times the diameter d_eq of the ball of equal volume: "
                            "spheres reach to its nodes and stand out of the faces between; refine the mesh to edges "
                            "below %.2g d_eq for %zu spheres, or use another method",
                            edge / deq, most / deq, n);
    }
}
