/* Pictures: the charts over time and the artificial horizon. */
"use strict";

const STEPS = [0.5, 1, 2, 5, 10, 15, 30, 45, 90];

class Chart {
  constructor(canvas, title, { raw, filtered, truth = null, limit }) {
    Object.assign(this, { canvas, title, raw, filtered, truth, limit, low: -5, high: 5, fresh: true });
  }

  /* The range of the axis: the filtered line and the mean of the raw one (calibration shifts them) with a margin, changed only
     when necessary, so that it stays calm. */
  rescale(history, from, to, fixed) {
    if (fixed) { this.high = Math.min(fixed, this.limit); this.low = -this.high; this.fresh = true; return; }
    let low = Infinity, high = -Infinity;
    const values = history[this.filtered], raw = history[this.raw], mask = history.size - 1;
    let mean = 0;
    for (let k = from; k < to; k++) {
      low = Math.min(low, values[k & mask]);
      high = Math.max(high, values[k & mask]);
      mean += raw[k & mask] / (to - from);
    }
    if (low > high) return;
    low = Math.min(low, mean);
    high = Math.max(high, mean);
    const room = Math.max(4, (high - low) * 0.35);
    const tight = low - room / 2 < this.low || high + room / 2 > this.high, loose = this.high - this.low > 2.2 * (high - low + 2 * room);
    if (this.fresh || tight || loose) {
      this.low = Math.max(-this.limit, low - room);
      this.high = Math.min(this.limit, high + room);
      this.fresh = false;
    }
  }

  draw(history, endS, spanS, fixed, colours) {
    const scale = window.devicePixelRatio || 1, box = this.canvas.getBoundingClientRect();
    const width = Math.max(1, Math.round(box.width * scale)), height = Math.max(1, Math.round(box.height * scale));
    if (this.canvas.width !== width || this.canvas.height !== height) { this.canvas.width = width; this.canvas.height = height; }
    const pen = this.canvas.getContext("2d");
    const left = Math.round(44 * scale), right = width - Math.round(6 * scale);
    const top = Math.round(22 * scale), bottom = height - Math.round(20 * scale);
    const low = history.find(endS - spanS), high = history.find(endS + 1e-9);
    this.rescale(history, low, high, fixed);
    const perPixel = spanS / (right - left), end = Math.floor(endS / perPixel);
    const view = { pen, scale, left, top, right, bottom, low, high, spanS, colours,
      x: (s) => right - 1 + Math.floor(s / perPixel) - end,
      y: (value) => top + ((this.high - value) * (bottom - top)) / (this.high - this.low) };
    pen.clearRect(0, 0, width, height);
    this.grid(view);
    pen.save();
    pen.beginPath();
    pen.rect(left, top, right - left, bottom - top);
    pen.clip();
    this.marks(view, history);
    this.line(view, history, this.raw, colours.raw, 1);
    this.line(view, history, this.filtered, colours.filtered, 2);
    if (this.truth) this.line(view, history, this.truth, colours.truth, 1.5, [6, 4]);
    pen.restore();
    this.words(view, history);
  }

  grid({ pen, scale, left, top, right, bottom, spanS, colours, y }) {
    pen.font = `${Math.round(11 * scale)}px system-ui, "DejaVu Sans", sans-serif`;
    pen.strokeStyle = colours.grid;
    pen.fillStyle = colours.dim;
    pen.lineWidth = Math.max(1, Math.round(scale));
    pen.beginPath();
    const wanted = ((this.high - this.low) * 34 * scale) / (bottom - top), step = STEPS.find((each) => each >= wanted) || 90;
    pen.textAlign = "right";
    pen.textBaseline = "middle";
    for (let value = Math.ceil(this.low / step) * step; value <= this.high; value += step) {
      const at = Math.round(y(value)) + 0.5;
      pen.moveTo(left, at);
      pen.lineTo(right, at);
      pen.fillText(`${step < 1 ? value.toFixed(1) : Math.round(value)}\u00b0`.replace("-", "\u2212"), left - 6 * scale, at);
    }
    pen.textAlign = "center";
    pen.textBaseline = "top";
    const every = spanS / 5;
    for (let ago = 0; ago <= 5; ago++) {
      const at = Math.round(right - ((right - left) * ago) / 5) - 0.5;
      pen.moveTo(at, top);
      pen.lineTo(at, bottom);
      if (ago) pen.fillText(`\u2212${ago * every} s`, at + (ago === 5 ? 8 * scale : 0), bottom + 5 * scale);
    }
    pen.textAlign = "right";
    pen.fillText("now", right, bottom + 5 * scale);
    pen.stroke();
  }

  marks({ pen, scale, top, bottom, low, high, colours, x }, history) {
    const mask = history.size - 1, tick = Math.round(9 * scale);
    let gate = NaN, absent = NaN;
    for (let k = low; k < high; k++) {
      const flags = history.flags[k & mask];
      if (!(flags & (GATED | NO_SAMPLE))) continue;
      const at = x(history.s[k & mask]);
      if (flags & NO_SAMPLE && at !== absent) {
        const from = k > history.first && !history.apart[k & mask] ? x(history.s[(k - 1) & mask]) : at - 1;
        pen.fillStyle = colours.absent;
        pen.fillRect(from, top, Math.max(1, at - from), bottom - top);
        absent = at;
      }
      if (flags & GATED && at !== gate) {
        pen.fillStyle = colours.gate;
        pen.fillRect(at - Math.round(scale / 2), bottom - tick, Math.max(1, Math.round(scale)), tick);
        gate = at;
      }
    }
  }

  line({ pen, scale, low, high, x, y }, history, column, colour, size, dashes = []) {
    pen.setLineDash(dashes.map((length) => length * scale));
    pen.strokeStyle = colour;
    pen.lineWidth = size * scale;
    pen.lineJoin = "round";
    pen.beginPath();
    eachPixel(history, column, Math.max(history.first, low - 1), high, x, (at, value, starts) => {
      if (starts) pen.moveTo(at + 0.5, y(value)); else pen.lineTo(at + 0.5, y(value));
    });
    pen.stroke();
  }

  words({ pen, scale, left, right, low, high, colours }, history) {
    const values = history[this.raw], mask = history.size - 1;
    let outside = 0;
    for (let k = low; k < high; k++) outside += values[k & mask] < this.low || values[k & mask] > this.high;
    pen.textBaseline = "middle";
    pen.textAlign = "left";
    pen.fillStyle = colours.ink;
    pen.font = `600 ${Math.round(13 * scale)}px system-ui, "DejaVu Sans", sans-serif`;
    pen.fillText(this.title, left, 10 * scale);
    pen.textAlign = "right";
    pen.fillStyle = colours.dim;
    pen.font = `${Math.round(11 * scale)}px system-ui, "DejaVu Sans", sans-serif`;
    if (outside) pen.fillText(`${outside} raw ${outside === 1 ? "point" : "points"} outside`, right, 10 * scale);
    else if (low === high) pen.fillText("no rows yet", right, 10 * scale);
  }
}

const PER_DEGREE = 2; /* of the horizon's ladder, in units of its viewBox */

function horizonLadder() {
  let marks = "";
  for (let degrees = -80; degrees <= 80; degrees += 10) {
    if (!degrees) continue;
    const y = -degrees * PER_DEGREE, half = degrees % 30 ? 12 : 24;
    marks += `<line x1="${-half}" x2="${half}" y1="${y}" y2="${y}"/>`;
    if (degrees % 30 === 0) marks += `<text x="33" y="${y + 3}" stroke="none">${Math.abs(degrees)}</text>`;
  }
  return marks;
}

/* The view along the sensor's x axis, y to the left and z up: with the side of positive y lifted, roll is positive and the
   horizon rotates the other way; with x lowered, pitch is positive and the horizon rises. */
const horizonTransform = (roll, pitch) => `rotate(${(-roll).toFixed(2)}) translate(0 ${(-PER_DEGREE * pitch).toFixed(2)})`;
