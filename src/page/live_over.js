// Layers over the echo: ground truth, callipers, a traced cavity, and the line of the M-mode.
"use strict";

// new LiveOver(live): live has { state, ask(path, body), body(more), shown(made) } and the canvases.
class LiveOver {
  static kLayers = [["contours", "contours"], ["labels", "labels"], ["segments", "segments"], ["strain", "strain"], ["arrows", "displacement"]];
  static kStrainRange = 25;  // percent at the ends of the colours

  constructor(live) {
    Object.assign(this, { live, layers: new Set(), known: new Map(), busy: false });
    this.canvas = page.byId("over");
    this.words = page.byId("truth-words");
    this.scrap = page.element("canvas", {});
  }

  makeControls(parent) {
    const { element } = page;
    for (const [name, label] of LiveOver.kLayers) {
      const box = element("input", { type: "checkbox", id: `truth-${name}`, change: () => {
        this.layers[box.checked ? "add" : "delete"](name);
        this.draw();
      } });
      parent.append(element("label", { for: box.id }, box, ` ${label}`));
    }
  }

  // After a change of the scene.
  forget() { this.known.clear(); }

  get sector() { return this.live.state.sector; }

  pixel([x, z]) {
    const { origin_px: [ox, oy], mm_per_px } = this.sector.picture;
    return [ox + x / mm_per_px, oy + z / mm_per_px];
  }

  // ---- Truth

  get wallWanted() { return ["segments", "strain", "arrows"].some((name) => this.layers.has(name)); }

  async request(name, frame) {
    if (this.busy) return;
    this.busy = true;
    const layers = [...(this.layers.has("labels") ? ["labels"] : []), ...(this.wallWanted ? ["wall"] : [])];
    try {
      const response = await this.live.ask("/truth", this.live.body({ frame, layers }));
      if (response.status === 200) {
        const [truth, labels] = LiveServer.parts(await response.arrayBuffer());
        if (layers.includes("labels")) truth.labels = labels;
        if (this.known.size > 240) this.known.clear();
        this.known.set(name, { ...truth, layers });
      } else this.known.set(name, { layers, contours: [], refused: (await response.text()).trim() });
    } finally {
      this.busy = false;
    }
    this.draw();
  }

  // The truth of the current picture, if it has arrived.
  truth() {
    const { shown, version, playing, kept, frames } = this.live.state;
    if (!this.layers.size || shown?.effort !== "still" || shown.version !== version) return null;
    const name = `${version} ${shown.frame}`, known = this.known.get(name);
    const enough = known && (!this.layers.has("labels") || known.layers.includes("labels")) && (!this.wallWanted || known.layers.includes("wall"));
    if (enough) return known;
    if (!playing || kept.size >= frames) this.request(name, shown.frame);
    return null;
  }

  drawLabels(context, { labels, width, height }) {
    Object.assign(this.scrap, { width, height });
    const pen = this.scrap.getContext("2d"), image = pen.createImageData(width, height), colours = new Map();
    const colourOf = (id) => {
      if (!colours.has(id)) {
        pen.fillStyle = HeartView.colourOf(id - 1);  // reads as #rrggbb
        colours.set(id, [1, 3, 5].map((i) => parseInt(pen.fillStyle.slice(i, i + 2), 16)).concat(105));
      }
      return colours.get(id);
    };
    for (let i = 0; i < width * height; ++i) {
      const id = labels[2 * i] + 256 * labels[2 * i + 1];
      if (id) image.data.set(colourOf(id), 4 * i);
    }
    pen.putImageData(image, 0, 0);
    context.drawImage(this.scrap, 0, 0);
  }

  // Blue shortens, red lengthens; white does not change.
  static strainColour(percent) {
    if (percent === null) return "#808080";
    const share = Math.max(-1, Math.min(1, percent / LiveOver.kStrainRange)), fade = Math.round(255 * (1 - Math.abs(share)));
    return share < 0 ? `rgb(${fade}, ${fade}, 255)` : `rgb(255, ${fade}, ${fade})`;
  }

  drawWall(context, { tracks, function: f }) {
    const dot = (at, colour) => {
      context.fillStyle = colour;
      context.beginPath();
      context.arc(...this.pixel(at), 3.5, 0, 2 * Math.PI);
      context.fill();
    };
    for (const { at_mm, segment } of tracks) {
      if (this.layers.has("strain")) dot(at_mm, LiveOver.strainColour(f.segments[segment - 1].longitudinal));
      else if (this.layers.has("segments")) dot(at_mm, HeartView.colourOf(segment));
    }
    if (!this.layers.has("arrows")) return;
    context.strokeStyle = context.fillStyle = "#7fd6a3";
    context.lineWidth = 1.2;
    for (const { from_mm, at_mm, layer } of tracks) {
      if (layer === 1) continue;
      const [x0, y0] = this.pixel(from_mm), [x1, y1] = this.pixel(at_mm), long = Math.hypot(x1 - x0, y1 - y0);
      if (long < 1) continue;
      const [dx, dy] = [(x1 - x0) / long, (y1 - y0) / long], head = Math.min(5, long);
      context.beginPath();
      context.moveTo(x0, y0);
      context.lineTo(x1, y1);
      context.stroke();
      context.beginPath();
      context.moveTo(x1, y1);
      context.lineTo(x1 - head * (dx + 0.5 * dy), y1 - head * (dy - 0.5 * dx));
      context.lineTo(x1 - head * (dx - 0.5 * dy), y1 - head * (dy + 0.5 * dx));
      context.fill();
    }
  }

  drawTruth(context) {
    const truth = this.truth();
    this.tell(truth);
    if (!truth) return;
    context.save();
    context.beginPath();
    this.sector.sector_mm.forEach((p) => context.lineTo(...this.pixel(p)));
    context.clip();
    if (this.layers.has("labels") && truth.labels) this.drawLabels(context, truth);
    if (this.layers.has("contours"))
      for (const { structure, closed, points_mm } of truth.contours) {
        context.strokeStyle = HeartView.colourOf(structure);
        context.beginPath();
        points_mm.forEach((p) => context.lineTo(...this.pixel(p)));
        if (closed) context.closePath();
        context.stroke();
      }
    if (truth.tracks) this.drawWall(context, truth);
    context.restore();
  }

  // Volumes, strain and view in words, and what the colours mean.
  tell(truth) {
    const { element, fixed } = page;
    this.words.replaceChildren();
    if (!this.layers.size) return;
    if (!truth) { this.words.append("The truth of this picture is being computed, once the picture is complete."); return; }
    if (truth.refused || truth.no_wall) this.words.append(truth.refused ?? truth.no_wall);
    const f = truth.function;
    if (!f || !this.wallWanted) return;
    const single = f.single_plane_ml === null ? "" : `, one plane ${fixed(f.single_plane_ml, 1)} mL`;
    const line = (text) => this.words.append(element("div", {}, text));
    line(`Left ventricle: exact ${fixed(f.volume_ml, 1)} mL; Simpson's rule in two planes ${fixed(f.biplane_ml, 1)} mL${single}. `
      + `Global longitudinal strain ${fixed(f.gls, 1)} %.`);
    if (truth.view) {
      const { label, tilt_deg, rotation_deg, foreshortening_mm } = truth.view;
      line(`View: ${label}, tilt ${fixed(tilt_deg, 1)}°${rotation_deg === null ? "" : `, rotation ${fixed(rotation_deg, 1)}°`}`
        + `${foreshortening_mm === null ? "" : `, foreshortening ${fixed(foreshortening_mm, 1)} mm`} from the standard plane.`);
    }
    const segments = [...new Set(truth.tracks.map((t) => t.segment))].sort((a, b) => a - b), strain = this.layers.has("strain");
    if (strain || this.layers.has("segments"))
      this.words.append(element("div", {}, ...segments.flatMap((s) => {
        const { name, longitudinal } = f.segments[s - 1], swatch = element("span", { class: "swatch" });
        swatch.style.background = strain ? LiveOver.strainColour(longitudinal) : HeartView.colourOf(s);
        return [swatch, ` ${s} ${name}${strain && longitudinal !== null ? ` ${fixed(longitudinal, 1)} %` : ""}  `];
      })));
    if (this.layers.has("arrows")) line("Arrows: displacement in the plane since the first frame.");
  }

  // ---- Callipers and traced cavity

  // Area (mm²) and volume (mL) of a closed outline whose first and last points are the base: 20 discs
  // along the line from the middle of the base to the farthest point.
  static discs(points) {
    const kDiscs = 20, first = points[0], last = points[points.length - 1], base = [(first[0] + last[0]) / 2, (first[1] + last[1]) / 2];
    const apex = points.reduce((a, p) => (Math.hypot(p[0] - base[0], p[1] - base[1]) > Math.hypot(a[0] - base[0], a[1] - base[1]) ? p : a), base);
    const long = Math.hypot(apex[0] - base[0], apex[1] - base[1]), [ux, uy] = [(apex[0] - base[0]) / long, (apex[1] - base[1]) / long];
    const local = points.map(([x, y]) => [(x - base[0]) * ux + (y - base[1]) * uy, (y - base[1]) * ux - (x - base[0]) * uy]);
    let area = 0, volume = 0;
    local.forEach(([s, t], i) => { const [s2, t2] = local[(i + 1) % local.length]; area += (s * t2 - s2 * t) / 2; });
    for (let disc = 0; disc < kDiscs; ++disc) {
      const at = (disc + 0.5) / kDiscs * long, cuts = [];
      local.forEach(([s, t], i) => {
        const [s2, t2] = local[(i + 1) % local.length];
        if (s < at !== s2 < at) cuts.push(t + (at - s) / (s2 - s) * (t2 - t));
      });
      const width = cuts.length ? Math.max(...cuts) - Math.min(...cuts) : 0;
      volume += Math.PI / 4 * width * width * long / kDiscs;
    }
    return { area_mm2: Math.abs(area), volume_ml: volume / 1000, length_mm: long };
  }

  drawMarks(context) {
    const { state } = this.live, { mm_per_px } = this.sector.picture, { fixed } = page;
    context.lineWidth = 1.5;
    context.strokeStyle = context.fillStyle = "#e5b25d";
    context.font = "16px system-ui, sans-serif";
    for (let i = 0; i + 1 < state.mm.length; i += 2) {
      const [a, b] = [state.mm[i], state.mm[i + 1]];
      context.beginPath();
      context.moveTo(...a);
      context.lineTo(...b);
      context.stroke();
      context.fillText(`${fixed(mm_per_px * Math.hypot(a[0] - b[0], a[1] - b[1]), 1)} mm`, b[0] + 8, b[1] - 8);
    }
    for (const [x, y] of [...state.mm, ...state.trace]) context.fillRect(x - 3, y - 3, 6, 6);
    if (state.trace.length > 2) {
      context.beginPath();
      state.trace.forEach((p) => context.lineTo(...p));
      context.closePath();
      context.stroke();
      const { area_mm2, volume_ml, length_mm } = LiveOver.discs(state.trace.map(([x, y]) => [x * mm_per_px, y * mm_per_px]));
      const [x, y] = state.trace[state.trace.length - 1];
      context.fillText(`${fixed(volume_ml, 1)} mL, ${fixed(area_mm2 / 100, 1)} cm², ${fixed(length_mm, 1)} mm`, x + 8, y - 8);
    }
    if (state.cursor) {
      const [x, y] = state.cursor;
      context.beginPath();
      for (const [dx, dy] of [[9, 0], [0, 9]]) { context.moveTo(x - dx, y - dy); context.lineTo(x + dx, y + dy); }
      context.stroke();
    }
    if (!state.m_line) return;
    context.setLineDash([6, 6]);
    context.beginPath();
    for (const [x, y] of state.m_line) context.lineTo(x, y);
    context.stroke();
    context.setLineDash([]);
  }

  draw() {
    const context = this.canvas.getContext("2d");
    context.clearRect(0, 0, this.canvas.width, this.canvas.height);
    context.lineWidth = 1.5;
    this.drawTruth(context);
    this.drawMarks(context);
  }

  // A point at a place of the picture, by the tool.
  put(place) {
    const { state } = this.live;
    if (state.tool === "line") return this.chooseLine(place);
    const list = state.tool === "measure" ? state.mm : state.trace;
    if (list.length >= (state.tool === "measure" ? 8 : 60)) list.length = 0;
    list.push(place);
    this.draw();
  }

  clear() {
    Object.assign(this.live.state, { mm: [], trace: [], m_line: null, cursor: null });
    page.byId("m-mode").hidden = true;
    this.draw();
  }

  // From the apex through the point to the end of the depth; for parallel lines, straight down.
  chooseLine([x, y]) {
    const { state } = this.live, { origin_px: [ox, oy], mm_per_px } = this.sector.picture, length = this.sector.depth_mm / mm_per_px;
    const r = Math.hypot(x - ox, y - oy) || 1, parallel = state.values["probe.width_mm"] != null && !state.values["probe.sector_deg"];
    const d = parallel ? [0, 1] : [(x - ox) / r, (y - oy) / r], from = parallel ? [x, oy] : [ox, oy];
    state.m_line = [from, [from[0] + length * d[0], from[1] + length * d[1]]];
    this.draw();
    this.drawM();
  }

  // A column for each frame that is known at this pose.
  drawM() {
    const { state } = this.live, figure = page.byId("m-mode"), canvas = figure.querySelector("canvas"), [a, b] = state.m_line, rows = 300;
    figure.hidden = false;
    Object.assign(canvas, { width: state.frames, height: rows });
    const context = canvas.getContext("2d"), image = context.createImageData(state.frames, rows);
    for (const [frame, { greys, width, height }] of state.kept)
      for (let row = 0; row < rows; ++row) {
        const s = row / (rows - 1), x = Math.round(a[0] + s * (b[0] - a[0])), y = Math.round(a[1] + s * (b[1] - a[1]));
        const grey = x >= 0 && y >= 0 && x < width && y < height ? greys[y * width + x] : 0, i = 4 * (row * state.frames + frame);
        image.data.set([grey, grey, grey, 255], i);
      }
    context.putImageData(image, 0, 0);
    figure.querySelector("figcaption").textContent =
      `M-mode of the dashed line: ${state.kept.size} of ${state.frames} frames, ${page.fixed(this.sector.depth_mm, 0)} mm deep.`;
  }
}
