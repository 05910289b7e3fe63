#pragma once

#include <sys/resource.h>
#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace geo {

/// What a program left behind when it ended.
struct Outcome {
  int code = -1;  ///< exit code, or 128 + signal as a shell shows it
  std::string out, err;
  double processor_s = 0.0;  ///< of all its threads, however busy the machine is
  double peak_bytes = 0.0;   ///< the most memory that it had resident
};

/// How `terrane` is called: arguments and circumstances.
struct Call {
  std::vector<std::string> arguments;
  std::vector<std::pair<std::string, std::string>> environment;  ///< an empty value: without it
  std::filesystem::path working_folder;
  long file_size_limit_bytes = -1;      ///< RLIMIT_FSIZE; negative: none
  bool as_nobody = false;               ///< without the rights of root
  long address_space_limit_bytes = -1;  ///< RLIMIT_AS; negative: none
  long data_limit_bytes = -1;           ///< RLIMIT_DATA; negative: none
  int ranks = 0;                        ///< processes that mpirun starts; 0: without mpirun
};

/// The program on its way, heard through files in a folder of its own.
class Running {
 public:
  explicit Running(const Call& call);
  ~Running();
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  void send(int signal_number) const;
  /// To one of the ranks that mpirun has started; false where there is none of that number.
  [[nodiscard]] bool send_to_rank(int rank, int signal_number) const;
  /// Whether it still runs.
  bool alive();
  /// Waits until `condition` holds or the program has ended; true when the condition came first.
  bool until(const std::function<bool()>& condition);
  /// Waits for the end.
  Outcome finish();
  [[nodiscard]] std::string err_so_far() const;
  /// The address space that it takes now; 0 when it has ended.
  [[nodiscard]] long address_space_bytes() const;
  /// What it has of files in that folder that no longer have a name there, on the disk.
  [[nodiscard]] double bytes_of_deleted_files_in(const std::filesystem::path& folder) const;
  /// Its environment as the system shows it, entries parted by zero bytes.
  [[nodiscard]] std::string environment() const;

 private:
  void note(int status, const rusage& used);

  std::filesystem::path folder_;
  pid_t process_ = -1;
  bool ended_ = false;
  int code_ = -1;
  double processor_s_ = 0.0, peak_bytes_ = 0.0;
};

/// Runs `terrane` to its end.
Outcome terrane(const Call& call);
Outcome terrane(std::vector<std::string> arguments);

/// Whether mpirun is there, and a program that it can start.
bool can_start_ranks();

std::string text_of(const std::filesystem::path& file);
std::vector<std::string> lines_of(const std::string& text);

}  // namespace geo
