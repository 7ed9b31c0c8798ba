// What `make second` runs, and which part of it CI does.
import { readFileSync } from 'node:fs';
import { FAULTS } from './job_faults.mjs';
import { READINGS, EVENTS } from './job_readings.mjs';
import { GO_MS } from './job_rows.mjs';
import { SESSIONS } from './job_sessions.mjs';
import { WORDED_FAULTS } from './job_words.mjs';
import { readCsv, streamNames, STREAMS } from './streams.mjs';

const RATES = [100, 400, 800];
const LEAST_MS = { 100: 3500, 400: 700, 800: 600 };
const ADDRESSES = [0x53, 0x1d];
const SPARE_ROWS = 20; // of a stream that a run does not come to
const SEAM_ROWS = 5; // that two neighbours share: two are on their way when a run ends, two go by before the first after `go`, one is rounded off
const PHASES = 50, PHASES_CI = 5, PHASES_UNTIL_MS = 60;

const imageOf = (set, everyday) => (set === everyday ? 'build/uno/firmware.hex' : `build/uno/${set}/firmware.hex`);
const filtersOf = (image) => readFileSync(image.replace('firmware.hex', 'filters.txt'), 'utf8').trim().split(/\s+/);

// sets: the names of mk/images.mk's FILTER_SETS, the first is the shipped one
export function imagesOf(sets) {
  return sets.map((set) => { const image = imageOf(set, sets[0]); return { set, image, filters: filtersOf(image) }; });
}

// A run over `all` rows of a stream, the p-th of so many pairs of image and filter: where its piece begins, and how long it lasts after `go`.
// A step from one pair's piece to the next is as long as a run or shorter.
export function pieceOf(all, rate, p, pairs) {
  const before = GO_MS / 1000 * rate;
  const ms = Math.max(LEAST_MS[rate], Math.ceil(((all - before - SPARE_ROWS) / pairs + SEAM_ROWS) * 1000 / rate));
  const spare = all - before - Math.ceil(ms / 1000 * rate) - SPARE_ROWS;
  return { offset: Math.floor(spare * p / (pairs - 1)), ms };
}

// Every filter of every image over every stream at every rate. The pieces differ from filter to filter: together they cover a stream, but for
// its first half second and last 20 rows. (Less where a filter refuses the rate, or the stream has gaps: whole-stream sees those at 100 Hz.)
function rowJobs(images) {
  const pairs = images.flatMap(({ image, filters }) => filters.map((filter) => ({ image, filter })));
  return pairs.flatMap((pair, p) => streamNames().flatMap((stream, s) => RATES.map((rate, r) => {
    const piece = pieceOf(readCsv(`${STREAMS}/${stream}.csv`).length, rate, p, pairs.length);
    return { check: 'rows', kind: 'rows', ...pair, rate, stream, ...piece, turn: p + s + r };
  })));
}

const wholeJobs = (image) => streamNames().filter((s) => s !== 'tilt-400hz').map((stream) => (
  { check: 'whole-stream', kind: 'whole', image, rate: 100, stream, ms: Math.round(readCsv(`${STREAMS}/${stream}.csv`).at(-1)[0] / 1000) }));

const faultJobs = (image) => Object.keys(FAULTS).map((fault) => (
  { check: 'fault', kind: 'fault', image, fault, rate: FAULTS[fault].rate ?? 100 }));
const sessionJobs = (image) => Object.keys(SESSIONS).map((session) => ({ check: 'session', kind: 'session', image, session, rate: 100 }));

const readingJobs = (image) => Object.keys(READINGS).flatMap((reading, r) => Object.keys(EVENTS).flatMap((event, e) => [100, 400].map((rate, k) => (
  { check: 'reading', kind: 'reading', image, reading, event, rate, turn: r + e + k }))));

const identityJobs = (images, phases) => images.flatMap(({ image }) => ADDRESSES.map((address) => (
  { check: 'fault-2-words', kind: 'identity', image, address,
    typedMs: Array.from({ length: phases }, (_, k) => k * PHASES_UNTIL_MS / phases) })));

const wordsJobs = (image) => ADDRESSES.flatMap((address) => WORDED_FAULTS.map((fault) => ({ check: 'fault-words', kind: 'fault-words', image, address, fault })));

const stockJobs = (images) => images.map(({ image }) => ({ check: 'stock-usart', kind: 'stock-usart', image }));

// CI: one of so many turns, another one with each commit
const CI_SHARE = { rows: 6, reading: 4 };

export const CHECKS = ['rows', 'whole-stream', 'fault', 'session', 'reading', 'fault-words', 'stock-usart', 'fault-2-words', 'planted'];
export const PARTS = ['ci'];

// ONLY's names, all of them if it is empty; names that there are not are an error that lists the others
export function asked(part = '', only = '') {
  if (part && !PARTS.includes(part)) throw new Error(`PART=${part}: there is no such part; leave it out, or PART=${PARTS.join(', ')}`);
  const names = only.split(/[\s,]+/).filter(Boolean);
  const unknown = names.filter((name) => !CHECKS.includes(name));
  if (unknown.length || (only && !names.length)) throw new Error(`ONLY=${only}: no check is called ${unknown.join(', ') || only}; there are ${CHECKS.join(', ')}`);
  return names.length ? names : CHECKS;
}

// only: names of checks
export function planOf(images, part, turn = 0, only = CHECKS) {
  const shipped = images[0].image;
  const all = [...rowJobs(images), ...wholeJobs(shipped), ...faultJobs(shipped), ...sessionJobs(shipped), ...readingJobs(shipped),
    ...wordsJobs(shipped), ...stockJobs(images), ...identityJobs(images, part === 'ci' ? PHASES_CI : PHASES)];
  const wanted = all.filter((job) => only.includes(job.check));
  if (part !== 'ci') return wanted;
  return wanted.filter((job) => job.check !== 'whole-stream' && (!CI_SHARE[job.check] || (job.turn + turn) % CI_SHARE[job.check] === 0));
}
