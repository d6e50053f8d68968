// The page of a comparison.
"use strict";

(() => {
  const { data, byId, element, number, fixed } = page;
  const { summary, frames } = data;
  const kMetrics = data.metrics;  // [key, title] of each
  const bands = Object.keys(summary.bands_after_calibration);
  const rate_hz = summary.real.frame_rate_hz;
  const frame_x = rate_hz ? frames.real_time_s : frames.real_frame;
  const x_name = rate_hz ? "time in the real loop, s" : "frame of the real loop";
  const kBefore = "greys as they are", kAfter = "greys calibrated";

  // Equal frames have no finite PSNR, which JSON cannot hold.
  const value = (metrics, key, digits) => (key === "psnr_db" && metrics[key] === null && metrics.rms === 0 ? "∞"
    : number(metrics[key], digits));
  const at = (group, k) => Object.fromEntries(Object.entries(group).map(([key, values]) => [key, values[k]]));
  const bandName = (name) => (name === "all" ? "band around all boundaries" : `band around ${name}`);

  function showHead() {
    byId("title").textContent = `${summary.synthetic.label} against ${summary.real.label}`;
    byId("subtitle").textContent = `discrepancy ${fixed(summary.discrepancy, 4)} (0 equal, about 1 unrelated) · `
      + `${fixed(summary.discrepancy_as_placed, 4)} before registration · ${summary.frames_counted} of ${summary.frames_total} frames counted`
      + (data.stride > 1 ? ` · this page shows every ${data.stride}th frame, frames.csv has all` : "");
    byId("definition").textContent = `Discrepancy: ${summary.discrepancy_definition}.`;
    byId("foot").textContent = `EchoCine ${summary.version}. The same numbers are in summary.json and frames.csv.`;
    // A loop's own notes return in the comparison's with its name before them.
    const caveats = (summary.scene_fit?.caveats ?? []).map((text) => `where the scene disagrees: ${text}`);
    const all = [...new Set([...caveats, ...summary.notes, ...summary.real.notes, ...summary.synthetic.notes])];
    const notes = all.filter((note) => !all.some((other) => other !== note && other.endsWith(note)));
    byId("notes").hidden = !notes.length;
    byId("notes").querySelector("ul").append(...notes.map((note) => element("li", {}, note)));
  }

  function makePlayer() {
    const describe = (k) => {
      const parts = [`real frame ${frames.real_frame[k]}`];
      if (rate_hz) parts.push(`${fixed(frames.real_time_s[k], 3)} s`);
      parts.push(frames.synthetic_frame[k] === null ? "no synthetic frame shows this instant"
        : `synthetic frame ${fixed(frames.synthetic_frame[k], 2)}`);
      if (frames.synthetic_phase[k] !== null) parts.push(`phase ${fixed(frames.synthetic_phase[k], 3)}`);
      if (frames.discrepancy[k] !== null) parts.push(`discrepancy ${fixed(frames.discrepancy[k], 3)}`);
      if (frames.repeat[k]) parts.push("repeats the previous frame: not counted");
      return parts.join(" · ");
    };
    const loop = (name, label) => ({ label, images: page.frames(name) });
    // The lines in the first two pictures, by name.
    const lines = summary.contours?.length ? ` · white lines: ${summary.contours.join(", ")}` : "";
    return new Player(byId("player"), { rate_hz: (rate_hz ? Math.min(rate_hz, 1000) : 25) / data.stride, describe,
      loops: [loop("real", `real${lines}`), loop("synthetic", `synthetic, registered and calibrated${lines}`),
        loop("difference", "synthetic − real: grey where equal, bright where the synthetic is brighter")] });
  }

  // Means of the loop beside the numbers of the frame that is shown.
  function showNumbers(player) {
    const groups = [[kBefore, frames.before, summary.before_calibration], [kAfter, frames.after, summary.after_calibration],
      ...bands.map((name) => [bandName(name), frames.bands[name], summary.bands_after_calibration[name]])];
    const now = new Map();
    const cell = (group, key) => {
      const made = element("span", {}, "–");
      now.set(made, (k) => (group ? value(at(group, k), key, 4) : number(frames.discrepancy[k], 4)));
      return made;
    };
    const rows = [["Discrepancy", "–", "–", cell(null), fixed(summary.discrepancy, 4),
      ...bands.flatMap(() => ["–", "–"])],
      ...kMetrics.map(([key, label]) => [label, ...groups.flatMap(([, group, mean]) => [cell(group, key), value(mean, key, 4)])])];
    page.table(byId("numbers"), {
      columns: [{ label: "" }, ...groups.flatMap(([label]) => [{ label: `${label}: this frame`, number: true },
        { label: "mean", number: true }])], rows }).classList.add("wrapped-head");
    const show = (k) => now.forEach((text, made) => { made.textContent = text(k); });
    player.addEventListener("frame", (event) => show(event.detail.index));
    show(0);
  }

  function showCurves(player) {
    const chart = (label, series) => {
      const box = element("div", {}, element("h3", {}, label));
      byId("curves").append(box);
      curves(box, { x_name, y_name: "", frame_x, series, player, height_px: 210 });
    };
    chart("Discrepancy", [{ name: "discrepancy", values: frames.discrepancy }]);
    for (const [key, label] of kMetrics)
      chart(label, [{ name: kAfter, values: frames.after[key] }, { name: kBefore, values: frames.before[key] },
        ...bands.map((name) => ({ name: bandName(name), values: frames.bands[name][key], hidden: name !== "all" }))]);
  }

  function showCalibration() {
    const { synthetic_grey: from, real_grey: to } = summary.calibration;
    const points = from.map((grey, i) => [grey, to[i]]);
    if (points.length) points.unshift([0, to[0]]), points.push([255, to.at(-1)]);
    const ends = { min: 0, max: 255, nameLocation: "middle", type: "value" };
    makeChart(byId("calibration"), 300, {
      grid: { left: 34, right: 16, top: 40, bottom: 34, containLabel: true }, legend: { top: 0 },
      tooltip: { trigger: "item", confine: true },
      xAxis: { ...ends, name: "synthetic grey", nameGap: 26 }, yAxis: { ...ends, name: "real grey", nameGap: 36 },
      series: [{ name: "calibration", type: "line", data: points, symbolSize: 6 },
        { name: "unchanged", type: "line", data: [[0, 0], [255, 255]], showSymbol: false, lineStyle: { type: "dashed", width: 1 } }] });
    page.table(byId("calibration"), { columns: [{ label: "synthetic grey" }, ...from.map((g) => ({ label: fixed(g, 1), number: true }))],
      rows: [["real grey", ...to.map((g) => fixed(g, 1))]] });
  }

  function showTime(player) {
    curves(byId("time-curve"), { x_name, y_name: "synthetic frame", frame_x, player, height_px: 240,
      series: [{ name: "synthetic frame", values: frames.synthetic_frame }] });
    const t = summary.time;
    page.facts(byId("time"), [["method", t.method], ["shift", `${number(t.shift_frames)} synthetic frames`],
      ["pace", `${number(t.synthetic_frames_per_real_frame)} synthetic frames per real frame`],
      ["largest warp", `${number(t.largest_warp_frames)} frames`], ["correlation of moving parts", number(t.correlation)],
      ["confidence", fixed(t.confidence, 3)]]);
  }

  // The sector over its picture: edges from the apex, arcs of both radii.
  function sectorOutline(loop) {
    const { apex_px: [x, y], first_deg, last_deg, r_min_px, r_max_px } = loop.sector;
    const point = (r, deg) => {
      const angle = (deg * Math.PI) / 180;
      return `${x + r * Math.sin(angle)} ${y + r * Math.cos(angle)}`;
    };
    const arc = (r) => `M ${point(r, first_deg)} A ${r} ${r} 0 ${last_deg - first_deg > 180 ? 1 : 0} 0 ${point(r, last_deg)}`;
    const edge = (deg) => `M ${x} ${y} L ${point(r_max_px, deg)}`;
    const drawn = (tag, attributes, ...children) => {
      const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
      for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
      made.append(...children);
      return made;
    };
    return drawn("svg", { viewBox: `0 0 ${loop.width} ${loop.height}`, "aria-hidden": "true" },
      drawn("path", { d: [arc(r_min_px), arc(r_max_px), edge(first_deg), edge(last_deg)].join(" ") }));
  }

  // Both loops in one picture, real in green and synthetic in magenta: white where they agree.
  function showOverlay(player) {
    const canvas = element("canvas", { class: "picture", role: "img", "aria-label": "Real and synthetic frame superimposed" });
    const context = canvas.getContext("2d");
    const tinted = document.createElement("canvas"), tint = tinted.getContext("2d");
    const draw = () => {
      const [real, synthetic] = player.loops.map((loop) => loop.canvas);
      for (const c of [canvas, tinted]) [c.width, c.height] = [real.width, real.height];
      for (const [loop, colour] of [[real, "#0f0"], [synthetic, "#f0f"]]) {
        tint.globalCompositeOperation = "source-over";
        tint.drawImage(loop, 0, 0);
        tint.globalCompositeOperation = "multiply";
        tint.fillStyle = colour;
        tint.fillRect(0, 0, tinted.width, tinted.height);
        context.globalCompositeOperation = loop === real ? "source-over" : "lighter";
        context.drawImage(tinted, 0, 0);
      }
    };
    player.addEventListener("frame", draw);
    byId("sectors").append(element("figure", {}, canvas,
      element("figcaption", {}, "as registered, at the loops' frame: real green, synthetic magenta, both white")));
  }

  function showSpace(player) {
    for (const [label, picture] of [["real", data.sector_real], ["synthetic", data.sector_synthetic]])
      byId("sectors").append(element("figure", {},
        element("div", { class: "outlined" }, sectorOutline(summary[label]),
          element("img", { class: "picture", src: picture, alt: `First frame of the ${label} loop with its sector` })),
        element("figcaption", {}, `${label}: sector as ${summary[label].sector.source}; flat grey is masked (colour, text)`)));
    showOverlay(player);
    const s = summary.space, b = summary.beam_space;
    page.facts(byId("space"), [["method", s.method], ["shift", `${fixed(s.shift_px[0], 2)}, ${fixed(s.shift_px[1], 2)} px of the real picture`],
      ["scale", fixed(s.scale, 4)], ["rotation", `${fixed(s.rotation_deg, 2)}°`],
      ["used", s.used ? "yes" : "no: the unregistered sectors are best"],
      ["dissimilarity E", fixed(s.unlike, 3)],
      ["confidence", `${fixed(s.confidence, 3)}${s.at_limit_of_search ? ", at the limit of the search" : ""}`],
      ...s.rivals.map((r, i) => [`rival ${i + 1}`, `${fixed(r.shift_px[0], 1)}, ${fixed(r.shift_px[1], 1)} px, scale ${fixed(r.scale, 3)}, `
        + `${fixed(r.rotation_deg, 1)}°, E ${fixed(r.unlike, 3)}`]),
      ["common beam space", `${b.lines} × ${b.samples}, ${fixed(b.first_deg, 1)}° to ${fixed(b.last_deg, 1)}°, `
        + `${number(b.near)} to ${number(b.far)} ${b.unit}`]]);
  }

  function showLoops() {
    const rows = [["loop", (l) => l.label], ["format", (l) => l.format], ["greys", (l) => l.grey_source], ["picture", (l) => `${l.width} × ${l.height}`],
      ["frames", (l) => l.frames],
      ["repeated frames", (l) => (l.repeated_frames.length ? l.repeated_frames.join(", ") : "none")],
      ["frame rate", (l) => (l.frame_rate_hz ? `${number(l.frame_rate_hz, 5)} /s, ${l.frame_rate_source}` : "not known")
        + (l.frame_rate_trusted ? "" : " (not used as the acquisition rate)")],
      ["scale", (l) => (l.mm_per_pixel ? `${number(l.mm_per_pixel)} mm per pixel, ${l.scale_source}` : "not known")],
      ["apex", (l) => `${fixed(l.sector.apex_px[0], 1)}, ${fixed(l.sector.apex_px[1], 1)} px`],
      ["edges", (l) => `${fixed(l.sector.first_deg, 2)}° to ${fixed(l.sector.last_deg, 2)}°`],
      ["radii", (l) => `${fixed(l.sector.r_min_px, 1)} to ${fixed(l.sector.r_max_px, 1)} px`],
      ["sector", (l) => `${l.sector.source}, confidence ${fixed(l.sector.confidence, 3)}`],
      ["beat", (l) => (l.beat.frames ? `${number(l.beat.frames)} frames, ${l.beat.source}, confidence ${fixed(l.beat.confidence, 3)}` : "not known")],
      ["beats start by", (l) => l.beat.anchor + (l.beat.ecg ? `: ${l.beat.ecg.kind}, R waves at frames `
        + `${l.beat.ecg.r_wave_frames.map((f) => fixed(f, 1)).join(", ")}, confidence ${fixed(l.beat.ecg.confidence, 2)}` : "")]];
    page.table(byId("loops"), { columns: [{ label: "" }, { label: "real" }, { label: "synthetic" }],
      rows: rows.map(([label, text]) => [label, String(text(summary.real)), String(text(summary.synthetic))]) })
      .classList.add("wrapped");
  }

  // Made when it is opened: hundreds of rows cost a second.
  function showFrames(player) {
    const details = byId("frames");
    const fill = () => {
      const groups = [["before", frames.before], ["after", frames.after], ...bands.map((name) => [`band ${name}`, frames.bands[name]])];
      page.table(details, { columns: [{ label: "real frame" }, ...["time, s", "synthetic frame", "phase", "counted", "discrepancy",
        ...groups.flatMap(([label]) => kMetrics.map(([key]) => `${key} ${label}`))].map((label) => ({ label, number: true }))],
      rows: frames.real_frame.map((real, k) => [
        element("button", { type: "button", class: "link", click: () => player.jump(k) }, String(real)),
        fixed(frames.real_time_s[k], 4), number(frames.synthetic_frame[k], 6), number(frames.synthetic_phase[k]),
        frames.counted[k] ? "yes" : "no", number(frames.discrepancy[k], 6),
        ...groups.flatMap(([, group]) => kMetrics.map(([key]) => value(at(group, k), key, 6)))]) });
    };
    details.addEventListener("toggle", fill, { once: true });
  }

  showHead();
  const player = makePlayer();
  page.parts.player = player;
  showNumbers(player);
  showCurves(player);
  if (data.fit) {
    byId("fit").hidden = false;
    if (summary.scene_fit.tilt) page.facts(byId("tilt"), page.tiltFacts(summary.scene_fit.tilt));
    showFit(data.fit);
  }
  showCalibration();
  showTime(player);
  showSpace(player);
  showLoops();
  showFrames(player);
})();
