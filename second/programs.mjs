// The project's own programs: simrun (the first simulator) and pipeline_replay, native_replay (the PC).
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { Board, rowsOf } from './board.mjs';
import { readCsv } from './streams.mjs';
import { varied } from './varied.mjs';

export const OUT = 'build/second';
const SIMRUN = process.env.SECOND_SIMRUN ?? 'build/sim/simrun';

function output(program, args) {
  try {
    return execFileSync(program, args.map(String), { encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'], maxBuffer: 1 << 28 });
  } catch (error) {
    throw new Error(`${program} ${args.join(' ')}: ${typeof error.status !== 'number' ? error.message : `status ${error.status}: ${error.stderr.trim()}`}`);
  }
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

function loadHex(text) {
  const program = new Uint16Array(0x4000);
  const bytes = new Uint8Array(program.buffer);
  for (const line of text.split('\n').filter((l) => l[0] === ':')) {
    const record = Buffer.from(line.trim().slice(1), 'hex');
    if (record[3] === 0) record.copy(bytes, record.readUInt16BE(1), 4, 4 + record[0]);
  }
  return program;
}

// a board that runs this image (Intel hex)
export const boardOf = ({ image, ...rest }) => new Board({ ...rest, program: loadHex(readFileSync(image, 'utf8')) });

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
