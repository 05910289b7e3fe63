"""Runs in memory and in folders, read back, scored, refined and fitted."""

import gc
import json
import os
import signal
import subprocess
import tempfile
import threading
import time
import unittest
import warnings
from pathlib import Path

import numpy as np
import terrane
import xarray as xr

SMALL = dict(preset="preview", grid=(64, 32), seed=5)


class Memory(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.planet = terrane.run(**SMALL, to="biomes")

    def test_has_every_stage(self):
        self.assertEqual(list(self.planet),
                         ["plates", "isostasy", "erosion", "climate", "hydrology", "biomes"])
        self.assertEqual(self.planet["elevation"].shape, (32, 64))
        self.assertIn("rock_closing_error", " ".join(self.planet.stages["erosion"].budget))

    def test_datasets_share_the_memory(self):
        stage = self.planet.stages["climate"]
        first = stage.dataset["temperature"].values
        again = stage._core.arrays["temperature"]
        self.assertTrue(np.shares_memory(first, again))
        self.assertFalse(first.flags.writeable)

    def test_values_outlive_the_planet(self):
        temperature = terrane.run(**SMALL, to="climate")["temperature"]
        copy = temperature.values.copy()
        gc.collect()
        terrane.run(**SMALL, to="climate")
        np.testing.assert_array_equal(temperature.values, copy)

    def test_runs_again_to_the_same_bits(self):
        again = terrane.run(**SMALL, to="biomes", threads=1)
        for name, values in self.planet.dataset.items():
            np.testing.assert_array_equal(values, again.dataset[name], name)

    def test_an_elevation_takes_the_place_of_stages(self):
        # An elevation says nothing of ice.
        planet = terrane.run(**SMALL, to="climate", parameters={"erosion.ice.model": "none"})
        elevation = planet.stages["erosion"]["elevation"]
        climate = terrane.run("preview", elevation=elevation, from_stage="climate", to="climate")
        np.testing.assert_array_equal(climate["temperature"], planet.stages["climate"]["temperature"])
        alone = terrane.kernels.climate(elevation.values, "preview")
        np.testing.assert_array_equal(alone["precipitation"], climate["precipitation"])
        with self.assertRaisesRegex(terrane.InputError, "southwards"):
            terrane.run("preview", elevation=elevation[::-1], from_stage="climate")

    def test_an_elevation_is_laid_out_with_the_turn(self):
        elevation = self.planet.stages["erosion"]["elevation"]
        only = dict(from_stage="climate", to="climate", elevation=elevation)
        grid = np.asarray(elevation)
        turned = terrane.run("preview", parameters={"run.turn": "-90,0,0"}, **only)["temperature"]
        plain = terrane.run("preview", **only)["temperature"]
        self.assertGreater(float(abs(turned - plain).mean()), 1.0)
        # The same file, read by the run itself, is laid out the same.
        with tempfile.TemporaryDirectory() as scratch:
            file = Path(scratch) / "relief.nc"
            elevation.to_dataset(name="elevation").to_netcdf(file)
            read = terrane.run("preview", dem=file, to="climate", from_stage="climate",
                               grid=grid.shape[::-1], parameters={"run.turn": "-90,0,0"})["temperature"]
        np.testing.assert_allclose(turned, read, rtol=1e-5, atol=1e-3)

    def test_an_island_is_cut_from_it(self):
        island = terrane.island(self.planet, center=(10.0, 20.0), size=(64, 32), cell_m=4000.0)
        self.assertEqual(island["elevation"].dims, ("y", "x"))
        self.assertAlmostEqual(float(island.dataset["lat"].mean()), 10.0, 1)


class Files(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = Path(cls.scratch.name) / "run"
        cls.opened = terrane.run(**SMALL, to="biomes", folder=cls.folder)
        cls.planet = terrane.run(**SMALL, to="biomes")

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def test_hold_the_same_as_the_memory(self):
        for name in self.planet:
            with xr.open_dataset(next(self.folder.glob(f"0?-{name}.nc")), mask_and_scale=False) as file:
                made = self.planet.stages[name].dataset
                self.assertEqual(set(made.data_vars), set(file.data_vars) - {"terrane_config", "lat_bnds", "lon_bnds",
                                                                            "crs", "cell_area"})
                for field in made.data_vars:
                    np.testing.assert_array_equal(made[field], file[field], field)
                    self.assertEqual(made[field].dtype, file[field].dtype, field)

    def test_have_the_same_attributes(self):
        for name in self.planet:
            with xr.open_dataset(next(self.folder.glob(f"0?-{name}.nc"))) as file:
                made = self.planet.stages[name].dataset
                for field in made.data_vars:
                    wanted, given = dict(file[field].attrs), dict(made[field].attrs)
                    for key in ("cell_measures", "grid_mapping"):  # xarray may move them aside
                        wanted.setdefault(key, given[key])
                    self.assertEqual(set(wanted), set(given), field)
                    for key, value in wanted.items():
                        np.testing.assert_array_equal(given[key], value, f"{field}:{key}")
                for coordinate in ("lat", "lon"):
                    np.testing.assert_array_equal(made[coordinate], file[coordinate])
                np.testing.assert_allclose(made["cell_area"], file["cell_area"], rtol=1e-14)

    def test_are_opened_again(self):
        again = terrane.open_run(self.folder)
        np.testing.assert_array_equal(again["elevation"], self.planet["elevation"])
        self.assertEqual(again.parameters["run.seed"], 5)
        self.assertEqual(list(again), list(self.planet))

    def test_are_scored_like_the_memory(self):
        card, memory = terrane.score(self.folder), self.planet.score()
        self.assertEqual([f.value for f in card.figures], [f.value for f in memory.figures])
        self.assertEqual(card.within, sum(f.is_within for f in card.figures))
        program = os.environ.get("TERRANE")
        if program:
            printed = subprocess.run([program, "score", "--json", self.folder], check=True, capture_output=True)
            self.assertEqual(json.loads(printed.stdout)["totals"]["within"], card.within)

    def test_are_not_replaced_unasked(self):
        with self.assertRaisesRegex(terrane.ConfigurationError, "already holds a run"):
            terrane.run(**SMALL, folder=self.folder)

    def test_that_are_missing_are_an_os_error(self):
        with self.assertRaises(OSError):
            terrane.open_run(self.folder / "nothing")
        with self.assertRaises(terrane.FileError):
            terrane.score(self.folder / "nothing.nc")


class Watching(unittest.TestCase):
    def test_progress_is_told(self):
        told = []
        terrane.run(**SMALL, to="isostasy", progress=lambda stage, fraction: told.append((stage, fraction)))
        self.assertEqual(told[0], ("plates", 0.0))
        self.assertEqual(told[-1], ("isostasy", 1.0))

    def test_an_error_of_the_watcher_ends_the_run(self):
        def watch(stage, fraction):
            if stage == "erosion":
                raise RuntimeError("enough")

        with self.assertRaisesRegex(RuntimeError, "enough"):
            terrane.run(**SMALL, progress=watch)

    def test_an_interrupt_ends_the_run(self):
        threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
        begin = time.monotonic()
        with self.assertRaises(KeyboardInterrupt):
            for _ in range(100):
                terrane.run("preview", seed=5)
        self.assertLess(time.monotonic() - begin, 30.0)

    def test_other_threads_run_meanwhile(self):
        count, running = [0], True

        def work():
            while running:
                count[0] += 1
                time.sleep(0.001)

        other = threading.Thread(target=work)
        other.start()
        terrane.run("preview", grid=(256, 128), to="isostasy")
        running = False
        other.join()
        self.assertGreater(count[0], 5)


class Fit(unittest.TestCase):
    def test_a_calibration_comes_nearer(self):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            found = terrane.calibrate("earth", parameters={
                "calibration.free": ["planet.ocean_fraction"], "calibration.seeds": "1",
                "calibration.held_out": "", "calibration.grid": "64x32", "calibration.held_out_grid": "64x32",
                "calibration.iterations": 2, "calibration.profiles": False, "planet.ocean_fraction": 0.6})
        self.assertEqual([p.name for p in found.parameters], ["planet.ocean_fraction"])
        self.assertLess(found.cost_after, found.cost_before)


if __name__ == "__main__":
    unittest.main()
