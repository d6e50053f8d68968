#include "frame/plan_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/free_list.h"
#include "core/parallel.h"
#include "core/units.h"
#include "frame/echo_shift.h"
#include "frame/mean_loss.h"
#include "frame/mesh_placement.h"
#include "geometry/frame_geometry.h"
#include "geometry/plane_slice.h"
#include "motion/surfaces/beam_to_axis.h"
#include "motion/surfaces/heart_size.h"
#include "motion/surfaces/motion_warnings.h"
#include "scene/elevation_slices.h"
#include "scene/names.h"
#include "scene/path_length.h"
#include "scene/role.h"
#include "scene/scan_geometry.h"
#include "scene/scene_keys.h"
#include "trace/beam_rays.h"

namespace echocine {

namespace {

// Frames that are looked at: end-diastole, mid-systole, end-systole, early and late filling. Our
// choice.
constexpr double kProbePhases[] = {0.0, 0.15, 0.36, 0.5, 0.8};

// The box that holds all scan lines, and the rays of their beams.
Box sectorBox(const Probe& probe, const EffectPlan& plan) {
  constexpr double kFarthest = 9;  // no ray is so many deviations off
  const BeamRays beams(probe, beamSpread(plan, 0));
  Box box;
  Probe outline = probe;
  outline.lines = std::max(probe.lines, 64) | 1;  // odd: the middle line reaches deepest
  for (int i = 0; i < outline.lines; ++i) {
    const LineGeometry line = lineGeometry(outline, i);
    box.add(line.origin);
    box.add(line.origin + probe.max_depth_m * line.direction);
    for (int side = 0; side < 8 && plan.rays_per_beam > 1; ++side) {
      const auto far = [&](int bit) { return side & bit ? kFarthest : -kFarthest; };
      const Ray ray = beams.through(line, far(1), far(2), far(4)).ray;
      box.add(ray.origin);
      box.add(ray.origin + probe.max_depth_m * ray.direction);
    }
  }
  return box;
}

bool overlap(const Box& a, const Box& b) {
  return a.lo.x <= b.hi.x && b.lo.x <= a.hi.x && a.lo.y <= b.hi.y && b.lo.y <= a.hi.y &&
         a.lo.z <= b.hi.z && b.lo.z <= a.hi.z;
}

bool sameAsAllMedia(const Scene& scene, const Medium& medium) {
  return std::ranges::all_of(scene.media,
                             [&](const Medium& m) { return sameInterface(m, medium); });
}

// A closed structure of the background's medium shows only where it hides another one.
bool invisible(const Scene& scene, const Structure& structure) {
  if (structure.membrane && !hasThickness(scene, structure))
    return sameAsAllMedia(scene, scene.medium(structure.medium));
  const Medium& medium = scene.medium(structure.medium);
  if (wants(scene, Channel::medium) || !sameMedium(medium, scene.medium(scene.background)))
    return false;
  return std::ranges::none_of(scene.structures, [&](const Structure& other) {
    return !other.membrane && other.priority <= structure.priority &&
           !sameMedium(scene.medium(other.medium), medium);
  });
}

void dropStructures(const Scene& scene, const MeshMotion& motion, LoopPlan& plan) {
  Probe longest = scene.probe;
  longest.max_depth_m = longestPath(scene);
  Box sector = sectorBox(longest, plan.effects);
  if (plan.effects.elevation_slices > 1) {
    sector.lo.y -= elevationReach(scene);
    sector.hi.y += elevationReach(scene);
  }
  if (plan.effects.refraction) {  // rays may leave the imaging plane: as far as they are long
    const double reach = longest.max_depth_m;
    sector.add(sector.lo - Vec3d{reach, reach, reach});
    sector.add(sector.hi + Vec3d{reach, reach, reach});
  }
  for (std::size_t s = 0; s < scene.structures.size(); ++s) {
    const Structure& structure = scene.structures[s];
    const std::size_t triangles = motion.surfaces()[s].triangles.size();
    plan.triangles_given += triangles;
    std::string reason;
    if (!overlap(sector, motion.loopBoxes()[s]))
      reason = "outside the sector in every frame";
    else if (invisible(scene, structure))
      reason = "same impedance and speed as all around it";
    if (reason.empty()) {
      plan.triangles_kept += triangles;
    } else {
      plan.left_out[s] = true;
      plan.interfaces.push_back({structure.name, reason});
    }
  }
  for (std::size_t a = 0; a < scene.media.size(); ++a)
    for (std::size_t b = a + 1; b < scene.media.size(); ++b)
      if (sameInterface(scene.media[a], scene.media[b]))
        plan.interfaces.push_back(
            {fmt::format("interface {}/{}", scene.media[a].name, scene.media[b].name),
             "same impedance and speed"});
}

// And every keyframe's own phase: what is in view nowhere else would be missed.
std::set<double> lookedAt(const Scene& scene) {
  std::set<double> phases(std::begin(kProbePhases), std::end(kProbePhases));
  for (const Structure& structure : scene.structures)
    for (const Keyframe& keyframe : structure.keyframes) phases.insert(keyframe.phase);
  return phases;
}

// Among equal shifts that of the earliest phase.
EchoShift worstShift(const Scene& scene, const MeshMotion& motion, const LoopPlan& plan) {
  struct Space {
    FrameGeometry geometry;
    SurfaceFrame surfaces;
  };
  const std::set<double> in_order = lookedAt(scene);
  const std::vector<double> phases(in_order.begin(), in_order.end());
  const EchoShiftMeter meter(scene, plan.effects);
  std::vector<EchoShift> shifts(phases.size());
  FreeList<Space> spaces;
  parallelBlocks(phases.size(), 1, [&](std::size_t begin, std::size_t end) {
    const std::shared_ptr<Space> space = spaces.borrow([&] {
      return std::make_unique<Space>(Space{FrameGeometry(motion.surfaces(), plan.left_out), {}});
    });
    for (std::size_t i = begin; i < end; ++i) {
      motion.frameAt(phases[i], space->surfaces);
      space->geometry.update(space->surfaces);
      shifts[i] = meter.measure(space->geometry, phases[i]);
    }
  });
  return *std::max_element(shifts.begin(), shifts.end());
}

// Traces some frames with refraction and leaves it out when the image could hardly show it.
void decideRefraction(const Scene& scene, const MeshMotion& motion, LoopPlan& plan) {
  if (!plan.effects.refraction || scene.effects.refraction != Switch::automatic) return;
  EffectDecision& decision = plan.effects.decision(Effect::refraction);
  if (scene.accuracy.tracer == TracerChoice::slice) {
    plan.effects.refraction = decision.on = false;
    decision.reason = "accuracy.tracer selects the plane slice, whose rays are straight";
    return;
  }
  const EchoShift worst = worstShift(scene, motion, plan);
  const double tolerance = scene.accuracy.refraction_tolerance_beam_widths;
  plan.effects.refraction = decision.on = worst.beam_widths >= tolerance && worst.metres > 0;
  decision.reason =
      worst.metres > 0
          ? fmt::format(
                "echoes move by up to {:.2g} mm, {:.2g} of the beam's width, {:.0f} mm deep "
                "at phase {:.2f} (accepted: {:g})",
                millimetresFromMetres(worst.metres), worst.beam_widths,
                millimetresFromMetres(worst.depth_m), worst.phase, tolerance)
          : "no echo moves";
}

void chooseTracer(const Scene& scene, LoopPlan& plan) {
  const AccuracySettings& a = scene.accuracy;
  const bool beams = plan.effects.rays_per_beam > 1;
  plan.slice = a.tracer != TracerChoice::embree && !plan.effects.refraction && !beams;
  plan.tracer_reason =
      a.tracer != TracerChoice::automatic ? "accuracy.tracer selects it"
      : beams      ? fmt::format("{} rays per beam, each by itself", plan.effects.rays_per_beam)
      : plan.slice ? "straight rays in one plane meet only the facets on it"
                   : "refracted rays leave the imaging plane";
  if (!plan.slice && plan.effects.elevation_slices > 1) {
    plan.effects.elevation_slices = 1;
    EffectDecision& decision = plan.effects.decision(Effect::elevation);
    decision.on = false;
    decision.reason = "only the plane slice has several slices; " + plan.tracer_reason;
  }
  plan.cell_echoes = !beams && plan.effects.reflection && scene.probe.lines > 1 &&
                     a.interface_echo != InterfaceEcho::centre;
  plan.echo_reason =
      plan.cell_echoes && plan.slice
          ? "integrated over the beam's cell: the contour between lines is known"
      : plan.cell_echoes
          ? "integrated over the beam's cell: neighbouring lines' crossings of one wall are linked"
      : a.interface_echo == InterfaceEcho::centre && !beams
          ? "at each line's centre: accuracy.interface_echo selects it"
      : beams ? "at each ray, averaged over the beam"
              : "at each line's centre";
}

void lookAtFrames(const Scene& scene, const MeshMotion& motion, LoopPlan& plan) {
  // The trace leaves out structures without an interface; their speckle still shows them.
  const SurfaceSet unseen = plan.effects.contrast ? plan.left_out : SurfaceSet{};
  PlaneSlice slice(motion.surfaces(), scene.probe, unseen);
  SurfaceFrame frame;
  std::size_t crossings = 0;
  for (const double phase : kProbePhases) {
    motion.frameAt(phase, frame, false);
    slice.update(frame);
    plan.triangles_met = std::max(plan.triangles_met, slice.edges().size());
    for (const RayCrossings& line : slice.lines()) crossings += line.crossings.size();
  }
  if (!plan.effects.shows()) {
    plan.warnings.push_back(
        fmt::format("{}: all structures and their surroundings are of one medium", kNothingSeen));
  } else if (unseen.count() == scene.structures.size() ||
             (crossings == 0 && plan.effects.rays_per_beam == 1)) {
    plan.warnings.push_back(fmt::format(
        "{}: no scan line meets a structure in the frames examined; {} "
        "(probe.view places the probe by the heart's anatomy; else probe.apex and probe.axis, "
        "motion.mesh_unit and motion.mesh_scale)",
        kNothingSeen, describePlacement(scene, meshesBox(motion))));
  }
}

// Walls are filled: of a heart with chambers, one whose own is not given hides it.
void tellWallsWithoutChambers(const Scene& scene, LoopPlan& plan) {
  constexpr std::pair<Role, Role> kChambers[] = {{Role::lv_wall, Role::lv_cavity},
                                                 {Role::rv_wall, Role::rv_cavity},
                                                 {Role::la_wall, Role::la},
                                                 {Role::ra_wall, Role::ra}};
  const auto isThere = [&](Role role) { return structureOf(scene, role).has_value(); };
  if (std::none_of(std::begin(kChambers), std::end(kChambers),
                   [&](const auto& pair) { return isThere(pair.second); }))
    return;
  for (const auto& [wall, chamber] : kChambers) {
    const std::optional<SurfaceId> found = structureOf(scene, wall);
    if (!found || isThere(chamber)) continue;
    const Structure& structure = scene.structures[index(*found)];
    plan.warnings.push_back(atPlace(
        structure.place,
        fmt::format("{}: is {} and no structure is {}: its content is shown as wall or background, "
                    "not as blood; add the chamber's surface with role = \"{}\"",
                    structure.name, nameOf(wall), nameOf(chamber), nameOf(chamber))));
  }
}

void addWarnings(const Scene& scene, const MeshMotion& motion, LoopPlan& plan) {
  plan.warnings = motion.repairNotes();
  tellWallsWithoutChambers(scene, plan);
  for (const auto& told : {sizeWarnings(scene, motion), motionWarnings(scene, motion)})
    plan.warnings.insert(plan.warnings.end(), told.begin(), told.end());
}

// Ribs and lung beside the apical window add clutter that the parasternal one hardly has.
void weighClutter(const Scene& scene, const MeshMotion& motion, EffectPlan& plan) {
  const double squared_sine = squaredSineToLongAxis(scene, motion);
  plan.clutter_window_db = scene.artefacts.clutter_parasternal_db * squared_sine * squared_sine;
  plan.decision(Effect::clutter).reason +=
      fmt::format(", {:.1f} dB by the direction of the beam to the left ventricle's axis",
                  plan.clutter_window_db);
}

}  // namespace

LoopPlan planLoop(const Scene& scene, const MeshMotion& motion, PlanWords words) {
  refuseOutOfRange(scene);
  LoopPlan plan;
  plan.effects = planEffects(scene);
  const bool warns = words == PlanWords::with_warnings;
  if (warns)
    addWarnings(scene, motion, plan);
  else
    refuseInverted(scene, motion);
  dropStructures(scene, motion, plan);
  decideRefraction(scene, motion, plan);
  plan.smooth_normals =
      motion.hasNormals() && (scene.accuracy.normals == Normals::smooth || plan.effects.refraction);
  chooseTracer(scene, plan);
  if (scene.signal.tgc == Tgc::mean && plan.effects.attenuation && wantsPicture(scene))
    plan.effects.mean_loss = meanLoss(scene, motion, plan);
  if (plan.effects.clutter && scene.artefacts.clutter_parasternal_db != 0 &&
      !scene.probe.isFullTurn())  // within the chest, lines point all round
    weighClutter(scene, motion, plan.effects);
  if (warns) lookAtFrames(scene, motion, plan);
  return plan;
}

}  // namespace echocine
