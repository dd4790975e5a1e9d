#include "ms_tally.h"

#include <string.h>

void ms_tally_add(ms_tally *sum, const ms_tally *part)
{
    sum->inside += part->inside;
    sum->outside += part->outside;
    sum->cut += part->cut;
    for (int m = 0; m < 3; m++) {
        sum->first[m] += part->first[m];
    }
    for (int m = 0; m < 6; m++) {
        sum->second[m] += part->second[m];
    }
}

void ms_tally_body(ms_body *body, const ms_tally *sum, const ms_grid *grid)
{
    static const int AXES[6][2] = {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
    const double count = (double)(sum->inside + sum->outside), h = grid->h;
    double moment[6]; /* second central moments, in voxels */
    memset(body, 0, sizeof *body);
    if (!(count > 0)) {
        return;
    }
    body->volume = count * h * h * h;
    for (int m = 0; m < 6; m++) {
        const int a = AXES[m][0], b = AXES[m][1];
        moment[m] = (double)sum->second[m] - (double)sum->first[a] / count * (double)sum->first[b];
        moment[m] += a == b ? count / 12 : 0; /* a voxel is a cube, not a point */
        moment[m] *= h * h * h * h * h;
    }
    for (int a = 0; a < 3; a++) {
        body->centroid[a] = grid->origin[a] + h * (double)sum->first[a] / count;
        body->inertia[a][a] = moment[0] + moment[1] + moment[2] - moment[a];
    }
    for (int m = 3; m < 6; m++) {
        const int a = AXES[m][0], b = AXES[m][1];
        body->inertia[a][b] = body->inertia[b][a] = -moment[m];
    }
}
