// Sliders, and one canvas: wiggly potential, friction loop, coefficients.
// Python sends arrays and what it has to say of them; see `ExplorePage` in widget.py.

const FONT = "12px system-ui, sans-serif";
// JupyterLab pays for each message to Python with its signs of a busy kernel, more than
// for a frame: places of the sliders go together, and are answered one by one.
const PAUSE = 100; // ms between messages, at most: pictures trail the slider by that
const LEAST = 50; // ms, where answers are there sooner
const ANSWERS = 4; // that take as long as the pause between
const LATE = 300; // ms after which it is asked again, and what waits is dropped
const MOST = 6; // places in one; answers that wait for their frame

function coloursOf(element) {
  const style = getComputedStyle(element);
  const names = ["ink", "faint", "grid", "first", "second", "third"];
  return Object.fromEntries(
    names.map((name) => [name, style.getPropertyValue(`--${name}`).trim()]),
  );
}

// The arrays of `Explored.packed`, in its order.
function unpacked(view, wells, times) {
  const bytes = view.buffer.slice(view.byteOffset, view.byteOffset + view.byteLength);
  const names = ["wells", "energy", "ts", "z", "force", "zLimit", "forceLimit"];
  const found = {};
  let start = 0;
  for (const name of names) {
    const count = name === "wells" || name === "energy" ? wells : times;
    found[name] = new Float32Array(bytes, 4 * start, count);
    start += count;
  }
  return found;
}

function largest(...arrays) {
  let most = 0;
  for (const array of arrays) {
    for (const value of array) most = Math.max(most, Math.abs(value));
  }
  return most;
}

// Rounded up to 1, 1.5, 2, 3, 5, 7 of a decade: axes that stand still while sliders move.
function roundedUp(value) {
  const decade = 10 ** Math.floor(Math.log10(value || 1));
  const steps = [1, 1.5, 2, 3, 5, 7, 10];
  return decade * steps.find((step) => step * decade >= value * 0.999999);
}

function shownNumber(value) {
  return String(Number(value.toPrecision(3)));
}

// Axes around zero in a box; returns where values are on the canvas.
function drawAxes(ctx, box, colours, { title, x, y, xMost, yMost }) {
  const [left, top] = [box.x + 52, box.y + 24];
  const [width, height] = [box.width - 64, box.height - 64];
  const px = (value) => left + (width * (value + xMost)) / (2 * xMost);
  const py = (value) => top + (height * (yMost - value)) / (2 * yMost);
  ctx.strokeStyle = colours.grid;
  ctx.fillStyle = colours.ink;
  ctx.lineWidth = 1;
  ctx.font = FONT;
  for (const share of [-1, -0.5, 0, 0.5, 1]) {
    ctx.beginPath();
    ctx.moveTo(px(share * xMost), top);
    ctx.lineTo(px(share * xMost), top + height);
    ctx.moveTo(left, py(share * yMost));
    ctx.lineTo(left + width, py(share * yMost));
    ctx.stroke();
    ctx.textAlign = "center";
    ctx.fillText(shownNumber(share * xMost), px(share * xMost), top + height + 15);
    ctx.textAlign = "right";
    ctx.fillText(shownNumber(share * yMost), left - 5, py(share * yMost) + 4);
  }
  ctx.textAlign = "left";
  ctx.fillText(title, box.x + 8, box.y + 14);
  ctx.textAlign = "center";
  ctx.fillText(`${x}; upwards ${y}`, left + width / 2, top + height + 32);
  return { px, py };
}

function drawLine(ctx, axes, xs, ys, colour, width, dashes = [], scale = 1) {
  ctx.strokeStyle = colour;
  ctx.lineWidth = width;
  ctx.setLineDash(dashes);
  ctx.beginPath();
  for (let i = 0; i < xs.length; i++) ctx.lineTo(axes.px(xs[i]), axes.py(scale * ys[i]));
  ctx.stroke();
  ctx.setLineDash([]);
}

function drawDot(ctx, axes, x, y, colour) {
  ctx.fillStyle = colour;
  ctx.beginPath();
  ctx.arc(axes.px(x), axes.py(y), 5, 0, 2 * Math.PI);
  ctx.fill();
}

function between(xs, ys, x) {
  const step = (xs[xs.length - 1] - xs[0]) / (xs.length - 1);
  const place = Math.max(0, Math.min(xs.length - 1.001, (x - xs[0]) / step));
  const low = Math.floor(place);
  return ys[low] + (place - low) * (ys[low + 1] - ys[low]);
}

function drawWells(ctx, box, colours, shown, row) {
  const yMost = roundedUp(1e3 * largest(shown.arrays.energy));
  const axes = drawAxes(ctx, box, colours, {
    title: "Wiggly potential, and the tip",
    x: "z/eps from its well (periods)",
    y: "V (mJ)",
    xMost: 2,
    yMost,
  });
  const { wells, energy, z } = shown.arrays;
  drawLine(ctx, axes, wells, energy, colours.first, 2, [], 1e3);
  const place = z[row] / shown.eps;
  const inside = place - Math.round(place);
  drawDot(ctx, axes, inside, 1e3 * between(wells, energy, inside), colours.second);
}

function drawLoop(ctx, box, colours, shown, row) {
  const { z, force, zLimit, forceLimit } = shown.arrays;
  const axes = drawAxes(ctx, box, colours, {
    title: "Friction loop; dashed: eps \u2192 0",
    x: "z (m)",
    y: "l - \u03a6'(z) (N)",
    xMost: roundedUp(largest(z, zLimit)),
    yMost: roundedUp(largest(force, forceLimit)),
  });
  drawLine(ctx, axes, z, force, colours.first, 1.3);
  drawLine(ctx, axes, zLimit, forceLimit, colours.ink, 1.5, [6, 4]);
  drawDot(ctx, axes, z[row], force[row], colours.second);
}

function coefficientRows({ rho_plus: plus, rho_minus: minus, ratio }) {
  const most = roundedUp(Math.max(plus, -minus));
  const share = Math.log(ratio) / Math.log(4); // the bar ends at 1/4 and at 4
  return [
    ["rho_plus, against motion to the right", `${plus.toFixed(4)} N`, 0, plus / most],
    ["rho_minus, against motion to the left", `${minus.toFixed(4)} N`, 0, -minus / most],
    ["ratio -rho_plus/rho_minus", ratio.toFixed(4), 0.5, 0.5 + 0.5 * share],
  ];
}

function drawCoefficients(ctx, box, colours, shown) {
  ctx.font = FONT;
  ctx.textAlign = "left";
  ctx.fillStyle = colours.ink;
  ctx.fillText("Coefficients", box.x + 8, box.y + 14);
  const width = box.width - 24;
  const height = (box.height - 40) / 3;
  const inks = [colours.first, colours.second, colours.third];
  coefficientRows(shown.coefficients).forEach(([name, text, from, to], i) => {
    const [left, top] = [box.x + 12, box.y + 30 + i * height];
    const [start, end] = [from, to].map((v) => Math.max(0, Math.min(1, v)) * width);
    ctx.fillStyle = colours.ink;
    ctx.font = FONT;
    ctx.textAlign = "left";
    const room = width - ctx.measureText(text).width - 20; // bold, and a gap
    const fits = ctx.measureText(name).width < room;
    ctx.fillText(fits ? name : name.split(",")[0], left, top + 12);
    ctx.font = `bold ${FONT}`;
    ctx.textAlign = "right";
    ctx.fillText(text, left + width, top + 12);
    ctx.strokeStyle = colours.faint;
    ctx.lineWidth = 1;
    ctx.strokeRect(left, top + 20, width, 14);
    ctx.fillStyle = inks[i];
    ctx.fillRect(left + Math.min(start, end), top + 20, Math.abs(end - start), 14);
    if (from) {
      ctx.fillStyle = colours.ink;
      ctx.fillRect(left + start - 1, top + 17, 2, 20);
    }
  });
}

// As many as there is room for, evenly, the last one always.
function thinned(places, room) {
  const count = Math.min(room, places.length);
  return Array.from(
    { length: count },
    (_, i) => places[Math.ceil(((i + 1) * places.length) / count) - 1],
  );
}

// The canvas in this size; to set it anew, though it is the same, lays out the page.
function sized(canvas, width, height, dots) {
  const size = [Math.round(width * dots), Math.round(height * dots)];
  if (canvas.width !== size[0] || canvas.height !== size[1]) {
    [canvas.width, canvas.height] = size;
    canvas.style.height = `${height}px`;
  }
  const ctx = canvas.getContext("2d");
  ctx.setTransform(dots, 0, 0, dots, 0, 0);
  ctx.clearRect(0, 0, width, height);
  return ctx;
}

function draw(canvas, shown, row) {
  const width = canvas.clientWidth || 900;
  const wide = width >= 760;
  const panel = wide ? width / 3 : width;
  const height = wide ? 300 : 840;
  const dots = globalThis.devicePixelRatio || 1;
  const ctx = sized(canvas, width, height, dots);
  ctx.lineJoin = "round";
  const colours = coloursOf(canvas);
  const box = (i) =>
    wide
      ? { x: i * panel, y: 0, width: panel, height }
      : { x: 0, y: 280 * i, width: panel, height: 280 };
  drawWells(ctx, box(0), colours, shown, row);
  drawLoop(ctx, box(1), colours, shown, row);
  drawCoefficients(ctx, box(2), colours, shown);
  const { rho_plus: plus, rho_minus: minus, ratio } = shown.coefficients;
  canvas.setAttribute(
    "aria-label",
    "Wiggly potential, friction loop and coefficients: " +
      `rho_plus ${plus.toFixed(4)} N, rho_minus ${minus.toFixed(4)} N, ` +
      `ratio ${ratio.toFixed(4)}`,
  );
}

function slider(parent, { label, unit, low, high, step, logarithmic }, moved) {
  const [toPlace, toValue] = logarithmic
    ? [Math.log10, (place) => 10 ** place]
    : [Number, Number];
  const row = document.createElement("label");
  const name = document.createElement("span");
  name.textContent = label;
  const shown = document.createElement("span"); // an <output> would be read out each time
  shown.className = "value";
  const input = document.createElement("input");
  Object.assign(input, { type: "range", min: toPlace(low), max: toPlace(high), step });
  input.setAttribute("aria-label", label); // without the value: aria-valuetext has it
  row.append(name, shown, input);
  parent.append(row);
  let value = low;
  const tell = () => {
    shown.textContent = `${Number(value.toPrecision(3))} ${unit}`.trim();
    input.setAttribute("aria-valuetext", shown.textContent);
  };
  input.addEventListener("input", () => {
    value = toValue(Number(input.value));
    tell();
    moved();
  });
  return {
    get: () => value,
    set: (given) => {
      value = given; // as given, though the slider has steps
      input.value = toPlace(given);
      tell();
    },
  };
}

function render({ model, el }) {
  const root = document.createElement("div");
  root.className = "fx-explore";
  const canvas = document.createElement("canvas");
  canvas.setAttribute("role", "img");
  const status = document.createElement("div");
  status.className = "status";
  status.setAttribute("role", "status");
  const rows = document.createElement("div");
  rows.className = "sliders";
  root.append(canvas, status, rows);
  el.append(root);

  const view = Math.random().toString(36).slice(2); // of several views of one page
  const read = () => {
    const { wells, times } = model.get("told");
    return unpacked(model.get("arrays"), wells, times);
  };
  const end = read().ts.at(-1);
  let [drawing, shown] = [false, null];
  let [timer, sent, left] = [null, -PAUSE, 0]; // left to be answered
  let [since, pace] = [0, PAUSE / 2]; // ms: when the next one was begun, what each takes
  const [places, heard] = [[], []];
  const sliders = Object.fromEntries(
    model.get("sliders").map((one) => [one.name, slider(rows, one, ask)]),
  );
  const time = slider(
    rows,
    { label: "time, moves the tip along", unit: "s", low: 0, high: end, step: end / 1200 },
    redraw,
  );
  time.set(0);

  function ask() {
    places.push(
      Object.fromEntries(Object.entries(sliders).map(([name, one]) => [name, one.get()])),
    );
    sendInTime();
  }

  // At once after a rest; else when Python is about to run out of places.
  function pause() {
    return Math.max(LEAST, Math.min(PAUSE, ANSWERS * pace));
  }

  function sendInTime() {
    clearTimeout(timer);
    if (!places.length) return;
    const due = sent + (left > 1 ? LATE : pause());
    timer = setTimeout(send, Math.max(0, due - performance.now()));
  }

  function send() {
    const room = Math.max(2, Math.min(MOST, Math.ceil(pause() / pace)));
    const settings = thinned(places.splice(0), room);
    sent = performance.now();
    if (!left) since = sent;
    left = Math.min(left, 1) + settings.length; // one is in work, others are dropped
    model.send({ view, settings });
  }

  function countAnswer(own) {
    const now = performance.now();
    if (own && left) pace += 0.3 * (now - since - pace);
    left = own ? Math.max(0, left - 1) : 0; // another's, or Python's, came in place of them
    since = now;
    sendInTime();
  }

  // One answer a frame.
  function redraw() {
    if (drawing) return;
    drawing = true;
    requestAnimationFrame(() => {
      drawing = false;
      if (heard.length) take(heard.shift());
      if (heard.length) redraw();
      const row = Math.round((time.get() / end) * (shown.arrays.ts.length - 1));
      draw(canvas, shown, row);
      canvas.dataset.frames = Number(canvas.dataset.frames || 0) + 1;
    });
  }

  function hear() {
    const told = model.get("told");
    if (told.view !== view) {
      for (const [name, one] of Object.entries(sliders)) one.set(told.setting[name]);
      places.length = 0; // where they are no more
    }
    countAnswer(told.view === view);
    heard.push({ told, arrays: read() });
    if (heard.length > MOST) take(heard.shift()); // of a page that is not in sight
    redraw();
  }

  function take({ told, arrays }) {
    if (status.textContent !== told.status) status.textContent = told.status;
    status.classList.toggle("refused", !told.ok);
    canvas.classList.toggle("stale", !told.ok);
    if (told.ok || !shown) {
      shown = { eps: told.eps, coefficients: told.coefficients, arrays };
    }
  }

  const lights = matchMedia("(prefers-color-scheme: dark)");
  const sizes = new ResizeObserver(redraw);
  model.on("change:told", hear);
  lights.addEventListener("change", redraw);
  sizes.observe(root);
  hear();
  return () => {
    clearTimeout(timer);
    model.off("change:told", hear);
    lights.removeEventListener("change", redraw);
    sizes.disconnect();
  };
}

export default { render };
