#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace geo::io {

/// The folder of a run: what its files are called and what is there.
class RunFolder {
 public:
  explicit RunFolder(std::filesystem::path path);
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::filesystem::path config() const { return path_ / "config.toml"; }
  [[nodiscard]] std::filesystem::path manifest() const { return path_ / "manifest.json"; }
  [[nodiscard]] std::filesystem::path maps() const { return path_ / "maps"; }
  [[nodiscard]] std::filesystem::path report() const { return path_ / "report.html"; }
  [[nodiscard]] std::filesystem::path collection() const { return path_ / "planet.pvd"; }
  [[nodiscard]] std::filesystem::path islands() const { return path_ / "island.pvd"; }
  [[nodiscard]] std::filesystem::path globes() const { return path_ / "globe.pvd"; }
  /// "03-erosion.nc"; `extension` with its dot.
  [[nodiscard]] std::filesystem::path stage_file(int number, std::string_view stage,
                                                 std::string_view extension) const;

  /// Whether anything that a run writes is there.
  [[nodiscard]] bool holds_run() const;
  /// Checks that the folder is there or can be made, that it can be written, and that the disk has
  /// room for `bytes`. Changes nothing. Throws IoError.
  void check_writable(double bytes) const;
  /// Makes the folder, keeps other runs out of it until this object ends, and clears what a killed
  /// run left half-written. Throws IoError, also when another run is at work in it.
  void open();
  /// Removes the files of one stage. Throws IoError.
  void remove_stage(int number, std::string_view stage) const;
  /// Removes the files of further islands, "07-island-2.nc" and so on. Throws IoError.
  void remove_further_islands() const;
  /// Removes what is made from all stages together: collections, maps, report.
  void remove_summaries() const;

 private:
  void lock();

  std::filesystem::path path_;
  int locked_ = -1;  // descriptor of the folder while it is ours
};

}  // namespace geo::io
