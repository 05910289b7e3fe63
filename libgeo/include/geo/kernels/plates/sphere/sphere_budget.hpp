#pragma once

#include "geo/core/vector3.hpp"

namespace geo {

/// Sums over a step. Areas km2, volumes of continental crust km3.
struct SphereBudget {
  double time_myr = 0.0;
  int plates = 0;
  bool resampled = false;
  int collisions = 0, rifts = 0, subduction_initiations = 0;
  double area_error = 0.0;        ///< sum of the plates' areas over the sphere's, less 1
  double created_km2 = 0.0;       ///< new ocean floor
  double consumed_km2 = 0.0;      ///< ocean floor that had subducted
  double buried_km2 = 0.0;        ///< continents thrust below others
  double ocean_change_km2 = 0.0;  ///< of the oceanic area, measured
  double ocean_error_km2 = 0.0;   ///< created - consumed - turned into continent - change
  double emerged_km2 = 0.0;       ///< ocean floor that became continental
  double continental_km3 = 0.0;   ///< volume of continental crust at the end of the step
  double accreted_km3 = 0.0;      ///< sediment that the wedges behind trenches grew by
  double raised_km3 = 0.0;        ///< added by subduction: magma and accretion
  double eroded_km3 = 0.0;
  double deposited_km3 = 0.0;   ///< laid on continents and their shelves by rivers
  double sea_floor_km3 = 0.0;   ///< laid on ocean floor by rivers
  double scraped_km3 = 0.0;     ///< sediment of subducting floor that continents have kept
  double emerged_km3 = 0.0;     ///< of arcs when they became continental
  double stretched_km2 = 0.0;   ///< margins that broken continents grew
  double swallowed_km3 = 0.0;   ///< moved by collisions from roots into mountains
  double changed_km3 = 0.0;     ///< made or taken by change_crust
  double erupted_km3 = 0.0;     ///< that plumes laid on ocean floor
  double lost_km3 = 0.0;        ///< subducted below floor, or from roots that found no room
  double resampling_km3 = 0.0;  ///< what interpolation added or took
  // Of sediment, on continents and floor.
  double sediment_km3 = 0.0;             ///< at the end of the step
  double sediment_laid_km3 = 0.0;        ///< by rivers
  double sediment_reworked_km3 = 0.0;    ///< that rivers have taken up again
  double sediment_subducted_km3 = 0.0;   ///< into the mantle
  double sediment_resampling_km3 = 0.0;  ///< what interpolation added or took
};

/// A happening worth telling.
struct SphereEvent {
  enum class Kind {
    collision,
    rift,
    subduction_initiation,
    back_arc,
    ridge_jump,
    indentation
  } kind;
  double time_myr;
  int first, second;  ///< plates: terrane's and collided one; that with the plume and the one
                      ///< beyond the ridge; or the plate that broke and -1
  Vector3 place;      ///< centroid, or the plume, unit vector
  double area_km2;    ///< of the terrane or plate, or of floor that has changed plates
};

}  // namespace geo
