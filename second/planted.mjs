// Faults planted in the firmware, in this sensor and in the first simulator's: the comparison must find each. And each look must find
// nothing where nothing is planted. second/second.mk builds the firmware and simrun with them.
import { basename, dirname } from 'node:path';

// in our own sensor
const SENSOR = {
  fifo_of_30: { broken: { capacity: 30 } },
  bytes_swapped: { broken: { bytesSwapped: true } },
  never_pops: { broken: { neverPops: true } },
  clock_off: { clockPpm: 30000 },
  selftest_of_no_force: { selfTest: [0, 0, 0] },
};

const rows = (more) => ({ kind: 'rows', filter: 'adaptive', rate: 100, stream: 'outliers-15pct', offset: 0, ms: 1500, ...more });
const fault = (name, more) => ({ kind: 'fault', fault: name, rate: 100, ...more });

// what each is looked for with, one after the other until it is found: runs that the sound ones pass
const LOOKS = [
  (more) => rows(more), (more) => rows({ rate: 400, ms: 400, ...more }), (more) => fault('int1_cut_500_ms', more),
  (more) => fault('starved_58_ms_800_hz', more), (more) => fault('power_lost_5_ms', more), (more) => fault('sda_low_30_ms', more),
  (more) => ({ kind: 'session', session: 'selftest_pass', ...more }),
];

// Look by look until one finds the planted fault. A run that fails (run throws), or that gives no rows, has found nothing: it says why.
export function lookThrough(looks, run) {
  for (const [n, look] of looks.entries()) {
    let result;
    try {
      result = run(look);
    } catch (error) {
      return { found: null, looks: n + 1, why: `look ${n + 1} did not run: ${error.message.split('\n')[0]}` };
    }
    if (result.rows === 0) return { found: null, looks: n + 1, why: `look ${n + 1} gave no rows: ${result.why}` };
    if (result.why !== null) return { found: result.why, looks: n + 1, why: null };
  }
  return { found: null, looks: looks.length, why: `none of ${looks.length} looks found it` };
}

// .../firmware/NAME/firmware.hex and .../simrun/NAME/simrun
const nameOf = (path) => basename(dirname(path));

// built: what make has built with a planted fault
export function plantedJobs(image, built) {
  const images = built.filter((path) => path.endsWith('.hex')), simruns = built.filter((path) => path.endsWith('/simrun'));
  if (!images.length || !simruns.length) throw new Error('no image or no simrun with a planted fault: run it by make second, which builds them');
  const of = (planted, more) => ({ check: 'planted', kind: 'planted', planted, looks: LOOKS.map((look) => look({ image, ...more })) });
  return [
    ...LOOKS.map((look) => ({ ...look({ image }), check: 'control' })),
    ...Object.entries(SENSOR).map(([name, sensor]) => of(`second: ${name}`, { sensor })),
    ...images.map((path) => of(`firmware: ${nameOf(path)}`, { image: path })),
    ...simruns.map((path) => of(`simrun: ${nameOf(path)}`, { simrun: path })),
  ];
}

export function judgePlanted(results) {
  const lines = [], failures = [];
  for (const [{ planted }, { found, looks, why }] of results.sort(([a], [b]) => (a.planted < b.planted ? -1 : 1))) {
    lines.push(`planted ${planted}: ${found ? `found by look ${looks}: ${found.slice(0, 160)}` : 'not found'}`);
    if (!found) failures.push(`FAIL planted ${planted}: ${why}`);
  }
  return { count: results.length, lines, failures };
}
