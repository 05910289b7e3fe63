#include "globe_files.hpp"

#include <vector>

#include "geo/core/field.hpp"
#include "geo/io/netcdf/stage_file.hpp"
#include "geo/io/run/recorded_file.hpp"

namespace geo::io {
namespace {

/// Heights in a snapshot, or nothing.
std::shared_ptr<const Values> heights_of(const Snapshot& snapshot) {
  for (const FieldSpec* wanted : {static_cast<const FieldSpec*>(&field::elevation),
                                  static_cast<const FieldSpec*>(&field::crust_elevation)}) {
    for (const auto& [spec, values] : snapshot.fields) {
      if (spec == wanted) return values;
    }
  }
  return nullptr;
}

}  // namespace

bool write_globe_files(const RunFolder& folder, Manifest& manifest, double times, int compression) {
  std::vector<std::filesystem::path> files;
  std::shared_ptr<const Values> heights;
  for (StageRecord& record : manifest.stages) {
    if (record.own_grid) continue;
    const auto netcdf = folder.path() / netcdf_of(record);
    const Snapshot snapshot =
        read_recorded(folder.path(), record, [](const FieldSpec&) { return true; });
    if (snapshot.grid->topology() != Topology::sphere) return false;
    if (auto newer = heights_of(snapshot)) heights = std::move(newer);
    std::span<const float> elevation_m;
    if (heights) elevation_m = std::get<std::vector<float>>(*heights);
    const auto vtp = std::filesystem::path(netcdf).replace_extension(".vtp");
    write_globe(vtp, snapshot, read_provenance(netcdf), elevation_m, times, compression);
    files.push_back(vtp);
    record.list(folder.path(), vtp.filename().string());
  }
  write_pvd(folder.globes(), files);
  return true;
}

}  // namespace geo::io
