#include "map_projection.hpp"

#include <fmt/format.h>
#include <proj.h>

#include <cmath>
#include <memory>

#include "geo/core/error.hpp"

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

std::string equal_area_wkt(Centre centre, const Ellipsoid& figure) {
  const std::string body = figure.flattening == 0.0 ? fmt::format("+R={}", figure.radius_m)
                                                    : fmt::format("+a={} +rf={}", figure.radius_m,
                                                                  1.0 / figure.flattening);
  const std::string text =
      fmt::format("+proj=laea +lat_0={} +lon_0={} {} +units=m +no_defs +type=crs",
                  centre.latitude_deg, centre.longitude_deg, body);
  const Context context(proj_context_create());
  proj_log_level(context.get(), PJ_LOG_NONE);
  const Projection crs(proj_create(context.get(), text.c_str()));
  const char* const options[] = {"MULTILINE=NO", nullptr};
  const char* const wkt =
      crs ? proj_as_wkt(context.get(), crs.get(), PJ_WKT2_2019, options) : nullptr;
  if (wkt == nullptr) throw Bug("PROJ refuses " + text);
  return wkt;
}

}  // namespace geo::io
