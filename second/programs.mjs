// The project's own programs: simrun (the first simulator) and pipeline_replay, native_replay (the PC).
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { rowsOf } from './board.mjs';
import { readCsv } from './streams.mjs';

export const OUT = 'build/second';
const SIMRUN = process.env.SECOND_SIMRUN ?? 'build/sim/simrun';

function output(program, args) {
  try {
    return execFileSync(program, args.map(String), { encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'], maxBuffer: 1 << 28 });
  } catch (error) {
    throw new Error(`${program} ${args.join(' ')}: ${typeof error.status !== 'number' ? error.message : `status ${error.status}: ${error.stderr.trim()}`}`);
  }
}

// A row that is measured again, because the sensor runs faster than the stream, has noise of its own: as feed_vary in sim/model/feed.h
function varied(rows, row, repeats) {
  const atRail = (lsb) => [512, 1024, 2048, 4096].includes(lsb < 0 ? -lsb : lsb + 1);
  const off = (all) => all.every((lsb) => lsb === -1);
  const readings = rows[row].slice(1);
  if (repeats === 0 || off(readings)) return readings;
  const turn = repeats + row + 1;
  for (const axis of [turn % 3, (turn + 1) % 3, (turn + 2) % 3]) {
    const lately = rows.slice(Math.max(0, row - 10), row + 1).map((each) => each[axis + 1]);
    const now = readings.map((lsb, i) => (i === axis ? lsb + (turn % 2 === 0 ? 1 : -1) : lsb));
    if (lately.some((lsb) => lsb !== lately[0]) && !atRail(readings[axis]) && !atRail(now[axis]) && !off(now)) return now;
  }
  return readings;
}

// When the first simulator's sensor measured, and which row of the stream: [t_us, x, y, z] with the stream's own readings, so that
// what its model makes of them stays its own affair
function servedOf(path, stream) {
  const rows = readCsv(stream);
  const [header, ...lines] = readFileSync(path, 'utf8').trim().split('\n');
  const at = header.split(',').indexOf('row'), t = header.split(',').indexOf('t_us');
  let before = -1, repeats = 0;
  return lines.map((line) => line.split(',')).map((fields) => {
    const row = Number(fields[at]);
    repeats = row === before ? repeats + 1 : 0;
    before = row;
    return [Number(fields[t]), ...varied(rows, row, repeats)];
  });
}

// script: [ms, line] typed; faults: WHEN:KIND as simrun takes them. {lines, served: [t_us, x, y, z]}
export function simrun(base, { elf, stream, ms, script = [], faults = [], options = [], simrun = SIMRUN }) {
  const args = ['--fw', elf, '--in', stream, '--out', `${base}.sim.csv`, '--served', `${base}.served.csv`, '--max-ms', ms, ...options];
  for (const [at, line] of script) args.push('--cmd', `${at}:${line}`);
  for (const fault of faults) args.push('--fault', fault);
  output(simrun, args);
  return { lines: readFileSync(`${base}.sim.csv`, 'latin1').split('\n').slice(0, -1), served: servedOf(`${base}.served.csv`, stream) };
}

// what the PC makes of these samples from a cold start on
export function pipeline(csv, filter, rate, range = 16) {
  return rowsOf(output('build/host/pipeline_replay', [csv, filter, rate * 10, range, 0]).split('\n'));
}

// the whole firmware on the PC
export function native(base, { stream, ms, script }) {
  const typed = script.flatMap(([at, line]) => ['--cmd', `${at}:${line}`]);
  output('build/host/native_replay', ['--in', stream, '--out', `${base}.native.csv`, '--max-ms', ms, ...typed]);
  return readFileSync(`${base}.native.csv`, 'latin1').split('\n');
}
