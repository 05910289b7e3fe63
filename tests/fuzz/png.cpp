// Grey PNG and the JSON that says what it means: a JSON behind a line of its own, "json", and
// before it the bytes of a picture.
#include <fstream>

#include "read_images.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const geo::fuzz::InputFile file("input.png");
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  constexpr std::string_view kMark = "\njson\n";
  const std::size_t at = bytes.rfind(kMark);
  file.write(bytes.substr(0, at));
  const auto beside = std::filesystem::path(file.path()).replace_extension(".json");
  std::filesystem::remove(beside);
  if (at != std::string_view::npos) {
    const std::string_view text = bytes.substr(at + kMark.size());
    std::ofstream(beside, std::ios::binary) << text;
  }
  geo::fuzz::read_image(file.path());
  geo::fuzz::read_image(file.path(), {.range = "-11000,9000", .window = "-10,40,20,60"});
  return 0;
}
