// The pure functions of second/, by node's own test runner: what each must say, and what it must not pass.
import assert from 'node:assert/strict';
import test from 'node:test';
import { compareRows, compareWords, stampSpread, thinned } from './compare.mjs';
import { leastRows, FAULTS } from './job_faults.mjs';
import { asked, pieceOf, CHECKS } from './plan.mjs';
import { lookThrough } from './planted.mjs';

// flags are column 9; the others do not matter here
const row = (t, x, flags = 0) => [t, x, 0, 256, 0, 0, 1000, 0, 0, flags];

test('compareRows: equal rows; a changed value, a missing row and a shifted stamp show', () => {
  const rows = [row(0, 1), row(10, 2), row(20, 3)];
  assert.deepEqual(compareRows(rows, rows), { rows: 3, missing: 0, different: 0, first: null, t_us_low: 0, t_us_high: 0 });
  assert.equal(compareRows(rows, [row(0, 1), row(10, 9), row(20, 3)]).different, 1);
  assert.equal(compareRows(rows, rows.slice(0, 1)).missing, 2);
  assert.equal(compareRows(rows, rows.map((r) => [r[0] - 5, ...r.slice(1)])).t_us_high, 5);
});

test('thinned: every third row, with the flags of all since the row before; five warm up, predictions not counted', () => {
  const rows = Array.from({ length: 24 }, (_, i) => row(i, i, i === 3 ? 64 : i === 5 ? 2 : 0));
  const kept = thinned(rows, 3);
  assert.deepEqual(kept.map((r) => r[1]), [2, 5, 8, 11, 14, 17, 20, 23]);
  assert.deepEqual(kept.map((r) => r[9]), [128, 128 | 64 | 2, 128, 128, 128, 128, 0, 0]); // the second is a prediction: a sixth warms up
  assert.equal(thinned(rows, 1), rows);
  const own = [[1, 512], [2, 1], [3, 1024], [4, 512]].map(([t, flags]) => [t, 0, 0, 0, 0, 0, 0, 0, 0, flags]);
  assert.deepEqual(thinned(own, 2).map((r) => r[9] & ~128), [1, 512]);
  assert.notDeepEqual(thinned(rows, 2).map((r) => r[1]), kept.map((r) => r[1]));
});

test('stampSpread: 0 about any constant, else how far it wanders', () => {
  assert.equal(stampSpread([row(105, 0), row(205, 0)], [100, 200]), 0);
  assert.equal(stampSpread([row(105, 0), row(203, 0), row(309, 0)], [100, 200, 300]), 6);
});

test('compareWords: a tolerance holds for its own number and no other', () => {
  const over = (ms, lost) => [`# fault 8 over: after ${ms} ms, ${lost} lost, sensor at 0x53`];
  assert.equal(compareWords(over(30, 3), over(40, 3), 17), null);
  assert.equal(compareWords(['measured 100.1 Hz'], ['measured 100.2 Hz']), null);
  for (const other of [over(50, 3), over(40, 4), [], [...over(30, 3), '# more'], ['# fault 7 over: after 30 ms, 3 lost, sensor at 0x53']]) {
    assert.notEqual(compareWords(over(30, 3), other, 17), null);
  }
  assert.notEqual(compareWords(['measured 100.1 Hz'], ['measured 100.4 Hz']), null);
});

// the first row that no pair's run compares, from the half second before `go` on
function firstHole(all, rate, pairs, shorterMs = 0) {
  let seen = rate / 2;
  for (let p = 0; p < pairs; p++) {
    const { offset, ms } = pieceOf(all, rate, p, pairs);
    if (offset + rate / 2 > seen) return seen;
    seen = offset + rate / 2 + Math.floor((ms - shorterMs) * rate / 1000);
  }
  return seen;
}

test('pieceOf: together the runs see a stream but for its last 20 rows; runs a quarter shorter would not', () => {
  for (const rate of [100, 400, 800]) for (const all of [1500, 4000, 6000]) for (const pairs of [8, 15]) {
    const seen = firstHole(all, rate, pairs);
    assert.ok(seen >= all - 21 && seen <= all, `${rate} Hz, ${all} rows, ${pairs} pairs: to row ${seen}`);
  }
  assert.ok(firstHole(6000, 100, 15, 1000) < 6000 - 21);
});

test('asked, leastRows, lookThrough: unknown names, too few rows and failed runs are no success', () => {
  assert.equal(asked(), CHECKS);
  assert.deepEqual(asked('ci', 'rows planted'), ['rows', 'planted']);
  for (const [part, only] of [['foo', ''], ['', 'foo'], ['', 'rows,foo'], ['', ',']]) assert.throws(() => asked(part, only), /there (is|are)/);
  assert.equal(leastRows(FAULTS.unplugged_500_ms, 100), 190); // 2.5 s of 100 Hz less the fault and twice 50 ms
  assert.equal(leastRows(FAULTS.starved_58_ms_800_hz, 800), 20 + 800 - 64);
  assert.equal(lookThrough([1, 2], (n) => ({ rows: 9, why: n === 2 ? 'rows differ' : null })).found, 'rows differ');
  for (const run of [() => { throw new Error('status 1'); }, () => ({ rows: 0, why: 'no rows' }), () => ({ rows: 9, why: null })]) {
    const { found, why } = lookThrough([1], run);
    assert.ok(found === null && why !== null);
  }
});
