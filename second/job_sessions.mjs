// A person at the board: what is typed, and that both simulators' boards answer alike.
import { readFileSync, rmSync } from 'node:fs';
import { rowsOf, notesOf } from './board.mjs';
import { compareRows, compareWords } from './compare.mjs';
import { ROWS_AT_THE_END } from './job_rows.mjs';
import { OUT, boardOf, simrun } from './programs.mjs';
import { feedOf } from './streams.mjs';
import { MCUSR } from './uno.mjs';

const STREAM = 'sim/streams/rest-2lsb.csv';
const SET_UP_ROWS = 20; // what starts, changes of rate and words between them cost, of 100 rows a second
const SELFTEST_MS = 1400; // without rows (docs/protocol.md)
// `rows`: how many are due, at 100 Hz but where it says otherwise
// what a session says must hold these words, so that two boards that do nothing do not pass
// typed where no sample is due within 3 ms: a line that meets one to the microsecond is carried out before it or after it
const selfTest = (x, y, z, says) => (
  { part: `selftest=${x},${y},${z}`, selfTest: [x, y, z], script: [[503, 'selftest']], ms: 3500, rows: (3500 - SELFTEST_MS) / 10, says });

export const SESSIONS = {
  calibrate_tare_save_reset: {
    script: [[505, 'cal'], [4505, 'tare'], [8505, 'stop'], [8805, 'rate 200'], [8905, 'save'], [9505, 'go'],
      [12005, 'offset'], [12105, 'level'], [12205, 'settings']],
    // 8.5 s and 2.7 s, as rows are held behind settings: 200 Hz is more than 115200 baud takes, every second sample has a row
    resetAt: 10501.5, ms: 13000, rows: 1120, says: [/^# offset /, /^# level /, /^# saved/, /^# settings: as saved/, /rate 200 Hz/],
  },
  // the limits for 3.3 V (docs/protocol.md): x 88.5 to 955.8, y the same downwards, z 110.25 to 1286.25 LSB
  selftest_pass: selfTest(522, -522, 698, [/x .*: pass/, /y .*: pass/, /z .*: pass/]),
  selftest_low: selfTest(60, -60, 100, [/x .*: FAIL/, /y .*: FAIL/, /z .*: FAIL/]),
  selftest_high: selfTest(1000, -522, 698, [/x .*: high/, /y .*: pass/, /z .*: pass/]),
  selftest_reversed: selfTest(-522, 522, -698, [/x .*: FAIL/, /y .*: FAIL/, /z .*: FAIL/]),
  noise_and_odr: { ppm: 20000, script: [[1505, 'odr'], [2005, 'noise']], ms: 6000, rows: 6 * 102, says: [/^# odr 102\.0\d Hz/, /^# noise x /] },
  slow_sensor: { ppm: -40000, script: [[1505, 'odr']], ms: 3000, rows: 3 * 96, says: [/^# odr 96\.0\d Hz/] },
  typing: {
    script: [[505, 'help'], [3505, 'foo'], [3605, 'filter nosuch'], [3705, 'rate 13'], [3805, 'range 4'], [4205, 'axes -yxz'],
      [4305, 'every 3'], [4605, 'baud 250000'], [5005, 'mode plot'], [5505, 'mode csv']],
    // none for 2.1 s from help on, every third from 4.3 s on, and none of this form between `mode plot` and `mode csv`
    ms: 6500, rows: 430 - 210 + Math.floor((700 + 1000) / 30), says: [/^# refused 1: /, /^# refused 4: filter /, /^# range 4 g/, /^# every 3/, /^# baud 250000/, /^roll_raw:/],
  },
};

export function run(job) {
  const session = SESSIONS[job.session];
  const base = `${OUT}/run-${process.pid}`;
  rmSync(`${base}.eeprom`, { force: true }); // of the session before
  const options = ['--eeprom', `${base}.eeprom`, '--ppm', session.ppm ?? 0, '--loop'];
  if (session.part) options.push('--part', session.part);
  if (session.resetAt) options.push('--expect-resets', 1);
  const faults = session.resetAt ? [`${session.resetAt}ms:reset`] : [];
  const elf = job.image.replace('.hex', '.elf');
  const first = simrun(base, { elf, stream: STREAM, ms: session.ms, script: session.script, faults, options, simrun: job.simrun });
  const sensor = { selfTest: session.selfTest, clockPpm: session.ppm ?? 0, ...job.sensor };
  const board = boardOf({ image: job.image, feed: feedOf(first.served, 1000), sensor });
  for (const [at, line] of session.script) board.type(at, line);
  if (session.resetAt) board.at(session.resetAt, () => board.reset(MCUSR.external));
  board.run(session.ms);
  return judge(session, board, first, readFileSync(`${base}.eeprom`));
}

function judge(session, board, first, simCells) {
  const notes = notesOf(board.output);
  const rows = compareRows(rowsOf(board.output), rowsOf(first.lines));
  const words = compareWords(notes, notesOf(first.lines));
  const unsaid = session.says.find((pattern) => !notes.some((note) => pattern.test(note)));
  const cells = Buffer.compare(Buffer.from(board.uno.eepromCells.memory), simCells) !== 0;
  const why = words ? `words differ: ${words}` : rows.different ? `rows differ: ${rows.first}` :
    rows.missing > ROWS_AT_THE_END ? `${rows.missing} rows are missing` :
    rows.rows < session.rows - SET_UP_ROWS ? `only ${rows.rows} rows, ${session.rows} are due` :
    unsaid ? `nobody said ${unsaid}` : cells ? 'the EEPROMs differ' : null;
  return { rows: rows.rows, different: rows.different, why };
}
