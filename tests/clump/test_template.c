/* Templates: the frame of the particle and back; what each format holds; what is read again to the last bit. */
#include <locale.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/ms_text.h"
#include "clump/formats/ms_read.h"
#include "clump/formats/ms_write.h"
#include "support/body_samples.h"
#include "support/clump_samples.h"

static const double SCALE = 1e-3, CENTRE[3] = {12.5, -3, 700};

/* Axes of the particle in the frame of the shape: a turn about no axis in particular. */
static const double AXIS[3][3] = {
    {2.0 / 3, 2.0 / 3, 1.0 / 3}, {-2.0 / 3, 1.0 / 3, 2.0 / 3}, {1.0 / 3, -2.0 / 3, 2.0 / 3}};
static const double MOMENT[3] = {1.25e-9, 2.385e-9, 3e-9};

/* Spheres of known places in the frame of the particle, in metres. */
static void place_of(double out[3], int s)
{
    out[0] = 1e-3 * (s - 2);
    out[1] = 1e-4 * (s * s - 6);
    out[2] = 1e-4 * (s % 3);
}

static void make_clump(ms_clump *clump, ms_particle *particle)
{
    *clump = (ms_clump){0};
    *particle = (ms_particle){.scale = SCALE, .density = 2650, .mass = 0.1234567890123456789};
    for (int s = 0; s < 6; s++) {
        double place[3], x[3];
        place_of(place, s);
        for (int k = 0; k < 3; k++) {
            x[k] = CENTRE[k];
            for (int m = 0; m < 3; m++) {
                x[k] += AXIS[m][k] * place[m] / SCALE;
            }
        }
        add_sphere(clump, x[0], x[1], x[2], 0.5 + s / 7.0);
    }
    assert_int_equal(ms_clump_alloc_masses(clump, NULL), MS_OK);
    for (int s = 0; s < 6; s++) {
        clump->mass[s] = particle->mass * (s + 1) / 21;
    }
    memcpy(particle->centre, CENTRE, sizeof CENTRE);
    for (int k = 0; k < 9; k++) {
        for (int m = 0; m < 3; m++) {
            particle->inertia[k / 3][k % 3] += MOMENT[m] * AXIS[m][k / 3] * AXIS[m][k % 3];
        }
    }
}

static void into_the_frame_and_back(void **state)
{
    ms_clump clump;
    ms_particle particle;
    ms_template made;
    (void)state;
    make_clump(&clump, &particle);
    assert_int_equal(ms_template_make(&made, &clump, &particle, NULL), MS_OK);
    for (int m = 0; m < 3; m++) {
        expect_close(made.particle.inertia[m][m], MOMENT[m], 1e-22);
        expect_close(made.particle.inertia[m][(m + 1) % 3], 0, 0);
        expect_close(made.particle.centre[m], 0, 0);
    }
    for (size_t s = 0; s < 6; s++) {
        double place[3];
        place_of(place, (int)s);
        for (int m = 0; m < 3; m++) {
            /* The sign rule: the largest component of the first two axes is positive. Here the second is turned. */
            const double sign = made.axis[m][0] * AXIS[m][0] > 0 ? 1 : -1;
            expect_close(made.clump.sphere[s].centre[m], sign * place[m], 1e-14);
        }
        expect_close(made.clump.sphere[s].radius, SCALE * clump.sphere[s].radius, 0);
        expect_close(made.clump.mass[s], clump.mass[s], 0);
    }
    assert_int_equal(ms_template_undo(&made.clump, &particle, NULL), MS_OK);
    for (size_t s = 0; s < 6; s++) {
        for (int k = 0; k < 3; k++) {
            expect_close(made.clump.sphere[s].centre[k], clump.sphere[s].centre[k], 1e-11);
        }
        expect_close(made.clump.sphere[s].radius, clump.sphere[s].radius, 1e-15);
    }
    ms_template_free(&made);
    ms_clump_free(&clump);
}

static void a_body_without_axes_of_its_own_keeps_those_of_the_input(void **state)
{
    ms_clump clump = {0};
    ms_particle particle = {.scale = 1, .mass = 1, .density = 1, .inertia = {{0.4, 0, 0}, {0, 0.4, 0}, {0, 0, 0.4}}};
    ms_template made;
    (void)state;
    add_sphere(&clump, 0.1, 0.2, 0.3, 1);
    assert_int_equal(ms_template_make(&made, &clump, &particle, NULL), MS_OK);
    assert_memory_equal(made.clump.sphere, clump.sphere, sizeof *clump.sphere);
    assert_null(made.clump.mass);
    expect_close(ms_template_reach(&clump), 1 + sqrt(0.14), 1e-15);
    ms_template_free(&made);
    ms_clump_free(&clump);
}

/* Writes it in a format and reads it again. */
static void read_again(ms_clump *got, ms_particle *known, const char *folder, const char *format, const ms_clump *clump,
                       const ms_particle *particle)
{
    char path[128];
    ms_error err = {{0}};
    const ms_content content = {.clump = clump, .particle = particle};
    snprintf(path, sizeof path, "%s/c.%s", folder, format);
    if (ms_write_clump(&content, path, ms_write_format_find(format, NULL), &err) != MS_OK ||
        ms_read_clump(got, known, path, &err) != MS_OK) {
        fail_msg("%s: %s", format, err.text);
    }
}

static void expect_equal_clumps(const ms_clump *got, const ms_clump *expected, int masses)
{
    assert_int_equal(got->n_spheres, expected->n_spheres);
    assert_memory_equal(got->sphere, expected->sphere, got->n_spheres * sizeof *got->sphere);
    assert_int_equal(got->mass != NULL, masses);
    if (masses) {
        assert_memory_equal(got->mass, expected->mass, got->n_spheres * sizeof *got->mass);
    }
}

static void clean(const char *folder)
{
    char command[96];
    snprintf(command, sizeof command, "rm -r %s", folder);
    assert_int_equal(system(command), 0);
}

static void round_trips(void **state)
{
    static const struct {
        const char *format;
        int is_template, masses;
    } FORMATS[] = {{"csv", 0, 1}, {"json", 0, 1}, {"lammps", 1, 1}, {"liggghts", 1, 0}, {"yade", 1, 0}};
    char folder[64], path[128];
    ms_clump clump, got;
    ms_particle particle, known;
    ms_template made;
    (void)state;
    make_folder(folder);
    make_clump(&clump, &particle);
    assert_int_equal(ms_template_make(&made, &clump, &particle, NULL), MS_OK);
    for (size_t f = 0; f < 5; f++) {
        read_again(&got, &known, folder, FORMATS[f].format, &clump, &particle);
        expect_equal_clumps(&got, FORMATS[f].is_template ? &made.clump : &clump, FORMATS[f].masses);
        if (f == 1) { /* JSON knows the particle whole */
            assert_memory_equal(&known, &particle, sizeof known);
        } else if (f == 2) { /* a molecule all but the density */
            known.density = made.particle.density;
            assert_memory_equal(&known, &made.particle, sizeof known);
        } else {
            assert_true(known.mass == 0);
        }
        ms_clump_free(&got);
    }
    snprintf(path, sizeof path, "%s/c.frame.json", folder);
    assert_int_equal(ms_read_particle(&known, path, NULL), MS_OK);
    assert_memory_equal(&known, &particle, sizeof known);
    clean(folder);
    ms_template_free(&made);
    ms_clump_free(&clump);
}

/* All numbers of a text file, in order. */
static size_t numbers_of(double *out, size_t room, const char *folder, const char *name)
{
    char path[192];
    size_t n = 0;
    ms_bytes bytes;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    assert_int_equal(ms_file_read(&bytes, path, NULL), MS_OK);
    for (char *word = strtok((char *)bytes.data, " ,\n"); word && n < room; word = strtok(NULL, " ,\n")) {
        const ms_word w = {word, strlen(word)};
        n += ms_text_to_double(&out[n], &w) != 0;
    }
    ms_file_free(&bytes);
    return n;
}

static void expect_spheres(const double *number, const ms_clump *clump, size_t stride, double over)
{
    for (size_t s = 0; s < clump->n_spheres; s++) {
        for (int k = 0; k < 3; k++) {
            expect_close(number[stride * s + k] * over, clump->sphere[s].centre[k], 1e-17);
        }
        expect_close(number[stride * s + 3] * over, clump->sphere[s].radius, 1e-17);
    }
}

static void what_the_other_engines_are_told(void **state)
{
    static const char *const FORMATS[] = {"mercury", "deme", "kratos", "mfix", "pfc"};
    char folder[64], path[128];
    double v[200];
    ms_clump clump;
    ms_particle particle;
    ms_template made;
    (void)state;
    make_folder(folder);
    make_clump(&clump, &particle);
    assert_int_equal(ms_template_make(&made, &clump, &particle, NULL), MS_OK);
    for (size_t f = 0; f < 5; f++) {
        const ms_content content = {.clump = &clump, .particle = &particle};
        snprintf(path, sizeof path, "%s/c.%s", folder, FORMATS[f]);
        assert_int_equal(ms_write_clump(&content, path, ms_write_format_find(FORMATS[f], NULL), NULL), MS_OK);
    }
    assert_int_equal(numbers_of(v, 200, folder, "c.mercury/Clump/Clump.txt"), 24);
    expect_spheres(v, &made.clump, 4, 1);
    assert_int_equal(numbers_of(v, 200, folder, "c.mercury/Inertia/Mass.txt"), 1);
    expect_close(v[0], particle.mass, 0);
    assert_int_equal(numbers_of(v, 200, folder, "c.mercury/Inertia/TOI.txt"), 9);
    assert_int_equal(numbers_of(v + 9, 100, folder, "c.mercury/Inertia/PD.txt"), 9);
    for (int k = 0; k < 9; k++) {
        expect_close(v[k], made.particle.inertia[k / 3][k % 3], 0);
        expect_close(v[9 + k], k / 3 == k % 3, 0);
    }
    assert_int_equal(numbers_of(v, 200, folder, "c.deme"), 24);
    expect_spheres(v, &made.clump, 4, 1);
    /* Kratos: spheres, centre and diameter, size, volume, inertia per unit mass. */
    assert_int_equal(numbers_of(v, 200, folder, "c.kratos"), 24 + 4 + 1 + 1 + 3);
    expect_spheres(v, &made.clump, 4, 1);
    expect_close(v[29] * 2650, particle.mass, 1e-16);
    expect_close(pi / 6 * v[27] * v[27] * v[27], v[29], 1e-18);
    for (int m = 0; m < 3; m++) {
        expect_close(v[30 + m] * particle.mass, made.particle.inertia[m][m], 1e-24);
    }
    /* MFiX: "#version = 1", then x, y, z, diameter over that of the ball around, and 14 more. */
    const double bound = 2 * ms_template_reach(&made.clump);
    assert_int_equal(numbers_of(v, 200, folder, "c.mfix"), 1 + 6 * 18);
    for (int s = 0; s < 6; s++) {
        v[1 + 18 * s + 3] /= 2;
    }
    expect_spheres(v + 1, &made.clump, 18, bound);
    /* PFC: the number of pebbles, r x y z of each, volume, inertia at unit density. */
    assert_int_equal(numbers_of(v, 200, folder, "c.pfc"), 1 + 24 + 1 + 6);
    expect_close(v[0], 6, 0);
    expect_close(v[1], made.clump.sphere[0].radius, 0);
    expect_close(v[4], made.clump.sphere[0].centre[2], 0);
    for (int m = 0; m < 3; m++) {
        expect_close(v[26 + m] * 2650, made.particle.inertia[m][m], 1e-22);
    }
    clean(folder);
    ms_template_free(&made);
    ms_clump_free(&clump);
}

/* The clump with two carriers and masses of all eight. */
static void make_clump_with_carriers(ms_clump *clump, ms_particle *particle)
{
    make_clump(clump, particle);
    for (int c = 0; c < 2; c++) {
        ms_sphere carrier = clump->sphere[c];
        carrier.centre[c] += 0.3 * carrier.radius;
        carrier.radius /= 20;
        assert_int_equal(ms_clump_add_carrier(clump, &carrier, NULL), MS_OK);
    }
    assert_int_equal(ms_clump_alloc_masses(clump, NULL), MS_OK);
    for (int s = 0; s < 8; s++) {
        clump->mass[s] = particle->mass / 36 * (s + 1);
    }
}

static void carriers_go_with_masses(void **state)
{
    static const struct {
        const char *format;
        int is_template, masses;
    } FORMATS[] = {{"csv", 0, 1}, {"json", 0, 1}, {"lammps", 1, 1}, {"liggghts", 1, 0}, {"yade", 1, 0}, {"deme", 1, 0}};
    char folder[64];
    double v[400];
    ms_clump clump, got;
    ms_particle particle, known;
    ms_template made;
    (void)state;
    make_folder(folder);
    make_clump_with_carriers(&clump, &particle);
    assert_int_equal(ms_template_make(&made, &clump, &particle, NULL), MS_OK);
    assert_int_equal(made.clump.n_carriers, 2);
    for (size_t f = 0; f < 6; f++) {
        const ms_clump *expected = FORMATS[f].is_template ? &made.clump : &clump;
        read_again(&got, &known, folder, FORMATS[f].format, &clump, &particle);
        expect_equal_clumps(&got, expected, FORMATS[f].masses);
        assert_int_equal(got.n_carriers, FORMATS[f].masses ? 2 : 0);
        assert_memory_equal(got.sphere + 6, expected->sphere + 6, got.n_carriers * sizeof *got.sphere);
        assert_true(!got.mass || memcmp(got.mass + 6, clump.mass + 6, 2 * sizeof *got.mass) == 0);
        ms_clump_free(&got);
    }
    for (size_t f = 0; f < 2; f++) { /* without the particle no masses are written, and so no carriers */
        read_again(&got, &known, folder, FORMATS[f].format, &clump, NULL);
        expect_equal_clumps(&got, &clump, 0);
        assert_int_equal(got.n_carriers, 0);
        ms_clump_free(&got);
    }
    /* Engines that take mass and inertia as given, and MFiX, which takes no masses, get what touches alone. */
    const struct {
        const char *format;
        size_t numbers;
    } CONTACTS[] = {{"kratos", 24 + 4 + 1 + 1 + 3}, {"mfix", 1 + 6 * 18}, {"pfc", 1 + 24 + 1 + 6}};
    const ms_content content = {.clump = &clump, .particle = &particle};
    for (size_t f = 0; f < 3; f++) {
        char path[128], name[16];
        snprintf(name, sizeof name, "c.%s", CONTACTS[f].format);
        snprintf(path, sizeof path, "%s/%s", folder, name);
        assert_int_equal(ms_write_clump(&content, path, ms_write_format_find(CONTACTS[f].format, NULL), NULL), MS_OK);
        assert_int_equal(numbers_of(v, 400, folder, name), CONTACTS[f].numbers);
    }
    clean(folder);
    ms_template_free(&made);
    ms_clump_free(&clump);
}

static void vtk_has_masses_and_densities(void **state)
{
    char folder[64], path[128];
    double v[200];
    ms_clump clump;
    ms_particle particle;
    (void)state;
    make_folder(folder);
    make_clump(&clump, &particle);
    const ms_content content = {.clump = &clump, .particle = &particle};
    snprintf(path, sizeof path, "%s/c.vtk", folder);
    assert_int_equal(ms_write_clump(&content, path, NULL, NULL), MS_OK);
    const size_t n = numbers_of(v, 200, folder, "c.vtk");
    for (size_t s = 0; s < 6; s++) { /* radii, a 1, masses, a 1, densities */
        const double r = SCALE * clump.sphere[s].radius;
        expect_close(v[n - 20 + s], clump.sphere[s].radius, 0);
        expect_close(v[n - 13 + s], clump.mass[s], 0);
        expect_close(v[n - 6 + s] * ball_volume(r), clump.mass[s], 1e-15);
    }
    clean(folder);
    ms_clump_free(&clump);
}

static void templates_need_a_particle(void **state)
{
    char folder[64], path[128];
    ms_clump clump;
    ms_particle particle;
    ms_error err = {{0}};
    (void)state;
    make_folder(folder);
    make_clump(&clump, &particle);
    const ms_content bare = {.clump = &clump};
    snprintf(path, sizeof path, "%s/c.liggghts", folder);
    assert_int_equal(ms_write_clump(&bare, path, NULL, &err), MS_ERR_ARG);
    expect_message(&err, "mskit correct");
    free(clump.mass);
    clump.mass = NULL;
    const ms_content massless = {.clump = &clump, .particle = &particle};
    snprintf(path, sizeof path, "%s/c.lammps", folder);
    assert_int_equal(ms_write_clump(&massless, path, NULL, &err), MS_ERR_ARG);
    expect_message(&err, "a mass for each sphere");
    particle.density = 0;
    snprintf(path, sizeof path, "%s/c.clu", folder);
    assert_int_equal(ms_write_clump(&massless, path, NULL, &err), MS_ERR_ARG);
    expect_message(&err, "density");
    assert_int_equal(rmdir(folder), 0); /* nothing is left */
    ms_clump_free(&clump);
}

static void a_decimal_comma_changes_nothing(void **state)
{
    char folder[64];
    ms_clump clump, got;
    ms_particle particle, known;
    ms_template made;
    (void)state;
    if (!setlocale(LC_NUMERIC, "de_DE.UTF-8") || strcmp(localeconv()->decimal_point, ",") != 0) {
        setlocale(LC_NUMERIC, "C");
        print_message("skipped: the locale de_DE.UTF-8 is not installed\n");
        skip();
    }
    make_folder(folder);
    make_clump(&clump, &particle);
    assert_int_equal(ms_template_make(&made, &clump, &particle, NULL), MS_OK);
    read_again(&got, &known, folder, "lammps", &clump, &particle);
    expect_equal_clumps(&got, &made.clump, 1);
    ms_clump_free(&got);
    read_again(&got, &known, folder, "json", &clump, &particle);
    expect_equal_clumps(&got, &clump, 1);
    setlocale(LC_NUMERIC, "C");
    clean(folder);
    ms_clump_free(&got);
    ms_template_free(&made);
    ms_clump_free(&clump);
}

static void expect_refused(const char *folder, const char *name, const char *text, const char *says)
{
    char path[128];
    ms_clump clump;
    ms_particle particle;
    ms_error err = {{0}};
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fputs(text, f);
    fclose(f);
    assert_int_not_equal(ms_read_clump(&clump, &particle, path, &err), MS_OK);
    expect_message(&err, path);
    expect_message(&err, says);
    assert_true(clump.n_spheres == 0 && !clump.sphere && !clump.mass && particle.mass == 0);
    remove(path);
}

static void bad_files_are_refused(void **state)
{
    char folder[64];
    (void)state;
    make_folder(folder);
    expect_refused(folder, "a.csv", "x,y,z,r,mass\n0,0,0,1\n", "line 2");
    expect_refused(folder, "a.csv", "x,y,z,r,mass\n0,0,0,1,2\n0,0,0,1,0\n", "sphere 2 has the mass 0");
    expect_refused(folder, "a.csv", "x,y,z,r,mass\n0,0,0,1,nan\n", "sphere 1 has the mass nan");
    expect_refused(folder, "a.json", "{\"spheres\": [[0,0,0,1]", "this is no JSON");
    expect_refused(folder, "a.json", "{}", "no list 'spheres'");
    expect_refused(folder, "a.json", "{\"spheres\": [[0,0,1]]}", "sphere 1 is no list of 4");
    expect_refused(folder, "a.json", "{\"spheres\": [[0,0,0,-1]]}", "radii above 0");
    expect_refused(folder, "a.json", "{\"spheres\": [[0,0,0,\"1\"]]}", "sphere 1 is no list of 4");
    expect_refused(folder, "a.json", "{\"columns\": [\"x\",\"y\",\"z\",\"r\",\"mass\"], \"spheres\": [[0,0,0,1]]}",
                   "list of 5");
    expect_refused(folder, "a.json", "{\"columns\": [\"r\",\"x\",\"y\",\"z\"], \"spheres\": [[1,0,0,1]]}",
                   "x, y, z stand in other columns");
    expect_refused(folder, "a.json", "{\"columns\": [\"x\",\"y\",\"z\",\"d\"], \"spheres\": [[0,0,0,1]]}",
                   "called 'd'");
    expect_refused(folder, "a.json", "{\"spheres\": [[0,0,0,1]], \"carriers\": [[0,0,0,0.1]]}", "tells of no masses");
    expect_refused(folder, "a.json", "{\"columns\": [0,0,0,0], \"spheres\": [[0,0,0,1]]}", "called ''");
    expect_refused(folder, "a.json", "{\"columns\": [\"x\"], \"spheres\": [[0,0,0,1]]}", "no list that begins with x");
    expect_refused(folder, "a.json", "{\"columns\": \"xyzr\", \"spheres\": [[0,0,0,1]]}", "no list that begins with x");
    expect_refused(folder, "a.yade", "0 0 0 1 7\n1 0 0 1 7\n2 0 0 1 8\n", "line 3: this sphere is of clump 8");
    expect_refused(folder, "a.yade", "# x y z r clumpId\n0 0 0 1 0\n1 0 0 1 1\n", "those before of clump 0");
    expect_refused(folder, "a.txt", "#format x_y_z_r_clumpId\n# of a bed\n0\t0\t0\t1\t3\n1\t0\t0\t1\t4\n",
                   "of clump 4");
    expect_refused(folder, "a.csv", "x,y,z,r,clumpId\n0,0,0,1,3\n1,0,0,1,4\n", "of clump 4");
    expect_refused(folder, "a.json", "{\"spheres\": [[0,0,0,1]], \"particle\": {\"mass\": 1}}", "not all of scale");
    expect_refused(folder, "a.lammps", "", "number of atoms");
    expect_refused(folder, "a.lammps", "t\n\n0 atoms\n", "line 3");
    expect_refused(folder, "a.lammps", "t\n\n1e9 atoms\n", "from 1 to 65534");
    expect_refused(folder, "a.lammps", "t\n1 atoms\n2 atoms\n", "given twice");
    expect_refused(folder, "a.lammps", "t\n1 atoms\n1 bonds\n", "not understood");
    expect_refused(folder, "a.lammps", "t\n1 atoms\n1 2 3 1 0 0 inertia\n", "principal axes");
    expect_refused(folder, "a.lammps", "t\n1 atoms\n\nBonds\n", "no section");
    expect_refused(folder, "a.lammps", "t\n1 atoms\n\nCoords\n\n1 0 0\n", "line 6");
    expect_refused(folder, "a.lammps", "t\n1 atoms\n\nCoords\n\n2 0 0 0\n", "no sphere 2");
    expect_refused(folder, "a.lammps", "t\n2 atoms\n\nCoords\n\n1 0 0 0\n", "after 1 of 2");
    expect_refused(folder, "a.lammps", "t\n1 atoms\n\nCoords\n\n1 0 0 0\n", "Diameters");
    expect_refused(folder, "a.lammps", "t\n1 atoms\n\nCoords\n\n1 0 0 0\n\nDiameters\n\n1 0\n", "radii above 0");
    expect_refused(folder, "a.lammps",
                   "t\n1 atoms\ninf mass\n1 1 1 0 0 0 inertia\n\nCoords\n\n1 0 0 0\n\nDiameters\n\n1 1\n",
                   "not from 1e-290 to 1e+290");
    expect_refused(folder, "a.lammps", "t\n1 atoms\n1 mass\n\nCoords\n\n1 0 0 0\n\nDiameters\n\n1 1\n",
                   "not from 1e-290 to 1e+290");
    expect_refused(folder, "a.json",
                   "{\"spheres\": [[0,0,0,1]], \"particle\": {\"scale\": 1, \"density\": 1e-30, \"mass\": 1, "
                   "\"centre\": [0,0,0], \"inertia\": [[1e280,0,0],[0,1e280,0],[0,0,1e280]]}}",
                   "not from 1e-290 to 1e+290");
    expect_refused(folder, "a.json",
                   "{\"spheres\": [[0,0,0,1]], \"particle\": {\"scale\": 1, \"density\": 1e-31, \"mass\": 1, "
                   "\"centre\": [0,0,0], \"inertia\": [[1,0,0],[0,1,0],[0,0,1]]}}",
                   "that of no body");
    expect_refused(folder, "a.pfc", "clump", "written and not read");
    assert_int_equal(rmdir(folder), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(into_the_frame_and_back),
        cmocka_unit_test(a_body_without_axes_of_its_own_keeps_those_of_the_input),
        cmocka_unit_test(round_trips),
        cmocka_unit_test(what_the_other_engines_are_told),
        cmocka_unit_test(vtk_has_masses_and_densities),
        cmocka_unit_test(carriers_go_with_masses),
        cmocka_unit_test(templates_need_a_particle),
        cmocka_unit_test(a_decimal_comma_changes_nothing),
        cmocka_unit_test(bad_files_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
