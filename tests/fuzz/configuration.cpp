// Configuration files.
#include "configuration.hpp"

#include "fuzz.hpp"
#include "geo/io/config/config.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static terrane::Configuration configuration;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  geo::fuzz::expect_value_or_refusal([&] {
    auto& events = configuration.settings.events;
    events.clear();
    // What was accepted is written so that it reads back the same.
    std::vector<geo::Parameter> parameters;
    for (const std::string& name :
         geo::io::apply_toml(text, "input.toml", configuration.all_parameters(), &events)) {
      parameters.push_back(*geo::find_parameter(configuration.all_parameters(), name));
    }
    const std::string written = geo::io::write_config(parameters, "", events);
    try {
      geo::io::apply_toml(written, "written.toml", parameters, &events);
    } catch (const geo::Error& error) {
      geo::fuzz::claim(false, error.what());
    }
    geo::fuzz::claim(geo::io::write_config(parameters, "", events) == written,
                     "a configuration reads back as it was written");
    static_cast<void>(geo::io::first_difference(text, written));
  });
  return 0;
}
