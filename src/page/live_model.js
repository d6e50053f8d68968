// The dials of a parametric heart. A new heart is made beside the one that beats, and replaces it
// once it is there.
"use strict";

// new LiveModel(live): live has { state, ask, body, setHeart(answer) }.
class LiveModel {
  static kFirst = ["ef", "edv", "wall-thickness", "hr", "sphericity", "mapse", "twist"];
  static kNames = { ef: "ejection fraction (EF)", edv: "end-diastolic volume (EDV)", hr: "heart rate", mapse: "excursion of the mitral ring" };
  // Coronary territories (Cerqueira et al., 2002).
  static kTerritories = [["LAD", [1, 2, 7, 8, 13, 14, 17]], ["RCA", [3, 4, 9, 10, 15]], ["LCx", [5, 6, 11, 12, 16]]];

  constructor(live) {
    Object.assign(this, { live, dials: {}, segments: {}, inputs: {}, asked: 0, last: "" });
    const { heart } = page.data;
    if (!heart) return;
    page.byId("heart").hidden = false;
    const first = page.byId("heart-dials"), more = page.byId("heart-more").querySelector("div");
    for (const key of LiveModel.kFirst) this.addDial(first, heart.dials.find((d) => d.key === key));
    for (const dial of heart.dials) if (!LiveModel.kFirst.includes(dial.key)) this.addDial(more, dial);
    this.addSegments(heart.segments);
    this.words = page.byId("heart-words");
    // The first heart of a session takes longer, because the file's own one is made for comparison.
    setTimeout(() => { if (!this.asked) this.live.ask("/heart", {}); }, 2500);
  }

  addInput(parent, name, label, title, { lo, hi, step, value }, set) {
    const { element } = page, id = `heart-${name}`, refusal = element("p", { class: "bad", role: "alert", hidden: true });
    const put = (text) => { this.last = name; set(text.trim() === "" || !Number.isFinite(Number(text)) ? null : Number(text)); };
    const box = element("input", { type: "number", id, min: lo, max: hi, step: "any", value: value ?? "", change: () => { bar.value = box.value; put(box.value); } });
    const bar = element("input", { type: "range", min: lo, max: hi, step, value: value ?? lo, "aria-label": `${label} by slider`,
      input: () => { box.value = bar.value; }, change: () => { box.value = bar.value; put(bar.value); } });
    const dial = element("div", { class: "dial", title }, element("label", { for: id }, label), box, bar, refusal);
    this.inputs[name] = { box, bar, refusal, dial, value };
    parent.append(dial);
  }

  addDial(parent, { key, unit, lo, hi, value, meaning }) {
    const step = 10 ** Math.floor(Math.log10((hi - lo) / 50)), label = (LiveModel.kNames[key] ?? key.replace(/-/g, " ")) + (unit === "1" ? "" : `, ${unit}`);
    this.addInput(parent, key, label, meaning, { lo, hi, step, value }, (number) => {
      if (number === null) delete this.dials[key];
      else this.dials[key] = number;
      this.apply();
    });
  }

  addSegments(amplitudes) {
    const { element, data } = page, box = page.byId("heart-segments").querySelector("div");
    const buttons = element("div", { class: "controls" });
    const setAll = (numbers, amplitude) => {
      for (const n of numbers) this.setSegment(n, amplitude);
      this.apply();
    };
    for (const [name, numbers] of LiveModel.kTerritories)
      buttons.append(element("button", { type: "button", title: `Segments ${numbers.join(", ")}: no motion`, click: () => setAll(numbers, 0) }, `Infarct: ${name}`));
    buttons.append(element("button", { type: "button", click: () => setAll(amplitudes.map((_, i) => i + 1), null) }, "As in the file"));
    const grid = element("div", { class: "dials" });
    amplitudes.forEach((value, i) => this.addInput(grid, `segment-${i + 1}`, `${i + 1} ${data.segment_names[i]}`,
      "inward motion: 1 healthy, 0 none, below 0 outward", { lo: -0.5, hi: 1.5, step: 0.05, value },
      (number) => { this.setSegment(i + 1, number); this.apply(); }));
    box.append(buttons, grid);
  }

  setSegment(number, amplitude) {
    const { box, bar, value } = this.inputs[`segment-${number}`];
    if (amplitude === null) delete this.segments[number];
    else this.segments[number] = amplitude;
    box.value = bar.value = amplitude ?? value;
  }

  // Some dials follow others.
  showValue(name, value) {
    const { box, bar } = this.inputs[name];
    if (document.activeElement === box || value === null) return;
    box.value = bar.value = Number(value.toPrecision(6));
  }

  refuse(line) {
    for (const [name, { refusal, box }] of Object.entries(this.inputs)) {
      const mine = line !== "" && name === this.last;
      refusal.hidden = !mine;
      refusal.textContent = mine ? line : "";
      box.setAttribute("aria-invalid", String(mine));
    }
  }

  // The heart that is shown, where the program has not kept it.
  async again() {
    if (this.remaking) return;
    this.remaking = true;
    try {
      await this.live.ask("/heart", this.live.state.wish);
    } finally {
      this.remaking = false;
    }
  }

  // The newest wish wins. Refused dials leave the heart that beats as it is.
  async apply() {
    const number = ++this.asked, wish = { dials: { ...this.dials }, segments: { ...this.segments } }, begun = performance.now();
    this.words.textContent = "A new heart is being made; the one before it beats on.";
    const response = await this.live.ask("/heart", wish);
    if (number !== this.asked) return;
    if (response.status === 204) { setTimeout(() => { if (number === this.asked) this.apply(); }, 200); return; }
    if (!response.ok) {
      const line = (await response.text()).trim();
      this.refuse(line);
      const { dials, segments } = this.live.state.wish;  // a refused value is in no later wish
      Object.assign(this, { dials: { ...dials }, segments: { ...segments } });
      this.words.textContent = "The heart before it beats on.";
      return;
    }
    this.refuse("");
    const answer = await response.json();
    // The rate of the heart replaces a rate that was set as a key of the scene.
    if (this.last === "hr") delete this.live.state.keys["acquisition.heart_rate_bpm"];
    this.live.setHeart(wish, answer);
    for (const { key, value } of answer.heart.dials) this.showValue(key, value);
    answer.heart.segments.forEach((value, i) => this.showValue(`segment-${i + 1}`, value));
    this.words.textContent = `The heart took ${Math.round(performance.now() - begun)} ms.`;
    for (const [name, { dial }] of Object.entries(this.inputs))
      dial.classList.toggle("changed", name in wish.dials || name.replace("segment-", "") in wish.segments && name.startsWith("segment-"));
  }
}
