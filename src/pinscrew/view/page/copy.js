// Numbers to take along: matrices as text that other programs read, with all their digits.
"use strict";
(function (ps) {
  const latex = (x) => String(x).replace(/e([+-]?)0*(\d+)$/, (_, sign, power) => ` \\cdot 10^{${sign === "-" ? "-" : ""}${power}}`);
  const joined = (rows, entry, between, line) => rows.map((row) => row.map(entry).join(between)).join(line);

  // A matrix as rows of numbers; a vector is one row.
  const FORMATS = {
    numpy: (rows, vector) => (vector ? `np.array([${rows[0].join(", ")}])` : `np.array([[${joined(rows, String, ", ", "],\n          [")}]])`),
    matlab: (rows, vector) => `[${joined(rows, String, vector ? "; " : ", ", ";\n ")}]`,
    latex: (rows, vector) => `\\begin{bmatrix} ${joined(rows, latex, vector ? " \\\\ " : " & ", " \\\\ ")} \\end{bmatrix}`,
    csv: (rows) => joined(rows, String, ",", "\n"),
  };

  // What is copied: q as a vector, the pose, and the whole Jacobian, a column for each velocity of the robot.
  function text(app, what, format) {
    const { T, J } = app.shown;
    const rows = {
      q: () => [app.state.q],
      T: () => [0, 4, 8, 12].map((i) => T.slice(i, i + 4)),
      J: () => [0, 1, 2, 3, 4, 5].map((r) => J.map((column) => column[r])),
    }[what]();
    return FORMATS[format](rows, what === "q");
  }

  // Where the page may not use the clipboard, a selected text and the old command.
  async function put(words) {
    try {
      await navigator.clipboard.writeText(words);
      return true;
    } catch {
      const area = document.body.appendChild(ps.numbers.element("textarea", "aside"));
      area.value = words;
      area.select();
      const done = document.execCommand("copy");
      area.remove();
      return done;
    }
  }

  function connect(app) {
    const said = document.getElementById("copied"), format = document.getElementById("copy-format");
    for (const what of ["q", "T", "J"]) {
      document.getElementById(`copy-${what}`).addEventListener("click", async () => {
        const done = await put(text(app, what, format.value));
        said.textContent = done ? `${what} copied` : "the browser does not let it be copied";
        setTimeout(() => (said.textContent = ""), 2000);
      });
    }
  }

  ps.copy = { text, connect };
})((globalThis.pinscrew = globalThis.pinscrew || {}));
