#include "calibration/report.hpp"

#include "calibration/report_curves.hpp"
#include "calibration/report_json.hpp"
#include "calibration/report_page.hpp"
#include "geo/io/atomic_file.hpp"
#include "geo/io/config.hpp"

namespace geo::calibration {

void write_results(const Result& result, std::span<const Parameter> parameters,
                   std::span<const Event> events, const std::filesystem::path& folder) {
  const std::string heading =
      "Fitted to " + result.target_name + " by terrane calibrate; makes a planet with terrane run";
  io::write_text_file(folder / "fitted.toml", io::write_config(parameters, heading, events));
  io::write_text_file(folder / "hypsometry.csv", curves_csv(result));
  io::write_chart(folder / "hypsometry.png", curves_chart(result));
  io::write_text_file(folder / "report.html", page_text(result));
  // Last, as it says that all is there.
  io::write_text_file(folder / "calibration.json", json_text(result));
}

}  // namespace geo::calibration
