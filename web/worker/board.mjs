// second's UNO and sensor as a page shows them: bytes out as text, the LED, cells of EEPROM that are kept, and faults that outlast a reset.
import { avr } from '../../second/avr8js.mjs';
import { Board } from '../../second/board.mjs';
import { CPU_HZ } from '../../second/uno.mjs';

const LED = 5; // of port B

// EEPROM whose content somebody keeps
export class Cells extends avr.EEPROMMemoryBackend {
  constructor(content = null) {
    super(1024);
    if (content) this.memory.set(content.subarray(0, this.memory.length));
    this.changed = false;
  }

  writeMemory(address, value) {
    super.writeMemory(address, value);
    this.changed = true;
  }

  eraseMemory(address) {
    super.eraseMemory(address);
    this.changed = true;
  }
}

export class DemoBoard extends Board {
  // onSample(cycle, sample): what the sensor has measured
  constructor(options) {
    super(options);
    this.sensor.served = { push: ([cycle, sample]) => options.onSample(cycle, sample) };
  }

  build(options) {
    super.build(options);
    this.beganAt = this.uno.cpu.cycles;
    this.text ??= '';
    this.uno.usart.onByteTransmit = (byte) => { this.text += String.fromCharCode(byte); };
  }

  wireUp() {
    const before = this.wires, wires = super.wireUp();
    if (before) {
      wires.unplugged = before.unplugged;
      for (const wire of ['sda', 'scl']) if (before.held[wire]) wires.hold(wire, true);
    }
    return wires;
  }

  // microseconds as the firmware counts them, in 32 bits
  usOf(cycle) { return (cycle - this.beganAt) * 1e6 / CPU_HZ % 2 ** 32; }

  get led() { return this.uno.portB.pinState(LED) === avr.PinState.High; }

  // all wires of the sensor, its supply too
  unplug(on) {
    this.wires.unplugged = on;
    if (on) this.sensor.powerOff();
    else this.sensor.powerOn();
  }

  takeText() {
    const { text } = this;
    this.text = '';
    return text;
  }
}
