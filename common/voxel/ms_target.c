#include "ms_target.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "mesh/ms_closest.h"
#include "ms_distance.h"
#include "ms_signed_distance.h"
#include "ms_tally.h"

double ms_target_bytes(const double n[3], double squares, ms_target_need need)
{
    const double voxel = MS_TARGET_OWN_BYTES + (need.voxel > 0 ? need.voxel : MS_TARGET_METHOD_BYTES);
    return voxel * n[0] * n[1] * n[2] + need.square * squares;
}

double ms_target_box_squares(const double n[3])
{
    return 2 * (n[0] * n[1] + n[1] * n[2] + n[2] * n[0]);
}

double ms_target_default_bytes(void)
{
    const double pages = (double)sysconf(_SC_PHYS_PAGES), size = (double)sysconf(_SC_PAGE_SIZE);
    return 0.75 * (pages > 0 && size > 0 ? pages * size : 4e9);
}

double ms_target_equivalent_radius(const ms_target *target)
{
    return cbrt(target->body.volume * 3 / (4 * acos(-1.0)));
}

double ms_target_misfit(const ms_target *target)
{
    const double h = target->grid.h;
    return target->mesh && target->closed ? (double)target->voxels * h * h * h / target->body.volume - 1 : 0;
}

/* The sums over the target's own voxels. */
static ms_tally tally_grid(const ms_grid *grid)
{
    ms_tally sum = {0};
    const uint8_t *row = grid->inside;
    for (int64_t k = 0; k < grid->n[2]; k++) {
        for (int64_t j = 0; j < grid->n[1]; j++, row += grid->n[0]) {
            int64_t count = 0, si = 0, sii = 0;
            for (int64_t i = 0; i < grid->n[0]; i++) {
                count += row[i];
                si += row[i] * i;
                sii += row[i] * i * i;
            }
            sum.inside += count;
            sum.first[0] += si;
            sum.first[1] += count * j;
            sum.first[2] += count * k;
            const int64_t second[6] = {sii, count * j * j, count * k * k, count * j * k, si * k, si * j};
            for (int m = 0; m < 6; m++) {
                sum.second[m] += second[m];
            }
        }
    }
    return sum;
}

/* What follows from the voxels, the body where no mesh gave it; the place for signed distances. */
static ms_status sum_up(ms_target *target, ms_error *err)
{
    const ms_tally sum = tally_grid(&target->grid);
    target->voxels = (size_t)sum.inside;
    if (!(target->body.volume > 0)) {
        ms_tally_body(&target->body, &sum, &target->grid);
    }
    return ms_signed_distance_store_alloc(&target->signed_distance, err);
}

ms_status ms_target_add_distance(ms_target *target, ms_error *err)
{
    const size_t voxels = ms_grid_voxels(&target->grid);
    target->distance = malloc(voxels * sizeof *target->distance);
    ms_status status =
        target->distance
            ? ms_distance(target->distance, target->grid.inside, target->grid.n, err)
            : ms_fail(err, MS_ERR_NOMEM, "no memory for the distance field of %zu voxels; use fewer cells", voxels);
    if (status != MS_OK) {
        ms_target_free(target);
    }
    return status;
}

/* @param shift of the lattice under the mesh, voxels; NULL: none */
static ms_status make_voxels(ms_target *target, const ms_mesh *mesh, const ms_solid *solid, double h,
                             ms_voxel_rule rule, const double *shift, ms_error *err)
{
    memset(target, 0, sizeof *target);
    target->mesh = mesh;
    target->closed = solid != NULL;
    target->overlapping = solid && solid->overlapping;
    target->rule = rule;
    target->body = solid ? solid->body : target->body;
    ms_status status = solid ? ms_voxelize_moved(&target->grid, mesh, h, rule, shift, err)
                             : ms_voxelize_open_moved(&target->grid, &target->disagree, mesh, h, shift, err);
    if (status == MS_OK) {
        status = sum_up(target, err);
    }
    if (status == MS_OK) {
        status = ms_closest_build(&target->closest, mesh, err);
    }
    if (status != MS_OK) {
        ms_target_free(target);
    }
    return status;
}

ms_status ms_target_voxels_from_solid(ms_target *target, const ms_mesh *mesh, const ms_solid *solid, double h,
                                      ms_voxel_rule rule, ms_error *err)
{
    return make_voxels(target, mesh, solid, h, rule, NULL, err);
}

/* As make_voxels, of a mesh whose body is not known yet. */
static ms_status measure_and_make_voxels(ms_target *target, const ms_mesh *mesh, int closed, double h,
                                         ms_voxel_rule rule, const double *shift, ms_error *err)
{
    ms_solid solid;
    const ms_status status = closed ? ms_solid_mesh(&solid, mesh, err) : MS_OK;
    if (status != MS_OK) {
        memset(target, 0, sizeof *target);
        return status;
    }
    return make_voxels(target, mesh, closed ? &solid : NULL, h, rule, shift, err);
}

ms_status ms_target_voxels_from_mesh(ms_target *target, const ms_mesh *mesh, int closed, double h, ms_voxel_rule rule,
                                     ms_error *err)
{
    return measure_and_make_voxels(target, mesh, closed, h, rule, NULL, err);
}

ms_status ms_target_from_mesh(ms_target *target, const ms_mesh *mesh, int closed, double h, ms_voxel_rule rule,
                              ms_error *err)
{
    return ms_target_from_mesh_moved(target, mesh, closed, h, rule, NULL, err);
}

ms_status ms_target_from_mesh_moved(ms_target *target, const ms_mesh *mesh, int closed, double h, ms_voxel_rule rule,
                                    const double shift[3], ms_error *err)
{
    ms_status status = measure_and_make_voxels(target, mesh, closed, h, rule, shift, err);
    return status == MS_OK ? ms_target_add_distance(target, err) : status;
}

int ms_target_label_box(int lo[3], int hi[3], uint32_t *other, const ms_volume *volume, uint32_t label)
{
    const uint32_t *at = volume->label;
    uint32_t seen = label;
    *other = 0;
    for (int a = 0; a < 3; a++) {
        lo[a] = volume->n[a];
        hi[a] = 0;
    }
    for (int k = 0; k < volume->n[2]; k++) {
        for (int j = 0; j < volume->n[1]; j++) {
            for (int i = 0; i < volume->n[0]; i++, at++) {
                if (*at == 0 || (label && *at != label)) {
                    continue;
                }
                if (seen && *at != seen) {
                    *other = *at;
                }
                seen = *at;
                const int p[3] = {i, j, k};
                for (int a = 0; a < 3; a++) {
                    lo[a] = p[a] < lo[a] ? p[a] : lo[a];
                    hi[a] = p[a] >= hi[a] ? p[a] + 1 : hi[a];
                }
            }
        }
    }
    return lo[0] < hi[0];
}

static void copy_label(ms_grid *grid, const ms_volume *volume, uint32_t label, const int lo[3], const int hi[3])
{
    for (int k = lo[2]; k < hi[2]; k++) {
        for (int j = lo[1]; j < hi[1]; j++) {
            const uint32_t *from =
                volume->label + (size_t)volume->n[0] * ((size_t)j + (size_t)volume->n[1] * (size_t)k);
            uint8_t *to =
                grid->inside + ms_grid_index(grid, MS_GRID_HULL, j - lo[1] + MS_GRID_HULL, k - lo[2] + MS_GRID_HULL);
            for (int i = lo[0]; i < hi[0]; i++) {
                to[i - lo[0]] = label ? from[i] == label : from[i] != 0;
            }
        }
    }
}

ms_status ms_target_voxels_from_volume(ms_target *target, const ms_volume *volume, uint32_t label, ms_error *err)
{
    int lo[3], hi[3], n[3];
    double origin[3];
    uint32_t other;
    memset(target, 0, sizeof *target);
    if (!ms_target_label_box(lo, hi, &other, volume, label)) {
        return ms_fail(err, MS_ERR_SHAPE, "no voxel of the volume has the label %u", label);
    }
    if (other) {
        return ms_fail(err, MS_ERR_SHAPE, "the volume has several labels (%u among them); choose one (label)", other);
    }
    for (int a = 0; a < 3; a++) {
        n[a] = hi[a] - lo[a] + 2 * MS_GRID_HULL;
        origin[a] = volume->origin[a] + volume->spacing * (volume->first[a] + lo[a] - MS_GRID_HULL);
    }
    ms_status status = ms_grid_alloc(&target->grid, n, volume->spacing, origin, err);
    if (status == MS_OK) {
        target->closed = 1;
        copy_label(&target->grid, volume, label, lo, hi);
        status = sum_up(target, err);
    }
    if (status == MS_OK) {
        status = ms_grid_pieces(&target->pieces, &target->largest_piece, &target->grid, err);
    }
    if (status != MS_OK) {
        ms_target_free(target);
    }
    return status;
}

ms_status ms_target_from_volume(ms_target *target, const ms_volume *volume, uint32_t label, ms_error *err)
{
    ms_status status = ms_target_voxels_from_volume(target, volume, label, err);
    return status == MS_OK ? ms_target_add_distance(target, err) : status;
}

void ms_target_free(ms_target *target)
{
    if (target) {
        ms_closest_free(target->closest);
        ms_signed_distance_store_free(target->signed_distance);
        ms_grid_free(&target->grid);
        free(target->distance);
        free(target->descriptors);
        memset(target, 0, sizeof *target);
    }
}
