"""The page about the module: each of its blocks does what it shows, at the size of a test."""

import os
import re
import tempfile
import unittest
import warnings
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

PAGE = Path(__file__).resolve().parents[2] / "docs" / "python.md"
# A planet of 512 x 256 cells takes half a minute.
SMALL = {'grid=(512, 256), to="climate"': 'grid=(64, 32), to="climate"'}


class Page(unittest.TestCase):
    def test_every_block_runs(self):
        blocks = re.findall(r"^```python\n(.*?)^```$", PAGE.read_text(), re.DOTALL | re.MULTILINE)
        self.assertGreaterEqual(len(blocks), 4)
        text = "\n".join(blocks)
        for shown, small in SMALL.items():
            self.assertIn(shown, text)
            text = text.replace(shown, small)
        names = {}
        home = os.getcwd()
        with tempfile.TemporaryDirectory() as scratch, warnings.catch_warnings():
            warnings.simplefilter("ignore")
            os.chdir(scratch)
            try:
                exec(compile(text, str(PAGE), "exec"), names)
            finally:
                os.chdir(home)
        self.assertGreater(names["planet"].score()["land_mean"].value, 0.0)
        fitted = {parameter.name: parameter.fitted for parameter in names["fit"].parameters}
        self.assertGreater(fitted["planet.ocean_fraction"], 0.65)  # from 0.62
        self.assertEqual(names["parameters"]["planet.ocean_fraction"], fitted["planet.ocean_fraction"])
        self.assertLess(float(names["lower"].mean()), float(names["elevation"].mean()))


if __name__ == "__main__":
    unittest.main()
