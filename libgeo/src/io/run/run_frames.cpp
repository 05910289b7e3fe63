#include "run_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "geo/core/error.hpp"
#include "geo/core/stage.hpp"
#include "geo/io/maps/maps.hpp"
#include "geo/io/netcdf/stage_file.hpp"
#include "geo/io/run/manifest.hpp"
#include "geo/io/run/run_pictures.hpp"

namespace fs = std::filesystem;

namespace geo::io {
namespace {

template <class Wanted>
State read_frame(const fs::path& file, Wanted&& wanted) {
  const Snapshot snapshot = read_netcdf(file, wanted);
  State state(snapshot.grid);
  for (const auto& [spec, values] : snapshot.fields) state.share(*spec, values);
  return state;
}

/// A file goes on in another folder, under another name.
fs::path moved_to(const fs::path& file, const fs::path& folder, const std::string& name) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error) fs::rename(file, folder / name, error);
  if (error) throw IoError(fmt::format("{}: {}", (folder / name).string(), error.message()));
  return folder / name;
}

/// Frames without a landscape know the elevation of their crust alone.
void take_crust_for_surface(State& frame) {
  if (frame.has(field::elevation)) return;
  const auto crust_m = frame.read(field::crust_elevation);
  frame.set(field::elevation, std::vector<float>(crust_m.begin(), crust_m.end()));
}

}  // namespace

std::vector<fs::path> frame_files(const RunFolder& folder, const Manifest& manifest) {
  std::vector<fs::path> files;
  for (const StageRecord& record : manifest.stages) {
    for (const std::string& file : record.files) {
      if (!file.starts_with("frames/") || !file.ends_with(".nc")) continue;
      if (fs::exists(folder.path() / file)) files.push_back(folder.path() / file);
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string time_in_name(const fs::path& frame) {
  const std::string name = frame.stem().string();
  return name.substr(name.find_last_of('-') + 1);
}

std::vector<GlobeFrame> globe_frames(const RunFolder& folder, const Manifest& manifest) {
  constexpr std::size_t kMost = 12;
  const std::vector<fs::path> files = frame_files(folder, manifest);
  std::vector<GlobeFrame> frames;
  const std::size_t count = std::min(kMost, files.size());
  for (std::size_t k = 0; k < count; ++k) {
    const fs::path& file = files[count < 2 ? 0 : k * (files.size() - 1) / (count - 1)];
    State state = read_frame(file, [](const FieldSpec& spec) {
      return spec.name == field::crust_elevation.name || spec.name == field::elevation.name;
    });
    frames.push_back({std::stod(time_in_name(file)), std::move(state)});
  }
  return frames;
}

std::vector<fs::path> draw_frames(const RunFolder& folder, const MapView& view,
                                  const fs::path& pictures) {
  const Manifest manifest = read_manifest(folder.manifest());
  const std::vector<fs::path> files = frame_files(folder, manifest);
  if (files.empty()) {
    throw ConfigurationError(
        fmt::format("{}: has no frames to draw; runs with plates.sphere.frames_myr have",
                    folder.path().string()));
  }
  auto wanted = map_fields();
  wanted.push_back(&field::crust_elevation);
  std::vector<fs::path> written;
  for (const fs::path& file : files) {
    State frame = read_frame(file, [&](const FieldSpec& spec) { return lists(wanted, spec); });
    take_crust_for_surface(frame);
    const std::string time = time_in_name(file);
    const std::string note = fmt::format("{:g} Myr, seed {}", std::stod(time), manifest.seed);
    const fs::path drawn = pictures / fmt::format(".{}", time);
    for (const MapFile& map : draw_map_files(frame, drawn, view, note)) {
      written.push_back(moved_to(map.path, pictures / map.path.stem(), time + ".png"));
    }
    std::error_code ignored;
    fs::remove(drawn, ignored);
  }
  return written;
}

}  // namespace geo::io
