// The manifest of a run, as --resume and others read it.
#include "geo/io/run/manifest.hpp"

#include "fuzz.hpp"
#include "geo/io/config/config.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const geo::fuzz::InputFile file("manifest.json"), again("again.json");
  file.write({reinterpret_cast<const char*>(data), size});
  geo::fuzz::expect_value_or_refusal([&] {
    const geo::io::Manifest manifest = geo::io::read_manifest(file.path());
    for (const geo::io::StageRecord& stage : manifest.stages) {
      static_cast<void>(manifest.free_name(stage.name, 1));
      geo::fuzz::expect_value_or_refusal([&] { static_cast<void>(geo::io::netcdf_of(stage)); });
    }
    // What was accepted is written so that it reads back the same.
    geo::io::write_manifest(file.path(), manifest);
    geo::io::write_manifest(again.path(), geo::io::read_manifest(file.path()));
    geo::fuzz::claim(geo::io::read_text(file.path()) == geo::io::read_text(again.path()),
                     "a manifest reads back as it was written");
  });
  return 0;
}
