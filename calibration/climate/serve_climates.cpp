#include <cstdio>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <cmath>
#include "geo/stages/climate/climate.hpp"
#include "stages/climate/climate_frame.hpp"
#include "stages/climate/orographic_ascent.hpp"
using namespace geo;
struct PlanetIn { int nx, ny; std::vector<float> z; };
static PlanetIn load(const std::string& f) {
  std::ifstream in(f, std::ios::binary); int d[2]; in.read((char*)d, 8);
  PlanetIn p{d[0], d[1], std::vector<float>((size_t)d[0]*d[1])};
  in.read((char*)p.z.data(), p.z.size()*4); return p;
}
int main() {
  std::map<std::string, PlanetIn> planets; std::string line;
  struct Cached { std::unique_ptr<Grid> grid; std::unique_ptr<ClimateFrame> frame; std::vector<float> land,h,rh; };
  std::map<std::string, Cached> cache;
  while (std::getline(std::cin, line)) {
    std::istringstream s(line); std::string planet, out, kv; s >> planet >> out;
    try {
    ClimateParameters p; p.topography_resolution_km = 80; p.resolution_deg=2;
    auto d = p.declarations();
    while (s >> kv) { auto e = kv.find('='); std::string k="climate."+kv.substr(0,e); bool ok=false;
      for (auto& q : d) if (q.name==k) { q.set_text(kv.substr(e+1)); ok=true; }
      if (!ok) throw std::runtime_error("no key "+k); }
    if (!planets.count(planet)) planets[planet]=load(planet);
    const auto& in = planets[planet];
    std::string id = planet+" "+std::to_string(p.resolution_deg)+" "+std::to_string(p.topography_resolution_km);
    if (!cache.count(id)) {
      Cached c; c.grid=std::make_unique<Grid>(Grid::sphere(in.nx,in.ny));
      Planet pl; c.frame=std::make_unique<ClimateFrame>(*c.grid,p,pl);
      size_t n=c.frame->planet().size(); c.land.resize(n); c.h.resize(n); c.frame->planet_relief(in.z,c.land,c.h);
      size_t m=c.frame->relief().size(); std::vector<float> a(m),cov(m); c.rh.resize(m);
      c.frame->on_relief().average_elevation(in.z,a,c.rh,cov); cache[id]=std::move(c);
    }
    auto& c=cache[id]; const ClimateFrame& frame=*c.frame;
    SeasonalClimate model=p.seasonal; Planet pl; model.energy.orbit={pl.obliquity_deg,pl.eccentricity,pl.perihelion_deg};
    std::vector<float> asc, pa;
    auto f = solve_seasonal_climate(frame.planet(), model, frame.planet_latitudes_deg(), c.land, c.h,
      [&](std::span<const float> e, std::span<const float> n){ asc=orographic_ascent(frame,e,n,c.rh,p); pa=mean_ascent(frame,asc); return pa; });
    std::ofstream o(out, std::ios::binary); int dd[2]={frame.planet().nx(),frame.planet().ny()}; o.write((char*)dd,8);
    float lapse=model.energy.lapse_k_m; o.write((char*)&lapse,4);
    auto w=[&](const std::vector<float>& v){o.write((const char*)v.data(),v.size()*4);};
    w(c.land); w(c.h);
    for (auto& v: f.temperature_c) w(v);
    for (auto& v: f.precipitation_mm) w(v);
    for (auto& v: f.wind_east) w(v);
    for (auto& v: f.wind_north) w(v);
    o.close(); std::cout << "ok" << std::endl;
    } catch (std::exception& e) { std::cout << "bad " << e.what() << std::endl; }
  }
}
