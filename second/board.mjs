// An UNO with an ADXL345 at its pins, a person at the serial port, and what befalls them at a given time.
import { Adxl345 } from './adxl345.mjs';
import { TwoWire } from './twowire.mjs';
import { Uno, CPU_HZ, MCUSR } from './uno.mjs';

export const CYCLES_PER_MS = CPU_HZ / 1000;
const ROW = /^\d+(,-?\d+){8},\d+$/;
const HEADER = 't_us,x_lsb,y_lsb,z_lsb,x_mg,y_mg,z_mg,roll_cdeg,pitch_cdeg,flags';

export const isRow = (line) => ROW.test(line);
export const rowsOf = (lines) => lines.filter(isRow).map((line) => line.split(',').map(Number));
export const notesOf = (lines) => lines.filter((line) => line !== '' && line !== HEADER && !isRow(line)); // words, for people

export class Board {
  constructor({ program, feed, sensor = {}, stock = [], eeprom }) {
    this.program = program;
    this.stock = stock;
    this.int1Cut = false;
    this.lines = [];
    this.resets = 0;
    this.build({ program, stock, eeprom });
    this.sensor = new Adxl345({ ...sensor, clock: this.clock, feed, onInt1: () => this.wireInt1() });
    this.wires = this.wireUp();
    this.script = [];
  }

  build(options) {
    this.uno = new Uno(options);
    const { cpu } = this.uno;
    this.clock = { now: () => cpu.cycles, after: (cycles, f) => cpu.addClockEvent(f, Math.round(cycles)) };
  }

  wireUp() {
    return new TwoWire(this.uno.cpu, this.uno.twi, this.uno.portC, this.sensor, { stock: this.stock.includes('twi') });
  }

  wireInt1() {
    if (this.sensor) this.uno.setInt0(this.sensor.int1 && !this.int1Cut);
  }

  cutInt1(cut) {
    this.int1Cut = cut;
    this.wireInt1();
  }

  get ms() { return this.uno.cpu.cycles / CYCLES_PER_MS; }

  // the UNO begins again, the sensor goes on
  reset(cause) {
    this.resets++;
    this.lines.push(...this.uno.lines, ...(this.uno.line ? [this.uno.line] : []));
    const { slept } = this.uno;
    this.build({ program: this.program, before: this.uno, mcusr: cause, stock: this.stock });
    this.uno.slept = slept;
    this.sensor.moveTo(this.clock);
    this.wires = this.wireUp();
    this.wireInt1();
  }

  at(ms, f) {
    this.script.push({ ms, f });
    this.script.sort((a, b) => a.ms - b.ms);
    return this;
  }

  type(ms, line) { return this.at(ms, () => this.uno.type(line)); }

  run(ms) {
    while (this.script.length && this.script[0].ms <= ms) {
      const { ms: at, f } = this.script.shift();
      this.runTo(at);
      f(this);
    }
    this.runTo(ms);
    return this;
  }

  runTo(ms) {
    const until = Math.round(ms * CYCLES_PER_MS);
    while (this.uno.cpu.cycles < until) {
      this.uno.run(until);
      if (this.uno.reset) this.reset(MCUSR.watchdog);
    }
  }

  get output() { return [...this.lines, ...this.uno.lines]; }
  get load() { return 1 - this.uno.slept / this.uno.cpu.cycles; }
}
