#include <fmt/format.h>

#include <array>

#include "checkpoint_group.hpp"
#include "geo/core/error.hpp"
#include "geo/io/stage_file.hpp"
#include "netcdf_file.hpp"
#include "open_input.hpp"

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
  const auto time = file.find_variable("drift_time");
  if (!time || nc_inq_ncid(file.id(), kCheckpointGroup, &group) != NC_NOERR) {
    throw InputError("is no frame of drifting plates");
  }
  nc::check(nc_get_var_double(file.id(), *time, &checkpoint.time_myr));
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
    checkpoint.arrays[name.data()] = read_any(group, variable, type, size);
  }
  return checkpoint;
}

}  // namespace

Checkpoint read_checkpoint(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) {
    throw InputError(fmt::format("fields.start_frame: {}: no such file", path.string()));
  }
  try {
    return read_group(open_input(path));
  } catch (const nc::Failure& failure) {
    throw InputError(fmt::format("{}: {}", path.string(), failure.what()));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", path.string(), error.what()));
  }
}

}  // namespace geo::io
