/*
 * What is not covered yet is kept as bits, 64 voxels of a row in a word. A ball is a run of
 * bits in each of its rows: counting them costs one root and one or two words a row. What was left of
 * a candidate is kept once it is few runs: the next count costs one word for each of them.
 */
#include "ms_cover.h"

#include <math.h>
#include <omp.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "ms_cover_bits.h"
#include "ms_cover_groups.h"
#include "ms_overlap.h"

/* Bounds that are counted at once: whatever the number of threads, since the choice among estimates hangs on it. */
enum { AT_ONCE = 8 };

/* From so many rows on counting them takes longer than waking a thread for it. */
static const double ROWS_FOR_THREADS = 800;

#define NEVER (UINT32_MAX >> 1)

/* Voxels of the grid for each run that may be kept: at most 6.4 bytes a voxel. */
static const double VOXELS_A_RUN = 2.5;

/* Of the runs that are free a candidate gets up to this part. */
static const double SHARE = 1.0 / 512;

/* A group is dissolved when a ball was taken for less than this part of the ball of its class' radius. */
static const double GROUP_GAIN = 0.125;

/* Of groups' candidates every 8th, 4th or 2nd row of every such plane is counted first, as long as the ball's radius is
 * at least so many of these steps, and its bound as many voxels as give so many in such rows. What is in all rows is
 * estimated to be at most by a twentieth, and twice the root of what was counted, more. */
static const double SAMPLED_RADIUS = 4, SAMPLED_VOXELS = 100, ESTIMATE = 1.05, ESTIMATE_ROOTS = 2;

/* A candidate and what it would cover. */
typedef struct heap_entry {
    uint64_t gain;          /* exact when it was counted, an upper bound before and since */
    double radius;          /* of the candidate, here since the heap compares them all the time */
    uint32_t index;         /* of the candidate */
    uint32_t counted : 31;  /* how many balls had been taken by then; NEVER */
    uint32_t estimated : 1; /* from some of its rows */
} heap_entry;

/* All that was left of a ball when it was last counted. */
typedef struct remains {
    ms_cover_run *run; /* NULL: not known */
    uint32_t n, room;  /* runs, and for how many room is taken; 0: they were too many so far */
    int is_member;     /* of a group, and not its first */
} remains;

struct ms_cover {
    ms_cover_bits left; /* not yet covered */
    const ms_ball *candidate;
    size_t count;
    ms_cover_rule rule;
    uint32_t n_taken;
    remains *remains;       /* of each candidate */
    size_t free_runs;       /* that may still be kept */
    ms_cover_room *scratch; /* of each thread */
    int threads;
    uint32_t *next;    /* in groups of candidates, as of ms_cover_groups_form; NULL: no groups */
    int largest_class; /* of the groups that are not dissolved */
    /* A heap, the best first, and behind it those that touch no ball taken so far (connected). */
    heap_entry *entry;
    size_t n_heap, n_entries;
};

/* Keeps the runs of a candidate if they are few enough for the room that is left to each that is counted at once.
 * Without memory for them the room is taken all the same and the ball walked again: the choice must not hang on it. */
static void keep_remains(const ms_cover *cover, remains *part, const ms_cover_room *room, size_t n)
{
    const size_t left = cover->free_runs;
    if (part->room == 0 &&
        (n + 1 > room->room || (double)(n + 1) > SHARE * (double)left + 16 || n + 1 > left / AT_ONCE)) {
        return;
    }
    part->run = malloc((n + 1) * sizeof *part->run);
    if (part->run) {
        memcpy(part->run, room->found, n * sizeof *part->run);
    }
    part->n = (uint32_t)n;
    part->room = part->room > 0 ? part->room : (uint32_t)n + 1;
}

/* Gives back what is no longer needed of the room of a candidate's runs. */
static void shrink_remains(remains *part)
{
    if (part->n + 1 > part->room / 2) {
        return;
    }
    ms_cover_run *smaller = part->run ? realloc(part->run, (part->n + 1) * sizeof *smaller) : NULL;
    part->run = smaller ? smaller : part->run;
    part->room = part->n + 1;
}

/* How many rows there are to one that is counted of a candidate. */
static int choose_step(const ms_cover *cover, const heap_entry *entry)
{
    const double radius = entry->radius, gain = (double)entry->gain;
    int step = cover->rule < MS_COVER_ADMITTED || (entry->estimated && entry->counted == cover->n_taken) ? 1 : 8;
    while (step > 1 && (radius < SAMPLED_RADIUS * step || gain < SAMPLED_VOXELS * step * step)) {
        step /= 2;
    }
    return step;
}

/* How many rows a count of a candidate goes over, about. */
static double estimate_rows(const ms_cover *cover, const heap_entry *entry)
{
    const remains *part = &cover->remains[entry->index];
    const double rows = entry->radius / (part->room > 0 ? 1 : choose_step(cover, entry));
    return part->run ? part->n : 4 * rows * rows;
}

/* The voxels of a candidate that are left, or at first an estimate; its runs are kept once they are few. */
static void count_left(const ms_cover *cover, heap_entry *entry)
{
    remains *part = &cover->remains[entry->index];
    const ms_ball *ball = &cover->candidate[entry->index];
    const int step = part->room > 0 ? 1 : choose_step(cover, entry);
    ms_cover_room *room = &cover->scratch[omp_get_thread_num()];
    size_t n = 0;
    if (part->run) {
        entry->gain = ms_cover_bits_recount(&cover->left, part->run, &part->n);
    } else if (step == 1) {
        entry->gain = ms_cover_bits_walk(&cover->left, room, &n, ball);
        keep_remains(cover, part, room, n);
    } else {
        const double sum = (double)ms_cover_bits_sample(&cover->left, ball, step);
        const uint64_t most = (uint64_t)((ESTIMATE * sum + ESTIMATE_ROOTS * sqrt(sum)) * step * step);
        entry->gain = most < entry->gain ? most : entry->gain;
    }
    shrink_remains(part);
    entry->estimated = step > 1;
    entry->counted = cover->n_taken & NEVER;
}

/* Covers what is left of a candidate. */
static void cover_ball(ms_cover *cover, uint32_t index)
{
    remains *part = &cover->remains[index];
    if (part->run) {
        ms_cover_bits_take(&cover->left, part->run, part->n);
    } else {
        ms_cover_bits_remove(&cover->left, &cover->candidate[index]);
    }
}

/* Is a the better one? No two candidates are equal. */
static int is_before(const heap_entry *a, const heap_entry *b)
{
    if (a->gain != b->gain) {
        return a->gain > b->gain;
    }
    return a->radius != b->radius ? a->radius > b->radius : a->index < b->index;
}

static void sift_down(ms_cover *cover, size_t at)
{
    const heap_entry moved = cover->entry[at];
    size_t child;
    while ((child = 2 * at + 1) < cover->n_heap) {
        if (child + 1 < cover->n_heap && is_before(&cover->entry[child + 1], &cover->entry[child])) {
            child++;
        }
        if (!is_before(&cover->entry[child], &moved)) {
            break;
        }
        cover->entry[at] = cover->entry[child];
        at = child;
    }
    cover->entry[at] = moved;
}

static void sift_up(ms_cover *cover, size_t at)
{
    const heap_entry moved = cover->entry[at];
    while (at > 0 && is_before(&moved, &cover->entry[(at - 1) / 2])) {
        cover->entry[at] = cover->entry[(at - 1) / 2];
        at = (at - 1) / 2;
    }
    cover->entry[at] = moved;
}

/* Removes the first of the heap, for good; the last of those that wait fills the gap behind it. */
static void drop_first(ms_cover *cover)
{
    remains *part = &cover->remains[cover->entry[0].index];
    cover->free_runs += part->room;
    free(part->run);
    *part = (remains){0};
    cover->entry[0] = cover->entry[--cover->n_heap];
    cover->entry[cover->n_heap] = cover->entry[--cover->n_entries];
    if (cover->n_heap > 1) {
        sift_down(cover, 0);
    }
}

/* Those that wait and overlap the ball enter the heap. */
static void admit_overlapping(ms_cover *cover, const ms_ball *ball)
{
    for (size_t e = cover->n_heap; e < cover->n_entries; e++) {
        if (ms_overlap(&cover->candidate[cover->entry[e].index], ball)) {
            const heap_entry swap = cover->entry[e];
            cover->entry[e] = cover->entry[cover->n_heap];
            cover->entry[cover->n_heap] = swap;
            sift_up(cover, cover->n_heap++);
        }
    }
}

/* As many voxels as a ball can hold: their cubes lie in a ball larger by half a cube's diagonal. */
static heap_entry uncounted(const ms_cover *cover, uint32_t index)
{
    const double radius = cover->candidate[index].radius, most = 4.2 * pow(radius + 0.87, 3);
    return (heap_entry){.gain = (uint64_t)fmin(most, 1e18) + 1, .radius = radius, .index = index, .counted = NEVER};
}

/* The other candidates of a group enter the heap. */
static void dissolve_group(ms_cover *cover, uint32_t leader)
{
    uint32_t member = cover->next[leader];
    cover->next[leader] = MS_COVER_GROUPS_END;
    while (member != MS_COVER_GROUPS_END) {
        const uint32_t after = cover->next[member];
        cover->next[member] = MS_COVER_GROUPS_END;
        cover->entry[cover->n_heap] = uncounted(cover, member);
        cover->n_entries++;
        sift_up(cover, cover->n_heap++);
        member = after;
    }
}

/* Dissolves the groups of balls so large that within a group gains may differ by as much as the last one. */
static void dissolve_large(ms_cover *cover, double gain)
{
    int keep = cover->largest_class;
    while (keep > 0 && gain < GROUP_GAIN * 4.18879 * pow(8, keep)) {
        keep--;
    }
    if (keep == cover->largest_class) {
        return;
    }
    cover->largest_class = keep;
    for (size_t c = 0; c < cover->count; c++) {
        if (cover->next[c] != MS_COVER_GROUPS_END && ms_cover_groups_class(cover->candidate[c].radius) > keep) {
            dissolve_group(cover, (uint32_t)c);
        }
    }
}

static void take_first(ms_cover *cover)
{
    const uint32_t index = cover->entry[0].index;
    const size_t gain = cover->entry[0].gain;
    const ms_ball *ball = &cover->candidate[index];
    cover_ball(cover, index);
    drop_first(cover);
    cover->n_taken++;
    if (cover->rule == MS_COVER_CONNECTED) {
        if (cover->n_taken == 1) {
            cover->n_heap = 0;
        }
        admit_overlapping(cover, ball);
    } else if (cover->next) {
        dissolve_large(cover, (double)gain);
    }
}

/* Takes the first of the heap out, to come back by return_entry. */
static heap_entry borrow_first(ms_cover *cover)
{
    const heap_entry first = cover->entry[0];
    cover->entry[0] = cover->entry[--cover->n_heap];
    cover->entry[cover->n_heap] = first;
    if (cover->n_heap > 1) {
        sift_down(cover, 0);
    }
    return first;
}

static int is_stale(const ms_cover *cover, const heap_entry *entry)
{
    return entry->counted != cover->n_taken || entry->estimated;
}

/* Counts the best bounds again, as long as they are no exact counts. More than are needed may be counted. */
static void count_best(ms_cover *cover)
{
    const int at_once = cover->threads > 1 || cover->rule >= MS_COVER_ADMITTED ? AT_ONCE : 1;
    heap_entry stale[AT_ONCE];
    double rows = 0;
    int n = 0;
    while (n < at_once && cover->n_heap > 0 && is_stale(cover, &cover->entry[0])) {
        rows += estimate_rows(cover, &cover->entry[0]);
        cover->free_runs += cover->remains[cover->entry[0].index].room;
        stale[n++] = borrow_first(cover);
    }
#pragma omp parallel for schedule(dynamic, 1) num_threads(cover->threads) if (n > 1 && rows >= ROWS_FOR_THREADS)
    for (int e = 0; e < n; e++) {
        count_left(cover, &stale[e]);
    }
    for (int e = n; e-- > 0;) { /* where they were put, in the order of a stack */
        cover->free_runs -= cover->remains[stale[e].index].room;
        cover->entry[cover->n_heap] = stale[e];
        sift_up(cover, cover->n_heap++);
    }
}

/* Is the first of the heap, whose count is exact, to be taken? If not, the heap is another one. */
static int settle_first(ms_cover *cover)
{
    const heap_entry *first = &cover->entry[0];
    if (first->gain == 0) {
        drop_first(cover);
        return 0;
    }
    if (cover->next && cover->next[first->index] != MS_COVER_GROUPS_END) {
        dissolve_group(cover, first->index);
        return 0;
    }
    return 1;
}

size_t ms_cover_best(size_t *which, ms_cover *cover)
{
    while (cover->n_heap > 0) {
        if (is_stale(cover, &cover->entry[0])) {
            count_best(cover);
        } else if (settle_first(cover)) {
            *which = cover->entry[0].index;
            return cover->entry[0].gain;
        }
    }
    return 0;
}

size_t ms_cover_next(size_t *which, ms_cover *cover)
{
    const size_t gain = ms_cover_best(which, cover);
    if (gain > 0) {
        take_first(cover);
    }
    return gain;
}

void ms_cover_admit(ms_cover *cover, size_t which)
{
    if (cover->candidate[which].radius > 0) {
        cover->entry[cover->n_heap] = uncounted(cover, (uint32_t)which);
        cover->n_entries++;
        sift_up(cover, cover->n_heap++);
    }
}

size_t ms_cover_count(const ms_cover *cover, const ms_ball *ball)
{
    return ms_cover_bits_sample(&cover->left, ball, 1);
}

void ms_cover_take(ms_cover *cover, const ms_ball *ball)
{
    ms_cover_bits_remove(&cover->left, ball);
    cover->n_taken++;
}

/* Puts the candidates into groups; the largest of each stands for it. */
static ms_status form_groups(ms_cover *cover, ms_error *err)
{
    const ms_status status =
        ms_cover_groups_form(&cover->next, &cover->largest_class, cover->candidate, cover->count, err);
    for (size_t c = 0; status == MS_OK && c < cover->count; c++) {
        if (cover->next[c] != MS_COVER_GROUPS_END) {
            cover->remains[cover->next[c]].is_member = 1;
        }
    }
    return status;
}

/* Every candidate, but of groups their first. What they cover is counted when they first come to the top. */
static void rank_all(ms_cover *cover)
{
    for (size_t c = 0; c < cover->count; c++) {
        if (cover->rule != MS_COVER_ADMITTED && cover->candidate[c].radius > 0 && !cover->remains[c].is_member) {
            cover->entry[cover->n_entries++] = uncounted(cover, (uint32_t)c);
        }
    }
    cover->n_heap = cover->n_entries;
    for (size_t at = cover->n_heap / 2; at-- > 0;) {
        sift_down(cover, at);
    }
}

/* Room to find runs, for each thread. */
static int make_scratch(ms_cover *cover)
{
    cover->threads = omp_get_max_threads();
    cover->scratch = calloc((size_t)cover->threads, sizeof *cover->scratch);
    const size_t room = (size_t)(SHARE * (double)cover->free_runs) + 16;
    int complete = cover->scratch != NULL;
    for (int t = 0; complete && t < cover->threads; t++) {
        cover->scratch[t] = (ms_cover_room){malloc((room + 1) * sizeof(ms_cover_run)), room};
        complete = cover->scratch[t].found != NULL;
    }
    return complete;
}

ms_status ms_cover_build(ms_cover **out, const ms_grid *grid, const ms_ball *candidate, size_t count,
                         ms_cover_rule rule, ms_error *err)
{
    *out = NULL;
    if (count >= UINT32_MAX) {
        return ms_fail(err, MS_ERR_LIMIT,
                       "%zu candidates for spheres, and fewer than %u can be compared; use fewer cells", count,
                       (unsigned)UINT32_MAX);
    }
    ms_cover *cover = calloc(1, sizeof *cover);
    if (cover) {
        *cover = (ms_cover){.candidate = candidate,
                            .count = count,
                            .rule = rule,
                            .entry = malloc((count + 1) * sizeof *cover->entry),
                            .remains = calloc(count + 1, sizeof *cover->remains),
                            .free_runs = (size_t)((double)ms_grid_voxels(grid) / VOXELS_A_RUN)};
    }
    if (!cover || !ms_cover_bits_alloc(&cover->left, grid) || !cover->entry || !cover->remains ||
        !make_scratch(cover)) {
        ms_cover_free(cover);
        return ms_fail(err, MS_ERR_NOMEM, "no memory to choose among %zu spheres on %zu voxels; use fewer cells", count,
                       ms_grid_voxels(grid));
    }
    const ms_status status = rule == MS_COVER_GROUPED ? form_groups(cover, err) : MS_OK;
    if (status != MS_OK) {
        ms_cover_free(cover);
        return status;
    }
    rank_all(cover);
    *out = cover;
    return MS_OK;
}

void ms_cover_free(ms_cover *cover)
{
    if (cover) {
        for (size_t c = 0; cover->remains && c < cover->count; c++) {
            free(cover->remains[c].run);
        }
        for (int t = 0; cover->scratch && t < cover->threads; t++) {
            free(cover->scratch[t].found);
        }
        free(cover->scratch);
        free(cover->remains);
        free(cover->next);
        ms_cover_bits_free(&cover->left);
        free(cover->entry);
        free(cover);
    }
}
