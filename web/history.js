/* The last rows, and the points of a line through them. */
"use strict";

const ANGLES = ["rawRoll", "roll", "trueRoll", "rawPitch", "pitch", "truePitch"];

class RowHistory {
  constructor(size = 65536) { /* a minute at 800 rows a second; a power of two */
    this.size = size;
    this.count = 0;
    this.s = new Float64Array(size);
    for (const name of ANGLES) this[name] = new Float32Array(size); /* undefined becomes NaN: not known */
    this.flags = new Uint16Array(size);
    this.apart = new Uint8Array(size);
  }

  push(row) {
    const at = this.count++ & (this.size - 1);
    for (const name of ["s", "flags", ...ANGLES]) this[name][at] = row[name];
    this.apart[at] = row.apart ? 1 : 0;
  }

  get first() { return Math.max(0, this.count - this.size); }

  get last() { return this.count ? this.s[(this.count - 1) & (this.size - 1)] : 0; }

  /* Number of the first row at or after s. */
  find(s) {
    let low = this.first, high = this.count;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.s[middle & (this.size - 1)] < s) low = middle + 1; else high = middle;
    }
    return low;
  }

  /* Rows a second over the last two seconds of the board's time. */
  rate() {
    const from = Math.min(this.find(this.last - 2), Math.max(this.first, this.count - 2));
    const span = this.last - this.s[from & (this.size - 1)];
    return span > 0 ? (this.count - 1 - from) / span : 0;
  }
}

/* The points of a line, one device pixel after another: if many rows share a pixel, the first, least, greatest and last of them, so
   that every outlier shows. line(x, value), or line(x, value, true) to start a new line. */
function eachPixel(history, column, low, high, pixelOf, line) {
  const values = history[column], mask = history.size - 1;
  let x = NaN, first = 0, least = 0, greatest = 0, last = 0, starts = true;
  const flush = () => {
    line(x, first, starts);
    if (least < first) line(x, least);
    if (greatest > least) line(x, greatest);
    if (last !== greatest) line(x, last);
    starts = false;
  };
  for (let k = low; k < high; k++) {
    const value = values[k & mask], at = pixelOf(history.s[k & mask]);
    if (Number.isNaN(value)) {
      if (x === x) flush();
      x = NaN;
      starts = true;
      continue;
    }
    const parted = history.apart[k & mask] || Math.abs(value - last) > 180; /* roll wraps from 180 to -180 */
    if (at === x && !parted) {
      least = Math.min(least, value);
      greatest = Math.max(greatest, value);
      last = value;
      continue;
    }
    if (x === x) flush();
    starts = starts || parted;
    x = at;
    first = least = greatest = last = value;
  }
  if (x === x) flush();
}
