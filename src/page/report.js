// The page of a rendered loop.
"use strict";

(() => {
  const { data, byId, element, number, fixed } = page;
  const { frames } = data;
  const count = frames.index.length;
  const x_range = [data.ecg.time_s[0], data.ecg.time_s.at(-1)];  // from the first frame to the end of the last
  const kDegrees = 180 / Math.PI, kDecibelPerNeper = 20 / Math.LN10;

  // In step with the player, whose picture it carries on the imaging plane.
  function showSpace(player) {
    const root = byId("space"), has_pictures = page.frames("cine").length > 0;
    let space = null, visible = false;
    const show = () => {
      if (!space || !visible) return;
      space.showPhase(frames.phase[Math.max(0, player.index)]);
      if (has_pictures && player.index >= 0) space.setPicture(player.loops[0].canvas);
    };
    player.addEventListener("frame", show);
    // Made when it is first scrolled to or printed, and drawn while it can be seen: the page opens as fast.
    const see = (is_seen) => {
      visible = is_seen;
      if (visible && !space) page.parts.space = space = new HeartView(root, data.view);
      show();
    };
    new IntersectionObserver((entries) => see(entries.at(-1).isIntersecting)).observe(root);
    const paper = window.matchMedia("print");
    const print = () => { if (paper.matches) { see(true); space.renderNow(); } };
    paper.addEventListener("change", print);
    print();
  }

  function percent(share) { return `${fixed(100 * share, 1)} %`; }

  function showHead() {
    byId("title").textContent = data.title;
    const bpm = fixed(60 * data.acquisition.heart_rate_hz, 0);
    byId("subtitle").textContent =
      `${data.frames_done} of ${data.loop_frames} frames, ${number(data.acquisition.frame_rate_hz)} frames/s, ${bpm} beats/min`
      + (data.stride > 1 ? `; this page shows every ${data.stride}th frame` : "");
    byId("foot").textContent = `EchoCine ${data.version}, scene ${data.scene_sha256}. All of this is in manifest.json.`;
    if (!data.warnings.length) return;
    byId("warnings").hidden = false;
    byId("warnings").querySelector("ul").append(...data.warnings.map((w) => element("li", {}, w)));
  }

  const shown = { labels: false, contours: false, tracks: false };

  // Truth over the picture, as far as it was asked for and is switched on.
  function drawTruth(context, labels, k) {
    context.save();
    if (shown.labels && labels) {
      context.globalCompositeOperation = "screen";  // outside is black, which changes nothing
      context.globalAlpha = 0.5;
      context.drawImage(labels, 0, 0);
      context.globalCompositeOperation = "source-over";
      context.globalAlpha = 1;
    }
    if (shown.contours)
      for (const [structure, closed, px] of data.truth.outlines[k]) {
        context.strokeStyle = kCurveColours[structure % kCurveColours.length];
        context.lineWidth = 1.2;
        context.beginPath();
        for (let i = 0; i < px.length; i += 2) context.lineTo(px[i], px[i + 1]);
        if (closed) context.closePath();
        context.stroke();
      }
    if (shown.tracks) {
      context.fillStyle = "#ffe14d";
      const px = data.truth.tracks_px[k];
      for (let i = 0; i < px.length; i += 2) context.fillRect(px[i] - 1, px[i + 1] - 1, 2, 2);
    }
    context.restore();
  }

  // A box to tick for each kind of truth that the page has.
  function showToggles(player) {
    if (!data.truth) return;
    const has = { labels: page.frames("labels").length > 0, contours: data.truth.outlines.some((o) => o.length),
      tracks: data.truth.tracks_px.some((px) => px.length) };
    const boxes = Object.keys(shown).filter((kind) => has[kind]).map((kind) =>
      element("label", {}, element("input", { type: "checkbox", id: `show-${kind}`, change: (event) => {
        shown[kind] = event.target.checked;
        player.seek(Math.max(0, player.index));
      } }), ` ${kind} `));
    if (boxes.length) byId("player").append(element("p", { class: "keys no-print" }, "Truth: ", ...boxes));
  }

  function showFunction(player) {
    const given = data.truth?.curves ?? {};
    const strains = Object.keys(given).filter((name) => !/_(mm|deg|ml)$/.test(name));
    if (!strains.length) return;
    byId("truth").hidden = false;
    const draw = (root, names, y_name, factor, height_px) => curves(byId(root), { x_name: "time, s", y_name,
      frame_x: frames.time_s, x_range, player, height_px, series: names.map((name) =>
        ({ name: name.replaceAll("_", " "), values: given[name].map((v) => (v === null ? null : factor * v)) })) });
    draw("strain", strains, "%", 100, 280);
    draw("thickness", ["wall_thickness_mm", "base_descent_mm"], "mm", 1, 200);
  }

  // Also without pictures there is a frame that curves and tables speak of.
  function makePlayer() {
    const images = page.frames("cine");
    const describe = (k) => `frame ${frames.index[k]} · ${fixed(frames.time_s[k], 3)} s · phase ${fixed(frames.phase[k], 3)}`
      + (data.acquisition.beats > 1 ? ` · beat ${frames.beat[k] + 1}` : "");
    const player = new Player(byId("player"), {
      loops: [{ label: images.length ? "" : "No pictures were requested (output.cine, output.png).", images:
        images.length ? images : frames.index.map(() => null),
        over: data.truth && { images: page.frames("labels"), draw: drawTruth } }],
      rate_hz: data.acquisition.frame_rate_hz / data.stride, describe });
    if (!images.length) byId("player").querySelector("canvas").hidden = true;
    return player;
  }

  function extremes(ml) {
    let largest = 0, smallest = 0;
    ml.forEach((v, k) => {
      if (v > ml[largest]) largest = k;
      if (v < ml[smallest]) smallest = k;
    });
    return { largest, smallest, change: ml[largest] > 0 ? 1 - ml[smallest] / ml[largest] : 0 };
  }

  // Chambers first: blood that changes its volume, or else whatever does.
  function hiddenAtFirst(names) {
    const medium = Object.fromEntries(data.structures.map((s) => [s.name, s.medium]));
    const moving = names.filter((name) => extremes(frames.volumes_ml[name]).change > 0.05);
    const blood = moving.filter((name) => /blood/i.test(medium[name]));
    const shown = new Set(blood.length ? blood : moving.length ? moving : names);
    return (name) => !shown.has(name);
  }

  function showVolumes(player) {
    const given = Object.keys(frames.volumes_ml);
    if (!given.length) {
      byId("volumes").textContent = "The scene has no closed structure.";
      return;
    }
    const hidden = hiddenAtFirst(given);
    const names = [...given.filter((name) => !hidden(name)), ...given.filter(hidden)];
    curves(byId("volumes"), { x_name: "time, s", y_name: "mL", frame_x: frames.time_s, x_range, player, height_px: 300,
      series: names.map((name) => ({ name, values: frames.volumes_ml[name], hidden: hidden(name) })) });

    const jump = (k) => element("button", { type: "button", class: "link", click: () => player.jump(k),
      "aria-label": `frame ${frames.index[k]}` }, String(frames.index[k]));
    const now = names.map(() => element("span"));
    page.table(byId("volume-table"), {
      columns: [{ label: "structure" }, { label: "this frame, mL", number: true }, { label: "largest, mL", number: true },
        { label: "at frame", number: true }, { label: "smallest, mL", number: true }, { label: "at frame", number: true },
        { label: "change", number: true }],
      rows: names.map((name, i) => {
        const ml = frames.volumes_ml[name], e = extremes(ml);
        return [name, now[i], fixed(ml[e.largest], 2), jump(e.largest), fixed(ml[e.smallest], 2), jump(e.smallest), percent(e.change)];
      }) });
    const show = (k) => names.forEach((name, i) => { now[i].textContent = fixed(frames.volumes_ml[name][k], 2); });
    player.addEventListener("frame", (event) => show(event.detail.index));
    show(0);
  }

  function showEcg(player) {
    const chart = curves(byId("ecg"), { x_name: "time, s", y_name: "of the R wave", frame_x: frames.time_s, x_range, player, height_px: 170,
      series: [{ name: "lead", x: data.ecg.time_s, values: data.ecg.lead }] });
    chart.setOption({ series: [{ lineStyle: { width: 1.2 } }] });
  }

  function showEffects() {
    page.table(byId("effects"), {
      columns: [{ label: "effect" }, { label: "" }, { label: "time", number: true }, { label: "why" }],
      rows: data.effects.map((e) => [e.name, element("span", { class: e.on ? "on" : "off" }, e.on ? "on" : "off"),
        e.on ? `${fixed(100 * data.measured.time_shares[e.name], 0)} %` : "", e.reason]) });
    const { plan } = data, t = plan.triangles;
    const facts = [["tracer", `${plan.tracer}: ${plan.tracer_reason}`],
      ["interface echoes", `${plan.interface_echo}: ${plan.interface_echo_reason}`],
      ["triangles", `${t.given} given, ${t.kept} in structures in use, ${t.met} cut by the imaging plane`]];
    if (plan.left_out.length)
      facts.push(["left out", plan.left_out.map((i) => `${i.name}: ${i.reason}`).join("; ")]);
    page.facts(byId("plan"), facts).style.marginTop = "12px";
  }

  function showTimes() {
    const { wall, ...stages } = data.measured.timings_ms_per_frame;
    const total = Object.values(stages).reduce((sum, ms) => sum + ms, 0);
    const bar = (ms) => {
      const drawn = element("div", { class: "bar" });
      drawn.style.width = `${total > 0 ? (100 * ms) / Math.max(...Object.values(stages)) : 0}%`;
      return drawn;
    };
    page.table(byId("times"), {
      columns: [{ label: "stage" }, { label: "ms", number: true }, { label: "" }],
      rows: [...Object.entries(stages).map(([name, ms]) => [name.replace("_", " "), fixed(ms, 2), bar(ms)]),
        ["all stages", fixed(total, 2), ""], ["wall clock", fixed(wall, 2), ""]] });
  }

  function showProbe() {
    const p = data.probe;
    const mm = (m, decimals = 1) => `${fixed(1e3 * m, decimals)} mm`;
    const vector = (v, digits) => v.map((x) => number(x, digits)).join(", ");
    const facts = [["kind", p.kind]];
    if (p.kind === "linear") facts.push(["width", mm(p.last_offset_m - p.first_offset_m)]);
    else facts.push(["sector", `${fixed((p.last_angle_rad - p.first_angle_rad) * kDegrees, 1)}°`]);
    if (p.kind === "curvilinear") facts.push(["face radius", mm(p.face_radius_m)]);
    facts.push(["depth", `${fixed(1e3 * p.min_depth_m, 1)} to ${mm(p.max_depth_m)}`],
      ["frequency", `${number(p.frequency_hz / 1e6)} MHz`],
      ["lines × samples", `${p.lines} × ${p.samples}`],
      ["sample spacing", mm((p.max_depth_m - p.min_depth_m) / p.samples, 3)],
      ["aperture, focus", `${mm(p.aperture_m)}, ${mm(p.focus_m)}`],
      ["apex, mm", vector(p.apex_m.map((x) => 1e3 * x))],
      ["axis", vector(p.axis, 4)], ["lateral", vector(p.lateral, 4)]);
    page.facts(byId("probe"), facts);
  }

  function showRun() {
    const { acquisition: a, motion: m, signal: s, accuracy, output: o } = data;
    const facts = [["heart rate", `${fixed(60 * a.heart_rate_hz, 1)} beats/min`], ["frame rate", `${number(a.frame_rate_hz)} frames/s`],
      ["beats", number(a.beats)], ["R-R variability", percent(a.rr_variability)], ["interpolation", m.interpolation], ["subdivision", m.subdivision],
      ["TGC", s.tgc], ["spread", s.spread], ["beam width", s.beam_width], ["dynamic range", `${number(s.dynamic_range_db)} dB`],
      ["white at", `${data.reference_intensity.toExponential(3)} of I_S`], ["gamma", number(s.grey_gamma)], ["toe, shoulder", `${number(s.grey_toe)}, ${number(s.grey_shoulder)}`],
      ["rays per beam", accuracy.rays_per_beam], ["normals", accuracy.normals],
      ["picture", `${o.width} × ${o.height}, ${o.codec}${o.codec === "mjpg" ? `, quality ${o.jpeg_quality}` : ""}`]];
    page.facts(byId("run"), facts);
  }

  function showMedia() {
    page.table(byId("media"), {
      caption: `At ${number(data.probe.frequency_hz / 1e6)} MHz. Outside all structures: ${data.background}.`,
      columns: [{ label: "medium" }, { label: "Z, MRayl", number: true }, { label: "c, m/s", number: true },
        { label: "α, Np/m", number: true }, { label: "α, dB/cm", number: true }, { label: "η_b, 1/(m sr)", number: true }],
      rows: Object.entries(data.media).map(([name, m]) => [name, fixed(m.Z / 1e6, 4), number(m.c, 6), fixed(m.alpha_np_per_m, 2),
        fixed((m.alpha_np_per_m * kDecibelPerNeper) / 100, 3), m.eta_b_per_m_sr > 0 ? m.eta_b_per_m_sr.toExponential(2) : "0"]) });
    page.table(byId("structures"), {
      columns: [{ label: "structure" }, { label: "medium" }, { label: "kind" }, { label: "keyframes", number: true }],
      rows: data.structures.map((s) => [s.name, s.medium, s.membrane ? "membrane" : "closed", String(s.keyframes)]) });
  }

  showHead();
  const player = makePlayer();
  page.parts.player = player;
  showEcg(player);
  showVolumes(player);
  showToggles(player);
  showFunction(player);
  showSpace(player);
  showEffects();
  showTimes();
  showProbe();
  showRun();
  showMedia();
})();
