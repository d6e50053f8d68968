#pragma once
// A scene: plain structs in SI units, without library types. The initial value of a member is the
// default of its key; scene_keys.cpp has the keys.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "scene/channel.h"
#include "scene/effects.h"
#include "scene/medium.h"
#include "scene/motion_settings.h"
#include "scene/probe.h"
#include "scene/role.h"
#include "scene/view_placement.h"

namespace echocine {

// Playback of keyframes at another heart rate. automatic: systole if the keyframes' rate is known.
enum class WarpChoice { automatic, uniform, systole };

struct Acquisition {
  double heart_rate_hz = 65.0 / 60.0;  // the mean where beats vary
  double frame_rate_hz = 50;
  double beats = 1;
  WarpChoice time_warp = WarpChoice::automatic;
  double rr_variability = 0;  // standard deviation / mean of the beats' durations
  int seed = 1;               // of all randomness of the acquisition
  bool rolling = false;       // each line is acquired at its own instant, in order
  double rolling_share = 1;   // share of the frame interval in which all lines are acquired
};

struct Structure {
  std::string name;
  MediumId medium{};
  Role role = Role::none;           // anatomical role
  bool role_given = false;          // by the scene; else guessed from the name
  bool membrane = false;            // an open sheet of a thin material: reflects, encloses nothing
  int priority = 0;                 // the highest wins where closed structures overlap
  std::vector<Keyframe> keyframes;  // ascending phases
  bool phases_given = false;        // by the scene; else evenly spaced
  double reflection_gain = 1;       // factor of R in W of the non-specular lobe
  double reflection_exponent = 2;   // n of the non-specular lobe
  double coherent_share = 0;        // K: coherent / random power of its echoes
  Repairs repair;
  SourcePlace place;  // of its keyframes in the scene file
};

enum class Tgc { perfect, mean, table, none, nominal };
enum class Spread { compensate, keep };
enum class BeamWidth { focused, profile, fixed, none };

// Appearance of a picture: the paper's; with speckle and a scanner's grey map; those of several
// scanners, with artefacts. A look only sets other defaults (looks.h).
enum class Look { paper, clean, scanner, smooth, contrast, sharp, portable, faint };
constexpr bool isScanner(Look look) {
  return look != Look::paper && look != Look::clean;
}
enum class Quality { good, medium, poor };

struct SignalSettings {
  Look look = Look::paper;
  Quality quality = Quality::medium;  // of a scanner's look
  Tgc tgc = Tgc::perfect;
  std::vector<std::pair<double, double>> tgc_table;  // (depth m, gain dB), ascending depths
  // The examiner's gain of the near field: added at the face, straight in dB to 0 at this depth.
  double near_gain_db = 0, near_gain_depth_m = 25e-3;
  // For Tgc::nominal: 0.76 of soft tissue's 0.54 dB/(cm MHz), so that lung stays dark. Our choice.
  double nominal_gain_np_per_m_hz = 4.72e-6;
  Spread spread = Spread::compensate;
  BeamWidth beam_width = BeamWidth::focused;
  double beam_width_m = 0;  // for BeamWidth::fixed
  double pulse_cycles = 2;  // axial averaging over the pulse, pulse_cycles * wavelength / 2
  double dynamic_range_db = 60;
  std::optional<double> reference_intensity;  // relative to I_S; otherwise the percentile
  double reference_percentile = 99.5;         // of all samples of the loop, without the near field
  double gain_db = 0;                         // of the picture: lowers the intensity shown as white
  double examiner_gain_db = 0;                // added to gain_db
  double interface_gain_db = 0;  // of interface echoes relative to tissue, in the picture only
  // Interface echoes E become E / (1 + E / limit), in dB of the transmitted intensity. None:
  // unchanged.
  std::optional<double> interface_limit_db;
  // The grey map (grey_curve.h). Toe and shoulder: shares of the dynamic range.
  double grey_gamma = 1, grey_toe = 0, grey_shoulder = 0;
  bool harmonic = false;   // echoes of the second harmonic, sent at half the probe's frequency
  bool downshift = false;  // attenuation lowers the centre frequency with depth
  // Depth over width of the receiving aperture, which grows up to the whole one; 0: always whole.
  double receive_f_number = 0;
  // Unsharp masking of grey levels: 0 none; size of its box.
  double edge_enhancement = 0, edge_size_m = 3e-3;

  double pictureGain_db() const { return gain_db + examiner_gain_db; }
};

// Relief of the ventricles' inner surfaces, for the picture and its echoes only
// (motion/surfaces/trabeculae.h).
struct TrabeculaeSettings {
  double deviation_m = 0;  // standard deviation of its height about the mesh; 0: none
  double scale_m = 5e-3;   // about half the distance between ridges
  int seed = 1;
  double most_m() const { return 2 * deviation_m; }  // largest height. Our choice
};

// Leaflets and cusps of the valves as bodies (motion/surfaces/leaflet_bodies.h), chordae
// (motion/surfaces/chordae.h) and fibrous rings. In the picture only.
struct LeafletSettings {
  double thickness_m = 0;  // at the hinge; 0: sheets without thickness
  double cusp_m = 0;       // the same of aortic and pulmonary cusps
  double chordae_m = 0;    // diameter of the mitral valve's chordae; 0: none
  // Cords of the fibrous rings of mitral and tricuspid valves (motion/surfaces/valve_rings.h):
  // diameter, 0: none; backscatter across their fibres relative to the leaflets'.
  double annulus_m = 0, annulus_db = 16;
};

// Coherent echoes of material scatterers (src/speckle).
struct SpeckleSettings {
  bool on = false;
  int seed = 1;
  double per_cell = 3;             // scatterers per resolution cell
  double smoothing_m = 0.7e-3;     // full width at half maximum, along the lines; 0: none
  double tissue_time_s = 0;        // renewal time of tissue scatterers; 0: never
  double surroundings_time_s = 0;  // of chest wall and lung; 0: as tissue_time_s
  double blood_time_s = 0.01;  // renewal time of blood scatterers; our choice: well under a frame
  // Backscatter that varies in space and moves with the tissue. Log-normal with mean 1: the sum of
  // two fields of equal variance, an isotropic one and one of layers across the beam, of the given
  // thickness and width. Standard deviation; 0: none.
  double heterogeneity_db = 0;
  double heterogeneity_fine_m = 1.2e-3;
  double heterogeneity_layer_m = 1e-3, heterogeneity_coarse_m = 12e-3;
  int heterogeneity_seed = 1;
  // Backscatter of muscle fibres along their axis, relative to that across it, as a loss; 0: none.
  double anisotropy_db = 0;
  double helix_angle_rad =
      1.0471975511965976;  // at the endocardium; the negative at the epicardium
};

enum class TracerChoice { automatic, slice, embree };
enum class InterfaceEcho { automatic, centre, cell };
enum class Normals { automatic, facet, smooth };

struct AccuracySettings {
  int rays_per_beam = 1;
  int elevation_slices = 1;  // 1, 3 or 5: scene/elevation_slices.h
  TracerChoice tracer = TracerChoice::automatic;
  // At the scan line, or integrated over the beam's cell (plane slice only; automatic: whenever
  // possible).
  InterfaceEcho interface_echo = InterfaceEcho::automatic;
  // Angles of incidence from facets, or from interpolated normals of the Loop limit surface.
  // automatic: smooth with refraction, if the surfaces have such normals.
  Normals normals = Normals::automatic;
  SourcePlace normals_place;
  // Refraction "auto" is off if echoes move by less than this many beam widths, by the rule of
  // frame/echo_shift.h. Our choice.
  double refraction_tolerance_beam_widths = 0.25;
  // Rolling acquisition: number of lines that share an instant. Our choice, from the study's
  // measurements.
  int rolling_lines = 32;
  // Cells of the tissue's motion field along the diagonal of the moving surfaces. Our choice:
  // motion/interior/README.md has the error and the time of others.
  int motion_field_cells = 48;
  // Request for the cheapest settings within this error (study/tolerance.h), not part of the
  // rendered scene.
  std::optional<double> tolerance_db;
  SourcePlace tolerance_place;
};

enum class ExrCompression { none, rle, zips, zip, piz, pxr24 };  // pxr24 loses: 24-bit floats
enum class ExrPixel { whole, half };                             // 32 or 16 bits a value
enum class CineCodec { mjpg, ffv1 };

struct OutputSettings {
  bool exr = true, cine = true, png = false, report = true;
  bool dicom = false, volumes = true;
  std::vector<Channel> channels{Channel::y};
  bool channels_given = false;  // by the scene
  ExrCompression exr_compression = ExrCompression::none;
  ExrPixel exr_pixel = ExrPixel::whole;
  CineCodec codec = CineCodec::mjpg;
  int jpeg_quality = 95;
  int width = 800, height = 600;  // pixels
  bool ecg = true, depth_ticks = true;

  bool pictures() const { return cine || png || dicom; }  // scan-converted frames are made
};

// Ground truth of every frame, written beside its picture; only what is requested is computed.
struct TruthSettings {
  bool labels = false;    // truth/labels_0000.png: the picture's pixels
  bool contours = false;  // truth/contours.json: per structure and frame
  bool tracks = false;    // truth/tracks.npz: material points over the loop
  bool function = false;  // truth/function.json: volumes, strain, thickness, excursions
  // Labels of structures or roles in the label pictures; empty: closed structures from 1, in the
  // scene's order.
  std::vector<std::pair<std::string, int>> label_numbers;
  bool papillary_in_cavity = false;  // papillary muscles count as cavity in the label pictures
  int track_count = 1000;            // material points
  // Contours whose visible points are computed; empty: all. Not a key.
  std::vector<Role> visible_roles{};
  SourcePlace labels_place, tracks_place, function_place;

  bool any() const { return labels || contours || tracks || function; }
};

struct Scene {
  std::filesystem::path file;
  MediumId background{};
  std::vector<Medium> media;     // resolved at the probe's frequency
  double unit_volume_m3 = 1e-6;  // V of Eq. 4
  Probe probe;
  std::optional<ViewPlacement> view;  // until the pose is computed from the structures
  Acquisition acquisition;
  MotionSettings motion;
  std::vector<Structure> structures;
  EffectSwitches effects;
  TrabeculaeSettings trabeculae;
  LeafletSettings leaflets;
  SpeckleSettings speckle;
  ArtefactSettings artefacts;
  SignalSettings signal;
  AccuracySettings accuracy;
  OutputSettings output;
  TruthSettings truth;
  std::vector<std::string> warnings;  // about valid but unlikely input, one line each

  const Medium& medium(MediumId id) const { return media[index(id)]; }
};

}  // namespace echocine
