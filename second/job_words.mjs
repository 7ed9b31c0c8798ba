// The whole words of fault lines, at both addresses; and avr8js as it is, without our repair of its USART.
import { readFileSync } from 'node:fs';
import { rowsOf, notesOf } from './board.mjs';
import { boardOf } from './programs.mjs';
import { feedOf, readCsv } from './streams.mjs';

const hex = (value) => `0x${value.toString(16).toUpperCase().padStart(2, '0')}`;

// docs/faults.md's table of codes, as patterns: number -> words with 0x.. for what they name
export function faultWords() {
  const rows = readFileSync('docs/faults.md', 'utf8').matchAll(/^\| (\d+) \| ([^|]+?) \| \d \|/gm);
  return new Map([...rows].map(([, number, words]) => [Number(number), words]));
}

function expectedLine(number, values) {
  let next = 0;
  return `# fault ${number}: ${faultWords().get(number).replace(/0x\.\./g, () => hex(values[next++]))}`;
}

function identityAt(job, typedMs) {
  const board = boardOf({ image: job.image, feed: () => [0, 0, 256], sensor: { address: job.address, identity: 0xe6, ...job.sensor } });
  board.type(typedMs, 'status').run(700);
  return notesOf(board.output).filter((note) => note.startsWith('# fault')).join(' / ');
}

// A device of another identity at one address and nobody at the other; `status` typed at a moment of the start delays the words
export function runIdentity(job) {
  const wanted = expectedLine(2, [job.address, 0xe6]);
  const wrong = job.typedMs.map((ms) => [ms, identityAt(job, ms)]).filter(([, said]) => said !== wanted);
  const why = wrong.length ? `at ${wrong.length} of ${job.typedMs.length} moments: wanted "${wanted}", said "${wrong[0][1]}"` : null;
  return { rows: 0, different: 0, moments: job.typedMs.length, why };
}

// by the fault's number what befalls the sensor: its line must come, and the line of its end must name the address
const BEFALLS = {
  1: (b) => b.at(1000, () => { b.wires.unplugged = true; }).at(1500, () => { b.wires.unplugged = false; }),
  5: (b) => b.at(1000, () => b.cutInt1(true)).at(1500, () => b.cutInt1(false)),
  6: (b) => b.at(1000, () => b.sensor.powerOff()).at(1005, () => b.sensor.powerOn()),
  7: (b) => b.at(1000, () => b.wires.hold('scl', true)).at(1500, () => b.wires.hold('scl', false)),
  8: (b) => b.at(1000, () => b.wires.hold('sda', true)).at(1500, () => b.wires.hold('sda', false)),
};
export const WORDED_FAULTS = Object.keys(BEFALLS).map(Number);

export function runFaultWords(job) {
  const samples = readCsv('sim/streams/rest-2lsb.csv');
  const board = boardOf({ image: job.image, feed: feedOf(samples, Infinity), sensor: { address: job.address, ...job.sensor } });
  BEFALLS[job.fault](board);
  board.run(2200);
  const said = notesOf(board.output).filter((note) => note.startsWith('# fault'));
  const wanted = new RegExp(`^# fault ${job.fault} over: after \\d+ ms, \\d+ lost, sensor at ${hex(job.address)}$`);
  const right = said.length === 2 && said[0] === expectedLine(job.fault, []) && wanted.test(said[1]);
  return { rows: 0, different: 0, why: right ? null : `wanted fault ${job.fault} and its end at ${hex(job.address)}, said "${said.join(' / ')}"` };
}

// D1: whatever the simulator makes of a write of UCSR0A, the firmware sends its rows
export function runStockUsart(job) {
  const samples = readCsv('sim/streams/rest-2lsb.csv');
  const board = boardOf({ image: job.image, feed: feedOf(samples, Infinity), stock: ['usart'] });
  board.run(1200);
  const rows = rowsOf(board.output).length;
  return { rows, different: 0, why: rows >= 100 && board.resets === 0 ? null : `${rows} rows in 1.2 s and ${board.resets} watchdog resets` };
}
