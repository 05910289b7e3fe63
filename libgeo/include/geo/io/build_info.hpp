#pragma once

#include <string>
#include <utility>
#include <vector>

namespace geo::io {

/// What this build is made of; goes into `terrane --version`, the manifest and file attributes.
struct BuildInfo {
  std::string version;   ///< "0.1.0"
  std::string commit;    ///< abbreviated hash, "-dirty" with local changes, "unknown" without git
  std::string compiler;  ///< "GNU 12.2.0"
  std::vector<std::pair<std::string, std::string>> libraries;  ///< name, version
};

const BuildInfo& build_info();

}  // namespace geo::io
