// Rotation files of GPlates, and where plates are by them.
#include <cmath>

#include "fuzz.hpp"
#include "geo/io/input/rotation_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  geo::fuzz::expect_value_or_refusal([&] {
    const auto model =
        geo::io::rotations_of({reinterpret_cast<const char*>(data), size}, "input.rot");
    for (const int plate : model.plates()) {
      for (const double time_ma : {0.0, 0.5, 10.0, 1e5}) {
        const auto rotation = model.stage_rad_myr(plate, time_ma + 2.0, time_ma);
        geo::fuzz::claim(!rotation || std::isfinite(geo::length(*rotation)),
                         "a plate turns at a finite rate");
      }
    }
  });
  return 0;
}
