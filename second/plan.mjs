// What `make second` runs, and which part of it CI does.
import { readFileSync } from 'node:fs';
import { FAULTS } from './job_faults.mjs';
import { READINGS, EVENTS } from './job_readings.mjs';
import { SESSIONS } from './job_sessions.mjs';
import { TOLD_FAULTS } from './job_words.mjs';
import { readCsv, streamNames, STREAMS } from './streams.mjs';

const RATES = [100, 400, 800];
const RUN_MS = { 100: 3500, 400: 700, 800: 600 };
const ADDRESSES = [0x53, 0x1d];
const FIRST_MS = 500; // of each run, at 100 Hz until `go`
const PHASES = 50, PHASES_CI = 5, PHASES_UNTIL_MS = 60;

const imageOf = (set, everyday) => (set === everyday ? 'build/uno/firmware.hex' : `build/uno/${set}/firmware.hex`);
const filtersOf = (image) => readFileSync(image.replace('firmware.hex', 'filters.txt'), 'utf8').trim().split(/\s+/);

// sets: the names of mk/images.mk's FILTER_SETS, the first is the shipped one
export function imagesOf(sets) {
  return sets.map((set) => { const image = imageOf(set, sets[0]); return { set, image, filters: filtersOf(image) }; });
}

// Every filter of every image over every stream at every rate; the filters begin at different rows, together they see the whole of it
function rowJobs(images) {
  const pairs = images.flatMap(({ image, filters }) => filters.map((filter) => ({ image, filter })));
  return pairs.flatMap((pair, p) => streamNames().flatMap((stream, s) => RATES.map((rate, r) => {
    const need = Math.ceil((FIRST_MS + RUN_MS[rate]) / 1000 * rate) + 20;
    const spare = readCsv(`${STREAMS}/${stream}.csv`).length - need;
    return { check: 'rows', kind: 'rows', ...pair, rate, stream, offset: Math.floor(spare * p / (pairs.length - 1)), ms: RUN_MS[rate], turn: p + s + r };
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

const toldJobs = (image) => ADDRESSES.flatMap((address) => TOLD_FAULTS.map((fault) => ({ check: 'fault-words', kind: 'told', image, address, fault })));

const stockJobs = (images) => images.map(({ image }) => ({ check: 'stock-usart', kind: 'stock-usart', image }));

// CI: one of so many turns, another one with each commit
const CI_SHARE = { rows: 6, reading: 4 };

// only: names of checks, with commas between them
export function planOf(images, part, turn = 0, only = '') {
  const shipped = images[0].image;
  const all = [...rowJobs(images), ...wholeJobs(shipped), ...faultJobs(shipped), ...sessionJobs(shipped), ...readingJobs(shipped),
    ...toldJobs(shipped), ...stockJobs(images), ...identityJobs(images, part === 'ci' ? PHASES_CI : PHASES)];
  const wanted = only ? all.filter((job) => only.split(',').includes(job.check)) : all;
  if (part !== 'ci') return wanted;
  return wanted.filter((job) => job.check !== 'whole-stream' && (!CI_SHARE[job.check] || (job.turn + turn) % CI_SHARE[job.check] === 0));
}
