// One run: an image, a filter, a rate, a piece of a stream. The same samples and typed lines in avr8js, in simrun and on the PC.
import { writeFileSync } from 'node:fs';
import { rowsOf, notesOf } from './board.mjs';
import { PASSES_MS, compareRows, compareWords, thinned, beforeFault, stampSpread } from './compare.mjs';
import { OUT, boardOf, simrun, pipeline, native } from './programs.mjs';
import { feedOf, readCsv, writePiece } from './streams.mjs';

export const GO_MS = 500;
const STAMP_SPREAD_US = 100; // of t_us about the sensor's own time: +-50 us, as the first simulator's tests grant
const FLAG_DISOWNED = 64, FLAG_ROLL_UNDEFINED = 1024;
// after a long gap the sensor is configured again, and which of its irregular samples that meets depends on microseconds
const GAP = [PASSES_MS, 1];
export const ROWS_AT_THE_END = 2; // on their way when the time is over

function scriptOf({ filter, rate }) {
  const faster = rate === 100 ? [] : [[300, `baud ${rate === 400 ? 500000 : 1000000}`], [400, `rate ${rate}`]];
  return [[200, 'stop'], ...faster, [450, `filter ${filter}`], [GO_MS, 'go']];
}

// what is in force in the end, as the firmware says: a filter too slow for a rate is refused
function inForce(notes, image) {
  const last = (pattern) => notes.map((n) => n.match(pattern)?.[1]).filter(Boolean).at(-1);
  return { every: Number(last(/^# every (\d+)/) ?? 1), rate: Number(last(/^# rate ([\d.]+) Hz/) ?? 100), filter: last(/^# filter (\w+)/) ?? image };
}

// three times -1 is what a bus reads that nobody drives: the driver takes it for no sample, the sample path never sees it
const isDead = ([, x, y, z]) => x === -1 && y === -1 && z === -1;

function onThePc(base, samples, { filter, rate, every }) {
  const csv = `${base}.pc.csv`;
  writeFileSync(csv, `t_us,x,y,z\n${samples.filter((s) => !isDead(s)).map((s) => s.join()).join('\n')}\n`);
  return thinned(pipeline(csv, filter, rate), every);
}

// Of the chip's rows what the PC's sample path can know: not the driver's flag; nor a roll that is held, before one is defined or where
// only the rows sent hold it
function compareWithPc(chip, pc, every) {
  const held = (row) => (row[9] & FLAG_ROLL_UNDEFINED) !== 0;
  const defined = pc.findIndex((row) => !held(row));
  const early = defined < 0 ? pc.length : defined;
  const unknown = pc.map((row, i) => i < early || (every > 1 && (held(row) || (i < chip.length && held(chip[i])))));
  const known = (row, i) => [...row.slice(0, 7), unknown[i] ? 0 : row[7], row[8],
    row[9] & ~FLAG_DISOWNED & ~(unknown[i] ? FLAG_ROLL_UNDEFINED : 0)];
  return compareRows(chip.map(known), pc.map(known));
}

const afterGo = (rows) => rows.filter((r) => r[0] >= GO_MS * 1000);

function judged({ sim, pc, words, missing, spread }) {
  if (sim.different) return `simrun's rows differ: ${sim.first}`;
  if (pc.different) return `the PC's rows differ: ${pc.first}`;
  if (missing) return `${missing} rows are missing`;
  if (sim.rows === 0 || pc.rows === 0) return 'no rows to compare';
  if (words) return `simrun's words differ: ${words}`;
  return spread > STAMP_SPREAD_US ? `t_us wanders by ${spread} us about the sensor's time` : null;
}

export function run(job) {
  const base = `${OUT}/run-${process.pid}`;
  const ms = GO_MS + job.ms;
  writePiece(`${base}.csv`, job.stream, { rate: job.rate, offset: job.offset, count: Math.ceil(ms / 1000 * job.rate) + 20 });
  const script = scriptOf(job);
  const first = simrun(base, { elf: job.image.replace('.hex', '.elf'), stream: `${base}.csv`, ms, script, simrun: job.simrun });
  const board = boardOf({ image: job.image, feed: feedOf(first.served, 0.4e6 / job.rate), sensor: job.sensor });
  for (const [at, line] of script) board.type(at, line);
  board.run(ms);
  const rows = rowsOf(board.output), notes = notesOf(board.output);
  const simRows = rowsOf(first.lines);
  const gaps = job.stream.includes('gaps') && job.rate === 100; // the sensor is configured again after a long one
  const force = inForce(notes, job.filter);
  const pc = compareWithPc(beforeFault(afterGo(rows)), onThePc(base, afterGo(first.served), force), force.every);
  const measured = board.sensor.served.map(([at]) => at / 16).filter((t) => t >= GO_MS * 1000);
  const spread = gaps ? 0 : Math.round(stampSpread(afterGo(rows), measured.filter((_, i) => i % force.every === force.every - 1)));
  const sim = compareRows(rows, simRows);
  const words = compareWords(notes, notesOf(first.lines), ...(gaps ? GAP : []));
  const missing = Math.max(0, sim.missing - ROWS_AT_THE_END);
  return { rows: sim.rows, different: sim.different, pc_rows: pc.rows, pc_different: pc.different, every: force.every, rate_in_force: force.rate,
    t_us_low: sim.t_us_low, t_us_high: sim.t_us_high, stamp_spread_us: spread, why: judged({ sim, pc, words, missing, spread }) };
}

// A whole stream at 100 Hz from power-on, nothing typed: also against the whole firmware on the PC
export function runWhole(job) {
  const base = `${OUT}/run-${process.pid}`;
  const stream = `sim/streams/${job.stream}.csv`;
  const first = simrun(base, { elf: job.image.replace('.hex', '.elf'), stream, ms: job.ms });
  const board = boardOf({ image: job.image, feed: feedOf(first.served, 4000) });
  board.run(job.ms);
  const rows = rowsOf(board.output);
  const count = job.stream.includes('gaps') ? beforeFault(rows).length : readCsv(stream).length;
  const pcLines = native(base, { stream, ms: job.ms, script: [] });
  const pc = compareRows(rows.slice(0, count), rowsOf(pcLines).slice(0, count));
  const sim = compareRows(rows, rowsOf(first.lines));
  const missing = Math.max(0, sim.missing - ROWS_AT_THE_END);
  const words = compareWords(notesOf(board.output), notesOf(first.lines), ...(job.stream.includes('gaps') ? GAP : []));
  return { rows: sim.rows, different: sim.different, pc_rows: pc.rows, pc_different: pc.different, t_us_low: sim.t_us_low, t_us_high: sim.t_us_high,
    cpu_load: Math.round(board.load * 1e4) / 1e4, why: judged({ sim, pc, words, missing, spread: 0 }) };
}
