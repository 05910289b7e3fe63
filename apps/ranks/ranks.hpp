#pragma once

#include <functional>

namespace terrane {

class RankMessages;

/// Whether `mpirun`, `srun` or another launcher of MPI's started this process as one of several.
[[nodiscard]] bool is_one_of_several();

/// The work of one process of a job: rank 0 does `program`, whose exit code it returns; the others
/// keep pages for it until it is done, say nothing and return 0. Where another rank dies, the
/// launcher ends rank 0 too, which says so in one line. Throws ConfigurationError where this build
/// cannot talk to other ranks.
int run_as_rank(const std::function<int()>& program);

/// The others of the job, for rank 0; null where there are none.
[[nodiscard]] RankMessages* other_ranks();

}  // namespace terrane
