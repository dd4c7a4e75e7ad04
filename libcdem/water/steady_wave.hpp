// Waves of one height that travel without change over a flat bed. In the frame that moves with the crest, with z from the
// bed, the flow is steady:
//
//   u = -U + k sum j B_j cosh(j k z) / cosh(j k d) cos(j theta),   w = k sum j B_j sinh(j k z) / cosh(j k d) sin(j theta)
//   p / rho = R - g z - (u^2 + w^2) / 2,   theta = k (s - c t)
//
// s is the distance along the direction of travel, c = U + current the speed of the crest. Three theories give the
// coefficients: Airy, Stokes of fifth order (Fenton 1985), and the stream function (Rienecker and Fenton 1981).
#pragma once

#include "libcdem/water/water_field.hpp"

#include <optional>
#include <vector>

namespace cdem {

enum class WaveTheory { stream_function, stokes, airy };

struct WaveGiven {
  WaveTheory theory = WaveTheory::stream_function;
  double height = 0;                        // m, crest over trough
  std::optional<double> period, length;     // s, m: one of the two
  double depth = 0;                         // m, of still water
  double level = 0;                         // m, z of still water
  geom::Vec3 direction{1, 0, 0};            // of travel; its horizontal part counts
  geom::Vec3 crest_at = geom::Vec3::Zero(); // where a crest stands at time 0
  double current = 0;    // m/s, mean velocity along the direction at a fixed place under water
  int order = 20;        // N, of the stream function
  double density = 1025; // kg/m3
  double gravity = 9.81; // m/s2
};

struct SteadyWave {
  double wave_number = 0, depth = 0, gravity = 0; // 1/m, m, m/s2
  double mean = 0;                                // U, m/s
  double bernoulli = 0;                           // R, m2/s2, z from the bed
  std::vector<double> surface;                    // E_j, m: height over the bed is d + sum E_j cos(j theta)
  std::vector<double> potential;                  // B_j, m2/s

  double length() const;
  struct Surface {
    double height = 0, slope = 0; // m over the bed; rise along the direction of travel
  };
  Surface surface_at(double theta) const;
  struct Flow {
    double u = 0, w = 0;   // m/s, in the frame of the crest
    double ax = 0, az = 0; // m/s2, of the particles
  };
  Flow flow(double theta, double z) const;
};

// Throws geom::InputError, for a wave beyond breaking too.
SteadyWave steady_wave(const WaveGiven&);

// Largest height over depth of a steady wave of this length over depth (Fenton 1990, after Williams 1981).
double highest_wave(double length_over_depth);

// k of small waves: omega^2 = g k tanh(k d) in a current, omega - k current in place of omega.
double linear_wave_number(double period, double depth, double gravity, double current = 0);

struct WaveField final : WaterField {
  explicit WaveField(const WaveGiven&);
  WaterPoint at(const geom::Vec3& place, double time) const override;
  double density() const override { return given.density; }
  double gravity() const override { return given.gravity; }
  bool has_dynamic_pressure() const override { return true; }
  bool has_pressure() const override { return true; }
  std::optional<FlatBed> flat_bed() const override { return FlatBed{given.level - given.depth, given.level}; }

  double shortest_period() const override { return period(); }

  double period() const; // s
  WaveGiven given;
  SteadyWave wave;
  geom::Vec3 along = geom::Vec3::UnitX(); // unit, horizontal
};

} // namespace cdem
