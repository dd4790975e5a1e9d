#include "ms_exposed.h"

#include <math.h>
#include <stdlib.h>

#include "base/ms_vector.h"

void ms_exposed_free(ms_exposed *e)
{
    free(e->block);
    free(e->normal);
    *e = (ms_exposed){0};
}

int ms_exposed_alloc(ms_exposed *out, const ms_lattice *lattice, size_t count)
{
    const size_t most = (size_t)lattice->level[MS_LATTICE_LEVELS - 1].points;
    *out = (ms_exposed){.block = malloc((count / MS_CAPS_BLOCK + 1) * sizeof *out->block),
                        .normal = malloc(most * sizeof *out->normal)};
    if (!out->block || !out->normal) {
        ms_exposed_free(out);
    }
    return out->block != NULL;
}

/* Normals of the lattice at one level that are not covered, turned. */
static void list_level(ms_exposed *e, const ms_lattice *lattice, int which)
{
    const ms_lattice_level *level = &lattice->level[which];
    size_t first = 0;
    e->count = 0;
    e->points = level->points;
    for (int g = 0; g < level->groups; g++) {
        const ms_lattice_group *group = &level->group[g];
        if (which > 0 && ms_caps_cover_group(e->block, e->blocks, group->centre, group->cosine, group->sine)) {
            continue;
        }
        for (int p = group->first; p < group->first + group->count; p++) {
            const float *d = level->direction[p];
            if (ms_caps_cover(&first, e->block, e->blocks, d)) {
                continue;
            }
            const double at[3] = {(double)d[0], (double)d[1], (double)d[2]};
            for (int c = 0; c < 3; c++) {
                e->normal[e->count][c] = ms_dot(lattice->turn[c], at);
            }
            e->count++;
        }
    }
}

int ms_exposed_find(ms_exposed *out, const ms_lattice *lattice, const ms_caps_window *s, uint32_t self, int level,
                    int enough)
{
    out->blocks = ms_caps_find(out->block, s, self, lattice->turn);
    for (;; level++) {
        list_level(out, lattice, level);
        if (out->count >= enough || level == MS_LATTICE_LEVELS - 1) {
            return level;
        }
    }
}

double ms_exposed_depth(const ms_exposed *e, const ms_lattice *lattice, const double normal[3])
{
    double u[3] = {0}, last = 0;
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) {
            u[c] += lattice->turn[r][c] * normal[r];
        }
    }
    for (size_t b = 0; b < e->blocks; b++) {
        const ms_caps *c = &e->block[b];
        for (int i = 0; i < MS_CAPS_BLOCK; i++) {
            /* Where the ray leaves the other sphere: t^2 - 2 t u.axis + |axis|^2 - r^2 = 0. */
            const double along = (double)c->axis[0][i] * u[0] + (double)c->axis[1][i] * u[1] + (double)c->axis[2][i] * u[2];
            const double rest = along * along - (2 * (double)c->least[i] - 1);
            if (c->length[i] > 0 && rest > 0) {
                last = fmax(last, along + sqrt(rest));
            }
        }
    }
    return last < 1 ? 1 - last : 0;
}
