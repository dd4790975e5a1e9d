#include "ms_exposed.h"

#include <math.h>
#include <stdlib.h>

void ms_exposed_free(ms_exposed *e)
{
    ms_caps_list_free(&e->caps);
    free(e->coarse);
    free(e->fine);
    free(e->normal);
    *e = (ms_exposed){0};
}

int ms_exposed_alloc(ms_exposed *out, const ms_lattice *lattice, size_t count)
{
    const size_t most = (size_t)lattice->level[MS_LATTICE_LEVELS - 1].points;
    const size_t blocks = count / MS_CAPS_BLOCK + 1;
    *out = (ms_exposed){.coarse = malloc(blocks * sizeof *out->coarse),
                        .fine = malloc(blocks * sizeof *out->fine),
                        .normal = malloc(most * sizeof *out->normal)};
    if (!ms_caps_list_alloc(&out->caps, count) || !out->coarse || !out->fine || !out->normal) {
        ms_exposed_free(out);
    }
    return out->normal != NULL;
}

/* Adds those normals of a fine group that are not covered, turned. */
static void list_group(ms_exposed *e, const ms_lattice *lattice, const ms_lattice_level *level,
                       const ms_lattice_group *group, size_t blocks)
{
    size_t first = 0;
    for (int p = group->first; p < group->first + group->count; p++) {
        const float *d = level->direction[p];
        if (ms_caps_cover(&first, e->fine, blocks, d)) {
            continue;
        }
        ms_lattice_normal(e->normal[e->count++], lattice, d);
    }
}

/* The normals of the lattice at one level that are not covered. */
static void list_level(ms_exposed *e, const ms_lattice *lattice, int which)
{
    const ms_lattice_level *level = &lattice->level[which];
    e->count = 0;
    e->points = level->points;
    for (int c = 0; c < level->coarses; c++) {
        const ms_lattice_group *coarse = &level->coarse[c];
        const int near =
            ms_caps_narrow(e->coarse, e->caps.block, e->caps.blocks, coarse->centre, coarse->cosine, coarse->sine);
        for (int f = coarse->first; near >= 0 && f < coarse->first + coarse->count; f++) {
            const ms_lattice_group *fine = &level->fine[f];
            const int nearer = ms_caps_narrow(e->fine, e->coarse, (size_t)near, fine->centre, fine->cosine, fine->sine);
            if (nearer >= 0) {
                list_group(e, lattice, level, fine, (size_t)nearer);
            }
        }
    }
}

int ms_exposed_find(ms_exposed *out, const ms_lattice *lattice, const ms_caps_window *s, uint32_t self, int level,
                    int enough)
{
    ms_caps_find(&out->caps, s, self, lattice->turn);
    for (;; level++) {
        list_level(out, lattice, level);
        if (out->count >= enough || level == MS_LATTICE_LEVELS - 1) {
            return level;
        }
    }
}

double ms_exposed_depth(const ms_exposed *e, const double normal[3])
{
    double last = 0;
    for (size_t b = 0; b < e->caps.nears; b++) {
        const ms_caps *c = &e->caps.near[b];
        for (int i = 0; i < MS_CAPS_BLOCK; i++) {
            /* Where the ray leaves the other sphere: t^2 - 2 t u.axis + |axis|^2 - r^2 = 0. */
            const double along = (double)c->axis[0][i] * normal[0] + (double)c->axis[1][i] * normal[1] +
                                 (double)c->axis[2][i] * normal[2];
            const double rest = along * along - (2 * (double)c->least[i] - 1);
            if (c->length[i] > 0 && rest > 0) {
                last = fmax(last, along + sqrt(rest));
            }
        }
    }
    return last < 1 ? 1 - last : 0;
}
