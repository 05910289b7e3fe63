// Tables of comma-separated values: a hypsography, and a target of a calibration.
#include <cmath>

#include "calibration/target.hpp"
#include "fuzz.hpp"
#include "geo/io/input/hypsography.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const geo::fuzz::InputFile file("input.csv");
  static const geo::Grid grid = geo::Grid::sphere(8, 4);
  file.write({reinterpret_cast<const char*>(data), size});
  geo::fuzz::expect_value_or_refusal([&] {
    const auto curve = geo::io::with_ocean_share(geo::io::read_hypsography(file.path()), 0.71);
    for (const double elevation_m : curve.elevation_m) {
      geo::fuzz::claim(std::isfinite(elevation_m), "a hypsography is of finite elevations");
    }
  });
  geo::fuzz::expect_value_or_refusal([&] {
    const auto target = geo::calibration::read_target(file.path(), {}, grid, {});
    for (const double elevation_m : target.elevation_m) {
      geo::fuzz::claim(std::isfinite(elevation_m), "a target is of finite elevations");
    }
  });
  return 0;
}
