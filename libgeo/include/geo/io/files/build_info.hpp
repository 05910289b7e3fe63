#pragma once

#include <string>

namespace geo::io {

/// What this build was made from; goes into `terrane --version`, the manifest and file attributes.
struct BuildInfo {
  std::string version;   ///< "0.1.0"
  std::string commit;    ///< abbreviated hash, "-dirty" with local changes, "unknown" without git
  std::string compiler;  ///< "GNU 12.2.0"
  /// What the linker called the program, hexadecimal: the same for the same sources, compiler and
  /// options, another for any other. Empty where the linker gives no name.
  std::string id;
};

const BuildInfo& build_info();

}  // namespace geo::io
