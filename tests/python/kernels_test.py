"""Kernels on arrays: exact solutions, budgets, shapes."""

import threading
import time
import unittest

import numpy as np
import terrane
from terrane import kernels


def rough(grid, seed=7):
    return np.random.default_rng(seed).normal(200.0, 300.0, grid.shape).astype(np.float32)


class Routing(unittest.TestCase):
    def test_all_water_reaches_an_outlet(self):
        grid = terrane.Grid.sphere(128, 64)
        flow = kernels.route(grid, rough(grid))
        area = kernels.accumulate(grid, flow.filled, flow.receiver)
        ends = flow.receiver.ravel() == np.arange(flow.receiver.size)
        whole = 4.0 * np.pi * grid.radius_m**2
        self.assertAlmostEqual(area.ravel()[ends].sum() / whole, 1.0, 9)
        self.assertTrue((rough(grid).ravel()[ends] < 0.0).all())

    def test_multiple_flow_keeps_the_water_too(self):
        grid = terrane.Grid.plane(60, 40, 100.0, 100.0)
        elevation = rough(grid) + 2000.0
        flow = kernels.route(grid, elevation)
        ends = flow.receiver.ravel() == np.arange(flow.receiver.size)
        for method in ("steepest", "multiple", "d_infinity"):
            rain = np.ones(grid.shape)
            arrived = kernels.accumulate(grid, flow.filled, flow.receiver, rain, method)
            self.assertAlmostEqual(arrived.ravel()[ends].sum() / rain.sum(), 1.0, 9, method)

    def test_a_bowl_fills_to_its_rim(self):
        grid = terrane.Grid.plane(41, 41, 10.0, 10.0)
        y, x = np.mgrid[-20:21, -20:21]
        bowl = np.hypot(x, y).astype(np.float32)
        filled = kernels.fill(grid, bowl)
        np.testing.assert_allclose(filled, np.maximum(bowl, 20.0))

    def test_donors_stand_before_receivers(self):
        grid = terrane.Grid.plane(30, 20, 1.0, 1.0)
        flow = kernels.route(grid, rough(grid))
        place = np.empty(flow.order.size, int)
        place[flow.order] = np.arange(flow.order.size)
        receiver = flow.receiver.ravel()
        drains = receiver != np.arange(receiver.size)
        self.assertTrue((place[drains] < place[receiver[drains]]).all())


class Landscape(unittest.TestCase):
    def test_rivers_in_steady_state_stay(self):
        # A straight river: K A^m S = U with A = x w gives dz = U / (K sqrt(A)) dx.
        n, dx, uplift, erodibility, dt = 400, 100.0, 1e-3, 1e-5, 1e5
        grid = terrane.Grid.plane(n, 3, dx, dx)
        area = np.broadcast_to(dx * dx * np.arange(n, 0, -1.0), grid.shape)
        rise = uplift / (erodibility * np.sqrt(area[0])) * dx
        profile = np.concatenate([[0.0], np.cumsum(rise[1:])])
        elevation = np.broadcast_to(profile, grid.shape).astype(np.float32)
        cells = np.arange(grid.nx * grid.ny, dtype=np.int32).reshape(grid.shape)
        receiver = np.where(cells % n == 0, cells, cells - 1).astype(np.int32)
        lifted = elevation + np.where(cells % n == 0, 0.0, uplift * dt).astype(np.float32)
        after = kernels.incise(grid, lifted, receiver, area, erodibility, dt)
        np.testing.assert_allclose(after, elevation, rtol=2e-6, atol=1e-3)

    def test_a_wave_decays_as_it_should(self):
        grid = terrane.Grid.torus(64, 64, 1000.0, 1000.0)
        wave = np.cos(2.0 * np.pi * np.arange(64) / 64.0)[None, :] * np.ones((64, 1))
        rate = 100.0 * (2.0 * np.pi / 64e3) ** 2
        after = kernels.diffuse(grid, wave, 100.0, 0.5 / rate)
        np.testing.assert_allclose(after, np.exp(-0.5) * wave, atol=4e-3)
        self.assertAlmostEqual(after.sum(), 0.0, 9)


class Bounds(unittest.TestCase):
    def test_shapes_are_checked(self):
        grid = terrane.Grid.plane(30, 20, 1.0, 1.0)
        with self.assertRaisesRegex(terrane.InputError, r"elevation: has shape \(30, 20\): must be \(20, 30\)"):
            kernels.route(grid, np.zeros((30, 20), np.float32))
        with self.assertRaisesRegex(terrane.InputError, "area"):
            kernels.incise(grid, np.zeros(grid.shape), np.zeros(grid.shape, np.int32), np.zeros(3), 1e-6, 1.0)

    def test_receivers_are_checked(self):
        grid = terrane.Grid.plane(4, 3, 1.0, 1.0)
        receiver = np.arange(12, dtype=np.int32).reshape(grid.shape)
        for place, to, words in (((0, 2), 99, "must be the flat index"), ((0, 0), 1, "round in a circle")):
            wrong = receiver.copy()
            wrong[place] = to
            wrong[0, 1] = 0 if to == 1 else wrong[0, 1]
            with self.assertRaisesRegex(terrane.InputError, words):
                kernels.accumulate(grid, np.zeros(grid.shape), wrong)

    def test_arguments_stay_as_they_are(self):
        grid = terrane.Grid.plane(30, 20, 1.0, 1.0)
        elevation = rough(grid)
        before = elevation.copy()
        kernels.fill(grid, elevation)
        kernels.diffuse(grid, elevation, 1.0, 10.0)
        np.testing.assert_array_equal(elevation, before)

    def test_other_threads_work_meanwhile(self):
        grid = terrane.Grid.sphere(2048, 1024)
        elevation = rough(grid)
        ticks, running = [], True

        def tick():
            while running:
                ticks.append(time.monotonic())
                time.sleep(0.001)

        other = threading.Thread(target=tick)
        other.start()
        begin = time.monotonic()
        kernels.route(grid, elevation)
        end = time.monotonic()
        running = False
        other.join()
        self.assertGreater(sum(begin < t < end for t in ticks), 5)


if __name__ == "__main__":
    unittest.main()
