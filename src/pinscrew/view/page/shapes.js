// The primitives as three.js geometries, and materials; THREE is the one inside meshcat's viewer.
"use strict";
(function (ps) {
  const THREE = MeshCat.THREE;
  const fixed = new Map();

  function along(geometry, offset) {
    geometry.rotateX(Math.PI / 2); // three.js has its cylinders along y
    if (offset) geometry.translate(0, 0, offset);
    return geometry;
  }

  const makers = {
    box: () => new THREE.BoxGeometry(1, 1, 1),
    sphere: () => new THREE.SphereGeometry(1, 40, 24),
    cylinder: () => along(new THREE.CylinderGeometry(1, 1, 1, 48), 0),
    rod: () => along(new THREE.CylinderGeometry(1, 1, 1, 16), 0.5),
    cone: () => along(new THREE.ConeGeometry(1, 1, 24), 0.5),
  };

  function coil({ turns, rise, tube }) {
    class Helix extends THREE.Curve {
      getPoint(t) {
        const angle = 2 * Math.PI * turns * t;
        return new THREE.Vector3(Math.cos(angle), Math.sin(angle), rise * angle);
      }
    }
    return new THREE.TubeGeometry(new Helix(), Math.ceil(72 * turns), tube, 8, turns === 1 && rise === 0);
  }

  const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer;

  function mesh({ low, step, positions, normals, faces, wide }) {
    const steps = new Uint16Array(bytes(positions)), out = new Float32Array(steps.length);
    for (let i = 0; i < steps.length; i++) out[i] = low[i % 3] + step[i % 3] * steps[i];
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(out, 3));
    geometry.setAttribute("normal", new THREE.BufferAttribute(new Int8Array(bytes(normals)), 3, true));
    const index = wide ? new Uint32Array(bytes(faces)) : new Uint16Array(bytes(faces));
    geometry.setIndex(new THREE.BufferAttribute(index, 1));
    return geometry;
  }

  const meshes = new Map();

  function geometry(part, document) {
    if (part.kind === "coil") return coil(part.parameters);
    if (part.kind === "mesh") {
      if (!meshes.has(part.mesh)) meshes.set(part.mesh, mesh(document.meshes[part.mesh]));
      return meshes.get(part.mesh);
    }
    if (!fixed.has(part.kind)) fixed.set(part.kind, makers[part.kind]());
    return fixed.get(part.kind);
  }

  const materials = new Map();

  function material([red, green, blue, opacity], glossy, twoSided) {
    const key = [red, green, blue, opacity, glossy, twoSided].join();
    if (!materials.has(key)) {
      const made = new THREE.MeshPhongMaterial({
        color: new THREE.Color(red, green, blue),
        opacity,
        transparent: opacity < 1,
        depthWrite: opacity >= 1,
        shininess: glossy ? 40 : 8,
        specular: glossy ? 0x222222 : 0x111111,
      });
      if (twoSided) made.side = THREE.DoubleSide;
      materials.set(key, made);
    }
    return materials.get(key);
  }

  // What shows of an axis or arrow where something is in front of it.
  function ghost([red, green, blue]) {
    const key = [red, green, blue, "ghost"].join();
    if (!materials.has(key)) {
      materials.set(key, new THREE.MeshBasicMaterial({
        color: new THREE.Color(red, green, blue),
        opacity: 0.5,
        transparent: true,
        depthWrite: false,
        depthFunc: THREE.GreaterDepth,
      }));
    }
    return materials.get(key);
  }

  // The three.js object of a part: a group without content for a label, which is drawn as text above the canvas.
  function object(part, document, solid) {
    const [red, green, blue, opacity] = part.color;
    const color = new THREE.Color(red, green, blue);
    if (part.kind === "label") return new THREE.Group();
    if (part.kind === "line" || part.kind === "points") {
      const made = new THREE.BufferGeometry();
      made.setAttribute("position", new THREE.Float32BufferAttribute(part.points.flat(), 3));
      const found = part.kind === "line"
        ? new THREE.Line(made, new THREE.LineBasicMaterial({ color, linewidth: 2 }))
        : new THREE.Points(made, new THREE.PointsMaterial({
            color, size: 2, sizeAttenuation: false, opacity: 0.55 * opacity, transparent: true, depthWrite: false,
          }));
      found.frustumCulled = false;
      return found;
    }
    const found = new THREE.Mesh(geometry(part, document), material(part.color, solid, part.kind === "mesh"));
    if (!solid && part.kind !== "sphere") found.add(new THREE.Mesh(found.geometry, ghost(part.color)));
    return found;
  }

  ps.shapes = { object, coil };
})((globalThis.pinscrew = globalThis.pinscrew || {}));
