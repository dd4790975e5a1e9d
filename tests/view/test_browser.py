#!/usr/bin/env python3
"""The pages in a real browser: Debian's chromium, without a screen; skipped where it or its driver is not installed.

    MSKIT=build/eval/mskit /usr/bin/python3 tests/view/test_browser.py [-v] [-k PATTERN]
"""
import csv
import math
import os
import struct
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
import support_browser as chromium  # noqa: E402

if not chromium.LACKING:
    from selenium.webdriver.common.action_chains import ActionChains

MSKIT = os.environ.get("MSKIT", "mskit")

# In the frame in which they are drawn: pixels of each of three spheres in the colours of the index, of which the first
# has the least green, the second the least red, the third the least blue; and the size of the picture.
COUNT = """
const done = arguments[0], canvas = document.getElementById('canvas'), gl = canvas.getContext('webgl2');
const w = canvas.width, h = canvas.height, pixels = new Uint8Array(4 * w * h), seen = [0, 0, 0];
document.getElementById('first').dispatchEvent(new Event('input'));
requestAnimationFrame(() => {
  gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  for (let at = 0; at < 4 * w * h; at += 4) {
    const [r, g, b] = pixels.subarray(at, at + 3), least = Math.min(r, g, b);
    if (r + g + b < 765) {
      seen[least === g ? 0 : least === r ? 1 : 2]++;
    }
  }
  done([w, h, seen]);
});
"""


def count_pixels(spheres, w, h):
    """How many pixels of the first view show each sphere, by looking at each pixel."""
    turn, pixel = [[1, 0, 0], [0, 0, 1], [0, -1, 0]], 0.475 * min(w, h)
    for a, b, angle in ((2, 0, -0.5), (1, 2, 0.35)):
        c, s, u, v = math.cos(angle), math.sin(angle), turn[a], turn[b]
        turn[a], turn[b] = [c * x - s * y for x, y in zip(u, v)], [s * x + c * y for x, y in zip(u, v)]
    lo, hi = ([pick(p[k] + sign * p[3] for p in spheres) for k in range(3)] for pick, sign in ((min, -1), (max, 1)))
    centre = [(a + b) / 2 for a, b in zip(lo, hi)]
    scale = max(math.dist(p[:3], centre) + p[3] for p in spheres)
    placed = [[sum(row[k] * (p[k] - centre[k]) for k in range(3)) / scale for row in turn] + [p[3] / scale]
              for p in spheres]
    seen = [0] * len(spheres)
    for j in range(h):
        for i in range(w):
            x, y = (i + 0.5 - w / 2) / pixel, (j + 0.5 - h / 2) / pixel
            squares = [r * r - (x - a) ** 2 - (y - b) ** 2 for a, b, _, r in placed]
            fronts = [(p[2] + math.sqrt(q), k) for k, (p, q) in enumerate(zip(placed, squares)) if q > 0]
            if fronts:
                seen[max(fronts)[1]] += 1
    return seen


@chromium.skip_without
class Browser(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="mskit-view-")
        self.addCleanup(folder.cleanup)
        self.dir = folder.name

    def mskit(self, *args):
        return subprocess.run([MSKIT] + [str(a) for a in args], cwd=self.dir, check=True, capture_output=True,
                              text=True)

    def open(self, name, *flags):
        self.browser = chromium.start(self, *flags)
        self.browser.get("file://" + os.path.join(self.dir, name))

    def look(self):
        return self.browser.execute_async_script(chromium.LOOK)

    def text(self, name):
        return self.browser.execute_script(f"return document.getElementById('{name}').textContent")

    def choose(self, name, value, event="change"):
        self.browser.execute_script("const e = document.getElementById(arguments[0]); e.value = arguments[1];"
                                    "e.dispatchEvent(new Event(arguments[2]))", name, value, event)

    def expect_no_error(self):
        self.assertEqual(chromium.errors(self.browser), [])

    def test_clump_and_shape(self):
        self.mskit("shape", "grain", "-o", "grain.ply")
        self.mskit("generate", "grain.ply", "-g", "mss", "-n", 20, "--cells", 30, "--correct", "--density", 2650,
                   "-o", "c.html", "-o", "c.csv")
        with open(os.path.join(self.dir, "c.csv"), newline="", encoding="utf-8") as stream:
            spheres = len(list(csv.reader(stream))) - 1
        self.open("c.html")
        both = self.look()
        self.assertGreater(min(both["left"], both["right"]), 0.05, "spheres on the left, the shape on the right")
        self.assertLess(abs(both["left"] / both["right"] - 1), 0.2, "the clump is about as large as the shape")
        self.assertEqual(self.look()["changed"], 0, "a picture that nobody touches stays")
        self.assertTrue(self.text("count").startswith(f"{spheres} spheres, "), self.text("count"))
        self.assertIn("mss", self.text("command"))
        self.expect_drag()
        for value in ("radius", "mass", "protrusion", "surface", "index"):
            self.choose("colour", value)
            self.assertGreater(self.look()["changed"], 0.02, value)
        for value in ("over", "clump", "shape"):
            self.choose("layout", value)
            seen = self.look()
            self.assertGreater(seen["changed"], 0.01, value)
            self.assertGreater(seen["left"] + seen["right"], 0.2, value)
        self.choose("layout", "clump")
        whole = self.look()
        self.choose("first", 3, "input")
        part = self.look()
        self.assertEqual(self.text("count").split(",")[0], f"3 of {spheres} spheres")
        self.assertGreater(whole["left"] + whole["right"], 1.05 * (part["left"] + part["right"]))
        self.expect_no_error()

    def expect_drag(self):
        canvas = self.browser.find_element("id", "canvas")
        ActionChains(self.browser).drag_and_drop_by_offset(canvas, 90, 40).perform()
        self.assertGreater(self.look()["changed"], 0.03, "a drag turns them")
        ActionChains(self.browser).double_click(canvas).perform()
        self.look()

    def test_clump_alone(self):
        with open(os.path.join(self.dir, "two.csv"), "w", encoding="utf-8") as stream:
            stream.writelines(f"{0.02 * k},0,0,1\n" for k in range(150))
        self.mskit("convert", "two.csv", "-o", "two.html")
        self.open("two.html")
        seen = self.look()
        self.assertGreater(min(seen["left"], seen["right"]), 0.2, "the clump fills the picture")
        self.assertEqual(self.text("count"), "150 spheres", "more than a slider has by itself")
        self.expect_no_error()

    def test_each_sphere_is_seen_as_far_as_it_is(self):
        """What others hide of a sphere is not drawn, and nothing else is missing."""
        spheres = [(0, 0, 0, 1), (0.8, 0.3, 0.2, 0.8), (0.3, -0.9, 0.6, 0.7)]
        with open(os.path.join(self.dir, "c.csv"), "w", encoding="utf-8") as stream:
            stream.writelines("%g,%g,%g,%g\n" % sphere for sphere in spheres)
        self.mskit("convert", "c.csv", "-o", "c.html")
        self.open("c.html")
        w, h, seen = self.browser.execute_async_script(COUNT)
        for one, truth in zip(seen, count_pixels(spheres, w, h)):
            self.assertGreater(truth, 5000)
            self.assertLess(abs(one - truth), 0.01 * truth, (seen, truth))
        self.expect_no_error()

    def test_volume(self):
        """A ball of voxels: seen as large as its spheres."""
        n, r = 24, 9.3
        voxels = bytes((i - 12) ** 2 + (j - 12) ** 2 + (k - 12) ** 2 < r * r
                       for k in range(n) for j in range(n) for i in range(n))
        head = f"{{'descr': '|u1', 'fortran_order': False, 'shape': ({n}, {n}, {n}), }}\n".encode()
        with open(os.path.join(self.dir, "v.npy"), "wb") as stream:
            stream.write(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head + voxels)
        self.mskit("generate", "v.npy", "-n", 1, "-o", "v.html")
        self.open("v.html")
        seen = self.look()
        self.assertGreater(seen["left"], 0.2)
        self.assertLess(abs(seen["left"] / seen["right"] - 1), 0.1)
        self.expect_no_error()

    def test_report(self):
        self.mskit("shape", "grain", "-o", "grain.ply")
        self.mskit("shape", "tablet", "-o", "tablet.stl")
        self.mskit("compare", "grain.ply", "tablet.stl", "-g", "mss", "-g", "euclid", "-n", "3,30", "--cells", 20,
                   "--charts", "charts", "--report", "r.html")
        self.open("r.html")
        rows = self.browser.find_elements("css selector", "#rows tbody tr")
        self.assertEqual(len(rows), 8)
        self.assertEqual(len(self.browser.find_elements("css selector", "#tiles button")), 8)
        self.assertEqual(len({tile.screenshot_as_base64 for tile in
                              self.browser.find_elements("css selector", "#tiles canvas")}), 8, "each its own picture")
        self.look()
        rows[6].click()
        self.assertGreater(self.look()["changed"], 0.05, "a click on a row shows its clump")
        words = [cell.text for cell in rows[6].find_elements("css selector", "td")]
        self.assertIn(words[0], self.text("name"))
        self.assertTrue(self.text("count").startswith(words[4] + " spheres"), (words, self.text("count")))
        self.expect_sorted()
        self.browser.find_element("id", "filter").send_keys("tablet euclid")
        shown = [row for row in self.browser.find_elements("css selector", "#rows tbody tr") if row.is_displayed()]
        self.assertEqual(len(shown), 2)
        self.assertIn("--charts charts", self.text("command"))
        charts = self.browser.execute_script("return [...document.images].map(i => i.naturalWidth)")
        self.assertGreaterEqual(len(charts), 8)
        self.assertGreater(min(charts), 100, "each chart is drawn")
        self.expect_no_error()

    def test_report_of_grains(self):
        """Rows in another order than clumps: the second grain has none."""
        for name, words in (("a.stl", "ball"), ("c.stl", "cube")):
            self.mskit("shape", words, "-o", name)
        with open(os.path.join(self.dir, "b.stl"), "w", encoding="utf-8") as stream:
            stream.write("nothing")
        self.mskit("grains", "a.stl", "b.stl", "c.stl", "-g", "mss", "-n", 2, "--cells", 10, "-o", "out",
                   "--report", "r.html")
        self.open("r.html")
        rows = self.browser.find_elements("css selector", "#rows tbody tr")
        self.assertEqual([row.get_attribute("data-scene") for row in rows], ["0", None, "1"])
        self.assertEqual(len(self.browser.find_elements("css selector", "#tiles button")), 2)
        self.look()
        rows[2].click()
        self.assertGreater(self.look()["changed"], 0.05)
        self.assertTrue(self.text("name").startswith("grain 3, c, mss"), self.text("name"))
        self.expect_no_error()

    def test_report_without_clumps(self):
        """Rows of a run that kept none: the table sorts even so."""
        self.mskit("shape", "ball", "-o", "ball.stl")
        run = ("compare", "ball.stl", "-g", "mss", "-n", "1,2", "--cells", 8)
        self.mskit(*run)
        self.mskit(*run, "--resume", "--charts", "charts", "--report", "r.html")
        self.open("r.html")
        self.assertIn("none to show", self.browser.find_element("id", "message").text)
        self.expect_sorted()
        self.expect_no_error()

    def expect_sorted(self):
        heading = self.browser.find_elements("css selector", "#rows th")[5]
        self.assertEqual(heading.text, "dice")
        for sign in (1, -1):
            heading.click()
            values = [sign * float(row.find_elements("css selector", "td")[5].text)
                      for row in self.browser.find_elements("css selector", "#rows tbody tr")]
            self.assertEqual(values, sorted(values))

    def test_without_webgl(self):
        self.mskit("shape", "ball", "-o", "ball.stl")
        self.mskit("generate", "ball.stl", "-n", 1, "--cells", 10, "-o", "c.html")
        self.open("c.html", "--disable-3d-apis")
        message = self.browser.find_element("id", "message")
        self.assertTrue(message.is_displayed())
        self.assertIn("no WebGL 2", message.text)
        self.assertFalse(self.browser.find_element("id", "canvas").is_displayed())
        self.assertTrue(self.browser.find_element("id", "measures").is_displayed())

    def test_names_are_text(self):
        """The path of the shape ends a script, opens a comment and sets an attribute, if it is let."""
        folder = "a<"
        name = "script><!--<script><b id=bad>\"' onload=x&lt;.stl"
        os.mkdir(os.path.join(self.dir, folder))
        self.mskit("shape", "ball", "-o", f"{folder}/{name}")
        self.mskit("generate", f"{folder}/{name}", "-n", 2, "--cells", 10, "-o", "<b id=bad>.html")
        self.open("<b id=bad>.html".replace("<", "%3C").replace(">", "%3E"))
        self.assertEqual(self.browser.find_elements("id", "bad"), [])
        self.assertEqual(self.text("name"), f"{folder}/{name}")
        self.assertEqual(self.browser.title, "<b id=bad>.html")
        self.assertGreater(self.look()["right"], 0.05)
        self.expect_no_error()


if __name__ == "__main__":
    unittest.main()
