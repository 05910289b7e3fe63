#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace geo::test {

/// All bytes of a file.
inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

}  // namespace geo::test
