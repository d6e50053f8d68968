// The page of a fitted heart: the loops with the heart over them, the heart itself, and how sure it is.
"use strict";

(() => {
  const { data, byId, element, number, fixed } = page;
  const { views, result } = data;
  const pictures = views[0].overlay.outline.length;
  const range = (e, digits) => (e ? `${fixed(e.value, digits)} (${fixed(e.low, digits)} to ${fixed(e.high, digits)})` : "–");
  const fillList = (list, texts) => list.append(...texts.map((text) => element("li", {}, text)));

  function showHead() {
    byId("title").textContent = `A heart fitted to ${views.map((v) => `${v.view}: ${v.loop}`).join(", ")}`;
    byId("subtitle").textContent = [result.ef && `EF ${range(result.ef, 3)}`, result.edv_ml && `EDV ${range(result.edv_ml, 0)} mL`,
      result.esv_ml && `ESV ${range(result.esv_ml, 0)} mL`, result.gls && `GLS ${range(result.gls, 3)}`, result.ef ? `intervals at ${100 * result.interval} %` : "no result",
      data.stopped && "stopped"].filter(Boolean).join(" · ");
    byId("refusal").hidden = !data.refusal;
    byId("refusal").querySelector("p").textContent = data.refusal ?? "";
    byId("hints").hidden = !data.hints.length;
    fillList(byId("hints").querySelector("ul"), data.hints);
    fillList(byId("assumptions"), data.assumptions);
    byId("foot").textContent = `EchoCine ${data.version}. The same numbers are in fit.json and curves.csv. ${number(data.cpu_s, 3)} s of one core.`;
  }

  const kFull_mm = 4;
  // Blue: edges lie inside the heart's boundary; red: outside.
  const tint = (mm) => {
    const t = Math.max(-1, Math.min(1, mm / kFull_mm)), pale = Math.round(235 * (1 - Math.abs(t)));
    return t < 0 ? `rgb(${pale} ${pale} 255)` : `rgb(255 ${pale} ${pale})`;
  };
  const marks = (context, points, mm_per_pixel, colour, alpha) => {
    const size = 0.6 / mm_per_pixel;
    context.save();
    for (const point of points) {
      context.globalAlpha = alpha(point);
      context.fillStyle = colour(point);
      context.fillRect(point[0] - size, point[1] - size, 2 * size, 2 * size);
    }
    context.restore();
  };

  // Of each view: the loop with the heart's boundaries, with its disagreement, and its twin.
  function loopsOf({ view, fit, overlay }) {
    const images = page.frames(view), twin = page.frames(`${view} twin`), { mm_per_pixel } = overlay;
    const over = (draw) => ({ images, draw: (context, _, k) => draw(context, k) });
    const loops = [
      { label: `${view}: the heart's boundaries, D ${fixed(fit.discrepancy, 3)}`, images,
        over: over((context, k) => marks(context, overlay.outline[k], mm_per_pixel, () => "#ffb347", () => 0.9)) },
      { label: `${view}: disagreement`, images,
        over: over((context, k) => marks(context, overlay.map[k].boundary, mm_per_pixel, (p) => tint(p[2]),
          (p) => 0.15 + 0.85 * Math.min(1, 2 * p[3]))) }];
    return twin.length ? [...loops, { label: `${view}: synthetic twin`, images: twin }] : loops;
  }

  function showLoops() {
    const own = views.some((v) => v.overlay.beyond_own);
    byId("loops-words").textContent = "Disagreement is the distance of edges from the heart's boundaries along their normals"
      + (own ? ", beyond what the heart shows against its own synthetic loop" : "")
      + `. Red: edges lie outside; blue: inside; full colour from ${kFull_mm} mm on; faint: no visible edge.`
      + (own ? " Twins have the sector of the model." : "")
      + (views.every((v) => v.has_scale) ? "" : " All lengths in mm on this page assume the model's depth: a loop has no length scale.");
    return new Player(byId("fit-loops"), { loops: views.flatMap(loopsOf), rate_hz: 20,
      describe: (k) => `picture ${k} of ${pictures} of the beat, from end-diastole` });
  }

  function showHeart(player) {
    const space = new HeartView(byId("space"), data.heart);
    page.parts.space = space;
    const follow = () => space.showPhase(Math.max(0, player.index) / pictures);
    player.addEventListener("frame", follow);
    follow();
  }

  function showVolume(player) {
    const { volume } = data;
    byId("volume").hidden = !volume;
    if (!volume) return;
    const frame_x = Array.from({ length: pictures }, (_, k) => k / pictures);
    const line = (values) => values.map((value, i) => [volume.phase[i], value]);
    const band = { type: "line", stack: "band", symbol: "none", lineStyle: { opacity: 0 }, silent: true };
    const chart = makeChart(byId("volume-chart"), 260, {
      grid: { left: 8, right: 16, top: 26, bottom: 26, containLabel: true },
      tooltip: { trigger: "axis", confine: true, valueFormatter: (value) => number(value, 4) },
      xAxis: { type: "value", name: "phase of the beat", nameLocation: "middle", nameGap: 26, min: 0, max: 1 },
      yAxis: { type: "value", name: volume.unit, scale: true, nameTextStyle: { align: "left" } },
      series: [{ ...band, name: "low", data: line(volume.low) },
        { ...band, name: "width at 90 %", data: line(volume.high.map((high, i) => high - volume.low[i])), areaStyle: { opacity: 0.25 } },
        { type: "line", name: "left ventricle", showSymbol: false, lineStyle: { width: 1.8 }, data: line(volume.value) }] });
    followPlayer(chart, player, frame_x);
  }

  function showOffsets(player) {
    byId("offsets-words").textContent = "Mean over each structure's visible boundary, weighted by certainty. Positive: the heart's chamber is too small there.";
    const frame_x = Array.from({ length: pictures }, (_, k) => k / pictures);
    for (const { view, overlay } of views) {
      const box = element("div", {}, element("h3", {}, view));
      byId("offsets").append(box);
      const series = overlay.curves.filter((c) => c.offset_mm.some((v) => v !== null))
        .map((c) => ({ name: c.structure, values: c.offset_mm }));
      if (series.length) curves(box, { x_name: "phase of the beat", y_name: "mm", frame_x, player, series });
    }
  }

  // Without own loops nothing is known of regions.
  function showRegions() {
    const all = views.flatMap(({ view, regions }) => regions.map((r) => ({ view, ...r }))), shown = all.filter((r) => r.visible), found = all.filter((r) => r.significant);
    byId("regions").hidden = !all.length;
    byId("regions").querySelector("p").textContent = (found.length ? `${found.length} of ${shown.length} visible regions differ` : `None of ${shown.length} visible regions differs`)
      + " by more than a perfect model would. Offset: mean over the beat. Change: offset at end-systole minus that at end-diastole, positive where a wall moves less."
      + " Local: offset of a segment minus the mean of its visible neighbours."
      + " In brackets: standard deviation for a perfect model. Positive offsets lie outside the heart's chamber.";
    page.table(byId("regions").querySelector("div"), { columns: [{ label: "view" }, { label: "region" },
      ...["offset, mm", "change, mm", "local, mm"].map((label) => ({ label, number: true })), { label: "" }],
    rows: [...found, ...all.filter((r) => !r.significant)].map((r) => [r.view, r.segment ?? r.structure,
      `${fixed(r.offset_mm, 1)} (${fixed(r.offset_sd_mm, 1)})`, `${fixed(r.motion_mm, 1)} (${fixed(r.motion_sd_mm, 1)})`,
      r.local_mm === null ? "" : `${fixed(r.local_mm, 1)} (${fixed(r.local_sd_mm, 1)})`, r.significant ? "differs" : r.visible ? "" : "hardly visible"]) });
  }

  function showTables() {
    page.table(byId("result"), { columns: [{ label: "dial" }, ...["value", "SD", "SD of the prior", "own error"]
      .map((label) => ({ label, number: true })), { label: "" }],
    rows: data.dials.map((d) => [d.dial, number(d.value), number(d.sd, 2), number(d.prior_sd, 2), number(data.own_error[d.dial], 2),
      [d.at_limit && "at its limit", !d.determined && "not determined"].filter(Boolean).join(", ")]) });
    page.table(byId("views"), { columns: [{ label: "view" }, { label: "loop" }, ...["D", "mirrored", "shuffled", "in the picture, %",
      "tilt, °", "rotation, °", "start's confidence"].map((label) => ({ label, number: true }))],
    rows: views.map((v) => [v.view, v.loop, fixed(v.fit.discrepancy, 3), fixed(v.controls?.mirrored, 3), fixed(v.controls?.shuffled, 3),
      fixed(100 * v.fit.overlap, 0), fixed(v.tilt_deg, 1), fixed(v.rotate_deg, 1), fixed(v.beat.confidence, 2)]) });
    byId("rivals").hidden = !data.rivals.length;
    page.table(byId("rivals").querySelector("div"), { columns: [{ label: "heart" }, { label: "EF", number: true },
      { label: "J above the best", number: true }, { label: "dials" }],
    rows: data.rivals.map((r, i) => [String(i + 2), fixed(r.ef, 3), fixed(r.cost_above, 1),
      Object.entries(r.dials ?? {}).map(([key, value]) => `${key} ${number(value, 3)}`).join(", ")]) });
  }

  showHead();
  const player = showLoops();
  page.parts.player = player;
  showHeart(player);
  showVolume(player);
  showOffsets(player);
  showRegions();
  showTables();
})();
