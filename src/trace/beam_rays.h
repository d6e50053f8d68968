#pragma once
// A beam as a bundle of straight rays, whose weighted average is the beam's two-way profile at
// every depth: the accurate alternative to the paper's average over neighbouring samples.
//
// Widths are those of scene/beam_profile.h; sigma = w / sqrt(8 ln 4). z: depth along the line,
// x across the lines, y across the imaging plane; q, p, s: independent standard normal numbers.
//
// Lateral. Receive is focused at every depth, so its bell is a cone from the line's start:
//   x(z) = q sigma_r z with the slope sigma_r = 1.207 lambda / D / sqrt(8 ln 4).
// Transmit's bell is nowhere narrower than receive's, so rays drawn for receive are weighed by
// transmit at their place: exp(-(q^2/2) rho(z)), rho = w_r^2 / w_t^2, 0 < rho <= 1. Normalised at
// each depth this is the two-way bell, 1/w^2 = 1/w_t^2 + 1/w_r^2, at every depth.
//
// Elevation. One fixed lens for transmit and receive: w_e^2/2 = (1.207 lambda z / D_e)^2/2 +
// (D_e (1 - z/F_e))^2/2, which is the variance of the straight rays
//   y(z) = p sigma_y (1 - z/F_e) + s sigma_s z,  sigma_y of D_e / sqrt 2,
//   sigma_s of 1.207 lambda / D_e / sqrt 2,
// so these need no weights. The lens makes all paths to its focus equal: they count from the
// sphere of radius F_e about the focus, sqrt(F_e^2 + y_0^2) - F_e behind the face (paraxial).
//
// Echoes. A ray stands for its lateral stratum, q between two quantiles. On a wall that leans by
// tan = t towards x its echo is spread evenly over the depths at which that stratum meets the
// wall's tangent plane, dz = -z t sigma_r dq, instead of put where the ray itself does: the
// expectation over the stratum, so a steep wall takes fewer rays to come out smooth. The outermost
// strata end where their mean is kept. Leans over 10 (84 degrees) are taken for 10.
//
// Limits: an incoherent sum (no interference, no side lobes, no speckle); angles of incidence are
// those of the rays, which in a focus differ by sigma_r and y_0/F_e from the wave's front; after
// refraction weights are still those of the straight ray; widths of lambda / D beyond paraxial.
//
// Points: (i + jitter)/N, and the first two Sobol' sequences under Owen's scrambling. For N a power
// of two a (0, m, 3)-net, for any N stratified in the first dimension. The pattern is a hash of
// (seed, frame, line).

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/crossing.h"
#include "plan/effect_plan.h"
#include "scene/scan_geometry.h"

namespace echocine {

// Standard normal quantile: Q(normalQuantile(u)) = u to 1e-9, 0 < u < 1.
double normalQuantile(double u);

// Point i of n in (0, 1)^3.
std::array<double, 3> beamPoint(std::uint64_t pattern, int i, int n);

struct BeamRay {
  Ray ray;                              // from the transducer's face
  double start_m = 0;                   // along it to where its path length counts from: the lens
  double lens_m = 0;                    // y of the ray's start
  double half_square = 0;               // q^2 / 2
  Vec3d lateral;                        // unit vector across the lines
  double from_slope = 0, to_slope = 0;  // ends of its stratum, sigma_r (q' - q)
};

struct BeamSpread {
  int rays = 1;
  bool lateral = true, elevation = true;  // what the rays are spread over
  int seed = 1;
};

BeamSpread beamSpread(const EffectPlan& plan, int seed);

class BeamRays {
 public:
  BeamRays(const Probe& probe, const BeamSpread& spread);

  int count() const { return spread_.rays; }
  bool weighted() const { return spread_.lateral; }
  bool elevation() const { return spread_.elevation; }

  // Seed of the points of one line in one frame.
  std::uint64_t pattern(int frame, int line) const;

  BeamRay ray(const LineGeometry& line, std::uint64_t pattern, int i) const;

  // The ray of given normal numbers, those of what is not spread taken for 0.
  BeamRay through(const LineGeometry& line, double q, double p, double s) const;

  // exp(-(q^2/2) rho) at each sample's centre, in (0, 1], to 3e-6; not normalised. Precondition:
  // out has an entry per sample.
  void weights(const BeamRay& ray, std::span<float> out) const;

 private:
  BeamSpread spread_;
  double lateral_slope_ = 0;                    // sigma_r
  double lens_m_ = 0, tilt_ = 0, focus_m_ = 1;  // sigma_y, sigma_s, F_e
  std::vector<float> transmit_;                 // rho of each sample
  std::vector<double> strata_;                  // q at the ends of the lateral strata
};

}  // namespace echocine
