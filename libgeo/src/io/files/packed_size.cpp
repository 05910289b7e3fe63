#include "packed_size.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include "geo/core/error.hpp"

namespace geo::io {

void check_packed_size(double values, double bytes_each, double file_bytes) {
  constexpr double kSmall = 1 << 22, kMostPerByte = 4096.0;
  if (values > kSmall && values > kMostPerByte * file_bytes) {
    throw InputError(fmt::format("truncated or damaged: claims {:.0f} values in {:.0f} bytes",
                                 values, file_bytes));
  }
  const double memory_bytes =
      static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE));
  if (values * bytes_each > memory_bytes) {
    throw InputError(
        fmt::format("holds {:.0f} values, which take {:.1f} GB: there are {:.1f} GB of "
                    "memory; cut or coarsen it first",
                    values, 1e-9 * values * bytes_each, 1e-9 * memory_bytes));
  }
}

}  // namespace geo::io
