/** Voxel sets for tests, and their topology by brute force: simple voxels, components, Euler characteristic. */
#ifndef TOPOLOGY_SAMPLES_H
#define TOPOLOGY_SAMPLES_H

#include "grid_samples.h"

/* Connected through corners or through faces. */
enum { BY_CORNERS = 3, BY_FACES = 1 };

/* How many coordinates differ at most by 1: 0 the same voxel, 1 a face, 2 an edge, 3 a corner; 9 apart. */
static inline int steps_between(int a, int b)
{
    int steps = 0;
    for (int axis = 0; axis < 3; axis++, a /= 3, b /= 3) {
        const int step = abs(a % 3 - b % 3);
        steps = step > 1 ? 9 : steps + step;
    }
    return steps > 3 ? 9 : steps;
}

/** Voxel b of a neighbourhood (ms_clique.h), moved by `by`, or -1 if it then lies outside. */
static inline int moved(int b, const int by[3])
{
    const int x = b % 3 + by[0], y = b / 3 % 3 + by[1], z = b / 9 + by[2];
    return x < 0 || y < 0 || z < 0 || x > 2 || y > 2 || z > 2 ? -1 : x + 3 * y + 9 * z;
}

static inline uint32_t bit_of(int b)
{
    return UINT32_C(1) << b;
}

/** What a breadth-first search reaches in `set` from voxel `start`. */
static inline uint32_t reached(uint32_t set, int start, int connected)
{
    int queue[27], head = 0, tail = 0;
    uint32_t found = bit_of(start);
    queue[tail++] = start;
    while (head < tail) {
        const int from = queue[head++];
        for (int b = 0; b < 27; b++) {
            if ((set & ~found & bit_of(b)) && steps_between(from, b) <= connected) {
                found |= bit_of(b);
                queue[tail++] = b;
            }
        }
    }
    return found;
}

/** Theorem 1 of Yuan 2019, word by word; the centre is bit 13. */
static inline int brute_is_simple(uint32_t object)
{
    uint32_t others = 0, beside = 0, ground = 0;
    int other = -1, face = -1;
    for (int b = 0; b < 27; b++) {
        const int steps = steps_between(13, b), is_object = (object & bit_of(b)) != 0;
        if (steps > 0 && is_object) {
            others |= bit_of(b);
            other = b;
        }
        if (steps > 0 && steps <= 2 && !is_object) {
            ground |= bit_of(b);
        }
        if (steps == 1 && !is_object) {
            beside |= bit_of(b);
            face = b;
        }
    }
    return other >= 0 && face >= 0 && reached(others, other, BY_CORNERS) == others &&
           (beside & ~reached(ground, face, BY_FACES)) == 0;
}

/** A neighbourhood with about that share of voxels set. */
static inline uint32_t random_word(uint64_t *seed, double fill)
{
    uint32_t word = 0;
    for (int b = 0; b < 27; b++) {
        word |= (uint32_t)(next_uniform(seed) < fill) << b;
    }
    return word;
}

/** The neighbourhood of a voxel that is not on the rim of the grid. */
static inline uint32_t neighbours_at(const ms_grid *grid, const uint8_t *field, int i, int j, int k)
{
    uint32_t word = 0;
    for (int b = 0; b < 27; b++) {
        word |= (uint32_t)field[ms_grid_index(grid, i + b % 3 - 1, j + b / 3 % 3 - 1, k + b / 9 - 1)] << b;
    }
    return word;
}

/** The grid's coordinates of voxel v. */
static inline void place_of(int at[3], const ms_grid *grid, size_t v)
{
    const size_t nx = (size_t)grid->n[0], ny = (size_t)grid->n[1];
    at[0] = (int)(v % nx);
    at[1] = (int)(v / nx % ny);
    at[2] = (int)(v / nx / ny);
}

/* Marks the component of the voxel that is on the stack. */
static inline void flood(uint8_t *seen, size_t *stack, const ms_grid *grid, int connected)
{
    int way[26], ways = 0;
    for (int b = 0; b < 27; b++) {
        if (b != 13 && steps_between(13, b) <= connected) {
            way[ways++] = b;
        }
    }
    for (size_t count = 1; count > 0;) {
        const size_t v = stack[--count];
        int at[3];
        place_of(at, grid, v);
        for (int w = 0; w < ways; w++) {
            const int x = at[0] + way[w] % 3 - 1, y = at[1] + way[w] / 3 % 3 - 1, z = at[2] + way[w] / 9 - 1;
            if (x < 0 || y < 0 || z < 0 || x >= grid->n[0] || y >= grid->n[1] || z >= grid->n[2]) {
                continue;
            }
            const size_t next = ms_grid_index(grid, x, y, z);
            if (!seen[next] && grid->inside[next] == grid->inside[v]) {
                seen[next] = 1;
                stack[count++] = next;
            }
        }
    }
}

/** Number of components of the voxels of that value. */
static inline int components(const ms_grid *grid, int value, int connected)
{
    const size_t voxels = ms_grid_voxels(grid);
    uint8_t *seen = calloc(voxels, 1);
    size_t *stack = malloc(voxels * sizeof *stack);
    int count = 0;
    assert_non_null(seen);
    assert_non_null(stack);
    for (size_t v = 0; v < voxels; v++) {
        if (grid->inside[v] == value && !seen[v]) {
            seen[v] = 1;
            stack[0] = v;
            flood(seen, stack, grid, connected);
            count++;
        }
    }
    free(seen);
    free(stack);
    return count;
}

/* The eight voxels around a corner, the one at (i, j, k) first and those before it along x, y, z
 * after it, as bits. */
static inline unsigned around_corner(const ms_grid *grid, int i, int j, int k)
{
    unsigned word = 0;
    for (int b = 0; b < 8; b++) {
        word |= (unsigned)inside_at(grid, i - (b & 1), j - (b >> 1 & 1), k - (b >> 2)) << b;
    }
    return word;
}

/** Corners - edges + squares - voxels of the union of the closed voxels, none of them on the rim. */
static inline long euler_characteristic(const ms_grid *grid)
{
    /* The cells of the voxel at a corner that hold the corner, by the axes across which they are
     * thin (bits of `thin`), and the voxels that hold the cell: b with no other bits. */
    const unsigned holders_of[8] = {0x01, 0x03, 0x05, 0x0f, 0x11, 0x33, 0x55, 0xff};
    const int sign[8] = {-1, 1, 1, -1, 1, -1, -1, 1};
    long sum = 0;
    for (int k = 1; k < grid->n[2]; k++) {
        for (int j = 1; j < grid->n[1]; j++) {
            for (int i = 1; i < grid->n[0]; i++) {
                const unsigned word = around_corner(grid, i, j, k);
                for (int thin = 0; thin < 8; thin++) {
                    sum += (word & holders_of[thin]) ? sign[thin] : 0;
                }
            }
        }
    }
    return sum;
}

/** What thinning must not change. */
typedef struct topology {
    int pieces, cavities;
    long tunnels;
} topology;

/** Topology of a grid whose outermost layer is background. */
static inline topology topology_of(const ms_grid *grid)
{
    topology t = {components(grid, 1, BY_CORNERS), components(grid, 0, BY_FACES) - 1, 0};
    t.tunnels = t.pieces + t.cavities - euler_characteristic(grid);
    return t;
}

/** The centre of voxel v seen from the middle of the grid, in voxels. */
static inline void from_middle(double p[3], const ms_grid *grid, size_t v)
{
    int at[3];
    place_of(at, grid, v);
    for (int a = 0; a < 3; a++) {
        p[a] = at[a] - 0.5 * (grid->n[a] - 1);
    }
}

static inline ms_grid copy_of(const ms_grid *grid)
{
    ms_grid copy = empty_grid(grid->n[0], grid->n[1], grid->n[2], 1);
    memcpy(copy.inside, grid->inside, ms_grid_voxels(grid));
    return copy;
}

/** Neighbours of a voxel of the grid, through faces or all. */
static inline int count_neighbours(const ms_grid *grid, const int at[3], int connected)
{
    int count = 0;
    for (int b = 0; b < 27; b++) {
        const int x = at[0] + b % 3 - 1, y = at[1] + b / 3 % 3 - 1, z = at[2] + b / 9 - 1;
        count += b != 13 && steps_between(13, b) <= connected && inside_at(grid, x, y, z);
    }
    return count;
}

/** How many voxels it is from a voxel out of the set: back and forth along x, y and z. */
static inline void ways_out(int way[6], const ms_grid *grid, const int from[3])
{
    for (int face = 0; face < 6; face++) {
        int at[3] = {from[0], from[1], from[2]};
        for (way[face] = 0; inside_at(grid, at[0], at[1], at[2]); way[face]++) {
            at[face / 2] += face % 2 ? 1 : -1;
        }
    }
}

static inline int least_of(const int *values, int count)
{
    int least = values[0];
    for (int i = 1; i < count; i++) {
        least = values[i] < least ? values[i] : least;
    }
    return least;
}

/** A body by a function that is negative inside; coordinates in voxels from the middle of the grid. */
typedef double (*level)(const double p[3], const double *value);

static inline ms_grid body_grid(const int n[3], level body, const double *value)
{
    ms_grid grid = empty_grid(n[0], n[1], n[2], 1);
    for (size_t v = 0; v < ms_grid_voxels(&grid); v++) {
        double p[3];
        from_middle(p, &grid, v);
        grid.inside[v] = body(p, value) < 0;
    }
    return grid;
}

/* Radius about the axis, radius of the tube. */
static inline double torus(const double p[3], const double *value)
{
    return hypot(hypot(p[0], p[1]) - value[0], p[2]) - value[1];
}

static inline double joined_tori(const double p[3], const double *value)
{
    const double left[3] = {p[0] + value[0], p[1], p[2]}, right[3] = {p[0] - value[0], p[1], p[2]};
    return fmin(torus(left, value), torus(right, value));
}

static inline double linked_rings(const double p[3], const double *value)
{
    const double flat[3] = {p[0] + 0.5 * value[0], p[1], p[2]}, upright[3] = {p[0] - 0.5 * value[0], p[2], p[1]};
    return fmin(torus(flat, value), torus(upright, value));
}

/* Semi-axes. */
static inline double ellipsoid(const double p[3], const double *value)
{
    const double x = p[0] / value[0], y = p[1] / value[1], z = p[2] / value[2];
    return x * x + y * y + z * z - 1;
}

/* Outer radius, inner radius. */
static inline double shell(const double p[3], const double *value)
{
    const double r = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    return fmax(r - value[0], value[1] - r);
}

/* Half the length, radius, axis. */
static inline double cylinder(const double p[3], const double *value)
{
    const int axis = (int)value[2];
    return fmax(fabs(p[axis]) - value[0], hypot(p[(axis + 1) % 3], p[(axis + 2) % 3]) - value[1]);
}

/* Half the sides. */
static inline double cuboid_level(const double p[3], const double *value)
{
    return fmax(fabs(p[0]) - value[0], fmax(fabs(p[1]) - value[1], fabs(p[2]) - value[2]));
}

static inline void clear_rim(ms_grid *grid)
{
    for (size_t v = 0; v < ms_grid_voxels(grid); v++) {
        int at[3];
        place_of(at, grid, v);
        for (int a = 0; a < 3; a++) {
            grid->inside[v] &= at[a] > 0 && at[a] < grid->n[a] - 1;
        }
    }
}

static inline ms_grid noise(int nx, int ny, int nz, double fill, uint64_t *seed)
{
    ms_grid grid = empty_grid(nx, ny, nz, 1);
    for (size_t v = 0; v < ms_grid_voxels(&grid); v++) {
        grid.inside[v] = next_uniform(seed) < fill;
    }
    clear_rim(&grid);
    return grid;
}

/* Means of three along an axis, in place: what is behind is smooth already. */
static inline void smooth(double *field, const ms_grid *grid, size_t stride)
{
    for (size_t v = stride; v + stride < ms_grid_voxels(grid); v++) {
        field[v] = (field[v - stride] + field[v] + field[v + stride]) / 3;
    }
}

/** A random field, smoothed, above its mean by that share of its spread. */
static inline ms_grid blobs(const int n[3], int rounds, double above, uint64_t *seed)
{
    ms_grid grid = empty_grid(n[0], n[1], n[2], 1);
    const size_t voxels = ms_grid_voxels(&grid);
    double *field = malloc(voxels * sizeof *field), sum = 0, squares = 0;
    assert_non_null(field);
    for (size_t v = 0; v < voxels; v++) {
        field[v] = next_uniform(seed);
    }
    for (int round = 0; round < 3 * rounds; round++) {
        smooth(field, &grid, (size_t[]){1, (size_t)n[0], (size_t)n[0] * (size_t)n[1]}[round % 3]);
    }
    for (size_t v = 0; v < voxels; v++) {
        sum += field[v];
        squares += field[v] * field[v];
    }
    const double mean = sum / (double)voxels, spread = sqrt(squares / (double)voxels - mean * mean);
    for (size_t v = 0; v < voxels; v++) {
        grid.inside[v] = field[v] > mean + above * spread;
    }
    free(field);
    clear_rim(&grid);
    return grid;
}

static inline ms_grid random_blobs(int least, int most, uint64_t *seed)
{
    int n[3];
    for (int a = 0; a < 3; a++) {
        n[a] = least + pick(seed, most - least + 1);
    }
    return blobs(n, 1 + pick(seed, 3), between(seed, -1.5, 1.2), seed);
}

#endif
