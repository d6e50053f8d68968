// The 3-D drawing that HeartView fills: canvas, camera, keys and pointer. Axes: x the probe's lateral
// axis, y against its depth, z its elevation axis, mm.
"use strict";

// A derived class has measure(), which sets middle and radius of what is shown, renderNow(), tint()
// and pick(event).
class HeartSpace {
  constructor(label) {
    const { element } = page;
    this.box = element("div", { class: "space-box" });
    this.words = element("p", { class: "space-words", role: "status" });
    this.canvas = element("canvas", { tabindex: "0", role: "application", "aria-label": label });
  }

  // Null, with a line in place of the drawing, without WebGL.
  makeRenderer() {
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

  makeCamera() {
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(32, 1, 1, 5000);
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x8899aa, 2.2));
    this.lamp = new THREE.DirectionalLight(0xffffff, 1.6);
    this.camera.add(this.lamp);
    this.scene.add(this.camera);
    this.makeOrbit();
  }

  // Controls keep the upward direction that the camera has at this instant.
  makeOrbit() {
    this.orbit?.dispose();
    this.orbit = new THREE.OrbitControls(this.camera, this.canvas);
    this.orbit.addEventListener("change", () => this.render());
  }

  // "aside", "picture": as the picture shows it, "probe": from where the probe is. By the axes of the
  // rig, which holds the probe.
  look(name) {
    this.measure();
    const { camera, rig } = this, up = new THREE.Vector3(0, 1, 0).transformDirection(rig.matrix);
    if (camera.up.distanceTo(up) > 1e-6) {
      camera.up.copy(up);
      this.makeOrbit();
    }
    const { orbit } = this;
    const from = { aside: [0.75, 0.35, 1], picture: [0, 0, 1], probe: [0, 1, 1e-3] }[name];
    const half = 0.5 * camera.fov * Math.PI / 180;
    const fit = Math.min(half, Math.atan(Math.tan(half) * Math.max(0.2, camera.aspect)));
    const distance = 0.95 * this.radius / Math.sin(fit);
    camera.position.copy(this.middle).addScaledVector(new THREE.Vector3(...from).transformDirection(rig.matrix), distance);
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
    const { camera, orbit } = this, d = camera.position.clone().sub(orbit.target).applyAxisAngle(camera.up, -around);
    const polar = d.angleTo(camera.up), wanted = Math.min(Math.PI - 0.01, Math.max(0.01, polar - up));
    d.applyAxisAngle(camera.up.clone().cross(d).normalize(), wanted - polar);
    camera.position.copy(orbit.target).add(d);
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

  // At the next frame of the screen, however often it is asked for.
  render() {
    if (!this.gl || this.due) return;
    this.due = requestAnimationFrame(() => this.renderNow());
  }
}
