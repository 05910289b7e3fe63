#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/program.hpp"

namespace geo {

/// Arguments of a run that takes a moment: a coarse climate, a small island, no pictures, two
/// threads.
inline std::vector<std::string> quick_run(const std::filesystem::path& relief,
                                          const std::filesystem::path& folder,
                                          const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments{"run", "--dem",         relief.string(),
                                     "-o",  folder.string(), "--no-maps"};
  for (const char* setting : {"climate.resolution_deg=10", "island.nx=128", "island.ny=64"}) {
    arguments.insert(arguments.end(), {"--set", setting});
  }
  if (std::find(more.begin(), more.end(), "--threads") == more.end()) {
    arguments.insert(arguments.end(), {"--threads", "2"});
  }
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

inline nlohmann::json manifest_of(const std::filesystem::path& folder) {
  return nlohmann::json::parse(text_of(folder / "manifest.json"));
}

/// "stage/field: digest" of everything a run computed.
inline std::vector<std::string> digests_of(const std::filesystem::path& folder) {
  std::vector<std::string> digests;
  const auto manifest = manifest_of(folder);
  for (const auto& stage : manifest.at("stages")) {
    for (const auto& [name, field] : stage.at("fields").items()) {
      digests.push_back(stage.at("name").get<std::string>() + "/" + name + ": " +
                        field.at("digest").get<std::string>());
    }
  }
  EXPECT_FALSE(digests.empty()) << folder << " holds no complete stage";
  return digests;
}

/// Names of the stages that a run has completed.
inline std::vector<std::string> stages_of(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  const auto manifest = manifest_of(folder);
  for (const auto& stage : manifest.at("stages")) names.push_back(stage.at("name"));
  return names;
}

}  // namespace geo
