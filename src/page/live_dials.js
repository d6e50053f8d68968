// Dials of scene keys: a control for each key, generated from the table of keys.
"use strict";

// new LiveDials(keys, values, changed): changed(key, value) when a person sets one; null: the default.
class LiveDials {
  // Ranges of sliders. The scene accepts more; the number beside a slider does, too.
  static kSliders = {
    "probe.depth_mm": [30, 300, 1], "probe.sector_deg": [10, 150, 1], "probe.frequency_mhz": [1, 10, 0.1],
    "probe.focus_mm": [5, 300, 1], "signal.gain_db": [-30, 30, 0.5], "signal.dynamic_range_db": [20, 120, 1],
  };

  static kFirst = ["probe.depth_mm", "probe.sector_deg", "probe.frequency_mhz", "probe.focus_mm", "signal.gain_db",
    "signal.dynamic_range_db", "signal.look", "signal.quality", "signal.tgc", "speckle.on", "speckle.seed",
    "probe.lines", "probe.samples"];

  constructor(keys, changed) {
    this.keys = new Map(keys.map((key) => [key.key, key]));
    this.changed = changed;
    this.dials = [];
  }

  // A key may have several dials, in several lists.
  add(parent, name) {
    const { element } = page, key = this.keys.get(name);
    if (!key || key.kind === "other" && !(name in LiveDials.kSliders)) return;
    const id = `dial-${this.dials.length}-${name}`;
    const dial = { key, inputs: [], refusal: element("p", { class: "bad", role: "alert", hidden: true }) };
    const set = (value) => this.changed(name, value);
    if (key.kind === "flag") {
      const box = element("input", { type: "checkbox", id, change: () => set(box.checked) });
      dial.inputs.push(box);
    } else if (key.kind === "word") {
      const list = element("select", { id, change: () => set(list.value) }, ...key.words.map((w) => element("option", { value: w }, w)));
      dial.inputs.push(list);
    } else {
      const whole = key.kind === "whole", slider = LiveDials.kSliders[name];
      const put = (text) => { if (text.trim() === "") set(null); else if (Number.isFinite(Number(text))) set(whole ? Math.round(Number(text)) : Number(text)); };
      const box = element("input", { type: "number", id, min: key.lo ?? undefined, max: key.hi ?? undefined,
        step: whole ? 1 : "any", change: () => put(box.value) });
      dial.inputs.push(box);
      if (slider) {
        const bar = element("input", { type: "range", min: slider[0], max: slider[1], step: slider[2], "aria-label": `${name} by slider`,
          input: () => put(bar.value) });
        dial.inputs.push(bar);
      }
    }
    dial.box = element("div", { class: "dial", title: key.meaning }, element("label", { for: id }, LiveDials.words(name)),
      ...dial.inputs, dial.refusal);
    this.dials.push(dial);
    parent.append(dial.box);
  }

  // "probe.depth_mm" -> "depth, mm"
  static words(name) {
    const units = { mm: "mm", deg: "°", mhz: "MHz", db: "dB", hz: "Hz", bpm: "/min", ms: "ms" };
    const [table, key] = name.split("."), parts = key.split("_"), unit = units[parts[parts.length - 1]];
    if (unit) parts.pop();
    return (["probe", "signal"].includes(table) ? "" : `${table}: `) + parts.join(" ") + (unit ? `, ${unit}` : "");
  }

  // Values as the scene has them; those in `changed` are marked. Keys without effect are disabled.
  show(values, changed) {
    for (const { key, inputs, box } of this.dials) {
      const value = values[key.key], known = value !== undefined;
      box.classList.toggle("changed", key.key in changed);
      for (const input of inputs) {
        input.disabled = !known;
        if (input.type === "checkbox") input.checked = value === true;
        else if (document.activeElement !== input || input.type === "range") input.value = known && value !== null ? value : "";
      }
    }
  }

  // A refusal beside the dials of the key that it names; "" clears all.
  refuse(name, line) {
    for (const dial of this.dials) {
      const mine = line !== "" && dial.key.key === name;
      dial.refusal.hidden = !mine;
      dial.refusal.textContent = mine ? line : "";
      for (const input of dial.inputs) input.setAttribute("aria-invalid", String(mine));
    }
  }
}
