#include "ranks.hpp"

#include <dlfcn.h>
#include <omp.h>
#include <sched.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/memory/memory.hpp"
#include "geo/core/error.hpp"
#include "page_server.hpp"
#include "rank_messages.hpp"

namespace terrane {
namespace {

RankMessages* others = nullptr;

std::optional<long> number_of(const char* variable) {
  const char* const text = std::getenv(variable);
  if (text == nullptr) return std::nullopt;
  return std::strtol(text, nullptr, 10);
}

/// What the launcher calls this process, as long as MPI has not said it.
long rank_by_launcher() {
  for (const char* const name : {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK"}) {
    if (const auto rank = number_of(name)) return *rank;
  }
  return 0;
}

/// Beside the program where it was built, in the folder of modules where it was installed.
RankMessages* load_messages() {
  std::array<char, PATH_MAX> path{};
  if (::readlink("/proc/self/exe", path.data(), path.size() - 1) <= 0) return nullptr;
  std::string folder = path.data();
  folder.erase(folder.find_last_of('/'));
  for (const std::string& place : {folder + "/" TERRANE_MPI_MODULE,
                                   folder + "/" TERRANE_MODULE_FOLDER "/" TERRANE_MPI_MODULE}) {
    // Libraries that MPI loads by itself look for it among all names.
    void* const module = ::dlopen(place.c_str(), RTLD_NOW | RTLD_GLOBAL);
    if (module == nullptr) continue;
    const auto make = reinterpret_cast<MakeRankMessages>(::dlsym(module, kMakeRankMessages));
    if (make != nullptr) return make();
  }
  return nullptr;
}

/// What the launcher sends to the rest of a job of which one has died.
void end_with_job(int) {
  end_at_once(
      "the job was ended: another of its ranks died, or it was cancelled; terrane run --resume "
      "goes on after the last complete stage, with any number of ranks",
      static_cast<int>(geo::ErrorKind::interrupted));
}

std::atomic<pid_t> computing{0};

/// It is rank 0 that says it, or the first of the others where rank 0 is gone.
void end_with_job_if_alone(int number) {
  if (computing != 0 && ::kill(computing, 0) != 0 && errno == ESRCH) end_with_job(number);
  ::_exit(128 + number);
}

void serve(RankMessages& messages) {
  std::signal(SIGINT, SIG_IGN);  // the launcher's to tell
  std::signal(SIGTERM, messages.rank() == 1 ? end_with_job_if_alone : SIG_DFL);
  serve_pages(messages, [](pid_t process) { computing = process; });
}

/// A launcher that starts several processes on a machine keeps each to some of its processors. But
/// only rank 0 computes: it may have all again.
void use_all_processors() {
  cpu_set_t all;
  CPU_ZERO(&all);
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) CPU_SET(cpu, &all);
  ::sched_setaffinity(0, sizeof all, &all);
  if (std::getenv("OMP_NUM_THREADS") == nullptr) omp_set_num_threads(omp_get_num_procs());
}

/// Processes that this one starts are none of the job.
void leave_job() {
  std::vector<std::string> names;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view text(*entry);
    for (const std::string_view of_launcher : {"OMPI_", "PMI_", "PMIX_"}) {
      if (text.starts_with(of_launcher)) names.emplace_back(text.substr(0, text.find('=')));
    }
  }
  for (const std::string& name : names) ::unsetenv(name.c_str());
}

}  // namespace

bool is_one_of_several() {
  const auto count = [](const char* name) { return number_of(name).value_or(0); };
  // Open MPI's launcher, MPICH's and its kin, Slurm's with PMIx.
  return count("OMPI_COMM_WORLD_SIZE") > 1 || count("PMI_SIZE") > 1 ||
         (number_of("PMIX_RANK") && count("SLURM_STEP_NUM_TASKS") > 1);
}

int run_as_rank(const std::function<int()>& program) {
  // Others may die while MPI begins.
  if (rank_by_launcher() == 0) std::signal(SIGTERM, end_with_job);
  const std::unique_ptr<RankMessages> messages(load_messages());
  if (!messages) {
    if (rank_by_launcher() > 0) return static_cast<int>(geo::ErrorKind::configuration);
    throw geo::ConfigurationError(
        "this build of terrane has no MPI: start it without mpirun or srun, or build it where MPI "
        "is (libopenmpi-dev)");
  }
  if (messages->rank() > 0) {
    serve(*messages);
    return 0;
  }
  leave_job();
  use_all_processors();
  if (messages->count() > 1) {
    others = messages.get();
    begin_page_servers(*messages);
    std::signal(SIGTERM, end_with_job);
  } else {
    std::signal(SIGTERM, SIG_DFL);
  }
  const int code = program();
  end_page_servers(*messages);
  others = nullptr;
  return code;
}

RankMessages* other_ranks() { return others; }

}  // namespace terrane
