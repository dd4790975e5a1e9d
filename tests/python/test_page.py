"""The page that shows a clump: what stands in it, and what a browser makes of it."""
import base64
import html
import json
import re
import unittest

import mskit
import numpy
from mskit import _view
from support_python import PythonCase, labelled
import support_browser as chromium  # found by support_python


def scene_of(page):
    return json.loads(re.search(r'id="scenes">(.*?)</script>', page, re.S)[1])[0]


def volume_of(vertices, faces):
    """By the divergence theorem."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return numpy.einsum("ij,ij->i", a, numpy.cross(b, c)).sum() / 6


class Page(PythonCase):
    def clump(self):
        return mskit.generate(self.path(self.grain), "mss", spheres=7, cells=20)

    def test_spheres_and_shape_stand_in_it(self):
        clump = self.clump()
        scene = scene_of(_view.page(clump, "a clump", with_scores=False))
        spheres = numpy.frombuffer(base64.b64decode(scene["spheres"]), "<f4").reshape(-1, 4)
        centres = spheres[:, :3] * scene["scale"] + scene["centre"]
        self.assertLess(abs(centres - clump.centres).max(), 1e-6)
        self.assertLess(abs(spheres[:, 3] * scene["scale"] - clump.radii).max(), 1e-6)
        mesh = scene["mesh"]
        part = numpy.frombuffer(base64.b64decode(mesh["corners"]), "<u2").reshape(-1, 3) / 65535
        corners = mesh["low"] + part * numpy.subtract(mesh["high"], mesh["low"])
        faces = numpy.frombuffer(base64.b64decode(mesh["faces"]), "<u2").reshape(-1, 3)
        self.assertAlmostEqual(volume_of(corners * scene["scale"], faces) / clump.shape.volume, 1, delta=1e-4)
        self.assertLessEqual(numpy.linalg.norm(corners, axis=1).max(), 1 + 1e-4)

    def test_text_from_outside_is_escaped(self):
        clump = self.clump()
        clump.shape.name = '</script><script>alert("x")</script>'
        clump.write(self.path("<b>&.html"))
        text = self.read("<b>&.html").decode()
        self.assertNotIn("<b>", text)
        self.assertEqual(text.count("<script"), 2)
        self.assertEqual(scene_of(text)["name"], clump.shape.name)
        self.assertEqual(self.files(), sorted([self.grain, "<b>&.html"]))

    def test_too_far(self):
        """As the program refuses it, and no page that shows nothing."""
        for far, radius in ((1e200, 1), (1e308, 1e308)):
            apart = mskit.Clump([(0, 0, 0), (far, 0, 0)], [1, radius])
            self.refused(mskit.ArgumentError, "reaches too far; choose another unit", apart.write, self.path("a.html"))
        self.assertEqual(self.files(), [self.grain])

    def test_surface_of_voxels(self):
        shape = mskit.volume(labelled(), label=3, spacing=0.5, origin=(5, 6, 7))
        vertices, faces = shape.surface()
        self.assertAlmostEqual(volume_of(vertices, faces), shape.volume, delta=1e-9)
        self.assertLess(abs(vertices.mean(axis=0) - shape.centroid).max(), 0.1)

    def test_few_enough_triangles(self):
        ball = mskit.body("ball", fineness=40)
        vertices, faces = _view.decimate(ball.vertices, ball.faces, 3000)
        self.assertTrue(1000 < len(faces) <= 3000)
        self.assertAlmostEqual(volume_of(vertices, faces) / ball.volume, 1, delta=0.02)
        self.assertIs(_view.decimate(vertices, faces, 3000)[1], faces)

    @chromium.skip_without
    def test_in_a_browser(self):
        """As a page, and as what Jupyter takes, within another page: both draw, and neither has an error."""
        clump = mskit.correct(self.clump(), density=2650)
        clump.write(self.path("page.html"))
        self.write("frame.html", "<!doctype html><meta charset='utf-8'><body>" + clump._repr_html_())
        browser = chromium.start(self)
        for name in ("page", "frame"):
            browser.get("file://" + self.path(name + ".html"))
            if name == "frame":
                browser.switch_to.frame(0)
            seen = browser.execute_async_script(chromium.LOOK)
            self.assertGreater(min(seen["left"], seen["right"]), 0.05, name)
            self.assertLess(abs(seen["left"] / seen["right"] - 1), 0.2, "the clump is about as large as the shape")
            said = browser.execute_script("return document.getElementById('count').textContent")
            self.assertTrue(said.startswith("7 spheres"), said)
            for colour in ("radius", "mass", "index"):
                browser.execute_script("const e = document.getElementById('colour'); e.value = arguments[0];"
                                       "e.dispatchEvent(new Event('change'))", colour)
            self.assertEqual(chromium.errors(browser), [])

    def test_measures_stand_beside_it(self):
        self.clump().write(self.path("page.html"))
        text = html.unescape(self.read("page.html").decode())
        for measure in ("dice", "coverage", "gap_max"):
            self.assertIn(mskit.measures[measure].help, text)


if __name__ == "__main__":
    unittest.main()
