// Where a model disagrees with a loop: maps over its pictures, curves by structure and by segment.
"use strict";

const showFit = (() => {
  const { byId, element, fixed } = page;

  page.tiltFacts = (t) => [["tilt about the lateral axis", `${fixed(t.tilt_deg, 1)}° of ±${fixed(t.most_deg, 1)}°, confidence ${fixed(t.tilt_confidence, 2)}`],
    ["rotation about the beam's axis", `${fixed(t.rotate_deg, 1)}° of ±${fixed(t.most_deg, 1)}°, confidence ${fixed(t.rotate_confidence, 2)}`
      + (t.at_limit_of_search ? "; at the limit of the search" : "")],
    ["the model's discrepancy there", `${fixed(t.discrepancy, 4)}, ${fixed(t.discrepancy_untilted, 4)} without tilt`],
    ["planes tried", String(t.planes)]];

  // How a loop was laid on a model, in space and in time.
  page.showPose = (parent, what, { pose, confidence, at_limit_of_search, rivals, tilt, beat }, anchor) => {
    const text = (p) => `${fixed(p.shift_mm[0], 1)}, ${fixed(p.shift_mm[1], 1)} mm, ${fixed(p.turn_deg, 1)}°, scale ${fixed(p.scale, 3)}`;
    page.facts(parent, [[what, text(pose)],
      ["confidence", `${fixed(confidence, 2)}${at_limit_of_search ? ", at the limit of the search" : ""}`],
      ...rivals.map((r, i) => [`rival ${i + 1}`, `${text(r)}, discrepancy ${fixed(r.discrepancy, 4)}`]),
      ...(tilt ? page.tiltFacts(tilt) : []),
      ["end-diastole", `frame ${fixed(beat.end_diastole_frame, 2)}, by ${beat.start_source}, confidence ${fixed(beat.confidence, 2)}`],
      ...(beat.end_systole.part_of_beat === null ? [] : [["end-systole", `at ${fixed(beat.end_systole.part_of_beat, 3)} of the beat, `
        + `by ${beat.end_systole.source}, confidence ${fixed(beat.end_systole.confidence, 2)}; the models' at ${fixed(beat.end_systole.of_model, 3)}`]]),
      ["beat", `${fixed(beat.frames, 2)} frames, ${beat.length_source}; beats start by: ${anchor}`]]);
  };

  // Blue: edges lie inside the model's boundary, or the model leaves too much grey; red the other way.
  const tint = (value, most) => {
    const t = Math.max(-1, Math.min(1, value / most)), pale = Math.round(235 * (1 - Math.abs(t)));
    return t < 0 ? `rgb(${pale} ${pale} 255)` : `rgb(255 ${pale} ${pale})`;
  };
  const kMaps = {
    boundary: { label: "boundary: mm along the normal", most: 4, unit: "mm",
      says: "Red: edges lie outside the model's blood boundary; blue: inside. Faint: no visible edge.",
      draw(context, frame, size) {
        for (const [x, y, offset_mm, certainty] of frame.boundary) {
          context.globalAlpha = 0.15 + 0.85 * Math.min(1, 2 * certainty);
          context.fillStyle = tint(offset_mm, this.most);
          context.fillRect(x - size, y - size, 2 * size, 2 * size);
        }
      } },
    motion: { label: "motion: mm from frame to frame", most: 2, unit: "mm",
      says: "Red: difference between the model's displacement and block matching.",
      draw(context, frame, size) {
        for (const [x, y, , , motion_mm] of frame.boundary) {
          if (motion_mm < 0) continue;
          context.fillStyle = tint(motion_mm, this.most);
          context.fillRect(x - size, y - size, 2 * size, 2 * size);
        }
      } },
    region: { label: "region: residual grey level", most: 3, unit: "standard deviations",
      says: "Red: the loop is brighter than the same tissue elsewhere; blue: darker.",
      draw(context, frame, size) {
        context.globalAlpha = 0.5;
        for (const [x, y, left] of frame.region) {
          context.fillStyle = tint(left, this.most);
          context.fillRect(x - size, y - size, 2 * size, 2 * size);
        }
      } },
  };

  // Pictures of the loop "fit" with a map over them, and curves over the beat. Returns the player.
  return (fit) => {
    const select = byId("term"), images = page.frames("fit");
    select.append(...Object.entries(kMaps).map(([key, map]) => element("option", { value: key }, map.label)));
    const draw = (context, _, k) => {
      const map = kMaps[select.value];
      context.save();
      map.draw(context, fit.map[k], 0.7 / fit.mm_per_pixel);
      context.restore();
    };
    const player = new Player(byId("fit-player"), { loops: [{ label: "", images, over: { images, draw } }],
      rate_hz: 20, describe: (k) => `picture ${k} of ${images.length} of the beat, from end-diastole` });
    page.parts.player ??= player;
    const tell = () => {
      const map = kMaps[select.value];
      byId("where").textContent = `${map.says} Full colour from ${map.most} ${map.unit} on.`;
    };
    select.addEventListener("change", () => { tell(); player.seek(player.wanted); });
    tell();
    const frame_x = images.map((_, k) => k / images.length);
    const show = (root, all, name) => {
      root.hidden = !all.length;
      for (const [key, label] of [["offset_mm", "offset along the normal, mm"], ["distance_mm", "distance, mm"],
        ["motion_mm", "motion, mm"]]) {
        const box = element("div", {}, element("h3", {}, label));
        root.querySelector(".small-charts").append(box);
        const series = all.filter((c) => c[key].some((v) => v !== null)).map((c) => ({ name: c[name], values: c[key] }));
        if (series.length) curves(box, { x_name: "phase of the beat", y_name: "", frame_x, player, series });
      }
    };
    show(byId("beat"), fit.curves, "structure");
    show(byId("segments"), fit.segments, "segment");
    return player;
  };
})();
