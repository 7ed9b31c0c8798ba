/* The motion sensor of a phone: its acceleration in g, in the ADXL345's axes. */
"use strict";

const G = 9.80665, FIRST_EVENT_MS = 2000;

class Motion {
  constructor(onMotion) { Object.assign(this, { onMotion, heard: false, listener: null }); }

  /* why there is none, or null */
  static absent() {
    if (!isSecureContext || location.protocol === "file:") return "A phone's motion sensor needs this page over https.";
    return "DeviceMotionEvent" in window ? null : "This browser has no motion sensor.";
  }

  /* Asks as iOS wants: within a click. Resolves once the sensor reports; an error says why it does not. */
  async start() {
    const asks = typeof DeviceMotionEvent.requestPermission === "function";
    const sign = navigator.vendor.startsWith("Apple") ? -1 : 1; /* WebKit reports the opposite of the standard's sign */
    if (asks && await DeviceMotionEvent.requestPermission().catch(() => "denied") !== "granted") {
      throw new Error("the motion sensor was refused: allow motion for this site in the browser's settings");
    }
    this.stop();
    this.heard = false;
    this.listener = ({ accelerationIncludingGravity: felt }) => {
      if (!felt || felt.x === null) return;
      this.heard = true;
      this.onMotion([felt.x, felt.y, felt.z].map((each) => sign * each / G));
    };
    addEventListener("devicemotion", this.listener);
    await new Promise((resolve) => setTimeout(resolve, FIRST_EVENT_MS));
    if (!this.heard && this.listener) {
      this.stop();
      throw new Error("the motion sensor does not report: has this device one?");
    }
  }

  stop() {
    if (this.listener) removeEventListener("devicemotion", this.listener);
    this.listener = null;
  }
}
