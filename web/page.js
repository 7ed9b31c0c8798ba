/* What every page has: rows in, charts, horizon, flags, filter switch and console out. */
"use strict";

const LIT_MS = 500, FRAME_MS = 30, TEXT_MS = 100, LOG_LINES = 300, ASK_MS = 300, STALE_MS = 1500;
const byId = (id) => document.getElementById(id);
const degrees = (value) => `${value.toFixed(2)}\u00b0`.replace("-", "\u2212");

/* A page adds a source, {send(text)}, which calls begin, feed, state and log. */
class Page {
  constructor() {
    this.history = new RowHistory();
    this.protocol = new Protocol({ row: (row) => this.row(row), note: (text) => this.note(text) });
    this.charts = [this.chart("roll", { raw: "rawRoll", filtered: "roll", truth: "trueRoll", limit: 180 }),
      this.chart("pitch", { raw: "rawPitch", filtered: "pitch", truth: "truePitch", limit: 90 })];
    this.lamps = FLAGS.map(([bit, name, kind]) => this.lamp(bit, name, kind));
    Object.assign(this, { newest: null, arrivedMs: -Infinity, fault: null, logged: [], past: [], pastAt: 0, asked: true, filter: "", filters: [],
      dirty: true, frozenS: null, drawnMs: -Infinity, writtenMs: -Infinity, firstPictureMs: null, begunMs: null });
    for (const element of document.querySelectorAll("[data-truth]")) element.hidden = !this.knowsTruth;
    byId("ladder").innerHTML = horizonLadder();
    this.listen();
    this.recolour();
    requestAnimationFrame((now) => this.frame(now));
  }

  chart(title, { truth, ...rest }) { return new Chart(byId(title), title, { ...rest, truth: this.knowsTruth ? truth : null }); }

  /* the source knows the true angles of each row */
  get knowsTruth() { return false; }

  /* called by the sources */

  begin(whole) {
    this.protocol.begin(whole);
    this.asked = false;
    this.fault = null;
    this.begunMs ??= performance.now();
    byId("state").title = "";
    this.dirty = true;
  }

  feed(text) {
    const now = performance.now();
    this.protocol.feed(text, now);
    this.arrivedMs = now;
    if (this.protocol.broken > 20 && this.protocol.rows === 0 && !this.warned) {
      this.warned = true;
      this.log("no line is from tilt-uno: check the baud rate", "fault-line");
    }
  }

  state(kind, words) {
    byId("dot").className = `dot ${kind}`;
    byId("state").textContent = words;
    this.words = words;
    this.kind = kind;
    if (kind !== "up") this.log(words, "said");
  }

  log(text, kind) {
    this.logged.push([text, kind]);
    if (this.logged.length > LOG_LINES) this.logged.shift();
    this.dirty = true;
  }

  /* called by the protocol */

  row(row) {
    this.history.push(row);
    this.newest = row;
    this.inBanner = false;
    const now = performance.now();
    for (const lamp of this.lamps) {
      if (row.flags & lamp.bit) { lamp.count++; lamp.litMs = now; }
    }
    this.dirty = true;
    if (!this.asked) this.ask();
  }

  note(text) {
    const begun = /^fault (\d+): (.*)$/.exec(text), over = /^fault (\d+) over/.test(text), state = /^state \w+, fault (\d+)/.exec(text);
    if (begun) this.fault = `fault ${begun[1]}: ${begun[2]}`;
    else if (over || /^tilt-uno /.test(text)) this.fault = null;
    else if (state) this.fault = Number(state[1]) ? this.fault || `fault ${state[1]}` : null;
    const names = /^(?:filter(?: \w+)?:|refused(?: \d+)?: filter is one of) ?([^;]+)/.exec(text), now = /^filter[ =]+(\w+)/.exec(text);
    if (names) this.offer(names[1].split(/[ ,]+/).filter(Boolean));
    if (now) this.choose(now[1]);
    /* loaded or reset settings may select another filter; a banner names its own */
    if (/^tilt-uno /.test(text)) this.inBanner = true;
    else if (/^settings: /.test(text) && !this.inBanner) this.send("filter");
    this.log(`# ${text}`, begun ? "fault-line" : "");
  }

  /* Asks which filters there are and which one is in use, once rows arrive, one line at a time. */
  async ask() {
    this.asked = true;
    await this.send("filter");
    setTimeout(() => this.send("filter ?"), ASK_MS); /* refused with the list of filters; help would pause the rows */
  }

  async send(text) {
    if (!/^[ -~]{1,40}$/.test(text)) { this.log("a command has 1 to 40 characters without accents", "fault-line"); return; }
    try {
      if (!this.source) throw new Error("not connected");
      await this.source.send(text);
    } catch (error) {
      this.log(`${text}: not sent: ${error.message}`, "fault-line");
      this.choose(this.filter);
    }
  }

  /* parts of the page */

  lamp(bit, name, kind) {
    const item = document.createElement("li");
    item.innerHTML = `<i></i><b></b><small></small>`;
    item.querySelector("b").textContent = name;
    item.className = kind;
    byId("lamps").append(item);
    return { bit, name, kind, item, count: 0, litMs: -Infinity, shown: "" };
  }

  offer(names) {
    if (names.join() === this.filters.join()) return;
    this.filters = names;
    const box = byId("filters");
    box.replaceChildren(...names.map((name) => {
      const label = document.createElement("label"), input = document.createElement("input"), words = document.createElement("span");
      Object.assign(input, { type: "radio", name: "filter", value: name });
      input.addEventListener("change", () => { box.classList.add("asked"); this.send(`filter ${name}`); });
      words.textContent = name;
      label.append(input, words);
      return label;
    }));
    this.choose(this.filter);
  }

  /* Marks the filter that the board reports as in use, whatever was clicked. */
  choose(name) {
    this.filter = name;
    byId("filters").classList.remove("asked");
    for (const input of byId("filters").querySelectorAll("input")) input.checked = input.value === name;
  }

  listen() {
    for (const id of ["span", "scale"]) byId(id).addEventListener("change", () => this.rescale());
    byId("pause").addEventListener("click", () => this.pause());
    byId("theme").addEventListener("click", () => this.turn());
    byId("command").addEventListener("submit", (event) => { event.preventDefault(); this.typed(); });
    byId("line").addEventListener("keydown", (event) => this.recall(event));
    for (const button of document.querySelectorAll("[data-send]")) button.addEventListener("click", () => this.send(button.dataset.send));
    addEventListener("resize", () => { this.dirty = true; });
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.recolour());
  }

  typed() {
    const text = byId("line").value.trim();
    if (!text) return;
    byId("line").value = "";
    this.past.push(text);
    this.pastAt = this.past.length;
    this.send(text);
  }

  recall(event) {
    const step = { ArrowUp: -1, ArrowDown: 1 }[event.key];
    if (!step || !this.past.length) return;
    event.preventDefault();
    this.pastAt = Math.min(this.past.length, Math.max(0, this.pastAt + step));
    byId("line").value = this.past[this.pastAt] ?? "";
  }

  rescale() {
    for (const chart of this.charts) chart.fresh = true;
    this.dirty = true;
  }

  pause() {
    this.frozenS = this.frozenS === null ? this.history.last : null;
    byId("pause").setAttribute("aria-pressed", String(this.frozenS !== null));
    byId("pause").textContent = this.frozenS === null ? "Pause" : "Resume";
    this.dirty = true;
  }

  isDark() {
    const chosen = document.documentElement.dataset.theme;
    return chosen ? chosen === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
  }

  turn() {
    document.documentElement.dataset.theme = this.isDark() ? "light" : "dark";
    this.recolour();
  }

  /* A canvas cannot read style sheet variables, so an element resolves each of them. */
  recolour() {
    const probe = byId("dot"), style = probe.style.color;
    this.colours = {};
    for (const name of ["raw", "filtered", "truth", "gate", "absent", "grid", "dim", "ink"]) {
      probe.style.color = `var(--${name})`;
      this.colours[name] = getComputedStyle(probe).color;
    }
    probe.style.color = style;
    byId("theme").textContent = this.isDark() ? "Light" : "Dark";
    this.dirty = true;
  }

  /* drawing, independent of the arrival of rows */

  frame(now) {
    if (this.dirty && now - this.drawnMs >= FRAME_MS) {
      this.drawnMs = now;
      this.dirty = false;
      this.draw();
    }
    if (now - this.writtenMs >= TEXT_MS) {
      this.writtenMs = now;
      this.write(now);
    }
    requestAnimationFrame((next) => this.frame(next));
  }

  draw() {
    const end = this.frozenS ?? this.history.last;
    for (const chart of this.charts) chart.draw(this.history, end, Number(byId("span").value), Number(byId("scale").value), this.colours);
    if (this.newest) byId("horizon").setAttribute("transform", horizonTransform(this.newest.roll, this.newest.pitch));
    if (this.firstPictureMs === null && this.history.count > 1) {
      this.firstPictureMs = performance.now();
      this.log(`first picture ${((this.firstPictureMs - (this.begunMs ?? 0)) / 1000).toFixed(2)} s after connecting`, "said");
    }
  }

  write(now) {
    const { protocol, newest } = this, stale = performance.now() - this.arrivedMs > STALE_MS;
    const rate = stale ? 0 : this.history.rate();
    byId("rate").textContent = rate < 100 ? rate.toFixed(1) : rate.toFixed(0);
    byId("rows").textContent = protocol.rows.toLocaleString("en");
    const lost = byId("lost"), unknown = protocol.mode === "plot";
    lost.textContent = unknown ? "unknown (mode plot)" : protocol.losses.lost.toLocaleString("en");
    lost.className = !unknown && protocol.losses.lost ? "bad" : "";
    byId("broken").textContent = protocol.broken.toLocaleString("en");
    if (newest) this.readings(newest);
    for (const lamp of this.lamps) this.light(lamp, performance.now());
    const fault = byId("fault"), words = this.fault || "no fault reported";
    if (fault.textContent !== words) fault.textContent = words;
    fault.classList.toggle("lit", this.fault !== null);
    this.writeLog();
  }

  readings(row) {
    byId("roll-now").textContent = degrees(row.roll);
    byId("pitch-now").textContent = degrees(row.pitch);
    byId("size-now").textContent = row.mg ? `${(Math.hypot(...row.mg) / 1000).toFixed(3)} g` : "\u2013";
  }

  light(lamp, now) {
    const lit = now - lamp.litMs < LIT_MS, shown = `${lit} ${lamp.count}`;
    if (shown === lamp.shown) return;
    lamp.shown = shown;
    lamp.item.className = `${lamp.kind}${lit ? " lit" : ""}`;
    lamp.item.querySelector("small").textContent = lamp.count ? lamp.count.toLocaleString("en") : "";
    lamp.item.setAttribute("aria-label", `${lamp.name}: ${lit ? "on" : "off"}, ${lamp.count} rows`);
  }

  writeLog() {
    if (!this.logged.length) return;
    const box = byId("log"), follow = box.scrollTop + box.clientHeight >= box.scrollHeight - 4;
    for (const [text, kind] of this.logged.splice(0)) {
      const line = document.createElement("div");
      line.textContent = text;
      line.className = kind || "";
      box.append(line);
    }
    while (box.childElementCount > LOG_LINES) box.firstElementChild.remove();
    if (follow) box.scrollTop = box.scrollHeight;
  }

  /* Figures for tests and for the console. */
  figures() {
    const { protocol, history, fault, filter, filters, firstPictureMs, begunMs, kind, words } = this;
    const lamps = Object.fromEntries(this.lamps.map(({ name, count, item }) => [name, { count, lit: item.classList.contains("lit") }]));
    return { rows: protocol.rows, lost: protocol.losses.lost, broken: protocol.broken, restarts: protocol.restarts,
      mode: protocol.mode, rate: history.rate(), fault, filter, filters, firstPictureMs, begunMs, kind, words, lamps };
  }
}
