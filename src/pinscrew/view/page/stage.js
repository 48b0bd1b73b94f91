// What surrounds the robot: background, light, a floor, the camera, and labels as text above the canvas.
"use strict";
(function (ps) {
  const THREE = MeshCat.THREE;
  const DIRECTION = [0.75, -1.0, 0.62]; // from the robot to the camera, in the base frame
  const FIELD = 32; // degrees

  const world = ([x, y, z]) => new THREE.Vector3(x, z, -y);

  class Stage {
    constructor(viewer, pane, tree, size) {
      this.viewer = viewer;
      this.pane = pane;
      this.tree = tree;
      this.size = size;
      viewer.gui.domElement.style.display = "none";
      for (const name of ["Grid", "Axes"]) viewer.set_property([name], "visible", false);
      this._light();
      // The canvas has the pane's size, not the window's.
      viewer.set_3d_pane_size = () =>
        MeshCat.Viewer.prototype.set_3d_pane_size.call(viewer, pane.clientWidth, pane.clientHeight);
      // The robot stays in sight until a person takes the camera.
      viewer.controls.addEventListener("start", () => (this.taken = true));
      viewer.controls.addEventListener("end", () => this.moved && this.moved());
      new ResizeObserver(() => {
        viewer.set_3d_pane_size();
        if (!this.taken) this.frame();
      }).observe(pane);
      this._labels();
    }

    _light() {
      const { viewer } = this;
      for (const name of ["PointLightNegativeX", "PointLightPositiveX", "SpotLight", "FillLight"]) {
        viewer.set_property(["Lights", name], "visible", false);
      }
      viewer.set_property(["Lights", "AmbientLight", "<object>"], "intensity", 0.62);
      for (const [name, strength, from] of [["key", 0.42, [1, -2, 2.5]], ["fill", 0.16, [-2, 1, 0.6]]]) {
        const light = new THREE.DirectionalLight(0xffffff, strength);
        light.position.set(...from);
        viewer.set_object(["pinscrew", "lights", name], light);
      }
    }

    // A floor below what is drawn, in squares of 1, 2 or 5 times a power of ten, its middle lines in the first of two
    // colours.
    floor(colors) {
      const corners = this.tree.corners();
      const low = corners.reduce((z, corner) => Math.min(z, corner.y), 0);
      const power = 10 ** Math.floor(Math.log10(this.size / 3));
      const side = power * [5, 2, 1].find((k) => k * power <= this.size / 3);
      const count = 2 * Math.ceil((1.6 * this.size) / side);
      const grid = new THREE.GridHelper(count * side, count, ...colors);
      grid.rotateX(Math.PI / 2);
      this.viewer.set_object(["pinscrew", "floor"], grid);
      grid.position.set(0, 0, low - 2e-3 * this.size);
      this.side = side;
    }

    // Look at the whole robot.
    frame() {
      this.taken = false;
      const { viewer, pane } = this;
      const aspect = pane.clientWidth / Math.max(pane.clientHeight, 1);
      const back = world(DIRECTION).normalize();
      const right = new THREE.Vector3(0, 1, 0).cross(back).normalize(), up = back.clone().cross(right);
      const corners = this.tree.corners();
      if (corners.length === 0) corners.push(new THREE.Vector3());
      // Margins leave room for labels.
      const tall = 0.86 * Math.tan((FIELD * Math.PI) / 360), wide = 0.84 * aspect * Math.tan((FIELD * Math.PI) / 360);
      // The point between the outermost corners as the camera sees them, twice: it depends on the distance.
      const centre = new THREE.Box3().setFromPoints(corners).getCenter(new THREE.Vector3());
      let distance = 0;
      for (let pass = 0; pass < 4; pass++) {
        distance = this.size * 0.05;
        const seen = corners.map((corner) => {
          const p = corner.clone().sub(centre);
          return [p.dot(right), p.dot(up), p.dot(back)];
        });
        for (const [x, y, z] of seen) distance = Math.max(distance, z + Math.abs(x) / wide, z + Math.abs(y) / tall);
        const middle = (i) => {
          const at = seen.map((p) => p[i] / (distance - p[2]));
          return (0.5 * (Math.min(...at) + Math.max(...at))) * distance;
        };
        if (pass < 3) centre.addScaledVector(right, middle(0)).addScaledVector(up, middle(1));
      }
      viewer.camera.fov = FIELD;
      viewer.camera.near = 0.01 * distance;
      viewer.camera.far = 100 * distance;
      viewer.controls.target.copy(centre);
      viewer.camera.position.copy(centre).addScaledVector(back, distance);
      viewer.camera.updateProjectionMatrix();
      viewer.controls.update();
      viewer.set_dirty();
    }

    // Where the camera is and what it looks at, six numbers of meshcat's world.
    camera() {
      const { camera, controls } = this.viewer;
      return [...camera.position.toArray(), ...controls.target.toArray()];
    }

    look(numbers) {
      this.frame();
      this.taken = true;
      this.viewer.camera.position.fromArray(numbers);
      this.viewer.controls.target.fromArray(numbers, 3);
      this.viewer.controls.update();
      this.viewer.set_dirty();
    }

    // Turn the camera about what it looks at, by angles to the right and down, and change its distance.
    orbit(right, down, farther) {
      this.taken = true;
      const { camera, controls } = this.viewer;
      const from = camera.position.clone().sub(controls.target), at = new THREE.Spherical().setFromVector3(from);
      at.theta += right;
      at.phi = Math.min(Math.PI - 0.01, Math.max(0.01, at.phi + down));
      at.radius *= farther;
      camera.position.setFromSpherical(at).add(controls.target);
      controls.update();
      this.viewer.set_dirty();
    }

    // The scene with its labels, as the address of a picture.
    picture() {
      const { viewer } = this, drawn = viewer.renderer.domElement;
      viewer.render();
      const canvas = document.createElement("canvas"), context = canvas.getContext("2d");
      [canvas.width, canvas.height] = [drawn.width, drawn.height];
      context.drawImage(drawn, 0, 0);
      context.scale(drawn.width / this.pane.clientWidth, drawn.height / this.pane.clientHeight);
      context.textBaseline = "top";
      for (const { text } of this.texts.filter((label) => label.text.style.visibility === "visible")) {
        const { left, top } = text.getBoundingClientRect(), pane = this.pane.getBoundingClientRect();
        const style = getComputedStyle(text);
        context.font = `${style.fontStyle} ${style.fontWeight} ${style.fontSize} ${style.fontFamily}`;
        context.fillStyle = style.color;
        context.fillText(text.textContent, left - pane.left, top - pane.top);
      }
      return canvas.toDataURL("image/png");
    }

    _labels() {
      const { viewer, pane, tree } = this;
      const layer = document.createElement("div");
      layer.className = "labels";
      pane.appendChild(layer);
      this.texts = tree.labels.map(({ node, group, owner, part }) => {
        const text = document.createElement("span");
        text.className = `label ${group}`;
        text.textContent = part.text;
        layer.appendChild(text);
        return { node, group, owner, part, text, width: 0, height: 0 };
      });
      const render = MeshCat.Viewer.prototype.render;
      viewer.render = () => {
        render.call(viewer);
        this.placeLabels();
      };
    }

    // What the colours mean of what is drawn.
    legend(drawn, colors) {
      const words = [
        ["velocity", "linear", "linear velocity of the tip"], ["velocity", "angular", "angular velocity"],
        ["velocity", "instantaneous", "instantaneous screw of V = J θ̇"],
        ["circles", "spatial", "spatial velocity: seen at the base"], ["circles", "body", "body velocity: seen at the tip"],
        ["ellipsoid", "manipulability", "tip velocities for ‖θ̇‖ = 1"],
        ["ellipsoid", "velocity", "tip velocities within the joints' limits"],
      ];
      const list = document.getElementById("legend");
      list.replaceChildren(...words.filter(([group]) => drawn.has(group)).map(([, color, text]) => {
        const item = document.createElement("li"), dot = document.createElement("i");
        dot.style.background = `rgb(${colors[color].slice(0, 3).map((c) => Math.round(255 * c)).join()})`;
        item.append(dot, text);
        return item;
      }));
    }

    // Labels beside their points, none over another: the next best place, or hidden where there is none.
    placeLabels() {
      const { clientWidth: width, clientHeight: height } = this.pane;
      const { camera } = this.viewer, point = new THREE.Vector3(), taken = [];
      const rank = ({ group, owner }) => (this.first && this.first.has(owner) ? 0 : group === "screws" ? 1 : 2);
      for (const label of this.texts.slice().sort((a, b) => rank(a) - rank(b))) {
        const { node, text } = label;
        if (!label.width) [label.width, label.height] = [text.offsetWidth, text.offsetHeight];
        point.setFromMatrixPosition(node.object.matrixWorld).project(camera);
        const x = (0.5 + 0.5 * point.x) * width, y = (0.5 - 0.5 * point.y) * height;
        const { width: w, height: h } = label, gap = 9;
        const shown = this.drawn && this.drawn.has(label.group) && Math.abs(point.z) < 1;
        const spots = [[gap, -h - 2], [gap, 3], [-gap - w, -h - 2], [-gap - w, 3], [gap, h + 4], [gap, -2 * h - 3],
          [-gap - w, h + 4], [-gap - w, -2 * h - 3], [gap, 2 * h + 5], [gap, -3 * h - 4]];
        const spot = shown && spots.map(([dx, dy]) => [x + dx, y + dy]).find(([a, b]) =>
          a >= 2 && b >= 2 && a + w <= width - 2 && b + h <= height - 2 &&
          taken.every(([c, d, e, f]) => a + w < c || c + e < a || b + h < d || d + f < b));
        text.style.visibility = spot ? "visible" : "hidden";
        if (spot) {
          taken.push([...spot, w, h]);
          text.style.transform = `translate(${Math.round(spot[0])}px, ${Math.round(spot[1])}px)`;
        }
      }
    }
  }

  ps.Stage = Stage;
})((globalThis.pinscrew = globalThis.pinscrew || {}));
