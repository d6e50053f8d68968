// The page of `echocine live`: a probe in the hand, its echo, and the settings. Here is the state that
// all parts share, and what a change does.
"use strict";

(() => {
  const { data, byId } = page;
  const start = probePose.squared(data.sector.pose);
  const state = {
    own_start: start, start, pose: start, reference: start, reference_name: "the start",  // own_start: of the file's heart
    keys: {}, values: data.values, last_key: "", wish: { dials: {}, segments: {} }, standard: null, sector: data.sector,
    version: 0, changed_ms: -1e9, held: false,  // of the scene; held: the pointer is down
    loop: data.loop, frames: data.loop.frames, frame: 0, playing: true,
    shown: null, kept: new Map(),  // pictures: the last one, and those at rest by their frame
    tool: "tilt", mm: [], trace: [], m_line: null, cursor: null,
  };
  page.parts.live = state;
  const server = new LiveServer(() => live.model.again());
  // At the start the pose is that of the file, to the last digit.
  const keys = () => ({ ...state.keys, ...(state.pose === state.own_start ? {} : probePose.keys(state.pose, data.view.unit_mm)) });
  const live = {
    state,
    ask: (path, body) => server.ask(path, body),
    body: (more = {}) => ({ keys: keys(), ...state.wish, ...more }),
    refuse: (line) => {
      byId("refusal").textContent = line.trim();
      live.settings.dials.refuse(state.last_key, line.trim());
    },
    changed: () => {
      ++state.version;
      state.changed_ms = performance.now();
      state.kept.clear();
      live.overlay.forget();
      live.pose.show();
      live.settings.refresh();
      live.picture.tick(performance.now());  // at once, not with the screen's next frame
    },
    setKey: (name, value) => live.settings.set(name, value),
    setHeart: (wish, answer) => live.pose.setHeart(wish, answer),
  };

  byId("title").textContent = data.title;
  byId("subtitle").textContent = `${data.view.structures.length} structures. Drag in the echo or in 3-D, or use the keys.`;
  byId("foot").textContent = `EchoCine ${data.version}. The picture at rest is the one that echocine render writes.`;
  live.player = new LivePlayer(state);
  live.picture = new LivePicture(live);
  live.overlay = new LiveOver(live);
  live.model = new LiveModel(live);
  live.out = new LiveOut(live);
  live.settings = new LiveSettings(live);
  live.pose = new LivePose(live);
  live.hand = new LiveHand(live);
  live.heart = page.parts.space = new LiveHeart(byId("space"), data.view, {
    start: () => { state.held = true; state.grabbed = state.pose; },
    slide: (x, y) => live.pose.set(probePose.shifted(state.grabbed, { x, y })),
    end: () => live.hand.hold(false) });
  live.heart.setPose(state.pose);
  live.heart.setGhost(state.reference);
  live.changed();
  const tick = (now) => { live.picture.tick(now); requestAnimationFrame(tick); };
  requestAnimationFrame(tick);
})();
