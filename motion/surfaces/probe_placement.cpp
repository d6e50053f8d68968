#include "motion/surfaces/probe_placement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/box.h"
#include "core/units.h"
#include "motion/mesh/mesh_check.h"
#include "motion/mesh/world_place.h"
#include "motion/surfaces/end_diastole.h"
#include "motion/surfaces/keyframe_set.h"
#include "motion/views/heart_marks.h"
#include "scene/probe_pose.h"
#include "scene/scan_geometry.h"
#include "scene/view_names.h"

namespace echocine {

namespace {

bool hasVessel(const std::vector<RoleSurface>& surfaces) {
  return std::any_of(surfaces.begin(), surfaces.end(),
                     [](const RoleSurface& s) { return s.role == Role::aorta; });
}

// The scene with some of its structures alone.
Scene sceneOf(const Scene& scene, std::vector<Structure> structures) {
  Scene part;
  part.motion = scene.motion;
  part.structures = std::move(structures);
  return part;
}

// Phase of the largest left ventricle; 0 without one, or if it does not move.
double endDiastole(const Scene& scene) {
  const auto ventricle = ventricleOf(scene);
  if (!ventricle) return 0;
  const Structure& structure = scene.structures[index(*ventricle)];
  if (structure.keyframes.size() < 2) return structure.keyframes.front().phase;
  const KeyframeSet set = readKeyframes(sceneOf(scene, {structure}));
  const std::size_t largest = largestKeyframe(structure.keyframes.size(), [&](std::size_t k) {
    return signedVolume(set.structures.front()[k].mesh);
  });
  return structure.keyframes[largest].phase;
}

Structure atPhase(Structure structure, double phase) {
  std::vector<double> phases;
  for (const Keyframe& k : structure.keyframes) phases.push_back(k.phase);
  structure.keyframes = {Keyframe(structure.keyframes[nearestKeyframe(phase, phases)])};
  return structure;
}

// Input of the search for a view: the meshes of one instant, in the world.
std::vector<RoleSurface> heartAtEndDiastole(const Scene& scene) {
  const double phase = endDiastole(scene);
  std::vector<Structure> parts;
  for (const Structure& structure : scene.structures)
    if (const Role role = roleOf(structure); role != Role::none && role != Role::surroundings)
      parts.push_back(atPhase(structure, phase));
  const Scene heart = sceneOf(scene, std::move(parts));
  const KeyframeSet set = readKeyframes(heart);
  std::vector<RoleSurface> surfaces;
  for (std::size_t s = 0; s < heart.structures.size(); ++s) {
    const TriangleMesh& mesh = set.structures[s].front().mesh;
    RoleSurface surface{roleOf(heart.structures[s]), heart.structures[s].name, {}, mesh.triangles};
    for (const Vec3d& p : mesh.positions) surface.points_m.push_back(worldPlace(scene.motion, p));
    surfaces.push_back(std::move(surface));
  }
  return surfaces;
}

Pose frameOf(const ProbePose& pose) {
  return {pose.apex, pose.lateral, cross(pose.axis, pose.lateral), pose.axis};
}

// Shifted along its own axes, then turned and tilted.
Pose moved(const Pose& pose, const ViewPlacement& by) {
  Pose p = pose;
  p.origin = pose.origin + by.shift_m.x * pose.x_axis + by.shift_m.y * pose.y_axis +
             by.shift_m.z * pose.z_axis;
  return turnedAndTilted(p, by.rotate_rad, by.tilt_rad);
}

// An edge of a mesh meets the imaging plane within the sector.
bool cuts(const Probe& probe, const std::vector<RoleSurface>& heart) {
  for (const RoleSurface& surface : heart) {
    std::vector<Vec3d> at;
    for (const Vec3d p : surface.points_m) at.push_back(probe.pose.fromWorld(p));
    for (const Triangle& t : surface.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3d a = at[t[k]], b = at[t[(k + 1) % 3]];
        if ((a.y < 0) == (b.y < 0)) continue;
        const Vec3d at_plane = a + a.y / (a.y - b.y) * (b - a);
        if (inScanArea(probe, at_plane.x, at_plane.z)) return true;
      }
  }
  return false;
}

// From the pose of the view to that of the probe: a curvilinear one's apex lies behind its face.
void place(const ViewPlacement& placement, const HeartMarks& marks, double mesh_unit_m,
           Probe& probe) {
  Pose pose = moved(frameOf(standardPose(placement.view, marks.frame, marks.outside_m, marks.wall_m,
                                         marks.front_m)),
                    placement);
  pose.origin = pose.origin - probe.face_radius_m * pose.z_axis;
  probe.pose = writable(pose, mesh_unit_m);
  if (probe.max_depth_m > 0) return;
  const ProbePose at{probe.pose.origin, probe.pose.z_axis, probe.pose.x_axis};
  const double scale = marks.frame.scale;
  const double deep_m =
      (probe.isFan()
           ? fittingDepth(marks.outside_m, at, probe.last_angle_rad, scale)
           : fittingDepth(marks.outside_m, at, probe.first_offset_m, probe.last_offset_m, scale)) +
      marks.wall_m - probe.face_radius_m;
  probe.max_depth_m = writableDepth(std::max(deep_m, 2 * probe.min_depth_m + 1e-3));
  if (probe.focus_m == 0) probe.focus_m = defaultFocus(probe.max_depth_m);
}

std::string whereTheyAre(const Probe& probe, const std::vector<RoleSurface>& heart) {
  Box box;
  for (const RoleSurface& s : heart)
    for (const Vec3d p : s.points_m) box.add(probe.pose.fromWorld(p));
  const auto mm = [](double m) { return std::round(millimetresFromMetres(m)); };
  return fmt::format(
      "from the probe they lie {} to {} mm lateral, {} to {} mm in elevation, {} to {} "
      "mm deep",
      mm(box.lo.x), mm(box.hi.x), mm(box.lo.y), mm(box.hi.y), mm(box.lo.z), mm(box.hi.z));
}

// The first view that cuts a mesh, this one before the others.
std::string viewThatCuts(const Scene& scene, const HeartMarks& marks,
                         const std::vector<RoleSurface>& heart) {
  std::vector<View> views{scene.view->view};
  for (const ViewName& name : viewNames()) views.push_back(name.view);
  for (const View view : views) {
    Probe probe = scene.probe;
    ViewPlacement unmoved;
    unmoved.view = view;
    place(unmoved, marks, scene.motion.mesh_unit_m, probe);
    if (cuts(probe, heart))
      return fmt::format("view = \"{}\" without shift_mm, tilt_deg and rotate_deg does",
                         keyOf(view));
  }
  return "a depth_mm or a sector that holds them does";
}

void tellGuesses(const HeartMarks& marks, Scene& scene) {
  const auto tell = [&](const std::string& what) {
    scene.warnings.push_back(atPlace(scene.view->place, what));
  };
  for (const std::string& what : marks.told) tell(what);
  const View view = scene.view->view;
  if (!marks.aortic_found && (view == View::a3c || view == View::plax))
    tell(
        "no structure has the role of the aortic valve: the plane uses its position in an average "
        "heart; give "
        "a "
        "structure role = \"aortic_valve\" or \"aorta\"");
}

}  // namespace

Scene placed(Scene scene) {
  if (!scene.view) return scene;
  const ViewPlacement placement = *scene.view;
  const std::vector<RoleSurface> heart = heartAtEndDiastole(scene);
  const HeartMarks marks = findHeart(heart, placement.place);
  const auto fail = [&](const std::string& what) {
    throw SceneError(atPlace(placement.place, what));
  };
  if (placement.view == View::psax_base && !marks.aortic_found)
    fail(
        hasVessel(heart)
            ? "the structure with role aorta does not reach the left ventricle, so its valve is "
              "not found; accepted: an aorta that does, or a structure with role = \"aortic_valve\""
            : "\"psax-base\" is found from the aortic valve, accepted: role = \"aortic_valve\" or "
              "\"aorta\" of one structure, or view = \"psax-mid\"");
  Probe probe = scene.probe;
  place(placement, marks, scene.motion.mesh_unit_m, probe);
  if (!cuts(probe, heart))
    fail(fmt::format("\"{}\" as shifted and rotated cuts none of the meshes with roles: {}; {}",
                     keyOf(placement.view), whereTheyAre(probe, heart),
                     viewThatCuts(scene, marks, heart)));
  tellGuesses(marks, scene);
  scene.probe = probe;
  // There is no chest wall between this probe and the heart.
  if (isTransoesophageal(placement.view))
    scene.artefacts.acoustic_window = scene.artefacts.shading = false;
  scene.view.reset();
  return scene;
}

std::pair<Scene, std::shared_ptr<const MeshMotion>> placedWithMotion(Scene given) {
  Scene scene = placed(std::move(given));
  auto motion = std::make_shared<const MeshMotion>(scene);
  return {std::move(scene), std::move(motion)};
}

Pose turnedAndTilted(const Pose& pose, double rotate_rad, double tilt_rad) {
  const auto turned = [](Vec3d from, Vec3d towards, double rad) {
    return std::cos(rad) * from + std::sin(rad) * towards;
  };
  Pose p = pose;
  p.x_axis = turned(pose.x_axis, pose.y_axis, rotate_rad);
  p.y_axis = cross(pose.z_axis, p.x_axis);
  p.z_axis = turned(pose.z_axis, p.y_axis, tilt_rad);
  p.y_axis = cross(p.z_axis, p.x_axis);
  return p;
}

}  // namespace echocine
