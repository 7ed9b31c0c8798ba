/* The protocol of the firmware (docs/protocol.md): text in, rows and notes out. */
"use strict";

const FLAGS = [[1, "gated", "info"], [2, "coasted", "warn"], [4, "re-acquired", "info"], [8, "clipped", "warn"], [16, "silence", "bad"],
  [32, "stuck", "bad"], [64, "integrity", "bad"], [128, "warming up", "info"], [256, "dropped", "bad"], [512, "not gravity", "warn"],
  [1024, "roll undefined", "warn"], [2048, "switched", "info"], [4096, "axis left out", "warn"]];
const GATED = 1, NO_SAMPLE = 2 | 16, DROPPED = 256;
const COLUMNS = "t_us,x_lsb,y_lsb,z_lsb,x_mg,y_mg,z_mg,roll_cdeg,pitch_cdeg,flags".split(",");
const RANGES = { t_us: [0, 4294967295], x_lsb: [-4096, 4095], y_lsb: [-4096, 4095], z_lsb: [-4096, 4095],
  roll_cdeg: [-18000, 18000], pitch_cdeg: [-9000, 9000], flags: [0, 65535] };
const WRAP_US = 4294967296, LEARN = 9, APART = 3, SILENT_US = 100000, LEAP_US = 1e6,
  LONGEST_INTERVAL_US = 900e6 /* `every 10000` at 12.5 Hz: 800 s */, LONGEST_LINE = 4096, DEGREES = 180 / Math.PI,
  Z_TO_XY = 265 / 256; // sensitivities of a typical sensor at 3.3 V, for the raw angles

const stepUs = (before, after) => (after.t_us - before.t_us + WRAP_US) % WRAP_US; /* the counter has 32 bits */

/* Counts missing rows by the time between received rows. The interval is the third shortest of the first LEARN, so that gaps
   among them count too. While the sensor is silent, rows have other intervals: then only the flag counts. */
class Losses {
  constructor() { this.lost = 0; this.restart(); }

  restart() { this.last = null; this.period = 0; this.learning = []; this.run = 0; this.short = 0; }

  /* The board reports another interval for its rows; rows sent at that interval before the report were not gaps. */
  announced() { this.lost -= this.run; this.restart(); }

  /* Microseconds since the previous row, null without one. */
  row(t_us, flags) {
    const before = this.last;
    this.last = { t_us, flags };
    if (!before) return null;
    const dt = stepUs(before, { t_us }), dropped = (flags & DROPPED) !== 0;
    if ((flags | before.flags) & NO_SAMPLE) this.lost += dropped ? 1 : 0;
    else if (this.period) this.judge(dt, dropped);
    else this.learn(dt, dropped);
    return dt;
  }

  learn(dt, dropped) {
    this.learning.push([dt, dropped]);
    if (this.learning.length < LEARN) return;
    const seen = this.learning;
    this.learning = [];
    this.period = seen.map(([each]) => each).sort((a, b) => a - b)[LEARN >> 2];
    for (const [each, flagged] of seen) this.judge(each, flagged);
  }

  judge(dt, dropped) {
    const intervals = Math.max(1, Math.round(dt / this.period));
    const missing = dropped ? Math.max(1, intervals - 1) : intervals - 1;
    this.lost += missing;
    this.run = missing && !dropped ? this.run + missing : 0;
    const over = dt - intervals * this.period;
    if (Math.abs(over) < 0.3 * this.period) this.period += over / (32 * intervals);
    this.short = dt < 0.75 * this.period ? this.short + 1 : 0;
    if (this.short >= LEARN) { this.period = 0; this.short = 0; }
  }
}

class Protocol {
  /* on.row({t_us, s, apart, lsb or null, mg or null, rawRoll, roll, rawPitch, pitch, flags}), angles in degrees, s in seconds that never
     go back; on.note(text) for each comment line, without its #. */
  constructor(on) {
    Object.assign(this, { on, rows: 0, broken: 0, restarts: 0, suspect: null, s: 0, losses: new Losses(), arrived: 0, plotted: [], mode: "csv" });
    this.begin(true);
  }

  /* A new connection. whole: input starts at the beginning of a line; otherwise its first, partial line is dropped. */
  begin(whole) {
    this.rest = "";
    this.joined = whole;
    this.cut = true;
    this.setColumns(COLUMNS);
    this.restart();
  }

  /* No further row can confirm a held row. */
  release() {
    if (this.suspect) this.broken++;
    this.suspect = null;
  }

  restart() {
    this.release();
    this.losses.restart();
  }

  setColumns(names) {
    this.columns = names;
    this.at = Object.fromEntries(COLUMNS.map((name) => [name, names.indexOf(name)]));
  }

  feed(text, nowMs) {
    const lines = (this.rest + text).split("\n");
    this.rest = lines.pop();
    if (this.rest.length > LONGEST_LINE) this.rest = "";
    for (const line of lines) {
      const first = !this.joined;
      this.joined = true;
      if (!first || line.startsWith("#")) this.line(line.endsWith("\r") ? line.slice(0, -1) : line);
    }
    this.spread(nowMs);
  }

  line(line) {
    if (line === "") return;
    if (line[0] === "#") this.note(line.slice(1).trim());
    else if (/^roll_raw:/.test(line)) this.plotLine(line);
    else if (/^[a-z_]\w*(,[a-z_]\w*)+$/i.test(line)) this.header(line.split(","));
    else if (!this.row(line.split(","))) this.broken++;
  }

  header(names) {
    if (COLUMNS.every((name) => names.includes(name))) this.setColumns(names);
    else this.broken++;
    this.mode = "csv";
  }

  note(text) {
    if (/^tilt-uno /.test(text)) { this.cut = true; this.restart(); }
    else if (/^(rate|every|baud|mode) |^going|^stopped|^settings: /.test(text)) { this.release(); this.losses.announced(); }
    this.on.note(text);
  }

  row(fields) {
    if (fields.length !== this.columns.length || !fields.every((field) => /^-?\d{1,10}$/.test(field))) return false;
    const value = {};
    for (const name of COLUMNS) {
      value[name] = Number(fields[this.at[name]]);
      const range = RANGES[name];
      if (range && (value[name] < range[0] || value[name] > range[1])) return false;
    }
    this.weigh(value);
    return true;
  }

  /* A time far from the previous one is accepted if the next row continues from it: a long gap, or a step back, of a restarted
     board. Otherwise a digit was lost on the line. */
  weigh(value) {
    const held = this.suspect;
    this.suspect = null;
    if (held && !this.follows(this.losses.last, value) && this.follows(held, value)) {
      if (stepUs(this.losses.last, held) >= WRAP_US / 2) {
        this.losses.restart();
        this.restarts++;
      }
      this.take(held);
    } else if (held) this.broken++;
    if (!this.losses.last || this.follows(this.losses.last, value)) this.take(value);
    else this.suspect = value;
  }

  follows(before, value) {
    const step = stepUs(before, value), { period } = this.losses;
    return step > 0 && step <= (period ? Math.max(LEAP_US, APART * period) : LONGEST_INTERVAL_US);
  }

  take(value) {
    const before = this.losses.last, dt = this.losses.row(value.t_us, value.flags);
    const silent = (value.flags | (before ? before.flags : 0)) & NO_SAMPLE, usual = silent ? SILENT_US : this.losses.period || 10000;
    this.s += (dt === null ? usual : dt) / 1e6;
    const apart = this.cut || dt === null || dt > APART * usual;
    this.cut = false;
    this.mode = "csv";
    this.rows++;
    const { x_lsb: x, y_lsb: y, z_lsb: z } = value, up = z * Z_TO_XY;
    this.on.row({ t_us: value.t_us, s: this.s, apart, lsb: [x, y, z], mg: [value.x_mg, value.y_mg, value.z_mg], rawRoll: Math.atan2(y, up) * DEGREES,
      roll: value.roll_cdeg / 100, rawPitch: Math.atan2(-x, Math.hypot(y, up)) * DEGREES, pitch: value.pitch_cdeg / 100, flags: value.flags });
  }

  plotLine(line) {
    const value = {};
    for (const pair of line.split(",")) {
      const match = /^(\w+):(-?\d+(?:\.\d+)?)$/.exec(pair);
      if (match) value[match[1]] = Number(match[2]);
    }
    const wanted = ["roll_raw", "roll", "pitch_raw", "pitch", "gated"];
    if (wanted.some((name) => value[name] === undefined)) { this.broken++; return; }
    this.plotted.push({ lsb: null, mg: null, rawRoll: value.roll_raw, roll: value.roll, rawPitch: value.pitch_raw, pitch: value.pitch,
      flags: value.gated ? GATED : 0 });
  }

  /* Lines for a plotter have no time: those that arrive together get times of arrival, evenly spaced. */
  spread(nowMs) {
    const since = Math.min(1000, Math.max(1, nowMs - this.arrived)) / 1000;
    this.arrived = nowMs;
    const rows = this.plotted;
    if (!rows.length) return;
    if (this.mode !== "plot") { this.cut = true; this.restart(); }
    this.mode = "plot";
    this.plotted = [];
    for (const row of rows) {
      this.s += since / rows.length;
      this.rows++;
      this.on.row({ ...row, s: this.s, apart: this.cut });
      this.cut = false;
    }
  }
}
