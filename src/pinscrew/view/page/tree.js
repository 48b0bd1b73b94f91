// The scene in meshcat's tree. pinscrew/rigid/GROUP/OWNER moves as a whole with its link or joint; what depends on
// velocities is in pinscrew/now/GROUP/OWNER/PART. Names from the robot's file are encoded in paths.
"use strict";
(function (ps) {
  const L = ps.linear, THREE = MeshCat.THREE;

  // three.js keeps a matrix column by column.
  function place(object, T) {
    object.matrixAutoUpdate = false;
    object.matrix.set(...T);
    object.matrixWorldNeedsUpdate = true;
  }

  // A path in meshcat's tree. It keeps children in plain objects, where "constructor" and "__proto__" are taken, so
  // names begin with a sign that no property has.
  const encoded = (path) => ["pinscrew", ...path.map((name) => `@${encodeURIComponent(name)}`)];

  class Tree {
    constructor(viewer, document, robot) {
      this.viewer = viewer;
      this.document = document;
      this.robot = robot;
      this.bodies = [];
      this.labels = [];
      this.now = new Map();
      this.node("rigid");
      this.node("now");
      for (const body of document.bodies) this._body(body);
    }

    node(...path) {
      return this.viewer.scene_tree.find(encoded(path));
    }

    _put(path, part, solid) {
      const object = ps.shapes.object(part, this.document, solid);
      this.viewer.set_object(encoded(path), object);
      const node = this.node(...path);
      place(node.object, part.transform);
      return node;
    }

    _body(body) {
      const path = ["rigid", body.group, body.owner];
      const node = this.node(...path);
      this.bodies.push({ node, motion: body.motion, home: body.home });
      for (const part of body.parts) {
        const placed = this._put([...path, part.name], part, body.group === "links");
        if (part.kind === "label") this.labels.push({ node: placed, group: body.group, owner: body.owner, part });
      }
    }

    // Move what is rigid.
    move(moved) {
      for (const { node, motion, home } of this.bodies) {
        place(node.object, motion < 0 ? home : L.multiply(moved[motion], home));
      }
      this.viewer.set_dirty();
    }

    // Show what depends on velocities: `found` as `twists.now` gives it.
    show(found) {
      const seen = new Set();
      for (const { group, owner, parts } of found) {
        for (const part of parts) {
          const path = ["now", group, owner, part.name], key = JSON.stringify(path);
          seen.add(key);
          let entry = this.now.get(key);
          if (!entry) {
            entry = { node: this._put(path, part, false), part };
            this.now.set(key, entry);
          }
          const object = entry.node.children["<object>"].object;
          if (part.kind === "coil" && differs(entry.part.parameters, part.parameters)) {
            object.geometry.dispose();
            object.geometry = ps.shapes.coil(part.parameters);
            for (const ghost of object.children) ghost.geometry = object.geometry;
          }
          if (part.kind === "line" || part.kind === "points") {
            object.geometry.setAttribute("position", new THREE.Float32BufferAttribute(part.points.flat(), 3));
          }
          place(entry.node.object, part.transform);
          entry.node.object.visible = true;
          entry.part = part;
        }
      }
      for (const [key, { node }] of this.now) if (!seen.has(key)) node.object.visible = false;
      this.viewer.set_dirty();
    }

    // Show some groups and hide the others.
    select(drawn) {
      for (const root of ["rigid", "now"]) {
        for (const group of this.document.groups) this.node(root, group).object.visible = drawn.has(group);
      }
      this.viewer.set_dirty();
    }

    // The transform of everything in the base frame, as three.js has it, by [group, owner, part] as JSON.
    transforms() {
      this.viewer.scene.updateMatrixWorld(true);
      const base = new THREE.Matrix4().copy(this.viewer.scene.matrixWorld).invert();
      const found = {};
      const read = (node) => {
        const M = base.clone().multiply(node.object.matrixWorld).transpose();
        return M.toArray();
      };
      for (const body of this.document.bodies) {
        for (const part of body.parts) {
          const key = JSON.stringify([body.group, body.owner, part.name]);
          found[key] = read(this.node("rigid", body.group, body.owner, part.name));
        }
      }
      for (const [key, { node }] of this.now) {
        if (node.object.visible) found[JSON.stringify(JSON.parse(key).slice(1))] = read(node);
      }
      return found;
    }

    // The pose of each link in the base frame, as three.js has it: pairs of name and pose.
    poses() {
      this.viewer.scene.updateMatrixWorld(true);
      const base = new THREE.Matrix4().copy(this.viewer.scene.matrixWorld).invert();
      return this.document.frames.map(({ name }) => {
        const { matrixWorld } = this.node("rigid", "frames", name).object;
        return [name, base.clone().multiply(matrixWorld).transpose().toArray()];
      });
    }

    // Corners of the boxes of all that is shown, in three.js's world: for the camera.
    corners() {
      this.viewer.scene.updateMatrixWorld(true);
      const found = [];
      const visit = (object) => {
        if (!object.visible) return;
        if (object.isMesh || object.isLine || object.isPoints) {
          object.geometry.computeBoundingBox();
          const { min, max } = object.geometry.boundingBox;
          for (let i = 0; i < 8; i++) {
            const corner = new THREE.Vector3(i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z);
            corner.applyMatrix4(object.matrixWorld);
            if (Number.isFinite(corner.x + corner.y + corner.z)) found.push(corner);
          }
        }
        object.children.forEach(visit);
      };
      for (const root of ["rigid", "now"]) visit(this.node(root).object);
      return found;
    }
  }

  function differs(a, b) {
    return ["turns", "rise", "tube"].some((key) => Math.abs(a[key] - b[key]) > 1e-3 * Math.abs(a[key]) + 1e-9);
  }

  ps.Tree = Tree;
})((globalThis.pinscrew = globalThis.pinscrew || {}));
