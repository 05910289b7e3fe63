#include <fmt/core.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <CLI/Formatter.hpp>
#include <charconv>
#include <memory>
#include <string>

#include "apps/memory_option.hpp"
#include "apps/thread_count.hpp"
#include "commands.hpp"
#include "geo/core/error.hpp"
#include "geo/io/export/export.hpp"

namespace terrane {
namespace {

/// An export as it was typed.
struct ExportOptions {
  geo::io::ExportRequest request;
  MemoryOption memory;
  std::string format, layout, range, masks, tiles, nside, exaggeration;
};

template <class Number>
Number number_of(std::string_view option, const std::string& text, std::string_view words) {
  Number number{};
  const char* const end = text.data() + text.size();
  const auto [at, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || at != end) {
    throw geo::ConfigurationError(fmt::format("{} {}: must be {}", option, text, words));
  }
  return number;
}

void write(const ExportOptions& options) {
  use_threads();
  geo::io::ExportRequest request = options.request;
  if (request.place.empty()) {
    throw geo::ConfigurationError("export: of what? Give the folder of a run or a stage file");
  }
  if (options.format.empty()) {
    throw geo::ConfigurationError(fmt::format("export: give --format, one of {}",
                                              fmt::join(geo::io::export_format_names(), ", ")));
  }
  request.format = geo::io::parse_export_format(options.format);
  if (!options.layout.empty() && options.layout != "whole" && options.layout != "cube") {
    throw geo::ConfigurationError(
        fmt::format("--layout {}: must be whole or cube", options.layout));
  }
  request.cube = options.layout == "cube";
  if (!options.tiles.empty()) {
    request.tile_samples =
        number_of<int>("--tiles", options.tiles, "the samples along an edge, such as 1009");
    if (request.tile_samples < 3) {
      throw geo::ConfigurationError(
          fmt::format("--tiles {}: must be 3 samples at least", options.tiles));
    }
  }
  if (!options.nside.empty()) {
    request.nside = number_of<int>("--nside", options.nside, "a power of two, such as 256");
    if (request.nside == 0) throw geo::ConfigurationError("--nside 0: must be a power of two");
  }
  if (!options.exaggeration.empty()) {
    request.exaggeration = number_of<double>("--exaggeration", options.exaggeration, "a number");
    if (!(request.exaggeration >= 0.0 && request.exaggeration <= 1000.0)) {
      throw geo::ConfigurationError(
          fmt::format("--exaggeration {}: must be within 0 and 1000", options.exaggeration));
    }
  }
  if (!options.range.empty()) {
    const auto comma = options.range.find(',');
    constexpr std::string_view kWords = "two numbers, such as --range=-11000,9000";
    if (comma == std::string::npos) {
      throw geo::ConfigurationError(fmt::format("--range {}: must be {}", options.range, kWords));
    }
    request.range = {number_of<double>("--range", options.range.substr(0, comma), kWords),
                     number_of<double>("--range", options.range.substr(comma + 1), kWords)};
  }
  for (std::size_t from = 0; from < options.masks.size();) {
    const std::size_t to = std::min(options.masks.find(',', from), options.masks.size());
    request.masks.push_back(options.masks.substr(from, to - from));
    from = to + 1;
  }
  const auto cap = options.memory.cap(".");
  for (const auto& path : geo::io::export_field(request)) fmt::print("{}\n", path.string());
}

}  // namespace

void add_export_command(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand(
      "export", "Writes a planet or an island for engines, GIS, Python and viewers");
  const auto options = std::make_shared<ExportOptions>();
  ExportOptions& o = *options;
  command->add_option("DIR_OR_FILE", o.request.place, "Folder of a run, or a stage file");
  command
      ->add_option("--format", o.format,
                   fmt::format("One of {}", fmt::join(geo::io::export_format_names(), ", ")))
      ->type_name("FORMAT");
  command
      ->add_option("--field", o.request.field,
                   "Field to export (default: elevation; zarr and healpix: all of the stage)")
      ->type_name("NAME");
  command
      ->add_option("--stage", o.request.stage,
                   "Stage or island of the run (default: the last of the planet that wrote the "
                   "field)")
      ->type_name("NAME");
  command
      ->add_option("-o,--output", o.request.output,
                   "File to write (default: FIELD.EXTENSION); gplates: folder (default: "
                   "gplates)")
      ->type_name("FILE");
  command
      ->add_option("--tiles", o.tiles,
                   "png16, r16: square tiles of N samples that share their edges, such as 1009")
      ->type_name("N");
  command
      ->add_option("--layout", o.layout,
                   "png16, r16: whole, or cube: six faces round the planet that share their edges")
      ->type_name("whole|cube");
  command
      ->add_option("--masks", o.masks,
                   fmt::format("png16, r16: 8-bit layers beside it: all, or some of {}",
                               fmt::join(geo::io::export_mask_names(), ",")))
      ->type_name("NAMES");
  command
      ->add_option(
          "--range", o.range,
          "png16, r16: values of samples 0 and 65535 (default: the least and the greatest)")
      ->type_name("MIN,MAX");
  command->add_option("--nside", o.nside, "healpix: pixels along the edge of a base pixel")
      ->type_name("N");
  command
      ->add_option("--exaggeration", o.exaggeration,
                   "glb: how many times a planet's heights are raised (default: 15)")
      ->type_name("TIMES");
  add_memory_options(*command, o.memory, "the export");
  command->footer(
      "The paths of the files are printed. Beside height maps a JSON of the same name says their\n"
      "range, offset and scale: value = offset + scale * sample.");
  command->callback([&action, options] { action = [options] { write(*options); }; });
}

}  // namespace terrane
