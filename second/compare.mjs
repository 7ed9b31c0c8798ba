// Rows against rows.
const FLAG_COASTED = 2, FLAG_FAULT = 16, FLAG_WARM = 128;
const OWN_FLAGS = 512 | 1024 | 4096; // said of the row's own angles
const WARM_ROWS = 5; // docs/protocol.md

const same = (a, b) => a.length === b.length && a.every((v, i) => v === b[i]);

// Every column but t_us, as far as the shorter of the two goes; `missing` rows have no counterpart, `first` is the first difference in words.
export function compareRows(mine, other) {
  const count = Math.min(mine.length, other.length);
  let different = 0, first = null, low = Infinity, high = -Infinity;
  for (let i = 0; i < count; i++) {
    if (!same(mine[i].slice(1), other[i].slice(1))) {
      different++;
      first ??= `row ${i}: ${mine[i]} and ${other[i]}`;
    }
    const shift = (mine[i][0] - other[i][0]) | 0;
    low = Math.min(low, shift);
    high = Math.max(high, shift);
  }
  return { rows: count, missing: Math.abs(mine.length - other.length), different, first, t_us_low: low, t_us_high: high };
}

// What the firmware sends of every `every`-th of these rows: its flags are those of all since the row before, but what is said of its own
// angles; five rows warm up, of those sent, predictions not counted
export function thinned(rows, every) {
  if (every === 1) return rows;
  const kept = [];
  let warm = 0;
  for (let i = every - 1; i < rows.length; i += every) {
    const before = rows.slice(i - every + 1, i).reduce((all, row) => all | row[9], 0) & ~OWN_FLAGS;
    const flags = (before | rows[i][9]) & ~FLAG_WARM;
    kept.push([...rows[i].slice(0, 9), flags | (warm < WARM_ROWS ? FLAG_WARM : 0)]);
    if (!(rows[i][9] & FLAG_COASTED)) warm++;
  }
  return kept;
}

// the rows before the first fault: after it the sensor is configured again, and which sample that meets depends on microseconds
export function beforeFault(rows) {
  const end = rows.findIndex((row) => row[9] & FLAG_FAULT);
  return end < 0 ? rows : rows.slice(0, end);
}

// The stamps of rows against the times at which their samples were measured [us]: how far they spread about a constant
export function stampSpread(rows, times) {
  let low = Infinity, high = -Infinity;
  for (let i = 0; i < Math.min(rows.length, times.length); i++) {
    const late = rows[i][0] - times[i];
    low = Math.min(low, late);
    high = Math.max(high, late);
  }
  return rows.length ? high - low : 0;
}

// Begin and end of a fault are noted by a pass of the main loop, which comes with Timer1's tick of 8.192 ms when nothing else wakes it:
// two runs whose clocks are microseconds apart may note each a tick apart.
export const PASSES_MS = 2 * 8.192 + 1;

// Words against words. Two clocks microseconds apart measure a rate to 0.02 %; the tolerances are granted to how long a fault was, to the
// samples that it cost, and to those read in one go after it.
export function compareWords(mine, other, toleranceMs = 0, toleranceLost = 0, toleranceDrained = 0) {
  const near = [[/after (\d+) ms/, toleranceMs], [/, (\d+) lost,/, toleranceLost], [/drained (\d+)/, toleranceDrained], [/measured ([\d.]+) Hz/, 0.2]];
  const apart = (a, b, [pattern, tolerance]) => Math.abs((a.match(pattern)?.[1] ?? 0) - (b.match(pattern)?.[1] ?? 0)) > tolerance;
  const plain = (text) => near.reduce((t, [pattern]) => t.replace(pattern, ''), text);
  for (let i = 0; i < Math.max(mine.length, other.length); i++) {
    const a = mine[i] ?? '', b = other[i] ?? '';
    if (plain(a) !== plain(b) || near.some((n) => apart(a, b, n))) return `"${a}" and "${b}"`;
  }
  return null;
}
