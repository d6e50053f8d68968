// Poses of the probe: axes in the world, its motions in its own frame, and angles from another pose.
"use strict";

const probePose = {
  copy: ({ origin_mm, lateral, elevation, depth }) => ({ origin_mm: [...origin_mm], lateral: [...lateral], elevation: [...elevation], depth: [...depth] }),

  dot: (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2],

  mix: (a, x, b, y) => a.map((v, i) => x * v + y * b[i]),

  cross: (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]],

  // Rounding does not add up: lateral is made perpendicular to depth, and all have unit length.
  squared(pose) {
    const unit = (v) => v.map((x) => x / Math.hypot(...v));
    const depth = unit(pose.depth), off = probePose.dot(pose.lateral, depth);
    const lateral = unit(probePose.mix(pose.lateral, 1, depth, -off));
    return { origin_mm: pose.origin_mm, lateral, elevation: probePose.cross(depth, lateral), depth };
  },

  // by: { x, y, z } in mm along lateral, elevation and depth.
  shifted(pose, { x = 0, y = 0, z = 0 }) {
    const moved = probePose.copy(pose);
    moved.origin_mm = pose.origin_mm.map((v, i) => v + x * pose.lateral[i] + y * pose.elevation[i] + z * pose.depth[i]);
    return moved;
  },

  // One of the axes towards another one, by degrees; the third is the axis of the turn.
  turned(pose, from, to, degrees) {
    const angle = degrees * Math.PI / 180, made = probePose.copy(pose);
    made[from] = probePose.mix(pose[from], Math.cos(angle), pose[to], Math.sin(angle));
    made[to] = probePose.mix(pose[to], Math.cos(angle), pose[from], -Math.sin(angle));
    return probePose.squared(made);
  },

  // As in scene files: rotate moves lateral towards elevation, tilt depth towards elevation; rock
  // moves depth towards lateral.
  rotated: (pose, degrees) => probePose.turned(pose, "lateral", "elevation", degrees),
  tilted: (pose, degrees) => probePose.turned(pose, "depth", "elevation", degrees),
  rocked: (pose, degrees) => probePose.turned(pose, "depth", "lateral", degrees),

  // From the numbers that offsets() gives: shift along the axes of `from`, then rotate, tilt, rock.
  moved(from, { x, y, z, rotate, tilt, rock }) {
    return probePose.rocked(probePose.tilted(probePose.rotated(probePose.shifted(from, { x, y, z }), rotate), tilt), rock);
  },

  // Shift (mm) and angles (degrees) of a pose from another one.
  offsets(pose, from) {
    const axes = ["lateral", "elevation", "depth"], degrees = 180 / Math.PI;
    const r = axes.map((i) => axes.map((j) => probePose.dot(from[i], pose[j])));
    const d = pose.origin_mm.map((v, i) => v - from.origin_mm[i]);
    return {
      x: probePose.dot(d, from.lateral), y: probePose.dot(d, from.elevation), z: probePose.dot(d, from.depth),
      rotate: degrees * Math.atan2(-r[0][1], r[1][1]),
      tilt: -degrees * Math.asin(Math.min(1, Math.max(-1, r[2][1]))),
      rock: degrees * Math.atan2(-r[2][0], r[2][2]),
    };
  },

  keys(pose, unit_mm) {
    return { "probe.apex": pose.origin_mm.map((v) => v / unit_mm), "probe.axis": pose.depth, "probe.lateral": pose.lateral };
  },

  fromKeys(keys, unit_mm) {
    return probePose.squared({ origin_mm: keys["probe.apex"].map((v) => v * unit_mm), depth: keys["probe.axis"], lateral: keys["probe.lateral"], elevation: [] });
  },
};
