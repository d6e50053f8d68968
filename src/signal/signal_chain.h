#pragma once
// The scanner's signal processing, the same in every frame of a loop: time gain -> lung -> beam
// width -> drop-out, ribs, patches, haze, reverberation -> (speckle) -> clutter, noise -> log
// compression -> scan conversion -> grey map. The tracer handles the spread, because it knows the
// scattered part, by the intensity_terms of its request.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/beam_plane.h"
#include "plan/effect_plan.h"
#include "scene/unrolled_turn.h"
#include "signal/beam_width.h"
#include "signal/edge_enhancement.h"
#include "signal/field_sum.h"
#include "signal/haze.h"
#include "signal/lung_echo.h"
#include "signal/profile_average.h"
#include "signal/scan_conversion.h"
#include "trace/coherent_echoes.h"

namespace echocine {

class SignalChain {
 public:
  SignalChain(const Scene& scene, const EffectPlan& plan);

  const PictureGeometry& geometry() const { return geometry_; }

  // Time gain, beam width and chest effects, in place.
  void process(Intensities& intensities) const { process(intensities, all_lines_); }
  // The same for some lines. The content of the others is undefined afterwards. The lines that it
  // reads must be as received.
  // media: PolarFrame::medium, read only by plan.lung; empty: no lung.
  void process(Intensities& intensities, LineRange lines,
               std::span<const std::uint32_t> media = {}) const;
  // Number of samples of each line, from the first, that process() of some lines needs.
  std::vector<int> taken(LineRange lines) const;

  // The same for the coherent part, without side lobes, haze and tail, which are incoherent.
  void process(CoherentEchoes& echoes, LineRange lines) const;

  // True if compress() needs the field of intensities with speckle.
  bool addsFields() const { return fields_.draws(); }

  // Adds clutter and noise of an instant to the field of some lines; `white` is the loop's.
  void addFields(double white, double time_s, LineRange lines, EchoField& field) const;

  // The lines whose intensities compress() needs for these grey levels: edge enhancement looks at
  // neighbours.
  LineRange greysFrom(LineRange lines) const;

  // Clutter, noise and log compression against the loop's single reference; noise is that of the
  // instant. field: of the same intensities, empty without speckle. The grey levels reuse the
  // intensities' memory.
  Greys compress(Intensities&& intensities, double reference_intensity, double time_s = 0,
                 const EchoField& field = {}) const;

  // Scan conversion and grey map.
  void picture(const Greys& greys, GreyImage& image) const { converter_.convert(greys, image); }
  // Scan conversion only: grey 0..1, -1 outside the sector.
  void picture(const Greys& greys, std::vector<float>& picture) const {
    converter_.convert(greys, picture);
  }

 private:
  void averageOverBeam(std::vector<float>& plane, LineRange lines, BeamPart part) const;
  void enhanceEdges(Greys& greys) const;

  SignalSettings settings_;
  LineRange all_lines_;
  int samples_;
  std::optional<UnrolledTurn> turn_;  // for windows across the seam of a full turn
  std::vector<float> gains_;          // from a table or the mean; empty: none
  std::optional<BeamAverage> beam_;
  std::optional<ProfileAverage> profile_;  // across the lines, where beam_ is along them alone
  std::vector<float> losses_;              // by drop-out and ribs; empty: none
  std::vector<float> build_up_;            // of the second harmonic; empty: none
  std::optional<LungEcho> lung_;
  std::optional<LateralHaze> haze_;
  std::optional<ReverberationTail> tail_;
  FieldSum fields_;
  std::optional<EdgeEnhancement> edges_;
  PictureGeometry geometry_;
  ScanConverter converter_;
};

}  // namespace echocine
