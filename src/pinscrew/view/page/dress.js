// Light or dark, as the system is; and the camera by keys. Labels keep a contrast that can be read (WCAG 2.1, 1.4.3).
"use strict";
(function (ps) {
  const CONTRAST = 4.6; // 4.5 is asked for, and colours are rounded to 8 bits
  const SCENES = {
    light: { top: [0.985, 0.988, 0.992], bottom: [0.86, 0.885, 0.92], lines: [0xb4bfcc, 0xd3dae3] },
    dark: { top: [0.11, 0.125, 0.15], bottom: [0.16, 0.18, 0.21], lines: [0x4a5462, 0x353d49] },
  };
  const STEP = 0.12; // rad for a key
  const NEARER = 0.88;

  // Relative luminance and contrast of sRGB colours, WCAG 2.1.
  const luminance = (color) => color.map((c) => (c <= 0.03928 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4))
    .reduce((sum, c, i) => sum + [0.2126, 0.7152, 0.0722][i] * c, 0);
  function contrast(a, b) {
    const [low, high] = [luminance(a), luminance(b)].sort((x, y) => x - y);
    return (high + 0.05) / (low + 0.05);
  }

  // A colour moved towards black or white until it can be read on both ends of the background.
  function readable(color, { top, bottom }) {
    const end = luminance(top) > 0.5 ? 0 : 1;
    for (let part = 0; part <= 1; part += 0.05) {
      const found = color.slice(0, 3).map((c) => c + part * (end - c));
      if (Math.min(contrast(found, top), contrast(found, bottom)) >= CONTRAST) return found;
    }
    return [end, end, end];
  }

  const css = (color) => `rgb(${color.map((c) => Math.round(255 * c)).join()})`;

  function dress(stage) {
    const asked = matchMedia("(prefers-color-scheme: dark)");
    const put = () => {
      const scene = SCENES[asked.matches ? "dark" : "light"];
      stage.viewer.set_property(["Background"], "top_color", scene.top);
      stage.viewer.set_property(["Background"], "bottom_color", scene.bottom);
      stage.viewer.show_background();
      for (const { text, part } of stage.texts) text.style.color = css(readable(part.color, scene));
      stage.floor(scene.lines);
      stage.viewer.set_dirty();
    };
    asked.addEventListener("change", put);
    put();
  }

  // Arrows turn the camera about what it looks at, plus and minus move it, 0 shows the whole robot.
  function keys(stage, pane) {
    const turns = { ArrowLeft: [-STEP, 0], ArrowRight: [STEP, 0], ArrowUp: [0, -STEP], ArrowDown: [0, STEP] };
    const zooms = { "+": NEARER, "=": NEARER, "-": 1 / NEARER };
    pane.addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      if (event.key === "0") stage.frame();
      else if (turns[event.key]) stage.orbit(...turns[event.key], 1);
      else if (zooms[event.key]) stage.orbit(0, 0, zooms[event.key]);
      else return;
      event.preventDefault();
      if (stage.moved) stage.moved();
    });
  }

  ps.dress = { dress, keys };
})((globalThis.pinscrew = globalThis.pinscrew || {}));
