#pragma once

#include <string>

namespace terrane {

/// Makes OpenMP use as many threads as `--threads` says; if that is empty, as OMP_NUM_THREADS or
/// the machine has it, but never more than the machine has processors: then it warns. Returns their
/// number. Throws ConfigurationError.
int use_threads(const std::string& text = {});

}  // namespace terrane
