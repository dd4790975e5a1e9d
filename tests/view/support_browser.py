"""A real browser that looks at pages: Debian's chromium, without a screen. `skip_without` skips where it lacks."""
import os
import shutil
import unittest

LACKING = [name for name in ("chromium", "chromedriver") if not shutil.which(name)]
try:
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
except ImportError:
    LACKING.append("selenium")

skip_without = unittest.skipIf(LACKING, "not installed: " + ", ".join(LACKING))

# Draws once more and looks at the pixels in the same frame: those not white of the left and the right half, and those
# that differ from the call before.
LOOK = """
const done = arguments[0], canvas = document.getElementById('canvas'), gl = canvas.getContext('webgl2');
const w = canvas.width, h = canvas.height, pixels = new Uint8Array(4 * w * h), seen = [0, 0];
document.getElementById('first').dispatchEvent(new Event('input'));
requestAnimationFrame(() => {
  gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  let changed = 0;
  for (let p = 0; p < w * h; p++) {
    const at = 4 * p, is = (k) => window.before && window.before[at + k] !== pixels[at + k];
    seen[p % w < w / 2 ? 0 : 1] += pixels[at] + pixels[at + 1] + pixels[at + 2] < 720;
    changed += is(0) || is(1) || is(2) ? 1 : 0;
  }
  window.before = pixels;
  done({left: 2 * seen[0] / (w * h), right: 2 * seen[1] / (w * h), changed: changed / (w * h)});
});
"""


def start(test, *flags):
    """A browser with its profile in the folder `dir` of the test, behind which it ends."""
    options = webdriver.ChromeOptions()
    options.binary_location = shutil.which("chromium")
    for flag in ("--headless", "--no-sandbox", "--enable-unsafe-swiftshader", "--disable-quic",
                 "--user-data-dir=" + os.path.join(test.dir, "profile")) + flags:
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    browser = webdriver.Chrome(options=options, service=Service(shutil.which("chromedriver")))
    test.addCleanup(browser.quit)
    browser.set_window_size(1100, 800)
    browser.set_script_timeout(60)
    return browser


def errors(browser):
    """Driver's words on speed are none; a breach of the policy is one."""
    return [entry["message"] for entry in browser.get_log("browser") if entry["level"] == "SEVERE"]
