#include "ms_compare_population.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double LEAST = 1e-6;

/* Clumps of another tool have a file each: their name is what makes them one method. */
static int is_same_method(const ms_compare_record *a, const ms_compare_record *b)
{
    const int clump = ms_compare_record_is_clump(a);
    return clump == ms_compare_record_is_clump(b) && ms_compare_records_agree(a, b, MS_COLUMN_GENERATOR) &&
           (clump || ms_compare_records_agree(a, b, MS_COLUMN_OPTIONS));
}

/* The place of a row in a list, to which it is added if there is none like it. The last is tried first: rows of a shape
 * stand together. */
static size_t find_or_add(const ms_compare_record **list, size_t *count, const ms_compare_record *row,
                          int (*is_same)(const ms_compare_record *, const ms_compare_record *))
{
    for (size_t at = *count; at-- > 0;) {
        if (is_same(list[at], row)) {
            return at;
        }
    }
    list[*count] = row;
    return (*count)++;
}

static void add_number(ms_compare_population *p, double number)
{
    size_t at = p->n_numbers;
    while (at > 0 && p->number[at - 1] > number) {
        at--;
    }
    if (at == 0 || p->number[at - 1] != number) {
        memmove(p->number + at + 1, p->number + at, (p->n_numbers - at) * sizeof *p->number);
        p->number[at] = number;
        p->n_numbers++;
    }
}

/* The least number that is not below that of the row; n_numbers if there is none, or the row failed. */
static size_t find_number(const ms_compare_population *p, const ms_compare_record *row)
{
    const double number =
        ms_compare_record_number(row, ms_compare_record_is_clump(row) ? MS_COLUMN_SPHERES : MS_COLUMN_ASKED);
    size_t at = 0;
    while (at < p->n_numbers && !(p->number[at] >= number)) {
        at++;
    }
    return at;
}

static int is_of(const ms_compare_record *row, const char *cells)
{
    return strcmp(row->field[MS_COLUMN_CELLS], cells) == 0;
}

static void list_axes(ms_compare_population *p, const ms_compare_records *all, const char *cells)
{
    for (size_t r = 0; r < all->count; r++) {
        const ms_compare_record *row = &all->record[r];
        if (is_of(row, cells)) {
            find_or_add(p->shape, &p->n_shapes, row, ms_compare_records_same_shape);
            find_or_add(p->method, &p->n_methods, row, is_same_method);
            if (!ms_compare_record_is_clump(row)) {
                add_number(p, ms_compare_record_number(row, MS_COLUMN_ASKED));
            }
        }
    }
}

static void place_rows(ms_compare_population *p, const ms_compare_records *all, const char *cells)
{
    for (size_t r = 0; r < all->count; r++) {
        const ms_compare_record *row = &all->record[r];
        if (is_of(row, cells)) {
            const size_t s = find_or_add(p->shape, &p->n_shapes, row, ms_compare_records_same_shape);
            const size_t m = find_or_add(p->method, &p->n_methods, row, is_same_method);
            const size_t n = find_number(p, row);
            if (n < p->n_numbers) {
                p->row[(n * p->n_methods + m) * p->n_shapes + s] = row;
            }
            p->left_out += n == p->n_numbers;
        }
    }
}

ms_status ms_compare_population_make(ms_compare_population *p, const ms_compare_records *all, const char *cells,
                                     ms_error *err)
{
    *p = (ms_compare_population){.shape = calloc(all->count + 1, sizeof(const ms_compare_record *)),
                                 .method = calloc(all->count + 1, sizeof(const ms_compare_record *)),
                                 .number = calloc(all->count + 1, sizeof *p->number)};
    if (p->shape && p->method && p->number) {
        list_axes(p, all, cells);
        p->row = calloc(p->n_numbers * p->n_methods + 1, (p->n_shapes + 1) * sizeof(const ms_compare_record *));
    }
    if (!p->row) {
        ms_compare_population_free(p);
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the population of %zu rows", all->count);
    }
    place_rows(p, all, cells);
    return MS_OK;
}

void ms_compare_population_free(ms_compare_population *p)
{
    free(p->shape);
    free(p->method);
    free(p->number);
    free(p->row);
    *p = (ms_compare_population){0};
}

double ms_compare_population_value(const ms_compare_population *p, size_t number, size_t method, size_t shape,
                                   ms_column column)
{
    const ms_compare_record *row = p->row[(number * p->n_methods + method) * p->n_shapes + shape];
    return row ? ms_compare_record_number(row, column) : (double)NAN;
}

ms_compare_spread ms_compare_population_spread(const ms_compare_population *p, size_t number, size_t method,
                                               ms_column column, double *room)
{
    size_t count = 0;
    for (size_t s = 0; s < p->n_shapes; s++) {
        const double value = ms_compare_population_value(p, number, method, s, column);
        if (isfinite(value)) {
            room[count++] = value;
        }
    }
    return ms_compare_spread_of(room, count);
}

int ms_compare_population_is_beside(const ms_compare_population *p, size_t number)
{
    int found = 0;
    for (size_t m = 0; m < p->n_methods; m++) {
        for (size_t s = 0; s < p->n_shapes; s++) {
            found |= ms_compare_population_value(p, number, m, s, MS_COLUMN_BESIDE) > 0;
        }
    }
    return found;
}

double ms_compare_population_time(const ms_compare_population *p, double *room)
{
    return p->n_numbers ? ms_compare_population_spread(p, 0, 0, MS_COLUMN_GENERATE, room).mean : (double)NAN;
}

/* The least value of the others; NAN without. */
static double find_rival(const ms_compare_population *p, size_t number, size_t method, size_t shape, ms_column column)
{
    double least = (double)NAN;
    for (size_t m = 0; m < p->n_methods; m++) {
        if (m != method) {
            least = fmin(least, ms_compare_population_value(p, number, m, shape, column));
        }
    }
    return least;
}

/* @param room n_shapes logarithms of the factor */
static ms_status judge_method(ms_compare_standing *out, const ms_compare_population *p, size_t number, size_t method,
                              ms_column column, double *room, ms_error *err)
{
    double sum = 0;
    *out = (ms_compare_standing){.factor = (double)NAN};
    for (size_t s = 0; s < p->n_shapes; s++) {
        const double own = ms_compare_population_value(p, number, method, s, column);
        const double rival = find_rival(p, number, method, s, column);
        if (isfinite(own) && isfinite(rival)) {
            room[out->shapes] = log(fmax(rival, LEAST) / fmax(own, LEAST));
            sum += room[out->shapes++];
            out->best += own <= rival;
        }
    }
    const ms_status status = ms_compare_spread_interval(&out->low, &out->high, room, out->shapes, err);
    out->factor = exp(sum / (double)out->shapes);
    out->low = exp(out->low);
    out->high = exp(out->high);
    return status;
}

ms_status ms_compare_population_judge(ms_compare_standing *standing, const ms_compare_population *p, size_t number,
                                      ms_column column, ms_error *err)
{
    double *room = malloc((p->n_shapes + 1) * sizeof *room);
    ms_status status = room ? MS_OK : ms_fail(err, MS_ERR_NOMEM, "no memory for %zu shapes", p->n_shapes);
    for (size_t m = 0; m < p->n_methods && status == MS_OK; m++) {
        status = judge_method(&standing[m], p, number, m, column, room, err);
    }
    free(room);
    return status;
}
