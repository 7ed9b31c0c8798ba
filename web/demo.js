/* The demo: the firmware in a Web Worker as the source of the lines, and a person's hands on the virtual sensor. */
"use strict";

const MOST_DEGREES = 80, KEY_DEGREES = 5, DEGREES_PER_PIXEL = 0.8, FILE_MB = 64;
const BEHIND = 0.9, BEHIND_FOR = 3; /* of the pace asked for, in so many reports in a row */
const SLACK_US = 20000, MOST_MEASURED = 4000;
const PAD_KEYS = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [-1, 0], ArrowDown: [1, 0] }; /* the side that goes down: x, y */
const bytesOf = (base64) => Uint8Array.from(atob(base64.trim()), (each) => each.charCodeAt(0));
const limited = (value) => Math.max(-MOST_DEGREES, Math.min(MOST_DEGREES, value));

class DemoPage extends Page {
  get knowsTruth() { return true; }

  start() {
    this.measured = []; /* [t_us, [roll, pitch] or null, lsb or null] since the last row */
    this.hand = [0, 0];
    this.powered = true;
    this.behind = 0;
    this.kept = new Kept("tilt-uno EEPROM", (words) => this.notice(words));
    this.motion = new Motion((phone) => this.world({ phone }));
    this.source = { send: async (text) => this.typeOn(text) };
    const flash = new Uint8Array(32768).fill(0xff);
    flash.set(bytesOf(byId("image").textContent));
    const seed = Number(new URLSearchParams(location.hash.slice(1)).get("seed") ?? 1);
    this.worker = new Worker(URL.createObjectURL(new Blob([byId("worker").textContent], { type: "text/javascript" })));
    this.worker.onmessage = ({ data }) => { for (const [name, value] of Object.entries(data)) this.on[name]?.(value); };
    this.worker.onerror = (event) => this.stopped(event.message || "the simulation could not be started");
    const world = { outliers: Number(byId("outliers").value) / 100, noise: Number(byId("noise").value) };
    this.tell({ start: { program: flash.buffer, eeprom: this.kept.read(), seed, world } });
    byId("phone-hint").textContent = Motion.absent() ?? "";
    byId("phone-choice").hidden = Motion.absent() !== null;
  }

  typeOn(text) {
    if (!this.powered) throw new Error("the board is switched off");
    this.tell({ typed: text });
    this.log(`> ${text}`, "typed");
  }

  tell(message) { this.worker.postMessage(message); }

  world(changes) { this.tell({ world: changes }); }

  /* what the worker says */

  get on() {
    return {
      booted: () => this.begin(true),
      samples: (samples) => { this.measured = [...this.measured, ...samples].slice(-MOST_MEASURED); },
      text: (text) => { if (text) this.feed(text); this.turnBoard(); },
      led: (on) => byId("led").classList.toggle("on", on),
      status: (status) => this.status(status),
      eeprom: (bytes) => this.kept.write(bytes),
      replays: (recording) => this.replays(recording),
      refused: (why) => this.refused(why),
      broken: (why) => this.stopped(why),
    };
  }

  status({ on, pace, speed }) {
    this.pace = pace;
    const words = on ? `simulated UNO, ${pace.toFixed(2)} \u00d7 real time` : "switched off";
    this.state(on ? "up" : "off", words);
    const slow = on && speed && pace < BEHIND * speed && !document.hidden;
    this.behind = slow ? this.behind + 1 : 0;
    if (this.behind === BEHIND_FOR) {
      this.notice(`This browser falls behind: ${pace.toFixed(2)} times real time instead of ${speed}. The simulation goes on, slower.`);
    }
  }

  state(kind, words) {
    if (kind !== "off") super.state(kind, words);
    else if (this.words !== words) super.state("wait", words);
  }

  replays({ name, rows, hz }) {
    byId("recording-choice").hidden = false;
    byId("recording-name").textContent = `replays ${name}`;
    this.mark("recording");
    this.log(`replaying ${name}: ${rows.toLocaleString("en")} rows at ${hz.toFixed(1)} Hz, over and over`, "said");
  }

  refused(why) {
    this.notice(`${why}. The page goes on without it.`);
  }

  stopped(why) {
    this.state("down", `the simulation has stopped: ${why}`);
    this.notice(`The simulation has stopped: ${why}. Reload the page to start it again.`);
  }

  /* a sentence for a person, where it cannot be overlooked, until it is closed or another comes */
  notice(words) {
    byId("notice-words").textContent = words;
    byId("notice").hidden = false;
    this.log(words, "said");
  }

  /* rows with the truth */

  row(row) {
    const truth = this.truthOf(row.t_us);
    super.row(truth ? { ...row, trueRoll: truth[0], truePitch: truth[1] } : row);
  }

  truthOf(t_us) {
    const { measured } = this;
    if (t_us === undefined) return measured.at(-1)?.[1]; /* mode plot */
    let nearest = 0;
    measured.forEach((each, n) => { if (Math.abs(each[0] - t_us) <= Math.abs(measured[nearest][0] - t_us)) nearest = n; });
    measured.splice(0, nearest); /* what was before, a reset's other times too */
    return measured.length && Math.abs(measured[0][0] - t_us) < SLACK_US ? measured[0][1] : null;
  }

  begin(whole) {
    this.measured = [];
    super.begin(whole);
  }

  /* hands */

  listen() {
    super.listen();
    this.listenToPad();
    for (const input of document.querySelectorAll("[name=mode]")) input.addEventListener("change", () => this.choice(input.value));
    for (const [id, unit, scale] of [["outliers", "%", 100], ["noise", "LSB", 1]]) {
      byId(id).addEventListener("input", ({ target }) => {
        byId(`${id}-now`).textContent = `${target.value} ${unit}`;
        this.world({ [id]: Number(target.value) / scale });
      });
    }
    for (const button of document.querySelectorAll("[data-press]")) {
      button.addEventListener("click", () => this.tell({ press: button.dataset.press }));
    }
    for (const button of document.querySelectorAll("[data-hold]")) button.addEventListener("click", () => this.hold(button));
    byId("speed").addEventListener("change", ({ target }) => this.tell({ speed: Number(target.value) }));
    byId("notice-close").addEventListener("click", () => { byId("notice").hidden = true; });
    this.listenToFiles();
  }

  hold(button) {
    const held = button.getAttribute("aria-pressed") !== "true", { hold } = button.dataset;
    button.setAttribute("aria-pressed", String(held));
    if (hold === "power") this.powered = !held;
    this.tell(hold === "power" ? { power: !held } : { fault: [hold, held] });
  }

  mark(mode) {
    this.mode = mode;
    for (const each of document.querySelectorAll("#outliers, #noise, [data-press=knock], [data-press=push]")) each.disabled = mode === "recording";
    document.querySelector(`[name=mode][value=${mode}]`).checked = true;
  }

  async choice(mode) {
    const before = this.mode ?? "self";
    if (mode !== "phone") this.motion.stop();
    this.mark(mode);
    this.world({ mode });
    if (mode !== "phone") return;
    try {
      await this.motion.start();
    } catch (error) {
      this.mark(before);
      this.world({ mode: before });
      this.notice(`This phone is not used: ${error.message}.`);
    }
  }

  /* follows a hand to [roll, pitch] in degrees */
  follow(roll, pitch) {
    this.hand = [limited(roll), limited(pitch)];
    if (this.mode !== "hand") { this.motion.stop(); this.mark("hand"); }
    this.world({ mode: "hand", roll: this.hand[0], pitch: this.hand[1] });
  }

  listenToPad() {
    const pad = byId("pad");
    let from = null;
    pad.addEventListener("pointerdown", (event) => {
      pad.setPointerCapture(event.pointerId);
      from = { x: event.clientX, y: event.clientY, tilt: this.shown ?? this.hand };
    });
    pad.addEventListener("pointermove", (event) => {
      if (!from || !event.buttons) return;
      this.follow(from.tilt[0] + (event.clientY - from.y) * DEGREES_PER_PIXEL, from.tilt[1] + (event.clientX - from.x) * DEGREES_PER_PIXEL);
    });
    pad.addEventListener("pointerup", () => { from = null; });
    pad.addEventListener("keydown", (event) => {
      const by = PAD_KEYS[event.key], now = this.mode === "hand" ? this.hand : this.shown ?? this.hand;
      if (!by && event.key !== "Home") return;
      event.preventDefault();
      if (by) this.follow(now[0] + KEY_DEGREES * by[0], now[1] + KEY_DEGREES * by[1]);
      else this.follow(0, 0);
    });
  }

  /* The board in the picture: as the truth says, else as the filtered angles say. Seen from the front, y away, x to the right. */
  turnBoard() {
    const last = this.measured.at(-1), { newest } = this;
    if (last) this.newestTruth = last[1];
    const [roll, pitch] = this.newestTruth ?? [newest?.roll ?? 0, newest?.pitch ?? 0];
    this.shown = [limited(roll), limited(pitch)];
    byId("board").style.transform = `rotateX(${(48 - roll).toFixed(1)}deg) rotateY(${pitch.toFixed(1)}deg)`;
  }

  listenToFiles() {
    byId("file").addEventListener("change", ({ target }) => { if (target.files[0]) this.open(target.files[0]); target.value = ""; });
    const over = (on) => (event) => { event.preventDefault(); document.body.classList.toggle("dropping", on); };
    addEventListener("dragover", over(true));
    addEventListener("dragleave", over(false));
    addEventListener("drop", (event) => {
      over(false)(event);
      if (event.dataTransfer.files[0]) this.open(event.dataTransfer.files[0]);
      else this.refused("What was dropped is no file");
    });
  }

  async open(file) {
    try {
      if (file.size > FILE_MB * 1e6) throw new Error(`more than ${FILE_MB} MB`);
      this.tell({ recording: { name: file.name, text: await file.text() } });
    } catch (error) {
      this.refused(`${file.name}: ${error.message}`);
    }
  }

  figures() { return { ...super.figures(), pace: this.pace, sensor: this.mode ?? "self" }; }
}

const tiltPage = new DemoPage();
tiltPage.start();
