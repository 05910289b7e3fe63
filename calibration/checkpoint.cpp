#include "calibration/checkpoint.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "geo/core/error.hpp"
#include "geo/io/config/config.hpp"
#include "geo/io/files/atomic_file.hpp"

namespace geo::calibration {
namespace {

using nlohmann::json;

std::vector<double> as_list(const Eigen::VectorXd& x) { return {x.data(), x.data() + x.size()}; }
Eigen::VectorXd as_vector(const std::vector<double>& list) {
  return Eigen::Map<const Eigen::VectorXd>(list.data(), Eigen::Index(list.size()));
}

json to_json(const Iteration& i) {
  return {{"start", i.start},     {"number", i.number},
          {"cost", i.cost},       {"wasserstein_m", i.wasserstein_m},
          {"step", i.step},       {"accepted", i.accepted},
          {"seconds", i.seconds}, {"values", i.values}};
}
Iteration iteration_from(const json& j) {
  return {j.at("start"), j.at("number"),   j.at("cost"),    j.at("wasserstein_m"),
          j.at("step"),  j.at("accepted"), j.at("seconds"), j.at("values")};
}
json to_json(const io::Builder& builder) {
  return {{"version", builder.version}, {"commit", builder.commit}, {"build", builder.id}};
}
io::Builder builder_from(const json& j) { return {j.at("version"), j.at("commit"), j.at("build")}; }
json to_json(const Start& s) {
  return {{"from", s.from},
          {"to", s.to},
          {"cost", s.cost},
          {"converged", s.converged},
          {"iterations", s.iterations},
          {"ending", s.ending}};
}
Start start_from(const json& j) {
  return {j.at("from"),      j.at("to"),         j.at("cost"),
          j.at("converged"), j.at("iterations"), j.at("ending")};
}

}  // namespace

void write_checkpoint(const Checkpoint& c, const std::filesystem::path& file) {
  json all{{"question", c.question}, {"seconds", c.seconds}};
  all["written_by"] = json::array();
  for (const io::Builder& builder : c.builders) all["written_by"].push_back(to_json(builder));
  all["starts"] = json::array();
  for (const Start& start : c.starts) all["starts"].push_back(to_json(start));
  all["iterations"] = json::array();
  for (const Iteration& iteration : c.iterations) all["iterations"].push_back(to_json(iteration));
  const FitState& s = c.state;
  all["state"] = {{"x", as_list(s.x)},  {"probed", as_list(s.probed)},
                  {"probes", s.probes}, {"polishes", s.polishes},
                  {"cost", s.cost},     {"distance_m", s.distance_m},
                  {"radius", s.radius}, {"iteration", s.iteration},
                  {"stalls", s.stalls}, {"begun", s.begun},
                  {"ended", s.ended},   {"converged", s.converged},
                  {"ending", s.ending}};
  io::write_text_file(file, all.dump(1) + "\n");
}

Checkpoint read_checkpoint(const std::filesystem::path& file) {
  try {
    const json all = json::parse(io::read_text(file));
    Checkpoint c;
    c.question = all.at("question");
    c.seconds = all.at("seconds");
    for (const json& builder : all.value("written_by", json::array())) {
      c.builders.push_back(builder_from(builder));
    }
    for (const json& start : all.at("starts")) c.starts.push_back(start_from(start));
    for (const json& j : all.at("iterations")) c.iterations.push_back(iteration_from(j));
    const json& s = all.at("state");
    c.state.x = as_vector(s.at("x").get<std::vector<double>>());
    c.state.probed = as_vector(s.at("probed").get<std::vector<double>>());
    c.state.probes = s.at("probes");
    c.state.polishes = s.at("polishes");
    c.state.cost = s.at("cost");
    c.state.distance_m = s.at("distance_m");
    c.state.radius = s.at("radius");
    c.state.iteration = s.at("iteration");
    c.state.stalls = s.at("stalls");
    c.state.begun = s.at("begun");
    c.state.ended = s.at("ended");
    c.state.converged = s.at("converged");
    c.state.ending = s.at("ending");
    return c;
  } catch (const json::exception&) {
    throw InputError(
        fmt::format("{}: is no state of a calibration; --overwrite begins anew", file.string()));
  }
}

}  // namespace geo::calibration
