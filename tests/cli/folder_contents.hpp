#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "cli/program.hpp"

namespace geo {

/// Every file below a folder with its bytes, every folder with nothing; to see that a command
/// changed nothing, or made the same twice.
inline std::map<std::string, std::string> contents_of(const std::filesystem::path& folder) {
  std::map<std::string, std::string> contents;
  if (!std::filesystem::exists(folder)) return contents;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string name = std::filesystem::relative(entry.path(), folder).string();
    contents[name] = entry.is_regular_file() ? text_of(entry.path()) : std::string("(folder)");
  }
  return contents;
}

}  // namespace geo
