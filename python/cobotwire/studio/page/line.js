// List the frames and the noise on the line; only the rows that are visible are in the document.

import { byId, clock, el, oncePerFrame } from "./dom.js";

// The server keeps more, so that every row can be explained.
const KEPT = 10000;
const DROPPED_AT_ONCE = 1000;
const ARROWS = { sent: "→", received: "←", unknown: "·" };

export class Line {
  // `choose` gets the number of the entry that the user chooses.
  constructor(choose) {
    this.choose = choose;
    this.entries = [];
    this.rows = new Rows();
    this.paused = null;
    this.lost = 0;
    this.chosen = null;
    this.follows = true;
    this.commands = new Set();
    this.noises = new Set();
    this.pool = [];
    this.place = byId("rows");
    this.spacer = this.place.firstElementChild;
    this.redraw = oncePerFrame(() => this.draw());
    this.listen();
  }

  listen() {
    for (const id of ["search", "by-command", "by-direction", "by-noise", "queries"]) {
      byId(id).addEventListener("input", () => this.filter());
    }
    byId("pause").addEventListener("click", () => this.pause(this.paused === null));
    byId("clear").addEventListener("click", () => this.clear());
    this.place.addEventListener("scroll", () => {
      const { scrollTop, clientHeight, scrollHeight } = this.place;
      this.follows = scrollTop + clientHeight > scrollHeight - 2 * this.rowHeight;
      this.redraw();
    });
    this.place.addEventListener("click", (event) => {
      const row = event.target.closest(".row");
      // The row is found by its key, since the list may have changed since it was drawn.
      if (row) this.select(this.shown.findIndex((each) => each.key === Number(row.dataset.key)));
    });
    this.place.addEventListener("keydown", (event) => this.key(event));
    new ResizeObserver(this.redraw).observe(this.place);
  }

  key(event) {
    const page = Math.floor(this.place.clientHeight / this.rowHeight) - 1;
    const now = this.shown.findIndex((row) => row.key === this.chosen);
    const end = this.shown.length - 1;
    const start = now < 0 ? end + 1 : now;
    const goals = {
      ArrowDown: start + 1,
      ArrowUp: start - 1,
      PageDown: start + page,
      PageUp: start - page,
      Home: 0,
      End: end,
    };
    if (!(event.key in goals) || end < 0) return;
    event.preventDefault();
    this.follows = false;
    this.select(Math.min(end, Math.max(0, goals[event.key])), true);
  }

  get rowHeight() {
    return matchMedia("(max-width: 700px)").matches ? 44 : 26;
  }

  add(entries) {
    if (this.paused !== null) {
      this.paused.push(...entries);
      this.paused.splice(0, Math.max(0, this.paused.length - KEPT));
      this.count();
      return;
    }
    for (const entry of entries) {
      this.entries.push(entry);
      this.note(entry);
      if (this.matches(entry)) this.rows.add(entry);
    }
    if (this.entries.length > KEPT + DROPPED_AT_ONCE) {
      this.entries.splice(0, this.entries.length - KEPT);
      const first = this.entries[0].n;
      const before = this.shown.length;
      this.rows.drop(first);
      if (!this.follows) this.place.scrollTop -= (before - this.shown.length) * this.rowHeight;
    }
    this.redraw();
  }

  // Offer what has been seen in the filters.
  note(entry) {
    if (entry.k === "frame" && !this.commands.has(entry.l)) {
      this.commands.add(entry.l);
      insertOption(byId("by-command"), entry.l, 1);
    } else if (entry.k !== "frame" && !this.noises.has(entry.l)) {
      this.noises.add(entry.l);
      insertOption(byId("by-noise"), entry.l, 3);
    }
  }

  matches(entry) {
    const command = byId("by-command").value;
    const direction = byId("by-direction").value;
    const noise = byId("by-noise").value;
    const wanted = byId("search").value.trim().toLowerCase();
    if (command && !(entry.k === "frame" && entry.l === command)) return false;
    if (direction && entry.d !== direction) return false;
    if (noise === "none" && entry.k !== "frame") return false;
    if (noise === "any" && entry.k === "frame") return false;
    if (noise && noise !== "none" && noise !== "any" && entry.l !== noise) return false;
    return !wanted || `${entry.l} ${entry.x} ${entry.h}`.toLowerCase().includes(wanted);
  }

  get shown() {
    return this.rows.list;
  }

  filter() {
    this.rows = new Rows(byId("queries").value);
    for (const entry of this.entries) if (this.matches(entry)) this.rows.add(entry);
    this.follows = true;
    this.redraw();
  }

  pause(on) {
    byId("pause").setAttribute("aria-pressed", String(on));
    byId("pause").textContent = on ? "Continue" : "Pause";
    const held = this.paused ?? [];
    this.paused = on ? [] : null;
    if (!on) this.add(held);
    this.count();
  }

  clear() {
    this.entries = [];
    if (this.paused) this.paused = [];
    this.filter();
  }

  select(index, scroll = false) {
    const row = this.shown[index];
    if (!row) return;
    this.chosen = row.key;
    if (scroll) {
      const top = index * this.rowHeight;
      const bottom = top + this.rowHeight - this.place.clientHeight;
      this.place.scrollTop = Math.max(bottom, Math.min(top, this.place.scrollTop));
    }
    this.redraw();
    this.choose(row.entry.n);
  }

  draw() {
    const height = this.rowHeight;
    this.spacer.style.height = `${this.shown.length * height}px`;
    if (this.follows) this.place.scrollTop = this.place.scrollHeight;
    const first = Math.max(0, Math.floor(this.place.scrollTop / height) - 3);
    const count = Math.ceil(this.place.clientHeight / height) + 6;
    const visible = this.shown.slice(first, first + count);
    while (this.pool.length < visible.length) this.pool.push(makeRow(this.spacer));
    this.pool.forEach((row, at) => {
      row.hidden = at >= visible.length;
      if (!row.hidden) fillRow(row, visible[at], first + at, height, visible[at].key === this.chosen);
    });
    const marked = visible.some((row) => row.key === this.chosen);
    if (marked) this.place.setAttribute("aria-activedescendant", `row-${this.chosen}`);
    else this.place.removeAttribute("aria-activedescendant");
    this.count();
  }

  count() {
    const parts = [`${this.shown.length} rows of ${this.entries.length} entries`];
    if (this.paused) parts.push(`paused, ${this.paused.length} more received`);
    if (this.lost) parts.push(`${this.lost} were left out, because this page was too slow`);
    byId("line-count").textContent = parts.join("; ");
  }
}

// The rows of the list. A program or this server repeats its queries all the time. So the queries between two other
// entries are one row for each command, which shows the last of them.
class Rows {
  // `queries` is "group", "each" or "hide".
  constructor(queries = "group") {
    this.queries = queries;
    this.list = [];
    this.groups = new Map();
  }

  add(entry) {
    const query = entry.k === "frame" && entry.s === "query";
    if (query && this.queries === "hide") return;
    if (!query) this.groups.clear();
    let row = this.groups.get(entry.l);
    if (!row) {
      row = { key: entry.n, entry, sent: 0, received: 0 };
      this.list.push(row);
      if (query && this.queries === "group") this.groups.set(entry.l, row);
    }
    row.entry = entry;
    row[entry.d === "sent" ? "sent" : "received"] += 1;
  }

  // Drop the rows with a last entry before a number.
  drop(first) {
    this.list = this.list.filter((row) => row.entry.n >= first);
  }
}

function makeRow(spacer) {
  const cells = ["time", "way", "label", "text", "hex"].map((name) => el("span", { class: name }));
  const row = el("div", { class: "row", role: "option" }, ...cells);
  spacer.append(row);
  return row;
}

function fillRow(row, { key, entry, sent, received }, index, height, chosen) {
  row.id = `row-${key}`;
  row.dataset.key = key;
  row.style.top = `${index * height}px`;
  row.className = `row ${entry.k} ${entry.d}${chosen ? " chosen" : ""}`;
  row.setAttribute("aria-selected", String(chosen));
  const [time, way, label, text, hex] = row.children;
  time.textContent = clock(entry.t, 3);
  const times = Math.max(sent, received);
  const grouped = sent + received > 1;
  way.textContent = grouped ? "⇄" : entry.k === "remark" ? "!" : ARROWS[entry.d];
  way.title = grouped ? `${sent} sent, ${received} received, the last at ${clock(entry.t, 2)}` : entry.d;
  label.textContent = times > 1 ? `${entry.l} × ${times}` : entry.l;
  text.textContent = entry.x;
  hex.textContent = entry.size ? `${entry.h} … ${entry.size} bytes` : entry.h;
}

function insertOption(select, value, after) {
  const options = [...select.options].slice(after);
  const next = options.find((option) => option.value > value) ?? null;
  select.add(el("option", { value }, value), next);
}
