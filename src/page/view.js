// The page of a scene before it is rendered.
"use strict";

(() => {
  const { data, byId, element, number, fixed } = page;
  const { view, frames, probe } = data;

  function showHead() {
    byId("title").textContent = data.title;
    byId("subtitle").textContent = `${view.structures.length} structures in ${data.background}. `
      + (view.sees_any ? view.sight : "The sector shows no structure.");
    byId("foot").textContent = `EchoCine ${data.version}. Meshes are drawn with fewer triangles than are traced: the table says how many.`;
    if (!view.sees_any) {
      byId("blind").hidden = false;
      byId("blind-words").textContent = `${view.sight} Give probe.view to place it by the heart's anatomy, or change probe.apex and probe.axis, motion.mesh_unit or motion.mesh_scale.`;
    }
    const warnings = data.warnings.filter((w) => view.sees_any || !w.startsWith("nothing can be seen: no scan line"));
    if (!warnings.length) return;
    byId("warnings").hidden = false;
    byId("warnings").querySelector("ul").append(...warnings.map((w) => element("li", {}, w)));
  }

  function showSlice() {
    const [{ type, text }] = page.frames("slice");
    const image = element("img", { class: "picture", src: `data:${type};base64,${text}`, width: view.picture.width,
      height: view.picture.height, alt: "The first frame's picture" });
    byId("slice").append(image);
    return image;
  }

  function showProbe() {
    const mm = (m, decimals = 1) => `${fixed(1e3 * m, decimals)} mm`;
    const facts = [["kind", probe.kind]];
    if (probe.kind === "linear") facts.push(["width", mm(probe.last_offset_m - probe.first_offset_m)]);
    else facts.push(["sector", `${fixed((probe.last_angle_rad - probe.first_angle_rad) * 180 / Math.PI, 1)}°`]);
    if (probe.kind === "curvilinear") facts.push(["face radius", mm(probe.face_radius_m)]);
    facts.push(["depth", `${fixed(1e3 * probe.min_depth_m, 1)} to ${mm(probe.max_depth_m)}`],
      ["frequency", `${number(probe.frequency_hz / 1e6)} MHz`], ["lines × samples", `${probe.lines} × ${probe.samples}`]);
    page.facts(byId("probe"), facts);
    const list = (v, digits) => `[${v.map((x) => Number(x.toPrecision(digits))).join(", ")}]`;
    byId("pose").textContent = `apex = ${list(view.pose.origin_mm.map((x) => x / view.unit_mm), 7)}\n`
      + `axis = ${list(view.pose.depth, 6)}\nlateral = ${list(view.pose.lateral, 6)}`;
  }

  function showStructures() {
    const span = (box, i) => `${fixed(box[0][i], 1)} to ${fixed(box[1][i], 1)}`;
    page.table(byId("structures"), {
      columns: [{ label: "structure" }, { label: "medium" }, { label: "role" }, { label: "kind" }, { label: "in the sector" },
        { label: "extent, mm", number: true }, { label: "x from the probe, mm", number: true }, { label: "y, mm", number: true },
        { label: "z, mm", number: true }, { label: "triangles", number: true }, { label: "drawn", number: true },
        { label: "keyframes", number: true }],
      rows: view.structures.map((s) => [s.name, s.medium, s.role, s.membrane ? "membrane" : "closed", s.seen ? "yes" : "no",
        HeartView.extent(s), span(s.probe_box_mm, 0), span(s.probe_box_mm, 1), span(s.probe_box_mm, 2),
        String(s.triangles), String(s.shown), String(s.keyframes)]) });
  }

  showHead();
  const image = showSlice();
  const space = new HeartView(byId("space"), view);
  page.parts.space = space;
  const describe = (k) => `frame ${frames.index[k]} · ${fixed(frames.time_s[k], 3)} s · phase ${fixed(frames.phase[k], 3)}`;
  const player = new Player(space.below, { loops: [], count: frames.index.length,
    rate_hz: data.acquisition.frame_rate_hz / frames.stride, describe });
  page.parts.player = player;
  player.addEventListener("frame", (event) => space.showPhase(frames.phase[event.detail.index]));
  space.showPhase(frames.phase[0]);
  // Of one frame only, so the plane carries it while that frame is shown.
  image.decode().then(() => {
    space.setPicture(image);
    const follow = (k) => space.dimPicture(k !== 0);
    player.addEventListener("frame", (event) => follow(event.detail.index));
    follow(player.wanted);
  }, () => {});
  showProbe();
  showStructures();
})();
