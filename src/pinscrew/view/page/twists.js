// From vectors, screws and twists to shapes: the formulas of twists.py and scene.py, line by line.
"use strict";
(function (ps) {
  const L = ps.linear;
  const THIN = 0.005, COIL_RADIUS = 0.075, BACK = 0.16, FRONT = 0.28, COIL_AT = 0.62, MOST_TURNS = 3;
  const RING_TURNS = 0.8, RING_TUBE = 0.0035, FARTHEST = 12, NEGLIGIBLE = 1e-9;
  const ARROW = 0.6, ELLIPSOID = 0.5, THINNEST = 1e-3;

  const stretch = (x, y, z) => [x, 0, 0, 0, 0, y, 0, 0, 0, 0, z, 0, 0, 0, 0, 1];
  const nothing = (at) => [0, 0, 0, at[0], 0, 0, 0, at[1], 0, 0, 0, at[2], 0, 0, 0, 1];
  const up = (z) => [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, z, 0, 0, 0, 1];
  const columns = (x, y, z, p) =>
    [x[0], y[0], z[0], p[0], x[1], y[1], z[1], p[1], x[2], y[2], z[2], p[2], 0, 0, 0, 1];

  function frameAlong(point, direction) {
    const sizes = direction.map(Math.abs), k = sizes.indexOf(Math.min(...sizes));
    const e = [0, 0, 0];
    e[k] = 1;
    const x = L.sub(e, L.times(direction[k], direction)), unit = L.times(1 / L.norm(x), x);
    return columns(unit, L.cross(direction, unit), direction, point);
  }

  function lineOf(twist, at, size) {
    const w = twist.slice(3), velocity = L.add(twist, L.cross(w, at));
    const speed = L.norm(velocity), rate = L.norm(w);
    if (rate * size <= NEGLIGIBLE * speed || rate === 0) {
      const direction = speed > 0 ? L.times(1 / speed, velocity) : [0, 0, 0];
      return { point: at, direction, pitch: Infinity, velocity };
    }
    let pitch = L.dot(w, velocity) / (rate * rate);
    if (Math.abs(pitch) <= NEGLIGIBLE * size) pitch = 0;
    const point = L.add(at, L.times(1 / (rate * rate), L.cross(w, velocity)));
    return { point, direction: L.times(1 / rate, w), pitch, velocity };
  }

  function arrow(name, at, vector, radius, color) {
    const length = L.norm(vector);
    const parts = (shaft, head) => [
      { name: `${name}-shaft`, kind: "rod", transform: shaft, color },
      { name: `${name}-head`, kind: "cone", transform: head, color },
    ];
    if (length <= NEGLIGIBLE * radius) return parts(nothing(at), nothing(at));
    const r = radius * Math.min(1, length / (10 * radius)), head = 5 * r;
    const T = frameAlong(at, L.times(1 / length, vector));
    return parts(
      L.multiply(T, stretch(r, r, length - head)),
      L.multiply(L.multiply(T, up(length - head)), stretch(2.5 * r, 2.5 * r, head)),
    );
  }

  function screw(name, line, size, color, bigger = 1) {
    const tube = THIN * size * bigger, back = BACK * size * bigger, front = FRONT * size * bigger;
    const radius = COIL_RADIUS * size * bigger, finite = Number.isFinite(line.pitch);
    let turns = RING_TURNS, rise = 0, lead = 0;
    if (finite) {
      lead = 2 * Math.PI * line.pitch;
      if (Math.abs(lead) > 3 * tube) {
        turns = Math.min(MOST_TURNS, (COIL_AT * front + back) / Math.abs(lead));
        rise = line.pitch / radius;
      } else {
        lead = 0;
      }
    }
    const parameters = { turns, rise, tube: tube / radius };
    const parts = (axis, coil, tip) => [
      ...axis,
      { name: `${name}coil`, kind: "coil", parameters, transform: coil, color },
      { name: `${name}tip`, kind: "cone", transform: tip, color },
    ];
    const none = nothing(line.point);
    if (L.norm(line.direction) === 0) {
      return parts(arrow(`${name}axis`, line.point, [0, 0, 0], tube, color), none, none);
    }
    const T = frameAlong(line.point, line.direction);
    const start = L.sub(line.point, L.times(back, line.direction));
    const whole = L.times(back + front, line.direction);
    const axis = arrow(`${name}axis`, start, whole, finite ? tube : 1.8 * tube, color);
    if (!finite) return parts(axis, none, none);
    const low = up(COIL_AT * front - Math.max(turns * lead, 0));
    const coil = L.multiply(L.multiply(T, low), stretch(radius, radius, radius));
    const end = 2 * Math.PI * turns, long = Math.hypot(1, rise);
    const tangent = [-Math.sin(end) / long, Math.cos(end) / long, rise / long];
    const tip = frameAlong([Math.cos(end), Math.sin(end), rise * end], tangent), head = (5 * tube) / radius;
    return parts(axis, coil, L.multiply(L.multiply(coil, tip), stretch(0.5 * head, 0.5 * head, head)));
  }

  function circle(name, twist, at, size, seconds, color, bold) {
    const line = lineOf(twist, at, size), spoke = L.sub(at, line.point), radius = L.norm(spoke);
    const parts = arrow(name, at, L.times(seconds, line.velocity), 1.2 * THIN * size * bold, color);
    const parameters = { turns: 1, rise: 0, tube: (RING_TUBE * bold * size) / Math.max(radius, 1e-3 * size) };
    let ring = nothing(line.point), rod = nothing(line.point);
    if (Number.isFinite(line.pitch) && radius > 1e-6 * size && radius < FARTHEST * size) {
      const x = L.times(1 / radius, spoke);
      const T = columns(x, L.cross(line.direction, x), line.direction, line.point);
      ring = L.multiply(T, stretch(radius, radius, radius));
      const thin = 0.5 * RING_TUBE * bold * size;
      rod = L.multiply(frameAlong(line.point, x), stretch(thin, thin, radius));
    }
    parts.push({ name: `${name}-circle`, kind: "coil", parameters, transform: ring, color });
    parts.push({ name: `${name}-spoke`, kind: "rod", transform: rod, color });
    return parts;
  }

  // The ball times (J J')^(1/2): U S U' of the rows of scale * J.
  function ellipsoid(name, at, rows, scale, thinnest, color) {
    const squares = rows.map((a) => rows.map((b) => a.reduce((sum, x, i) => sum + x * b[i], 0)));
    const { values, V } = L.orthogonalise(squares);
    const half = values.map((value) => Math.max(scale * Math.sqrt(value), thinnest));
    const T = nothing(at);
    for (let i = 0; i < 3; i++) {
      for (let j = 0; j < 3; j++) {
        for (let k = 0; k < 3; k++) T[4 * i + j] += V[k][i] * half[k] * V[k][j];
      }
    }
    return { name, kind: "sphere", transform: T, color };
  }

  function arrowScales(document, rates) {
    const bound = (weights) => rates.reduce((sum, rate, i) => sum + Math.abs(rate) * weights[i], 0);
    const scale = (b) => (b > 0 ? (ARROW * document.size) / b : 0);
    return [scale(bound(document.scales.field)), 0.7 * scale(bound(document.scales.angular))];
  }

  // Everything that depends on velocities, as {group: [{owner, parts}]}, for the groups that are drawn.
  function now(document, robot, state, moved, drawn) {
    const { tip, qd } = state, { size, colors } = document;
    const found = [];
    const J = robot.jacobian(tip, "spatial", moved), at = L.position(robot.pose(tip, moved));
    const seconds = arrowScales(document, qd), driven = robot.above(tip).map((i) => robot.motions[i]);
    const twist = [0, 0, 0, 0, 0, 0];
    J.forEach((column, i) => column.forEach((x, r) => (twist[r] += x * qd[i])));
    if (drawn.has("screws")) {
      const several = new Set(driven.map((m) => m.v).filter((v, i, all) => all.indexOf(v) !== i));
      for (const i of [...several].sort((a, b) => a - b)) {
        const parts = screw("compound-", lineOf(J[i], at, size), size, colors.compound);
        found.push({ group: "screws", owner: document.velocities[i], parts });
      }
    }
    if (drawn.has("velocity")) {
      let line = lineOf(twist, at, size);
      if (L.norm(L.sub(line.point, at)) > FARTHEST * size) line = { ...line, point: at, direction: [0, 0, 0] };
      found.push({
        group: "velocity",
        owner: tip,
        parts: [
          ...screw("screw-", line, size, colors.instantaneous, 1.35),
          ...arrow("v", at, L.times(seconds[0], line.velocity), 1.6 * THIN * size, colors.linear),
          ...arrow("w", at, L.times(seconds[1], twist.slice(3)), 1.6 * THIN * size, colors.angular),
        ],
      });
    }
    if (drawn.has("circles")) {
      const both = (name, xi, bold) => [
        ...circle(`${name}spatial`, xi, [0, 0, 0], size, seconds[0], colors.spatial, bold),
        ...circle(`${name}body`, xi, at, size, seconds[0], colors.body, bold),
      ];
      const moving = new Set(driven.flatMap((m) => m.twists.map((_, k) => m.v + k)));
      for (const i of [...moving].sort((a, b) => a - b)) {
        const own = J[i].map((x) => x * qd[i]);
        found.push({ group: "circles", owner: document.velocities[i], parts: both("", own, 1) });
      }
      found.push({ group: "circles", owner: tip, parts: both("sum-", twist, 1.7) });
    }
    if (drawn.has("ellipsoid")) {
      const hybrid = robot.jacobian(tip, "hybrid", moved);
      const parts = [["manipulability", qd.map(() => 1)], ["velocity", document.scales.limits]].map(([name, weights]) => {
        const bound = Math.hypot(...document.scales.linear.map((x, i) => x * weights[i]));
        const rows = [0, 1, 2].map((r) => hybrid.map((column, i) => column[r] * weights[i]));
        const scale = bound > 0 ? (ELLIPSOID * size) / bound : 0;
        return ellipsoid(name, at, rows, scale, THINNEST * size, colors[name]);
      });
      found.push({ group: "ellipsoid", owner: tip, parts });
    }
    return found;
  }

  ps.twists = { now, lineOf, arrowScales };
})((globalThis.pinscrew = globalThis.pinscrew || {}));
