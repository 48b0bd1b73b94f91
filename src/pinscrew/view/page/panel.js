// The panel: sliders, choices and numbers. Every name goes in as text.
"use strict";
(function (ps) {
  const L = ps.linear;
  const ROWS = ["vx", "vy", "vz", "ωx", "ωy", "ωz"];
  const WORDS = {
    links: "links", frames: "frames", screws: "screw axes", velocity: "velocity",
    circles: "circles", ellipsoid: "ellipsoids", trace: "trace", workspace: "workspace",
  };
  const { element, fixed, significant: short, Table } = ps.numbers;
  const byId = (id) => document.getElementById(id);

  // Names without the words that all begin and end with: columns are narrow.
  function withoutShared(names) {
    if (names.length < 2) return names;
    const parts = names.map((name) => name.split("_"));
    const same = (place) => parts.every((words) => words[place(words)] === parts[0][place(parts[0])]);
    const room = () => parts.every((words) => words.length > 1 && words.slice(1).join("_") && words.slice(0, -1).join("_"));
    while (room() && same(() => 0)) parts.forEach((words) => words.shift());
    while (room() && same((words) => words.length - 1)) parts.forEach((words) => words.pop());
    return parts.map((words) => words.join("_"));
  }

  class Panel {
    constructor(app) {
      this.app = app;
      const { document: given, robot } = app;
      byId("name").textContent = given.name;
      this.pose = new Table(byId("pose"));
      this.jacobian = new Table(byId("jacobian"));
      this.measures = new Table(byId("measures"));
      this.sliders = given.coordinates.map((coordinate, i) => this._coordinate(coordinate, i));
      this.rates = given.velocities.map((name, i) => this._rate(name, i));
      this.mimics = given.motions.filter((motion) => motion.mimic).map((motion) => this._mimic(motion));
      const tip = byId("tip");
      for (const name of robot.frames.keys()) {
        const option = element("option", "", name);
        option.value = name;
        tip.appendChild(option);
      }
      tip.addEventListener("change", () => app.setTip(tip.value));
      byId("kind").addEventListener("change", () => app.setKind(byId("kind").value));
      const limits = (end) => app.move(given.coordinates.map((c, i) => {
        const bound = c[end];
        return bound === null ? robot.range(i)[end === "lower" ? 0 : 1] : bound;
      }));
      byId("zero").addEventListener("click", () => app.move(given.coordinates.map((c) => c.neutral)));
      byId("start").addEventListener("click", () => app.move(given.coordinates.map((c) => c.opening)));
      byId("random").addEventListener("click", () => app.move(robot.random()));
      byId("lower").addEventListener("click", () => limits("lower"));
      byId("upper").addEventListener("click", () => limits("upper"));
      byId("frame-view").addEventListener("click", () => app.stage.frame());
      byId("picture").addEventListener("click", () => {
        const link = element("a");
        link.href = app.stage.picture();
        link.download = `${given.name}.png`;
        link.click();
      });
      const beside = given.coordinates.filter((c, i) => c.opening !== c.neutral && c.opening === given.state.q[i])
        .map((c) => c.name);
      byId("opening").hidden = beside.length === 0;
      byId("opening").textContent = `Zero is outside the limits of ${beside.join(", ")}: it starts in the middle of them.`;
      this.checks = new Map(given.groups.map((group) => [group, this._check(group)]));
    }

    _coordinate(coordinate, i) {
      const { app } = this, [low, high] = app.robot.range(i);
      const row = element("div", "coordinate");
      const title = element("span", "name", coordinate.name);
      title.title = coordinate.name;
      const unit = element("span", "unit");
      const value = element("input", "value");
      value.type = "text";
      value.autocomplete = "off";
      value.setAttribute("aria-label", coordinate.name);
      const slider = element("input");
      slider.type = "range";
      slider.min = low;
      slider.max = high;
      slider.step = "any";
      slider.setAttribute("aria-label", `${coordinate.name}, slider`);
      const ends = element("div", "ends");
      const limit = (x, other) => (x === null ? `no limit (${fixed(other, 2)})` : fixed(x, 3));
      ends.append(
        element("span", "", limit(coordinate.lower, low)),
        unit,
        element("span", "", limit(coordinate.upper, high)),
      );
      const change = (text) => {
        const x = Number(text);
        if (text !== "" && Number.isFinite(x)) app.moveOne(i, x);
      };
      slider.addEventListener("input", () => change(slider.value));
      const needed = coordinate.angle ? "rad" : /\.q[xyzw]$/.test(coordinate.name) ? "" : "m";
      const error = element("p", "error");
      error.setAttribute("role", "alert");
      value.addEventListener("change", () => {
        const { x, error: what } = ps.dialect.number(value.value, needed);
        error.textContent = what || "";
        value.setAttribute("aria-invalid", String(Boolean(what)));
        if (!what) app.moveOne(i, x);
      });
      const rate = element("span", "rate");
      row.append(title, value, rate, error, slider, ends);
      byId("coordinates").appendChild(row);
      return { row, unit, value, slider, rate, coordinate };
    }

    // The rate of a velocity, beside the coordinate of its name, or of the same place in its joint.
    _rate(name, i) {
      const { app } = this;
      const input = element("input", "rate");
      input.type = "number";
      input.step = "any";
      input.title = `rate of ${name}, per second`;
      input.setAttribute("aria-label", `rate of ${name}`);
      input.addEventListener("change", () => {
        const x = Number(input.value);
        if (input.value !== "" && Number.isFinite(x)) app.setRate(i, x);
      });
      const motion = app.document.motions.find((m) => !m.mimic && m.v <= i && i < m.v + m.twists.length);
      this.sliders[motion.q + (i - motion.v)].rate.replaceWith(input);
      return input;
    }

    _mimic(motion) {
      const row = element("div", "mimic");
      const source = this.app.document.coordinates[motion.q].name;
      const name = row.appendChild(element("span", "name", motion.joint));
      const law = `${short(motion.multiplier)} · ${source}${motion.offset ? ` + ${short(motion.offset)}` : ""}`;
      name.title = `${motion.joint} = ${law}`;
      row.appendChild(element("span", "hint", law));
      const value = row.appendChild(element("span", "numbers"));
      byId("mimics").appendChild(row);
      return { motion, value };
    }

    _check(group) {
      const { app } = this;
      const label = element("label");
      const box = element("input");
      box.type = "checkbox";
      box.name = group;
      box.addEventListener("change", () => app.draw(group, box.checked));
      label.append(box, element("span", "", WORDS[group]));
      byId("draw").appendChild(label);
      return box;
    }

    // Show the state in the inputs; what a person is typing in is left alone.
    inputs() {
      const { state } = this.app;
      this.sliders.forEach(({ row, unit, value, slider, coordinate }, i) => {
        const x = state.q[i];
        if (document.activeElement !== value || !value.matches(":focus-visible")) value.value = Number(x.toFixed(4));
        if (Number(slider.value) !== x) slider.value = x;
        unit.textContent = coordinate.angle ? `${fixed((x * 180) / Math.PI, 1)}°` : /\.q[xyzw]$/.test(coordinate.name) ? "" : "m";
        const { lower, upper } = coordinate, slack = 1e-12;
        row.classList.toggle("outside", (lower !== null && x < lower - slack) || (upper !== null && x > upper + slack));
      });
      this.rates.forEach((input, i) => {
        if (document.activeElement !== input) input.value = Number(state.qd[i].toPrecision(4));
      });
      for (const { motion, value } of this.mimics) {
        value.textContent = short(motion.multiplier * state.q[motion.q] + motion.offset);
      }
      byId("tip").value = state.tip;
      byId("kind").value = state.kind;
      for (const [group, box] of this.checks) box.checked = state.draw.has(group);
    }

    numbers({ T, J, margin, generic, measures, line }) {
      const { state, document: given } = this.app;
      byId("pose-title").textContent = `Pose of ${state.tip} in ${given.base}`;
      byId("jacobian-title").textContent = `${state.kind} Jacobian of ${state.tip}`;
      this.pose.fill(["", "", "", ""], ["", "", "", ""], (i, j) => T[4 * i + j]);
      const moving = this.app.robot.moving(state.tip), names = moving.map((i) => given.velocities[i]);
      const V = ROWS.map((_, r) => J.reduce((sum, column, i) => sum + column[r] * state.qd[i], 0));
      this.jacobian.fill(ROWS, [...names, "V"], (i, j) => (j < moving.length ? J[moving[j]][i] : V[i]),
        [...withoutShared(names), "V"]);
      byId("still").textContent = names.length === given.velocities.length ? ""
        : `${names.length} of ${given.velocities.length} velocities move it; the other columns are zero`;
      ps.numbers.measures(this.measures, { parts: measures, twist: generic.rows === 6 && generic.rank ? margin : null });
      const length = L.norm(line.direction);
      byId("screw").textContent = length === 0
        ? "no motion"
        : Number.isFinite(line.pitch)
          ? `V is a screw of pitch ${short(line.pitch)} m/rad`
          : "V is a translation";
      this.warn(margin, generic, null);
    }

    // What is near: `found` is a singular configuration not far away, if one is known.
    warn({ least, greatest }, { rank, rows }, found) {
      const text = byId("warning"), of = rows === 6 ? "of the twist" : "of the position";
      const ratio = greatest > 0 ? least / greatest : 0;
      let words = "", level = "";
      if (rank === 0) {
        words = "nothing moves this frame";
      } else if (ratio < ps.Robot.SINGULAR) {
        words = `singular: a direction ${of} is lost`;
        level = "singular";
      } else if (found) {
        const names = this.app.document.coordinates.map((c) => c.name);
        const order = found.change.map((_, i) => i).sort((a, b) => Math.abs(found.change[b]) - Math.abs(found.change[a]));
        const main = order.filter((i) => Math.abs(found.change[i]) > 0.25 * Math.abs(found.change[order[0]])).slice(0, 2);
        const where = main.map((i) => `${names[i]} = ${fixed(found.q[i], 3)}`).join(", ");
        const outside = main.some((i) => {
          const { lower, upper } = this.app.document.coordinates[i];
          return (lower !== null && found.q[i] < lower - 1e-6) || (upper !== null && found.q[i] > upper + 1e-6);
        });
        words = `${ratio < 0.05 ? "near a singularity" : "a singularity"} ${of}: ${where}`
          + (outside ? " (outside the limits)" : "");
        level = ratio < 0.05 ? "near" : "";
      } else if (ratio < 0.05) {
        words = `near a singularity ${of}`;
        level = "near";
      }
      text.textContent = words;
      text.className = level;
    }

    scale(side) {
      byId("scale").textContent = `Squares on the floor: ${short(side).replace(/\.?0+$/, "")} m`;
    }
  }

  ps.Panel = Panel;
})((globalThis.pinscrew = globalThis.pinscrew || {}));
