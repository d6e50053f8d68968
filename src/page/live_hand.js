// The hand: pointer, wheel and keys move the probe, or set points with a tool of measurement.
"use strict";

class LiveHand {
  static kTools = [["tilt", "Tilt and rock"], ["rotate", "Rotate"], ["slide", "Slide and press"], ["measure", "Measure mm"], ["trace", "Trace mL"], ["line", "M-mode"]];
  static kHints = {
    measure: "Click two points.", line: "The line follows the pointer.",
    trace: "Click along the border of a cavity, from one side of the valve to the other.",
  };

  // live: { state, pose, picture, player, overlay }
  constructor(live) {
    this.live = live;
    this.canvas = live.picture.canvas;
    this.makeTools();
    this.listen();
  }

  // Is the tool one of points? Its keys move a cross.
  get points() { return this.live.state.tool in LiveHand.kHints; }

  makeTools() {
    const { element, byId } = page, { state, overlay } = this.live;
    const buttons = LiveHand.kTools.map(([name, label]) => element("button", { type: "button", "aria-pressed": String(name === state.tool), click: () => {
      Object.assign(state, { tool: name, cursor: null });
      buttons.forEach((b, i) => b.setAttribute("aria-pressed", String(LiveHand.kTools[i][0] === name)));
      byId("hint").textContent = this.points ? `${LiveHand.kHints[name]} By keys: arrows move a cross, Enter sets a point.` : "";
      overlay.draw();
    } }, label));
    byId("tools").append(...buttons, element("button", { type: "button", click: () => overlay.clear() }, "Clear"));
    overlay.makeControls(byId("truth"));
  }

  hold(on) { Object.assign(this.live.state, { held: on, changed_ms: performance.now() }); }

  listen() {
    const { canvas, live } = this, { state, picture, overlay } = live;
    let last = null;
    canvas.addEventListener("pointerdown", (event) => {
      if (event.button) return;
      if (this.points) { overlay.put(picture.placeOf(event)); return; }
      last = event;
      this.hold(true);
      canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener("pointermove", (event) => {
      if (state.tool === "line" && state.m_line) overlay.chooseLine(picture.placeOf(event));
      if (!last) return;
      const scale = canvas.width / canvas.clientWidth;
      this.drag(event, (event.clientX - last.clientX) * scale, (event.clientY - last.clientY) * scale);
      last = event;
    });
    for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, () => { last = null; this.hold(false); });
    canvas.addEventListener("wheel", (event) => { event.preventDefault(); live.pose.press(event.deltaY > 0 ? -1 : 1); }, { passive: false });
    document.addEventListener("keydown", (event) => this.key(event));
  }

  // By pixels of the picture.
  drag(event, dx, dy) {
    const { state, pose } = this.live, mm = state.sector.picture.mm_per_px;
    const tool = event.shiftKey ? "rotate" : event.altKey || event.ctrlKey ? "slide" : state.tool;
    if (tool === "rotate") pose.rotate(0.2 * dx);
    else if (tool === "slide") pose.shift({ x: -mm * dx, z: -mm * dy });
    else pose.set(probePose.tilted(probePose.rocked(state.pose, -0.12 * dx), 0.12 * dy));
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.closest?.("input, select, textarea")) return;
    if (event.key === " " && event.target.closest?.("button, summary")) return;
    if (this.points && (event.target === this.canvas || event.key !== "Enter") && this.moveCross(event)) { event.preventDefault(); return; }
    const { state, pose, player } = this.live, step = event.shiftKey ? 0.25 : 1;
    const actions = { ArrowLeft: () => pose.rock(-2 * step), ArrowRight: () => pose.rock(2 * step), ArrowUp: () => pose.tilt(2 * step),
      ArrowDown: () => pose.tilt(-2 * step), q: () => pose.rotate(-3 * step), e: () => pose.rotate(3 * step), a: () => pose.shift({ x: -2 * step }),
      d: () => pose.shift({ x: 2 * step }), w: () => pose.shift({ y: 2 * step }), s: () => pose.shift({ y: -2 * step }), r: () => pose.press(2 * step),
      f: () => pose.press(-2 * step), 0: () => pose.goTo(""), " ": () => player.toggle(), "[": () => player.stepTo(state.frame - 1),
      "]": () => player.stepTo(state.frame + 1) };
    const view = page.data.views[Number(event.key) - 1];
    const action = view ? () => pose.goTo(view.key) : actions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!action) return;
    event.preventDefault();
    action();
  }

  // Whether the key is one of the cross.
  moveCross(event) {
    const { canvas, live: { state, overlay } } = this, step = event.shiftKey ? 2 : 12;
    const by = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step] }[event.key];
    const [x, y] = state.cursor ?? [canvas.width / 2, canvas.height / 2];
    if (by) state.cursor = [Math.max(0, Math.min(canvas.width, x + by[0])), Math.max(0, Math.min(canvas.height, y + by[1]))];
    else if (event.key === "Enter") overlay.put([x, y]);
    else return false;
    if (by && state.tool === "line") overlay.chooseLine(state.cursor);
    overlay.draw();
    return true;
  }
}
