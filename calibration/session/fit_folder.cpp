#include "calibration/session/fit_folder.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "calibration/report/report.hpp"
#include "geo/core/error.hpp"
#include "geo/io/config/config.hpp"
#include "geo/io/config/run_settings.hpp"
#include "geo/io/files/digest.hpp"

namespace geo::calibration {
namespace {

namespace fs = std::filesystem;

/// What the answer depends on.
std::string question_of(const Request& request, const Target& target) {
  Settings settings = request.settings;
  settings.iterations = 0;  // a fit may be given more time
  settings.profiles = true;
  settings.error_m = 0.0;  // standard errors come after the fit
  settings.held_out.clear();
  settings.held_out_grid.clear();
  const auto own = settings.parameters();
  std::string text = io::write_config(request.configuration, "", request.events) +
                     io::write_config(own, "") + request.target;
  text +=
      fmt::format(" {} {}", fmt::join(target.elevation_m, " "), fmt::join(target.deviation_m, " "));
  return io::digest_of(std::string_view(text));
}

/// Another build may compute other planets: it goes on where that is asked for, and is listed.
void take_over(const Request& request, std::vector<io::Builder>& builders,
               const std::string& shown) {
  const io::Builder here = io::this_builder();
  const io::Builder last = builders.empty() ? io::Builder{} : builders.back();
  if (last == here) return;
  if (!request.allow_other_build) {
    throw ConfigurationError(
        fmt::format("--resume: {} was made by terrane {}, this is {}; --allow-other-build goes on "
                    "nevertheless, --overwrite calibrates again",
                    shown, builders.empty() ? "of an earlier version" : last.words_beside(here),
                    here.words_beside(last)));
  }
  builders.push_back(here);
}

/// Refuses a folder that holds something else, or whose fit is neither gone on with nor replaced.
void check_folder(const Request& request, const io::RunFolder& folder) {
  if (folder.path().empty()) throw ConfigurationError("-o \"\": must name a folder");
  const std::string shown = folder.path().string();
  const bool held =
      fs::exists(folder.path() / kStateFile) || fs::exists(folder.path() / kResultFile);
  if (folder.holds_run()) {
    throw ConfigurationError(
        fmt::format("{} holds a run of terrane run: choose another folder", shown));
  }
  if (request.resume && request.overwrite) {
    throw ConfigurationError("--resume and --overwrite exclude each other: choose one");
  }
  if (held && !request.resume && !request.overwrite) {
    throw ConfigurationError(fmt::format(
        "{} already holds a calibration: --resume goes on with it, --overwrite replaces it",
        shown));
  }
}

}  // namespace

Checkpoint begin_or_resume(const Request& request, const Target& target,
                           const io::RunFolder& folder) {
  check_folder(request, folder);
  const std::string shown = folder.path().string();
  const fs::path state_file = folder.path() / kStateFile;
  Checkpoint checkpoint;
  checkpoint.question = question_of(request, target);
  checkpoint.builders = {io::this_builder()};
  if (!request.resume) return checkpoint;
  if (!fs::exists(state_file)) {
    throw ConfigurationError(fmt::format("--resume: {} holds no calibration to go on with", shown));
  }
  Checkpoint before = read_checkpoint(state_file);
  if (before.question != checkpoint.question) {
    throw ConfigurationError(
        fmt::format("--resume: the configuration or the target changed; --overwrite calibrates "
                    "{} again",
                    shown));
  }
  take_over(request, before.builders, shown);
  // One that ran out of iterations may have been given more.
  FitState& state = before.state;
  if (state.ended && !state.converged && state.iteration < request.settings.iterations) {
    state.ended = false;
    if (!before.starts.empty()) before.starts.pop_back();
  }
  return before;
}

}  // namespace geo::calibration
