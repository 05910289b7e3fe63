#pragma once

namespace geo {

/// Net primary productivity, g m-2 yr-1 of dry matter: the lesser of what warmth and what water
/// allow, min(3000 / (1 + exp(1.315 - 0.119 T)), 3000 (1 - exp(-0.000664 P))) with T in °C and P in
/// mm/yr: the Miami model (Lieth 1975).
double miami_productivity(double temperature_c, double precipitation_mm_yr);

/// Share of its productivity that land keeps for farming at a height: 1 up to 500 m, falling to 0
/// at 4500 m (thin air, frost, short seasons; Körner 2003).
double altitude_factor(double elevation_m);

}  // namespace geo
