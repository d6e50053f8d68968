// The echo: requests pictures of the newest pose, keeps those at rest, and shows them.
"use strict";

class LivePicture {
  static kRest_ms = 220;  // without a change the probe is at rest

  // live: { state, ask, body, refuse, player, overlay, heart }
  constructor(live) {
    this.live = live;
    this.canvas = page.byId("picture");
    this.over = page.byId("over");
    this.pen = this.canvas.getContext("2d");
    this.pixels = null;
    this.busy = false;
    const { structures } = page.data.view;
    this.chambers = structures.filter(({ role }) => /_cavity$|^la$|^ra$/.test(role)).map(({ name }) => name);
    this.ventricle = structures.find(({ role }) => role === "lv_cavity")?.name;
  }

  // From a place in the window to one in the picture.
  placeOf(event) {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    return [(event.clientX - left) / width * this.canvas.width, (event.clientY - top) / height * this.canvas.height];
  }

  paint({ width, height, greys }) {
    const { canvas, over, pen } = this;
    if (canvas.width !== width || canvas.height !== height || !this.pixels) {
      for (const either of [canvas, over]) Object.assign(either, { width, height });
      this.pixels = pen.createImageData(width, height);
      this.pixels.data.fill(255);
    }
    const words = new Uint32Array(this.pixels.data.buffer);
    for (let i = 0; i < greys.length; ++i) words[i] = 0xff000000 | greys[i] * 0x010101;
    pen.putImageData(this.pixels, 0, 0);
  }

  show(made) {
    const { live, canvas } = this, { byId, fixed } = page;
    live.state.shown = made;
    this.paint(made);
    Object.assign(canvas.dataset, { version: made.version, effort: made.effort, frame: made.frame });
    byId("quality").textContent = `${made.quality} · ${fixed(made.ms, 0)} ms`;
    live.heart.showPhase(made.phase);
    live.heart.follow(canvas, made.effort === "moving");
    live.player.show(made);
    live.overlay.draw();
    const volumes = this.chambers.filter((name) => name in made.volumes_ml).map((name) => ` · ${name} ${fixed(made.volumes_ml[name], 0)} mL`);
    byId("readout").textContent = `frame ${made.frame} · ${fixed(made.time_s, 3)} s · phase ${fixed(made.phase, 3)}${volumes.join("")}${this.ejection()}`;
    if (made.effort === "still") this.warn(made.warnings);
  }

  // About the pose of a picture at rest.
  warn(warnings) {
    const words = (w) => (w.startsWith("nothing can be seen") ? "No scan line meets a structure: choose a standard view, or move the probe to the heart." : w);
    const text = warnings.map(words).join(" ");
    if (page.byId("warnings").textContent !== text) page.byId("warnings").textContent = text;
  }

  // Exact volumes of the left ventricle over the loop, once all frames are there.
  ejection() {
    const { state } = this.live, { fixed } = page;
    const volumes = [...state.kept.values()].map((made) => made.volumes_ml[this.ventricle]).filter((ml) => ml > 0);
    if (volumes.length < state.frames) return "";
    const most = Math.max(...volumes), least = Math.min(...volumes);
    return ` · exact EF ${fixed(100 * (1 - least / most), 1)} % (${fixed(most, 1)} to ${fixed(least, 1)} mL)`;
  }

  // One request at a time: the newest pose with less effort while it changes, the complete picture
  // at rest, and the other frames of the loop ahead.
  tick(now) {
    const { state, player } = this.live;
    const frame = player.wanted(now), rests = !state.held && now - state.changed_ms > LivePicture.kRest_ms;
    const kept = rests && state.kept.get(frame);
    if (kept && state.shown !== kept) this.show(kept);
    if (this.busy || state.refused === state.version) return;
    const { shown } = state, stale = !shown || shown.version !== state.version;
    if (!rests ? stale || state.playing && shown.frame !== frame : !kept) this.request(frame, rests ? "still" : "moving");
    else if (rests && state.kept.size < state.frames && state.playing) this.request(this.nextMissing(frame), "still", true);
  }

  nextMissing(from) {
    const { kept, frames } = this.live.state;
    for (let i = 0; i < frames; ++i) if (!kept.has((from + i) % frames)) return (from + i) % frames;
    return from;
  }

  async request(frame, effort, ahead = false) {
    const { live } = this, { state } = live, { version } = state;
    let newer = false;
    this.busy = true;
    try {
      const response = await live.ask("/picture", live.body({ frame, wrap: true, effort }));
      if (response.status === 204 || response.status === 410) return;
      if (!response.ok) {
        if (version === state.version) state.refused = version;
        live.refuse(await response.text());
        return;
      }
      const [head, greys] = LiveServer.parts(await response.arrayBuffer()), made = { ...head, greys, version };
      if (version === state.version) {
        live.player.setFrames(made.frames);
        live.refuse("");
        if (effort === "still") state.kept.set(made.frame, made);
        if (state.m_line) live.overlay.drawM();
      }
      if (!ahead && (version === state.version || state.held)) this.show(made);
      newer = version !== state.version;
    } catch {
      page.byId("refusal").textContent = "The program does not answer: it has ended, or the connection is lost.";
      await new Promise((done) => setTimeout(done, 1000));
    } finally {
      this.busy = false;
    }
    if (newer) this.tick(performance.now());  // a hand does not wait for the screen
  }
}
