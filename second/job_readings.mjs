// What the data sheet leaves open, both ways: whichever part it is, no row is wrong or comes twice.
import { AS_BUILT } from './adxl345.mjs';
import { rowsOf, notesOf } from './board.mjs';
import { boardOf } from './programs.mjs';

// each is another answer than AS_BUILT's (adxl345.mjs quotes the text)
export const READINGS = {
  as_built: {},
  fifo_of_32: { capacity: 32 },
  status_without_output_register: { entries: 'without-output', stampsMs: 8 },
  status_of_at_most_32: { entries: 'at-most-32' },
  overrun_at_first_loss: { overrun: 'first-loss' },
  overrun_never: { overrun: 'never' },
  source_read_clears_pin: { sourceReadClears: 'pin' },
  source_read_clears_overrun: { sourceReadClears: 'overrun' },
  pop_takes_5_us: { popTakesUs: 5 },
  pin_low_for_5_us_after_pop: { pinLowAfterPopUs: 5 },
  empty_reads_zero: { emptyReads: 'zero' },
  no_watermark_of_zero: { watermarkOfZero: false },
  no_turn_on_time: { turnOnMs: null },
  bypass_keeps_fifo: { bypassClears: false, stampsMs: 8 },
  bypass_again_keeps_sample: { bypassAgainClears: false },
  leaving_bypass_drops_sample: { leavingBypassKeeps: false },
  torn_bursts: { burst: 'torn' },
  reserved_bits_kept: { reservedKept: true },
  reserved_bits_read_one: { reservedRead: 1, mayFault: 4 },
  rate_from_the_next_sample: { rateChangeAtOnce: false },
};

const cut = (ms) => (b, at) => b.at(at, () => b.cutInt1(true)).at(at + ms, () => b.cutInt1(false));
export const EVENTS = {
  nothing: () => {},
  int1_cut_25_ms: cut(25),
  int1_cut_500_ms: cut(500),
  bus_held_30_ms: (b, at) => b.at(at, () => b.wires.hold('scl', true)).at(at + 30, () => b.wires.hold('scl', false)),
};

const STAMP_US = 50; // about their median, as for any row
const SILENT_US = 1500; // while INT1 is silent the firmware asks the sensor each 1.2 ms (seen on the bus), and a read takes 0.3 ms
const EVENT_MS = 1201.5, END_MS = 2200, WARM_MS = 600;
const NOT_A_SAMPLE = 2 | 16;
const UNHEARD_MS = { bus_held_30_ms: 30 }; // no sample can be read; a cut INT1 is found out, and then the sensor is asked
const SET_UP_MS = 50; // until a fault is found, and until the sensor is set up again
const leastRows = (event, rate) => Math.floor((END_MS - WARM_MS - (UNHEARD_MS[event] ?? 0) - SET_UP_MS) * rate / 1000);

// 61, 59 and 53 have no common factor: no two of 190,747 samples are equal
const unique = () => { let n = 0; return () => { n++; return [(n % 61) - 30, ((n * 7) % 59) - 29, 256 + (n % 53) - 26]; }; };

export function run(job) {
  const { stampsMs = 0, mayFault = null, ...reading } = { ...READINGS[job.reading] };
  for (const key of Object.keys(reading)) if (!(key in AS_BUILT)) throw new Error(`${job.reading}: no reading is called ${key}`);
  const board = boardOf({ image: job.image, feed: unique(), sensor: { reading, ...job.sensor } });
  if (job.rate !== 100) board.type(200, 'stop').type(300, 'baud 500000').type(400, `rate ${job.rate}`).type(500, 'go');
  EVENTS[job.event](board, EVENT_MS);
  board.run(END_MS);
  return judge(board, job, { stampsMs, mayFault });
}

function compare(rows, served) {
  const measured = new Map(served.map(([at, lsb]) => [lsb.join(), at / 16]));
  const shown = new Set();
  const found = { wrong: 0, twice: 0, late: [] };
  for (const row of rows) {
    const key = row.slice(1, 4).join();
    if (!measured.has(key)) { found.wrong++; continue; }
    if (shown.has(key)) found.twice++;
    shown.add(key);
    found.late.push(row[0] - measured.get(key));
  }
  return found;
}

// how far stamps are off, and how many stretches of rows are further off than the limit
function stamps(late, limit) {
  const median = [...late].sort((a, b) => a - b)[late.length >> 1];
  const off = late.map((l) => Math.abs(l - median));
  const stretches = off.filter((o, i) => o > limit && !(off[i - 1] > limit)).length;
  return { worst: Math.round(Math.max(0, ...off)), stretches };
}

function judge(board, { event, rate }, { stampsMs, mayFault }) {
  const rows = rowsOf(board.output).filter((row) => row[0] > WARM_MS * 1000 && !(row[9] & NOT_A_SAMPLE));
  const faults = notesOf(board.output).filter((note) => note.startsWith('# fault'));
  const refused = mayFault !== null && rows.length === 0 && faults.some((f) => f.startsWith(`# fault ${mayFault}:`));
  if (refused) return { rows: 0, different: 0, fault: mayFault, why: null };
  const { wrong, twice, late } = compare(rows, board.sensor.served);
  const limit = event === 'nothing' ? STAMP_US : SILENT_US;
  const { worst, stretches } = stamps(late, limit);
  const least = leastRows(event, rate);
  const why = rows.length < least ? `only ${rows.length} rows, ${least} are due` : wrong ? `${wrong} wrong rows` : twice ? `${twice} rows twice` :
    worst > Math.max(limit, stampsMs * 1000) ? `a stamp is ${worst} us off` : stretches > 1 ? `stamps are off ${stretches} times` : null;
  return { rows: rows.length, different: wrong + twice, worst_stamp_us: worst, stretches, faults: faults.length, why };
}
