// Time: plays the beat, freezes it, steps through it, and shows the ECG.
"use strict";

class LivePlayer {
  // state: playing, frame, frames, loop, shown
  constructor(state) {
    const { byId, element } = page;
    Object.assign(this, { state, started_ms: performance.now(), started_at: 0, ecg: byId("ecg") });
    const step = (by) => this.stepTo(state.frame + by);
    this.scrubber = element("input", { type: "range", min: 0, max: state.frames - 1, value: 0, "aria-label": "Frame",
      input: () => this.stepTo(Number(this.scrubber.value)) });
    this.button = element("button", { type: "button", click: () => this.toggle() });
    byId("player").append(this.button, element("button", { type: "button", "aria-label": "Previous frame", click: () => step(-1) }, "◂"),
      element("button", { type: "button", "aria-label": "Next frame", click: () => step(1) }, "▸"), this.scrubber);
    this.ecg.addEventListener("click", (event) => this.stepTo(Math.floor(event.offsetX / this.ecg.clientWidth * state.frames)));
    for (const scrolled of [this.ecg, this.scrubber])  // cine scroll
      scrolled.addEventListener("wheel", (event) => { event.preventDefault(); step(event.deltaY > 0 ? 1 : -1); }, { passive: false });
    this.showButton();
  }

  // The frame that the clock wants.
  wanted(now) {
    const { state } = this;
    if (state.playing)
      state.frame = Math.floor(this.started_at + Math.max(0, now - this.started_ms) / 1000 * state.loop.frame_rate_hz) % state.frames;
    return state.frame;
  }

  toggle() {
    const { state } = this;
    state.playing = !state.playing;
    Object.assign(this, { started_ms: performance.now(), started_at: state.frame });
    this.showButton();
  }

  showButton() {
    const { playing } = this.state, label = playing ? "Freeze" : "Play";
    this.button.textContent = playing ? "❚❚" : "▶";
    this.button.setAttribute("aria-label", label);
    this.button.title = label;
  }

  stepTo(frame) {
    const { state } = this;
    if (state.playing) this.toggle();
    state.frame = (frame + state.frames) % state.frames;
  }

  setFrames(frames) {
    const { state } = this;
    state.frames = frames;
    if (!state.playing) state.frame %= frames;
    this.scrubber.max = frames - 1;
  }

  // Another heart rate, frame rate or number of beats.
  setLoop(loop) {
    this.state.loop = loop;
    this.setFrames(loop.frames);
    this.drawEcg();
  }

  show(made) {
    this.scrubber.value = made.frame;
    this.drawEcg();
  }

  drawEcg() {
    const { ecg, state: { loop: { ecg: lead }, shown } } = this;
    const width = ecg.width = Math.max(100, ecg.clientWidth), { height } = ecg, context = ecg.getContext("2d");
    const low = Math.min(...lead), high = Math.max(...lead), at = (v) => height - 6 - (v - low) / (high - low) * (height - 12);
    const draw = (colour, points) => {
      context.strokeStyle = page.colour(colour);
      context.beginPath();
      points.forEach((p) => context.lineTo(...p));
      context.stroke();
    };
    draw("muted", lead.map((v, i) => [i / (lead.length - 1) * width, at(v)]));
    if (!shown) return;
    const x = shown.frame / shown.frames * width;
    draw("accent", [[x, 0], [x, height]]);
  }
}
