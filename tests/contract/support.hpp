#pragma once

#include <udunits2.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "support/declarations.hpp"

namespace geo::test {

/// The models among which a stage lets its user choose; the empty word where there is no choice.
inline std::vector<std::string> models_of(const StageEntry& entry) {
  const auto stage = entry.make();
  const auto parameters = stage->parameters();
  const Parameter* model = find_parameter(parameters, std::string(entry.name) + ".model");
  if (model == nullptr) return {""};
  return {model->choices.begin(), model->choices.end()};
}

/// A stage that runs one of its models, or its default for the empty word.
inline std::unique_ptr<Stage> stage_of(const StageEntry& entry, const std::string& model) {
  auto stage = entry.make();
  if (model.empty()) return stage;
  const auto parameters = stage->parameters();
  find_parameter(parameters, std::string(entry.name) + ".model")->set_text(model);
  return stage;
}

/// Asks UDUNITS, as every client of the files does.
class Units {
 public:
  Units() {
    ut_set_error_message_handler(ut_ignore);
    system_.reset(ut_read_xml(nullptr));
    if (!system_) throw std::runtime_error("no units database of UDUNITS");
  }
  [[nodiscard]] bool reads(std::string_view text) const { return parse(text) != nullptr; }
  [[nodiscard]] bool converts(std::string_view from, std::string_view to) const {
    const auto a = parse(from), b = parse(to);
    return a && b && ut_are_convertible(a.get(), b.get()) != 0;
  }

 private:
  struct Free {
    void operator()(ut_system* system) const { ut_free_system(system); }
    void operator()(ut_unit* unit) const { ut_free(unit); }
  };
  [[nodiscard]] std::unique_ptr<ut_unit, Free> parse(std::string_view text) const {
    return std::unique_ptr<ut_unit, Free>(
        ut_parse(system_.get(), std::string(text).c_str(), UT_UTF8));
  }
  std::unique_ptr<ut_system, Free> system_;
};

namespace fs = std::filesystem;

inline fs::path repository() { return TERRANE_SOURCE_DIR; }

inline std::string read_text(const fs::path& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read " + path.string());
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Files below folders of the repository that end in one of `extensions` ("": any).
inline std::vector<fs::path> files_in(const std::vector<std::string>& folders,
                                      const std::set<std::string>& extensions = {}) {
  std::vector<fs::path> files;
  for (const std::string& folder : folders) {
    for (const auto& entry : fs::recursive_directory_iterator(repository() / folder)) {
      if (!entry.is_regular_file()) continue;
      if (extensions.empty() || extensions.contains(entry.path().extension().string())) {
        files.push_back(entry.path());
      }
    }
  }
  return files;
}

}  // namespace geo::test
