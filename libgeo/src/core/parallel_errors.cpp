#include "geo/core/parallel_errors.hpp"

#include <omp.h>

namespace geo {
namespace {

/// How deep in parallel regions the innermost guard of this thread stands; nested regions have
/// none of their own.
thread_local int guarded_level = 0;

}  // namespace

ParallelErrors::Guarding::Guarding() noexcept
    : before_(std::exchange(guarded_level, omp_get_level())) {}

ParallelErrors::Guarding::~Guarding() { guarded_level = before_; }

void ParallelErrors::keep(std::exception_ptr error) noexcept {
  if (!any_.exchange(true, std::memory_order_acq_rel)) first_ = std::move(error);
}

bool ParallelErrors::is_carried() noexcept { return omp_get_level() <= guarded_level; }

}  // namespace geo
