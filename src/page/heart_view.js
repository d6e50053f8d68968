// Meshes and sector in space, with three.js. A HeartView draws what viewJson() (src/view) gives.
// Its axes: x the probe's lateral axis, y against its depth, z its elevation axis, mm: from +z one
// sees the imaging plane as the picture shows it.
"use strict";

// The meshes of one structure: 16-bit steps per phase, and what three.js draws of them.
class HeartSurface {
  constructor(given, colour, phases) {
    Object.assign(this, { given, colour, phases: given.positions ? phases : 0 });
    const indices = HeartView.bytes(given.indices), steps = HeartView.bytes(given.positions);
    const many = given.vertices > 65536;
    this.indices = many ? new Uint32Array(indices.buffer) : new Uint16Array(indices.buffer);
    this.steps = new Uint16Array(steps.buffer);
    this.still = this.steps.length === 3 * given.vertices;
    this.positions = new Float32Array(3 * given.vertices);
    this.phase = -1;
  }

  // Between two phases each vertex goes straight. Whether anything moved.
  place(phase) {
    if (this.phase === phase || (this.still && this.phase >= 0)) return false;
    this.phase = phase;
    const at = this.still ? 0 : (((phase % 1) + 1) % 1) * this.phases;
    const first = Math.floor(at) % Math.max(1, this.phases), share = at - Math.floor(at);
    const second = this.still ? 0 : (first + 1) % this.phases;
    const { from_mm, step_mm } = this.given, { steps, positions } = this;
    const n = positions.length, a = this.still ? 0 : first * n, b = second * n;
    for (let i = 0; i < n; i += 3) {
      const mix = (k) => from_mm[k] + step_mm[k] * (steps[a + i + k] * (1 - share) + steps[b + i + k] * share);
      positions[i] = mix(0);
      positions[i + 1] = -mix(2);
      positions[i + 2] = mix(1);
    }
    return true;
  }

  // Ends of the segments in which the triangles meet the imaging plane; how many numbers.
  cut(out, { normal, constant }) {
    const { indices, positions: p } = this;
    const height = (i) => normal.x * p[i] + normal.y * p[i + 1] + normal.z * p[i + 2] + constant;
    let n = 0;
    for (let t = 0; t < indices.length && n + 6 <= out.length; t += 3) {
      const start = n;
      for (let e = 0; e < 3 && n - start < 6; ++e) {
        const i = 3 * indices[t + e], j = 3 * indices[t + ((e + 1) % 3)], zi = height(i), zj = height(j);
        if (zi < 0 === zj < 0) continue;
        const s = zi / (zi - zj);
        const at = [0, 1, 2].map((k) => p[i + k] + s * (p[j + k] - p[i + k]));
        // Rounding lifts the point off the plane.
        const off = normal.x * at[0] + normal.y * at[1] + normal.z * at[2] + constant;
        out[n] = at[0] - off * normal.x;
        out[n + 1] = at[1] - off * normal.y;
        out[n + 2] = at[2] - off * normal.z;
        n += 3;
      }
      if (n - start !== 6) n = start;
    }
    return n;
  }

  // What is translucent has to be drawn from back to front, so the halves on both sides of the
  // imaging plane, cut by `halves`, are drawn apart, and what lies in the plane between them.
  addTo(scene, halves) {
    const { colour } = this;
    this.geometry = new THREE.BufferGeometry();
    this.geometry.setAttribute("position", new THREE.BufferAttribute(this.positions, 3));
    this.geometry.setIndex(new THREE.BufferAttribute(this.indices, 1));
    this.halves = halves.map((plane) => {
      const mesh = new THREE.Mesh(this.geometry, new THREE.MeshLambertMaterial(
        { color: colour, side: THREE.DoubleSide, clippingPlanes: [plane] }));
      mesh.userData.surface = this;
      return mesh;
    });
    this.contour = new THREE.BufferGeometry();
    this.contour.setAttribute("position", new THREE.BufferAttribute(new Float32Array(2 * this.indices.length), 3));
    this.line = new THREE.LineSegments(this.contour, new THREE.LineBasicMaterial({ color: colour }));
    this.line.renderOrder = 6;
    for (const object of [...this.halves, this.line]) object.frustumCulled = false;
    scene.add(...this.halves, this.line);
  }

  // To where `phase` has it.
  draw(phase, plane) {
    const moved = this.place(phase), { position } = this.geometry.attributes, contour = this.contour.attributes.position;
    if (moved) {
      position.needsUpdate = true;
      this.geometry.computeVertexNormals();
      this.geometry.computeBoundingSphere();  // for picking
    }
    if (!moved && this.cut_at === plane.version) return;
    this.cut_at = plane.version;
    contour.needsUpdate = true;
    this.contour.setDrawRange(0, this.cut(contour.array, plane) / 3);
  }

  // cut: without the half that stands before the plane as the picture looks at it.
  show(on, cut) {
    this.visible = this.line.visible = this.halves[0].visible = on;
    this.halves[1].visible = on && !cut;
  }
}

// new HeartView(root, view): canvas, controls and legend go into root. `below` is room under the
// canvas for a player. What the heart lies in is hidden at first. Without WebGL a line says so, and
// the legend stays.
class HeartView {
  constructor(root, view) {
    const { element } = page;
    this.view = view;
    this.phase = 0;
    this.surfaces = view.structures.map((s, i) => new HeartSurface(s, HeartView.colourOf(i), view.phases));
    this.box = element("div", { class: "space-box" });
    this.words = element("p", { class: "space-words", role: "status" });
    this.words.textContent = "Drag to rotate, wheel or two fingers to zoom, click a mesh for its coordinates.";
    this.below = element("div");
    const left = element("div", {}, this.box, this.words);
    const legend = this.legend();
    root.append(element("div", { class: "space" }, left, legend));
    const shell = (s) => s.role === "surroundings" || s.role === "pericardium";
    const core = this.surfaces.some((s) => !shell(s.given) && s.given.seen === view.sees_any);
    this.surfaces.forEach((s) => { s.tick.checked = !(core && shell(s.given)); });
    this.gl = this.makeRenderer();
    if (this.gl) {
      left.append(this.controls());
      this.makeScene();
      this.listen();
      this.look("aside");
    }
    left.append(this.below);
  }

  static bytes(base64) {
    const binary = atob(base64), bytes = new Uint8Array(binary.length);
    for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
    return bytes;
  }

  // Neighbours in the list lie far apart on the circle of hues (the golden angle).
  static colourOf(i) { return `hsl(${Math.round((8 + 137.508 * i) % 360)}, 58%, 56%)`; }

  static extent(structure) {
    const [lo, hi] = structure.world_box_mm;
    return hi.map((x, i) => page.fixed(x - lo[i], 1)).join(" × ");
  }

  legend() {
    const { element } = page;
    const item = (surface, i) => {
      const s = surface.given;
      const swatch = element("span", { class: "swatch" });
      swatch.style.background = surface.colour;
      surface.tick = element("input", { type: "checkbox", checked: true, id: `structure-${i}`,
        change: () => this.setVisible(i, surface.tick.checked) });
      const what = [s.medium, s.role === "none" ? "no role" : s.role, s.membrane && "membrane", !s.seen && "not in the sector"];
      return element("li", {}, element("label", {}, surface.tick, swatch, element("span", { class: "name" }, s.name),
        element("span", { class: "what" }, what.filter(Boolean).join(" · ")),
        element("span", { class: "what" }, `${HeartView.extent(s)} mm`)));
    };
    const all = (on) => element("button", { type: "button", class: "no-print",
      click: () => this.surfaces.forEach((_, i) => this.setVisible(i, on)) }, on ? "Show all" : "Hide all");
    return element("div", { class: "space-legend" }, element("h2", {}, "Structures: medium, role, extent"),
      element("div", { class: "controls no-print" }, all(true), all(false)),
      element("ul", {}, ...this.surfaces.map(item)));
  }

  makeRenderer() {
    const { element } = page;
    this.canvas = element("canvas", { tabindex: "0", role: "application",
      "aria-label": "Meshes and sector; arrow keys rotate, plus and minus zoom, 0 resets" });
    const context = this.canvas.getContext("webgl2", { alpha: true, antialias: true, preserveDrawingBuffer: true });
    if (!context) {
      this.missing("This browser has no WebGL, so the 3-D view is omitted. The lists have names, positions and extents.");
      return null;
    }
    this.box.append(this.canvas);
    const renderer = new THREE.WebGLRenderer({ canvas: this.canvas, context });
    renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
    renderer.localClippingEnabled = true;
    this.canvas.addEventListener("webglcontextlost", () =>
      this.missing("The browser has lost WebGL: reload the page for the 3-D view."));
    return renderer;
  }

  missing(words) {
    this.words.textContent = "";
    this.box.style.height = "auto";
    this.box.replaceChildren(page.element("p", { class: "missing" }, words));
  }

  controls() {
    const { element } = page;
    const button = (text, name) => element("button", { type: "button", click: () => this.look(name) }, text);
    const tick = (id, text, on, change) => {
      const box = element("input", { type: "checkbox", id, checked: on, change: () => { change(box.checked); this.render(); } });
      return element("label", {}, box, ` ${text}`);
    };
    const opacity = element("input", { type: "range", min: 0.1, max: 1, step: 0.05, value: 0.3, id: "opacity",
      input: () => { this.setOpacity(Number(opacity.value)); this.render(); } });
    this.opacity_input = opacity;
    return element("div", { class: "controls no-print" }, button("Aside", "aside"), button("As the picture", "picture"),
      button("From the probe", "probe"), tick("cut", "cut at the plane", false, (on) => this.setCut(on)),
      tick("on-plane", "picture on the plane", true, (on) => { this.picture_wanted = on; this.showPicture(); }),
      element("label", { for: "opacity" }, "opacity"), opacity);
  }

  makeScene() {
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(32, 1, 1, 5000);
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x8899aa, 2.2));
    this.lamp = new THREE.DirectionalLight(0xffffff, 1.6);
    this.camera.add(this.lamp);
    this.scene.add(this.camera);
    this.rig = new THREE.Scene();  // a group: sector, probe and picture
    this.scene.add(this.rig);
    const halves = this.halves = [-1, 1].map((side) => new THREE.Plane(new THREE.Vector3(0, 0, side), 0));
    this.surfaces.forEach((s) => { s.addTo(this.scene, halves); s.show(s.tick.checked, false); });
    this.addSector();
    this.addProbe();
    this.addAxes();
    this.setOpacity(0.3);
    this.picture_wanted = true;
    this.orbit = new THREE.OrbitControls(this.camera, this.canvas);
    this.orbit.addEventListener("change", () => this.render());
    this.tint();
  }

  // A line along points [x, depth] of the imaging plane.
  planeLine(points, material, pairs = false) {
    const geometry = new THREE.BufferGeometry().setFromPoints(points.map(([x, z]) => new THREE.Vector3(x, -z, 0)));
    const line = pairs ? new THREE.LineSegments(geometry, material) : new THREE.Line(geometry, material);
    line.renderOrder = 4;
    this.rig.add(line);
    return line;
  }

  // Outline, a veil over it, and ticks down the middle line, every 10 mm, longer every 50.
  addSector() {
    const { sector_mm } = this.view, near = sector_mm.slice(0, (sector_mm.length - 1) / 2);
    this.outline = new THREE.LineBasicMaterial();
    this.planeLine(sector_mm, this.outline);
    const count = near.length, flat = new Float32Array(6 * count), faces = [];
    for (let i = 0; i < count; ++i) {
      const far = sector_mm[2 * count - 1 - i];
      flat.set([near[i][0], -near[i][1], 0, far[0], -far[1], 0], 6 * i);
      if (i) faces.push(2 * i - 2, 2 * i - 1, 2 * i, 2 * i, 2 * i - 1, 2 * i + 1);
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(flat, 3));
    geometry.setIndex(faces);
    this.veil = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({ transparent: true, opacity: 0.14, depthWrite: false, side: THREE.DoubleSide }));
    this.veil.renderOrder = 1;
    this.rig.add(this.veil);
    const ticks = [], top = Math.min(...near.map((p) => p[1])), deepest = Math.max(...sector_mm.map((p) => p[1]));
    for (let z = 10 * Math.ceil(top / 10); z <= deepest; z += 10) {
      const half = z % 50 ? 1 : 3;
      ticks.push([-half, z], [half, z]);
    }
    this.planeLine(ticks, this.outline, true);
    this.face_mm = top;
  }

  // A housing as wide as the aperture or the face, and a dot on the side that is right in the picture.
  addProbe() {
    const { view } = this, near = view.sector_mm.slice(0, (view.sector_mm.length - 1) / 2).map((p) => p[0]);
    const width = Math.max(view.aperture_mm, Math.max(...near) - Math.min(...near)), lens = view.lens_mm, high = 24;
    this.housing = new THREE.MeshLambertMaterial();
    const body = new THREE.Mesh(new THREE.BoxGeometry(width, high, lens), this.housing);
    body.position.set(0, high / 2 - this.face_mm, 0);
    this.mark = new THREE.MeshLambertMaterial();
    const dot = new THREE.Mesh(new THREE.SphereGeometry(2.5, 16, 12), this.mark);
    dot.position.set(width / 2, high / 2 - this.face_mm, 0);
    this.probe = [body, dot];
    this.rig.add(body, dot);
  }

  // Of the scene file's coordinates, at the corner of all meshes.
  addAxes() {
    const { pose } = this.view, boxes = this.surfaces.filter((s) => s.tick.checked).map((s) => s.given.world_box_mm);
    if (!boxes.length) boxes.push([pose.origin_mm, pose.origin_mm.map((x) => x + 50)]);
    const corner = [0, 1, 2].map((i) => Math.min(...boxes.map((b) => b[0][i])));
    const longest = Math.max(...[0, 1, 2].map((i) => Math.max(...boxes.map((b) => b[1][i])) - corner[i]));
    const end = (i, length) => this.fromScene(corner.map((x, k) => x + (k === i ? length : 0)));
    this.axes = new THREE.LineBasicMaterial();
    const points = [0, 1, 2].flatMap((i) => [end(-1, 0), end(i, 0.25 * longest)]);
    const lines = new THREE.LineSegments(new THREE.BufferGeometry().setFromPoints(points), this.axes);
    this.scene.add(lines);
    this.labels = ["x", "y", "z"].map((name, i) => ({ at: end(i, 0.28 * longest), span: page.element("span", { class: "mark", "aria-hidden": "true" }, name) }));
    this.box.append(...this.labels.map((l) => l.span));
    this.origin_mm = pose.origin_mm;
  }

  // From scene coordinates (mm) to those of the drawing, and back.
  fromScene(p) {
    const { pose } = this.view, d = p.map((x, i) => x - pose.origin_mm[i]);
    const along = (axis) => d[0] * axis[0] + d[1] * axis[1] + d[2] * axis[2];
    return new THREE.Vector3(along(pose.lateral), -along(pose.depth), along(pose.elevation));
  }

  toScene(v) {
    const { pose } = this.view;
    return [0, 1, 2].map((i) => pose.origin_mm[i] + v.x * pose.lateral[i] - v.y * pose.depth[i] + v.z * pose.elevation[i]);
  }

  // The ball around all that is shown.
  measure() {
    const box = { lo: [Infinity, Infinity, Infinity], hi: [-Infinity, -Infinity, -Infinity] };
    const add = (p) => p.forEach((x, i) => { box.lo[i] = Math.min(box.lo[i], x); box.hi[i] = Math.max(box.hi[i], x); });
    for (const { given, tick } of this.surfaces)
      if (tick.checked) for (const [x, y, z] of given.probe_box_mm) add([x, -z, y]);
    for (const [x, z] of this.view.sector_mm) add([x, -z, 0]);
    add([0, 24 - this.face_mm, 0]);
    this.middle = new THREE.Vector3(...box.lo.map((x, i) => (x + box.hi[i]) / 2));
    this.radius = 0.5 * Math.hypot(...box.hi.map((x, i) => x - box.lo[i]));
  }

  // "aside", "picture": as the picture shows it, "probe": from where the probe is.
  look(name) {
    this.measure();
    const { camera, orbit } = this;
    const from = { aside: [0.75, 0.35, 1], picture: [0, 0, 1], probe: [0, 1, 1e-3] }[name];
    const half = 0.5 * camera.fov * Math.PI / 180;
    const fit = Math.min(half, Math.atan(Math.tan(half) * Math.max(0.2, camera.aspect)));
    const distance = 0.85 * this.radius / Math.sin(fit);
    camera.position.copy(this.middle).addScaledVector(new THREE.Vector3(...from).normalize(), distance);
    camera.near = distance / 100;
    camera.far = distance + 20 * this.radius;
    camera.updateProjectionMatrix();
    orbit.minDistance = 0.05 * this.radius;
    orbit.maxDistance = 12 * this.radius;
    orbit.target.copy(this.middle);
    orbit.update();
    this.looked = name;
    this.render();
  }

  listen() {
    new ResizeObserver(() => this.resize()).observe(this.box);
    this.resize();
    this.canvas.addEventListener("keydown", (event) => this.key(event));
    let down = null;
    this.canvas.addEventListener("pointerdown", (event) => { down = event; });
    this.canvas.addEventListener("pointerup", (event) => {
      if (down && Math.hypot(event.clientX - down.clientX, event.clientY - down.clientY) < 4) this.pick(event);
      down = null;
    });
    for (const media of ["print", "(prefers-color-scheme: light)"])
      window.matchMedia(media).addEventListener("change", () => { this.tint(); this.renderNow(); });
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.box;
    if (!width || !height) return;
    this.gl.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (this.looked) this.look(this.looked);
    this.renderNow();
  }

  // Turns by hand, as long as the canvas has the keys.
  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const step = Math.PI / 24;
    const action = { ArrowLeft: () => this.turn(step, 0), ArrowRight: () => this.turn(-step, 0), ArrowUp: () => this.turn(0, step),
      ArrowDown: () => this.turn(0, -step), "+": () => this.zoom(1 / 1.15), "=": () => this.zoom(1 / 1.15), "-": () => this.zoom(1.15),
      0: () => this.look("aside") }[event.key];
    if (!action) return;
    event.preventDefault();
    event.stopPropagation();  // the player takes arrows too
    action();
  }

  turn(around, up) {
    const { camera, orbit } = this, d = camera.position.clone().sub(orbit.target), r = d.length();
    const azimuth = Math.atan2(d.x, d.z) - around, polar = Math.min(Math.PI - 0.01, Math.max(0.01, Math.acos(d.y / r) - up));
    camera.position.set(r * Math.sin(polar) * Math.sin(azimuth), r * Math.cos(polar), r * Math.sin(polar) * Math.cos(azimuth)).add(orbit.target);
    this.looked = "";
    orbit.update();
    this.render();
  }

  zoom(factor) {
    const { camera, orbit } = this;
    camera.position.sub(orbit.target).multiplyScalar(factor).add(orbit.target);
    this.looked = "";
    orbit.update();
    this.render();
  }

  // The point of a mesh under the pointer, in the scene's and in the probe's coordinates.
  pick(event) {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const ray = new THREE.Raycaster();
    ray.setFromCamera(new THREE.Vector2(2 * (event.clientX - left) / width - 1, 1 - 2 * (event.clientY - top) / height), this.camera);
    const hits = ray.intersectObjects(this.surfaces.filter((s) => s.visible).map((s) => s.halves[0]));
    const hit = hits.find((h) => !this.cut_open || this.halves[1].distanceToPoint(h.point) <= 0);
    if (!hit) return;
    const at = this.toScene(hit.point).map((x) => Number((x / this.view.unit_mm).toPrecision(4))), p = hit.point;
    this.words.textContent = `${hit.object.userData.surface.given.name} at [${at.join(", ")}] in the units of probe.apex; from the probe `
      + `x ${page.fixed(p.x, 1)}, y ${page.fixed(p.z, 1)}, z ${page.fixed(-p.y, 1)} mm`;
  }

  setVisible(i, on) {
    const surface = this.surfaces[i];
    surface.tick.checked = on;
    if (!this.gl) return;
    surface.show(on, this.cut_open);
    this.render();
  }

  setOpacity(opacity) {
    for (const { material } of this.surfaces.flatMap((s) => s.halves)) {
      const clear = opacity < 1;
      if (material.transparent !== clear) material.needsUpdate = true;
      Object.assign(material, { opacity, transparent: clear, depthWrite: !clear });
    }
  }

  setCut(on) {
    this.cut_open = on;
    for (const surface of this.surfaces) surface.show(surface.tick.checked, on);
  }

  // Of an image or canvas, the scan area as a picture on the plane; called again, what it shows now.
  setPicture(source) {
    if (!this.gl) return;
    const { width, height, origin_px: [ox, oy], mm_per_px } = this.view.picture;
    if (!this.plane) {
      this.paper = page.element("canvas", { width, height });
      this.texture = new THREE.CanvasTexture(this.paper);
      this.texture.colorSpace = THREE.SRGBColorSpace;
      const geometry = new THREE.BufferGeometry(), at = (px, py) => [(px - ox) * mm_per_px, -(py - oy) * mm_per_px, 0];
      geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(
        [at(0, 0), at(0, height), at(width, height), at(width, 0)].flat()), 3));
      geometry.setAttribute("uv", new THREE.BufferAttribute(new Float32Array([0, 1, 0, 0, 1, 0, 1, 1]), 2));
      geometry.setIndex([0, 1, 2, 0, 2, 3]);
      this.plane = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({ map: this.texture, transparent: true, opacity: 0.92,
        side: THREE.DoubleSide, depthWrite: false }));
      this.plane.renderOrder = 2;
      this.rig.add(this.plane);
    }
    const context = this.paper.getContext("2d");
    context.clearRect(0, 0, width, height);
    context.save();
    context.beginPath();
    for (const [x, z] of this.view.sector_mm) context.lineTo(ox + x / mm_per_px, oy + z / mm_per_px);
    context.clip();
    context.drawImage(source, 0, 0, width, height);
    context.restore();
    this.texture.needsUpdate = true;
    this.showPicture();
    this.render();
  }

  // Where the picture is not of the instant that is shown.
  dimPicture(off) {
    this.picture_off = off;
    this.showPicture();
  }

  showPicture() {
    if (this.plane) this.plane.visible = this.picture_wanted && !this.picture_off;
    this.render();
  }

  tint() {
    this.outline.color.set(page.colour("accent"));
    this.veil.material.color.set(page.colour("accent"));
    this.housing.color.set(page.colour("muted"));
    this.mark.color.set(page.colour("warn"));
    this.axes.color.set(page.colour("muted"));
  }

  showPhase(phase) {
    this.phase = phase;
    this.render();
  }

  // At the next frame of the screen, however often it is asked for.
  render() {
    if (!this.gl || this.due) return;
    this.due = requestAnimationFrame(() => this.renderNow());
  }

  renderNow() {
    cancelAnimationFrame(this.due);
    this.due = 0;
    const before = this.halves[1].distanceToPoint(this.camera.position) >= 0;  // of the two halves, which is farther away
    for (const surface of this.surfaces) {
      if (surface.visible) surface.draw(this.phase, this.halves[1]);
      surface.halves[0].renderOrder = before ? 0 : 5;
      surface.halves[1].renderOrder = before ? 5 : 0;
    }
    this.gl.render(this.scene, this.camera);
    const { clientWidth: width, clientHeight: height } = this.box;
    for (const { at, span } of this.labels) {
      const p = at.clone().project(this.camera);
      span.style.transform = `translate(${(p.x + 1) / 2 * width}px, ${(1 - p.y) / 2 * height}px) translate(-50%, -50%)`;
      span.hidden = p.z > 1;
    }
  }
}
