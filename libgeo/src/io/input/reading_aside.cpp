#include "geo/io/input/reading_aside.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <omp.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <new>
#include <optional>
#include <stdexcept>

#include "geo/core/error.hpp"
#include "io/files/parcel.hpp"
#include "io/files/vouched_bytes.hpp"
#include "questions.hpp"

extern char** environ;  // NOLINT(readability-redundant-declaration): not in every <unistd.h>

namespace geo::io {
namespace {

/// The reader's end of the socket is its file of this number.
constexpr int kReadersEnd = 3;

enum class Outcome : std::uint8_t { answered, refused, out_of_memory };

std::vector<std::string>& reader_command() {
  static std::vector<std::string> command;
  return command;
}

/// Starts a reader that hears and says nothing but through a socket. Empty when the system cannot.
std::optional<pid_t> start_reader(int socket) {
  std::vector<char*> arguments;
  for (std::string& word : reader_command()) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&actions);
  posix_spawnattr_init(&attributes);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_RDWR, 0);
  }
  posix_spawn_file_actions_adddup2(&actions, socket, kReadersEnd);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  pid_t process = -1;
  const int error =
      ::posix_spawn(&process, arguments.front(), &actions, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  return error == 0 ? std::optional(process) : std::nullopt;
}

[[noreturn]] void refuse(const std::filesystem::path& path, std::string_view what) {
  throw InputError(fmt::format("{}: damaged: {}", path.string(), what));
}

/// A process that reads a file, and is gone when this is.
class Reader {
 public:
  Reader(pid_t process, std::filesystem::path path) : process_(process), path_(std::move(path)) {}
  ~Reader() {
    if (process_ < 0) return;
    ::kill(process_, SIGKILL);
    wait();
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  /// Waits for its end; throws what that was if it was none of a sound file.
  void finish();

 private:
  /// Its status; 0 where whoever started us wants no news of children.
  int wait() {
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = -1;
    return status;
  }

  pid_t process_;
  std::filesystem::path path_;
};

void Reader::finish() {
  const int status = wait();
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  if (signal == SIGINT || signal == SIGTERM || signal == SIGHUP) throw Interrupted();
  if (signal == SIGXCPU) refuse(path_, "reading it does not come to an end");
  const bool lacks_memory =
      signal == SIGKILL ||
      (WIFEXITED(status) && WEXITSTATUS(status) == static_cast<int>(ErrorKind::configuration));
  if (lacks_memory) refuse(path_, "reading it takes more memory than there is");
  refuse(path_, fmt::format("the library that reads it crashed{}",
                            signal == 0 ? "" : fmt::format(" ({})", strsignal(signal))));
}

/// What the reader threw; nothing when an answer follows.
std::exception_ptr take_refusal(Parcel& parcel) {
  Outcome outcome{};
  take(parcel, outcome);
  if (outcome == Outcome::answered) return {};
  if (outcome == Outcome::out_of_memory) return std::make_exception_ptr(std::bad_alloc());
  ErrorKind kind{};
  std::string message;
  take(parcel, kind);
  take(parcel, message);
  switch (kind) {
    case ErrorKind::configuration:
      return std::make_exception_ptr(ConfigurationError(message));
    case ErrorKind::input:
      return std::make_exception_ptr(InputError(message));
    case ErrorKind::io:
      return std::make_exception_ptr(IoError(message));
    case ErrorKind::bug:
      return std::make_exception_ptr(Bug(message));
    default:
      return std::make_exception_ptr(Error(kind, message));
  }
}

template <class Question>
void put_question(Parcel& parcel, Question question) {
  put(parcel, std::string_view(Question::kName));
  put(parcel, omp_get_max_threads());
  std::apply([&](const auto&... part) { (put(parcel, part), ...); }, question.parts());
}

}  // namespace

void read_files_aside(std::vector<std::string> command) { reader_command() = std::move(command); }

template <class Question>
typename Question::Answer answer_to(const Question& question) {
  const std::filesystem::path path = question.path();
  std::error_code error;
  // What is not there or is no file is told of better without a process.
  if (reader_command().empty() || !std::filesystem::is_regular_file(path, error) ||
      is_as_recorded(path)) {
    return question.here();
  }
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    return question.here();
  }
  Parcel parcel(ends[0]);
  const auto process = start_reader(ends[1]);
  ::close(ends[1]);
  if (!process) return question.here();
  Reader reader(*process, path);
  try {
    put_question(parcel, question);
    auto refusal = take_refusal(parcel);
    if (!refusal) {
      auto answer = take_answer(parcel, std::type_identity<typename Question::Answer>());
      reader.finish();
      return answer;
    }
    reader.finish();
    std::rethrow_exception(refusal);
  } catch (const Parcel::Incomplete&) {
    reader.finish();
  } catch (const std::length_error&) {
    // A reader whose memory the file spoilt.
  }
  refuse(path, "reading it ended before its end");
}

template Dem answer_to(const RasterQuestion&);
template Dem answer_to(const GeotiffQuestion&);
template Snapshot answer_to(const StageQuestion&);
template Provenance answer_to(const ProvenanceQuestion&);
template std::optional<std::string> answer_to(const StageNameQuestion&);
template Checkpoint answer_to(const CheckpointQuestion&);
template std::vector<Exemplar> answer_to(const CacheQuestion&);

namespace {

void set_limit(int resource, double most) {
  struct rlimit limit {};
  if (::getrlimit(resource, &limit) != 0) return;
  limit.rlim_cur = std::min(limit.rlim_max, static_cast<rlim_t>(most));
  ::setrlimit(resource, &limit);
}

/// A reader goes with the process that asks, leaves no core, and takes neither for ever nor all
/// memory. Files unpack at 100 MB/s or faster: a second for each MB is no limit to a sound one.
void limit_this_process(const std::filesystem::path& path) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  set_limit(RLIMIT_CORE, 0.0);
  std::error_code error;
  const auto bytes = std::filesystem::file_size(path, error);
  constexpr double kLeast_s = 20.0, kPerByte_s = 1e-6;
  set_limit(RLIMIT_CPU, kLeast_s + kPerByte_s * (error ? 0.0 : static_cast<double>(bytes)));
#ifndef TERRANE_SANITIZED  // sanitizers reserve more address space than any machine has memory
  const double memory_bytes =
      static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE));
  struct rlimit present {};
  if (::getrlimit(RLIMIT_AS, &present) == 0 &&
      (present.rlim_cur == RLIM_INFINITY || static_cast<double>(present.rlim_cur) > memory_bytes)) {
    set_limit(RLIMIT_AS, memory_bytes);
  }
#endif
}

/// Whether the question was one of this kind.
template <class Question>
bool answer_if(const std::string& name, Parcel& parcel) {
  if (name != Question::kName) return false;
  Question question;
  std::apply([&](auto&... part) { (take(parcel, part), ...); }, question.parts());
  limit_this_process(question.path());
  const auto answer = question.here();
  put(parcel, Outcome::answered);
  put(parcel, answer);
  return true;
}

template <class... Questions>
void answer_one_of(Parcel& parcel) {
  std::string name;
  int threads = 1;
  take(parcel, name);
  take(parcel, threads);
  omp_set_num_threads(std::max(1, threads));
  if (!(answer_if<Questions>(name, parcel) || ...)) throw Bug("unknown question to a reader");
}

}  // namespace

int answer_reader() {
  try {
    Parcel parcel(kReadersEnd);
    try {
      answer_one_of<RasterQuestion, GeotiffQuestion, StageQuestion, ProvenanceQuestion,
                    StageNameQuestion, CheckpointQuestion, CacheQuestion>(parcel);
    } catch (const Error& error) {
      put(parcel, Outcome::refused);
      put(parcel, error.kind());
      put(parcel, std::string_view(error.what()));
    } catch (const std::bad_alloc&) {
      put(parcel, Outcome::out_of_memory);
    }
    return 0;
  } catch (...) {
    return 1;
  }
}

}  // namespace geo::io
