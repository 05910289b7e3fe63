#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "cli/sample_run.hpp"

namespace geo {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

constexpr int kConfiguration = 2, kInput = 3, kIo = 4;

/// What is wrong: how to call the program in a folder that holds a sound `relief.nc`, with which
/// code it must refuse, and what its one line must say.
struct BadInput {
  std::string name;
  int code;
  Words says;
  std::function<Words(const fs::path& folder)> arguments;
  Words environment = {};  ///< name, value
};

inline void PrintTo(const BadInput& input, std::ostream* stream) { *stream << input.name; }

/// Instantiated beside each list of bad input.
class BadInputTest : public testing::TestWithParam<BadInput> {};

inline std::string name_of_input(const testing::TestParamInfo<BadInput>& info) {
  return info.param.name;
}

/// A sound run with more arguments.
inline auto run_with(Words more) {
  return [more = std::move(more)](const fs::path& folder) {
    return quick_run(folder / "relief.nc", folder / "out", more);
  };
}

inline auto words(Words arguments) {
  return [arguments = std::move(arguments)](const fs::path&) { return arguments; };
}

}  // namespace geo
