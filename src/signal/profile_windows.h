#pragma once
// The weights of ProfileAverage, by depth and line.

#include <cstddef>
#include <memory>
#include <vector>

#include "scene/probe.h"

namespace echocine {

// Properties of pulse and receiver that shape the beam. The attenuation of (B5) is 0 without
// downshift, the F-number is 0 if the whole aperture receives from every depth.
struct BeamPulse {
  // A length alone is a fundamental pulse.
  BeamPulse(double length_cycles, bool second_harmonic = false, double attenuation_np_per_m_hz = 0,
            double f_number = 0)
      : cycles(length_cycles),
        harmonic(second_harmonic),
        downshift_np_per_m_hz(attenuation_np_per_m_hz),
        receive_f_number(f_number) {}
  double cycles;
  bool harmonic;
  double downshift_np_per_m_hz, receive_f_number;
};

struct ProfileWindows {
  // Adjacent samples that share their weights: 1/40 of the depth, at least 8 samples.
  struct Zone {
    int first, last;
    std::size_t windows;  // place of its first row's window
  };
  // For one row in one zone: weights of the groups before the main lobe, its rows, the groups
  // behind it. Their sum is 1.
  struct Window {
    int first, end;  // rows one by one: whole groups
    std::size_t weights;
  };

  // Windows of some zones; their weights are numbered from 0.
  struct Part {
    std::vector<Window> windows;
    std::vector<float> weights;
  };

  // Precondition: at least two lines.
  ProfileWindows(const Probe& probe, const BeamPulse& pulse);

  const Zone& zoneOf(int sample) const;

  int in_row, rows;      // lines of a row; rows
  int in_group, groups;  // rows that enter together beyond the main lobe; groups
  std::vector<Zone> zones;
  std::vector<Window> windows;  // by zone and row
  std::vector<float> weights;

 private:
  void fill(const Probe& probe_of_rows, const BeamPulse& pulse);
};

// Those of a probe, wherever it stands. Simulators of equal probes share them, at once or one after
// the other: the windows of the last few probes are kept. Thread-safe.
std::shared_ptr<const ProfileWindows> sharedProfileWindows(const Probe& probe,
                                                           const BeamPulse& pulse);

}  // namespace echocine
