#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "dem_values.hpp"
#include "geo/io/config/run_settings.hpp"
#include "geo/io/input/dem.hpp"
#include "geo/io/netcdf/stage_file.hpp"
#include "geo/kernels/exemplars/exemplar.hpp"

namespace geo::io {

// What can be asked of a file. `here()` reads it in this process and throws what its reader throws.

/// A raster of somebody else's.
struct RasterQuestion {
  using Answer = Dem;
  static constexpr const char* kName = "raster";
  std::string file_and_variable, otherwise, units;
  Gaps gaps = Gaps::refused;
  double radius_km = 0.0, flattening = 0.0;
  std::string range = {}, window = {};        ///< ImageWords
  double least = -INFINITY, most = INFINITY;  ///< bounds of the quantity

  [[nodiscard]] auto parts() {
    return std::tie(file_and_variable, otherwise, units, gaps, radius_km, flattening, range, window,
                    least, most);
  }
  [[nodiscard]] std::filesystem::path path() const { return split_dem(file_and_variable).first; }
  [[nodiscard]] Answer here() const;
};

struct GeotiffQuestion {
  using Answer = Dem;
  static constexpr const char* kName = "geotiff";
  std::string file;
  double radius_km = 0.0, flattening = 0.0;

  [[nodiscard]] auto parts() { return std::tie(file, radius_km, flattening); }
  [[nodiscard]] std::filesystem::path path() const { return file; }
  [[nodiscard]] Answer here() const;
};

/// Fields of a stage file.
struct StageQuestion {
  using Answer = Snapshot;
  static constexpr const char* kName = "stage";
  std::string file;
  std::vector<std::string> wanted;

  [[nodiscard]] auto parts() { return std::tie(file, wanted); }
  [[nodiscard]] std::filesystem::path path() const { return file; }
  [[nodiscard]] Answer here() const;
};

struct ProvenanceQuestion {
  using Answer = Provenance;
  static constexpr const char* kName = "provenance";
  std::string file;

  [[nodiscard]] auto parts() { return std::tie(file); }
  [[nodiscard]] std::filesystem::path path() const { return file; }
  [[nodiscard]] Answer here() const;
};

/// The stage that a file is of; nothing if it is no stage file.
struct StageNameQuestion {
  using Answer = std::optional<std::string>;
  static constexpr const char* kName = "stage name";
  std::string file;

  [[nodiscard]] auto parts() { return std::tie(file); }
  [[nodiscard]] std::filesystem::path path() const { return file; }
  [[nodiscard]] Answer here() const;
};

/// What a frame of drift holds to go on from.
struct CheckpointQuestion {
  using Answer = Checkpoint;
  static constexpr const char* kName = "checkpoint";
  std::string file;

  [[nodiscard]] auto parts() { return std::tie(file); }
  [[nodiscard]] std::filesystem::path path() const { return file; }
  [[nodiscard]] Answer here() const;
};

/// Grown exemplars in the user's cache; none where they are damaged.
struct CacheQuestion {
  using Answer = std::vector<Exemplar>;
  static constexpr const char* kName = "cache";
  std::string file;

  [[nodiscard]] auto parts() { return std::tie(file); }
  [[nodiscard]] std::filesystem::path path() const { return file; }
  [[nodiscard]] Answer here() const;
};

/// The answer, read aside where the program wants it so (read_files_aside), else here.
template <class Question>
typename Question::Answer answer_to(const Question& question);

}  // namespace geo::io
