#include "child_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

#include "geo/core/error.hpp"
#include "signals.hpp"

namespace terrane {
namespace {

constexpr const char* kThisProgram = "/proc/self/exe";

int open_for(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (file < 0) throw geo::IoError(fmt::format("{}: {}", path.string(), std::strerror(errno)));
  return file;
}

}  // namespace

pid_t start_this_program(const std::vector<std::string>& arguments,
                         const std::filesystem::path& output,
                         const std::filesystem::path& messages) {
  std::vector<std::string> words{"terrane"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const int out = open_for(output), told = open_for(messages);
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child == 0) {
    // Between fork and exec nothing that could wait for another thread.
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (::getppid() != parent) ::_exit(1);
    const int nothing = ::open("/dev/null", O_RDONLY);
    ::dup2(nothing, STDIN_FILENO);
    ::dup2(out, STDOUT_FILENO);
    ::dup2(told, STDERR_FILENO);
    ::execv(kThisProgram, pointers.data());
    ::_exit(127);
  }
  ::close(out);
  ::close(told);
  if (child < 0) throw geo::IoError(fmt::format("no further process: {}", std::strerror(errno)));
  return child;
}

ChildEnd wait_for_child(const std::vector<pid_t>& children) {
  using namespace std::chrono_literals;
  bool told = false;
  for (;;) {
    if (stop_requested() && !told) {
      for (const pid_t child : children) ::kill(child, SIGTERM);
      told = true;
    }
    int status = 0;
    for (const pid_t child : children) {
      if (::waitpid(child, &status, WNOHANG) != child) continue;
      return {child, WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status)};
    }
    std::this_thread::sleep_for(10ms);
  }
}

}  // namespace terrane
