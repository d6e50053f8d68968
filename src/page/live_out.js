// Results of a session: scene, picture, loop, pose and command; and the effects with their cost.
"use strict";

class LiveOut {
  // live: { state, ask, body, setKey }
  constructor(live) {
    this.live = live;
    const { element, byId, data } = page;
    const stem = data.file.replace(/\.toml$/, "");
    const name = element("input", { type: "text", id: "save-name", value: `${stem}_live.toml` });
    const replace = element("input", { type: "checkbox", id: "replace" });
    const button = (label, click) => element("button", { type: "button", click }, label);
    byId("out").append(element("label", { for: "save-name" }, "file beside the scene"), name,
      element("label", { for: "replace" }, replace, " replace"),
      button("Save scene", () => this.save(name.value, replace.checked)),
      button("Save PNG", () => this.fetchFile("/png", { frame: live.state.frame }, `${stem}_${live.state.frame}.png`)),
      ...[["mp4", "MP4"], ["gif", "GIF"], ["webp", "WebP"]].map(([format, word]) => button(`Save ${word}`, () => this.fetchFile("/loop", { format }, `${stem}.${format}`))),
      button("Copy pose", () => this.copyPose()));
    byId("effects").addEventListener("toggle", () => { if (byId("effects").open) this.showEffects(); });
  }

  say(words) { page.byId("saved").textContent = words; }

  async copy(text, done, failed) {
    try {
      await navigator.clipboard.writeText(text);
      this.say(done);
    } catch {
      this.say(failed);
    }
  }

  async save(name, replace) {
    const response = await this.live.ask("/save", this.live.body({ name, replace }));
    if (!response.ok) return this.say((await response.text()).trim());
    const { saved, command } = await response.json(), box = page.byId("command");
    this.say(`Saved: ${saved}`);
    box.replaceChildren("Render it: ", page.element("code", {}, command), " ",
      page.element("button", { type: "button", click: () => this.copy(command, "The command is copied.", "Select the command and copy it.") }, "Copy command"));
  }

  async fetchFile(path, more, name) {
    this.say(path === "/loop" ? "The loop is being made ..." : "");
    const response = await this.live.ask(path, this.live.body(more));
    if (response.status !== 200) return this.say(response.status === 204 ? "Stopped." : (await response.text()).trim());
    const link = page.element("a", { href: URL.createObjectURL(await response.blob()), download: name });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
    this.say(`Downloaded: ${name}`);
  }

  async copyPose() {
    const response = await this.live.ask("/scene", this.live.body());
    if (!response.ok) return this.say((await response.text()).trim());
    const { pose } = await response.json();
    page.byId("pose-keys").textContent = pose;
    await this.copy(pose, "The pose is copied.", "The pose is listed below.");
  }

  // ---- Effects

  // The key that switches an effect, if one does.
  static keyOf(name) {
    const tables = ["effects", "artefacts"].map((table) => page.data.keys.find((k) => k.key === `${table}.${name}`));
    const key = [...tables, page.data.keys.find((k) => k.key === `${name}.on`)].find((k) => k);
    return key && (key.kind === "flag" || key.kind === "word" && key.words.includes("off") && key.words.includes("on")) ? key : null;
  }

  control(name) {
    const { element } = page, key = LiveOut.keyOf(name), { state } = this.live;
    if (!key || state.values[key.key] === undefined) return "–";
    const current = state.values[key.key];
    if (key.kind === "flag") return element("input", { type: "checkbox", "aria-label": name, checked: current === true, change: (e) => this.live.setKey(key.key, e.target.checked) });
    return element("select", { "aria-label": name, change: (e) => this.live.setKey(key.key, e.target.value) },
      ...key.words.map((w) => element("option", { value: w, selected: w === current }, w)));
  }

  async showEffects() {
    const { element, byId, fixed } = page, { state } = this.live, version = state.version;
    const response = await this.live.ask("/effects", this.live.body());
    if (response.status !== 200) return;
    const { effects, stage_ms } = await response.json(), box = byId("effects").querySelector("div");
    box.replaceChildren();
    const cells = new Map(effects.map(({ name }) => [name, element("span", {}, LiveOut.keyOf(name) && state.costs?.version === version && state.costs[name] || "–")]));
    const button = element("button", { type: "button", click: () => this.measure(effects, cells, button) }, "Measure the time of each effect");
    box.append(element("div", { class: "controls" }, button));
    page.table(box, { columns: [{ label: "effect" }, { label: "now" }, { label: "switch" }, { label: "ms", number: true }, { label: "reason" }],
      rows: effects.map(({ name, on, reason }) => [name, on ? "on" : "off", this.control(name), cells.get(name), reason]) });
    page.table(box, { caption: "Time of a complete frame by stage, on one thread", columns: [{ label: "stage" }, { label: "ms", number: true }],
      rows: Object.entries(stage_ms).filter(([, ms]) => ms > 0).map(([stage, ms]) => [stage, fixed(ms, 2)]) });
  }

  // CPU time of a frame with an effect less the time without it. Effects that need others include them.
  async measure(effects, cells, button) {
    const { state } = this.live, { version, frame } = state, body = this.live.body({ frame });
    const timeOf = async (keys) => {
      const response = await this.live.ask("/cost", { ...body, keys: { ...body.keys, ...keys } });
      return response.status === 200 ? (await response.json()).ms : null;
    };
    const switched = effects.filter(({ name }) => LiveOut.keyOf(name) && state.values[LiveOut.keyOf(name).key] !== undefined);
    button.disabled = true;
    state.costs = { version };
    const now = await timeOf({});
    for (const [i, { name, on }] of switched.entries()) {
      if (state.version !== version) break;
      button.textContent = `Measured ${i} of ${switched.length} ...`;
      const key = LiveOut.keyOf(name);
      const value = (wanted) => (key.kind === "flag" ? wanted : wanted ? "on" : "off");
      const other = await timeOf({ [key.key]: value(!on) });
      const words = now === null || other === null ? "–" : `${page.fixed(Math.max(0, on ? now - other : other - now), 1)}`;
      state.costs[name] = on ? words : `(${words})`;
      cells.get(name).textContent = state.costs[name];
    }
    button.textContent = "Measure again (ms of processor time of a complete frame; in brackets: if the effect were on)";
    button.disabled = false;
  }
}
