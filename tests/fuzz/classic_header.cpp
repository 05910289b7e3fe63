// Headers of NetCDF's classic format, which are walked before the library opens a file.
#include "fuzz.hpp"
#include "io/netcdf/classic_size.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const geo::fuzz::InputFile file("input.nc");
  file.write({reinterpret_cast<const char*>(data), size});
  geo::fuzz::expect_value_or_refusal([&] { geo::io::check_classic_size(file.path()); });
  return 0;
}
