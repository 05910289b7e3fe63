#pragma once

#include "geo/stages/isostasy/crust.hpp"

namespace geo {

/// crust = "simulated" or "given" where the grid is a torus: the surface that the plates made,
/// which is already that of crust which floats. What boundaries deform is their strength about a
/// place times exp(-distance / length). Cross sections of margins, the stiffness of plates and the
/// fabric of the sea floor are for spheres. Throws InputError for any other crust.
void take_torus_crust(const Crust<float>& crust);

}  // namespace geo
