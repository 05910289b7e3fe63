#include "calibration/report/report.hpp"

#include <fmt/format.h>

#include "calibration/report/report_curves.hpp"
#include "calibration/report/report_json.hpp"
#include "calibration/report/report_page.hpp"
#include "geo/core/error.hpp"
#include "geo/io/config/config.hpp"
#include "geo/io/files/atomic_file.hpp"

namespace geo::calibration {
namespace {

constexpr std::string_view kFitted = "fitted.toml", kCurves = "hypsometry.csv",
                           kPicture = "hypsometry.png", kPage = "report.html";

}  // namespace

void write_results(const Result& result, std::span<const Parameter> parameters,
                   std::span<const Event> events, const std::filesystem::path& folder) {
  const std::string heading =
      "Fitted to " + result.target_name + " by terrane calibrate; makes a planet with terrane run";
  io::write_text_file(folder / kFitted, io::write_config(parameters, heading, events));
  io::write_text_file(folder / kCurves, curves_csv(result));
  io::write_chart(folder / kPicture, curves_chart(result));
  io::write_text_file(folder / kPage, page_text(result));
  // Last, as it says that all is there.
  io::write_text_file(folder / kResultFile, json_text(result));
}

void remove_results(const std::filesystem::path& folder) {
  for (const std::string_view name : {kResultFile, kStateFile, kFitted, kCurves, kPicture, kPage}) {
    std::error_code failed;
    std::filesystem::remove(folder / name, failed);
    if (failed) throw IoError(fmt::format("{}: {}", (folder / name).string(), failed.message()));
  }
}

}  // namespace geo::calibration
