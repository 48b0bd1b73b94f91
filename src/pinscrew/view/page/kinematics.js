// The product of exponentials, from the spatial screws of the document: displacements down the tree, with mimic
// joints folded in, poses, and the three Jacobians. Twists are (v, w).
"use strict";
(function (ps) {
  const L = ps.linear;

  // Rotation by an angle about a unit vector: Rodrigues' formula, with 1 - cos as 2 sin^2 of the half.
  function rotation(w, angle) {
    const s = Math.sin(angle), h = Math.sin(0.5 * angle), C = 2 * h * h;
    const [x, y, z] = w;
    return [
      1 - C * (y * y + z * z), x * y * C - z * s, x * z * C + y * s,
      x * y * C + z * s, 1 - C * (x * x + z * z), y * z * C - x * s,
      x * z * C - y * s, y * z * C + x * s, 1 - C * (x * x + y * y),
    ];
  }

  function rotationOfQuaternion(quaternion) {
    const length = Math.hypot(...quaternion) || 1;
    const [x, y, z, w] = quaternion.map((c) => c / length);
    return [
      1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w),
      2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
      2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y),
    ];
  }

  const SINGULAR = 1e-6; // a singular value below this part of the greatest counts as zero

  const counted = (values) => values.filter((value) => value > SINGULAR * Math.max(values[0], 1e-12)).length;

  class Robot {
    constructor(document) {
      this.nq = document.coordinates.length;
      this.nv = document.velocities.length;
      this.size = document.size;
      this.motions = document.motions;
      this.frames = new Map(document.frames.map((frame) => [frame.name, frame]));
      this.coordinates = document.coordinates;
    }

    // Indices of the motions that move a frame, from the base outwards.
    above(frame) {
      const found = [];
      for (let i = this.frames.get(frame).motion; i >= 0; i = this.motions[i].parent) found.push(i);
      return found.reverse();
    }

    // Which velocities move a frame, in the robot's order.
    moving(frame) {
      const found = new Set();
      for (const i of this.above(frame)) this.motions[i].twists.forEach((_, k) => found.add(this.motions[i].v + k));
      return [...found].sort((a, b) => a - b);
    }

    // The displacement of each motion's child from its place at zero.
    displacements(q) {
      const found = [];
      for (const motion of this.motions) {
        const before = motion.parent < 0 ? L.identity() : found[motion.parent];
        found.push(L.multiply(before, this._factor(motion, q)));
      }
      return found;
    }

    _factor(motion, q) {
      if (motion.type === "planar" || motion.type === "floating") {
        const c = q.slice(motion.q, motion.q + 7);
        const X = motion.type === "planar"
          ? L.pose(rotation([0, 0, 1], c[2]), [c[0], c[1], 0])
          : L.pose(rotationOfQuaternion(c.slice(3)), c.slice(0, 3));
        return L.multiply(L.multiply(motion.home, X), L.inverse(motion.home));
      }
      const theta = motion.multiplier * q[motion.q], twist = motion.twists[0];
      const v = twist.slice(0, 3), w = twist.slice(3);
      if (motion.type === "prismatic") return L.pose([1, 0, 0, 0, 1, 0, 0, 0, 1], L.times(theta, v));
      // The exponential turns about the axis through c = w x v: its position is c - R c.
      const T = L.pose(rotation(w, theta), [0, 0, 0]), c = L.cross(w, v);
      const p = L.sub(c, L.turn(T, c));
      T[3] = p[0]; T[7] = p[1]; T[11] = p[2];
      return T;
    }

    pose(frame, moved) {
      const { motion, home } = this.frames.get(frame);
      return motion < 0 ? home.slice() : L.multiply(moved[motion], home);
    }

    // The Jacobian of a frame as nv columns of 6.
    jacobian(frame, kind, moved) {
      const J = Array.from({ length: this.nv }, () => [0, 0, 0, 0, 0, 0]);
      for (const i of this.above(frame)) {
        const motion = this.motions[i];
        // A joint with one velocity leaves its own screw as it is; others move theirs along.
        const carrier = motion.twists.length === 1 ? motion.parent : i;
        motion.twists.forEach((twist, k) => {
          const column = carrier < 0 ? twist : L.adjoint(moved[carrier], twist);
          for (let r = 0; r < 6; r++) J[motion.v + k][r] += motion.multiplier * column[r];
        });
      }
      if (kind === "spatial") return J;
      const T = this.pose(frame, moved), p = L.position(T);
      return J.map((column) => {
        const w = column.slice(3), v = L.sub(column, L.cross(p, w));
        return kind === "hybrid" ? [...v, ...w] : [...L.turnBack(T, v), ...L.turnBack(T, w)];
      });
    }

    // The Jacobian that singularities are judged by: metres in sizes of the robot; the whole twist where the frame
    // can have any, else the velocity of its origin (a SCARA's 6 x 3 Jacobian has full rank even stretched out).
    task(frame, moved, rows) {
      const s = 1 / this.size;
      return this.jacobian(frame, "body", moved).map((c) =>
        [c[0] * s, c[1] * s, c[2] * s, c[3], c[4], c[5]].slice(0, rows));
    }

    // Lower and upper end of a coordinate's slider.
    range(i) {
      const { lower, upper, angle, name } = this.coordinates[i];
      const reach = angle ? Math.PI : /\.q[xyzw]$/.test(name) ? 1 : this.size;
      return [lower === null ? -reach : lower, upper === null ? reach : upper];
    }

    random(generator = Math.random) {
      const q = this.coordinates.map((_, i) => {
        const [low, high] = this.range(i);
        return low + (high - low) * generator();
      });
      return this.normalised(q);
    }

    // The configuration with quaternions of norm 1.
    normalised(q) {
      const out = q.slice();
      for (const motion of this.motions) {
        if (motion.type !== "floating") continue;
        const length = Math.hypot(...out.slice(motion.q + 3, motion.q + 7));
        for (let k = 3; k < 7; k++) out[motion.q + k] = length > 0 ? out[motion.q + k] / length : Number(k === 6);
      }
      return out;
    }

    // Which rows count for a frame, and the rank they have almost everywhere; and that of each part alone.
    generic(frame) {
      const full = this._rank(frame, 0, 6), position = this._rank(frame, 0, 3), rotation = this._rank(frame, 3, 6);
      const parts = { position, rotation };
      if (full === 6) return { rows: 6, rank: 6, parts };
      return position > 0 ? { rows: 3, rank: position, parts } : { rows: 6, rank: full, parts };
    }

    // Of the position (m) and of the rotation, of the three rows of each: the singular values that are not always zero,
    // their product (Yoshikawa's measure), and how many are not zero now; never of both at once, whose units differ
    // (engines/measures.py).
    measures(frame, { parts }, moved) {
      const J = this.jacobian(frame, "body", moved);
      const part = (rank, from) => {
        const { values } = L.singular(J.map((column) => column.slice(from, from + 3)));
        const kept = values.slice(0, rank);
        return {
          generic: rank,
          manipulability: rank ? kept.reduce((all, value) => all * value, 1) : null,
          values: kept,
          rank: counted(kept),
        };
      };
      return { position: part(parts.position, 0), rotation: part(parts.rotation, 3) };
    }

    _rank(frame, from, to) {
      let state = 12345, rank = 0;
      const generator = () => (state = (state * 48271) % 2147483647) / 2147483647;
      for (let k = 0; k < 16; k++) {
        const task = this.task(frame, this.displacements(this.random(generator)), to);
        const { values } = L.singular(task.map((column) => column.slice(from)));
        rank = Math.max(rank, values.filter((value) => value > 1e-7 * Math.max(values[0], 1e-9)).length);
      }
      return rank;
    }

    // The greatest singular value and the least that counts: zero where the frame loses a direction of motion.
    margin(frame, { rows, rank }, q) {
      if (rank === 0) return { least: 0, greatest: 0, rank, now: 0 };
      const { values } = L.singular(this.task(frame, this.displacements(q), rows));
      return { least: values[rank - 1], greatest: values[0], rank, now: counted(values.slice(0, rank)) };
    }

    // A singular configuration not far away (limits are not looked at), by Newton's steps along the gradient of the
    // least singular value; null if there is none near, or none was found within the milliseconds given.
    singularityNear(frame, generic, q, milliseconds = 50) {
      const deadline = performance.now() + milliseconds;
      const least = (at) => this.margin(frame, generic, at).least;
      const start = least(q);
      if (generic.rank === 0) return null;
      let at = q.slice();
      const found = () => {
        const change = at.map((x, i) => x - q[i]);
        return { q: at, change, distance: Math.hypot(...change) };
      };
      // Near the goal every step leaves a part of its square: to 1e-9, so that a straight elbow is 0 and not -0.001.
      for (let step = 0; step < 20 && performance.now() < deadline; step++) {
        const here = least(at);
        if (here < 1e-9) return found();
        const gradient = at.map((x, i) => {
          const h = 1e-5 * (this.coordinates[i].angle ? 1 : this.size);
          const ahead = at.slice(), behind = at.slice();
          ahead[i] = x + h;
          behind[i] = x - h;
          return (least(ahead) - least(behind)) / (2 * h);
        });
        const square = gradient.reduce((sum, x) => sum + x * x, 0);
        if (!(square > 1e-12)) break;
        const length = Math.min(here / square, 0.4 / Math.sqrt(square));
        at = at.map((x, i) => x - length * gradient[i]);
      }
      return least(at) < 1e-3 * start ? found() : null;
    }
  }

  Robot.SINGULAR = SINGULAR;
  ps.Robot = Robot;
})((globalThis.pinscrew = globalThis.pinscrew || {}));
