// GeoTIFF: bytes as they come, through libtiff and libgeotiff.
#include "io/input/geotiff.hpp"

#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const geo::fuzz::InputFile file("input.tif");
  file.write({reinterpret_cast<const char*>(data), size});
  geo::fuzz::expect_value_or_refusal([&] {
    const geo::io::Dem dem = geo::io::read_geotiff(file.path(), {});
    geo::fuzz::claim(dem.elevation_m.size() == static_cast<std::size_t>(dem.grid.size()),
                     "a DEM has a value for each cell");
  });
  return 0;
}
