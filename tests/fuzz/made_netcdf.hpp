#pragma once

#include <netcdf.h>

#include <filesystem>
#include <string>
#include <vector>

#include "fuzz.hpp"

namespace geo::fuzz {

/// A NetCDF file that a fuzzer's bytes decide on. netCDF and HDF5 themselves do not survive any
/// bytes, and the program reads files of others in a process of its own for that; what is tried
/// here is our code behind them: files that the libraries can read and that hold anything. Calls
/// that the library refuses leave that part out.
class MadeNetcdf {
 public:
  MadeNetcdf(const std::string& path, Bytes& bytes) : bytes_(bytes) {
    // The classic formats are many times as fast to write.
    is_hdf5_ = bytes_.one_in(8);
    // A file that HDF5 could not close stays open, and cannot be made anew under its inode.
    std::filesystem::remove(path);
    claim(nc_create(path.c_str(), NC_CLOBBER | (is_hdf5_ ? NC_NETCDF4 : NC_64BIT_DATA), &id_) ==
              NC_NOERR,
          "files can be made");
    int old = 0;
    nc_set_fill(id_, bytes_.one_in(16) ? NC_FILL : NC_NOFILL, &old);
  }
  ~MadeNetcdf() {
    if (is_large_) nc_set_fill(id_, NC_NOFILL, nullptr);  // a file of holes, not of gigabytes
    nc_enddef(id_);
    if (!bytes_.one_in(16)) put_values();
    nc_close(id_);
  }
  MadeNetcdf(const MadeNetcdf&) = delete;
  MadeNetcdf& operator=(const MadeNetcdf&) = delete;

  [[nodiscard]] int id() const { return id_; }
  [[nodiscard]] bool is_hdf5() const { return is_hdf5_; }

  /// A dimension of `usual` entries, now and then of any other number.
  int dimension(const std::string& name, int usual) {
    const std::size_t size = bytes_.one_in(24)   ? bytes_.below(40)
                             : bytes_.one_in(64) ? large_size(usual)
                                                 : static_cast<std::size_t>(usual);
    int dimension = -1;
    if (nc_def_dim(id_, name.c_str(), size, &dimension) != NC_NOERR) return -1;
    dimensions_.push_back(dimension);
    return dimension;
  }

  /// A variable of the usual type over the usual dimensions, now and then of others; its values run
  /// from `first` to `last`, but for a few.
  int variable(const std::string& name, nc_type usual, std::vector<int> dimensions, double first,
               double last) {
    if (bytes_.one_in(32)) return -1;
    const nc_type type =
        bytes_.one_in(12) ? 1 + bytes_.below(is_hdf5_ ? NC_STRING : NC_UINT64) : usual;
    if (bytes_.one_in(24) && !dimensions.empty()) dimensions.pop_back();
    if (bytes_.one_in(24) && !dimensions_.empty()) {
      dimensions.insert(dimensions.begin(),
                        dimensions_[bytes_.below(static_cast<int>(dimensions_.size()))]);
    }
    if (bytes_.one_in(24) && dimensions.size() == 2) std::swap(dimensions[0], dimensions[1]);
    for (const int dimension : dimensions) {
      if (dimension < 0) return -1;
    }
    int variable = -1;
    if (nc_def_var(id_, name.c_str(), type, static_cast<int>(dimensions.size()), dimensions.data(),
                   &variable) != NC_NOERR) {
      return -1;
    }
    if (is_hdf5_ && !dimensions.empty() && bytes_.one_in(2)) {
      nc_def_var_deflate(id_, variable, 1, 1, 1);
    }
    values_.push_back({variable, type, dimensions, first, last});
    return variable;
  }

  void text(int variable, const char* name, const std::string& value) {
    if (bytes_.one_in(32)) return;
    if (bytes_.one_in(32)) return numbers(variable, name, {bytes_.value<double>()});
    if (is_hdf5_ && bytes_.one_in(4)) {
      const char* string = value.c_str();
      nc_put_att_string(id_, variable, name, 1, &string);
      return;
    }
    nc_put_att_text(id_, variable, name, value.size(), value.data());
  }
  void numbers(int variable, const char* name, std::vector<double> values) {
    if (bytes_.one_in(32)) return;
    if (bytes_.one_in(32)) values.resize(bytes_.below(6));
    for (double& value : values) {
      if (bytes_.one_in(16)) value = any_number();
    }
    const nc_type type = bytes_.one_in(8) ? 1 + bytes_.below(NC_UINT64) : NC_DOUBLE;
    if (type == NC_CHAR) return text(variable, name, bytes_.text(8));
    nc_put_att_double(id_, variable, name, type, values.size(), values.data());
  }

  double any_number() {
    switch (bytes_.below(4)) {
      case 0:
        return bytes_.value<std::int8_t>();
      case 1:
        return bytes_.value<float>();
      case 2:
        return 1e30 * bytes_.value<std::int16_t>();
      default:
        return bytes_.value<double>();
    }
  }

 private:
  /// Of one dimension, so that the file's data are few megabytes, or more than any grid has.
  std::size_t large_size(int usual) {
    if (is_large_) return usual;
    is_large_ = true;
    const std::size_t size = bytes_.below(8192);
    return bytes_.one_in(4) ? size << 24 : size;
  }

  struct Planned {
    int variable;
    nc_type type;
    std::vector<int> dimensions;
    double first, last;
  };

  void put_values() {
    for (const Planned& planned : values_) {
      std::size_t size = 1;
      for (const int dimension : planned.dimensions) {
        std::size_t length = 0;
        nc_inq_dimlen(id_, dimension, &length);
        size *= length;
      }
      constexpr std::size_t kMost = 4096;
      if (size > kMost || size == 0 || planned.type == NC_CHAR || planned.type == NC_STRING)
        continue;
      std::vector<double> values(size);
      for (std::size_t k = 0; k < size; ++k) {
        const double part = size > 1 ? static_cast<double>(k) / static_cast<double>(size - 1) : 0.0;
        values[k] = planned.first + part * (planned.last - planned.first);
      }
      for (int odd = bytes_.byte() % 4; odd > 0; --odd) {
        values[bytes_.below(static_cast<int>(size))] = any_number();
      }
      nc_put_var_double(id_, planned.variable, values.data());
    }
  }

  Bytes& bytes_;
  int id_ = -1;
  bool is_hdf5_ = false, is_large_ = false;
  std::vector<int> dimensions_;
  std::vector<Planned> values_;
};

}  // namespace geo::fuzz
