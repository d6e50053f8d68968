// The page of `echocine live`: a probe in the hand, its echo, and the settings.
"use strict";

(() => {
  const { data, byId, element, fixed } = page;
  const token = new URLSearchParams(location.search).get("token") ?? "";
  const kRest_ms = 220;  // without a change the probe is at rest
  const state = {
    start: probePose.squared(data.sector.pose), reference: null, reference_name: "the start",
    keys: {}, values: data.values, version: 0, changed_ms: -1e9, held: false,
    loop: data.loop, frames: data.loop.frames, frame: 0, playing: true, started_ms: performance.now(), started_at: 0,
    shown: null, kept: new Map(), busy: false, tool: "tilt", mm: [], trace: [], m_line: null, cursor: null, last_key: "",
    wish: { dials: {}, segments: {} }, standard: null, sector: data.sector,
  };
  state.own_start = state.pose = state.reference = state.start;
  page.parts.live = state;
  const { unit_mm } = data.view;
  // At the start the pose is that of the file, to the last digit.
  const allKeys = () => ({ ...state.keys, ...(state.pose === state.own_start ? {} : probePose.keys(state.pose, unit_mm)) });
  const body = (more = {}) => ({ keys: allKeys(), ...state.wish, ...more });

  // Answers: { ok, status, response }. Refusals are lines of text.
  async function ask(path, body) {
    const response = await fetch(path, { method: "POST", headers: { "Content-Type": "application/json", "Echocine-Token": token }, body: JSON.stringify(body) });
    if (response.status === 410) model.again();
    return response;
  }

  function refuse(line) {
    byId("refusal").textContent = line.trim();
    dials.refuse(state.last_key, line.trim());
  }

  // ---- The picture

  const picture = byId("picture"), over = byId("over"), pen = picture.getContext("2d");
  let pixels = null;

  function parse(buffer) {
    const size = new DataView(buffer).getUint32(0, true);
    const head = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, size)));
    return { ...head, greys: new Uint8Array(buffer, 4 + size) };
  }

  function show(made) {
    state.shown = made;
    const { width, height, greys } = made;
    if (picture.width !== width || picture.height !== height || !pixels) {
      for (const canvas of [picture, over]) Object.assign(canvas, { width, height });
      pixels = pen.createImageData(width, height);
      pixels.data.fill(255);
    }
    const words = new Uint32Array(pixels.data.buffer);
    for (let i = 0; i < greys.length; ++i) words[i] = 0xff000000 | greys[i] * 0x010101;
    pen.putImageData(pixels, 0, 0);
    picture.dataset.version = made.version;
    picture.dataset.effort = made.effort;
    picture.dataset.frame = made.frame;
    byId("quality").textContent = `${made.quality} · ${fixed(made.ms, 0)} ms`;
    heart.showPhase(made.phase);
    heart.follow(picture);
    drawEcg();
    overlay.draw();
    scrubber.value = made.frame;
    const chambers = Object.entries(made.volumes_ml).filter(([name]) => /cavity|^la$|^ra$/.test(name));
    readout.textContent = `frame ${made.frame} · ${fixed(made.time_s, 3)} s · phase ${fixed(made.phase, 3)}`
      + chambers.map(([name, ml]) => ` · ${name} ${fixed(ml, 0)} mL`).join("") + ejection();
  }

  // Exact volumes of the left ventricle over the loop, once all frames are there.
  function ejection() {
    const volumes = [...state.kept.values()].map((made) => made.volumes_ml.lv_cavity).filter((ml) => ml > 0);
    if (volumes.length < state.frames) return "";
    const most = Math.max(...volumes), least = Math.min(...volumes);
    return ` · exact EF ${fixed(100 * (1 - least / most), 1)} % (${fixed(most, 1)} to ${fixed(least, 1)} mL)`;
  }

  // The frame that the clock wants.
  function wanted(now) {
    if (!state.playing) return state.frame;
    state.frame = Math.floor(state.started_at + Math.max(0, now - state.started_ms) / 1000 * state.loop.frame_rate_hz) % state.frames;
    return state.frame;
  }

  // One request at a time: the newest pose with less effort while it changes, the complete picture at rest.
  async function tick(now) {
    const frame = wanted(now), rests = !state.held && now - state.changed_ms > kRest_ms;
    const kept = rests && state.kept.get(frame);
    if (kept && (state.shown !== kept)) show(kept);
    if (!state.busy && state.refused !== state.version) {
      const shown = state.shown, stale = !shown || shown.version !== state.version;
      if (!rests ? stale || state.playing && shown.frame !== frame : !kept) fetchPicture(frame, rests ? "still" : "moving");
      else if (rests && state.kept.size < state.frames && state.playing) fetchPicture(nextMissing(frame), "still", true);
    }
    requestAnimationFrame(tick);
  }

  function nextMissing(from) {
    for (let i = 0; i < state.frames; ++i) if (!state.kept.has((from + i) % state.frames)) return (from + i) % state.frames;
    return from;
  }

  async function fetchPicture(frame, effort, ahead = false) {
    const version = state.version;
    state.busy = true;
    try {
      const response = await ask("/picture", body({ frame, wrap: true, effort }));
      if (response.status === 204 || response.status === 410) return;
      if (!response.ok) {
        if (version === state.version) state.refused = version;
        refuse(await response.text());
        return;
      }
      const made = parse(await response.arrayBuffer());
      made.version = version;
      state.frames = made.frames;
      scrubber.max = made.frames - 1;
      if (version === state.version) {
        refuse("");
        if (effort === "still") state.kept.set(made.frame, made);
        if (state.m_line) overlay.drawM();
      }
      if (!ahead && (version === state.version || state.held)) show(made);
    } catch (error) {
      byId("refusal").textContent = "The program does not answer: it has ended, or the connection is lost.";
      await new Promise((done) => setTimeout(done, 1000));
    } finally {
      state.busy = false;
    }
  }

  function changed() {
    ++state.version;
    state.changed_ms = performance.now();
    state.kept.clear();
    overlay.forget();
    showPose();
    refreshScene();
  }

  // ---- Pose

  function setPose(pose) {
    state.pose = pose;
    heart.setPose(pose);
    changed();
  }

  const move = {
    rock: (d) => setPose(probePose.rocked(state.pose, d)), tilt: (d) => setPose(probePose.tilted(state.pose, d)),
    rotate: (d) => setPose(probePose.rotated(state.pose, d)), slide: (x, y) => setPose(probePose.shifted(state.pose, { x, y })),
    press: (z) => setPose(probePose.shifted(state.pose, { z })),
  };
  const kNumbers = [["x", "slide lateral, mm"], ["y", "slide across, mm"], ["z", "press, mm"], ["rotate", "rotate, °"], ["tilt", "tilt, °"], ["rock", "rock, °"]];
  const numbers = {};

  function makePose() {
    for (const [name, label] of kNumbers) {
      const id = `pose-${name}`;
      numbers[name] = element("input", { type: "number", id, step: "any", change: () => {
        const offsets = probePose.offsets(state.pose, state.reference);
        offsets[name] = Number(numbers[name].value);
        setPose(probePose.moved(state.reference, offsets));
      } });
      byId("pose").append(element("div", { class: "dial" }, element("label", { for: id }, label), numbers[name]));
    }
    const view = ({ key, meaning }, i) => element("button", { type: "button", title: meaning, click: () => goTo(key) }, `${i + 1} ${key}`);
    byId("views").append(...data.views.map(view), element("button", { type: "button", click: () => goTo("") }, "0 start"));
  }

  function showPose() {
    const offsets = probePose.offsets(state.pose, state.reference);
    for (const [name] of kNumbers)
      if (document.activeElement !== numbers[name]) numbers[name].value = Number(offsets[name].toFixed(2));
    const mm = Math.hypot(offsets.x, offsets.y, offsets.z), degrees = Math.hypot(offsets.rotate, offsets.tilt, offsets.rock);
    byId("off").textContent = `From ${state.reference_name} (orange outline): ${fixed(mm, 1)} mm and ${fixed(degrees, 1)}°.`;
  }

  async function goTo(key) {
    let pose = state.start;
    if (key) {
      const response = await ask("/view", { ...state.wish, view: key });
      if (!response.ok) { state.last_key = ""; refuse(await response.text()); return; }
      pose = probePose.fromKeys((await response.json()).keys, unit_mm);
    }
    Object.assign(state, { reference: pose, reference_name: key || "the start" });
    heart.setGhost(pose);
    setPose(pose);
  }

  // ---- Hand: pointer, wheel and keys

  function listen() {
    let last = null;
    const hold = (on) => { state.held = on; state.changed_ms = performance.now(); };
    picture.addEventListener("pointerdown", (event) => {
      if (event.button) return;
      if (kPointTools.includes(state.tool)) return overlay.put(placeOf(event));
      last = event;
      hold(true);
      picture.setPointerCapture(event.pointerId);
    });
    picture.addEventListener("pointermove", (event) => {
      if (state.tool === "line" && state.m_line) overlay.chooseLine(placeOf(event));
      if (!last) return;
      const scale = picture.width / picture.clientWidth, dx = (event.clientX - last.clientX) * scale, dy = (event.clientY - last.clientY) * scale;
      last = event;
      const tool = event.shiftKey ? "rotate" : event.altKey || event.ctrlKey ? "slide" : state.tool, mm = state.sector.picture.mm_per_px;
      if (tool === "rotate") move.rotate(0.2 * dx);
      else if (tool === "slide") setPose(probePose.shifted(state.pose, { x: -mm * dx, z: -mm * dy }));
      else state.pose = probePose.rocked(state.pose, -0.12 * dx), move.tilt(0.12 * dy);
    });
    for (const end of ["pointerup", "pointercancel"]) picture.addEventListener(end, () => { last = null; hold(false); });
    picture.addEventListener("wheel", (event) => { event.preventDefault(); move.press(event.deltaY > 0 ? -1 : 1); }, { passive: false });
    document.addEventListener("keydown", key);
  }

  function key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.closest?.("input, select, textarea")) return;
    if (event.key === " " && event.target.closest?.("button, summary")) return;
    if (kPointTools.includes(state.tool) && (event.target === picture || event.key !== "Enter") && keyOfCross(event)) { event.preventDefault(); return; }
    const step = event.shiftKey ? 0.25 : 1;
    const actions = { ArrowLeft: () => move.rock(-2 * step), ArrowRight: () => move.rock(2 * step), ArrowUp: () => move.tilt(2 * step),
      ArrowDown: () => move.tilt(-2 * step), q: () => move.rotate(-3 * step), e: () => move.rotate(3 * step), a: () => move.slide(-2 * step, 0),
      d: () => move.slide(2 * step, 0), w: () => move.slide(0, 2 * step), s: () => move.slide(0, -2 * step), r: () => move.press(2 * step),
      f: () => move.press(-2 * step), 0: () => goTo(""), " ": toggle, "[": () => stepTo(state.frame - 1), "]": () => stepTo(state.frame + 1) };
    const view = data.views[Number(event.key) - 1];
    const action = view ? () => goTo(view.key) : actions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!action) return;
    event.preventDefault();
    action();
  }

  // ---- Player and ECG

  const scrubber = element("input", { type: "range", min: 0, max: data.loop.frames - 1, value: 0, "aria-label": "Frame", input: () => stepTo(Number(scrubber.value)) });
  const play = element("button", { type: "button", click: () => toggle() });
  const readout = byId("readout"), ecg = byId("ecg");

  function toggle() {
    state.playing = !state.playing;
    Object.assign(state, { started_ms: performance.now(), started_at: state.frame });
    showPlaying();
  }

  function showPlaying() {
    const label = state.playing ? "Freeze" : "Play";
    play.textContent = state.playing ? "❚❚" : "▶";
    play.setAttribute("aria-label", label);
    play.title = label;
  }

  function stepTo(frame) {
    if (state.playing) toggle();
    state.frame = (frame + state.frames) % state.frames;
  }

  function drawEcg() {
    const width = ecg.width = Math.max(100, ecg.clientWidth), height = ecg.height, context = ecg.getContext("2d");
    const lead = state.loop.ecg, low = Math.min(...lead), high = Math.max(...lead), at = (v) => height - 6 - (v - low) / (high - low) * (height - 12);
    context.strokeStyle = page.colour("muted");
    context.beginPath();
    lead.forEach((v, i) => context.lineTo(i / (lead.length - 1) * width, at(v)));
    context.stroke();
    if (!state.shown) return;
    const x = state.shown.frame / state.shown.frames * width;
    context.strokeStyle = page.colour("accent");
    context.beginPath();
    context.moveTo(x, 0);
    context.lineTo(x, height);
    context.stroke();
  }

  // ---- Tools

  function placeOf(event) {
    const { left, top, width, height } = picture.getBoundingClientRect();
    return [(event.clientX - left) / width * picture.width, (event.clientY - top) / height * picture.height];
  }

  const kPointTools = ["measure", "trace", "line"];  // their keys move a cross

  function keyOfCross(event) {
    const step = event.shiftKey ? 2 : 12, by = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step] }[event.key];
    const [x, y] = state.cursor ?? [picture.width / 2, picture.height / 2];
    if (by) state.cursor = [Math.max(0, Math.min(picture.width, x + by[0])), Math.max(0, Math.min(picture.height, y + by[1]))];
    else if (event.key === "Enter") overlay.put([x, y]);
    else return false;
    if (by && state.tool === "line") overlay.chooseLine(state.cursor);
    overlay.draw();
    return true;
  }

  function makeTools() {
    const tools = [["tilt", "Tilt and rock"], ["rotate", "Rotate"], ["slide", "Slide and press"], ["measure", "Measure mm"], ["trace", "Trace mL"], ["line", "M-mode"]];
    const hints = { measure: "Click two points.", trace: "Click along the border of a cavity, from one side of the valve to the other.", line: "The line follows the pointer." };
    const buttons = tools.map(([name, label]) => element("button", { type: "button", "aria-pressed": String(name === state.tool), click: () => {
      Object.assign(state, { tool: name, cursor: null });
      buttons.forEach((b, i) => b.setAttribute("aria-pressed", String(tools[i][0] === name)));
      byId("hint").textContent = hints[name] ? `${hints[name]} By keys: arrows move a cross, Enter sets a point.` : "";
      overlay.draw();
    } }, label));
    byId("tools").append(...buttons, element("button", { type: "button", click: () => overlay.clear() }, "Clear"));
    overlay.makeControls(byId("truth"));
    byId("player").append(play, element("button", { type: "button", "aria-label": "Previous frame", click: () => stepTo(state.frame - 1) }, "◂"),
      element("button", { type: "button", "aria-label": "Next frame", click: () => stepTo(state.frame + 1) }, "▸"), scrubber);
    ecg.addEventListener("click", (event) => stepTo(Math.floor(event.offsetX / ecg.clientWidth * state.frames)));
    for (const scrolled of [ecg, scrubber])  // cine scroll
      scrolled.addEventListener("wheel", (event) => { event.preventDefault(); stepTo(state.frame + (event.deltaY > 0 ? 1 : -1)); }, { passive: false });
  }

  // ---- Settings and saving

  const dials = new LiveDials(data.keys, (name, value) => setKey(name, value));

  function setKey(name, value) {
    state.last_key = name;
    state.keys[name] = value;
    changed();
  }

  // Values, sector and changes of the scene, once changes pause.
  function refreshScene() {
    clearTimeout(state.refresh);
    state.refresh = setTimeout(async () => {
      const version = state.version, response = await ask("/scene", body());
      if (response.status === 410) return;
      if (!response.ok) { refuse(await response.text()); return; }
      const scene = await response.json();
      if (version !== state.version) return;
      showScene(scene);
    }, 120);
  }

  // 5.3864000000000001 -> 5.3864
  const shortNumbers = (text) => text.replace(/-?\d+\.\d{6,}/g, (digits) => String(Number(Number(digits).toFixed(5))));

  function showScene(scene) {
    state.values = scene.values;
    if (JSON.stringify(scene.sector.sector_mm) !== JSON.stringify(state.sector.sector_mm)) {
      heart.setSector(scene.sector);
      heart.setGhost(state.reference);
    }
    Object.assign(state, { sector: scene.sector, loop: scene.loop, frames: scene.loop.frames });
    if (!state.playing) state.frame %= state.frames;
    scrubber.max = state.frames - 1;
    drawEcg();
    dials.show(state.values, state.keys);
    byId("pose-keys").textContent = scene.pose;
    byId("changes").replaceChildren();
    if (scene.changes.length)
      page.table(byId("changes"), { caption: "Changes of the scene file", columns: [{ label: "key" }, { label: "from" }, { label: "to" }],
        rows: scene.changes.map(({ key, from, to }) => [key, shortNumbers(from) || "–", shortNumbers(to) || "–"]) });
    if (byId("effects").open) out.showEffects();
  }

  // Eight sliders over the depth, as scanners have them.
  function makeGain() {
    const box = byId("gain").querySelector("div"), count = 8, gains = new Array(count).fill(0);
    const apply = () => {
      const depth = state.sector.depth_mm, points = gains.map((g, i) => [Number((i / (count - 1) * depth).toFixed(2)), g]);
      state.keys["signal.tgc"] = "table";
      setKey("signal.tgc_table_mm_db", points);
    };
    for (let i = 0; i < count; ++i) {
      const id = `gain-${i}`, bar = element("input", { type: "range", id, min: -20, max: 80, step: 1, value: 0,
        change: () => { gains[i] = Number(bar.value); apply(); } });
      box.append(element("div", { class: "dial" }, element("label", { for: id }, `gain at ${Math.round(100 * i / (count - 1))} % of the depth, dB`), bar));
    }
  }

  // ---- Another heart

  // The probe keeps its place relative to the standard view of the heart.
  function setHeart(wish, { structures, standard, own_standard }) {
    const from = probePose.fromKeys(state.standard ?? own_standard, unit_mm), to = probePose.fromKeys(standard, unit_mm);
    const carried = (pose) => probePose.moved(to, probePose.offsets(pose, from));
    const own = !Object.keys(wish.dials).length && !Object.keys(wish.segments).length, at_start = state.pose === state.start;
    const start = own ? state.own_start : carried(state.start);
    const pose = at_start ? start : carried(state.pose), reference = state.reference === state.start ? start : carried(state.reference);
    Object.assign(state, { wish, standard, start, reference, pose });
    heart.setStructures(structures);
    heart.setGhost(reference);
    setPose(pose);
  }

  byId("title").textContent = data.title;
  byId("subtitle").textContent = `${data.view.structures.length} structures. Drag in the echo or in 3-D, or use the keys.`;
  byId("foot").textContent = `EchoCine ${data.version}. The picture at rest is the one that echocine render writes.`;
  const live = { state, ask, body, setKey, setHeart }, overlay = new LiveOver(live), model = new LiveModel(live), out = new LiveOut(live);
  const heart = new LiveHeart(byId("space"), data.view, {
    start: () => { state.held = true; state.grabbed = state.pose; },
    slide: (x, y) => setPose(probePose.shifted(state.grabbed, { x, y })),
    end: () => { state.held = false; state.changed_ms = performance.now(); } });
  page.parts.space = heart;
  for (const name of LiveDials.kFirst) dials.add(byId("dials"), name);
  const more = byId("all-keys").querySelector("div");
  for (const { key: name } of data.keys) if (!LiveDials.kFirst.includes(name)) dials.add(more, name);
  makePose();
  makeTools();
  makeGain();
  showPlaying();
  listen();
  heart.setPose(state.pose);
  heart.setGhost(state.reference);
  dials.show(state.values, state.keys);
  changed();
  requestAnimationFrame(tick);
})();
