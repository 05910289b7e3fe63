"""Parameters as a tree."""

import pathlib
import unittest

import numpy as np
import terrane


class Tree(unittest.TestCase):
    def setUp(self):
        self.parameters = terrane.Parameters("preview")

    def test_sections_hold_keys(self):
        self.assertEqual(self.parameters.planet.radius_km, self.parameters["planet.radius_km"])
        self.parameters.planet.radius_km = 3390
        self.assertEqual(self.parameters["planet.radius_km"], 3390.0)
        self.assertIn("sphere", dir(self.parameters.plates))
        self.assertIn("samples", list(self.parameters.plates.sphere))

    def test_say_what_they_are(self):
        info = self.parameters.describe("planet.radius_km")
        self.assertEqual(info.units, "km")
        self.assertEqual(info.type, "real")
        self.assertLess(info.minimum, info.maximum)
        self.assertTrue(info.doc and info.source)
        self.assertEqual(self.parameters.planet.describe("radius_km").name, info.name)

    def test_refuse_what_is_out_of_range(self):
        with self.assertRaisesRegex(terrane.ConfigurationError, "planet.radius_km"):
            self.parameters.planet.radius_km = -1
        with self.assertRaises(ValueError):
            self.parameters["run.seed"] = "many"
        with self.assertRaises(terrane.ConfigurationError):
            self.parameters["run.seed"] = object()

    def test_name_what_was_meant(self):
        with self.assertRaisesRegex(AttributeError, "radius_km"):
            self.parameters.planet.radius_kn
        with self.assertRaisesRegex(terrane.ConfigurationError, "radius_km"):
            self.parameters["planet.radius_kn"]
        with self.assertRaisesRegex(AttributeError, "is a section"):
            self.parameters.plates = 3
        with self.assertRaisesRegex(terrane.ConfigurationError, "preview"):
            terrane.Parameters("prevew")

    def test_take_numbers_of_any_kind(self):
        self.parameters["run.seed"] = np.int32(7)
        self.parameters["planet.radius_km"] = np.float32(1000)
        self.parameters["output.vtk"] = True
        self.parameters["dem.file"] = pathlib.Path("a.nc")
        self.parameters["calibration.free"] = ["planet.ocean_fraction", "isostasy.shelf_edge"]
        self.assertEqual((self.parameters["run.seed"], self.parameters["planet.radius_km"]), (7, 1000.0))
        self.assertEqual(self.parameters["dem.file"], "a.nc")
        self.assertEqual(self.parameters["calibration.free"], "planet.ocean_fraction,isostasy.shelf_edge")

    def test_go_through_text_and_back(self):
        self.parameters.planet.radius_km = 1234.5678901234567
        other = terrane.Parameters()
        other.apply_toml(self.parameters.to_toml())
        self.assertEqual(other.to_toml(), self.parameters.to_toml())
        self.assertEqual(other.planet.radius_km, 1234.5678901234567)

    def test_are_copied_apart(self):
        copy = self.parameters.copy()
        copy["run.seed"] = 99
        self.assertNotEqual(self.parameters["run.seed"], 99)

    def test_are_found_by_words(self):
        found = [info.name for info in self.parameters.search("lake")]
        self.assertTrue(found)
        self.assertLess(len(found), len(self.parameters))

    def test_stay_as_they_are_in_a_run(self):
        before = self.parameters.to_toml()
        terrane.run(parameters=self.parameters, grid="32x16", to="plates")
        self.assertEqual(self.parameters.to_toml(), before)


if __name__ == "__main__":
    unittest.main()
