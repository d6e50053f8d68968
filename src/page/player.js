// Loops of frames, side by side and in step.
"use strict";

// Decoded frames of one loop, the last used ones kept: all of a long loop would not fit in memory.
class FrameStore {
  constructor(images, kept) {
    this.images = images;
    this.kept = Math.max(8, kept);
    this.decoded = new Map(); // frame -> promise of its bitmap, the least recently used first
  }

  get(k) {
    const image = this.images[k];
    if (!image) return Promise.resolve(null);
    const found = this.decoded.get(k) ?? FrameStore.decode(image);
    this.decoded.delete(k);
    this.decoded.set(k, found);
    while (this.decoded.size > this.kept) {
      const [oldest, bitmap] = this.decoded.entries().next().value;
      this.decoded.delete(oldest);
      bitmap.then((b) => b?.close(), () => {});
    }
    return found;
  }

  static decode({ type, text }) {
    const binary = atob(text);
    const bytes = new Uint8Array(binary.length);
    for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
    return createImageBitmap(new Blob([bytes], { type }), { colorSpaceConversion: "none" });
  }
}

// A loop may have over: { images, draw(context, bitmap, k) }, which draws on top of its frames.
// new Player(root, { loops: [{ label, images }], count, rate_hz, describe }): images as page.frames()
// gives them, as many in each loop; count: of frames, where there is no loop to tell it; rate_hz:
// images shown per second at speed 1; describe(k): text beside the scrubber. Events: "frame"
// whenever another frame is on the canvases; detail.index is it.
class Player extends EventTarget {
  static kMemory_bytes = 256 << 20;

  constructor(root, { loops, count = 0, rate_hz, describe = () => "" }) {
    super();
    this.count = Math.max(count, ...loops.map((loop) => loop.images.length));
    this.rate_hz = rate_hz;
    this.describe = describe;
    this.speed = 1;
    this.index = -1; // on the canvases
    this.wanted = 0;
    this.busy = false;
    this.playing = false;
    this.loops = [];
    const figures = loops.map((loop) => this.addLoop(loop, loops.length));
    root.append(page.element("div", { class: `loops of-${loops.length}` }, ...figures), this.controls());
    document.addEventListener("keydown", (event) => this.key(event));
    if (this.count) this.seek(0);
  }

  addLoop({ label, images, over }, loops) {
    const canvas = page.element("canvas", { role: "img", "aria-label": label, width: 4, height: 3 });
    // 4 bytes a pixel; frames are taken for a megapixel until the first is seen.
    const store = new FrameStore(images, Player.kMemory_bytes / (4 << 20) / loops);
    const top = over && { draw: over.draw, store: new FrameStore(over.images, store.kept) };
    this.loops.push({ canvas, store, top, context: canvas.getContext("2d") });
    return page.element("figure", { class: "loop" }, canvas, label && page.element("figcaption", {}, label));
  }

  controls() {
    const { element } = page;
    const button = (text, label, click) =>
      element("button", { type: "button", "aria-label": label, title: label, click }, text);
    this.play_button = button("▶", "Play", () => this.toggle());
    this.scrubber = element("input", { type: "range", min: 0, max: Math.max(0, this.count - 1), value: 0,
      step: 1, "aria-label": "Frame", input: () => { this.pause(); this.seek(Number(this.scrubber.value)); } });
    this.readout = element("output", { "aria-live": "off" });
    const speed = element("select", { "aria-label": "Speed", change: () => this.setSpeed(Number(speed.value)) },
      ...[0.1, 0.25, 0.5, 1, 2].map((s) => element("option", { value: s, selected: s === 1 }, `${s} ×`)));
    this.speed_select = speed;
    const bar = element("div", { class: "controls no-print" }, this.play_button,
      button("◂", "Previous frame", () => this.step(-1)), button("▸", "Next frame", () => this.step(1)),
      this.scrubber, speed);
    const keys = element("p", { class: "keys no-print" }, element("kbd", {}, "space"), " plays, ",
      element("kbd", {}, "←"), " ", element("kbd", {}, "→"), " step, ", element("kbd", {}, "home"), " ",
      element("kbd", {}, "end"), " jump");
    return element("div", {}, bar, element("p", { class: "keys" }, this.readout), keys);
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.target.closest?.("input, select, textarea")) return;
    if (event.key === " " && event.target.closest?.("button")) return;
    const action = { " ": () => this.toggle(), ArrowLeft: () => this.step(-1), ArrowRight: () => this.step(1),
      Home: () => this.jump(0), End: () => this.jump(this.count - 1) }[event.key];
    if (!action) return;
    event.preventDefault();
    action();
  }

  setSpeed(speed) {
    this.speed = speed;
    if (this.playing) this.start();
  }

  toggle() { if (this.playing) this.pause(); else this.play(); }

  play() {
    if (this.playing || this.count < 2) return;
    this.playing = true;
    this.showState();
    this.start();
    requestAnimationFrame((now) => this.tick(now));
  }

  pause() {
    this.playing = false;
    this.showState();
  }

  start() {
    this.started_ms = performance.now();
    this.started_at = this.wanted;
  }

  showState() {
    const label = this.playing ? "Pause" : "Play";
    this.play_button.textContent = this.playing ? "❚❚" : "▶";
    this.play_button.setAttribute("aria-label", label);
    this.play_button.title = label;
  }

  step(n) {
    this.pause();
    this.seek((this.wanted + n + this.count) % this.count);
  }

  jump(k) {
    this.pause();
    this.seek(k);
  }

  // Where the clock says; frames are left out where the machine is slower than the loop.
  tick(now) {
    if (!this.playing) return;
    const passed_s = Math.max(0, now - this.started_ms) / 1000;
    const k = (this.started_at + Math.floor(passed_s * this.rate_hz * this.speed)) % this.count;
    if (k !== this.wanted && !this.busy) this.seek(k);
    requestAnimationFrame((next) => this.tick(next));
  }

  // Shows frame k on all canvases at once; the promise is kept when it is there, or overtaken.
  async seek(k) {
    this.wanted = Math.min(Math.max(0, Math.round(k)), this.count - 1);
    const wanted = this.wanted;
    this.busy = true;
    try {
      const bitmaps = await Promise.all(this.loops.map((loop) =>
        Promise.all([loop.store.get(wanted), loop.top?.store.get(wanted)])));
      if (wanted !== this.wanted) return;
      this.loops.forEach((loop, i) => {
        Player.draw(loop, bitmaps[i][0], wanted);
        if (bitmaps[i][0]) loop.top?.draw(loop.context, bitmaps[i][1], wanted);
      });
      this.show(wanted);
    } catch (error) {
      this.readout.textContent = `Frame ${wanted} cannot be decoded: ${error.message}`;
    } finally {
      if (wanted === this.wanted) this.busy = false;
    }
  }

  static draw({ canvas, context, store }, bitmap, k) {
    if (bitmap && (canvas.width !== bitmap.width || canvas.height !== bitmap.height)) {
      canvas.width = bitmap.width;
      canvas.height = bitmap.height;
      store.kept = Math.max(8, Math.min(store.kept, Player.kMemory_bytes / (4 * bitmap.width * bitmap.height)));
    }
    context.clearRect(0, 0, canvas.width, canvas.height);
    if (bitmap) context.drawImage(bitmap, 0, 0);
    canvas.dataset.frame = k;
  }

  show(k) {
    this.index = k;
    this.scrubber.value = k;
    const text = this.describe(k);
    this.scrubber.setAttribute("aria-valuetext", text || `frame ${k}`);
    this.readout.textContent = text;
    this.dispatchEvent(new CustomEvent("frame", { detail: { index: k } }));
    for (let ahead = 1; ahead <= 4 && this.playing; ++ahead)
      for (const loop of this.loops) loop.store.get((k + ahead) % this.count).catch(() => {});
  }
}
