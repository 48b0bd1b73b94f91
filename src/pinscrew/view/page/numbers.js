// Numbers as they are shown, and the measures of a frame as a table. Every name goes in as text.
"use strict";
(function (ps) {
  const POWER = ["", "", "²", "³"];

  function element(tag, className, text) {
    const made = document.createElement(tag);
    if (className) made.className = className;
    if (text !== undefined) made.textContent = text;
    return made;
  }

  // A number with a fixed count of digits and no minus before zero.
  function fixed(x, digits = 4) {
    const text = x.toFixed(digits);
    return Number(text) === 0 ? text.replace("-", "") : text;
  }

  // Four decimals, or as many as show four significant digits; 0 for what rounding leaves, that of a file's π of 11
  // digits among it.
  function significant(x) {
    const size = Math.abs(x);
    if (size < 1e-9) return "0";
    if (size >= 1e5 || size < 1e-3) return x.toExponential(3);
    return size >= 0.1 ? x.toFixed(4) : x.toPrecision(4);
  }

  // A table whose cells are made once and changed in place.
  class Table {
    constructor(table) {
      this.table = table;
      this.shape = "";
    }

    // `value(i, j)` is a number, or a text that is shown as it is.
    fill(rows, columns, value, shown = columns) {
      const shape = JSON.stringify([rows, columns]);
      if (shape !== this.shape) this._make(rows, columns, shape, shown);
      this.cells.forEach((line, i) => line.forEach((cell, j) => {
        const x = value(i, j), text = typeof x === "number" ? significant(x) : x;
        if (cell.textContent !== text) {
          cell.textContent = text;
          cell.classList.toggle("zero", Number(text) === 0);
        }
      }));
    }

    _make(rows, columns, shape, shown) {
      this.shape = shape;
      this.table.replaceChildren();
      this.heads = [];
      if (columns.some(Boolean)) {
        const head = this.table.createTHead().insertRow();
        if (rows.some(Boolean)) head.appendChild(element("th"));
        this.heads = columns.map((name, j) => {
          const cell = head.appendChild(element("th"));
          // A long name goes on in the next line, after an underscore where there is one.
          shown[j].split(/(?<=_)/).forEach((word) => cell.append(word, document.createElement("wbr")));
          cell.scope = "col";
          cell.title = name;
          return cell;
        });
      }
      const body = this.table.createTBody();
      this.cells = rows.map((name) => {
        const line = body.insertRow();
        if (name) line.appendChild(element("th", "row", name)).scope = "row";
        return columns.map(() => line.insertCell());
      });
    }
  }

  // Manipulability with its unit, singular values, condition and rank of position and rotation, as `workspace` has
  // them; and the rank of what the line on singularities judges.
  function measures(table, { parts, twist }) {
    const named = [["position", "m"], ["rotation", ""]].filter(([part]) => parts[part].generic > 0);
    const lines = named.map(([part, unit]) => {
      const { manipulability, values, rank, generic } = parts[part];
      const singular = rank < generic;
      return [
        `${significant(singular ? 0 : manipulability)}${unit && ` ${unit}${POWER[generic]}`}`,
        values.map((x, i) => significant(i < rank ? x : 0)).join(" "),
        singular ? "∞" : significant(values[0] / values[values.length - 1]),
        `${rank} of ${generic}`,
      ];
    });
    if (twist) lines.push(["", "", singular(twist) ? "∞" : significant(twist.greatest / twist.least), `${twist.now} of ${twist.rank}`]);
    const rows = [...named.map(([part]) => part), ...(twist ? ["twist"] : [])];
    table.fill(rows, ["manipulability", "singular values", "condition", "rank"], (i, j) => lines[i][j]);
    table.table.hidden = rows.length === 0;
  }

  const singular = (twist) => twist.now < twist.rank;

  ps.numbers = { element, fixed, significant, Table, measures };
})((globalThis.pinscrew = globalThis.pinscrew || {}));
