/** A sphere in the two frames in which one is held. */
#ifndef MS_SPHERE_H
#define MS_SPHERE_H

/** In the unit and frame of the shape. */
typedef struct ms_sphere {
    double centre[3];
    double radius;
} ms_sphere;

/** In voxels of a grid: the centre in voxel indices, fractions allowed. ms_grid_ball and ms_grid_sphere convert. */
typedef struct ms_ball {
    double centre[3];
    double radius;
} ms_ball;

#endif
