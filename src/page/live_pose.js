// The pose of the probe: its motions, its numbers from a reference pose, and the standard views.
"use strict";

class LivePose {
  static kNumbers = [["x", "slide lateral, mm"], ["y", "slide across, mm"], ["z", "press, mm"], ["rotate", "rotate, °"], ["tilt", "tilt, °"], ["rock", "rock, °"]];

  static kViews = { a4c: "apical 4-chamber", a2c: "apical 2-chamber", a3c: "apical 3-chamber", plax: "long axis", "psax-base": "short axis, base",
    "psax-mid": "short axis, middle", "psax-apex": "short axis, apex", subcostal: "subcostal",
    "tee-4c": "transoesophageal" };

  // live: { state, ask, refuse, changed, heart }
  constructor(live) {
    const { byId, element, data } = page;
    Object.assign(this, { live, numbers: {}, unit_mm: data.view.unit_mm });
    for (const [name, label] of LivePose.kNumbers) {
      const id = `pose-${name}`, input = element("input", { type: "number", id, step: "any", change: () => this.setNumber(name, Number(input.value)) });
      this.numbers[name] = input;
      byId("pose").append(element("div", { class: "dial" }, element("label", { for: id }, label), input));
    }
    const view = ({ key, meaning }, i) => element("button", { type: "button", title: `${key}: ${meaning}`, click: () => this.goTo(key) }, `${i + 1} ${LivePose.kViews[key] ?? key}`);
    byId("views").append(...data.views.map(view), element("button", { type: "button", click: () => this.goTo("") }, "0 start"));
  }

  set(pose) {
    this.live.state.pose = pose;
    this.live.heart.setPose(pose);
    this.live.changed();
  }

  rock(degrees) { this.set(probePose.rocked(this.live.state.pose, degrees)); }
  tilt(degrees) { this.set(probePose.tilted(this.live.state.pose, degrees)); }
  rotate(degrees) { this.set(probePose.rotated(this.live.state.pose, degrees)); }
  shift(by_mm) { this.set(probePose.shifted(this.live.state.pose, by_mm)); }
  press(mm) { this.shift({ z: mm }); }

  setNumber(name, value) {
    const { pose, reference } = this.live.state;
    this.set(probePose.moved(reference, { ...probePose.offsets(pose, reference), [name]: value }));
  }

  show() {
    const { state } = this.live, { fixed } = page, offsets = probePose.offsets(state.pose, state.reference);
    for (const [name] of LivePose.kNumbers)
      if (document.activeElement !== this.numbers[name]) this.numbers[name].value = Number(offsets[name].toFixed(2));
    const mm = Math.hypot(offsets.x, offsets.y, offsets.z), degrees = Math.hypot(offsets.rotate, offsets.tilt, offsets.rock);
    page.byId("off").textContent = `From ${state.reference_name} (orange outline): ${fixed(mm, 1)} mm and ${fixed(degrees, 1)}°.`;
  }

  // A standard view by its key; "": the pose of the file.
  async goTo(key) {
    const { live } = this, { state } = live;
    let pose = state.start;
    if (key) {
      const response = await live.ask("/view", { ...state.wish, view: key });
      if (!response.ok) { state.last_key = ""; live.refuse(await response.text()); return; }
      pose = probePose.fromKeys((await response.json()).keys, this.unit_mm);
    }
    Object.assign(state, { reference: pose, reference_name: key || "the start" });
    live.heart.setGhost(pose);
    this.set(pose);
    live.heart.refit();
  }

  // On another heart the probe keeps its place relative to the standard view of the heart.
  setHeart(wish, { structures, standard, own_standard }) {
    const { live, unit_mm } = this, { state } = live;
    const from = probePose.fromKeys(state.standard ?? own_standard, unit_mm), to = probePose.fromKeys(standard, unit_mm);
    const carried = (pose) => probePose.moved(to, probePose.offsets(pose, from));
    const own = !Object.keys(wish.dials).length && !Object.keys(wish.segments).length, at_start = state.pose === state.start;
    const start = own ? state.own_start : carried(state.start);
    const pose = at_start ? start : carried(state.pose), reference = state.reference === state.start ? start : carried(state.reference);
    Object.assign(state, { wish, standard, start, reference });
    live.heart.setStructures(structures);
    live.heart.setGhost(reference);
    this.set(pose);
  }
}
