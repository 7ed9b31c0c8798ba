// What the virtual sensor is exposed to: an orientation that a person, the clock, a phone or a recording gives, noise, outliers, a knock, a push.
import { normal, uniform } from './random.mjs';

const RADIANS = Math.PI / 180;
const LSB_PER_G = [265, 265, 256]; // of a typical ADXL345 at 3.3 V
const LEAST = -4096, MOST = 4095; // 13 bits
const SWING = { rollDegrees: 30, rollHz: 0.1, pitchDegrees: 20, pitchHz: 0.06 };
const FOLLOWS_S = 0.06; // the time constant with which the sensor follows a hand
const OUTLIER = { least: 100, most: 600 }; // LSB
const KNOCK = { g: 6, decayS: 0.03, hz: 45, lastsS: 0.3, along: [0.5, 0.6, 0.6] };
const PUSH = { g: 0.5, lastsS: 1 };

// gravity's reaction in g, in the sensor's axes
export function upward([roll, pitch]) {
  const r = roll * RADIANS, p = pitch * RADIANS;
  return [-Math.sin(p), Math.sin(r) * Math.cos(p), Math.cos(r) * Math.cos(p)];
}

export class World {
  // settings: {mode: 'self' | 'hand' | 'phone' | 'recording', roll, pitch, phone: [x, y, z] in g, noise in LSB, outliers: share of an axis' readings}
  constructor(seed) {
    this.random = uniform(seed);
    this.normal = normal(this.random);
    this.settings = { mode: 'self', roll: 0, pitch: 0, phone: null, noise: 2, outliers: 0 };
    this.recording = null;
    this.tilt = [0, 0];
    this.us = 0;
    this.knockedAt = this.pushedAt = -Infinity;
  }

  set(changes) {
    if (changes.mode === 'hand' && this.settings.mode !== 'hand') Object.assign(this.settings, { roll: this.tilt[0], pitch: this.tilt[1] });
    Object.assign(this.settings, changes);
  }

  get seconds() { return this.us / 1e6; }

  knock() { this.knockedAt = this.seconds; }

  push() { this.pushedAt = this.seconds; }

  // time passes
  moveTo(us) {
    const { mode, roll, pitch } = this.settings;
    const passed = (us - this.us) / 1e6;
    this.us = us;
    const { seconds } = this;
    if (mode === 'self') {
      const turn = (hz) => Math.sin(2 * Math.PI * hz * seconds);
      this.tilt = [SWING.rollDegrees * turn(SWING.rollHz), SWING.pitchDegrees * turn(SWING.pitchHz)];
    } else if (mode === 'hand') {
      const share = 1 - Math.exp(-passed / FOLLOWS_S);
      this.tilt = [this.tilt[0] + share * (roll - this.tilt[0]), this.tilt[1] + share * (pitch - this.tilt[1])];
    }
  }

  // roll and pitch in degrees; null where nobody knows them
  get truth() {
    const { mode } = this.settings;
    return mode === 'recording' ? this.recording.truth : mode === 'phone' ? null : this.tilt;
  }

  acceleration() {
    const { mode, phone } = this.settings;
    const felt = mode === 'phone' ? [...(phone ?? [0, 0, 1])] : upward(this.tilt);
    const sincePush = this.seconds - this.pushedAt, sinceKnock = this.seconds - this.knockedAt;
    if (sincePush < PUSH.lastsS) { // along the horizontal beside the sensor's x axis
      felt[1] += PUSH.g * Math.cos(this.tilt[0] * RADIANS);
      felt[2] -= PUSH.g * Math.sin(this.tilt[0] * RADIANS);
    }
    if (sinceKnock < KNOCK.lastsS) {
      const g = KNOCK.g * Math.exp(-sinceKnock / KNOCK.decayS) * Math.cos(2 * Math.PI * KNOCK.hz * sinceKnock);
      for (const axis of [0, 1, 2]) felt[axis] += g * KNOCK.along[axis];
    }
    return felt;
  }

  outlier() {
    const size = OUTLIER.least + (OUTLIER.most - OUTLIER.least) * this.random();
    return this.random() < 0.5 ? size : -size;
  }

  // the sensor's next sample in LSB; null: none
  sample(periodUs) {
    const { mode, noise, outliers } = this.settings;
    const clean = mode === 'recording' ? this.recording.next(this.us, periodUs) : this.acceleration().map((g, axis) => g * LSB_PER_G[axis]);
    if (clean === null || mode === 'recording') return clean;
    return clean.map((lsb) => {
      const spoilt = lsb + noise * this.normal() + (this.random() < outliers ? this.outlier() : 0);
      return Math.max(LEAST, Math.min(MOST, Math.round(spoilt)));
    });
  }
}
