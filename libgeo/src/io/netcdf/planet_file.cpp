#include "geo/io/netcdf/planet_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <functional>
#include <system_error>
#include <type_traits>

#include "geo/core/error.hpp"
#include "geo/io/input/dem.hpp"
#include "geo/io/netcdf/stage_file.hpp"
#include "geo/io/run/recorded_file.hpp"
#include "io/files/open_input.hpp"
#include "io/input/questions.hpp"
#include "netcdf_file.hpp"

namespace geo::io {
namespace {

namespace fs = std::filesystem;

/// "03-erosion.nc" and the like, in the order of the stages.
std::vector<fs::path> stage_files(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    const auto digit = [&](std::size_t i) {
      return std::isdigit(static_cast<unsigned char>(name[i])) != 0;
    };
    if (name.size() > 6 && digit(0) && digit(1) && name[2] == '-' &&
        entry.path().extension() == ".nc") {
      files.push_back(entry.path());
    }
  }
  if (error) throw IoError(fmt::format("{}: could not read: {}", folder.string(), error.message()));
  std::sort(files.begin(), files.end());
  return files;
}

bool same_cells(const Grid& a, const Grid& b) {
  return a.topology() == b.topology() && a.nx() == b.nx() && a.ny() == b.ny();
}

bool is_wanted(const FieldSpec& spec, std::span<const FieldSpec* const> wanted) {
  return std::find(wanted.begin(), wanted.end(), &spec) != wanted.end();
}

bool is_stage_file(const fs::path& path) {
  return answer_to(StageNameQuestion{path.string()}).has_value();
}

/// Refuses values by which something would be looked up that is not there: numbers of cells, of
/// plates, lakes and basins (there are never more than cells), and flags without a meaning.
void check_numbers(const fs::path& path, const Snapshot& snapshot) {
  const double cells = snapshot.grid->size();
  for (const auto& [spec, values] : snapshot.fields) {
    double least = spec == &field::flow_receiver ? 0.0 : spec->missing, most = cells - 1.0;
    if (!spec->flags.empty()) {
      const auto [low, high] =
          std::minmax_element(spec->flags.begin(), spec->flags.end(),
                              [](const Flag& a, const Flag& b) { return a.value < b.value; });
      least = std::min<double>(spec->missing, low->value);
      most = high->value;
    }
    const auto check = [&, &spec = spec]<class T>(const std::vector<T>& array) {
      if constexpr (std::is_integral_v<T>) {
        for (const T value : array) {
          if (value >= least && value <= most) continue;
          throw InputError(fmt::format("{}: variable {}: holds {}, must be within {:g} and {:g}",
                                       path.string(), spec->name, value, least, most));
        }
      }
    };
    std::visit(check, *values);
  }
}

Snapshot read_wanted(const fs::path& path, const std::function<bool(const FieldSpec&)>& wanted) {
  Snapshot snapshot = read_perhaps_recorded(path, wanted);
  check_numbers(path, snapshot);
  return snapshot;
}

State read_stage(const fs::path& path, std::span<const FieldSpec* const> wanted) {
  const Snapshot snapshot =
      read_wanted(path, [&](const FieldSpec& spec) { return is_wanted(spec, wanted); });
  State state(snapshot.grid);
  for (const auto& [spec, values] : snapshot.fields) state.share(*spec, values);
  return state;
}

void require_whole_planet(const Grid& grid, const std::string& place) {
  if (grid.topology() == Topology::sphere) return;
  throw InputError(
      fmt::format("{}: covers a part of a planet only; its figures can be set beside "
                  "Earth's when it goes from pole to pole and all round",
                  place));
}

}  // namespace

std::optional<std::string> StageNameQuestion::here() const {
  return open_input(file).text(NC_GLOBAL, "terrane_stage");
}

State read_planet(std::span<const fs::path> stage_files, std::span<const FieldSpec* const> wanted) {
  if (stage_files.empty()) throw InputError("the run holds no complete stage");
  const auto none = [](const FieldSpec&) { return false; };
  State state(read_perhaps_recorded(stage_files.front(), none).grid);
  for (auto file = stage_files.rbegin(); file != stage_files.rend(); ++file) {
    const Snapshot snapshot = read_wanted(
        *file, [&](const FieldSpec& spec) { return is_wanted(spec, wanted) && !state.has(spec); });
    if (!same_cells(*snapshot.grid, state.grid())) continue;
    for (const auto& [spec, values] : snapshot.fields) state.share(*spec, values);
  }
  return state;
}

State read_planet(const fs::path& folder, std::span<const FieldSpec* const> wanted) {
  const auto files = stage_files(folder);
  if (files.empty()) {
    throw InputError(fmt::format(
        "{}: holds no stage file (such as 03-erosion.nc): give the folder of a run or a NetCDF "
        "file",
        folder.string()));
  }
  return read_planet(files, wanted);
}

State read_planet_or_dem(const std::string& place, std::span<const FieldSpec* const> wanted) {
  std::error_code ignored;
  if (fs::is_directory(place, ignored)) {
    State state = read_planet(place, wanted);
    require_whole_planet(state.grid(), place);
    return state;
  }
  if (fs::exists(place, ignored) && is_stage_file(place)) {
    State state = read_stage(place, wanted);
    require_whole_planet(state.grid(), place);
    return state;
  }
  Dem dem = read_dem(place, Planet{});
  require_whole_planet(dem.grid, dem.source);
  State state(std::make_shared<const Grid>(std::move(dem.grid)));
  state.set(field::elevation, std::move(dem.elevation_m));
  return state;
}

}  // namespace geo::io
