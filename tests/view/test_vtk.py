#!/usr/bin/env python3
"""VTK's own reader takes the spheres as surfaces; skipped without Debian's python3-vtk9."""
import os
import subprocess
import sys
import tempfile
import unittest

MSKIT = os.environ.get("MSKIT", "mskit")
try:
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
    LACKING = ""
except ImportError:
    LACKING = "python3-vtk9 is not installed"

SPHERES = [(0.5, -1, 2, 1.5), (2, 0, 0, 0.25), (7, 8, 9, 3)]


@unittest.skipIf(LACKING, LACKING)
class Vtk(unittest.TestCase):
    def test_spheres(self):
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "c.csv"), "w", encoding="utf-8") as stream:
                stream.writelines(",".join(map(str, s)) + "\n" for s in SPHERES)
            subprocess.run([MSKIT, "convert", "c.csv", "-o", "c.vtp"], cwd=folder, check=True, capture_output=True)
            reader = vtkXMLPolyDataReader()
            reader.SetFileName(os.path.join(folder, "c.vtp"))
            reader.Update()
        data = reader.GetOutput()
        index, radius = (data.GetCellData().GetArray(name) for name in ("index", "radius"))
        self.assertEqual(data.GetNumberOfCells(), 324 * len(SPHERES))
        for cell in range(data.GetNumberOfCells()):
            sphere = SPHERES[int(index.GetValue(cell)) - 1]
            self.assertEqual(radius.GetValue(cell), sphere[3])
            points = [data.GetCell(cell).GetPoints().GetPoint(k) for k in range(3)]
            self.expect_on_sphere(points, sphere)

    def test_the_script_of_the_docs(self):
        """All but its window: the clump coloured by its radii, the shape beside it and as large."""
        with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "docs", "formats.md"),
                  encoding="utf-8") as stream:
            script = stream.read().split("```python\n")[1].split("\nwindow, interactor")[0]
        self.assertIn("clump.vtp", script)
        with tempfile.TemporaryDirectory() as folder:
            for command in (("shape", "ellipsoid", "fineness=8", "-o", "shape.stl"),
                            ("generate", "shape.stl", "-g", "mss", "-n", "5", "--cells", "16", "-o", "clump.vtp",
                             "-o", "clump.csv")):
                subprocess.run([MSKIT, *command], cwd=folder, check=True, capture_output=True)
            said = subprocess.run([sys.executable, "-c", script + "\nprint(renderer.GetActors().GetNumberOfItems(), "
                                   "*clump.GetBounds(), *shape.GetBounds(), *spheres.GetScalarRange())"],
                                  cwd=folder, check=True, capture_output=True, text=True).stdout.split()
            with open(os.path.join(folder, "clump.csv"), encoding="utf-8") as stream:
                radii = [float(line.split(",")[3]) for line in list(stream)[1:]]
        actors, *numbers = (float(word) for word in said)
        clump, shape, scale = numbers[:6], numbers[6:12], numbers[12:]
        self.assertEqual(actors, 2)
        for found, radius in zip(scale, (min(radii), max(radii))):
            self.assertAlmostEqual(found, radius, delta=1e-6)
        self.assertLess(clump[1], shape[0], "they stand side by side")
        for a, b, whole in zip(clump, shape, (None, None, -1, 1, -1, 1)):
            if whole:
                self.assertAlmostEqual(b, whole, delta=1e-6)
                self.assertAlmostEqual(a, whole, delta=0.1)

    def expect_on_sphere(self, points, sphere):
        """Corners on it, wound so that the triangle looks outward."""
        from_centre = [[p[k] - sphere[k] for k in range(3)] for p in points]
        for v in from_centre:
            self.assertAlmostEqual(sum(x * x for x in v) ** 0.5, sphere[3], delta=1e-6)
        (a, b, c) = from_centre
        triple = (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2])
                  + a[2] * (b[0] * c[1] - b[1] * c[0]))
        self.assertGreater(triple, 0)


if __name__ == "__main__":
    sys.dont_write_bytecode = True
    unittest.main()
