"""What the tests of the Python module share with those of the program."""
import os
import sys

sys.dont_write_bytecode = True
for folder in ("cli", "view"):
    sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", folder))

import mskit  # noqa: E402
import numpy  # noqa: E402
from support import TIMEOUT, Case, box_obj  # noqa: E402,F401


class PythonCase(Case):
    """In a folder of its own, with the program beside the module."""

    def setUp(self):
        super().setUp()
        self.grain = self.shape("grain", "fineness=10", name="grain.ply")

    def refused(self, kind, words, function, *arguments, **options):
        """Raises this kind of error, with a sentence that has these words; returns the sentence."""
        with self.assertRaises(kind) as caught:
            function(*arguments, **options)
        sentence = str(caught.exception)
        self.assertIn(words, sentence)
        self.assertIsInstance(caught.exception, mskit.Error)
        self.assertNotIn("\n", sentence)
        return sentence


def labelled():
    """Two balls [z, y, x] of labels 3 and 8, apart, and 8 cut by the border."""
    z, y, x = numpy.indices((16, 18, 30))
    labels = numpy.zeros(z.shape, numpy.uint16)
    labels[(x - 8) ** 2 + (y - 8) ** 2 + (z - 8) ** 2 < 40] = 3
    labels[(x - 22) ** 2 + (y - 10) ** 2 + (z - 4) ** 2 < 42] = 8
    return labels
