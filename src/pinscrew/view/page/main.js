// The page: one state, from which everything shown follows at once.
"use strict";
(function (ps) {
  const L = ps.linear;
  const TRACE = 2000, CLOUD = 2000;

  // Plays configurations by the clock.
  class Player {
    constructor(app) {
      this.app = app;
      this.box = document.getElementById("player");
      this.button = document.getElementById("play");
      this.slider = document.getElementById("moment");
      this.button.addEventListener("click", () => (this.playing ? this.stop() : this.start()));
      this.slider.addEventListener("input", () => {
        this.stop();
        this.show(Number(this.slider.value));
      });
    }

    load(animation, play) {
      this.stop();
      if (!animation || animation.trajectory.length === 0) return;
      this.frames = animation.trajectory;
      this.fps = animation.fps;
      this.box.hidden = false;
      this.slider.max = this.frames.length - 1;
      this.slider.value = 0;
      if (play) this.start();
    }

    start() {
      const last = this.frames.length - 1;
      const from = Number(this.slider.value) >= last ? 0 : Number(this.slider.value), begun = performance.now();
      this.playing = true;
      this.button.textContent = "Pause";
      const step = () => {
        if (!this.playing) return;
        const index = Math.min(last, from + Math.floor(((performance.now() - begun) / 1000) * this.fps));
        this.show(index);
        if (index < last) requestAnimationFrame(step);
        else this.stop();
      };
      step();
    }

    stop() {
      this.playing = false;
      this.button.textContent = "Play";
    }

    show(index) {
      this.slider.value = index;
      this.app.move(this.frames[index]);
    }
  }

  class App {
    constructor(given) {
      this.document = given;
      this.robot = new ps.Robot(given);
      const { q, qd, kind, draw, trace, workspace } = given.state;
      this.state = { q, qd, kind, tip: given.tip, draw: new Set(draw) };
      this.trace = trace;
      this.workspace = workspace;
      this.generic = this.robot.generic(given.tip);
      const pane = document.getElementById("pane");
      if (given.picture) {
        // A browser without a window may settle on its size late; the picture's is known.
        document.body.classList.add("picture");
        [pane.style.width, pane.style.height] = given.picture.map((pixels) => `${pixels}px`);
      }
      this.viewer = new MeshCat.Viewer(pane);
      this.tree = new ps.Tree(this.viewer, given, this.robot);
      this.stage = new ps.Stage(this.viewer, pane, this.tree, given.size);
      this.panel = new ps.Panel(this);
      this.stage.moved = () => ps.address.keep(this);
      this.player = new Player(this);
      this.player.load(given.animation, false);
      this.show();
      ps.dress.dress(this.stage);
      ps.dress.keys(this.stage, pane);
      this.panel.scale(this.stage.side);
      this.viewer.set_3d_pane_size();
      this.stage.frame();
      this.viewer.render();
      ps.copy.connect(this);
      const said = ps.address.read(given, location.hash);
      if (Object.keys(said).length) this.set(said);
      window.addEventListener("hashchange", () => this.set(ps.address.read(given, location.hash)));
      if (given.live) this.live = new ps.Live(this);
    }

    // Draw and print the state.
    show() {
      const { state, robot } = this;
      const moved = robot.displacements(state.q);
      this.tree.move(moved);
      const found = ps.twists.now(this.document, robot, state, moved, state.draw);
      const T = robot.pose(state.tip, moved), at = L.position(T);
      for (const [group, name, kind, points] of [
        ["trace", "line", "line", this.trace], ["workspace", "points", "points", this.workspace],
      ]) {
        if (!state.draw.has(group)) continue;
        const part = { name, kind, points, transform: L.identity(), color: this.document.colors[group] };
        found.push({ group, owner: state.tip, parts: [part] });
      }
      this.tree.show(found);
      this.tree.select(state.draw);
      this.stage.drawn = state.draw;
      this.stage.legend(state.draw, this.document.colors);
      this.stage.first = new Set([state.tip, this.document.base]);
      const spatial = robot.jacobian(state.tip, "spatial", moved), twist = [0, 0, 0, 0, 0, 0];
      spatial.forEach((column, i) => column.forEach((x, r) => (twist[r] += x * state.qd[i])));
      this.shown = {
        T,
        J: robot.jacobian(state.tip, state.kind, moved),
        margin: robot.margin(state.tip, this.generic, state.q),
        generic: this.generic,
        measures: robot.measures(state.tip, this.generic, moved),
        line: ps.twists.lineOf(twist, at, this.document.size),
      };
      this.panel.inputs();
      this.panel.numbers(this.shown);
      clearTimeout(this.search);
      this.search = setTimeout(() => {
        const near = robot.singularityNear(state.tip, this.generic, state.q);
        this.panel.warn(this.shown.margin, this.generic, near);
      }, 150);
    }

    // Take over some of the state; `tell` whether Python is to hear of it.
    set({ q, qd, tip, kind, draw, camera }, tell = true) {
      const { state } = this;
      if (tell) this.touched = true;
      if (q) state.q = this.robot.normalised(q);
      if (qd) state.qd = qd;
      if (kind) state.kind = kind;
      if (draw) state.draw = new Set(draw);
      if (tip && tip !== state.tip) {
        state.tip = tip;
        this.generic = this.robot.generic(tip);
        this.trace = [];
        this.workspace = this.cloud();
      }
      if (q) this._trail();
      if (camera) this.stage.look(camera);
      this.show();
      ps.address.keep(this);
      if (tell && this.live) this.live.tell();
    }

    _trail() {
      const { robot, state, trace } = this;
      const at = L.position(robot.pose(state.tip, robot.displacements(state.q)));
      const last = trace[trace.length - 1];
      if (!last || L.norm(L.sub(at, last)) > 1e-3 * this.document.size) trace.push(at);
      if (trace.length > TRACE) trace.shift();
    }

    // Points that the tip can reach.
    cloud() {
      const { robot, state } = this;
      return Array.from({ length: CLOUD }, () =>
        L.position(robot.pose(state.tip, robot.displacements(robot.random()))));
    }

    move(q) { this.set({ q }); }
    moveOne(i, x) { this.set({ q: this.state.q.map((old, k) => (k === i ? x : old)) }); }
    setRate(i, x) { this.set({ qd: this.state.qd.map((old, k) => (k === i ? x : old)) }); }
    setTip(tip) { this.set({ tip }); }
    setKind(kind) { this.set({ kind }); }
    draw(group, wanted) {
      const draw = new Set(this.state.draw);
      if (wanted) draw.add(group);
      else draw.delete(group);
      this.set({ draw });
    }
  }

  ps.app = new App(JSON.parse(document.getElementById("document").textContent));
  document.documentElement.dataset.ready = "true";
})((globalThis.pinscrew = globalThis.pinscrew || {}));
