// The two wires between the UNO and the sensor: avr8js' TWI with the times of a real bus and without its defects D2 to D5, the pins
// that the firmware clocks by hand, and what can happen to a bus.
const TWBR = 0xb8, TWSR = 0xb9, TWCR = 0xbc;
const TWINT = 0x80, TWEN = 0x04, TWS = 0xf8;
const SDA = 4, SCL = 5; // of port C
const ARBITRATION_LOST = 0x38, BUS_ERROR = 0x00, NO_STATE = 0xf8;

export class TwoWire {
  // stock: avr8js' TWI as it is, in no time and with its defects
  constructor(cpu, twi, portC, sensor, { stock = false } = {}) {
    Object.assign(this, { cpu, twi, portC, sensor, stock });
    this.unplugged = false;
    this.once = []; // what happens once, in order: nack, nackdata, arbitration, buserror
    this.held = { sda: false, scl: false }; // by a short to ground
    this.hungClocks = 0; // the slave holds SDA low until it has seen so many clocks
    this.epoch = 0; // a TWI that was switched off has no transfer under way
    this.busLost = false;
    this.waiting = null; // a START for a free bus, a byte for a free SCL
    this.log = null; // an array: what passes on the bus, for people
    this.level = { sda: true, scl: true };
    portC.setPin(SDA, true);
    portC.setPin(SCL, true);
    portC.addListener(() => this.wiresMove());
    twi.eventHandler = this.handler();
    if (!stock) this.repair();
  }

  // --- the wires ---

  driven(pin) { return this.portC.pinState(pin) === 0; } // open drain: the firmware drives low or lets go

  wiresMove() {
    const scl = !this.held.scl && !this.driven(SCL);
    if (scl && !this.level.scl && this.hungClocks > 0) this.hungClocks--;
    const sda = !this.held.sda && !this.driven(SDA) && this.hungClocks === 0;
    const stop = scl && this.level.scl && sda && !this.level.sda;
    const start = scl && this.level.scl && !sda && this.level.sda;
    this.level = { sda, scl };
    if (stop) this.sensor.stop();
    if (start) this.sensor.start();
    this.portC.setPin(SDA, sda);
    this.portC.setPin(SCL, scl);
    if (scl && sda && this.waiting) { const go = this.waiting; this.waiting = null; go(); }
  }

  hold(wire, low) { this.held[wire] = low; this.wiresMove(); }

  hang(clocks) { this.hungClocks = clocks; this.wiresMove(); }

  // --- avr8js' TWI ---

  // 22.5.2: SCL frequency = CPU clock / (16 + 2 TWBR 4^TWPS)
  get bit() { return 16 + 2 * this.cpu.data[TWBR] * 4 ** (this.cpu.data[TWSR] & 3); }

  after(bits, f) {
    if (this.stock) return f();
    const epoch = this.epoch;
    const go = () => { if (epoch === this.epoch) f(); };
    // a line that is held low keeps SCL, or the START, from coming
    const when = () => { if (this.level.scl && this.level.sda) this.cpu.addClockEvent(go, bits * this.bit); else this.waiting = when; };
    when();
  }

  happens(kind) {
    if (this.once[0] !== kind) return false;
    this.once.shift();
    return true;
  }

  note(text) { this.log?.push(text); }

  handler() {
    const { twi, sensor } = this;
    return {
      start: (repeated) => this.after(1, () => {
        this.note(repeated ? 'Sr' : 'S');
        if (this.busLost) this.cpu.data[TWSR] |= NO_STATE; // no longer this master's bus: the next START is none that repeats
        this.busLost = false;
        sensor.start();
        twi.completeStart();
      }),
      stop: () => this.after(1, () => {
        this.note('P');
        sensor.stop();
        twi.completeStop();
        if (!this.stock) this.cpu.clearInterrupt(twi.TWI); // D4, 22.6 step 7: "TWINT is NOT set after a STOP condition has been sent"
      }),
      connectToSlave: (address, write) => this.after(9, () => this.address(address, write)),
      writeByte: (byte) => this.after(9, () => {
        const ack = !this.unplugged && sensor.written(byte) && !this.happens('nackdata');
        this.note(`>${byte.toString(16)}${ack ? '' : '-'}`);
        twi.completeWrite(ack);
      }),
      readByte: () => this.after(9, () => this.byteRead()),
    };
  }

  address(address, write) {
    if (this.happens('arbitration')) return this.status(ARBITRATION_LOST);
    if (this.happens('buserror')) return this.status(BUS_ERROR);
    const ack = !this.unplugged && this.sensor.addressed(address, write) && !this.happens('nack');
    this.note(`${write ? 'W' : 'R'}${address.toString(16)}${ack ? '+' : '-'}`);
    this.twi.completeConnect(ack);
  }

  byteRead() {
    const byte = this.unplugged ? 0xff : this.sensor.read();
    this.note(`<${byte.toString(16)}`);
    this.twi.completeRead(byte);
  }

  status(code) { // D5: avr8js knows neither arbitration nor bus errors
    this.busLost = true;
    this.twi.busy = false;
    this.twi.updateStatus(code);
  }

  repair() {
    const { cpu, twi } = this;
    const write = cpu.writeHooks[TWCR];
    cpu.writeHooks[TWCR] = (value, old, address, mask) => {
      if (value & TWEN) return write(value, old, address, mask);
      // D3, 22.9.2: "the TWI is switched off and all TWI transmissions are terminated, regardless of any ongoing operation"
      this.epoch++;
      this.waiting = null;
      twi.busy = false;
      cpu.data[TWSR] |= NO_STATE;
      cpu.updateInterruptEnable(twi.TWI, value);
      cpu.clearInterrupt(twi.TWI);
      cpu.data[TWCR] = value & ~TWINT;
      return true;
    };
    cpu.clearInterrupt(twi.TWI); // D4: TWCR is 0 after a reset
    cpu.writeHooks[TWSR] = (value, old) => { cpu.data[TWSR] = (old & TWS) | (value & 3); return true; }; // D2, 22.9.3: TWS7..3 are read only
  }
}
