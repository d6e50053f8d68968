// Meshes and sector in space, with three.js. A HeartView draws what viewJson() (src/view) gives: from
// +z one sees the imaging plane as the picture shows it.
"use strict";

// new HeartView(root, view): canvas, controls and legend go into root. `below` is room under the
// canvas for a player. What the heart lies in is hidden at first. Without WebGL a line says so, and
// the legend stays.
class HeartView extends HeartSpace {
  constructor(root, view) {
    super("Meshes and sector; arrow keys rotate, plus and minus zoom, 0 resets");
    const { element } = page;
    this.view = view;
    this.phase = 0;
    this.surfaces = view.structures.map((s, i) => new HeartSurface(s, HeartView.colourOf(i), view.phases));
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
    this.makeCamera();
    this.rig = new THREE.Scene();  // a group: sector, probe and picture
    this.scene.add(this.rig);
    const halves = this.halves = [-1, 1].map((side) => new THREE.Plane(new THREE.Vector3(0, 0, side), 0));
    this.surfaces.forEach((s) => { s.addTo(this.scene, halves); s.show(s.tick.checked, false); });
    this.addSector();
    this.addProbe();
    this.addAxes();
    this.setOpacity(0.3);
    this.picture_wanted = true;
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
    const ofProbe = (x, y) => { const p = new THREE.Vector3(x, y, 0).applyMatrix4(this.rig.matrix); add([p.x, p.y, p.z]); };
    for (const [x, z] of this.view.sector_mm) ofProbe(x, -z);
    ofProbe(0, 24 - this.face_mm);
    this.middle = new THREE.Vector3(...box.lo.map((x, i) => (x + box.hi[i]) / 2));
    this.radius = 0.5 * Math.hypot(...box.hi.map((x, i) => x - box.lo[i]));
  }

  // The point of a mesh under the pointer, in the scene's and in the probe's coordinates.
  pick(event) {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const ray = new THREE.Raycaster();
    ray.setFromCamera(new THREE.Vector2(2 * (event.clientX - left) / width - 1, 1 - 2 * (event.clientY - top) / height), this.camera);
    const hits = ray.intersectObjects(this.surfaces.filter((s) => s.visible).map((s) => s.halves[0]));
    const hit = hits.find((h) => !this.cut_open || this.halves[1].distanceToPoint(h.point) <= 0);
    if (!hit) return;
    const at = this.toScene(hit.point).map((x) => Number((x / this.view.unit_mm).toPrecision(4))), p = this.rig.worldToLocal(hit.point.clone());
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
