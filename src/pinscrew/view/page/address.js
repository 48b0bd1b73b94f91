// The state in the address: a page that is loaded again, or sent to somebody, is where it was.
"use strict";
(function (ps) {
  const WAIT = 250; // ms: browsers refuse an address that changes many times a second
  const KINDS = ["spatial", "body", "hybrid"];
  let pending;

  // What the fragment of an address says of this robot: some of {q, qd, tip, kind, draw, camera}. What does not fit the
  // robot is left out, and all of it if it is of another one.
  function read(given, fragment) {
    const said = new URLSearchParams(fragment.replace(/^#/, "")), found = {};
    if (said.get("robot") !== given.name) return found;
    const take = (key, value) => { if (value !== undefined) found[key] = value; };
    const numbers = (key, count) => {
      const values = (said.get(key) || "").split(",").map((text) => (text.trim() ? Number(text) : NaN));
      return values.length === count && values.every(Number.isFinite) ? values : undefined;
    };
    const among = (key, known) => (known.includes(said.get(key)) ? said.get(key) : undefined);
    take("q", numbers("q", given.coordinates.length));
    take("qd", numbers("qd", given.velocities.length));
    take("tip", among("tip", given.frames.map((frame) => frame.name)));
    take("kind", among("kind", KINDS));
    take("draw", said.has("draw") ? said.get("draw").split(",").filter((group) => given.groups.includes(group)) : undefined);
    take("camera", numbers("camera", 6));
    return found;
  }

  function written({ document: given, state, stage }) {
    const said = new URLSearchParams({ robot: given.name, tip: state.tip, kind: state.kind, draw: [...state.draw].join() });
    if (state.q.length) said.set("q", state.q.join());
    if (state.qd.length) said.set("qd", state.qd.join());
    if (stage.taken) said.set("camera", stage.camera().map((x) => x.toPrecision(6)).join());
    return `#${said.toString().replaceAll("%2C", ",")}`;
  }

  // Keep the state in the address, soon; a page inside a notebook has no address.
  function keep(app) {
    if (!/^(https?|file):$/.test(location.protocol) || app.document.picture) return;
    clearTimeout(pending);
    pending = setTimeout(() => history.replaceState(null, "", written(app)), WAIT);
  }

  ps.address = { read, written, keep };
})((globalThis.pinscrew = globalThis.pinscrew || {}));
