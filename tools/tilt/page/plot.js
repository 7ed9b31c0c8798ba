"use strict";
/* The page of `tilt plot`. DATA comes from tools/tilt/plot_page.py: each file's series as base64 of little-endian numbers. */
const LEFT = 150, RIGHT = 110, PANEL = 230, LANE = 20, SPECTRUM = 300, GATED = 1, WARMING = 128, NOTHING = -32768;
const AXIS_NAMES = ["x", "y", "z"], AXIS_COLOURS = ["#1f6fd0", "#e07b00", "#0f9a6a"];
const css = name => getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();

// --- data ---------------------------------------------------------------------------------------------------------------
function unpack(text, type) {
  const letters = atob(text), bytes = new Uint8Array(letters.length);
  for (let i = 0; i < letters.length; i++) bytes[i] = letters.charCodeAt(i);
  return new type(bytes.buffer);
}
for (const file of DATA.files) {
  file.t = unpack(file.t, Uint32Array);
  file.flags = unpack(file.flags, Uint16Array);
  file.begins = unpack(file.begins, Uint8Array);
  file.missing = unpack(file.missing, Uint8Array);
  for (const table of Object.values(file.series)) for (const kind in table) table[kind] = unpack(table[kind], Int16Array);
  if (file.density.hz) {
    file.density.hz = unpack(file.density.hz, Float32Array);
    for (const name of ["raw", "filtered"]) if (file.density[name]) file.density[name] = file.density[name].map(part => unpack(part, Float32Array));
  }
}
const groups = DATA.overlay ? [DATA.files] : DATA.files.map(file => [file]);
const whole = { a: Math.min(...DATA.files.map(f => f.t[0])), b: Math.max(...DATA.files.map(f => f.t[f.t.length - 1])) };
if (whole.b <= whole.a) whole.b = whole.a + 100;
const view = { ...whole }, shown = { raw: true, gated: true, filtered: true, truth: true };
const colourOf = (file, group) => DATA.colours[group.indexOf(file) % DATA.colours.length];

/** The first row whose time is not before t. */
function rowAt(file, t) {
  let low = 0, high = file.t.length;
  while (low < high) { const middle = (low + high) >> 1; if (file.t[middle] < t) low = middle + 1; else high = middle; }
  return low;
}

// --- panels -------------------------------------------------------------------------------------------------------------
function canvasIn(place, height) {
  const canvas = document.createElement("canvas");
  canvas.style.height = height + "px";
  place.append(canvas);
  return canvas;
}
function fitted(canvas) {
  const ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(height * ratio);
  const pen = canvas.getContext("2d");
  pen.scale(ratio, ratio);
  pen.font = "12px system-ui, sans-serif";
  return { pen, width, height };
}
function niceStep(span, count) {
  const rough = span / Math.max(count, 1), power = 10 ** Math.floor(Math.log10(rough));
  return power * [1, 2, 5, 10].find(n => n * power >= rough);
}
function labelOf(value, step) { return value.toFixed(Math.max(0, -Math.floor(Math.log10(step) + 1e-9))).replace("-", "\u2212"); }

function yLimits(group, kind) {
  const scale = DATA.scales[kind];
  let low = Infinity, high = -Infinity;
  const raw = [];
  for (const file of group) {
    const from = Math.max(0, rowAt(file, view.a) - 1), to = Math.min(file.t.length, rowAt(file, view.b) + 1);
    for (const name of ["filtered", "truth"]) {
      const values = shown[name] && file.series[name][kind];
      if (values) for (let i = from; i < to; i++) if (values[i] !== NOTHING) { if (values[i] < low) low = values[i]; if (values[i] > high) high = values[i]; }
    }
    const stride = Math.max(1, Math.floor((to - from) / 4000));
    if (shown.raw || low > high) for (let i = from; i < to; i += stride) if (!file.missing[i]) raw.push(file.series.raw[kind][i]);
  }
  raw.sort((p, q) => p - q);
  if (raw.length) {
    low = Math.min(low, raw[Math.floor(0.005 * (raw.length - 1))]);
    high = Math.max(high, raw[Math.ceil(0.995 * (raw.length - 1))]);
  }
  if (low > high) { low = 0; high = scale; }
  const margin = Math.max(0.06 * (high - low), 0.2 * scale);
  return [(low - margin) / scale, (high + margin) / scale];
}

class Plot {
  constructor(canvas, yLow, yHigh) {
    Object.assign(this, fitted(canvas));
    this.yLow = yLow; this.yHigh = yHigh; this.top = 18; this.bottom = this.height - 22;
    this.right = this.width - RIGHT;
    this.perTick = (this.right - LEFT) / (view.b - view.a);
    this.perUnit = (this.bottom - this.top) / (yHigh - yLow);
  }
  x(t) { return LEFT + (t - view.a) * this.perTick; }
  y(value) { return this.bottom - (value - this.yLow) * this.perUnit; }
  clip() { this.pen.save(); this.pen.beginPath(); this.pen.rect(LEFT, this.top, this.right - LEFT, this.bottom - this.top); this.pen.clip(); }
  frame(title, onTop) {
    const pen = this.pen;
    pen.strokeStyle = css("faint"); pen.strokeRect(LEFT, this.top, this.right - LEFT, this.bottom - this.top);
    pen.fillStyle = css("ink"); pen.textAlign = "left"; pen.fillText(title, LEFT, 12);
    pen.fillStyle = css("faint"); pen.textAlign = "right"; pen.fillText(onTop || "", this.right, 12);
  }
  timeGrid(labels) {
    const pen = this.pen, span = (view.b - view.a) * DATA.tick, step = niceStep(span, (this.right - LEFT) / 110);
    pen.strokeStyle = css("grid"); pen.fillStyle = css("ink"); pen.textAlign = "center";
    for (let k = Math.ceil(view.a * DATA.tick / step); k * step <= view.b * DATA.tick; k++) {
      const x = this.x(k * step / DATA.tick);
      pen.beginPath(); pen.moveTo(x, this.top); pen.lineTo(x, this.bottom); pen.stroke();
      if (labels) pen.fillText(labelOf(k * step, step) + " s", x, this.bottom + 16);
    }
  }
  valueGrid() {
    const pen = this.pen, step = niceStep(this.yHigh - this.yLow, (this.bottom - this.top) / 36);
    pen.strokeStyle = css("grid"); pen.fillStyle = css("ink"); pen.textAlign = "right";
    for (let k = Math.ceil(this.yLow / step); k * step <= this.yHigh; k++) {
      const y = this.y(k * step);
      pen.beginPath(); pen.moveTo(LEFT, y); pen.lineTo(this.right, y); pen.stroke();
      pen.fillText(labelOf(k * step, step), LEFT - 6, y + 4);
    }
  }
  band(file, from, to, is, colour) {
    this.pen.fillStyle = colour;
    const half = file.rate ? 0.5 / file.rate / DATA.tick : 0;
    for (let i = from; i < to; i++) if (is(i)) {
      const begin = i;
      while (i + 1 < to && is(i + 1)) i++;
      const x = this.x(file.t[begin] - half);
      this.pen.fillRect(x, this.top, Math.max(1, this.x(file.t[i] + half) - x), this.bottom - this.top);
    }
  }
  /** A mark at every point, at most one per cell of `cell` pixels; onEdge marks those outside. */
  marks(file, values, scale, from, to, is, cell, mark, onEdge) {
    const across = Math.ceil(this.width / cell) + 1, taken = new Uint8Array(across * (Math.ceil(this.height / cell) + 1));
    for (let i = from; i < to; i++) {
      if (!is(i)) continue;
      const x = this.x(file.t[i]), y = this.y(values[i] / scale);
      if (x < LEFT || x > this.right) continue;
      const outside = y < this.top ? -1 : y > this.bottom ? 1 : 0, at = outside < 0 ? this.top : outside > 0 ? this.bottom : y;
      const place = Math.floor(x / cell) + across * Math.floor(at / cell);
      if (taken[place]) continue;
      taken[place] = 1;
      if (!outside) mark(x, y); else if (onEdge) onEdge(x, at, outside);
    }
  }
  line(file, values, scale, from, to, colour, width, dash, seam) {
    const pen = this.pen, half = 180 * scale;
    pen.strokeStyle = colour; pen.lineWidth = width; pen.setLineDash(dash); pen.lineJoin = "round"; pen.beginPath();
    let down = false, column = -1, low = 0, high = 0, last = 0;
    const leave = () => { if (column >= 0 && low !== high) { pen.lineTo(column, this.y(low / scale)); pen.lineTo(column, this.y(high / scale)); pen.lineTo(column, this.y(last / scale)); } };
    for (let i = from; i < to; i++) {
      const value = values[i];
      if (value === NOTHING) { leave(); down = false; column = -1; continue; }
      const x = Math.round(this.x(file.t[i]) * 2) / 2, cut = !down || file.begins[i] || (seam && Math.abs(value - last) > half);
      if (x !== column || cut) {
        leave();
        if (cut) pen.moveTo(x, this.y(value / scale)); else pen.lineTo(x, this.y(value / scale));
        column = x; low = high = value;
      } else { if (value < low) low = value; if (value > high) high = value; }
      last = value; down = true;
    }
    leave();
    pen.stroke(); pen.setLineDash([]); pen.lineWidth = 1;
  }
}

function drawQuantity(canvas, group, kind, labels) {
  const plot = new Plot(canvas, ...yLimits(group, kind)), pen = plot.pen, scale = DATA.scales[kind], alone = group.length === 1;
  plot.timeGrid(labels); plot.valueGrid();
  const visible = group.map(file => [Math.max(0, rowAt(file, view.a) - 1), Math.min(file.t.length, rowAt(file, view.b) + 1)]);
  plot.clip();
  if (alone) {
    plot.band(group[0], ...visible[0], i => group[0].missing[i], css("missing"));
    plot.band(group[0], ...visible[0], i => group[0].flags[i] & WARMING, css("warming"));
  }
  group.forEach((file, n) => {
    if (!shown.raw || (n && DATA.sameReadings)) return;
    pen.fillStyle = alone || DATA.sameReadings ? css("raw") : colourOf(file, group);
    pen.globalAlpha = alone || DATA.sameReadings ? 1 : 0.35;
    plot.marks(file, file.series.raw[kind], scale, ...visible[n], i => !file.missing[i] && !(alone && shown.gated && file.flags[i] & GATED), 1,
               (x, y) => pen.fillRect(x - 1, y - 1, 2, 2));
    pen.globalAlpha = 1;
  });
  pen.restore();
  group.forEach((file, n) => {
    if (!shown.gated) return;
    pen.fillStyle = pen.strokeStyle = alone ? css("gated") : colourOf(file, group);
    pen.beginPath();
    plot.marks(file, file.series.raw[kind], scale, ...visible[n], i => !file.missing[i] && file.flags[i] & GATED, 2,
               (x, y) => { pen.moveTo(x - 2.5, y - 2.5); pen.lineTo(x + 2.5, y + 2.5); pen.moveTo(x - 2.5, y + 2.5); pen.lineTo(x + 2.5, y - 2.5); },
               (x, y, way) => { pen.moveTo(x - 3.5, y - 4 * way); pen.lineTo(x + 3.5, y - 4 * way); pen.lineTo(x, y + 2 * way); pen.closePath(); });
    pen.stroke();
  });
  plot.clip();
  group.forEach((file, n) => {
    if (shown.filtered && file.series.filtered[kind]) plot.line(file, file.series.filtered[kind], scale, ...visible[n], colourOf(file, group), 1.6, [], kind === "roll");
  });
  if (shown.truth && group[0].series.truth[kind]) plot.line(group[0], group[0].series.truth[kind], scale, ...visible[0], css("truth"), 1.2, [6, 4], kind === "roll");
  pen.restore();
  plot.frame(kind + (kind === "roll" || kind === "pitch" ? " in degrees" : " in mg") + (DATA.overlay ? "" : " \u2013 " + group[0].name));
}

const lanesOf = group => Object.keys(DATA.flagNames).flatMap(bit => group.filter(file => file.counts[bit]).map(file => [Number(bit), file]));

function drawFlags(canvas, group) {
  const lanes = lanesOf(group), plot = new Plot(canvas, 0, Math.max(lanes.length, 1)), pen = plot.pen;
  plot.timeGrid(true);
  lanes.forEach(([bit, file], n) => {
    const y = plot.top + n * LANE, width = Math.floor(plot.right - LEFT), rows = new Uint32Array(width + 1), hits = new Uint32Array(width + 1);
    const from = Math.max(0, rowAt(file, view.a) - 1), to = Math.min(file.t.length, rowAt(file, view.b) + 1);
    for (let i = from; i < to; i++) {
      const column = Math.min(Math.max(Math.floor(plot.x(file.t[i]) - LEFT), 0), width);
      rows[column]++;
      if (file.flags[i] & bit) hits[column]++;
    }
    const end = Math.min(width, Math.floor(plot.x(file.t[to - 1]) - LEFT));
    pen.fillStyle = DATA.flagColours[bit];
    let share = 0;
    for (let column = 0; column <= end; column++) {  // a column between rows repeats the previous one
      if (rows[column]) share = hits[column] / rows[column];
      if (share) { pen.globalAlpha = 0.35 + 0.65 * share; pen.fillRect(LEFT + column, y + 3, 1, LANE - 6); }
    }
    pen.globalAlpha = 1; pen.fillStyle = css("ink"); pen.textAlign = "right";
    pen.fillText(DATA.flagNames[bit] + (group.length > 1 ? ", " + file.name : ""), LEFT - 6, y + LANE / 2 + 4, LEFT - 10);
    pen.fillStyle = css("faint"); pen.textAlign = "left";
    pen.fillText(`${file.counts[bit].toLocaleString("en")} rows, ${(100 * file.counts[bit] / file.rows).toPrecision(2)} %`, plot.right + 6, y + LANE / 2 + 4, RIGHT - 8);
  });
  plot.frame(lanes.length ? "flags: the darker, the more of the rows have it" : "flags: no row has one");
}

function meanOfAxes(parts) { return parts[0].map((_, i) => Math.sqrt((parts[0][i] ** 2 + parts[1][i] ** 2 + parts[2][i] ** 2) / 3)); }

/** Lines of the spectrum: {name, hz, values, colour, width}. */
function spectrumLines() {
  const lines = [], files = DATA.files.filter(file => file.density.hz);
  for (const [n, file] of files.entries()) for (const name of ["raw", "filtered"]) {
    const parts = file.density[name];
    if (!parts || !shown[name] || (name === "raw" && n && DATA.sameReadings)) continue;
    const thin = name === "raw";
    if (DATA.files.length === 1) parts.forEach((values, i) => lines.push({ name: `${AXIS_NAMES[i]} ${name}`, hz: file.density.hz, values, colour: AXIS_COLOURS[i], width: thin ? 0.8 : 1.8, alpha: thin ? 0.6 : 1 }));
    else lines.push({ name: thin ? (DATA.sameReadings ? "raw" : `raw, ${file.name}`) : file.name, hz: file.density.hz, values: meanOfAxes(parts), width: thin ? 0.8 : 1.8,
                      colour: thin && DATA.sameReadings ? css("raw") : DATA.colours[DATA.files.indexOf(file) % DATA.colours.length], alpha: thin ? 0.7 : 1 });
  }
  return lines;
}
function drawSpectrum(canvas) {
  const { pen, width, height } = fitted(canvas), lines = spectrumLines(), top = 20, bottom = height - 36, right = width - RIGHT - 140;
  pen.fillStyle = css("ink"); pen.textAlign = "left";
  pen.fillText("spectrum in LSB/\u221aHz" + (DATA.files.length > 1 ? " (mean of x, y, z)" : "") + ": motion to the left, noise to the right; of the whole recording", LEFT, 13);
  if (!lines.length) { pen.fillText("no stretch without a gap is long enough, or raw and filtered are off", LEFT, 50); return; }
  let low = Math.min(...DATA.floors.map(f => f.lsb[0])), high = Math.max(...DATA.floors.map(f => f.lsb[2])), from = Infinity, to = 0;
  for (const line of lines) {
    from = Math.min(from, line.hz[0]); to = Math.max(to, line.hz[line.hz.length - 1]);
    for (const value of line.values) { if (value > 0 && value < low) low = value; if (value > high) high = value; }
  }
  low /= 1.2; high *= 1.2;
  const x = hz => LEFT + (right - LEFT) * Math.log(hz / from) / Math.log(to / from), y = v => bottom - (bottom - top) * Math.log(v / low) / Math.log(high / low);
  const decades = (a, b, each) => { for (let p = Math.floor(Math.log10(a)); p <= Math.log10(b); p++) for (const m of [1, 2, 5]) { const v = m * 10 ** p; if (v >= a && v <= b) each(v, m); } };
  pen.strokeStyle = css("grid");
  decades(from, to, v => { pen.beginPath(); pen.moveTo(x(v), top); pen.lineTo(x(v), bottom); pen.stroke(); pen.textAlign = "center"; pen.fillText(Number(v.toPrecision(3)) + " Hz", x(v), bottom + 16); });
  decades(low, high, (v, m) => { pen.beginPath(); pen.moveTo(LEFT, y(v)); pen.lineTo(right, y(v)); pen.stroke(); pen.textAlign = "right"; if (m === 1 || high / low < 200) pen.fillText(String(Number(v.toPrecision(3))), LEFT - 6, y(v) + 4); });
  const legend = [];
  DATA.floors.forEach((floor, n) => {
    pen.fillStyle = css(n ? "parts" : "sheet");
    pen.fillRect(LEFT, y(floor.lsb[2]), right - LEFT, y(floor.lsb[0]) - y(floor.lsb[2]));
    legend.push([pen.fillStyle, `${floor.name}: ${floor.lsb[0].toFixed(2)} to ${floor.lsb[2].toFixed(2)}`, 8, 1]);
  });
  for (const line of lines) {
    pen.globalAlpha = line.alpha; pen.strokeStyle = line.colour; pen.lineWidth = line.width; pen.beginPath();
    for (let i = 0; i < line.hz.length; i++) if (line.values[i] > 0) pen.lineTo(x(line.hz[i]), y(line.values[i]));
    pen.stroke();
    legend.push([line.colour, line.name, line.width, line.alpha]);
  }
  pen.globalAlpha = 1; pen.lineWidth = 1; pen.strokeStyle = css("faint"); pen.strokeRect(LEFT, top, right - LEFT, bottom - top);
  legend.forEach(([colour, text, thick, alpha], n) => {
    pen.globalAlpha = alpha; pen.fillStyle = colour; pen.fillRect(right + 10, top + 8 + 18 * n - thick / 2, 22, Math.max(thick, 1.5));
    pen.globalAlpha = 1; pen.fillStyle = css("ink"); pen.textAlign = "left"; pen.fillText(text, right + 38, top + 12 + 18 * n, RIGHT + 96);
  });
  canvas.hzAt = px => px < LEFT || px > right ? null : from * (to / from) ** ((px - LEFT) / (right - LEFT));
}

// --- the page -----------------------------------------------------------------------------------------------------------
const panels = document.getElementById("panels"), cursor = document.getElementById("cursor"), choice = document.getElementById("choice");
const drawings = [];
for (const group of groups) {
  for (const kind of DATA.kinds) drawings.push([canvasIn(panels, PANEL), canvas => drawQuantity(canvas, group, kind, !DATA.flags && kind === DATA.kinds[DATA.kinds.length - 1])]);
  if (DATA.flags) drawings.push([canvasIn(panels, 40 + LANE * Math.max(1, lanesOf(group).length)), canvas => drawFlags(canvas, group)]);
}
const spectrumCanvas = DATA.spectrum ? canvasIn(document.getElementById("spectrum"), SPECTRUM) : null;

let asked = false;
function redraw(spectrumToo) {
  redraw.spectrum ||= spectrumToo;
  if (asked) return;
  asked = true;
  requestAnimationFrame(() => {
    asked = false;
    for (const [canvas, draw] of drawings) draw(canvas);
    if (spectrumCanvas && redraw.spectrum) drawSpectrum(spectrumCanvas);
    redraw.spectrum = false;
    document.body.dataset.drawnMs ||= Math.round(performance.now());
  });
}
function show(a, b) {
  const least = 50, most = whole.b - whole.a, span = Math.min(Math.max(b - a, least), Math.max(most, least));
  view.a = Math.min(Math.max(a, whole.a), Math.max(whole.a, whole.b - span));
  view.b = view.a + span;
  redraw();
}
function zoom(factor, at = (view.a + view.b) / 2) { show(at - (at - view.a) * factor, at + (view.b - at) * factor); }
function move(part) { const by = (view.b - view.a) * part; show(view.a + by, view.b + by); }
const plotWidth = () => panels.clientWidth - 32 - LEFT - RIGHT;
const timeAt = event => view.a + (event.clientX - panels.getBoundingClientRect().left - 16 - LEFT) * (view.b - view.a) / plotWidth();

function flagWords(flags) { return Object.keys(DATA.flagNames).filter(bit => flags & bit).map(bit => DATA.flagNames[bit]).join(", ") || "-"; }
function tell(t) {
  const texts = DATA.files.map(file => {
    let i = Math.min(rowAt(file, t), file.t.length - 1);
    if (i > 0 && t - file.t[i - 1] < file.t[i] - t) i--;
    const values = DATA.kinds.map(kind => kind + " " + ["raw", "filtered", "truth"].filter(name => file.series[name][kind] && file.series[name][kind][i] !== NOTHING)
      .map(name => `${name} ${(file.series[name][kind][i] / DATA.scales[kind]).toFixed(DATA.scales[kind] > 10 ? 2 : 0)}`).join(", "));
    return `${(file.t[i] * DATA.tick).toFixed(3)} s` + (DATA.files.length > 1 ? ` ${file.name}` : "") + `   ${values.join("   ")}   flags: ${flagWords(file.flags[i])}`;
  });
  document.getElementById("readout").textContent = texts.join("\n");
}

let held = null;
panels.addEventListener("pointerdown", event => {
  if (event.button !== 0) return;
  held = { x: event.clientX, t: timeAt(event), a: view.a, b: view.b, choose: event.shiftKey };
  panels.setPointerCapture(event.pointerId);
});
panels.addEventListener("pointermove", event => {
  const t = timeAt(event), left = event.clientX - panels.getBoundingClientRect().left;
  if (held && held.choose) {
    const from = held.x - panels.getBoundingClientRect().left;
    Object.assign(choice.style, { display: "block", left: Math.min(from, left) + "px", width: Math.abs(left - from) + "px", height: panels.clientHeight + "px" });
  } else if (held) {
    const by = (held.x - event.clientX) * (held.b - held.a) / plotWidth();
    show(held.a + by, held.b + by);
  }
  const inside = left >= 16 + LEFT && left <= 16 + LEFT + plotWidth();
  Object.assign(cursor.style, { display: inside ? "block" : "none", left: left + "px", height: panels.clientHeight + "px" });
  if (inside) tell(t);
});
panels.addEventListener("pointerup", event => {
  if (held && held.choose && Math.abs(event.clientX - held.x) > 4) show(Math.min(held.t, timeAt(event)), Math.max(held.t, timeAt(event)));
  held = null;
  choice.style.display = "none";
});
panels.addEventListener("pointerleave", () => { cursor.style.display = "none"; });
panels.addEventListener("dblclick", () => show(whole.a, whole.b));
panels.addEventListener("wheel", event => { event.preventDefault(); zoom(1.0015 ** event.deltaY, timeAt(event)); }, { passive: false });
const actions = { "+": () => zoom(0.6), "=": () => zoom(0.6), "-": () => zoom(1 / 0.6), ArrowLeft: () => move(-0.25), ArrowRight: () => move(0.25), 0: () => show(whole.a, whole.b) };
document.addEventListener("keydown", event => {
  if (actions[event.key] && !event.ctrlKey && !event.metaKey) { event.preventDefault(); actions[event.key](); }
});
for (const [id, key] of [["in", "+"], ["out", "-"], ["left", "ArrowLeft"], ["right", "ArrowRight"], ["all", "0"]]) document.getElementById(id).onclick = actions[key];
if (spectrumCanvas) spectrumCanvas.addEventListener("pointermove", event => {
  const hz = spectrumCanvas.hzAt && spectrumCanvas.hzAt(event.offsetX);
  if (hz) document.getElementById("readout").textContent = `${hz.toPrecision(3)} Hz   ` + spectrumLines().map(line => {
    const i = line.hz.findIndex(other => other >= hz);
    return `${line.name} ${line.values[i < 0 ? line.hz.length - 1 : i].toPrecision(3)}`;
  }).join("   ");
});

function addToggle(name, text, mark, colour) {
  const label = document.createElement("label"), box = document.createElement("input"), sign = document.createElement("span");
  box.type = "checkbox"; box.checked = true;
  box.onchange = () => { shown[name] = box.checked; redraw(true); };
  sign.className = mark;
  if (mark === "cross") { sign.textContent = "\u00d7"; sign.style.color = colour; } else if (mark === "line") sign.style.borderColor = colour; else sign.style.background = colour;
  if (name === "truth") sign.style.borderTopStyle = "dashed";
  label.append(...(name ? [box] : []), sign, text);
  document.getElementById("legend").append(label);
}
function buildLegend() {
  const several = DATA.overlay && DATA.files.length > 1, any = name => DATA.files.some(file => Object.keys(file.series[name]).length);
  const gated = DATA.files.reduce((sum, file) => sum + file.gated, 0);
  if (DATA.kinds.length) {
    addToggle("raw", "raw", "dot", "var(--raw)");
    if (gated) addToggle("gated", `raw of gated rows (${gated.toLocaleString("en")})`, "cross", several ? "var(--ink)" : "var(--gated)");
    if (any("filtered")) addToggle("filtered", "filtered", "line", several ? "var(--ink)" : DATA.colours[0]);
    if (any("truth")) addToggle("truth", "truth", "line", "var(--truth)");
    if (several) DATA.files.forEach(file => addToggle("", file.name, "line", colourOf(file, DATA.files)));
    else {
      if (DATA.files.some(file => file.missing.includes(1))) addToggle("", "no sample: predicted", "area", "var(--missing)");
      if (DATA.files.some(file => file.counts[WARMING])) addToggle("", "warming up", "area", "var(--warming)");
    }
  }
  for (const file of DATA.files) if (file.kept < file.rows) {
    const note = document.createElement("div");
    note.id = "notes";
    note.textContent = `${file.name}: ${file.kept.toLocaleString("en")} of ${file.rows.toLocaleString("en")} rows are in this page, including all extremes; each has the flags of the omitted rows before it`;
    document.getElementById("legend").append(note);
  }
}

document.getElementById("title").textContent = DATA.title;
document.body.dataset.rows = DATA.files.map(file => file.t.length).join(",");
buildLegend();
new ResizeObserver(() => redraw(true)).observe(panels);
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => redraw(true));
redraw(true);
