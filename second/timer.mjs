// A timer of the ATmega328P in normal mode, computed when somebody looks: avr8js makes an event for each count (D10), this one for
// each compare match and overflow. Any other mode, input capture and output pins are refused: no image uses them.
const DIVIDERS_01 = [0, 1, 8, 64, 256, 1024]; // Table 15-9, 16-5; 6 and 7 are the external clock
const DIVIDERS_2 = [0, 1, 8, 32, 64, 128, 256, 1024]; // Table 18-9

export const TIMER0 = {
  tcnt: 0x46, ocr: [0x47, 0x48], tccra: 0x44, tccrb: 0x45, timsk: 0x6e, tifr: 0x35, vectors: [0x1c, 0x1e, 0x20], bits: 8, dividers: DIVIDERS_01,
};
export const TIMER1 = {
  tcnt: 0x84, ocr: [0x88, 0x8a], tccra: 0x80, tccrb: 0x81, timsk: 0x6f, tifr: 0x36, vectors: [0x16, 0x18, 0x1a], bits: 16, dividers: DIVIDERS_01,
};
export const TIMER2 = {
  tcnt: 0xb2, ocr: [0xb3, 0xb4], tccra: 0xb0, tccrb: 0xb1, timsk: 0x70, tifr: 0x37, vectors: [0x0e, 0x10, 0x12], bits: 8, dividers: DIVIDERS_2,
};

const OCF = [2, 4], TOV = 1;

export class Timer {
  constructor(cpu, config) {
    Object.assign(this, { cpu, config });
    this.wraps = 2 ** config.bits;
    this.startedAt = 0; // the cycle at which the count was startCount
    this.startCount = 0;
    this.divider = 0;
    this.temp = 0; // 16.3: the high byte waits in TEMP for the low one
    this.compare = [0, 0];
    const flags = [...OCF, TOV];
    this.interrupts = config.vectors.map((address, n) => (
      { address, flagRegister: config.tifr, flagMask: flags[n], enableRegister: config.timsk, enableMask: flags[n] }));
    // 16.7: the flag is set at the timer clock cycle after the match
    this.events = this.interrupts.map((interrupt, n) => () => { cpu.setInterruptFlag(interrupt); this.schedule(n); });
    this.hookCounter();
    config.ocr.forEach((address, n) => this.hookCompare(address, n));
    this.hookControl();
  }

  get count() {
    const steps = this.divider ? Math.floor((this.cpu.cycles - this.startedAt) / this.divider) : 0;
    return (this.startCount + steps) % this.wraps;
  }

  set count(value) {
    this.startCount = value;
    this.startedAt = this.cpu.cycles;
    this.scheduleAll();
  }

  hookCounter() {
    const { cpu, config } = this;
    cpu.readHooks[config.tcnt] = () => { const v = this.count; this.temp = v >> 8; return v & 0xff; };
    cpu.writeHooks[config.tcnt] = (value) => {
      this.count = config.bits === 16 ? (this.temp << 8) | value : value;
      return true;
    };
    if (config.bits === 16) this.hookHigh(config.tcnt + 1, () => this.temp);
  }

  hookHigh(address, read) {
    this.cpu.readHooks[address] = read;
    this.cpu.writeHooks[address] = (value) => { this.temp = value; return true; };
  }

  hookCompare(address, n) {
    const { cpu, config } = this;
    cpu.readHooks[address] = () => this.compare[n] & 0xff;
    cpu.writeHooks[address] = (value) => {
      this.compare[n] = config.bits === 16 ? (this.temp << 8) | value : value;
      this.schedule(n);
      return true;
    };
    if (config.bits === 16) this.hookHigh(address + 1, () => this.compare[n] >> 8); // 16.3: OCR1A/B are read without TEMP
  }

  hookControl() {
    const { cpu, config } = this;
    cpu.writeHooks[config.tccra] = (value) => {
      if (value !== 0) this.refuse('TCCRnA', value);
      return false;
    };
    cpu.writeHooks[config.tccrb] = (value) => {
      const divider = config.dividers[value & 7];
      if ((value & ~7) !== 0 || divider === undefined) this.refuse('TCCRnB', value);
      const now = this.count;
      this.divider = divider;
      this.count = now;
      return false;
    };
    cpu.writeHooks[config.timsk] = (value) => {
      cpu.data[config.timsk] = value;
      for (const i of this.interrupts) cpu.updateInterruptEnable(i, value);
      return true;
    };
    cpu.writeHooks[config.tifr] = (value) => { for (const i of this.interrupts) cpu.clearInterruptByFlag(i, value); return true; };
  }

  refuse(register, value) {
    throw new Error(`timer with TCNT at 0x${this.config.tcnt.toString(16)}: ${register} = ${value}: only normal mode without pins is modelled`);
  }

  scheduleAll() { for (const n of this.events.keys()) this.schedule(n); }

  schedule(n) {
    this.cpu.clearClockEvent(this.events[n]);
    if (!this.divider) return;
    const match = n < 2 ? this.compare[n] + 1 : this.wraps; // the overflow comes with the count of 0
    const counts = ((match - this.count - 1 + this.wraps) % this.wraps) + 1;
    const phase = (this.cpu.cycles - this.startedAt) % this.divider;
    this.cpu.addClockEvent(this.events[n], counts * this.divider - phase);
  }
}
