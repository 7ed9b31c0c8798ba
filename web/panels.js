/* The parts that the pages share, as HTML: an element with data-panel="NAME" is filled with the part of that name. */
"use strict";

const PANELS = {
  figures: `
    <div><dt>rows/s</dt><dd id="rate">0</dd></div>
    <div><dt>received</dt><dd id="rows">0</dd></div>
    <div title="rows that the board dropped (flag 256) or the line lost, found by gaps in the rows' times">
      <dt>lost</dt><dd id="lost">0</dd></div>
    <div title="lines that are neither a row nor a comment: cut or garbled on the line"><dt>broken lines</dt><dd id="broken">0</dd></div>`,

  charts: `
    <div class="bar">
      <span><i class="key"></i>raw</span><span><i class="key filtered"></i>filtered</span>
      <span data-truth hidden><i class="key truth"></i>truth</span>
      <span><i class="key gate"></i>gated</span><span><i class="key absent"></i>no sample</span>
      <div class="end">
        <label>window <select id="span"><option value="5">5 s<option value="10" selected>10 s
          <option value="30">30 s<option value="60">60 s</select></label>
        <label>scale <select id="scale"><option value="0">automatic<option value="15">&plusmn;15&deg;<option value="45">&plusmn;45&deg;
          <option value="90">&plusmn;90&deg;<option value="180">&plusmn;180&deg;</select></label>
        <button type="button" id="pause" aria-pressed="false">Pause</button>
        <button type="button" id="theme">Dark</button>
      </div>
    </div>
    <div class="plot"><canvas id="roll" role="img" aria-label="roll, raw and filtered, over the last seconds"></canvas></div>
    <div class="plot"><canvas id="pitch" role="img" aria-label="pitch, raw and filtered, over the last seconds"></canvas></div>`,

  attitude: `
    <svg viewBox="-74 -74 148 148" role="img" aria-label="artificial horizon, seen along the sensor's x axis">
      <title>Seen along the sensor's x axis, y to the left, z up</title>
      <clipPath id="round"><circle r="72"/></clipPath>
      <g clip-path="url(#round)">
        <g id="horizon">
          <rect x="-110" y="-330" width="220" height="330" fill="var(--sky)"/><rect x="-110" width="220" height="330" fill="var(--ground)"/>
          <g id="ladder" stroke="#fff" stroke-width="1.4" font-size="8" fill="#fff" text-anchor="middle"></g>
          <line x1="-110" x2="110" stroke="#fff" stroke-width="2"/>
        </g>
      </g>
      <circle r="72" fill="none" stroke="var(--edge)" stroke-width="3"/>
      <path d="M-44 0h26l9 9 9-9 9 9 9-9h26" fill="none" stroke="#1b1300" stroke-width="5.5" stroke-linejoin="round"/>
      <path d="M-44 0h26l9 9 9-9 9 9 9-9h26" fill="none" stroke="#ffd23f" stroke-width="3" stroke-linejoin="round"/>
    </svg>
    <dl><dt>roll</dt><dd id="roll-now">&ndash;</dd><dt>pitch</dt><dd id="pitch-now">&ndash;</dd>
      <dt>|a| filtered</dt><dd class="small" id="size-now">&ndash;</dd></dl>`,

  filters: `<fieldset><legend>Filter</legend><div class="choices" id="filters">waiting for the board</div></fieldset>`,

  flags: `<h2>Flags <span>of the last half second; rows so far</span></h2><ul class="lamps" id="lamps"></ul>`,

  console: `
    <div id="log" role="log" tabindex="0" aria-label="messages of the board"></div>
    <form id="command"><input id="line" maxlength="40" autocomplete="off" spellcheck="false" aria-label="command"
      placeholder="a command, such as rate 200"
      title="Arrow up: earlier commands"><button class="first">Send</button>
      <button type="button" data-send="status">status</button><button type="button" data-send="help">help</button>
      <button type="button" data-send="stop">stop</button><button type="button" data-send="go">go</button></form>`,
};

for (const place of document.querySelectorAll("[data-panel]")) place.innerHTML = PANELS[place.dataset.panel];
