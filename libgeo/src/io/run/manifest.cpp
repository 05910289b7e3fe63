#include "geo/io/run/manifest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "geo/core/error.hpp"
#include "geo/io/files/atomic_file.hpp"
#include "geo/io/files/build_info.hpp"

namespace geo::io {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kPathKey = "path_deg";

/// JSON has no NaN: null stands for it.
double number_or_nan(const Json& json) {
  return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

/// A whole number that fits; JSON libraries convert any number, and what does not fit to anything.
template <class Whole>
Whole whole_number(const Json& json) {
  if (json.is_number_unsigned() && std::in_range<Whole>(json.get<std::uint64_t>())) {
    return static_cast<Whole>(json.get<std::uint64_t>());
  }
  if (json.is_number_integer() && std::in_range<Whole>(json.get<std::int64_t>())) {
    return static_cast<Whole>(json.get<std::int64_t>());
  }
  throw InputError(fmt::format("{} is no whole number that fits", json.dump()));
}

Json to_json(const FieldRecord& field) {
  return {{"units", field.units}, {"min", field.min},         {"mean", field.mean},
          {"max", field.max},     {"missing", field.missing}, {"digest", field.digest}};
}

Json to_json(const EventRecord& event) {
  Json json{{"number", event.number}, {"kind", event.kind}, {"name", event.name}};
  for (const auto& [name, value] : event.figures) json[name] = value;
  if (!event.path.empty()) {
    json[kPathKey] = Json::array();
    for (const Centre& place : event.path) {
      json[kPathKey].push_back({place.latitude_deg, place.longitude_deg});
    }
  }
  return json;
}

Json to_json(const StageRecord& stage) {
  Json fields = Json::object();
  for (const FieldRecord& field : stage.fields) fields[field.name] = to_json(field);
  Json json{{"name", stage.name}, {"seconds", stage.seconds}, {"budget", stage.budget}};
  if (stage.own_grid) json["own_grid"] = true;
  if (stage.on_command) json["on_command"] = true;
  if (!stage.events.empty()) {
    json["events"] = Json::array();
    for (const EventRecord& event : stage.events) json["events"].push_back(to_json(event));
  }
  json["warnings"] = stage.warnings;
  json["files"] = stage.files;
  json["file_digests"] = stage.file_digests;
  json["written_by"] = {{"version", stage.builder.version},
                        {"commit", stage.builder.commit},
                        {"build", stage.builder.id}};
  json["fields"] = fields;
  return json;
}

FieldRecord field_from(const std::string& name, const Json& json) {
  return {name,
          json.at("units").get<std::string>(),
          number_or_nan(json.at("min")),
          number_or_nan(json.at("mean")),
          number_or_nan(json.at("max")),
          whole_number<std::int64_t>(json.at("missing")),
          json.at("digest").get<std::string>()};
}

EventRecord event_from(const Json& json) {
  EventRecord event;
  event.number = whole_number<decltype(event.number)>(json.at("number"));
  json.at("kind").get_to(event.kind);
  json.at("name").get_to(event.name);
  for (const auto& [name, value] : json.items()) {
    if (value.is_number() && name != "number")
      event.figures.emplace_back(name, value.get<double>());
  }
  if (const auto path = json.find(kPathKey); path != json.end()) {
    for (const Json& place : *path) {
      event.path.push_back({place.at(0).get<double>(), place.at(1).get<double>()});
    }
  }
  return event;
}

StageRecord stage_from(const Json& json) {
  StageRecord stage;
  json.at("name").get_to(stage.name);
  stage.own_grid = json.value("own_grid", false);
  stage.on_command = json.value("on_command", false);
  json.at("seconds").get_to(stage.seconds);
  for (const auto& [name, value] : json.at("budget").items()) {
    stage.budget[name] = number_or_nan(value);
  }
  if (const auto events = json.find("events"); events != json.end()) {
    for (const Json& event : *events) stage.events.push_back(event_from(event));
  }
  json.at("warnings").get_to(stage.warnings);
  json.at("files").get_to(stage.files);
  // Manifests of earlier versions have neither.
  if (const auto digests = json.find("file_digests"); digests != json.end()) {
    digests->get_to(stage.file_digests);
  }
  if (const auto builder = json.find("written_by"); builder != json.end()) {
    builder->at("version").get_to(stage.builder.version);
    builder->at("commit").get_to(stage.builder.commit);
    builder->at("build").get_to(stage.builder.id);
  }
  for (const auto& [name, field] : json.at("fields").items()) {
    stage.fields.push_back(field_from(name, field));
  }
  return stage;
}

Manifest manifest_from(const Json& json) {
  Manifest manifest;
  json.at("version").get_to(manifest.version);
  json.at("commit").get_to(manifest.commit);
  json.at("compiler").get_to(manifest.compiler);
  manifest.build = json.value("build", "");
  manifest.allowed = json.value("allowed", manifest.allowed);
  manifest.files = json.value("files", manifest.files);
  json.at("libraries").get_to(manifest.libraries);
  manifest.seed = whole_number<decltype(manifest.seed)>(json.at("seed"));
  manifest.threads = whole_number<decltype(manifest.threads)>(json.at("threads"));
  json.at("config_digest").get_to(manifest.config_digest);
  json.at("complete").get_to(manifest.complete);
  for (const Json& stage : json.at("stages")) manifest.stages.push_back(stage_from(stage));
  return manifest;
}

}  // namespace

void write_manifest(const std::filesystem::path& path, const Manifest& manifest) {
  Json stages = Json::array();
  for (const StageRecord& stage : manifest.stages) stages.push_back(to_json(stage));
  const Json json{{"version", manifest.version},
                  {"commit", manifest.commit},
                  {"compiler", manifest.compiler},
                  {"build", manifest.build},
                  {"allowed", manifest.allowed},
                  {"libraries", manifest.libraries},
                  {"seed", manifest.seed},
                  {"threads", manifest.threads},
                  {"config_digest", manifest.config_digest},
                  {"complete", manifest.complete},
                  {"files", manifest.files},
                  {"stages", stages}};
  // Bytes that are no UTF-8 (in a path, say) are replaced: no reason to lose a finished run.
  write_text_file(path, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

Manifest read_manifest(const std::filesystem::path& path) {
  std::ifstream stream(path);
  if (!stream) {
    throw IoError(
        fmt::format("cannot read {}: {}", path.string(), std::generic_category().message(errno)));
  }
  std::string reason;
  try {
    return manifest_from(Json::parse(stream));
  } catch (const Json::exception& error) {
    reason = error.what();
  } catch (const InputError& error) {
    reason = error.what();
  }
  throw InputError(
      fmt::format("{}: no manifest of this version of terrane ({})", path.string(), reason));
}

std::string disagreement(const StageRecord& record, const Snapshot& file) {
  const bool is_further = record.own_grid && record.name.starts_with(file.stage + "-");
  if (record.name != file.stage && !is_further) {
    return fmt::format("stage is {}, manifest says {}", file.stage, record.name);
  }
  for (const FieldRecord& field : record.fields) {
    const auto at = std::find_if(file.fields.begin(), file.fields.end(), [&](const auto& entry) {
      return entry.first->name == field.name;
    });
    if (at == file.fields.end()) return field.name + ": missing in the file";
    const std::string difference = disagreement(record, *at->first, *at->second);
    if (!difference.empty()) return difference;
  }
  if (record.fields.size() != file.fields.size()) return "file holds fields the manifest lacks";
  return {};
}

std::string disagreement(const StageRecord& record, const FieldSpec& spec, const Values& values) {
  for (const FieldRecord& field : record.fields) {
    if (field.name != spec.name) continue;
    return digest_of(values) == field.digest ? "" : field.name + ": digest differs";
  }
  return fmt::format("{}: not in the manifest", spec.name);
}

std::string Builder::words_beside(const Builder& other) const {
  if (version != other.version) return version;
  return fmt::format("{} of commit {}, build {}", version, commit,
                     id.empty() ? "unknown" : id.substr(0, 12));
}

Builder this_builder() {
  const BuildInfo& build = build_info();
  return {build.version, build.commit, build.id};
}

Builder Manifest::builder_of(const StageRecord& record) const {
  const bool is_told = !record.builder.version.empty();
  return is_told ? record.builder : Builder{version, commit, build};
}

namespace {
/// The word by which the manifest keeps that stages are of several builds.
constexpr std::string_view kOtherBuild = "other-build";
}  // namespace

std::optional<Builder> Manifest::other_builder() const {
  const Builder here = this_builder(), last{version, commit, build};
  if (last != here) return last;
  for (const StageRecord& record : stages) {
    if (const Builder builder = builder_of(record); builder != here) return builder;
  }
  return {};
}

void Manifest::check_builders(std::string_view asked_by, const std::filesystem::path& folder,
                              bool allow, std::string_view otherwise) {
  if (version.empty()) return;
  const auto other = other_builder();
  const Builder here = this_builder();
  const bool was_allowed = std::find(allowed.begin(), allowed.end(), kOtherBuild) != allowed.end();
  if (!other || (was_allowed && Builder{version, commit, build} == here)) return;
  if (!allow) {
    throw ConfigurationError(
        fmt::format("{}: {} was made by terrane {}, this is {}; --allow-other-build goes on "
                    "nevertheless, {}",
                    asked_by, folder.string(), other->words_beside(here), here.words_beside(*other),
                    otherwise));
  }
  if (!was_allowed) allowed.emplace_back(kOtherBuild);
}

std::string Manifest::free_name(std::string_view stage, int first) const {
  for (int number = first;; ++number) {
    const std::string name = number <= 1 ? std::string(stage) : fmt::format("{}-{}", stage, number);
    const bool taken = std::any_of(stages.begin(), stages.end(),
                                   [&](const StageRecord& record) { return record.name == name; });
    if (!taken) return name;
  }
}

void StageRecord::list(const std::filesystem::path& folder, const std::string& file) {
  if (std::find(files.begin(), files.end(), file) == files.end()) files.push_back(file);
  file_digests[file] = digest_of_file(folder / file);
}

std::string netcdf_of(const StageRecord& record) {
  for (const std::string& file : record.files) {
    if (std::filesystem::path(file).extension() == ".nc") return file;
  }
  throw InputError(fmt::format("manifest.json: stage {} lists no NetCDF file", record.name));
}

}  // namespace geo::io
