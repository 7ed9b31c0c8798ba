// An ADXL345 on I2C, written from Analog Devices' data sheet (Rev. D to G, the pages are the same) and from nothing else: what is
// quoted below is its text, partly from memory. Where it leaves something open, the readings of `job_readings.mjs` say which answer
// this part gives.
// Not modelled: taps, activity, free fall, sleep and link, SPI, INT2, the trigger of trigger mode (it goes on as stream mode).

const CPU_HZ = 16e6;

// Table 19, the register map
const DEVID = 0x00, FIRST = 0x1d, OFSX = 0x1e, ACT_TAP_STATUS = 0x2b, BW_RATE = 0x2c, POWER_CTL = 0x2d, INT_ENABLE = 0x2e;
const INT_MAP = 0x2f, INT_SOURCE = 0x30, DATA_FORMAT = 0x31, DATAX0 = 0x32, DATAZ1 = 0x37, FIFO_CTL = 0x38, FIFO_STATUS = 0x39;
const READ_ONLY = new Set([DEVID, ACT_TAP_STATUS, INT_SOURCE, 0x32, 0x33, 0x34, 0x35, 0x36, 0x37, FIFO_STATUS]);
// bits that the register definitions print as 0
const RESERVED = { [BW_RATE]: 0xe0, [POWER_CTL]: 0xc0, [DATA_FORMAT]: 0x10, 0x2a: 0xf0 };

const DATA_READY = 0x80, WATERMARK = 0x02, OVERRUN = 0x01;
const MEASURE = 0x08, SELF_TEST = 0x80, INT_INVERT = 0x20, FULL_RES = 0x08, JUSTIFY = 0x04;
const BYPASS = 0, FIFO = 1;
const LEVELS = 32;

// what a part does where the data sheet is open; job_readings.mjs has the other answers
export const AS_BUILT = {
  capacity: LEVELS + 1, // "a maximum of 33 entries available at any given time because an additional entry is available at the output filter"
  entries: 'all', // FIFO_STATUS: all | without-output (not the one that waits in the data registers) | at-most-32
  overrun: 'filled', // "set when FIFO is filled": filled | first-loss | never
  sourceReadClears: 'nothing', // "cleared by reading data from the DATAX, DATAY and DATAZ registers": nothing | pin | overrun
  popTakesUs: 0, // "at least 5 us between the end of reading the data registers and the start of a new read"
  pinLowAfterPopUs: 0,
  emptyReads: 'last', // the data registers of an empty FIFO: last | zero
  watermarkOfZero: true, // "Entering a value of 0 in the samples bits immediately sets the watermark status bit"
  turnOnMs: 1.1, // "turn-on and wake-up times are each approximately tau + 1.1"; null: a sample at once
  bypassClears: true, // "placing the device into bypass mode clears FIFO"
  bypassAgainClears: true, // a write of FIFO_CTL that stays in bypass drops an unread sample
  leavingBypassKeeps: true, // an unread sample is the first one of the FIFO
  burst: 'coherent', // "a multiple-byte read ... prevents a change in data between reads": coherent | torn
  reservedRead: 0, // reserved bits: 0 | 1
  reservedKept: false, // reserved bits of a write are kept
  rateChangeAtOnce: true, // a new BW_RATE counts from its write, not from the next sample
};

export class Adxl345 {
  // clock: {now() in cycles, after(cycles, f)}; feed(now): [x, y, z] in LSB of 3.9 mg, or null while the sensor has no sample;
  // onInt1(level); selfTest: the shift in LSB (1.77 and 1.47 times the middle of Table 1's limits, for 3.3 V)
  constructor({ clock, feed, onInt1 = () => {}, address = 0x53, identity = 0xe5, selfTest = [522, -522, 698], clockPpm = 0,
    reading = {}, broken = {} }) {
    Object.assign(this, { clock, feed, onInt1, address, identity, selfTest, clockPpm, broken });
    this.reading = { ...AS_BUILT, ...reading };
    this.served = []; // [cycle, [x, y, z]] of every sample measured
    this.powered = true;
    this.int1 = false;
    this.epoch = 0; // ticks of before a power cycle or standby no longer count
    this.powerOn();
  }

  powerOn() {
    this.registers = new Uint8Array(64);
    this.registers[BW_RATE] = 0x0a;
    this.queue = []; // waiting samples, the oldest first; in bypass mode at most one
    this.shown = [0, 0, 0]; // what the data registers hold
    this.overrun = false;
    this.pointer = 0;
    this.pointerComes = false;
    this.reading6 = null; // the sample that a read of the data registers has begun
    this.pinHeldLow = false; // for some microseconds
    this.pinCleared = false; // until the next sample
    this.powered = true;
    this.epoch++;
    this.drivePin();
  }

  powerOff() {
    this.powered = false;
    this.epoch++;
    this.drivePin();
  }

  get mode() { return this.registers[FIFO_CTL] >> 6; }
  get range() { return this.registers[DATA_FORMAT] & 3; }
  // Table 7: 3200 Hz for code 15, half of it for each code below
  get periodCycles() { return CPU_HZ * 2 ** (15 - (this.registers[BW_RATE] & 0x0f)) / 3200 / (1 + this.clockPpm * 1e-6); }

  // --- measuring ---

  scheduleTick(cycles) {
    const epoch = ++this.epoch;
    const at = this.clock.now() + cycles;
    this.dueAt = at;
    this.clock.after(cycles, () => { if (epoch === this.epoch) this.tick(at); });
  }

  // a clock that goes on elsewhere: the UNO was reset, the sensor was not
  moveTo(clock) {
    this.clock = clock;
    if (this.powered && this.registers[POWER_CTL] & MEASURE) this.scheduleTick(this.dueAt - clock.now());
  }

  startMeasuring() {
    const turnOn = this.reading.turnOnMs;
    this.scheduleTick(turnOn === null ? 160 : this.periodCycles + turnOn * CPU_HZ / 1000);
  }

  tick(at) {
    const sample = this.feed(at);
    this.scheduleTick(at + this.periodCycles - this.clock.now());
    if (sample === null) return;
    this.served.push([at, sample]);
    this.store(this.measured(sample));
    this.pinCleared = false;
    this.drivePin();
  }

  // "The value stored in the offset registers is automatically added", 15.6 mg/LSB: four data LSB
  measured(sample) {
    const testing = (this.registers[DATA_FORMAT] & SELF_TEST) !== 0;
    return sample.map((lsb, axis) => lsb + 4 * ((this.registers[OFSX + axis] << 24) >> 24) + (testing ? this.selfTest[axis] : 0));
  }

  store(sample) {
    const { capacity, overrun } = this.reading;
    const full = this.mode === BYPASS ? 1 : this.broken.capacity ?? capacity;
    const lost = this.queue.length >= full;
    if (!lost) {
      this.queue.push(sample);
    } else if (this.mode !== FIFO) { // FIFO mode "stops collecting data"
      this.queue.shift();
      this.queue.push(sample);
    }
    const filled = this.mode !== BYPASS && this.queue.length >= Math.min(LEVELS, full);
    if (overrun !== 'never' && (lost || (filled && overrun === 'filled'))) this.overrun = true;
  }

  // --- interrupts ---

  get source() {
    const samples = this.registers[FIFO_CTL] & 0x1f;
    const watermark = samples === 0 ? this.reading.watermarkOfZero : this.mode !== BYPASS && this.queue.length >= samples;
    return (this.queue.length > 0 ? DATA_READY : 0) | (watermark ? WATERMARK : 0) | (this.overrun ? OVERRUN : 0);
  }

  drivePin() {
    const active = (this.source & this.registers[INT_ENABLE] & ~this.registers[INT_MAP]) !== 0 && !this.pinHeldLow && !this.pinCleared;
    const inverted = (this.registers[DATA_FORMAT] & INT_INVERT) !== 0;
    const level = this.powered && active !== inverted;
    if (level !== this.int1) {
      this.int1 = level;
      this.onInt1(level);
    }
  }

  holdPinLow(us) {
    this.pinHeldLow = true;
    this.drivePin();
    this.clock.after(us * CPU_HZ / 1e6, () => { this.pinHeldLow = false; this.drivePin(); });
  }

  // --- registers ---

  readRegister(address) {
    if (address === DEVID) return this.identity;
    if (address < FIRST) return 0;
    if (address === INT_SOURCE) return this.readSource();
    if (address >= DATAX0 && address <= DATAZ1) return this.readData(address - DATAX0);
    if (address === FIFO_STATUS) return this.entries();
    return this.registers[address] | (this.reading.reservedRead ? RESERVED[address] ?? 0 : 0);
  }

  readSource() {
    const source = this.source;
    if (this.reading.sourceReadClears === 'overrun') this.overrun = false;
    if (this.reading.sourceReadClears === 'pin') this.pinCleared = true;
    this.drivePin();
    return source;
  }

  entries() {
    const count = this.mode === BYPASS ? 0 : this.queue.length; // "In bypass mode, FIFO is not operational and, therefore, remains empty"
    if (this.reading.entries === 'without-output') return Math.max(0, count - 1);
    return this.reading.entries === 'at-most-32' ? Math.min(LEVELS, count) : count;
  }

  readData(index) {
    if (this.reading6 === null || this.reading.burst === 'torn') {
      if (this.queue.length > 0) this.shown = this.queue[0];
      else if (this.reading.emptyReads === 'zero' && this.reading6 === null) this.shown = [0, 0, 0];
      this.reading6 = this.shown;
    }
    const word = this.formatted(this.reading6[index >> 1]);
    const high = (index & 1) !== (this.broken.bytesSwapped ? 1 : 0);
    return (high ? word >> 8 : word) & 0xff;
  }

  // "All data, except that for the +-16 g range, must be clipped to avoid rollover"; Table 21, Figure 49
  formatted(lsb) {
    const full = (this.registers[DATA_FORMAT] & FULL_RES) !== 0;
    const most = 512 << this.range;
    const clipped = Math.max(-most, Math.min(most - 1, lsb));
    let word = full ? clipped : clipped >> this.range;
    if ((this.registers[BW_RATE] & 0x0f) >= 0x0e && (full || this.range === 0)) word &= ~1;
    return this.registers[DATA_FORMAT] & JUSTIFY ? word << (6 - (full ? this.range : 0)) : word;
  }

  // "The end of reading a data register is signified by the transition from Register 0x37 to Register 0x38"; a shorter read loses the rest
  endOfDataRead() {
    if (this.reading6 === null) return;
    this.reading6 = null;
    const { popTakesUs, pinLowAfterPopUs } = this.reading;
    if (popTakesUs > 0) this.clock.after(popTakesUs * CPU_HZ / 1e6, () => this.pop());
    else this.pop();
    if (pinLowAfterPopUs > 0 && this.int1) this.holdPinLow(pinLowAfterPopUs);
  }

  pop() {
    if (!this.broken.neverPops) this.queue.shift();
    this.overrun = false; // "automatically cleared when the contents of FIFO are read"
    if (this.queue.length > 0) this.shown = this.queue[0];
    this.drivePin();
  }

  writeRegister(address, value) {
    if (address < FIRST || READ_ONLY.has(address)) return;
    const before = this.registers[address];
    this.registers[address] = this.reading.reservedKept ? value : value & ~(RESERVED[address] ?? 0);
    if (address === POWER_CTL && (before ^ value) & MEASURE) {
      if (value & MEASURE) this.startMeasuring();
      else this.epoch++; // standby: "no measurements are made"; "preserves the contents of FIFO"
    }
    if (address === BW_RATE && before !== value) this.rateChanged();
    if (address === FIFO_CTL) this.modeWritten(before >> 6, value >> 6);
    this.drivePin();
  }

  rateChanged() {
    if (this.registers[POWER_CTL] & MEASURE && this.reading.rateChangeAtOnce) this.scheduleTick(this.periodCycles);
  }

  modeWritten(before, after) {
    const { bypassClears, bypassAgainClears, leavingBypassKeeps } = this.reading;
    const clears = after === BYPASS ? (before === BYPASS ? bypassAgainClears : bypassClears) : before === BYPASS && !leavingBypassKeeps;
    if (clears) {
      this.queue = [];
      this.overrun = false;
    }
  }

  // --- I2C (Figure 40): address, register, data with increasing register address ---

  start() { this.endOfDataRead(); }

  stop() { this.endOfDataRead(); }

  // a device answers to its address; false: nobody pulls SDA low
  addressed(address, write) {
    if (!this.powered || address !== this.address) return false;
    this.pointerComes = write;
    return true;
  }

  written(byte) {
    if (!this.powered) return false;
    if (this.pointerComes) {
      this.pointer = byte & 0x3f;
      this.pointerComes = false;
    } else {
      this.writeRegister(this.pointer, byte);
      this.pointer = (this.pointer + 1) & 0x3f;
    }
    return true;
  }

  read() {
    if (!this.powered) return 0xff;
    if (this.pointer === FIFO_CTL) this.endOfDataRead();
    const byte = this.readRegister(this.pointer);
    this.pointer = (this.pointer + 1) & 0x3f;
    return byte;
  }
}
