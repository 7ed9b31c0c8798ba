/* The page of tilt live: lines from tilt live, or from the port itself. */
"use strict";

const REOPEN_MS = 300;

class Served {
  constructor(app, token) {
    Object.assign(this, { app, token, state: null });
    const events = new EventSource(`/events?token=${encodeURIComponent(token)}`);
    const on = (kind, act) => events.addEventListener(kind, (event) => act(JSON.parse(event.data)));
    on("lines", (text) => app.feed(text));
    on("sent", (text) => app.log(`> ${text}`, "typed"));
    on("missed", (count) => app.log(`this page was too slow or away: it missed ${count} pieces of the board's output`, "fault-line"));
    on("problem", (text) => app.log(text, "fault-line"));
    on("state", (text) => this.update(JSON.parse(text)));
    on("ended", () => { events.close(); app.state("down", "tilt live has ended: start it again and open its new address"); });
    events.onerror = () => app.state("wait", events.readyState === EventSource.CLOSED ?
      "refused: open the address that tilt live printed" : "tilt live does not answer: trying again");
    events.onopen = () => { if (this.state) this.show(); };
  }

  update(state) {
    this.state = state;
    if (state.connected) this.app.begin(true);
    this.show();
  }

  show() {
    const { connected, port, baud, why } = this.state;
    if (connected) this.app.state("up", `${port}, ${baud} baud`);
    else this.app.state("wait", `${port} is gone (${why}): waiting for it`);
  }

  async send(text) {
    const answer = await fetch("/send", { method: "POST", body: text, headers: { "X-Tilt-Token": this.token } });
    if (!answer.ok) throw new Error(await answer.text());
  }
}

class Direct {
  constructor(app) {
    Object.assign(this, { app, port: null, baud: 115200, wanted: false });
    app.state("wait", "not connected");
    /* the browser reports a returning board of this page a little before it can be opened */
    navigator.serial.addEventListener("connect", (event) => { if (this.wanted && !this.port) setTimeout(() => this.open(event.target), REOPEN_MS); });
  }

  async connect(baud) {
    let port;
    try { port = await navigator.serial.requestPort(); } catch { return; } /* nothing chosen */
    this.baud = baud;
    this.wanted = true;
    await this.open(port);
  }

  async open(port) {
    try {
      await port.open({ baudRate: this.baud, bufferSize: 65536 });
    } catch (error) {
      this.app.state("down", `cannot open the port (${error.message}): is it in use by another program?`);
      return;
    }
    this.port = port;
    this.app.begin(false);
    this.app.state("up", `serial port of this browser, ${this.baud} baud`);
    const why = await this.read(port);
    this.port = null;
    await port.close().catch(() => {});
    this.app.state("wait", this.wanted ? `the port is gone (${why}): plug it in again` : "not connected");
  }

  /* Reads until the port ends or is closed; returns why. Breaks, framing errors and overruns cost bytes and the reader, not the port. */
  async read(port) {
    const decoder = new TextDecoder("latin1");
    let why = "end of data";
    while (port.readable && this.wanted) {
      this.reader = port.readable.getReader();
      try {
        for (;;) {
          const { value, done } = await this.reader.read();
          if (done) return why;
          this.app.feed(decoder.decode(value));
        }
      } catch (error) {
        why = error.message;
        this.app.log(`serial port: ${why}`, "said");
      } finally {
        this.reader.releaseLock();
      }
    }
    return why;
  }

  async disconnect() {
    this.wanted = false;
    if (this.port) await this.reader.cancel().catch(() => {});
  }

  async send(text) {
    /* a browser changes the rate only by reopening the port, which resets the board to its saved rate */
    if (/^baud +\d/i.test(text)) throw new Error("choose the baud rate beside Connect; only `tilt live PORT` follows `baud N`");
    if (!this.port) throw new Error("not connected");
    const writer = this.port.writable.getWriter();
    try { await writer.write(new TextEncoder().encode(`${text}\n`)); } finally { writer.releaseLock(); }
    this.app.log(`> ${text}`, "typed");
  }
}

class LivePage extends Page {
  state(kind, words) {
    super.state(kind, words);
    if (this.source instanceof Direct) byId("connect").textContent = this.source.port ? "Disconnect" : "Connect a board";
  }

  listen() {
    super.listen();
    byId("connect").addEventListener("click", () => this.source.port ? this.source.disconnect() : this.source.connect(Number(byId("baud").value)));
  }

  start() {
    const token = location.hash.slice(1), served = location.protocol === "http:" && token;
    if (served) this.source = new Served(this, token);
    else if ("serial" in navigator) {
      byId("direct").hidden = false;
      this.source = new Direct(this);
    } else this.state("down", "this browser has no WebSerial: use Chrome or Edge, or run `tilt live PORT`");
  }
}

const tiltPage = new LivePage();
tiltPage.start();
