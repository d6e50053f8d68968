#include "output/function_json.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/box.h"
#include "core/units.h"

namespace echocine {

namespace {

using Json = nlohmann::ordered_json;

// Null where there is nothing to be measured.
Json numberJson(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

template <typename T>
Json orNull(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}

Json segmentsJson(const SegmentStrains& segments, bool with_empty) {
  Json list = Json::array();
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const SegmentStrain& s = segments[i];
    if (!with_empty && std::isnan(s.thickness_mm)) continue;
    list.push_back({{"segment", i + 1},
                    {"name", kAhaNames[i]},
                    {"longitudinal", numberJson(s.longitudinal)},
                    {"radial", numberJson(s.radial)},
                    {"circumferential", numberJson(s.circumferential)},
                    {"thickness_mm", numberJson(s.thickness_mm)}});
  }
  return list;
}

Json millimetres(Vec3d p) {
  return {millimetresFromMetres(p.x), millimetresFromMetres(p.y), millimetresFromMetres(p.z)};
}

Json pixels(Vec3d p, const PictureGeometry& picture) {
  const PixelPoint at = pixelOf(picture, p);
  return {at.x, at.y};
}

Json placeJson(Vec3d p, const PictureGeometry& picture) {
  return {{"mm", millimetres(p)}, {"px", pixels(p, picture)}};
}

Json ringJson(const std::optional<RingFrame>& ring, const PictureGeometry& picture) {
  if (!ring) return {};
  Json hinges = Json::array();
  if (ring->hinges_m)
    for (const Vec3d p : {ring->hinges_m->first, ring->hinges_m->second})
      hinges.push_back(placeJson(p, picture));
  return {{"middle", placeJson(ring->middle_m, picture)}, {"hinges", hinges}};
}

Json frameJson(const FrameRecord& record, const FunctionFrame& f, const PictureGeometry& picture) {
  return {{"index", record.frame},
          {"time_s", record.time_s},
          {"global_longitudinal_strain", f.global_longitudinal_strain},
          {"view_longitudinal_strain", numberJson(f.view_longitudinal_strain)},
          {"volume_ml", f.volume_ml},
          {"biplane_ml", f.biplane_ml},
          {"single_plane_ml", orNull(f.single_plane_ml)},
          {"length_mm", f.length_mm},
          {"base_descent_mm", f.base_descent_mm},
          {"tricuspid_descent_mm", f.tricuspid ? Json(f.tricuspid_descent_mm) : Json()},
          {"twist_deg", f.twist_deg},
          {"sphericity", f.sphericity},
          {"base", placeJson(f.axis.base_m, picture)},
          {"apex", placeJson(f.axis.apex_m, picture)},
          {"mitral_ring", ringJson(f.mitral, picture)},
          {"aortic_ring", ringJson(f.aortic, picture)},
          {"tricuspid_ring", ringJson(f.tricuspid, picture)},
          {"segments", segmentsJson(f.segments, true)},
          {"view_segments", segmentsJson(f.view_segments, false)}};
}

Json volumesJson(std::span<const FunctionFrame> frames) {
  const auto kind = [&](const auto& volume) {
    double most = 0, least = Box::kFar;
    for (const FunctionFrame& f : frames) {
      most = std::max(most, volume(f));
      least = std::min(least, volume(f));
    }
    return Json{{"end_diastolic_ml", numberJson(most)},
                {"end_systolic_ml", numberJson(least)},
                {"ejection_fraction", most > 0 ? numberJson(1 - least / most) : Json()}};
  };
  Json json{{"exact", kind([](const FunctionFrame& f) { return f.volume_ml; })},
            {"biplane", kind([](const FunctionFrame& f) { return f.biplane_ml; })}};
  if (std::all_of(frames.begin(), frames.end(),
                  [](const FunctionFrame& f) { return f.single_plane_ml.has_value(); }))
    json["single_plane"] = kind([](const FunctionFrame& f) { return *f.single_plane_ml; });
  return json;
}

Json viewJson(const std::optional<ViewOffset>& view) {
  if (!view) return {};
  return {{"label", view->label},
          {"tilt_deg", view->tilt_deg},
          {"rotation_deg", orNull(view->rotation_deg)},
          {"shift_mm", view->shift_mm},
          {"foreshortening_mm", orNull(view->foreshortening_mm)}};
}

double meanThickness(const FunctionFrame& f) {
  double sum = 0;
  int count = 0;
  for (const SegmentStrain& s : f.segments)
    if (std::isfinite(s.thickness_mm)) {
      sum += s.thickness_mm;
      ++count;
    }
  return sum / count;
}

}  // namespace

Json functionJson(std::span<const FrameRecord> records, std::span<const FunctionFrame> frames,
                  const LoopTruth& loop, const PictureGeometry& picture) {
  Json list = Json::array(), events = Json::object();
  double mapse_mm = 0, tapse_mm = 0;
  bool right = false;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    mapse_mm = std::max(mapse_mm, frames[i].base_descent_mm);
    tapse_mm = std::max(tapse_mm, frames[i].tricuspid_descent_mm);
    right |= frames[i].tricuspid.has_value();
    list.push_back(frameJson(records[i], frames[i], picture));
  }
  for (const LoopTruth::Event& e : loop.events)
    events[e.name] = {{"phase", e.phase}, {"time_s", e.time_s}};
  return {{"strain",
           "parts of the first frame's length, Lagrangian, in the middle of the wall; segments 1 "
           "to 17 of the American Heart Association"},
          {"volumes", volumesJson(frames)},
          {"mapse_mm", mapse_mm},
          {"tapse_mm", right ? Json(tapse_mm) : Json()},
          {"valves", events},
          {"view", viewJson(loop.view)},
          {"frames", list}};
}

std::vector<Curve> functionCurves(std::span<const FunctionFrame> frames) {
  std::vector<Curve> curves;
  const auto add = [&](const char* name, const auto& value) {
    Curve& curve = curves.emplace_back(name, std::vector<double>{});
    for (const FunctionFrame& f : frames) curve.second.push_back(value(f));
  };
  add("global_longitudinal_strain",
      [](const FunctionFrame& f) { return f.global_longitudinal_strain; });
  add("view_longitudinal_strain",
      [](const FunctionFrame& f) { return f.view_longitudinal_strain; });
  for (std::size_t s = 0; s < kAhaSegments; ++s) {
    const auto strain = [s](const FunctionFrame& f) { return f.view_segments[s].longitudinal; };
    if (!frames.empty() && std::isfinite(strain(frames.front()))) add(kAhaNames[s], strain);
  }
  add("wall_thickness_mm", meanThickness);
  add("length_mm", [](const FunctionFrame& f) { return f.length_mm; });
  add("base_descent_mm", [](const FunctionFrame& f) { return f.base_descent_mm; });
  add("twist_deg", [](const FunctionFrame& f) { return f.twist_deg; });
  add("volume_ml", [](const FunctionFrame& f) { return f.volume_ml; });
  add("biplane_ml", [](const FunctionFrame& f) { return f.biplane_ml; });
  return curves;
}

}  // namespace echocine
