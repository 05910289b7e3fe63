#include "calibration/report/report_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "calibration/report/report_curves.hpp"
#include "calibration/report/report_markup.hpp"
#include "calibration/report/report_pictures.hpp"
#include "calibration/report/report_tables.hpp"
#include "calibration/report/report_words.hpp"
#include "geo/io/files/build_info.hpp"
#include "geo/io/files/embedded_data.hpp"
#include "geo/io/files/source_date.hpp"
#include "geo/io/run/manifest.hpp"

namespace geo::calibration {
namespace {

void add_head(pugi::xml_node html, const std::string& title) {
  auto head = add(html, "head");
  add(head, "meta", {}, {{"charset", "utf-8"}});
  add(head, "meta", {}, {{"name", "viewport"}, {"content", "width=device-width, initial-scale=1"}});
  add(head, "title", title);
  add(head, "style",
      std::string(io::embedded_file("report/report.css")) +
          std::string(io::embedded_file("report/calibration.css")));
}

void add_introduction(pugi::xml_node main, const Result& result) {
  const auto shape = result.objective == "each" ? "the curve of every seed by itself"
                                                : "the mean of the curves of all seeds";
  add(main, "p",
      fmt::format("{} parameters of {} fitted to {} at {} cells, over seeds {}: {}. {}",
                  result.parameters.size(), result.preset_or_config, result.target_name,
                  result.grid, seeds_in_words(result.fitted), shape, sentence(result.ending)),
      {{"class", "lead"}});
}

void add_warnings(pugi::xml_node main, const Result& result) {
  std::vector<std::string> lines;
  for (const auto& warning : result.warnings) lines.push_back(sentence(warning));
  if (!result.converged) {
    lines.push_back(
        "As the fit did not converge, this is the best that was found, and its errors "
        "cannot be relied upon.");
  }
  if (lines.empty()) return;
  auto box = add(main, "section", {}, {{"class", "warnings"}, {"role", "note"}});
  add(box, "h2", lines.size() == 1 ? "One warning" : fmt::format("{} warnings", lines.size()));
  auto list = add(box, "ul");
  for (const auto& line : lines) add(list, "li", line);
}

void add_figure_of_merit(pugi::xml_node list, const std::string& value, const std::string& words,
                         const char* style = "") {
  auto item = add(list, "li");
  auto strong = add(item, "strong", value);
  if (style[0] != '\0') strong.append_attribute("class") = style;
  item.append_child(pugi::node_pcdata).set_value((" " + words).c_str());
}

std::string change(double before, double after) {
  return fmt::format("{} → {} m", shown(before), shown(after));
}

void add_figures(pugi::xml_node main, const Result& result) {
  auto list = add(main, "ul", {}, {{"class", "figures"}});
  add_figure_of_merit(list, result.converged ? "✓ yes" : "✗ no", "converged",
                      result.converged ? "good" : "bad");
  add_figure_of_merit(list, change(mean_before_m(result.fitted), mean_after_m(result.fitted)),
                      "distance to the target, mean of the fitted seeds");
  if (!result.held_out.empty()) {
    add_figure_of_merit(list, change(mean_before_m(result.held_out), mean_after_m(result.held_out)),
                        "the same on seeds held out");
  }
  if (!result.held_out_resolution.empty()) {
    add_figure_of_merit(
        list,
        change(mean_before_m(result.held_out_resolution), mean_after_m(result.held_out_resolution)),
        fmt::format("the same at {} cells", result.held_out_grid));
  }
  add_figure_of_merit(list,
                      fmt::format("{} → {}", shown(result.cost_before), shown(result.cost_after)),
                      "cost, half the sum of squares");
  add_figure_of_merit(list, shown(result.condition), "condition, strongest to weakest direction");
}

void add_curves(pugi::xml_node main, const Result& result) {
  add(main, "h2", "Curve");
  for (const auto& note : curves_chart(result).notes) add(main, "p", note);
  add_curve_picture(main, result);
}

void add_parameters(pugi::xml_node main, const Result& result) {
  add(main, "h2", "Parameters");
  add(main, "p",
      fmt::format("The standard error is that of a straight-line model with the scatter of the "
                  "residuals ({} m for a quantile), or with the errors to which the target says "
                  "that it is known, where those are larger. The spread of seeds is how far the "
                  "fitted value would move with other seeds; where it is the larger, believe it.",
                  shown(result.noise_m)));
  add_parameter_table(main, result);
}

void add_directions(pugi::xml_node main, const Result& result) {
  if (result.directions.empty()) return;
  add(main, "h2", "What the data determine");
  add(main, "p", weakest_in_words(result));
  if (!result.correlation.empty()) add_correlation_picture(main, result);
  add_direction_picture(main, result);
  add_direction_table(main, result);
}

void add_profiles(pugi::xml_node main, const Result& result) {
  if (result.profiles.empty()) return;
  add(main, "h2", "Profiles");
  add(main, "p",
      "The cost at values of each, with all other parameters fitted again at every one of them; "
      "rivers, shores and the cells of quantiles stay where they lie at the minimum. Dashed lines "
      "stand one standard error to either side of the fitted value. A curve that is flat towards "
      "one side gives no bound there, and one that is no parabola says that the standard error is "
      "too simple.");
  add_profile_pictures(main, result);
}

void add_misfits(pugi::xml_node main, const Result& result) {
  add(main, "h2", "Misfit of each planet");
  add(main, "p",
      "Wasserstein-1 distance between the elevations of one planet and the target, by area; mean "
      "and standard deviation over the planets. Seeds held out were not seen by the fit. Curves of "
      "different seeds lie apart by their standard deviation at equal rank, mean over the area.");
  add_misfit_tables(main, result);
}

void add_residuals(pugi::xml_node main, const Result& result) {
  if (result.residuals.empty()) return;
  add(main, "h2", "Residuals");
  add_residual_picture(main, result);
  add_residual_tables(main, result);
}

void add_convergence(pugi::xml_node main, const Result& result) {
  add(main, "h2", "Convergence");
  add_convergence_picture(main, result);
  if (!result.starts.empty()) add_start_table(main, result);
  if (!result.iterations.empty()) add_iteration_table(main, result);
}

void add_provenance(pugi::xml_node main, const Result& result) {
  add(main, "h2", "Effort and provenance");
  auto list = add(main, "dl");
  const auto entry = [&](const char* name, const std::string& value) {
    add(list, "dt", name);
    add(list, "dd", value);
  };
  const bool timed = !io::time_is_given();
  const auto times = [&](int count, double seconds) {
    return timed ? fmt::format("{}, {} s each", count, shown(seconds)) : fmt::format("{}", count);
  };
  entry("target", result.target_name);
  entry("configuration", result.preset_or_config);
  entry("forward runs", times(result.forward_runs, result.seconds_per_forward));
  entry("Jacobians", times(result.jacobians, result.seconds_per_jacobian));
  if (timed) {
    entry("time of the fit", fmt::format("{} s", shown(result.seconds)));
    if (!result.profiles.empty()) {
      entry("time of the profiles", fmt::format("{} s", shown(result.profile_seconds)));
    }
  }
  const auto& build = io::build_info();
  entry("terrane", fmt::format("{} (commit {}, {})", build.version, build.commit, build.compiler));
  std::string libraries;
  for (const auto& [name, version] : io::library_versions()) {
    libraries += fmt::format("{}{} {}", libraries.empty() ? "" : ", ", name, version);
  }
  entry("libraries", libraries);
}

}  // namespace

std::string page_text(const Result& result) {
  const std::string title = "terrane: fit to " + result.target_name;
  pugi::xml_document document;
  document.append_child(pugi::node_doctype).set_value("html");
  auto html = add(document, "html", {}, {{"lang", "en"}});
  add_head(html, title);
  auto main = add(add(html, "body"), "main");
  add(main, "h1", title);
  add_introduction(main, result);
  add_warnings(main, result);
  add_figures(main, result);
  add_curves(main, result);
  add_parameters(main, result);
  add_directions(main, result);
  add_profiles(main, result);
  add_misfits(main, result);
  add_residuals(main, result);
  add_convergence(main, result);
  add_provenance(main, result);
  std::ostringstream text;
  // As HTML wants it: no XML declaration, and no indentation that text would show.
  document.save(text, "", pugi::format_raw | pugi::format_no_declaration, pugi::encoding_utf8);
  return text.str() + "\n";
}

}  // namespace geo::calibration
