"""mskit grains: a clump for every grain of volumes, folders, patterns and manifests."""
import csv
import fcntl
import io
import json
import os
import resource
import signal
import struct
import subprocess
import time

from support import MSKIT, Case, box_obj, npy, parse_spheres, shared_file

TIMES = ("seconds", "beside")

# Boxes of the labels in a volume of 26 x 14 x 12 voxels, half open; 7 touches the border, 9 is small.
SIZE = (26, 14, 12)
BOXES = {4: ((2, 12), (2, 12), (2, 10)), 7: ((14, 26), (1, 11), (2, 11)), 9: ((13, 15), (12, 13), (10, 11))}


def voxels(label):
    count = 1
    for lo, hi in BOXES[label]:
        count *= hi - lo
    return count


def volume():
    def at(*voxel):
        for label, box in BOXES.items():
            if all(lo <= v < hi for v, (lo, hi) in zip(voxel, box)):
                return label
        return 0
    return npy([at(i, j, k) for k in range(SIZE[2]) for j in range(SIZE[1]) for i in range(SIZE[0])], SIZE[::-1])


def parse(text):
    return list(csv.DictReader(io.StringIO(text)))


class Grains(Case):
    def setUp(self):
        super().setUp()
        self.write("scan.npy", volume())
        os.mkdir(self.path("stones"))
        self.write("stones/b.obj", box_obj((0, 0, 0), (3, 2, 1)))
        self.write("stones/a.obj", box_obj((0, 0, 0), (1, 1, 2)))

    def table(self, name="out/grains.csv"):
        return parse(self.read(name).decode())

    def known(self, name="out/grains.csv"):
        """Rows without what differs from run to run."""
        return [{key: value for key, value in row.items() if key not in TIMES} for row in self.table(name)]

    def grains(self, *args, out="out", **more):
        self.mskit("grains", *args, "-o", out, **more)
        return self.table(out + "/grains.csv")

    def tree(self, folder):
        found = {}
        for at, _, names in os.walk(self.path(folder)):
            for name in names:
                path = os.path.join(at, name)
                with open(path, "rb") as f:
                    found[os.path.relpath(path, self.path(folder))] = f.read()
        return found


class Rows(Grains):
    def test_every_label_and_every_mesh(self):
        rows = self.grains("scan.npy", "stones", "-g", "mss", "-n", "5", "--cells", "12", "-j", "2")
        self.assertEqual([(row["grain"], row["grains"], row["label"], row["file"]) for row in rows],
                         [("1", "5", "4", "0000/scan-4.csv"), ("2", "5", "7", "0000/scan-7.csv"),
                          ("3", "5", "9", "0000/scan-9.csv"), ("4", "5", "", "0000/a.csv"),
                          ("5", "5", "", "0000/b.csv")])
        self.assertEqual([row["voxels"] for row in rows], [str(voxels(label)) for label in BOXES] + ["", ""])
        self.assertEqual([row["cut_by_border"] for row in rows], ["0", "1", "0", "", ""])
        for row in rows:
            self.assertEqual((row["status"], row["cause"], row["generator"], row["n_asked"]), ("ok", "", "mss", "5"))
            self.assertEqual(len(parse_spheres(self.read("out/" + row["file"]).decode())), int(row["n"]))

    def test_a_clump_is_that_of_generate(self):
        rows = self.grains("scan.npy", "stones/b.obj", "-n", "6", "--cells", "10", "--seed", "3")
        for row, shape in ((rows[0], ("scan.npy", "--label", "4")), (rows[3], ("stones/b.obj", "--cells", "10"))):
            record = self.generate(*shape, "-n", "6", "--seed", "3", "-o", "one.csv")
            self.assertEqual(self.read("one.csv"), self.read("out/" + row["file"]))
            self.assertEqual(float(row["dice"]), record["scores"]["dice"])
            self.assertEqual((row["stopped_by"], row["seed"]), ("spheres", "3"))
            self.assertEqual(float(row["volume"]), record["input"].get("volume", float(row["volume"])))

    def test_stop_rules_and_patterns(self):
        rows = self.grains("stones/*.obj", "-g", "setcover", "--until", "coverage=0.6", "--cells", "12",
                           "--min-radius", "0.001")
        self.assertEqual([row["source"] for row in rows], ["stones/a.obj", "stones/b.obj"])
        for row in rows:
            self.assertEqual((row["n_asked"], row["until"], row["stopped_by"]),
                             ("", "coverage=0.6 radius=0.001", "coverage"))
            self.assertGreaterEqual(float(row["coverage"]), 0.6)

    def test_templates_with_the_true_mass(self):
        rows = self.grains("stones", "-n", "12", "--cells", "16", "--format", "csv", "--format", "lammps", "--density",
                           "2000", "--unit", "mm")
        for row, volume_mm3 in zip(rows, (2, 6)):
            masses = [float(line["mass"]) for line in parse(self.read("out/" + row["file"]).decode())]
            self.assert_close(sum(masses), 2000 * volume_mm3 * 1e-9, 1e-9, "mass")
            self.assertTrue(row["epsilon"] and row["centre_epsilon"])
            self.assertEqual((row["scale"], row["carriers"]), ("", "0"))
        self.assertIn("a.lammps", os.listdir(self.path("out/0000")))

    def test_scale_and_carriers(self):
        """As generate says them of each."""
        flags = ("-n", "12", "--cells", "16", "--density", "2000", "--unit", "mm", "--equal-volume", "--carriers")
        for row in self.grains("stones", "-g", "setcover", *flags):
            alone = self.mskit("generate", row["source"], "-g", "setcover", *flags, "--correct", "-o", "a.json",
                               "--json").json
            self.assertEqual(float(row["scale"]), alone["equal_volume"]["scale"])
            clump = json.loads(self.read("a.json"))
            self.assertEqual(int(row["carriers"]), len(clump["carriers"]))
            self.assertGreater(int(row["carriers"]), 0)

    def test_a_folder_for_each_thousand(self):
        """By the number of the grain; those left out count, too."""
        labels = [*range(1, 1000), *(k for k in range(1000, 1004) for _ in range(2))]
        self.write("many.npy", npy(labels, (len(labels), 1, 1)))
        rows = self.grains("many.npy", "-g", "mss", "-n", "1", "--least-voxels", "2")
        self.assertEqual(len(rows), 1003)
        self.assertEqual(rows[999]["file"], "0000/many-1000.csv")
        self.assertEqual(rows[1000]["file"], "0001/many-1001.csv")
        self.assertEqual(sorted(os.listdir(self.path("out/0001"))), [f"many-{k}.csv" for k in (1001, 1002, 1003)])


class Faults(Grains):
    def test_filters_leave_out_with_a_cause(self):
        rows = self.grains("scan.npy", "-g", "mss", "-n", "2", "--skip-border", "--least-voxels", "10")
        self.assertEqual([row["status"] for row in rows], ["ok", "left-out", "left-out"])
        self.assertIn("border", rows[1]["cause"])
        self.assertIn("fewer than 10", rows[2]["cause"])
        self.assertEqual(os.listdir(self.path("out/0000")), ["scan-4.csv"])

    def test_a_fault_is_a_row_and_not_the_end(self):
        self.write("stones/aa.obj", "v 0 0 nan\nf 1 1 1\n")
        self.write("bad.npy", self.read("scan.npy")[:200])
        result = self.mskit("grains", "stones", "bad.npy", "scan.npy", "-g", "mss", "-n", "2", "--cells", "8",
                            "-o", "out")
        rows = self.table()
        self.assertEqual([row["status"] for row in rows], ["ok", "failed", "ok", "failed", "ok", "ok", "ok"])
        self.assertIn("aa.obj", rows[1]["cause"])
        self.assertIn("bad.npy", rows[3]["cause"])
        self.assertIn("2 failed", result.out)

    def test_remarks_of_the_method(self):
        """A bound that a clump cannot hold is in its row, with these commands, and how often is said."""
        bound = ("variational:gap=0.1,protrusion=0", "-n", "1", "--cells", "6")
        says = "gap=0.1 cannot be held by 1 sphere"
        self.grains("stones", "-g", "variational", "--gap", "0.1", "--protrusion", "0", *bound[1:])
        again = self.mskit("grains", "stones", "-g", "variational", "--gap", "0.1", "--protrusion", "0", *bound[1:],
                           "-o", "out", "--resume")
        self.assertIn("0 failed, 2 with a remark of the method: see the column cause", again.out)
        compared = self.mskit("compare", "stones/a.obj", "-g", *bound, "-o", "compare.csv")
        self.assertIn("on 1 of them the method has a remark", compared.out)
        changed = self.mskit("stability", "stones/a.obj", "-g", *bound, "--perturb", "seed", "--runs", "1",
                             "-o", "s.csv", "--json").json
        for group in changed:
            self.assertEqual((group["failed"], group["remarked"], group["cause"]), (0, 1, None))
            self.assertIn(says, group["remark"])
        for name in ("out/grains.csv", "compare.csv", "s.csv"):
            for row in self.table(name):
                self.assertIn(says, row["cause"])
                self.assertGreater(float(row["dice"]), 0)

    def test_exit_code_where_no_grain_has_a_clump(self):
        self.write("bad.obj", "nothing\n")
        self.assert_says(self.mskit("grains", "bad.obj", "-o", "out", code=1), "not one grain")
        self.assertEqual(self.table()[0]["status"], "failed")

    def test_what_is_wrong_is_said_before_the_work(self):
        grains = ("grains", "-n", "2", "-o", "out")
        self.assert_refused(*grains, "nowhere.stl", code=1, says=("nowhere.stl",))
        self.assert_refused(*grains, "nowhere/*.stl", code=1, says=("nowhere",))
        self.assert_refused("grains", "scan.npy", code=2, says=("-o DIR",))
        self.assert_refused("grains", "-o", "out", code=2, says=("takes",))
        self.assert_refused(*grains, "scan.npy", "--format", "lammps", code=2, says=("--density",))
        self.assert_refused(*grains, "scan.npy", "--part", "3/2", code=2, says=("3/2",))
        self.assert_refused(*grains, "scan.npy", "-g", "nothing", code=2, says=("nothing",))
        os.mkdir(self.path("empty"))
        self.assert_refused(*grains, "empty", code=1, says=("no mesh",))

    def test_two_grains_of_one_name(self):
        self.write("a.stl", self.read("stones/a.obj"))
        self.assert_refused("grains", "stones", "a.stl", "-n", "2", "-o", "out", code=1,
                            says=("stones/a.obj", "a.stl", "called a"))

    def test_names_are_made_safe(self):
        self.write("stones/$(x) \"y.obj", self.read("stones/a.obj"))
        rows = self.grains("stones", "-g", "mss", "-n", "1", "--cells", "4")
        for name in os.listdir(self.path("out/0000")):
            self.assertRegex(name, r"^[\w. ()-]+\.csv$")
        self.assertEqual(len(rows), 3)

    def test_commas_in_names_are_no_columns(self):
        os.mkdir(self.path("comma"))
        for name in ("a,b", "c,d"):
            self.write(f"comma/{name}.obj", self.read("stones/a.obj"))
        args = ("comma", "-g", "mss", "-n", "1", "--cells", "4")
        files = ["0000/a,b.csv", "0000/c,d.csv"]
        self.assertEqual([row["file"] for row in self.grains(*args)], files)
        self.assertEqual([row["file"] for row in self.grains(*args, "--resume", "--assembly")], files)
        row, = self.table("out/assembly.csv")
        self.assertEqual([row[key] + ".csv" for key in ("template", "neighbour_template")], files)

    def test_rows_that_are_there_are_not_replaced(self):
        args = ("grains", "stones", "-g", "mss", "-n", "2", "--cells", "6", "-o", "out")
        self.mskit(*args)
        before = self.tree("out")
        self.assert_says(self.mskit(*args, code=1), "exists")
        self.assert_says(self.mskit(*args, "--resume", "-n", "3", code=1), "another run", "line 2")
        self.assertEqual(self.tree("out"), before)

    def test_two_runs_into_one_folder(self):
        """The second is refused with and without --resume while the first is at work, which does not notice."""
        args = ("grains", "scan.npy", "stones", "-g", "mss", "-n", "4", "--cells", "30", "-j", "1")
        self.mskit(*args, "-o", "whole")
        first = subprocess.Popen([MSKIT, *args, "-o", "out"], cwd=self.dir, stdout=subprocess.DEVNULL)
        self.addCleanup(first.wait)
        self.addCleanup(first.kill)
        while not (os.path.exists(self.path("out/grains.csv")) and self.read("out/grains.csv")):
            time.sleep(0.001)
        first.send_signal(signal.SIGSTOP)
        self.assertIsNone(first.poll(), "it should be at work still")
        self.assert_says(self.mskit(*args, "-o", "out", "--resume", code=1), "another run is writing it")
        self.assert_says(self.mskit(*args, "-o", "out", code=1), "exists")
        first.send_signal(signal.SIGCONT)
        self.assertEqual(first.wait(), 0)
        self.assertEqual(self.known(), self.known("whole/grains.csv"))

    def test_a_full_disk(self):
        """Files may not grow beyond the first row and a half: this row is whole and the run goes on when there is
        room."""
        args = ("grains", "stones", "scan.npy", "-g", "mss", "-n", "2", "--cells", "6")
        self.mskit(*args, "-o", "whole")
        ends = [at for at, byte in enumerate(self.read("whole/grains.csv")) if byte == ord("\n")]
        most = (ends[1] + ends[2]) // 2
        result = self.mskit(*args, "-o", "out", code=1,
                            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (most, most)))
        self.assert_says(result, "out/grains.csv", "is the disk full", "1 rows before are intact")
        self.assertEqual(self.known(), self.known("whole/grains.csv")[:1])
        self.mskit(*args, "-o", "out", "--resume")
        self.assertEqual(self.known(), self.known("whole/grains.csv"))


class Manifest(Grains):
    def test_rows_say_what_is_special(self):
        self.write("stones/list.csv", "\ufeffshape,label,spheres,generator,cells,count\n# two of the scan\n"
                   "../scan.npy,7,3,mss,,5\n../scan.npy,4,,,,1\n\nb.obj,,4,\"mss\",9,2\n")
        rows = self.grains("stones/list.csv", "-n", "6", "-g", "setcover")
        self.assertEqual([(row["label"], row["generator"], row["n_asked"]) for row in rows],
                         [("7", "mss", "3"), ("4", "setcover", "6"), ("", "mss", "4")])
        self.assert_close(float(rows[2]["voxel_size"]), 1 / 9, 1e-12, "cells of the row")

    def test_wrong_rows_are_named(self):
        for line, says in (("b.obj,x,1", "label"), ("b.obj,1", "fields"), (",,1", "no shape"), ("c.obj,,1", "c.obj"),
                           ("b.obj,,-3", "spheres"), ("b.obj,,1,2", "fields")):
            self.write("stones/list.csv", "shape,label,spheres\na.obj,,2\n" + line + "\n")
            result = self.assert_refused("grains", "stones/list.csv", "-o", "out", code=None, says=(says,))
            self.assertNotEqual(result.code, 0)
        self.write("stones/list.csv", "shape,nonsense\na.obj,1\n")
        self.assert_refused("grains", "stones/list.csv", "-o", "out", code=1, says=("line 2", "--nonsense"))
        self.write("stones/list.csv", "a.obj\n")
        self.assert_refused("grains", "stones/list.csv", "-o", "out", code=1, says=("line 1", "shape"))


class Work(Grains):
    ARGS = ("scan.npy", "stones", "-g", "mss", "-n", "4", "--cells", "12")

    def test_bytes_do_not_hang_on_the_number_of_workers(self):
        for threads in ("1", "3"):
            self.grains(*self.ARGS, "-j", threads, out=threads)
        self.assertEqual(self.known("1/grains.csv"), self.known("3/grains.csv"))
        one, three = ({name: data for name, data in self.tree(t).items() if name != "grains.csv"} for t in "13")
        self.assertEqual(one, three)
        self.assertEqual({row["beside"] for row in self.table("3/grains.csv")}, {"2"})

    def test_a_run_that_was_cut_goes_on(self):
        self.grains(*self.ARGS)
        whole, text, files = self.known(), self.read("out/grains.csv"), self.tree("out")
        ends = [at for at, byte in enumerate(text) if byte == ord("\n")]
        for size in (0, 9, ends[0] + 1, ends[1] - 3, ends[1], ends[2] + 1, ends[3] + 50, len(text)):
            self.write("out/grains.csv", text[:size])
            self.grains(*self.ARGS, "--resume")
            self.assertEqual(self.known(), whole, f"cut after {size} bytes")
            self.assertEqual({k: v for k, v in self.tree("out").items() if k != "grains.csv"},
                             {k: v for k, v in files.items() if k != "grains.csv"})

    def test_killed_at_twenty_places(self):
        """kill -9 after each further row, again and again on the same folder: in the end all is as undisturbed."""
        for k in range(20):
            self.write(f"stones/more{k:02d}.obj", box_obj((0, 0, 0), (1 + k / 10, 1, 2)))
        args = ("scan.npy", "stones", "-g", "mss", "-n", "6", "--cells", "14", "-j", "2")
        self.grains(*args, out="whole")
        kills = 0
        for rows in range(1, 21):
            process = subprocess.Popen([MSKIT, "grains", *args, "-o", "out", "--resume"], cwd=self.dir,
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            while process.poll() is None:
                if os.path.exists(self.path("out/grains.csv")) and self.read("out/grains.csv").count(b"\n") > rows:
                    break
                time.sleep(0.001)
            process.send_signal(signal.SIGKILL)
            process.wait()
            kills += process.returncode == -signal.SIGKILL
        self.assertGreaterEqual(kills, 10, "it should have been at work still")
        self.grains(*args, "--resume")
        self.assertEqual(self.known(), self.known("whole/grains.csv"))
        clean = {k: v for k, v in self.tree("whole").items() if k != "grains.csv"}
        killed = self.tree("out")
        self.assertEqual({k: killed[k] for k in clean}, clean)

    def test_dry_run_writes_nothing(self):
        before = self.files()
        result = self.mskit("grains", *self.ARGS, "-o", "out", "--dry-run")
        self.assertRegex(result.out, r"5 grains of 3 sources .* .3 made a clump\); nothing is written")
        self.assertEqual(self.files(), before)


class Parts(Grains):
    ARGS = ("scan.npy", "stones", "-g", "mss", "-n", "4", "--cells", "12")

    def setUp(self):
        super().setUp()
        self.grains(*self.ARGS, out="whole")

    def run_parts(self, *parts, of, out="out"):
        for part in parts:
            self.mskit("grains", *self.ARGS, "-o", out, "--part", f"{part}/{of}")

    def test_parts_give_the_whole(self):
        self.run_parts(2, 1, 3, of=3)
        sizes = [len(self.table(f"out/grains-{part}-of-3.csv")) for part in (1, 2, 3)]
        self.assertEqual(sorted(sizes), [1, 2, 2])
        self.mskit("grains", "--merge", "out", "-o", "out")
        self.assertEqual(self.known(), self.known("whole/grains.csv"))
        clean = {k: v for k, v in self.tree("whole").items() if k != "grains.csv"}
        self.assertEqual({k: v for k, v in self.tree("out").items() if ".csv" in k and "grains" not in k}, clean)

    def test_table_of_another_run_is_not_replaced(self):
        self.grains("stones", "-g", "mss", "-n", "2", "--cells", "6")
        self.run_parts(1, 2, of=2, out="parts")
        before = self.tree("out")
        self.assert_says(self.mskit("grains", "--merge", "parts", "-o", "out", code=1), "out/grains.csv", "another run")
        self.assertEqual(self.tree("out"), before)
        for _ in range(2):  # that of the same run is
            self.mskit("grains", "--merge", "parts", "-o", "parts")
        self.assertEqual(len(self.table("parts/grains.csv")), 5)
        self.write("parts/grains.csv", "x,y\n")
        self.assert_says(self.mskit("grains", "--merge", "parts", "-o", "parts", code=1), "something else")

    def test_parts_in_folders_of_their_own(self):
        self.run_parts(1, of=2, out="one")
        self.run_parts(2, of=2, out="two")
        self.mskit("grains", "--merge", "one", "two/", "-o", "one")
        rows = self.table("one/grains.csv")
        for row, whole in zip(rows, self.table("whole/grains.csv")):
            self.assertEqual(self.read("one/" + row["file"]), self.read("whole/" + whole["file"]))
        self.assertEqual({row["file"].split("/0000")[0] for row in rows if row["file"][:2] == ".."}, {"../two"})
        self.assertEqual(len(rows), 5)

    def test_the_folder_of_the_whole_by_any_name(self):
        self.run_parts(1, 2, of=2)
        whole = [row["file"] for row in self.table("whole/grains.csv")]
        os.symlink("out", self.path("link"))
        for name in ("./out", "link", self.path("out"), "whole/../out/"):
            self.mskit("grains", "--merge", name, "-o", "out")
            self.assertEqual([row["file"] for row in self.table()], whole, name)
        for name, way in (("new", "../out/"), ("out/new", "../"), (".", "out/")):
            self.mskit("grains", "--merge", "out", "-o", name)
            self.assertEqual([row["file"] for row in self.table(name + "/grains.csv")], [way + file for file in whole])

    def test_more_parts_than_open_files(self):
        self.run_parts(*range(1, 31), of=30)
        self.mskit("grains", "--merge", "out", "-o", "out",
                   preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (20, 20)))
        self.assertEqual(self.known(), self.known("whole/grains.csv"))

    def test_tables_that_are_none(self):
        merge = ("grains", "--merge", "out", "-o", "out")
        self.run_parts(1, 2, of=2)
        text = self.read("out/grains-2-of-2.csv").decode()
        head, rows = text.split("\n", 1)
        for broken, says in ((text.replace("grain,", "Grain,", 1), "not the header"), ("", "no row"),
                             (head[:30], "no row"),
                             (head + "\nx" + rows, "number of a grain"),
                             (head + "\n" + rows.replace(",", ";", 3), "fields"),
                             (head + "\n9" + rows, "number of a grain")):
            self.write("out/grains-2-of-2.csv", broken)
            self.assert_says(self.mskit(*merge, code=1), "out/", says)
            self.assertEqual(self.read("out/grains-2-of-2.csv").decode(), broken)
        self.assert_says(self.mskit("grains", "--merge", "nowhere", "-o", "out", code=1), "nowhere")
        self.assert_refused("grains", "--merge", "stones", "-o", "new", code=1, says=("no table of a part",))
        self.assertFalse(os.path.exists(self.path("out/grains.csv")))

    def test_parts_by_other_flags(self):
        """Where the rows themselves do not show it: flags of grid, masses, formats and filters, and the list."""
        self.run_parts(1, of=2)
        for flag in (("--cells", "13"), ("--density", "2000"), ("--format", "json"), ("--skip-border",),
                     ("--weld", "0")):
            self.mskit("grains", *self.ARGS, *flag, "-o", "other", "--part", "2/2")
            self.assert_says(self.mskit("grains", "--merge", "out", "other", "-o", "out", code=1), "another run")
            self.assert_says(self.mskit("grains", *self.ARGS, "-o", "other", "--part", "2/2", "--resume", code=1),
                             "another run")
            os.unlink(self.path("other/grains-2-of-2.csv"))
        self.mskit("grains", "-j", "1", "--cells", "12", "--max-memory", "1G", *self.ARGS[:-2], "-o", "other",
                   "--part", "2/2")
        self.mskit("grains", "--merge", "out", "other", "-o", "out")

    def test_rows_of_a_manifest_tell_runs_apart(self):
        self.write("a.csv", "shape,cells\nstones/a.obj,\nstones/b.obj,9\n")
        self.write("b.csv", "shape,cells\nstones/a.obj,9\nstones/b.obj,\n")
        runs = [self.grains(name, "-g", "mss", "-n", "2", "--cells", "8", out=name[0])[0]["run"]
                for name in ("a.csv", "b.csv")]
        self.assertNotEqual(*runs)

    def test_parts_that_do_not_fit(self):
        merge = ("grains", "--merge", "out", "-o", "out")
        self.run_parts(1, 2, of=3)
        self.assert_says(self.mskit(*merge, code=1), "2 of 3 parts", "part 3")
        self.run_parts(3, of=3)
        text = self.read("out/grains-3-of-3.csv")
        self.write("out/grains-3-of-3.csv", text[:-20])
        self.assert_says(self.mskit(*merge, code=1), "no row", "--resume")
        self.assertEqual(self.read("out/grains-3-of-3.csv"), text[:-20], "merging touches no part")
        self.write("out/grains-3-of-3.csv", text)
        with open(self.path("out/grains-2-of-3.csv"), "rb+") as table:
            fcntl.flock(table, fcntl.LOCK_EX)
            self.assert_says(self.mskit(*merge, code=1), "grains-2-of-3.csv", "another run is writing it")
        self.write("out/grains-3-of-4.csv", text)
        self.assert_says(self.mskit(*merge, code=1), "different runs")
        os.unlink(self.path("out/grains-3-of-4.csv"))
        self.write("out/grains-3-of-3.csv", self.read("out/grains-1-of-3.csv"))
        self.assert_says(self.mskit(*merge, code=1), "in out/grains-1-of-3.csv, too")
        self.assertNotIn("grains.csv", os.listdir(self.path("out")))

    def test_work_is_dealt_out_evenly(self):
        """Of grains in which the work goes from 1 to 100, no part has 1.2 times the mean of the parts."""
        os.mkdir(self.path("sized"))
        corner = struct.pack("<12f", 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0) + b"\0\0"
        sizes = {}
        for k in range(1, 101):
            self.write(f"sized/{k:03d}.stl", bytes(80) + struct.pack("<I", k * 10) + corner * (k * 10))
            sizes[f"sized/{k:03d}.stl"] = k
        sums = []
        for part in range(1, 8):
            self.mskit("grains", "sized", "-g", "mss", "-n", "1", "-o", "deal", "--part", f"{part}/7", code=1)
            rows = self.table(f"deal/grains-{part}-of-7.csv")
            sums.append(sum(sizes[row["source"]] for row in rows))
        self.assertEqual(sum(sums), 5050)
        self.assertLess(max(sums), 1.2 * 5050 / 7)


class Scan(Grains):
    def test_all_grains_of_a_tomogram(self):
        scan = shared_file("nmc_ct_labels.npy")
        rows = self.grains(scan, "-g", "mss", "-n", "5", "--least-voxels", "200", out="ct")
        self.assertEqual(len(rows), 192)
        self.assertEqual(sum(row["cut_by_border"] == "1" for row in rows), 124)
        self.assertEqual([row["cause"] for row in rows if row["status"] == "failed"], [])
