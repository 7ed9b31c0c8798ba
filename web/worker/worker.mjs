// The Web Worker of the demo page: the board at the pace of a clock. Messages in: {start} once, then {world}, {recording}, {typed}, {fault},
// {press}, {power}, {speed}; out: {samples, text, led}, {status}, {booted}, {eeprom}, {replays}, {refused}, {broken}.
import { CPU_HZ, MCUSR } from '../../second/uno.mjs';
import { Cells, DemoBoard } from './board.mjs';
import { Recording, read } from './recording.mjs';
import { World } from './world.mjs';

const STEP_MS = 5, REST_MS = 25, LONGEST_MS = 40, STATUS_MS = 1000, BACKLOG_MS = 250, ASLEEP_MS = 1000, TRUTH_MS = 10;

class Simulator {
  constructor({ program, eeprom, seed, world }) {
    this.program = new Uint16Array(program);
    this.cells = new Cells(eeprom);
    this.world = new World(seed);
    this.world.set(world);
    this.faults = { sda: false, unplug: false, int1: false };
    this.speed = 1;
    this.samples = [];
    this.truthUs = 0;
    this.past = 0; // cycles of boards that were switched off
    this.window = { at: performance.now(), ms: 0 };
    this.switch(true);
    this.turn();
  }

  // --- what a person does ---

  switch(on) {
    if (on === Boolean(this.board)) return;
    this.past += this.board?.uno.cpu.cycles ?? 0;
    this.board = null;
    if (!on) return;
    this.board = new DemoBoard({ program: this.program, eeprom: this.cells, feed: (cycle) => this.feed(cycle),
      onSample: (cycle, lsb) => this.sampled(cycle, lsb) });
    for (const [kind, held] of Object.entries(this.faults)) if (held) this.fault(kind, true);
    this.anchor();
    postMessage({ booted: true });
  }

  fault(kind, held) {
    this.faults[kind] = held;
    const { board } = this;
    if (!board) return;
    if (kind === 'sda') board.wires.hold('sda', held);
    if (kind === 'int1') board.cutInt1(held);
    if (kind === 'unplug') board.unplug(held);
  }

  press(button) {
    if (button === 'reset') this.board?.reset(MCUSR.external);
    if (button === 'knock') this.world.knock();
    if (button === 'push') this.world.push();
  }

  replay({ name, text }) {
    try {
      const recording = read(text);
      this.world.recording = new Recording(recording);
      this.world.set({ mode: 'recording' });
      postMessage({ replays: { name, rows: recording.rows.length, hz: 1e6 / recording.stepUs } });
    } catch (error) {
      postMessage({ refused: `${name}: ${error.message}` });
    }
  }

  // --- the sensor ---

  us(cycle) { return (this.past + cycle) / (CPU_HZ / 1e6); }

  feed(cycle) {
    this.world.moveTo(this.us(cycle));
    return this.world.sample(this.board.sensor.periodCycles * 1e6 / CPU_HZ);
  }

  sampled(cycle, lsb) {
    this.truthUs = this.board.usOf(cycle);
    this.samples.push([this.truthUs, this.world.truth, lsb]);
  }

  // the truth for rows that come while the sensor measures nothing
  silence() {
    const { board } = this, now = board.usOf(board.uno.cpu.cycles);
    if (now - this.truthUs < TRUTH_MS * 1000 && now >= this.truthUs) return;
    this.world.moveTo(this.us(board.uno.cpu.cycles));
    this.truthUs = now;
    this.samples.push([now, this.world.truth, null]);
  }

  // --- time ---

  anchor() { this.from = { wall: performance.now(), ms: this.board?.ms ?? 0 }; }

  pace(speed) {
    this.speed = speed;
    this.anchor();
  }

  due(now) {
    if (!this.speed) return Infinity;
    const due = this.from.ms + (now - this.from.wall) * this.speed;
    if (due - this.board.ms <= BACKLOG_MS * this.speed) return due;
    if (now - this.lastMs > ASLEEP_MS) Object.assign(this.window, { at: now, ms: 0 }); // the browser had put the page to sleep
    this.anchor();
    return this.board.ms + STEP_MS;
  }

  run() {
    const began = performance.now(), { board } = this;
    const due = this.due(began), before = board.ms;
    while (board.ms < due && performance.now() - began < LONGEST_MS) {
      board.runTo(Math.min(due, board.ms + STEP_MS));
      this.silence();
    }
    this.lastMs = performance.now();
    this.window.ms += board.ms - before;
    postMessage({ samples: this.samples, text: board.takeText(), led: board.led });
    this.samples = [];
  }

  status(now) {
    const { at, ms } = this.window, passed = now - at;
    if (passed < STATUS_MS) return;
    postMessage({ status: { on: Boolean(this.board), pace: ms / passed, speed: this.speed } });
    this.window = { at: now, ms: 0 };
    this.keep();
  }

  keep() {
    if (this.cells.changed) postMessage({ eeprom: this.cells.memory });
    this.cells.changed = false;
  }

  turn() {
    try {
      if (this.board) this.run();
      this.status(performance.now());
    } catch (error) {
      postMessage({ broken: error.message });
      return;
    }
    setTimeout(() => this.turn(), this.speed ? REST_MS : 0);
  }
}

let simulator = null;
const ON = {
  start: (options) => { simulator = new Simulator(options); },
  world: (changes) => simulator.world.set(changes),
  recording: (file) => simulator.replay(file),
  typed: (line) => simulator.board?.uno.type(line),
  fault: ([kind, held]) => simulator.fault(kind, held),
  press: (button) => simulator.press(button),
  power: (on) => simulator.switch(on),
  speed: (speed) => simulator.pace(speed),
};

onmessage = ({ data }) => { for (const [name, value] of Object.entries(data)) ON[name](value); };
