// ESRI ASCII grids: bytes as they come.
#include "read_images.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const geo::fuzz::InputFile file("input.asc");
  file.write({reinterpret_cast<const char*>(data), size});
  geo::fuzz::read_image(file.path());
  return 0;
}
