// Takes jobs from run.mjs one by one and answers each with what came out.
import * as faults from './job_faults.mjs';
import * as readings from './job_readings.mjs';
import * as rows from './job_rows.mjs';
import * as sessions from './job_sessions.mjs';
import * as words from './job_words.mjs';
import { lookThrough } from './planted.mjs';

const KINDS = {
  rows: rows.run, whole: rows.runWhole, fault: faults.run, session: sessions.run, reading: readings.run,
  identity: words.runIdentity, 'fault-words': words.runFaultWords, 'stock-usart': words.runStockUsart,
};

const run = (job) => KINDS[job.kind](job);

function done(job) {
  try {
    return job.kind === 'planted' ? lookThrough(job.looks, run) : run(job);
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
