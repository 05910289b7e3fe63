#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <fstream>
#include <string_view>
#include <system_error>

#include "chunk_reader.hpp"
#include "geo/core/error.hpp"
#include "geo/io/files/digest.hpp"
#include "geo/io/netcdf/stage_file.hpp"
#include "grid_description.hpp"
#include "io/files/open_input.hpp"
#include "io/input/questions.hpp"
#include "netcdf_file.hpp"
#include "stage_names.hpp"

namespace geo::io {
namespace {

/// Whether a file begins as TIFF files do, classic or big, of either order of bytes.
bool is_tiff(const std::filesystem::path& path) {
  std::string begin(4, ' ');
  std::ifstream(path, std::ios::binary).read(begin.data(), 4);
  constexpr std::array<std::string_view, 4> kBegins{
      std::string_view("II*\0", 4), std::string_view("MM\0*", 4), std::string_view("II+\0", 4),
      std::string_view("MM\0+", 4)};
  return std::find(kBegins.begin(), kBegins.end(), begin) != kBegins.end();
}

Values empty_values(Type type, std::size_t size) {
  switch (type) {
    case Type::float32:
      return std::vector<float>(size);
    case Type::float64:
      return std::vector<double>(size);
    case Type::int8:
      return std::vector<std::int8_t>(size);
    case Type::int16:
      return std::vector<std::int16_t>(size);
    case Type::int32:
      return std::vector<std::int32_t>(size);
  }
  throw Bug("unknown type of field");
}

bool lies_on_grid(const nc::File& file, int variable, const Grid& grid) {
  auto dimensions = file.dimensions_of(variable);
  const auto names = dimension_names(grid);
  if (dimensions.size() == 3 && file.dimension_name(dimensions[0]) == kFrameTime &&
      file.dimension_size(dimensions[0]) == 1) {
    dimensions.erase(dimensions.begin());
  }
  return dimensions.size() == 2 && file.dimension_name(dimensions[0]) == names.row &&
         file.dimension_name(dimensions[1]) == names.column;
}

std::shared_ptr<const Values> read_field(const nc::File& file, const ChunkReader& chunks,
                                         int variable, const FieldSpec& spec, const Grid& grid) {
  const std::string name(spec.name);
  if (!lies_on_grid(file, variable, grid)) {
    throw InputError(fmt::format("variable {}: dimensions are not those of the grid", name));
  }
  if (file.variable_type(variable) != nc::type_of(spec.type)) {
    throw InputError(
        fmt::format("variable {}: stored as another type than this version of "
                    "terrane writes",
                    name));
  }
  const std::string units = file.text(variable, "units").value_or("");
  if (spec.flags.empty() && units != spec.units) {
    throw InputError(
        fmt::format("variable {}: units are \"{}\", must be \"{}\"", name, units, spec.units));
  }
  file.check_size(variable);
  const auto values = std::make_shared<Values>(empty_values(spec.type, grid.size()));
  if (chunks.read(name, *values, grid.ny(), grid.nx())) return values;
  try {
    std::visit([&](auto& array) { nc::check(nc_get_var(file.id(), variable, array.data())); },
               *values);
  } catch (const nc::Failure& failure) {
    throw InputError(fmt::format("variable {}: truncated or damaged ({})", name, failure.what()));
  }
  return values;
}

std::string required_text(const nc::File& file, const char* name) {
  auto text = file.text(NC_GLOBAL, name);
  if (!text) {
    throw InputError(fmt::format("not a stage file: global attribute {} is missing", name));
  }
  return *text;
}

std::uint64_t read_seed(const nc::File& file) {
  const std::string text = required_text(file, "terrane_seed");
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error != std::errc{} || end != text.data() + text.size()) {
    throw InputError(
        fmt::format("global attribute terrane_seed is \"{}\", must be a whole number", text));
  }
  return seed;
}

std::string read_configuration(const nc::File& file) {
  auto text = file.text_in(kConfig);
  if (!text) return required_text(file, kConfig);  // older files
  if (file.text(NC_GLOBAL, kConfigDigest) != digest_of(std::string_view(*text))) {
    throw InputError(fmt::format("variable {}: is not the text of which {} is the digest", kConfig,
                                 kConfigDigest));
  }
  return *text;
}

/// Opens a file, runs `read` on it, and puts the path before what goes wrong.
template <class Read>
auto read_stage_file(const std::filesystem::path& path, const Read& read) {
  const nc::File file = open_input(path);
  try {
    return read(file);
  } catch (const nc::Failure& failure) {
    throw InputError(fmt::format("{}: truncated or damaged ({})", path.string(), failure.what()));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", path.string(), error.what()));
  }
}

}  // namespace

nc::File open_input(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (error || !std::filesystem::exists(status)) {
    throw IoError(fmt::format("cannot read {}: {}", path.string(),
                              error ? error.message() : "No such file or directory"));
  }
  if (std::filesystem::is_directory(status)) {
    throw IoError(fmt::format("cannot read {}: Is a directory", path.string()));
  }
  try {
    return nc::File::open(path);
  } catch (const nc::Failure& failure) {
    if (failure.status == EACCES || failure.status == EPERM) {
      throw IoError(fmt::format("cannot read {}: Permission denied", path.string()));
    }
    if (is_tiff(path)) {
      throw InputError(fmt::format(
          "{}: a TIFF image: must be a NetCDF file, which gdal_translate -of netCDF makes of it",
          path.string()));
    }
    throw InputError(fmt::format(
        "{}: not a NetCDF file (classic, 64-bit or NetCDF-4, which alone is read), or truncated "
        "({})",
        path.string(), failure.what()));
  }
}

Snapshot read_netcdf(const std::filesystem::path& path) {
  return read_netcdf(path, [](const FieldSpec&) { return true; });
}

Snapshot read_netcdf(const std::filesystem::path& path,
                     const std::function<bool(const FieldSpec&)>& wanted) {
  StageQuestion question{path.string(), {}};
  for (const FieldSpec* spec : field::all()) {
    if (wanted(*spec)) question.wanted.emplace_back(spec->name);
  }
  return answer_to(question);
}

Snapshot StageQuestion::here() const {
  return read_stage_file(path(), [&](const nc::File& file) {
    Snapshot snapshot;
    const ChunkReader chunks(path());
    bool holds_fields = false;
    snapshot.grid = std::make_shared<const Grid>(read_grid(file));
    snapshot.stage = required_text(file, "terrane_stage");
    for (int variable = 0; variable < file.variables(); ++variable) {
      const FieldSpec* const spec = field::find(file.variable_name(variable));
      if (spec == nullptr) continue;
      holds_fields = true;
      if (std::find(wanted.begin(), wanted.end(), spec->name) == wanted.end()) continue;
      snapshot.fields.emplace_back(spec, read_field(file, chunks, variable, *spec, *snapshot.grid));
    }
    if (!holds_fields) throw InputError("holds no field that terrane knows");
    return snapshot;
  });
}

std::vector<float> read_month(const std::filesystem::path& path, const FieldSpec& spec, int month) {
  return read_stage_file(path, [&](const nc::File& file) -> std::vector<float> {
    const auto variable = file.find_variable(spec.name);
    if (!variable) return {};
    const auto dimensions = file.dimensions_of(*variable);
    if (dimensions.size() != 3 || file.variable_type(*variable) != NC_FLOAT) {
      throw InputError(fmt::format("variable {}: is no field of months", spec.name));
    }
    file.check_size(*variable);
    const std::size_t ny = file.dimension_size(dimensions[1]);
    const std::size_t nx = file.dimension_size(dimensions[2]);
    if (static_cast<std::size_t>(month) >= file.dimension_size(dimensions[0])) return {};
    std::vector<float> values(nx * ny);
    const std::array<std::size_t, 3> from{static_cast<std::size_t>(month), 0, 0};
    const std::array<std::size_t, 3> count{1, ny, nx};
    nc::check(nc_get_vara_float(file.id(), *variable, from.data(), count.data(), values.data()));
    return values;
  });
}

Provenance read_provenance(const std::filesystem::path& path) {
  return answer_to(ProvenanceQuestion{path.string()});
}

Provenance ProvenanceQuestion::here() const {
  return read_stage_file(path(), [](const nc::File& file) {
    Provenance provenance;
    provenance.title = file.text(NC_GLOBAL, "title").value_or("");
    provenance.config_toml = read_configuration(file);
    provenance.seed = read_seed(file);
    provenance.version = required_text(file, "terrane_version");
    provenance.history = file.text(NC_GLOBAL, "history").value_or("");
    provenance.references = file.text(NC_GLOBAL, "references").value_or("");
    return provenance;
  });
}

}  // namespace geo::io
