#include "map_projection.hpp"

#include <proj.h>

#include <cmath>
#include <memory>

namespace geo::io {
namespace {

struct Free {
  void operator()(PJ_CONTEXT* context) const { proj_context_destroy(context); }
  void operator()(PJ* projection) const { proj_destroy(projection); }
};
using Context = std::unique_ptr<PJ_CONTEXT, Free>;
using Projection = std::unique_ptr<PJ, Free>;

}  // namespace

std::optional<Centre> unproject(const std::string& crs, double x_m, double y_m) {
  const Context context(proj_context_create());
  proj_log_level(context.get(), PJ_LOG_NONE);
  const Projection projected(proj_create(context.get(), crs.c_str()));
  if (!projected || proj_is_crs(projected.get()) == 0) return {};
  const Projection geographic(proj_crs_get_geodetic_crs(context.get(), projected.get()));
  if (!geographic) return {};
  Projection transform(proj_create_crs_to_crs_from_pj(context.get(), projected.get(),
                                                      geographic.get(), nullptr, nullptr));
  if (!transform) return {};
  // Easting and longitude first, whatever the authority says.
  transform.reset(proj_normalize_for_visualization(context.get(), transform.get()));
  if (!transform) return {};
  const PJ_COORD to = proj_trans(transform.get(), PJ_FWD, proj_coord(x_m, y_m, 0.0, 0.0));
  if (!std::isfinite(to.lp.phi) || std::abs(to.lp.phi) > 90.0) return {};
  return Centre{to.lp.phi, to.lp.lam};
}

}  // namespace geo::io
