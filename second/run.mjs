// node second/run.mjs SET...: the plan, the planted faults, the sum, and build/second.json. PART=ci: a part, COUNT says which;
// ONLY=rows,planted: these checks; PLANTED: what make has built with a planted fault.
import { mkdirSync, writeFileSync } from 'node:fs';
import { asked, planOf, imagesOf } from './plan.mjs';
import { plantedJobs, judgePlanted } from './planted.mjs';
import { runAll } from './pool.mjs';

const named = ({ check, image, filter, rate, stream, fault, session, reading, event, address }) => (
  [check, image?.replace(/^build\/uno\/|\/?firmware\.hex$/g, '') || 'everyday', filter, rate && `${rate} Hz`, stream, fault, session, reading, event,
    address && `0x${address.toString(16)}`].filter(Boolean).join(' '));

const FIELDS = ['check', 'image', 'filter', 'rate', 'stream', 'offset', 'fault', 'session', 'reading', 'event', 'address', 'planted'];

const recorded = (job, result) => ({
  ...Object.fromEntries(FIELDS.filter((f) => job[f] !== undefined).map((f) => [f, job[f]])), passed: result.why === null, ...result });

function printTable(checks) {
  console.log('check            runs  failed    rows  different  PC rows  different  processor s');
  for (const [check, c] of checks) {
    const numbers = [[c.runs, 6], [c.failed, 8], [c.rows, 8], [c.different, 11], [c.pcRows, 9], [c.pcDifferent, 11], [c.seconds.toFixed(0), 13]];
    console.log(check.padEnd(15) + numbers.map(([value, width]) => String(value).padStart(width)).join(''));
  }
}

function add(checks, check, result) {
  if (!checks.has(check)) checks.set(check, { runs: 0, failed: 0, rows: 0, different: 0, pcRows: 0, pcDifferent: 0, seconds: 0 });
  const c = checks.get(check);
  c.runs++;
  c.failed += result.why === null ? 0 : 1;
  c.rows += result.rows ?? 0;
  c.different += result.different ?? 0;
  c.pcRows += result.pc_rows ?? 0;
  c.pcDifferent += result.pc_different ?? 0;
  c.seconds += result.cpu_s ?? 0;
}

async function main() {
  const { PART, COUNT = 0, PLANTED } = process.env;
  const only = asked(PART, process.env.ONLY);
  mkdirSync('build/second', { recursive: true });
  const images = imagesOf(process.argv.slice(2));
  const jobs = planOf(images, PART, Number(COUNT), only);
  const planted = !only.includes('planted') ? [] : plantedJobs(images[0].image, (PLANTED ?? '').split(' ').filter(Boolean));
  if (!jobs.length && !planted.length) throw new Error(`ONLY=${only} PART=${PART}: nothing of it is in this part`);
  const records = [], checks = new Map(), failures = [], plantedResults = [];
  console.log(`second: ${jobs.length} runs, ${planted.length} for planted faults, two at a time`);
  let ended = 0;
  await runAll([...jobs, ...planted], (job, result) => {
    if (++ended % 200 === 0) console.log(`second: ${ended} of ${jobs.length + planted.length} runs`);
    records.push(recorded(job, result));
    if (job.planted) { plantedResults.push([job, result]); return; }
    add(checks, job.check, result);
    if (result.why !== null) failures.push(`FAIL ${named(job)}: ${result.why}`);
  });
  const found = judgePlanted(plantedResults);
  printTable(checks);
  for (const line of found.lines) console.log(line);
  for (const failure of [...failures, ...found.failures]) console.log(failure);
  writeFileSync('build/second.json', `[\n${records.map((r) => JSON.stringify(r)).join(',\n')}\n]\n`);
  const failed = failures.length + found.failures.length;
  console.log('skipped: 0');
  console.log(`${records.length - failed} passed, ${failed} failed`);
  process.exitCode = failed ? 1 : 0;
}

try {
  await main();
} catch (error) {
  console.error(`second: ${error.message}`);
  process.exitCode = 2;
}
