#include "cli/program.hpp"

#include <fcntl.h>
#include <grp.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace geo {
namespace {

constexpr uid_t kNobody = 65534;
constexpr int kCouldNotStart = 127;

std::filesystem::path new_folder() {
  std::string name = (std::filesystem::temp_directory_path() / "terrane-call-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("mkdtemp " + name);
  return name;
}

void redirect(const std::filesystem::path& file, int descriptor) {
  const int opened = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (opened < 0 || ::dup2(opened, descriptor) < 0) ::_exit(kCouldNotStart);
  ::close(opened);
}

/// A negative limit is none.
void limit_to(decltype(RLIMIT_AS) resource, long bytes) {
  if (bytes < 0) return;
  const rlimit limit{static_cast<rlim_t>(bytes), static_cast<rlim_t>(bytes)};
  if (::setrlimit(resource, &limit) != 0) ::_exit(kCouldNotStart);
}

[[noreturn]] void become_terrane(const Call& call, const std::filesystem::path& folder) {
  redirect(folder / "out", STDOUT_FILENO);
  redirect(folder / "err", STDERR_FILENO);
  // As a shell starts a program, whatever the test's own surroundings ignore.
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGXFSZ, SIG_DFL);
  ::unsetenv("SOURCE_DATE_EPOCH");
  for (const auto& [name, value] : call.environment) {
    value.empty() ? ::unsetenv(name.c_str()) : ::setenv(name.c_str(), value.c_str(), 1);
  }
  limit_to(RLIMIT_FSIZE, call.file_size_limit_bytes);
  limit_to(RLIMIT_AS, call.address_space_limit_bytes);
  limit_to(RLIMIT_DATA, call.data_limit_bytes);
  if (!call.working_folder.empty() && ::chdir(call.working_folder.c_str()) != 0) {
    ::_exit(kCouldNotStart);
  }
  if (call.as_nobody &&
      (::setgroups(0, nullptr) != 0 || ::setgid(kNobody) != 0 || ::setuid(kNobody) != 0)) {
    ::_exit(kCouldNotStart);
  }
  std::vector<std::string> words;
  if (call.ranks > 0) {
    words = {"mpirun", "--oversubscribe", "-n", std::to_string(call.ranks)};
    ::setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
    ::setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
  }
  words.emplace_back(TERRANE_PROGRAM);
  words.insert(words.end(), call.arguments.begin(), call.arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  ::execvp(pointers.front(), pointers.data());
  ::_exit(kCouldNotStart);
}

}  // namespace

Running::Running(const Call& call) : folder_(new_folder()) {
  process_ = ::fork();
  if (process_ == 0) become_terrane(call, folder_);
  if (process_ < 0) throw std::runtime_error("fork");
}

Running::~Running() {
  if (!ended_) {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

void Running::send(int signal_number) const {
  if (!ended_) ::kill(process_, signal_number);
}

bool Running::send_to_rank(int rank, int signal_number) const {
  const std::string parent = std::to_string(process_);
  std::istringstream children(text_of("/proc/" + parent + "/task/" + parent + "/children"));
  const std::string mark = "OMPI_COMM_WORLD_RANK=" + std::to_string(rank);
  for (pid_t child = 0; children >> child;) {
    std::istringstream entries(text_of("/proc/" + std::to_string(child) + "/environ"));
    for (std::string entry; std::getline(entries, entry, '\0');) {
      if (entry == mark) return ::kill(child, signal_number) == 0;
    }
  }
  return false;
}

void Running::note(int status, const rusage& used) {
  ended_ = true;
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  processor_s_ = seconds(used.ru_utime) + seconds(used.ru_stime);
  peak_bytes_ = 1024.0 * static_cast<double>(used.ru_maxrss);
  code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

bool Running::alive() {
  int status = 0;
  rusage used{};
  if (!ended_ && ::wait4(process_, &status, WNOHANG, &used) == process_) note(status, used);
  return !ended_;
}

bool Running::until(const std::function<bool()>& condition) {
  while (alive()) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  return false;
}

Outcome Running::finish() {
  int status = 0;
  rusage used{};
  if (!ended_ && ::wait4(process_, &status, 0, &used) == process_) note(status, used);
  return {code_, text_of(folder_ / "out"), text_of(folder_ / "err"), processor_s_, peak_bytes_};
}

std::string Running::err_so_far() const { return text_of(folder_ / "err"); }

long Running::address_space_bytes() const {
  long pages = 0;
  std::ifstream("/proc/" + std::to_string(process_) + "/statm") >> pages;
  return pages * ::sysconf(_SC_PAGESIZE);
}

double Running::bytes_of_deleted_files_in(const std::filesystem::path& folder) const {
  double bytes = 0.0;
  std::error_code error;
  for (const auto& entry :
       std::filesystem::directory_iterator("/proc/" + std::to_string(process_) + "/fd", error)) {
    const std::string file = std::filesystem::read_symlink(entry.path(), error).string();
    struct stat about {};
    if (!file.starts_with(folder.string()) || !file.ends_with("(deleted)")) continue;
    constexpr double kBlock_bytes = 512.0;
    if (::stat(entry.path().c_str(), &about) == 0) {
      bytes += kBlock_bytes * static_cast<double>(about.st_blocks);
    }
  }
  return bytes;
}

std::string Running::environment() const {
  return text_of("/proc/" + std::to_string(process_) + "/environ");
}

Outcome terrane(const Call& call) { return Running(call).finish(); }
Outcome terrane(std::vector<std::string> arguments) {
  return terrane(Call{.arguments = std::move(arguments), .environment = {}, .working_folder = {}});
}

bool can_start_ranks() {
  std::istringstream folders(std::getenv("PATH"));
  const std::filesystem::path module =
      std::filesystem::path(TERRANE_PROGRAM).parent_path() / "terrane_mpi.so";
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (std::filesystem::exists(folder + "/mpirun")) return std::filesystem::exists(module);
  }
  return false;
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

}  // namespace geo
