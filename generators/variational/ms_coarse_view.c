#include "ms_coarse_view.h"

ms_status ms_coarse_view_make(ms_coarse_view *view, const ms_target *target, const float *distance, int step,
                              ms_error *err)
{
    const ms_grid *grid = &target->grid;
    int n[3];
    for (int a = 0; a < 3; a++) {
        n[a] = (grid->n[a] + step - 1) / step;
    }
    *view = (ms_coarse_view){.target = target, .distance = distance, .step = step};
    const ms_status status = ms_grid_alloc(&view->grid, n, grid->h * step, grid->origin, err);
    for (int k = 0; status == MS_OK && k < n[2]; k++) {
        for (int j = 0; j < n[1]; j++) {
            for (int i = 0; i < n[0]; i++) {
                view->grid.inside[ms_grid_index(&view->grid, i, j, k)] =
                    grid->inside[ms_grid_index(grid, i * step, j * step, k * step)];
            }
        }
    }
    return status;
}

void ms_coarse_view_keep_upper(ms_coarse_view *view, const ms_mirror *m)
{
    ms_grid *coarse = &view->grid;
    for (size_t v = 0; v < ms_grid_voxels(coarse); v++) {
        int at[3];
        ms_grid_voxel(at, coarse->n, v);
        for (int a = 0; a < 3; a++) {
            coarse->inside[v] = coarse->inside[v] && (!m->across[a] || view->step * at[a] >= m->at[a]);
        }
    }
}

ms_ball ms_coarse_view_ball(const ms_coarse_view *view, const ms_ball *ball)
{
    const double *c = ball->centre, step = view->step;
    return (ms_ball){.centre = {c[0] / step, c[1] / step, c[2] / step}, .radius = ball->radius / step};
}

ms_ball ms_coarse_view_target_ball(const ms_coarse_view *view, const ms_ball *ball)
{
    const double *c = ball->centre, step = view->step;
    return (ms_ball){.centre = {c[0] * step, c[1] * step, c[2] * step}, .radius = ball->radius * step};
}

void ms_coarse_view_free(ms_coarse_view *view)
{
    ms_grid_free(&view->grid);
}
