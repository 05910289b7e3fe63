// What follows --set.
#include "configuration.hpp"
#include "fuzz.hpp"
#include "geo/io/config/config.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static terrane::Configuration configuration;
  std::string text(reinterpret_cast<const char*>(data), size);
  text = text.c_str();  // a command line ends its words so
  geo::fuzz::expect_value_or_refusal(
      [&] { geo::io::apply_assignment(text, configuration.all_parameters()); });
  return 0;
}
