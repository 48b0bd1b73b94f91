// The one dialect of numbers, as `ground/expressions.py` reads it on the command line: pi/4, 45deg, 2cm, 2*(pi-1).
// Parsed, never run. A value is {x, unit}: rad, m, or "" for neither.
"use strict";
(function (ps) {
  const CONSTANTS = {
    pi: [Math.PI, ""], rad: [1, "rad"], deg: [Math.PI / 180, "rad"], m: [1, "m"], cm: [1e-2, "m"], mm: [1e-3, "m"],
  };
  const NAMES = { rad: "an angle", m: "a length", "": "a number" };
  const EXAMPLES = { rad: "0.1, pi/4 or 45deg", m: "0.1, 2cm or 30mm", "": "0.1 or 1e5" };
  const SUFFIX = /([0-9.)])\s*(pi|rad|deg|m|cm|mm)\b/g;
  const TOKEN = /\s*(?:((?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)|([a-z]+)|([-+*/()]))/y;
  const LONGEST = 100;

  function tokens(text) {
    const found = [], source = text.trim().replace(SUFFIX, "$1*$2");
    TOKEN.lastIndex = 0;
    while (TOKEN.lastIndex < source.length) {
      const match = TOKEN.exec(source);
      if (!match) throw new Error();
      found.push(match[1] !== undefined ? Number(match[1]) : match[2] || match[3]);
    }
    return found;
  }

  function parse(text) {
    const rest = tokens(text);
    const take = (...signs) => (signs.includes(rest[0]) ? rest.shift() : null);
    const fit = (a, b) => {
      if (a.unit && b.unit && a.unit !== b.unit) throw new RangeError("units");
      return a.unit || b.unit;
    };
    const atom = () => {
      const sign = take("+", "-");
      if (sign) {
        const { x, unit } = atom();
        return { x: sign === "-" ? -x : x, unit };
      }
      if (take("(")) {
        const inner = sum();
        if (!take(")")) throw new Error();
        return inner;
      }
      const token = rest.shift();
      if (typeof token === "number") return { x: token, unit: "" };
      if (!Object.hasOwn(CONSTANTS, token)) throw new Error();
      const [x, unit] = CONSTANTS[token];
      return { x, unit };
    };
    const product = () => {
      let a = atom();
      for (let sign; (sign = take("*", "/")); ) {
        const b = atom();
        if (sign === "*" ? a.unit && b.unit : b.unit && b.unit !== a.unit) throw new RangeError("units");
        a = sign === "*" ? { x: a.x * b.x, unit: a.unit || b.unit } : { x: a.x / b.x, unit: b.unit ? "" : a.unit };
      }
      return a;
    };
    const sum = () => {
      let a = product();
      for (let sign; (sign = take("+", "-")); ) {
        const b = product(), unit = fit(a, b);
        a = { x: sign === "+" ? a.x + b.x : a.x - b.x, unit };
      }
      return a;
    };
    const found = sum();
    if (rest.length) throw new Error();
    return found;
  }

  // {x} in rad or m, or {error}, what is wrong and what would be right.
  function number(text, needed) {
    const remedy = `write such as ${EXAMPLES[needed]}`;
    if (text.length > LONGEST) return { error: `too long; ${remedy}` };
    try {
      const { x, unit } = parse(text);
      if (!Number.isFinite(x)) return { error: `no finite number; ${remedy}` };
      if (unit && unit !== needed) return { error: `${NAMES[unit]}, where ${NAMES[needed]} is needed; ${remedy}` };
      return { x };
    } catch (problem) {
      return { error: `${problem instanceof RangeError ? "units do not fit" : "no arithmetic"}; ${remedy}` };
    }
  }

  ps.dialect = { number };
})((globalThis.pinscrew = globalThis.pinscrew || {}));
