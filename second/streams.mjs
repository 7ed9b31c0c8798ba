// The shipped streams as tables, and pieces of them at another rate: what both simulators measure.
import { readFileSync, writeFileSync, readdirSync } from 'node:fs';

export const STREAMS = 'sim/streams';

export const streamNames = () => readdirSync(STREAMS).filter((f) => f.endsWith('.csv')).map((f) => f.slice(0, -4)).sort();

// [t_us, x, y, z] of each row of a CSV whose header names them
export function readCsv(path) {
  const lines = readFileSync(path, 'utf8').split('\n').filter((l) => l && l[0] !== '#');
  const names = lines[0].split(',');
  const columns = [['t_us'], ['x', 'x_lsb'], ['y', 'y_lsb'], ['z', 'z_lsb']].map((wanted) => names.findIndex((n) => wanted.includes(n)));
  if (columns.includes(-1)) throw new Error(`${path}: the header ${lines[0]} lacks t_us, x, y or z`);
  return lines.slice(1).map((line) => { const fields = line.split(',').map(Number); return columns.map((c) => fields[c]); });
}

const gapless = (name) => !name.includes('gaps');

// `count` rows from `offset` on, written to `path`; at another rate than the stream's own they come closer together or further apart
export function writePiece(path, name, { rate, offset, count }) {
  const rows = readCsv(`${STREAMS}/${name}.csv`).slice(offset, offset + count);
  const began = rows[0][0];
  const keepTimes = rate === 100 && !gapless(name); // its missing samples are what it is for
  const lines = rows.map(([t, ...lsb], k) => [keepTimes ? t - began : Math.round(k * 1e6 / rate), ...lsb].join());
  writeFileSync(path, `t_us,x,y,z\n${lines.join('\n')}\n`);
}

// A sensor's world: the samples [t_us, x, y, z] in order, each at the tick that comes nearest to its time; between them there is none
export function feedOf(samples, slackUs) {
  let next = 0;
  return (cycle) => (next < samples.length && samples[next][0] <= cycle / 16 + slackUs ? samples[next++].slice(1) : null);
}
