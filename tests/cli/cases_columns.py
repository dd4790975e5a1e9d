"""The names that scripts rely on: the header line of every CSV and the keys of every JSON that the program writes."""
import csv
import json

from support import Case

NORMALS = "normal_median normal_95 edge_part edge_normal_median edge_normal_95"
SCORES = ("spheres eta dice coverage overshoot off_volume protrusion_max protrusion_rms gap_max gap_rms " + NORMALS +
          " smallest_radius_ratio work pieces coverage_cut volume inertia_error.moments inertia_error.weighted_mean "
          "inertia_error.axes_degrees inertia_error.centroid")
FORM = "equivalent_diameter area sphericity elongation flatness feret_elongation feret_flatness corey convexity".split()
DESCRIPTORS = ["voxel_limit"] + [which + name for name in FORM for which in ("shape_", "clump_")]
SCORES = SCORES.replace(" volume", " " + " ".join(DESCRIPTORS) + " volume")
MENDED = "joined dropped_degenerate dropped_duplicate filled_holes dropped_bodies dropped_volume turned"
TARGET = "path fnv1a rule grid voxel_size grid_origin voxels triangles closed " + MENDED
MASSES = ("epsilon products_epsilon centre_epsilon optimal least most error_mass error_centre error_moments "
          "error_products seconds")
PARTICLE = "scale density mass centre inertia principal_moments principal_axes"
SECONDS = "read voxelize distance generate score cpu"
RECORD = ("generator options.variant options.spacing options.boost options.polish options.radius-offset options.order "
          "options.confine options.plane "
          "seed until.spheres stopped_by")


def keys(value, before=""):
    """Names with dots, in order; of a list, those of its first element."""
    found = []
    if isinstance(value, list) and value and isinstance(value[0], dict):
        return keys(value[0], before)
    for key, inner in value.items() if isinstance(value, dict) else ():
        deeper = keys(inner, before + key + ".")
        found += deeper or [before + key]
    return found


def under(prefix, names):
    return [prefix + "." + name for name in names.split()]


class Columns(Case):
    def setUp(self):
        super().setUp()
        self.shape("grain")

    def header(self, name):
        return self.read(name).decode().splitlines()[0]

    def clump(self):
        self.mskit("generate", "grain.stl", "-g", "mss", "-n", 5, "--cells", 15, "-o", "c.csv")

    def test_csv_of_clumps(self):
        self.clump()
        self.assertEqual(self.header("c.csv"), "x,y,z,r")
        self.mskit("correct", "c.csv", "--target", "grain.stl", "--density", 1000, "--cells", 15, "-o", "m.csv")
        self.assertEqual(self.header("m.csv"), "x,y,z,r,mass,density")

    def test_csv_of_curves(self):
        self.clump()
        line = "n,eta,dice,coverage,overshoot"
        out = self.mskit("score", "c.csv", "--target", "grain.stl", "--cells", 15, "--curve").out
        self.assertEqual(out.splitlines()[0], line)
        self.mskit("generate", "grain.stl", "-n", 3, "--cells", 15, "-o", "d.csv", "--curve", "k.csv")
        self.assertEqual(self.header("k.csv"), line)

    def test_csv_of_compare(self):
        self.mskit("compare", "grain.stl", "-g", "mss", "-n", 2, "--cells", 10)
        self.assertEqual(self.header("compare.csv"),
                         "shape,checksum,label,generator,options,seed,cells,n_asked,flags,n,stopped_by,eta,dice,"
                         "coverage,"
                         "overshoot,off_volume,protrusion_max,protrusion_rms,gap_max,gap_rms," +
                         NORMALS.replace(" ", ",") + ",smallest_radius_ratio,work,"
                         "pieces,inertia_union,coverage_cut," + ",".join(DESCRIPTORS) +
                         ",expected,inertia_corrected,epsilon,"
                         "products_epsilon,centre_epsilon,voxel_size,"
                         "seconds_read,seconds_voxelize,seconds_distance,seconds_describe,seconds_generate,"
                         "seconds_least,"
                         "seconds_most,seconds_score,seconds_correct,repeats,peak_memory_kb,machine,threads,beside,"
                         "version,cause")

    def test_csv_of_stability(self):
        self.mskit("stability", "grain.stl", "-g", "mss", "-n", 2, "--cells", 10, "--runs", 1, "--perturb", "seed")
        self.assertEqual(self.header("stability.csv"),
                         "shape,checksum,generator,options,perturbation,level,seed,voxel_size,threads,n_asked,flags,"
                         "status,"
                         "n,stopped_by,eta,dice,coverage,overshoot,off_volume,inertia_error,coverage_cut," +
                         NORMALS.replace(" ", ",") + ",smallest_radius_ratio,work,pieces," + ",".join(DESCRIPTORS) +
                         ",n_until,seconds,beside,spheres_fnv1a,cause")

    def test_json_of_generate(self):
        run = self.generate("grain.stl", "-g", "mss", "-n", 5, "--cells", 15, "-o", "c.json")
        record = (RECORD.split() + under("input", TARGET) + under("scores", SCORES) + under("seconds", SECONDS) +
                  ["threads", "peak_memory_kb"])
        expected = under("expected", "dice factor")
        self.assertEqual(keys(run), record + expected)
        written = json.loads(self.read("c.json"))
        self.assertEqual(keys(written), ["mskit"] + record + ["columns", "spheres"])
        self.assertEqual(written["columns"], ["x", "y", "z", "r"])
        run = self.generate("grain.stl", "-g", "mss", "-n", 5, "--cells", 15, "--correct", "--density", 1000)
        self.assertEqual(keys(run), record + under("particle", PARTICLE) + under("masses", MASSES) + expected)

    def test_json_of_score(self):
        self.clump()
        run = self.mskit("score", "c.csv", "--target", "grain.stl", "--cells", 15, "--json").json
        self.assertEqual(keys(run), under("target", TARGET) + under("scores", SCORES))

    def test_json_of_correct(self):
        self.clump()
        run = self.mskit("correct", "c.csv", "--target", "grain.stl", "--density", 1000, "--cells", 15,
                         "--json", "-o", "m.json", "-o", "m.lammps").json
        self.assertEqual(keys(run), under("particle", PARTICLE) + under("masses", MASSES))
        self.assertEqual(json.loads(self.read("m.json"))["columns"], ["x", "y", "z", "r", "mass", "density"])
        frame = json.loads(self.read("m.frame.json"))
        self.assertEqual(keys(frame), ["mskit", "frame"] + under("particle", PARTICLE))

    def test_json_of_info(self):
        run = self.mskit("info", "grain.stl", "--json").json
        body = "volume centroid inertia principal_moments principal_axes"
        self.assertEqual(keys(run), ("path box_lo box_hi " + " ".join(FORM) + " feret triangles vertices closed "
                                     "open_edges nonmanifold_edges shells bodies cavities overlapping holes "
                                     "largest_hole " +
                                     MENDED + " " + body).split())

    def test_json_of_generators(self):
        self.assertEqual(keys(self.mskit("generators", "--json").json), "name summary source nested baseline".split())

    def test_json_of_help(self):
        about = self.mskit("help", "mss", "--json").json
        self.assertEqual(keys(about), "name summary source nested".split() +
                         under("options", "name type default min max unit choices help"))
        self.assertEqual([o["name"] for o in about["options"]],
                         "variant spacing boost polish radius-offset order confine plane".split())
        self.assertEqual(keys(self.mskit("help", "score", "--json").json), "name summary usage example".split() +
                         under("flags", "name letter argument help"))

    def test_json_of_shape(self):
        kinds = self.mskit("shape", "--list", "--json").json
        self.assertEqual(keys(kinds), ["name", "summary"] + under("parameters", "name default min max help"))
        ball = next(kind for kind in kinds if kind["name"] == "ball")
        self.assertEqual([(p["name"], p["default"]) for p in ball["parameters"]], [("r", 1), ("fineness", 56)])
        self.assert_refused("shape", "ball", "--json", "-o", "x.stl", code=2, says=("--list",))

    def test_json_of_compare(self):
        """All rows of the file, in its columns: those that were there and those that failed, too."""
        self.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        args = ("compare", "grain.stl", "open.obj", "-g", "mss:spacing=3", "-n", "2,3", "--cells", 10)
        self.mskit(*args)
        result = self.mskit(*args, "--resume", "--json")
        rows = result.json
        self.assertEqual(keys(rows), self.header("compare.csv").split(","))
        with open(self.path("compare.csv"), encoding="utf-8") as stream:
            written = list(csv.DictReader(stream))
        self.assertEqual(len(rows), 4)
        for row, columns in zip(rows, written):
            for name, text in columns.items():
                value = row[name]
                self.assertEqual(value, None if not text else text if isinstance(value, str) else float(text), name)
            self.assertEqual((row["options"], row["seed"]), ("spacing=3", 1))
        self.assertEqual([row["dice"] is None for row in rows], [False, False, True, True])
        self.assertIn("is open", rows[2]["cause"])
        self.assertIn("wrote compare.csv", result.err)

    def test_json_of_stability(self):
        run = self.mskit("stability", "grain.stl", "-g", "mss", "-n", 2, "--cells", 10, "--runs", 1, "--perturb",
                         "seed", "--json").json
        spread = "count min median max deviation"
        self.assertEqual(keys(run), "shape method perturbation runs identical failed short unusable not_reached "
                         "remarked".split() +
                         under("dice", spread) + under("inertia_error_spread", spread) + under("n_until", spread) +
                         ["worst", "cause", "remark"])

    def test_json_of_scene(self):
        run = self.mskit("scene", "grain.stl", "-g", "mss", "--knee", 0.3, "--max-spheres", 4, "--cells", 10,
                         "--json").json
        options = "variant spacing boost polish radius-offset order confine plane"
        self.assertEqual(keys(run), ["generator"] + under("options", options) +
                         "seed max_spheres min_radius goal.knee particles spheres mean_dice least_gain slack".split() +
                         under("even", "each spheres mean_dice") + under("smallest", "radius shape") +
                         under("shapes", "particles tolerance gain smallest_radius") +
                         under("shapes.scores", "spheres eta dice coverage overshoot off_volume inertia coverage_cut") +
                         under("shapes.input", TARGET) + ["shapes.curve"])
