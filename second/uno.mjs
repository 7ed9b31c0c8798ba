// An UNO from avr8js' parts: CPU, ports, INT0, USART, TWI, EEPROM and watchdog are avr8js', the timers our own. README.md lists
// avr8js' defects by number; each is worked around here or in twowire.mjs, with the words of the ATmega328P's data sheet.
import { avr } from './avr8js.mjs';
import { Timer, TIMER0, TIMER1, TIMER2 } from './timer.mjs';

export const CPU_HZ = 16e6;
export const MCUSR = { powerOn: 1, external: 2, brownOut: 4, watchdog: 8 };

const SLEEP = 0x9588, SEI = 0x9478, RETI = 0x9518;
const SREG = 95, I = 0x80;
const SMCR = 0x53, SE = 1, MCUSR_ADDRESS = 0x54, UCSR0A = 0xc0, UCSR0B = 0xc1, UDR0 = 0xc6, EIFR = 0x3c, EIMSK = 0x3d, EICRA = 0x69;
const RXC = 0x80, UDRE = 0x20, RXEN = 0x10;
const RAM = 0x100;

export class Uno {
  // program: the flash, 16384 words. stock: avr8js as it is: 'usart' and 'twi' with their defects. before: the UNO that is reset,
  // whose RAM, EEPROM and time go on
  constructor({ program, eeprom = new avr.EEPROMMemoryBackend(1024), before = null, mcusr = MCUSR.powerOn, stock = [] }) {
    this.program = program;
    const cpu = this.cpu = new avr.CPU(this.program, 0x800);
    if (before) {
      cpu.data.set(before.cpu.data.subarray(RAM), RAM);
      cpu.cycles = before.cpu.cycles;
      eeprom = before.eepromCells;
    }
    this.portB = new avr.AVRIOPort(cpu, avr.portBConfig);
    this.portC = new avr.AVRIOPort(cpu, avr.portCConfig);
    this.portD = new avr.AVRIOPort(cpu, avr.portDConfig);
    for (const config of [TIMER0, TIMER1, TIMER2]) new Timer(cpu, config); // D10
    this.eepromCells = eeprom;
    this.eeprom = new avr.AVREEPROM(cpu, eeprom);
    this.watchdog = new avr.AVRWatchdog(cpu, avr.watchdogConfig, new avr.AVRClock(cpu, CPU_HZ));
    this.usart = new avr.AVRUSART(cpu, avr.usart0Config, CPU_HZ);
    this.twi = new avr.AVRTWI(cpu, avr.twiConfig, CPU_HZ);
    this.reset = null;
    cpu.reset = () => { this.reset = 'watchdog'; }; // D11: the board is built again, as the data sheet's reset leaves nothing of the I/O registers
    cpu.data[MCUSR_ADDRESS] = mcusr;
    this.portD.setPin(4, true); // D7: no pull-ups; nothing is wired to D4
    this.slept = 0;
    this.asleep = false;
    this.handlers = 0; // interrupt handlers begun and not ended
    this.starved = false;
    this.typed = [];
    this.listen();
    if (!stock.includes('usart')) this.repairUsart();
  }

  // D1, 20.11.2: RXC0 and UDRE0 are read only; avr8js clears them by any write of UCSR0A
  repairUsart() {
    const { cpu } = this;
    const write = cpu.writeHooks[UCSR0A];
    cpu.writeHooks[UCSR0A] = (value, old, address, mask) => {
      const kept = cpu.data[UCSR0A] & (RXC | UDRE);
      const done = write(value, old, address, mask);
      cpu.data[UCSR0A] |= kept;
      return done;
    };
    this.keepReceived();
    this.bufferTransmitter();
  }

  // D14, 20.11.2: RXC0 is "set when there are unread data in the receive buffer"; avr8js clears it by a write of UCSR0B while RXEN0 stays set
  keepReceived() {
    const { cpu, usart } = this;
    const write = cpu.writeHooks[UCSR0B];
    cpu.writeHooks[UCSR0B] = (value, old, address, mask) => {
      const unread = cpu.data[UCSR0A] & RXC;
      const done = write(value, old, address, mask);
      if (unread && value & RXEN) cpu.setInterruptFlag(usart.RXC);
      return done;
    };
  }

  // D6, 20.6.3: a byte moves on into the shift register, "and UDRE0 says that the buffer is ready for new data" while that one is sent
  bufferTransmitter() {
    const { cpu, usart } = this;
    let shifting = false, waiting = false;
    const shift = () => {
      shifting = true;
      cpu.addClockEvent(frameEnds, usart.cyclesPerChar);
      cpu.setInterruptFlag(usart.UDRE);
    };
    const frameEnds = () => {
      if (waiting) { waiting = false; shift(); return; }
      shifting = false;
      cpu.setInterruptFlag(usart.TXC);
    };
    cpu.writeHooks[UDR0] = (value) => {
      usart.onByteTransmit(value);
      cpu.clearInterrupt(usart.UDRE);
      if (shifting) waiting = true;
      else shift();
    };
  }

  // lines as they are sent, each with the cycle of its end
  listen() {
    this.lines = [];
    this.lineCycles = [];
    this.line = '';
    this.usart.onByteTransmit = (byte) => {
      if (byte !== 10) { this.line += String.fromCharCode(byte); return; }
      this.lines.push(this.line);
      this.lineCycles.push(this.cpu.cycles);
      this.line = '';
    };
  }

  // D9, 13.2.3: INTF0 is set by the edge, whether INT0 is enabled or not
  setInt0(level) {
    const { cpu } = this;
    const rising = level && !(cpu.data[0x29] & 4) && (cpu.data[EICRA] & 3) === 3;
    if (rising && !(cpu.data[EIMSK] & 1)) cpu.data[EIFR] |= 1;
    this.portD.setPin(2, level);
  }

  type(line) { for (const c of `${line}\n`) this.typed.push(c.charCodeAt(0)); }

  // one byte after the other, as fast as the line carries them
  sendTyped() {
    const { usart, cpu } = this;
    if (this.typed.length && !usart.rxBusy && !(cpu.data[UCSR0A] & RXC) && usart.rxEnable) usart.writeByte(this.typed.shift());
  }

  // D12, 7.7.1: four cycles to an interrupt; avr8js takes two
  interrupt() {
    const { cpu } = this;
    const interrupt = cpu.pendingInterrupts[cpu.nextInterrupt];
    const sp = cpu.SP;
    cpu.data[sp] = cpu.pc & 0xff;
    cpu.data[sp - 1] = cpu.pc >> 8;
    cpu.SP = sp - 2;
    cpu.data[SREG] &= ~I;
    cpu.cycles += 4;
    cpu.pc = interrupt.address;
    this.handlers++;
    if (!interrupt.constant) cpu.clearInterrupt(interrupt);
  }

  events() {
    const { cpu } = this;
    while (cpu.nextClockEvent && cpu.nextClockEvent.cycles <= cpu.cycles) {
      const event = cpu.nextClockEvent;
      cpu.nextClockEvent = event.next; // before the call: it may add events
      event.callback();
    }
  }

  // D8: SLEEP is a no-op in avr8js; here the time until the next event passes at once
  sleep(until) {
    const { cpu } = this;
    const began = cpu.cycles;
    while (cpu.nextInterrupt < 0 && cpu.cycles < until && !this.reset) {
      this.sendTyped();
      cpu.cycles = Math.min(Math.ceil(cpu.nextClockEvent?.cycles ?? until), until);
      this.events();
    }
    this.slept += cpu.cycles - began;
    this.asleep = cpu.nextInterrupt < 0;
    if (!this.asleep) cpu.cycles += 4; // 7.7.1: four cycles more out of sleep
  }

  fallAsleep(until) {
    const { data } = this.cpu;
    if (!(data[SMCR] & SE)) return;
    if (!(data[SREG] & I)) throw new Error('the firmware sleeps with interrupts off');
    this.sleep(until);
  }

  // the main loop gets no time, as if what it calls never came back; interrupts go on. In the end it is awake.
  starve(on) {
    this.starved = on;
    if (!on) this.asleep = false;
  }

  wakeFor(until) {
    this.sleep(until);
    if (!this.asleep) this.interrupt();
  }

  // until this cycle, or a reset by the watchdog
  run(until) {
    const { cpu, program } = this;
    const { avrInstruction } = avr;
    if (this.asleep) this.wakeFor(until);
    while (cpu.cycles < until && !this.reset && !this.asleep) {
      if (this.starved && this.handlers === 0 && cpu.data[SREG] & I) {
        this.sleep(until);
        if (!this.asleep) this.interrupt();
        continue;
      }
      const opcode = program[cpu.pc];
      avrInstruction(cpu);
      if (opcode === SLEEP) this.fallAsleep(until);
      else if (opcode === RETI) this.handlers--;
      if (cpu.nextClockEvent !== null && cpu.nextClockEvent.cycles <= cpu.cycles) this.events();
      if (this.typed.length) this.sendTyped();
      // D13, 7.7: the instruction after SEI or RETI is executed before a pending interrupt
      if (cpu.nextInterrupt >= 0 && opcode !== SEI && opcode !== RETI && cpu.data[SREG] & I) this.interrupt();
    }
  }
}
