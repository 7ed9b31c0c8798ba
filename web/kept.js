/* The EEPROM's content in this browser: what is absent or not readable is an empty EEPROM. */
"use strict";

class Kept {
  constructor(name, say) { Object.assign(this, { name, say, warned: false }); }

  read() {
    let text = null;
    try { text = localStorage.getItem(this.name); } catch (error) { this.warn(error); }
    try {
      return text && Uint8Array.from(atob(text), (each) => each.charCodeAt(0));
    } catch {
      this.say("The EEPROM that this browser has kept cannot be read: it is empty.");
      return null;
    }
  }

  write(bytes) {
    try {
      localStorage.setItem(this.name, btoa(String.fromCharCode(...bytes)));
      this.warned = false;
    } catch (error) {
      this.warn(error);
    }
  }

  warn(error) {
    if (this.warned) return;
    this.warned = true;
    this.say(error.name === "QuotaExceededError" ? "This browser's storage is full: saved settings last until the page is closed." :
      "This browser does not let the page store anything: saved settings last until the page is closed.");
  }
}
