// Makes the plates of a small planet in a folder, and reads them back.
#include <cstdio>
#include <variant>
#include <vector>

#include "geo/core/planet.hpp"
#include "geo/io/config/config.hpp"
#include "geo/io/config/run_settings.hpp"
#include "geo/io/netcdf/stage_file.hpp"
#include "geo/io/run/manifest.hpp"
#include "geo/io/run/run_session.hpp"
#include "geo/stages/stages.hpp"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  geo::io::RunSettings settings;
  geo::Planet planet;
  geo::Pipeline pipeline = geo::make_pipeline();
  std::vector<geo::Parameter> parameters;
  for (auto rows : {settings.parameters(), planet.parameters(), pipeline.parameters()}) {
    parameters.insert(parameters.end(), rows.begin(), rows.end());
  }
  geo::io::apply_assignment("run.grid=64x32", parameters);
  settings.maps = false;
  std::vector<int> numbers;
  for (const geo::StageEntry& stage : geo::stage_table()) numbers.push_back(stage.number);

  geo::io::RunSession run({pipeline, settings, planet, parameters}, numbers,
                          {.folder = argv[1], .to = "plates"});
  run.prepare();
  run.execute({});

  const geo::io::RunFolder folder(argv[1]);
  const geo::io::Manifest manifest = geo::io::read_manifest(folder.manifest());
  const geo::io::Snapshot plates = geo::io::read_netcdf(folder.stage_file(1, "plates", ".nc"));
  for (const auto& [field, values] : plates.fields) {
    if (field->name != geo::field::continental_fraction.name) continue;
    double sum = 0.0;
    for (const float share : std::get<std::vector<float>>(*values)) sum += share;
    std::printf("%zu stage, %.2f of its cells continental\n", manifest.stages.size(),
                sum / plates.grid->size());
    return sum > 0.0 && manifest.complete ? 0 : 1;
  }
  return 1;
}
