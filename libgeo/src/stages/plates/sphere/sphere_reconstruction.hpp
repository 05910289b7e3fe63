#pragma once

#include "geo/core/stage.hpp"
#include "geo/kernels/plates/plate_reconstruction.hpp"
#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"

namespace geo {

/// Settings of a drift whose plates move as rotations have it: in the frame of these, and no plate
/// rifts by chance.
void let_rotations_lead(SphereSettings& settings);

/// Throws InputError where a drift that goes on was not driven by a reconstruction from that age.
void check_reconstruction(const PlateReconstruction& given, const SphereState& state);

/// Plates turn through the next step as the stage rotations of that time have it, in the frame of
/// the samples. A plate whose rotations have ended moves on as it did, with a warning.
void drive_plates(const PlateReconstruction& given, SphereTectonics& model, Context& context);

/// The same, once plates whose outlines begin within the step, after its end to its beginning
/// inclusively, have been cut out of the plates on which most of their crust lies. A plate that
/// lies almost whole within such an outline takes its rotations instead.
void follow_reconstruction(const PlateReconstruction& given, SphereTectonics& model,
                           Context& context);

}  // namespace geo
