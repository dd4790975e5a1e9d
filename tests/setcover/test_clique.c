/* Simple voxels and cliques against brute force from their definitions. */
#include "setcover/ms_clique.h"
#include "support/topology_samples.h"

enum { ALL = 0777777777, CENTRE = 1 << MS_CLIQUE_CENTRE };

static void expect_simple(uint32_t object)
{
    const int expected = brute_is_simple(object);
    if (!ms_clique_is_simple(object) != !expected) {
        fail_msg("neighbourhood %09o: expected %s", object, expected ? "simple" : "not simple");
    }
    if (!ms_clique_is_simple(object ^ CENTRE) != !expected) {
        fail_msg("neighbourhood %09o: the centre's own bit matters", object);
    }
}

static void random_neighbourhoods_agree_with_the_definition(void **state)
{
    (void)state;
    uint64_t seed = 31;
    for (int run = 0; run < 200000; run++) {
        expect_simple(random_word(&seed, (run % 19 + 1) / 20.0));
    }
}

static void nearly_empty_and_nearly_full_neighbourhoods_agree(void **state)
{
    (void)state;
    for (int a = 0; a < 27; a++) {
        for (int b = 0; b < 27; b++) {
            for (int c = 0; c < 27; c++) {
                const uint32_t few = bit_of(a) | bit_of(b) | bit_of(c);
                expect_simple(few);
                expect_simple(ALL & ~few);
            }
        }
    }
    expect_simple(0);
    expect_simple(ALL);
}

static void known_neighbourhoods(void **state)
{
    (void)state;
    const uint32_t below = 0000000777; /* the layer z = -1 */
    assert_false(ms_clique_is_simple(0));
    assert_false(ms_clique_is_simple(CENTRE));
    assert_false(ms_clique_is_simple(ALL));
    assert_false(ms_clique_is_simple(0777757777));
    assert_true(ms_clique_is_simple(below));
    assert_true(ms_clique_is_simple(1));                  /* the tip of a curve */
    assert_false(ms_clique_is_simple(0400000001));        /* the middle of a curve */
    assert_false(ms_clique_is_simple(0000777000));        /* the middle of a surface */
    assert_true(ms_clique_is_simple(ALL & ~0000000020));  /* one face bare */
    assert_false(ms_clique_is_simple(ALL & ~0020000020)); /* two opposite ones: a tunnel would open */
    assert_false(ms_clique_is_simple(ALL & ~0000000001)); /* a corner bare: the voxel is interior */
}

/* The surface of a cube as cells: bits 0 to 7 its corners, 8 to 19 its edges, 20 to 25 its
 * squares. A cell has the place (0 to 26) of the neighbour that touches the cube just there. */
enum { CORNERS = 0xff, GRAPH = 0xfffff };

static void list_cells(int place[26])
{
    int count = 0;
    for (int steps = 3; steps > 0; steps--) {
        for (int b = 0; b < 27; b++) {
            if (steps_between(MS_CLIQUE_CENTRE, b) == steps) {
                place[count++] = b;
            }
        }
    }
    assert_int_equal(count, 26);
}

/* Does neighbour b hold the cell? It does if the cell lies on the neighbour's sides of the cube. */
static int holds(int b, int cell)
{
    for (int axis = 0; axis < 3; axis++, b /= 3, cell /= 3) {
        if (b % 3 != 1 && cell % 3 != b % 3) {
            return 0;
        }
    }
    return 1;
}

/* For each layer of nine neighbours the cells that they hold. */
static void list_held(uint32_t held[3][512], const int place[26])
{
    for (int set = 0; set < 3 * 512; set++) {
        uint32_t *cells = &held[set / 512][set % 512];
        *cells = 0;
        for (int b = 0; b < 9; b++) {
            const int neighbour = 9 * (set / 512) + b;
            for (int c = 0; (set >> b & 1) && neighbour != MS_CLIQUE_CENTRE && c < 26; c++) {
                *cells |= holds(neighbour, place[c]) ? bit_of(c) : 0;
            }
        }
    }
}

/* The two corners of each edge. */
static void list_ends(uint32_t ends[12], const int place[26])
{
    for (int e = 0; e < 12; e++) {
        ends[e] = 0;
        for (int c = 0; c < 8; c++) {
            ends[e] |= holds(place[8 + e], place[c]) ? bit_of(c) : 0;
        }
    }
}

/* Are the corners, with the edges between them, one piece? */
static int is_one_piece(uint32_t graph, const uint32_t ends[12])
{
    const uint32_t corners = graph & CORNERS;
    uint32_t found = corners & -corners, before = 0;
    while (found != before) {
        before = found;
        for (int e = 0; e < 12; e++) {
            found |= (graph & bit_of(8 + e)) && (found & ends[e]) ? ends[e] : 0;
        }
    }
    return corners && found == corners;
}

/* Corners - edges + squares. */
static int euler_of(uint32_t cells)
{
    int sum = 0;
    for (int c = 0; c < 26; c++) {
        sum += (cells & bit_of(c)) ? (c >= 8 && c < 20 ? -1 : 1) : 0;
    }
    return sum;
}

/* Another definition, of all 2^26 neighbourhoods: a voxel is simple if what its neighbours
 * cover of its surface can be shrunk to a point. On a sphere that is a set of one piece with
 * Euler characteristic 1: no piece less, no hole, not the whole sphere. */
static void every_neighbourhood_agrees_with_what_it_covers_of_the_surface(void **state)
{
    (void)state;
    static uint32_t held[3][512];
    static uint8_t one_piece[GRAPH + 1];
    static int8_t squares[64], euler[GRAPH + 1];
    int place[26];
    uint32_t ends[12];
    list_cells(place);
    list_held(held, place);
    list_ends(ends, place);
    for (uint32_t graph = 0; graph <= GRAPH; graph++) {
        one_piece[graph] = (uint8_t)is_one_piece(graph, ends);
        euler[graph] = (int8_t)euler_of(graph);
    }
    for (uint32_t s = 0; s < 64; s++) {
        squares[s] = (int8_t)euler_of(s << 20);
    }
    long different = 0;
#pragma omp parallel for reduction(+ : different)
    for (int64_t w = 0; w < 1 << 26; w++) {
        const uint32_t low = (uint32_t)w & (CENTRE - 1), word = low | ((uint32_t)w & ~(CENTRE - 1u)) << 1;
        const uint32_t cells = held[0][word & 511] | held[1][word >> 9 & 511] | held[2][word >> 18];
        const int expected = one_piece[cells & GRAPH] && euler[cells & GRAPH] + squares[cells >> 20] == 1;
        different += !ms_clique_is_simple(word) != !expected;
    }
    assert_int_equal(different, 0);
}

/* A neighbourhood alone on a grid of 5x5x5. */
static topology topology_alone(uint32_t object)
{
    ms_grid grid = empty_grid(5, 5, 5, 1);
    for (int b = 0; b < 27; b++) {
        grid.inside[ms_grid_index(&grid, 1 + b % 3, 1 + b / 3 % 3, 1 + b / 9)] = object >> b & 1;
    }
    const topology t = topology_of(&grid);
    ms_grid_free(&grid);
    return t;
}

static void removing_a_simple_voxel_changes_no_topology(void **state)
{
    (void)state;
    uint64_t seed = 32;
    int tried = 0;
    for (int run = 0; run < 6000; run++) {
        const uint32_t object = random_word(&seed, (run % 9 + 1) / 10.0) | CENTRE;
        if (ms_clique_is_simple(object)) {
            const topology with = topology_alone(object), without = topology_alone(object & ~(uint32_t)CENTRE);
            assert_int_equal(with.pieces, without.pieces);
            assert_int_equal(with.cavities, without.cavities);
            assert_int_equal(with.tunnels, without.tunnels);
            tried++;
        }
    }
    assert_true(tried > 300);
}

/* The neighbourhood of voxel b, as far as it lies in the neighbourhood at hand. */
static uint32_t seen_from(uint32_t set, int b)
{
    uint32_t word = 0;
    const int by[3] = {b % 3 - 1, b / 3 % 3 - 1, b / 9 - 1};
    for (int to = 0; to < 27; to++) {
        const int from = moved(to, by);
        word |= from >= 0 && (set & bit_of(from)) ? bit_of(to) : 0;
    }
    return word;
}

/* Removes simple voxels one by one, in that order, from the front again after each: is one voxel left? */
static int reduces_to_one(uint32_t set, const int order[27])
{
    for (int at = 0; at < 27; at++) {
        const uint32_t bit = bit_of(order[at]);
        if ((set & bit) && brute_is_simple(seen_from(set, order[at]))) {
            set &= ~bit;
            at = -1;
        }
    }
    return set && !(set & (set - 1));
}

static void shuffle(int order[27], uint64_t *seed)
{
    for (int at = 26; at > 0; at--) {
        const int with = pick(seed, at + 1), swap = order[at];
        order[at] = order[with];
        order[with] = swap;
    }
}

static int is_regular(uint32_t around, uint64_t *seed)
{
    int order[27];
    for (int at = 0; at < 27; at++) {
        order[at] = at;
    }
    const int regular = reduces_to_one(around, order);
    for (int again = 0; again < 3; again++) {
        shuffle(order, seed);
        assert_int_equal(reduces_to_one(around, order), regular);
    }
    return regular;
}

/* The voxels of the object that hold a face of the centre. */
static uint32_t holders(uint32_t object, int face)
{
    uint32_t clique = 0;
    for (int b = 0; b < 27; b++) {
        clique |= (object & bit_of(b)) && holds(b, face) ? bit_of(b) : 0;
    }
    return clique;
}

/* Is no larger face common to all of the clique? */
static int is_essential(uint32_t clique, int face)
{
    for (int larger = 0; larger < 27; larger++) {
        if (larger != face && steps_between(13, larger) < steps_between(13, face) &&
            (clique & ~holders(ALL, larger)) == 0) {
            return 0;
        }
    }
    return 1;
}

static int is_critical(uint32_t object, uint32_t clique, uint64_t *seed)
{
    uint32_t around = 0;
    for (int b = 0; b < 27; b++) {
        int of_all = (object & ~clique & bit_of(b)) != 0;
        for (int c = 0; c < 27; c++) {
            of_all = of_all && (!(clique & bit_of(c)) || steps_between(b, c) <= BY_CORNERS);
        }
        around |= of_all ? bit_of(b) : 0;
    }
    return !is_regular(around, seed);
}

/* The cliques of a rank of which the centre is to be kept. */
static int brute_keeps(uint32_t object, uint32_t free, int rank, uint64_t *seed)
{
    for (int face = 0; face < 27; face++) {
        const uint32_t clique = holders(object, face);
        if (steps_between(MS_CLIQUE_CENTRE, face) == 3 - rank && !(clique & ~free) && !(clique & (CENTRE - 1)) &&
            is_essential(clique, face) && is_critical(object, clique, seed)) {
            return 1;
        }
    }
    return 0;
}

static int expect_kept(uint32_t object, uint32_t free, int rank, uint64_t *seed)
{
    const int expected = brute_keeps(object, free, rank, seed);
    if (!ms_clique_keeps(object, free, rank) != !expected) {
        fail_msg("object %09o, free %09o, rank %d: expected %d", object, free, rank, expected);
    }
    return expected;
}

static void cliques_agree_with_their_definition(void **state)
{
    (void)state;
    uint64_t seed = 33;
    int kept[3] = {0};
    for (int run = 0; run < 50000; run++) {
        const uint32_t object = random_word(&seed, (run % 19 + 1) / 20.0) | CENTRE;
        const uint32_t some = random_word(&seed, run % 3 ? 0.9 : 0.5), centre = run % 16 ? CENTRE : 0;
        for (int rank = 0; rank < 3; rank++) {
            kept[rank] += expect_kept(object, object & ((some & ~(uint32_t)CENTRE) | centre), rank, &seed);
        }
    }
    for (int rank = 0; rank < 3; rank++) {
        assert_true(kept[rank] > 500); /* or nothing has been tested */
    }
}

/* Each face alone, with all or few of the voxels around it, by every rule of the definition. */
static void small_cliques_agree_with_their_definition(void **state)
{
    (void)state;
    uint64_t seed = 34;
    for (int face = 0; face < 27; face++) {
        const uint32_t clique = holders(ALL, face);
        for (int run = 0; run < 300; run++) {
            const uint32_t some = CENTRE | (clique & random_word(&seed, 0.7));
            const uint32_t object = some | random_word(&seed, run % 5 * 0.1);
            for (int rank = 0; rank < 3; rank++) {
                expect_kept(object, object, rank, &seed);
                expect_kept(object, some, rank, &seed);
            }
        }
    }
}

static void cliques_at_a_corner_are_critical(void **state)
{
    (void)state;
    const uint32_t pair = CENTRE | bit_of(26), three = CENTRE | bit_of(17) | bit_of(23); /* (0,0,0) (1,1,0) (1,0,1) */
    uint64_t seed = 35;
    for (int run = 0; run < 2000; run++) {
        const uint32_t others = random_word(&seed, run % 11 / 10.0);
        const uint32_t object = others | pair, clique = holders(object, 26);
        assert_int_equal(ms_clique_keeps(object, clique, 0), 1);
        assert_int_equal(ms_clique_keeps(object, clique & ~bit_of(26), 0), 0);
    }
    assert_int_equal(ms_clique_keeps(three, three, 0), 1);
}

static void known_cliques(void **state)
{
    (void)state;
    /* Two voxels alone, joined by a face, an edge, a corner: one of the two stays, the first. */
    for (int b = 14; b < 27; b++) {
        const uint32_t pair = CENTRE | bit_of(b);
        const int joined = 3 - steps_between(MS_CLIQUE_CENTRE, b);
        for (int rank = 0; rank < 3; rank++) {
            assert_int_equal(ms_clique_keeps(pair, pair, rank), rank == joined);
            assert_int_equal(ms_clique_keeps(pair, CENTRE, rank), 0);
            assert_int_equal(ms_clique_keeps(pair, bit_of(b), rank), 0);
        }
        const uint32_t before = CENTRE | bit_of(26 - b); /* the other one is the first */
        assert_int_equal(ms_clique_keeps(before, before, joined), 0);
    }
    /* Two voxels across a plate of thickness 2: a hole would open. */
    const uint32_t plate = 0777777000;
    assert_int_equal(ms_clique_keeps(plate, plate, 2), 1);
    assert_int_equal(ms_clique_keeps(plate, CENTRE | bit_of(MS_CLIQUE_CENTRE + 9), 2), 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_neighbourhoods_agree_with_the_definition),
        cmocka_unit_test(nearly_empty_and_nearly_full_neighbourhoods_agree),
        cmocka_unit_test(known_neighbourhoods),
        cmocka_unit_test(every_neighbourhood_agrees_with_what_it_covers_of_the_surface),
        cmocka_unit_test(removing_a_simple_voxel_changes_no_topology),
        cmocka_unit_test(cliques_agree_with_their_definition),
        cmocka_unit_test(small_cliques_agree_with_their_definition),
        cmocka_unit_test(cliques_at_a_corner_are_critical),
        cmocka_unit_test(known_cliques),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
