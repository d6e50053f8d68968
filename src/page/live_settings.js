// The settings of the scene: dials of its keys, gain by depth, and what differs from its file.
"use strict";

class LiveSettings {
  static kGains = 8;  // as scanners have them

  // live: { state, ask, body, refuse, changed, player, heart, out }
  constructor(live) {
    const { byId, data } = page;
    this.live = live;
    this.dials = new LiveDials(data.keys, (name, value) => this.set(name, value));
    for (const name of LiveDials.kFirst) this.dials.add(byId("dials"), name);
    const more = byId("all-keys").querySelector("div");
    for (const { key: name } of data.keys) if (!LiveDials.kFirst.includes(name)) this.dials.add(more, name);
    this.makeGain();
    this.dials.show(live.state.values, live.state.keys);
  }

  set(name, value) {
    const { state } = this.live;
    state.last_key = name;
    state.keys[name] = value;
    this.live.changed();
  }

  // Values, sector, loop and changes of the scene, once changes pause.
  refresh() {
    clearTimeout(this.later);
    this.later = setTimeout(async () => {
      const { live } = this, { version } = live.state, response = await live.ask("/scene", live.body());
      if (response.status === 410) return;
      if (!response.ok) { live.refuse(await response.text()); return; }
      const scene = await response.json();
      if (version === live.state.version) this.show(scene);
    }, 120);
  }

  // 5.3864000000000001 -> 5.3864
  static short(text) { return text.replace(/-?\d+\.\d{6,}/g, (digits) => String(Number(Number(digits).toFixed(5)))); }

  show({ values, sector, loop, pose, changes }) {
    const { byId } = page, { state, heart, player, out } = this.live;
    const resized = JSON.stringify(sector.sector_mm) !== JSON.stringify(state.sector.sector_mm);
    Object.assign(state, { values, sector });
    if (resized) {
      heart.setSector(sector);
      heart.setGhost(state.reference);
    }
    player.setLoop(loop);
    this.dials.show(values, state.keys);
    byId("pose-keys").textContent = pose;
    byId("changes").replaceChildren();
    if (changes.length)
      page.table(byId("changes"), { caption: "Changes of the scene file", columns: [{ label: "key" }, { label: "from" }, { label: "to" }],
        rows: changes.map(({ key, from, to }) => [key, LiveSettings.short(from) || "–", LiveSettings.short(to) || "–"]) });
    if (byId("effects").open) out.showEffects();
  }

  // Sliders over the depth.
  makeGain() {
    const { byId, element } = page, box = byId("gain").querySelector("div"), count = LiveSettings.kGains, gains = new Array(count).fill(0);
    const apply = () => {
      const { state } = this.live, points = gains.map((g, i) => [Number((i / (count - 1) * state.sector.depth_mm).toFixed(2)), g]);
      state.keys["signal.tgc"] = "table";
      this.set("signal.tgc_table_mm_db", points);
    };
    for (let i = 0; i < count; ++i) {
      const id = `gain-${i}`, bar = element("input", { type: "range", id, min: -20, max: 80, step: 1, value: 0,
        change: () => { gains[i] = Number(bar.value); apply(); } });
      box.append(element("div", { class: "dial" }, element("label", { for: id }, `gain at ${Math.round(100 * i / (count - 1))} % of the depth, dB`), bar));
    }
  }
}
