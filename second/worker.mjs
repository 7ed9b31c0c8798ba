// Takes jobs from run.mjs one by one and answers each with what came out.
import * as faults from './job_faults.mjs';
import * as readings from './job_readings.mjs';
import * as rows from './job_rows.mjs';
import * as sessions from './job_sessions.mjs';
import * as words from './job_words.mjs';

const KINDS = {
  rows: rows.run, whole: rows.runWhole, fault: faults.run, session: sessions.run, reading: readings.run,
  identity: words.runIdentity, told: words.runTold, 'stock-usart': words.runStockUsart,
};

// run by run until one notices the planted fault
function planted(job) {
  for (const [n, look] of job.looks.entries()) {
    const { why } = done(look);
    if (why !== null) return { found: why, looks: n + 1, why: null };
  }
  return { found: null, looks: job.looks.length, why: 'not found' };
}

function done(job) {
  if (job.kind === 'planted') return planted(job);
  try {
    return KINDS[job.kind](job);
  } catch (error) {
    return { why: error.message.split('\n')[0] };
  }
}

process.on('message', (job) => {
  const before = process.cpuUsage();
  const result = done(job);
  const used = process.cpuUsage(before);
  process.send({ ...result, cpu_s: Math.round((used.user + used.system) / 1e4) / 100 });
});
