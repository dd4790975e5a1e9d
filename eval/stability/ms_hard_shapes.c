#include "ms_hard_shapes.h"

#include <math.h>
#include <string.h>

#include "base/ms_file.h"
#include "ms_perturb.h"
#include "shape/ms_shape.h"
#include "voxel/ms_solid.h"

const ms_hard_shape ms_hard_shapes[] = {
    {.name = "plate", .kind = "plate", .value = {5, 5, 0.1, 50}, .deq = 100},
    {.name = "needle", .kind = "needle", .value = {20, 0.5, 8}, .deq = 40},
    {.name = "cube", .kind = "cube", .value = {1, 16}, .deq = 40},
    {.name = "tetrahedron", .kind = "tetrahedron", .value = {1, 16}, .deq = 40},
    {.name = "shell", .kind = "hollow", .value = {1, 0.8, 12}, .deq = 60},
    {.name = "torus", .kind = "torus", .value = {3, 1, 10}, .deq = 40},
    {.name = "dumbbell", .kind = "dumbbell", .value = {1, 3, 0.2, 8}, .deq = 40},
    {.name = "cone", .kind = "cone", .value = {1, 2, 12}, .deq = 40},
    {.name = "rough", .kind = "grain", .value = {1, 1.3, 1.2, 0.3, 32, 1.5, 1, 24}, .deq = 40},
    {.name = "speck", .kind = "grain", .value = {1, 1.3, 1.2, 0.1, 16, 3, 1, 16}, .deq = 6, .only = 1},
    {.name = "open", .kind = "grain", .value = {1, 1.3, 1.2, 0.1, 16, 3, 1, 16}, .deq = 40, .holes = 0.02},
    {.name = "bowl", .kind = "bowl", .value = {1, 0.1, 12}, .deq = 60},
    {.name = "limbs", .kind = "cross", .value = {8, 1, 40}, .deq = 55.6}, /* 16 voxels across a limb */
    {.name = "cavity", .kind = "hollow", .value = {1, 0.2, 12}, .deq = 60},
    {.name = "corners", .kind = "box", .value = {3, 2, 1, 1}, .deq = 45},
    {.name = "pair", .kind = "ball", .value = {1, 10}, .deq = 40, .apart = 1.2},
    {0}};

_Static_assert(sizeof ms_hard_shapes / sizeof *ms_hard_shapes <= MS_HARD_SHAPES_MOST + 1, "room for each name");

/* The flags with a voxel size in the place of a diameter. */
static void choose_voxels(ms_input_flags *flags, const ms_hard_shape *shape, const ms_solid *solid)
{
    const double asked = flags->deq > 0 ? flags->deq : shape->deq;
    if (!shape->only && (flags->cells > 0 || flags->voxel_size > 0)) {
        return;
    }
    flags->voxel_size = cbrt(6 * solid->body.volume / acos(-1.0)) / (shape->only ? shape->deq : asked);
    flags->cells = flags->deq = 0;
}

/* Puts a copy beside the body, of which they may share a part. */
static ms_status add_copy(ms_mesh *mesh, double apart, ms_error *err)
{
    ms_mesh both;
    const ms_status status = ms_mesh_alloc(&both, 2 * mesh->n_vertices, 2 * mesh->n_triangles, err);
    if (status != MS_OK) {
        return status;
    }
    for (size_t v = 0; v < both.n_vertices; v++) {
        const size_t copy = v / mesh->n_vertices;
        memcpy(both.vertex[v], mesh->vertex[v % mesh->n_vertices], sizeof *both.vertex);
        both.vertex[v][0] += copy ? apart : 0;
    }
    for (size_t k = 0; k < 3 * both.n_triangles; k++) {
        const size_t t = k / 3, copy = t / mesh->n_triangles;
        both.triangle[t][k % 3] =
            mesh->triangle[t % mesh->n_triangles][k % 3] + (uint32_t)(copy ? mesh->n_vertices : 0);
    }
    ms_mesh_free(mesh);
    *mesh = both;
    return MS_OK;
}

const ms_hard_shape *ms_hard_shapes_find(ms_choice *choice)
{
    for (const ms_hard_shape *shape = ms_hard_shapes; shape->name; shape++) {
        if (ms_choice_offer(choice, shape->name)) {
            return shape;
        }
    }
    return NULL;
}

ms_status ms_hard_shapes_read(ms_input *input, const ms_hard_shape *shape, ms_input_flags *flags, ms_error *err)
{
    memset(input, 0, sizeof *input);
    input->path = shape->name;
    ms_status status = ms_shape_make(&input->mesh, ms_shape_find(shape->kind, err), shape->value, err);
    if (status == MS_OK && shape->apart > 0) {
        status = add_copy(&input->mesh, shape->apart, err);
    }
    if (status == MS_OK) {
        status = ms_solid_mesh(&input->solid, &input->mesh, err); /* before it has holes */
        choose_voxels(flags, shape, &input->solid);
    }
    if (status == MS_OK && shape->holes > 0) {
        flags->allow_open = 1;
        status = ms_perturb_open(&input->mesh, shape->holes, 1, err);
    }
    if (status == MS_OK) {
        status = ms_mesh_repair(&input->mesh, &input->report, err);
    }
    if (status == MS_OK) {
        const ms_bytes bytes = {.data = (uint8_t *)input->mesh.vertex,
                                .size = input->mesh.n_vertices * sizeof *input->mesh.vertex};
        input->checksum = ms_file_checksum(&bytes);
    }
    if (status != MS_OK) {
        ms_input_free(input);
    }
    return status;
}
