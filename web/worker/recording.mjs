// A recording as the virtual sensor measures it: CSV as docs/protocol.md has it, a row for each tick of the sensor where the rates agree within
// 5 %, else the row in force; at its end it begins again.
import { varied } from '../../second/varied.mjs';

const COLUMNS = { t_us: ['t_us'], x: ['x', 'x_lsb'], y: ['y', 'y_lsb'], z: ['z', 'z_lsb'] };
const TRUTH = ['roll_true_cdeg', 'pitch_true_cdeg'];
const LEAST = -4096, MOST = 4095, WRAP_US = 2 ** 32, MISSING = 2 | 16, TOLERANCE = 0.05;

function columnsOf(names) {
  const at = Object.fromEntries(Object.entries(COLUMNS).map(([name, any]) => [name, names.findIndex((each) => any.includes(each))]));
  const absent = Object.keys(at).find((name) => at[name] < 0);
  if (absent) throw new Error(`missing column ${absent} (a header with t_us,x,y,z comes first): tilt import FILE converts other recordings`);
  const truth = TRUTH.map((name) => names.indexOf(name));
  return { ...at, count: names.length, flags: names.indexOf('flags'), truth: truth.includes(-1) ? null : truth };
}

function whole(text, name, least, most) {
  const hint = text.includes('.') ? ': tilt import FILE converts other units' : '';
  if (!/^-?\d{1,16}$/.test(text)) throw new Error(`${name} is not a whole number: '${text.slice(0, 40)}'${hint}`);
  const value = Number(text);
  if (value < least || value > most) throw new Error(`${name} is outside ${least}..${most}: ${value}`);
  return value;
}

class Reader {
  constructor() { Object.assign(this, { rows: [], columns: null, begins: true, shift: 0, raw: 0, step: 0 }); }

  line(text) {
    if (text === '' || text[0] === '#') return;
    const fields = text.split(',').map((field) => field.trim());
    if (!this.columns || fields.includes('t_us')) {
      this.columns = columnsOf(fields);
      this.begins = true;
    } else {
      this.row(fields);
    }
  }

  row(fields) {
    const { columns } = this;
    if (fields.length !== columns.count) throw new Error(`${fields.length} fields where the header has ${columns.count}`);
    const t = this.time(whole(fields[columns.t_us], 't_us', 0, 1e15));
    const lsb = ['x', 'y', 'z'].map((name) => whole(fields[columns[name]], name, LEAST, MOST));
    const truth = columns.truth?.map((at) => whole(fields[at], 'the truth', -18000, 18000) / 100) ?? null;
    const missing = columns.flags >= 0 && (whole(fields[columns.flags], 'flags', 0, 65535) & MISSING) !== 0;
    this.rows.push({ t, lsb, truth, missing });
  }

  // counted on over the wrap of a 32-bit counter; a repeated header begins a segment one step after the row before it
  time(raw) {
    const last = this.rows.at(-1);
    if (this.begins) {
      this.shift = last ? last.t + this.step - raw : -raw;
      this.begins = false;
    } else if (raw < this.raw) {
      if (this.raw - raw <= WRAP_US / 2) throw new Error(`time goes backwards: ${raw} after ${this.raw}`);
      this.shift += WRAP_US;
    } else {
      this.step = raw - this.raw;
    }
    this.raw = raw;
    return raw + this.shift;
  }
}

const median = (values) => values.sort((a, b) => a - b)[values.length >> 1];

// {rows, stepUs}; an error names the line
export function read(text) {
  const reader = new Reader(), lines = text.replace(/^\ufeff/, '').split('\n');
  lines.forEach((line, n) => {
    if (line.includes('\0')) throw new Error(`line ${n + 1}: a NUL byte: no text, or UTF-16, which tilt import FILE converts`);
    try { reader.line(line.trim()); } catch (error) { throw new Error(`line ${n + 1}: ${error.message}`); }
  });
  const { rows, columns } = reader;
  if (!columns) throw new Error(text.trim() === '' ? 'the file is empty' : 'no header');
  if (rows.length < 2) throw new Error('fewer than two rows after the header');
  return { rows, stepUs: Math.max(1, median(rows.slice(1).map((row, n) => row.t - rows[n].t))) };
}

export class Recording {
  constructor({ rows, stepUs }) {
    Object.assign(this, { rows, stepUs, at: -1, silent: 0, repeats: 0, began: null, period: 0 });
    this.varying = rows.map(({ t, lsb }) => [t, ...lsb]);
  }

  get truth() { return this.rows[Math.max(0, this.at)].truth; }

  next(nowUs, periodUs) {
    if (periodUs !== this.period) Object.assign(this, { period: periodUs, began: null, silent: 0 });
    if (Math.abs(periodUs / this.stepUs - 1) <= TOLERANCE) {
      if (this.silent > 0) { this.silent--; return null; }
      this.step();
      const after = this.rows[this.at + 1];
      if (after) this.silent = Math.max(0, Math.floor((after.t - this.rows[this.at].t) / this.stepUs + 0.5) - 1);
    } else {
      this.inForce(nowUs);
    }
    return this.rows[this.at].missing ? null : varied(this.varying, this.at, this.repeats);
  }

  step() {
    this.at = (this.at + 1) % this.rows.length;
    this.repeats = 0;
  }

  inForce(nowUs) {
    if (this.began === null) {
      this.step();
      this.began = nowUs - this.rows[this.at].t;
      return;
    }
    this.repeats++;
    const length = this.rows.at(-1).t + this.stepUs;
    if (nowUs - this.began >= length) {
      this.began += length * Math.floor((nowUs - this.began) / length);
      this.at = -1;
      this.step();
    }
    while (this.at + 1 < this.rows.length && this.rows[this.at + 1].t <= nowUs - this.began) this.step();
  }
}
