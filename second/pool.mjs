// Jobs, two at a time, each worker a process of its own.
import { fork } from 'node:child_process';

const WORKERS = 2;
const JOB_LIMIT_MS = 600000; // a run takes 3 s of a processor at most: this ends one that hangs, on any machine

// onDone(job, result) in the order in which they end
export function runAll(jobs, onDone) {
  const waiting = [...jobs];
  const one = () => new Promise((resolve) => {
    let worker = null, job = null, timer = null;
    const next = () => {
      if (waiting.length === 0) { worker?.disconnect(); return resolve(); }
      job = waiting.shift();
      worker ??= start();
      timer = setTimeout(() => worker.kill('SIGKILL'), JOB_LIMIT_MS);
      return worker.send(job);
    };
    const finished = (result) => { clearTimeout(timer); const was = job; job = null; onDone(was, result); next(); };
    const start = () => fork(new URL('worker.mjs', import.meta.url))
      .on('message', finished)
      .on('exit', (code, signal) => { worker = null; if (job) finished({ why: `its process ended: ${signal ?? `status ${code}`}` }); });
    next();
  });
  return Promise.all(Array.from({ length: WORKERS }, one));
}
