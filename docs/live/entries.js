// Turn bytes into the entries, explanations and samples that the page shows, by the codec in WebAssembly.

import { Decoder } from "./cobotwire/dist/decoder.js";

const SHOWN_BYTES = 64;
const SHOWN_TEXT = 400;
// Replies that are later than this belong to no request that a person would look for.
const LONGEST_REPLY_SECONDS = 5;
// An arm that is as near as this to its target has reached it.
const REACHED_DEGREES = 0.5;
const REACHED_MILLIMETRES = 1;
const REASONS = {
  "no-header": "no frame starts here",
  "bad-address": "a header with an address that the edition lacks",
  "bad-length": "a header with a LEN that is not legal for its id",
  "unknown-id": "a header with an id that the edition lacks",
  "bad-check": "starts like a frame, but does not end like one",
  truncated: "starts like a frame; the bytes end before it does",
};
const DIRECTIONS = { sent: "request", received: "reply", unknown: "both" };
const hex = (bytes) => Array.from(bytes, (byte) => byte.toString(16).padStart(2, "0")).join(" ").toUpperCase();

// Cuts the bytes of one direction. An entry has the time `t` in seconds, the direction `d`, the bytes `data`, and the
// `reason` of noise; or it is a remark, with a `label` and a `text`.
export class Stream {
  constructor(direction, decoder) {
    Object.assign(this, { direction, decoder, times: [], size: 0 });
  }

  static async load(direction, table) {
    return new Stream(direction, await Decoder.load(table, DIRECTIONS[direction]));
  }

  // Return the entries that are certain after some bytes. An entry has the time of its first byte.
  take(t, data) {
    this.times.push([this.size, t]);
    this.size += data.length;
    return this.entries(this.decoder.feed(data));
  }

  // Return the entries that are certain because nothing follows.
  silence() {
    return this.entries(this.decoder.flush());
  }

  entries(found) {
    return found.map(({ offset, data, noise }) => {
      while (this.times[1]?.[0] <= offset) this.times.shift();
      return { t: this.times[0][1], d: this.direction, data, reason: noise };
    });
  }
}

// Reads entries of one edition.
export class Reader {
  constructor(facts, streams) {
    this.facts = facts;
    this.decoders = Object.fromEntries(streams.map(({ direction, decoder }) => [direction, decoder]));
  }

  // Return the message of an entry; undefined: it is noise or a remark; or the reason and text of what is wrong.
  read({ d, data, reason }) {
    return data && !reason ? this.decoders[d].read(data) : undefined;
  }

  // Return an entry as the list shows it.
  describe(entry, message) {
    const { n, t, d, data, reason } = entry;
    if (!data) return { n, t, d, h: "", k: "remark", l: entry.label, x: entry.text };
    const shown = { n, t, d, h: hex(data.subarray(0, SHOWN_BYTES)) };
    if (data.length > SHOWN_BYTES) shown.size = data.length;
    if (message?.command) {
      const { safety } = this.facts.commands[message.command].about;
      return { ...shown, k: "frame", l: message.command, x: text(message).slice(0, SHOWN_TEXT), s: safety };
    }
    const noise = d === "sent" ? ["fill", "no request of the edition"] : [reason, REASONS[reason]];
    const [l, x] = reason ? noise : ["illegal", message.text];
    return { ...shown, k: "noise", l, x: x.slice(0, SHOWN_TEXT) };
  }

  explain(entry) {
    const { t: time, d: direction, data = new Uint8Array(), reason } = entry;
    const found = { time, direction, hex: hex(data), text: entry.text ?? "" };
    const message = this.read(entry);
    if (reason) {
      const advice = "save the recording; cobotwire decode names the noise and its cause";
      return { ...found, noise: reason, reason: REASONS[reason], advice, facts: {} };
    }
    if (!message?.command) return { ...found, text: message?.text ?? found.text };
    const { about } = this.facts.commands[message.command];
    const parts = message.parts.map(({ at, size, name: part, raw, meaning }) => ({
      ...{ at, hex: hex(data.subarray(at, at + size)), name: part },
      ...{ raw: raw === undefined ? null : String(raw), meaning: part === "CMD" ? `${about.name}: ${about.title}` : meaning },
    }));
    return { ...found, parts, command: about };
  }
}

// Return a message on one line: a request like a call, a reply with an arrow before it.
function text({ command, kind, fields, parts }) {
  const shown = Object.keys(fields).map((field) => {
    const own = parts.filter(({ name }) => name.split(/[ []/)[0] === field).map(({ meaning }) => meaning);
    if (own.length < 2) return `${field}=${own[0] ?? ""}`;
    // Name each unit once.
    const [numbers, units] = [0, 1].map((at) => own.map((meaning) => /^(\S+) ?(.*)$/.exec(meaning)[at + 1]));
    const after = (at) => (units[at] === units[at + 1] ? "," : `${units[at] && ` ${units[at]}`}${at + 1 < own.length ? ";" : ""}`);
    return `${field}=(${numbers.map((number, at) => number + after(at)).join(" ")})`;
  });
  return `${kind === "request" ? "" : "-> "}${command}(${shown.join(", ")})`;
}

// Takes the messages of a line in their order; returns the samples that studio/samples.py describes.
export class Sampler {
  constructor({ places, commands }) {
    Object.assign(this, { places, commands, joints: [], target: [], end: [], sent: new Map() });
  }

  // Return the sample of an entry; undefined: it holds nothing to show.
  take({ t, data, reason }, message) {
    if (reason) return { t, z: data.length };
    const command = this.commands[message?.command];
    if (!command) return undefined;
    const row = message.fields[command.rows[message.kind === "request" ? "request" : "reply"]];
    let found;
    if (message.kind === "request") {
      this.sent.set(message.command, t);
      found = this.requested(command, message.fields, row);
    } else {
      found = finite(row) ? this.replied(command, row) : {};
      const since = t - (this.sent.get(message.command) ?? -Infinity);
      this.sent.delete(message.command);
      if (since >= 0 && since < LONGEST_REPLY_SECONDS) found.r = since * 1000;
    }
    return Object.keys(found).length ? { t, ...found } : undefined;
  }

  replied({ role }, row) {
    if (role === "joints") {
      this.joints = row;
      return { j: row, ...(near(row, this.target, REACHED_DEGREES) ? this.noTarget() : {}) };
    }
    if (role !== "coordinates") return {};
    return { c: row, ...(near(this.endOf(row), this.end, REACHED_MILLIMETRES) ? this.noTarget() : {}) };
  }

  requested({ role, one, ends }, fields, row) {
    if (role === "joint targets" && finite(row)) [this.target, this.end] = [row, []];
    else if (role === "joint target" && this.joints.length) {
      const [joint, target] = one.map((name) => fields[name]);
      if (!(joint >= 1 && joint <= this.joints.length)) return {};
      [this.target, this.end] = [(this.target.length ? this.target : this.joints).with(joint - 1, target), []];
    } else if (role === "coordinate targets" && finite(row)) [this.target, this.end] = [[], this.endOf(row)];
    else return ends && (this.target.length || this.end.length) ? this.noTarget() : {};
    const shown = (numbers) => (numbers.length ? numbers : null);
    return { tj: shown(this.target), te: shown(this.end) };
  }

  endOf(row) {
    return [0, 1, 2].map((axis) => row[this.places.indexOf(axis)] ?? 0);
  }

  noTarget() {
    this.target = this.end = [];
    return { tj: null, te: null };
  }
}

const near = (row, target, distance) => target.length > 0 && target.every((to, at) => Math.abs(row[at] - to) < distance);
const finite = (row) => Array.isArray(row) && row.length > 0 && row.every(Number.isFinite);
