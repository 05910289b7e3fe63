// Plates as GeoJSON, and the polygons that they become.
#include <cmath>

#include "fuzz.hpp"
#include "geo/io/input/plate_outlines.hpp"
#include "geo/kernels/plates/region_outline.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const geo::fuzz::InputFile file("input.geojson");
  file.write({reinterpret_cast<const char*>(data), size});
  geo::fuzz::expect_value_or_refusal([&] {
    for (const geo::PlateOutline& plate : geo::io::read_plate_outlines(file.path())) {
      const geo::RegionOutline region(plate.rings);
      for (const double latitude_deg : {-90.0, -45.5, 0.0, 89.9, 90.0}) {
        for (const double longitude_deg : {-180.0, -7.25, 0.0, 179.9, 180.0}) {
          static_cast<void>(region.holds({latitude_deg, longitude_deg}));
        }
      }
      geo::fuzz::claim(std::isfinite(plate.rate_deg_myr), "a plate turns at a finite rate");
    }
  });
  return 0;
}
