#include "ms_shape.h"

#include <math.h>
#include <string.h>

#include "base/ms_choice.h"
#include "ms_shape_build.h"

/* Small enough that no product of three overflows or vanishes. */
#define LENGTH_MIN 1e-12
#define LENGTH_MAX 1e12
#define LENGTH(name, fallback, help)                    \
    {                                                   \
        name, fallback, LENGTH_MIN, LENGTH_MAX, help, 0 \
    }
#define FINENESS(fallback, help)              \
    {                                         \
        "fineness", fallback, 2, 512, help, 1 \
    }
#define TURN "segments along a quarter turn"
#define EDGE "segments along the longest edge"
/* A cuboid's quarters are mirror images of each other but where it is its corners alone. */
#define BOX_FINENESS(fallback)                                                                 \
    {                                                                                          \
        "fineness", fallback, 1, 512, EDGE ", rounded up to an even number; 1: the corners", 1 \
    }
#define END                    \
    {                          \
        NULL, 0, 0, 0, NULL, 0 \
    }

static const ms_shape_parameter ball[] = {LENGTH("r", 1, "radius"), FINENESS(56, TURN), END};
static const ms_shape_parameter ellipsoid[] = {LENGTH("a", 2, "semi-axis along x"), LENGTH("b", 1, "semi-axis along y"),
                                               LENGTH("c", 1, "semi-axis along z"), FINENESS(56, TURN), END};
static const ms_shape_parameter hollow[] = {LENGTH("R", 1, "radius of the ball"),
                                            LENGTH("r", 0.5, "radius of its cavity"), FINENESS(48, TURN), END};
static const ms_shape_parameter tablet[] = {LENGTH("band_radius", 5.675, "radius of the band"),
                                            LENGTH("band_height", 4.0, "height of the band"),
                                            LENGTH("cap_height", 1.23, "height of each cap"), FINENESS(48, TURN), END};
static const ms_shape_parameter torus[] = {LENGTH("R", 3, "radius of the ring's centre line"),
                                           LENGTH("r", 1, "radius of the tube"), FINENESS(34, TURN), END};
static const ms_shape_parameter needle[] = {LENGTH("length", 20, "length over all, along x"),
                                            LENGTH("r", 0.5, "radius"), FINENESS(32, TURN), END};
static const ms_shape_parameter cylinder[] = {LENGTH("r", 1, "radius"), LENGTH("h", 2, "height, along z"),
                                              FINENESS(32, TURN), END};
static const ms_shape_parameter cone[] = {LENGTH("r", 1, "radius of the base"), LENGTH("h", 2, "height, along z"),
                                          FINENESS(32, TURN), END};
static const ms_shape_parameter dumbbell[] = {LENGTH("R", 1, "radius of the balls"),
                                              LENGTH("distance", 3, "between the balls' centres, along x"),
                                              LENGTH("neck", 0.4, "radius of the neck"), FINENESS(34, TURN), END};
static const ms_shape_parameter bowl[] = {LENGTH("R", 1, "outer radius"), LENGTH("wall", 0.1, "thickness of the wall"),
                                          FINENESS(48, TURN), END};
static const ms_shape_parameter cross[] = {LENGTH("length", 10, "of each bar"),
                                           LENGTH("width", 1, "of each bar, which is square"), FINENESS(40, EDGE), END};
static const ms_shape_parameter cube[] = {LENGTH("a", 1, "edge"), BOX_FINENESS(16), END};
static const ms_shape_parameter box[] = {LENGTH("a", 3, "edge along x"), LENGTH("b", 2, "edge along y"),
                                         LENGTH("c", 1, "edge along z"), BOX_FINENESS(24), END};
static const ms_shape_parameter plate[] = {LENGTH("a", 5, "edge along x"), LENGTH("b", 5, "edge along y"),
                                           LENGTH("c", 0.1, "thickness, along z"), BOX_FINENESS(50), END};
static const ms_shape_parameter tetrahedron[] = {LENGTH("a", 1, "edge"), FINENESS(16, EDGE), END};
static const ms_shape_parameter octahedron[] = {LENGTH("a", 1, "from the centre to the vertices"), FINENESS(16, EDGE),
                                                END};
static const ms_shape_parameter grain[] = {
    LENGTH("r", 1, "radius of the ball of equal volume"),
    {"elongation", 1.3, 1, 100, "stretch along x", 0},
    {"flatness", 1.2, 1, 100, "shrink along z", 0},
    {"noise", 0.1, 0, 1, "standard deviation of the logarithm of the radius", 0},
    {"degree", 16, 2, 64, "highest degree of the noise's harmonics", 1},
    {"decay", 3, 0, 10, "exponent by which the noise's power falls with the degree", 0},
    {"seed", 1, 0, 9007199254740992.0, "of the random numbers", 1},
    FINENESS(48, TURN),
    END};

const ms_shape_kind ms_shape_kinds[] = {
    {"ball", "ball", ball, ms_shape_ball, ms_shape_ball_volume},
    {"ellipsoid", "ellipsoid", ellipsoid, ms_shape_ellipsoid, ms_shape_ellipsoid_volume},
    {"hollow", "ball with a concentric ball-shaped cavity", hollow, ms_shape_hollow, ms_shape_hollow_volume},
    {"tablet", "bi-convex tablet: a cylindrical band with two spherical caps", tablet, ms_shape_tablet,
     ms_shape_tablet_volume},
    {"torus", "ring about z", torus, ms_shape_torus, ms_shape_torus_volume},
    {"needle", "cylinder with half balls as ends, along x", needle, ms_shape_needle, ms_shape_needle_volume},
    {"cylinder", "cylinder about z", cylinder, ms_shape_cylinder, ms_shape_cylinder_volume},
    {"cone", "cone about z", cone, ms_shape_cone, ms_shape_cone_volume},
    {"dumbbell", "two balls joined by a cylindrical neck, along x", dumbbell, ms_shape_dumbbell,
     ms_shape_dumbbell_volume},
    {"bowl", "half a hollow ball, about z, its opening upward", bowl, ms_shape_bowl, ms_shape_bowl_volume},
    {"cross", "three square bars along the axes, one through the other", cross, ms_shape_cross, ms_shape_cross_volume},
    {"cube", "cube", cube, ms_shape_cube, ms_shape_cube_volume},
    {"box", "cuboid", box, ms_shape_box, ms_shape_box_volume},
    {"plate", "thin cuboid", plate, ms_shape_box, ms_shape_box_volume},
    {"tetrahedron", "regular tetrahedron", tetrahedron, ms_shape_tetrahedron, ms_shape_tetrahedron_volume},
    {"octahedron", "regular octahedron with its vertices on the axes", octahedron, ms_shape_octahedron,
     ms_shape_octahedron_volume},
    {"grain", "random star-shaped grain", grain, ms_shape_grain, ms_shape_grain_volume},
    {NULL, NULL, NULL, NULL, NULL}};

const ms_shape_kind *ms_shape_find(const char *name, ms_error *err)
{
    ms_choice choice = {.typed = name};
    for (const ms_shape_kind *kind = ms_shape_kinds; kind->name; kind++) {
        if (ms_choice_offer(&choice, kind->name)) {
            return kind;
        }
    }
    ms_choice_fail(&choice, err, "no shape is called '%s'", name);
    return NULL;
}

static ms_status check_value(const ms_shape_kind *kind, const ms_shape_parameter *parameter, double value,
                             ms_error *err)
{
    if (!(value >= parameter->min && value <= parameter->max)) {
        return ms_fail(err, MS_ERR_ARG, "%s: %s = %g is not within %g to %g", kind->name, parameter->name, value,
                       parameter->min, parameter->max);
    }
    if (parameter->whole && value != floor(value)) {
        return ms_fail(err, MS_ERR_ARG, "%s: %s = %g must be a whole number", kind->name, parameter->name, value);
    }
    return MS_OK;
}

/* Of lengths more unlike than this the small ones would drown in the rounding of the large. */
#define LENGTH_RATIO_MAX 1e6

static ms_status check_ratio(const ms_shape_kind *kind, const double *value, ms_error *err)
{
    double least = HUGE_VAL;
    double most = 0;
    for (size_t k = 0; kind->parameters[k].name; k++) {
        if (kind->parameters[k].max == LENGTH_MAX) {
            least = fmin(least, value[k]);
            most = fmax(most, value[k]);
        }
    }
    if (most > LENGTH_RATIO_MAX * least) {
        return ms_fail(err, MS_ERR_ARG, "%s: the lengths %g and %g are too unlike; at most %g to 1 is allowed",
                       kind->name, most, least, LENGTH_RATIO_MAX);
    }
    return MS_OK;
}

ms_status ms_shape_make(ms_mesh *mesh, const ms_shape_kind *kind, const double *value, ms_error *err)
{
    *mesh = (ms_mesh){0};
    for (size_t k = 0; kind->parameters[k].name; k++) {
        ms_status status = check_value(kind, &kind->parameters[k], value[k], err);
        if (status != MS_OK) {
            return status;
        }
    }
    ms_status status = check_ratio(kind, value, err);
    return status == MS_OK ? kind->make(mesh, value, err) : status;
}
