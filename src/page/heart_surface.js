// Meshes of one structure over the beat, and their contour in the imaging plane, for HeartView.
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
