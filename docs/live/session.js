// What a session with an arm and a recording have in common: entries, as the studio's server describes and explains them.

import { Decoder, REASONS } from "./cobotwire/dist/decoder.js";
import { written } from "./pcapng.js";
import { Sampler } from "./samples.js";

// Beyond this the oldest entries are dropped.
export const MOST_ENTRIES = 1_000_000;
const [DROPPED_AT_ONCE, SHOWN_BYTES, SHOWN_TEXT] = [10_000, 64, 400];
const DIRECTIONS = { sent: "request", received: "reply", unknown: "both" };
const ADVICE = "save the recording; cobotwire decode names the noise and its cause";
const hex = (bytes) => Array.from(bytes, (byte) => byte.toString(16).padStart(2, "0")).join(" ").toUpperCase();

// Cuts the bytes of one direction. An entry has its number `n`, the time `t` of its first byte in seconds, the direction
// `d`, the bytes `data`, and the `reason` of noise; or it is a remark, with a `label` and a `text`.
export class Stream {
  static async load(direction, { table }) {
    return Object.assign(new Stream(), { direction, decoder: await Decoder.load(table, DIRECTIONS[direction]), times: [], size: 0 });
  }

  // Take bytes that came at a time; return the entries that are certain now.
  take(t, data) {
    if (!data.length) return [];
    this.times.push([this.size, t]);
    this.size += data.length;
    return this.entries(this.decoder.feed(data));
  }

  // Return the entries of the bytes that are left; call this when no more bytes follow.
  silence() {
    return this.entries(this.decoder.flush());
  }

  // Return the bytes that may still become a frame.
  begun() {
    const { pending } = this.decoder;
    return pending.length ? [{ t: this.times.findLast(([at]) => at <= this.size - pending.length)[1], d: this.direction, data: pending, reason: "truncated" }] : [];
  }

  entries(found) {
    return found.map(({ offset, data, noise }) => {
      while (this.times[1]?.[0] <= offset) this.times.shift();
      return { t: this.times[0][1], d: this.direction, data, reason: noise };
    });
  }
}

export class Session {
  // `publish` gets the news for the page; `port` is the name and the rate of the serial port.
  constructor(publish, facts, streams, port) {
    Object.assign(this, { publish, facts, streams, port, entries: [], dropped: 0, sampler: new Sampler(facts) });
  }

  // Add the entries that a function returns. An error here must not stop the traffic with the arm.
  note(entries) {
    try {
      this.add(entries());
    } catch (error) {
      this.publish({ states: { refused: `an entry is missing here: ${error.message}` } });
    }
  }

  // The number of the next entry.
  get count() {
    return this.dropped + this.entries.length;
  }

  add(entries) {
    for (const entry of entries) {
      entry.n = this.dropped + this.entries.push(entry) - 1;
      this.show(entry);
    }
    if (this.entries.length < MOST_ENTRIES + DROPPED_AT_ONCE) return;
    this.entries.splice(0, DROPPED_AT_ONCE);
    this.dropped += DROPPED_AT_ONCE;
  }

  show(entry, listed = true) {
    const message = this.read(entry);
    const sample = this.sampler.take(entry, message);
    this.publish({ entries: listed ? [this.describe(entry, message)] : [], samples: sample ? [sample] : [] });
  }

  // Return the message of an entry; undefined: it is noise or a remark; or the reason and text of what is wrong.
  read({ d, data, reason }) {
    return data && !reason ? this.streams.find(({ direction }) => direction === d).decoder.read(data) : undefined;
  }

  describe({ n, t, d, data, reason, label, text }, message) {
    if (!data) return { n, t, d, h: "", k: "remark", l: label, x: text };
    const shown = { n, t, d, h: hex(data.subarray(0, SHOWN_BYTES)) };
    if (data.length > SHOWN_BYTES) shown.size = data.length;
    if (message?.command) {
      const { safety } = this.facts.commands[message.command].about;
      return { ...shown, k: "frame", l: message.command, x: line(message).slice(0, SHOWN_TEXT), s: safety };
    }
    const noise = d === "sent" ? ["fill", "no request of the edition"] : [reason, REASONS[reason]];
    const [l, x] = reason ? noise : ["illegal", message.text];
    return { ...shown, k: "noise", l, x: x.slice(0, SHOWN_TEXT) };
  }

  explain(number) {
    const entry = this.entries[number - this.dropped];
    if (!entry) throw new Error("this entry is no longer kept");
    return this.explained(entry);
  }

  explained(entry) {
    const { t: time, d: direction, data = new Uint8Array(), reason, text = "" } = entry;
    const found = { time, direction, hex: hex(data), text };
    if (reason) return { ...found, noise: reason, reason: REASONS[reason], advice: ADVICE, facts: {} };
    const message = this.read(entry);
    if (!message?.command) return { ...found, text: message?.text ?? text };
    const { about } = this.facts.commands[message.command];
    const parts = message.parts.map(({ at, size, name, raw, meaning }) => ({
      ...{ at, hex: hex(data.subarray(at, at + size)), name, raw: raw === undefined ? null : String(raw) },
      meaning: name === "CMD" ? `${about.name}: ${about.title}` : meaning,
    }));
    return { ...found, parts, command: about };
  }

  // Return a recording of the entries that a query selects.
  exported({ begin, end, direction, command, first = 0, last = Infinity }) {
    const [from, to] = [Number(begin || -Infinity), Number(end || Infinity)];
    if (Number.isNaN(from) || Number.isNaN(to)) throw new Error("a time is a number of seconds");
    // Bytes that may still become a frame have no number.
    const numbered = (n = Infinity) => n >= Number(first) && (n < Number(last) || last === Infinity);
    const inside = ({ n, t, d, data }) => data && numbered(n) && t >= from && t < to && (!direction || d === direction);
    const chosen = (entry) => inside(entry) && (!command || this.read(entry)?.command === command);
    // A copy, since entries are added and dropped meanwhile.
    const entries = [...this.entries, ...this.streams.flatMap((stream) => stream.begun())];
    return written(entries, chosen, { ...this.port, edition: this.facts.robot.edition, startNs: this.startNs });
  }
}

// Return a message on one line: a request like a call, a reply with an arrow before it.
function line({ command, kind, fields, parts }) {
  const shown = Object.keys(fields).map((field) => {
    const own = parts.filter(({ name }) => name.split(/[.[]/)[0] === field).map(({ meaning }) => meaning);
    if (own.length < 2) return `${field}=${own[0] ?? ""}`;
    // Name each unit once.
    const [numbers, units] = [1, 2].map((at) => own.map((meaning) => /^(\S+) ?(.*)$/.exec(meaning)[at]));
    const after = (at) => (units[at] === units[at + 1] ? "," : `${units[at] && ` ${units[at]}`}${at + 1 < own.length ? ";" : ""}`);
    return `${field}=(${numbers.map((number, at) => number + after(at)).join(" ")})`;
  });
  return `${kind === "request" ? "" : "-> "}${command}(${shown.join(", ")})`;
}
