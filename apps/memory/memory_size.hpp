#pragma once

#include <string>

namespace terrane {

/// Less than this no run can be kept to: the program, its libraries and what they hold in small
/// blocks.
constexpr double kLeastMemory_bytes = 200e6;

/// Bytes of "16GiB" or "500MB" (kB, MB, GB, TB by 1000; KiB, MiB, GiB, TiB by 1024). Throws
/// ConfigurationError that names `--memory`.
double parse_memory_size(const std::string& text);

}  // namespace terrane
