// The heart with a probe that moves, on top of HeartView. Its axes stay those of the first pose.
"use strict";

class LiveHeart extends HeartView {
  // grab: { start(), slide(x_mm, y_mm), end() } for a probe pulled by the pointer.
  constructor(root, view, grab) {
    // The probe moves, so every structure may come into the picture.
    super(root, { ...view, sees_any: true, structures: view.structures.map((s) => ({ ...s, seen: true })) });
    this.grab = grab;
    this.halves?.forEach((half) => { half.version = 0; });
    if (!this.gl) return;
    this.words.textContent = "Drag to rotate, wheel to zoom; drag the grey probe to slide it over the skin.";
    this.canvas.addEventListener("pointerdown", (event) => this.take(event), true);
    this.canvas.addEventListener("pointermove", (event) => this.pull(event), true);
    for (const end of ["pointerup", "pointercancel"]) this.canvas.addEventListener(end, () => this.letGo(), true);
  }

  // A direction of the world in the axes of the drawing.
  direction(d) {
    const { pose } = this.view, along = (axis) => d[0] * axis[0] + d[1] * axis[1] + d[2] * axis[2];
    return new THREE.Vector3(along(pose.lateral), -along(pose.depth), along(pose.elevation));
  }

  matrixOf(pose) {
    const depth = this.direction(pose.depth).negate();
    return this.rig.matrix.clone().makeBasis(this.direction(pose.lateral), depth, this.direction(pose.elevation))
      .setPosition(this.fromScene(pose.origin_mm));
  }

  place(group, pose) {
    group.matrixAutoUpdate = false;
    group.matrix.copy(this.matrixOf(pose));
    group.matrixWorldNeedsUpdate = true;
  }

  setPose(pose) {
    this.pose = pose;
    if (!this.gl) return;
    this.place(this.rig, pose);
    const normal = this.direction(pose.elevation), at = this.fromScene(pose.origin_mm);
    this.halves[1].setFromNormalAndCoplanarPoint(normal, at);
    this.halves[0].copy(this.halves[1]).negate();
    ++this.halves[1].version;
    this.render();
  }

  // Probe and heart in the middle, after the probe has moved far.
  refit() { if (this.gl) this.look(this.looked || "aside"); }

  // Another sector: drawn anew, at the same pose.
  setSector(sector) {
    Object.assign(this.view, { sector_mm: sector.sector_mm, aperture_mm: sector.aperture_mm, lens_mm: sector.lens_mm, picture: sector.picture });
    if (!this.gl) return;
    for (const child of [...this.rig.children]) {
      child.geometry.dispose();
      this.rig.remove(child);
    }
    this.plane = null;
    this.addSector();
    this.addProbe();
    this.tint();
    this.render();
  }

  setOpacity(opacity) {
    this.opacity = opacity;
    super.setOpacity(opacity);
  }

  // Other meshes of the same structures.
  setStructures(structures) {
    this.view.structures = structures;
    this.surfaces = this.surfaces.map((old, i) => {
      const surface = new HeartSurface(structures[i], old.colour, this.view.phases);
      surface.tick = old.tick;
      surface.tick.closest("li").querySelectorAll(".what")[1].textContent = `${HeartView.extent(structures[i])} mm`;
      if (!this.gl) return surface;
      for (const object of [...old.halves, old.line]) {
        this.scene.remove(object);
        object.material.dispose();
      }
      old.geometry.dispose();
      old.contour.dispose();
      surface.addTo(this.scene, this.halves);
      surface.show(surface.tick.checked, this.cut_open);
      return surface;
    });
    if (!this.gl) return;
    this.setOpacity(this.opacity);
    this.render();
  }

  // The outline of a standard view, dashed by its faintness alone; null: none.
  setGhost(pose) {
    if (!this.gl) return;
    if (this.ghost) this.scene.remove(this.ghost);
    this.ghost = null;
    if (pose) {
      const points = this.view.sector_mm.map(([x, z]) => new THREE.Vector3(x, -z, 0));
      this.ghost_look = new THREE.LineBasicMaterial({ color: page.colour("warn"), transparent: true, opacity: 0.7 });
      this.ghost = new THREE.Line(new THREE.BufferGeometry().setFromPoints(points), this.ghost_look);
      this.ghost.renderOrder = 4;
      this.place(this.ghost, pose);
      this.scene.add(this.ghost);
    }
    this.render();
  }

  // The picture on the plane, taken when the drawing is made. moves: the hand moves the probe.
  follow(source, moves) {
    this.source = source;
    this.moves = moves;
    this.render();
  }

  // A machine without a graphics card draws slowly: at most a quarter of the time goes into drawings,
  // and a twentieth while a hand in the echo waits for its picture.
  render() {
    const factor = this.moves && !this.held && this.cost_ms > 25 ? 20 : 3;
    const wait_ms = (this.drawn_ms ?? 0) + factor * (this.cost_ms ?? 0) - performance.now();
    if (this.drawing) return;
    clearTimeout(this.later);
    if (wait_ms <= 0) super.render();
    else this.later = setTimeout(() => super.render(), wait_ms);
  }

  renderNow() {
    const begun_ms = performance.now();
    this.drawing = true;
    if (this.source && this.picture_wanted) this.setPicture(this.source);
    this.source = null;
    super.renderNow();
    this.drawing = false;
    requestAnimationFrame(() => {
      this.drawn_ms = performance.now();
      this.cost_ms = Math.min(500, this.drawn_ms - begun_ms);
    });
  }

  rayOf(event) {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const ray = new THREE.Raycaster();
    ray.setFromCamera(new THREE.Vector2(2 * (event.clientX - left) / width - 1, 1 - 2 * (event.clientY - top) / height), this.camera);
    return ray;
  }

  // Where the pointer is on the plane through the probe's origin across its depth, in mm of its axes.
  onSkin(event) {
    const inverse = this.held.clone().invert(), ray = this.rayOf(event).ray.clone().applyMatrix4(inverse);
    const plane = new THREE.Plane(new THREE.Vector3(0, 1, 0), 0);
    // Seen from the side the plane is a line: then the plane that faces the viewer.
    if (Math.abs(ray.direction.y) < 0.2) plane.normal.copy(ray.direction).negate();
    return ray.intersectPlane(plane, new THREE.Vector3());
  }

  take(event) {
    if (event.button || !this.rayOf(event).intersectObjects(this.probe).length) return;
    this.held = this.rig.matrix.clone();
    this.from = this.onSkin(event);
    if (!this.from) { this.held = null; return; }
    this.orbit.enabled = false;
    this.canvas.setPointerCapture(event.pointerId);
    this.grab.start();
  }

  pull(event) {
    if (!this.held) return;
    const to = this.onSkin(event);
    if (to) this.grab.slide(to.x - this.from.x, to.z - this.from.z);
  }

  letGo() {
    if (!this.held) return;
    this.held = null;
    this.orbit.enabled = true;
    this.grab.end();
  }
}
