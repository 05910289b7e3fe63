#include "sweep.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "apps/child_process.hpp"
#include "apps/log.hpp"
#include "apps/signals.hpp"
#include "geo/core/error.hpp"
#include "geo/io/files/atomic_file.hpp"
#include "geo/io/input/table.hpp"

namespace terrane {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

constexpr std::string_view kNameColumn = "run";
constexpr std::string_view kSeed = "run.seed";

/// "1..1000" or "3,5,8", each once and in that order.
std::vector<std::int64_t> seeds_of(const std::string& text) {
  const auto refuse = [&](std::string_view word) {
    throw geo::ConfigurationError(fmt::format(
        "--seeds {}: {}: must be seeds with commas between, or FIRST..LAST", text, word));
  };
  const auto number = [&](std::string_view word) {
    std::int64_t value = 0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || stop != word.data() + word.size() || value < 0) refuse(word);
    return value;
  };
  constexpr std::int64_t kMost = 1'000'000;
  std::vector<std::int64_t> seeds;
  std::stringstream words(text);
  for (std::string word; std::getline(words, word, ',');) {
    const auto dots = word.find("..");
    const std::int64_t first = number(word.substr(0, dots));
    const std::int64_t last =
        dots == std::string::npos ? first : number(std::string_view(word).substr(dots + 2));
    if (last < first || last - first >= kMost) refuse(word);
    for (std::int64_t seed = first; seed <= last; ++seed) seeds.push_back(seed);
  }
  if (seeds.empty()) refuse("empty");
  return seeds;
}

/// Names become names of folders.
void check_name(const std::string& name) {
  const bool is_plain = std::all_of(name.begin(), name.end(), [](unsigned char letter) {
    return std::isalnum(letter) != 0 || letter == '-' || letter == '_' || letter == '.';
  });
  if (!name.empty() && is_plain && name.front() != '.') return;
  throw geo::ConfigurationError(
      fmt::format("sweep: run \"{}\": must be letters, digits, - and _: it names a folder", name));
}

std::vector<SweepRun> runs_of_table(const fs::path& path) {
  const auto table = geo::io::Table::of_file(path);
  if (table.rows() == 0) throw geo::InputError(fmt::format("{}: has no row", path.string()));
  std::vector<SweepRun> runs;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    SweepRun run{.name = fmt::format("row-{:04}", row + 1), .values = {}};
    for (std::size_t column = 0; column < table.header().size(); ++column) {
      const std::string& name = table.header()[column];
      if (name == kNameColumn) {
        run.name = table.text(row, column);
      } else {
        run.values.emplace_back(name, table.text(row, column));
      }
    }
    runs.push_back(std::move(run));
  }
  return runs;
}

/// What is kept of a run that is done: its values, how it ended, its figures.
ordered_json values_of(const SweepRequest& request, const SweepRun& run) {
  ordered_json values{{"preset", request.sources.preset},
                      {"config", request.sources.config},
                      {"dem", request.sources.dem},
                      {"grid", request.sources.grid},
                      {"to", request.to},
                      {"set", request.sources.assignments}};
  for (const auto& [name, text] : run.values) values["values"][name] = text;
  return values;
}

/// The state of one run of the sweep.
struct Job {
  const SweepRun* run = nullptr;
  enum class Step { run, score } step = Step::run;
  pid_t process = -1;
  Clock::time_point start;
};

/// One line of the table.
struct Outcome {
  int exit_code = 0;
  double seconds = 0.0;
  std::string error;  ///< last line of its log
  int figures = 0, within = 0;
  std::vector<std::pair<std::string, double>> values;
};

std::string quoted(const std::string& cell) {
  if (cell.find_first_of(",\"\n") == std::string::npos) return cell;
  std::string text = "\"";
  for (const char letter : cell) {
    if (letter == '"') text += letter;
    text += letter;
  }
  text += '"';
  return text;
}

std::string without(std::string_view prefix, std::string_view text) {
  if (text.starts_with(prefix)) text.remove_prefix(prefix.size());
  return std::string(text);
}

std::string last_line_of(const fs::path& path) {
  std::ifstream file(path);
  std::string last;
  for (std::string line; std::getline(file, line);) {
    if (!line.empty()) last = line;
  }
  return without("terrane: error: ", last);
}

class Sweep {
 public:
  explicit Sweep(const SweepRequest& request) : request_(request) {}

  void run() {
    fs::create_directories(logs());
    take_done_runs();
    write_table();
    const int all = static_cast<int>(request_.runs.size());
    for (const SweepRun& run : request_.runs) {
      if (outcomes_.contains(run.name)) continue;
      while (static_cast<int>(jobs_.size()) >= request_.jobs) wait_for_one();
      if (stop_requested()) break;
      start_run(run);
    }
    while (!jobs_.empty()) wait_for_one();
    if (stop_requested()) throw geo::Interrupted();
    log_info(fmt::format("{} of {} runs are in {}", outcomes_.size(), all,
                         (request_.folder / "sweep.csv").string()));
    throw_first_failure();
  }

 private:
  [[nodiscard]] fs::path logs() const { return request_.folder / "logs"; }
  [[nodiscard]] fs::path log_of(const SweepRun& run) const { return logs() / (run.name + ".log"); }
  [[nodiscard]] fs::path folder_of(const SweepRun& run) const { return request_.folder / run.name; }
  [[nodiscard]] fs::path record_of(const SweepRun& run) const {
    return logs() / (run.name + ".json");
  }
  [[nodiscard]] fs::path score_of(const SweepRun& run) const {
    return logs() / (run.name + ".score.json");
  }

  void take_done_runs() {
    for (const SweepRun& run : request_.runs) {
      if (request_.overwrite) {
        for (const fs::path& file : {record_of(run), log_of(run), score_of(run)}) fs::remove(file);
        continue;
      }
      std::ifstream file(record_of(run));
      if (!file) continue;
      const auto record = ordered_json::parse(file, nullptr, false);
      if (record.is_discarded() || !record.contains("of")) continue;  // written by nobody: again
      if (record["of"] != values_of(request_, run)) {
        throw geo::ConfigurationError(
            fmt::format("{} holds run {} of another configuration: --overwrite replaces it",
                        request_.folder.string(), run.name));
      }
      if (record.value("exit", 1) != 0) continue;
      outcomes_[run.name] = outcome_of(record);
    }
  }

  static Outcome outcome_of(const ordered_json& record) {
    Outcome outcome{.seconds = record.value("seconds", 0.0), .error = {}, .values = {}};
    outcome.figures = record.value("figures", 0);
    outcome.within = record.value("within", 0);
    for (const auto& [name, value] : record["score"].items()) {
      if (value.is_number()) outcome.values.emplace_back(name, value.get<double>());
    }
    return outcome;
  }

  void start_run(const SweepRun& run) {
    const ConfigurationSources& sources = request_.sources;
    std::vector<std::string> words{"run"};
    const auto add = [&](const char* option, const std::string& value) {
      if (!value.empty()) words.insert(words.end(), {option, value});
    };
    if (!sources.config.empty()) words.push_back(sources.config);
    add("--preset", sources.preset);
    add("--dem", sources.dem);
    add("--grid", sources.grid);
    add("--to", request_.to);
    for (const std::string& assignment : sources.assignments) add("--set", assignment);
    for (const auto& [name, text] : run.values) add("--set", fmt::format("{}={}", name, text));
    add("-o", folder_of(run).string());
    add("--threads", std::to_string(request_.threads));
    words.emplace_back("--quiet");
    if (!request_.all_files) words.insert(words.end(), {"--no-vtk", "--no-maps"});
    if (request_.overwrite) {
      words.emplace_back("--overwrite");
    } else if (fs::exists(folder_of(run) / "manifest.json")) {
      words.emplace_back("--resume");
    }
    fs::remove(log_of(run));
    tell("run-begins", run, {});
    jobs_.push_back(
        {&run, Job::Step::run, start_this_program(words, log_of(run), log_of(run)), Clock::now()});
  }

  void wait_for_one() {
    std::vector<pid_t> children;
    for (const Job& job : jobs_) children.push_back(job.process);
    const ChildEnd end = wait_for_child(children);
    const auto at = std::find_if(jobs_.begin(), jobs_.end(),
                                 [&](const Job& job) { return job.process == end.process; });
    Job job = *at;
    jobs_.erase(at);
    if (stop_requested()) return;
    if (job.step == Job::Step::run && end.exit_code == 0) {
      fs::remove(score_of(*job.run));
      job.step = Job::Step::score;
      job.process = start_this_program({"score", "--json", folder_of(*job.run).string()},
                                       score_of(*job.run), log_of(*job.run));
      jobs_.push_back(job);
      return;
    }
    // A run that ends before there is an elevation has nothing to be scored.
    finish(job, job.step == Job::Step::run ? end.exit_code : 0);
  }

  void finish(const Job& job, int exit_code) {
    const SweepRun& run = *job.run;
    ordered_json record{
        {"of", values_of(request_, run)},
        {"exit", exit_code},
        {"seconds", std::chrono::duration<double>(Clock::now() - job.start).count()},
        {"score", ordered_json::object()}};
    std::ifstream file(score_of(run));
    const auto score = exit_code == 0 ? ordered_json::parse(file, nullptr, false) : ordered_json();
    if (score.is_object() && score.contains("figures")) {
      for (const auto& figure : score["figures"]) {
        record["score"][figure["name"].get<std::string>()] = figure["value"];
      }
      record["figures"] = score["totals"]["figures"];
      record["within"] = score["totals"]["within"];
    }
    if (exit_code == 0 && request_.scores_only) fs::remove_all(folder_of(run));
    geo::io::write_text_file(record_of(run), record.dump(1) + "\n");
    Outcome outcome = outcome_of(record);
    outcome.exit_code = exit_code;
    if (exit_code != 0) outcome.error = last_line_of(log_of(run));
    fs::remove(score_of(run));
    outcomes_[run.name] = std::move(outcome);
    write_table();
    tell("run-ends", run, &outcomes_[run.name]);
  }

  void tell(const char* event, const SweepRun& run, const Outcome* outcome) const {
    const auto done = outcomes_.size(), all = request_.runs.size();
    if (request_.json_progress) {
      ordered_json line{{"event", event}, {"run", run.name}, {"done", done}, {"of", all}};
      if (outcome != nullptr) {
        line["exit"] = outcome->exit_code;
        line["seconds"] = outcome->seconds;
        if (!outcome->error.empty()) line["error"] = outcome->error;
      }
      fmt::print(stderr, "{}\n", line.dump(-1, ' ', false, ordered_json::error_handler_t::replace));
    } else if (outcome != nullptr && outcome->exit_code != 0) {
      log_warning(fmt::format("{}: {}", run.name, outcome->error));
    } else if (outcome != nullptr) {
      log_info(fmt::format("{:>{}}/{}  {:<16} {:.1f} s  {} of {} figures", done,
                           std::to_string(all).size(), all, run.name, outcome->seconds,
                           outcome->within, outcome->figures));
    }
  }

  /// A row for each run that is done, in the order that was asked for.
  void write_table() const {
    std::vector<std::string> parameters, figures;
    std::set<std::string> known;
    for (const SweepRun& run : request_.runs) {
      for (const auto& [name, text] : run.values) {
        if (known.insert("parameter " + name).second) parameters.push_back(name);
      }
      const auto at = outcomes_.find(run.name);
      if (at == outcomes_.end()) continue;
      for (const auto& [name, value] : at->second.values) {
        if (known.insert("figure " + name).second) figures.push_back(name);
      }
    }
    std::string text = "run";
    for (const std::string& name : parameters) text += ',' + name;
    text += ",exit_code,seconds,figures,within";
    for (const std::string& name : figures) text += ',' + name;
    text += '\n';
    for (const SweepRun& run : request_.runs) {
      const auto at = outcomes_.find(run.name);
      if (at != outcomes_.end()) text += row_of(run, at->second, parameters, figures);
    }
    geo::io::write_text_file(request_.folder / "sweep.csv", text);
  }

  static std::string row_of(const SweepRun& run, const Outcome& outcome,
                            const std::vector<std::string>& parameters,
                            const std::vector<std::string>& figures) {
    const std::map<std::string, std::string> values(run.values.begin(), run.values.end());
    const std::map<std::string, double> scores(outcome.values.begin(), outcome.values.end());
    std::string text = run.name;
    for (const std::string& name : parameters) {
      const auto at = values.find(name);
      text += ',' + (at == values.end() ? std::string() : quoted(at->second));
    }
    text += fmt::format(",{},{:.2f},{},{}", outcome.exit_code, outcome.seconds, outcome.figures,
                        outcome.within);
    for (const std::string& name : figures) {
      const auto at = scores.find(name);
      text += at == scores.end() ? std::string(",") : fmt::format(",{}", at->second);
    }
    return text + '\n';
  }

  void throw_first_failure() const {
    int failed = 0;
    const SweepRun* first = nullptr;
    for (const SweepRun& run : request_.runs) {
      if (outcomes_.at(run.name).exit_code == 0) continue;
      if (first == nullptr) first = &run;
      ++failed;
    }
    if (first == nullptr) return;
    const Outcome& outcome = outcomes_.at(first->name);
    throw geo::Error(outcome.exit_code < 128 ? static_cast<geo::ErrorKind>(outcome.exit_code)
                                             : geo::ErrorKind::bug,
                     fmt::format("{} of {} runs failed, the first was {}: {}", failed,
                                 request_.runs.size(), first->name, outcome.error));
  }

  const SweepRequest& request_;
  std::vector<Job> jobs_;
  std::map<std::string, Outcome> outcomes_;
};

}  // namespace

std::vector<SweepRun> runs_of(const fs::path& table, const std::string& seeds) {
  std::vector<SweepRun> runs;
  if (!table.empty()) runs = runs_of_table(table);
  if (!seeds.empty()) {
    const auto numbers = seeds_of(seeds);
    const auto digits = std::to_string(*std::max_element(numbers.begin(), numbers.end())).size();
    if (runs.empty()) runs.push_back({});
    std::vector<SweepRun> seeded;
    for (const SweepRun& run : runs) {
      for (const std::int64_t seed : numbers) {
        SweepRun one = run;
        one.name += fmt::format("{}seed-{:0{}}", run.name.empty() ? "" : "-", seed, digits);
        one.values.emplace_back(kSeed, std::to_string(seed));
        seeded.push_back(std::move(one));
      }
    }
    runs = std::move(seeded);
  }
  std::set<std::string> names;
  for (const SweepRun& run : runs) {
    check_name(run.name);
    if (names.insert(run.name).second) continue;
    throw geo::ConfigurationError(fmt::format("sweep: two runs are called {}", run.name));
  }
  return runs;
}

void check_runs(const SweepRequest& request) {
  for (const SweepRun& run : request.runs) {
    ConfigurationSources sources = request.sources;
    for (const auto& [name, text] : run.values) {
      sources.assignments.push_back(fmt::format("{}={}", name, text));
    }
    try {
      Configuration configuration;
      configuration.take(sources);
    } catch (const geo::ConfigurationError& error) {
      throw geo::ConfigurationError(
          fmt::format("run {}: {}", run.name, without("--set: ", error.what())));
    }
  }
}

void sweep(const SweepRequest& request) { Sweep(request).run(); }

}  // namespace terrane
