#include <fmt/format.h>

#include <array>

#include "geo/core/error.hpp"
#include "geo/io/netcdf/stage_file.hpp"
#include "io/files/open_input.hpp"
#include "io/input/questions.hpp"
#include "netcdf_file.hpp"
#include "stage_names.hpp"

namespace geo::io {
namespace {

template <class T>
Values read_array(int group, int variable, std::size_t size) {
  std::vector<T> array(size);
  nc::check(nc_get_var(group, variable, array.data()));
  return array;
}

Values read_any(int group, int variable, nc_type type, std::size_t size) {
  switch (type) {
    case NC_FLOAT:
      return read_array<float>(group, variable, size);
    case NC_DOUBLE:
      return read_array<double>(group, variable, size);
    case NC_BYTE:
      return read_array<std::int8_t>(group, variable, size);
    case NC_SHORT:
      return read_array<std::int16_t>(group, variable, size);
    case NC_INT:
      return read_array<std::int32_t>(group, variable, size);
    default:
      throw InputError("holds an array of an unknown type");
  }
}

Checkpoint read_group(const nc::File& file) {
  Checkpoint checkpoint;
  int group = 0, count = 0;
  const auto time = file.find_variable(kFrameTime);
  if (!time || nc_inq_ncid(file.id(), kCheckpointGroup, &group) != NC_NOERR) {
    throw InputError("is no frame of drifting plates");
  }
  constexpr std::array<std::size_t, NC_MAX_VAR_DIMS> kFirst{};
  nc::check(nc_get_var1_double(file.id(), *time, kFirst.data(), &checkpoint.time_myr));
  nc::check(nc_inq_nvars(group, &count));
  for (int variable = 0; variable < count; ++variable) {
    std::array<char, NC_MAX_NAME + 1> name{};
    nc_type type = NC_NAT;
    int dimensions = 0, dimension = 0;
    nc::check(nc_inq_var(group, variable, name.data(), &type, &dimensions, nullptr, nullptr));
    if (dimensions != 1) throw InputError("is a damaged frame");
    nc::check(nc_inq_vardimid(group, variable, &dimension));
    std::size_t size = 0;
    nc::check(nc_inq_dimlen(group, dimension, &size));
    file.check_size(group, variable);
    checkpoint.arrays[name.data()] = read_any(group, variable, type, size);
  }
  // Frames of older versions have none.
  const auto digest = nc::text_of(group, NC_GLOBAL, kCheckpointDigest);
  if (digest && *digest != digest_of(checkpoint)) {
    throw InputError("is a damaged frame: its arrays are not those that were written");
  }
  return checkpoint;
}

}  // namespace

Checkpoint read_checkpoint(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) {
    throw InputError(fmt::format("fields.start_frame: {}: no such file", path.string()));
  }
  return answer_to(CheckpointQuestion{path.string()});
}

Checkpoint CheckpointQuestion::here() const {
  try {
    return read_group(open_input(file));
  } catch (const nc::Failure& failure) {
    throw InputError(fmt::format("{}: {}", file, failure.what()));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file, error.what()));
  }
}

}  // namespace geo::io
