// Turn bytes into the entries, explanations and samples that the page shows, by the codec in WebAssembly.

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
  "bad-value": "a frame with a value that the edition does not allow",
  truncated: "starts like a frame; the bytes end before it does",
};
const DIRECTIONS = { sent: ["request"], received: ["reply"], unknown: ["request", "reply"] };
const hex = (bytes) => Array.from(bytes, (byte) => byte.toString(16).padStart(2, "0")).join(" ").toUpperCase();

// Reads the frames of one edition. An entry has the number `n`, the time `t` in seconds, the direction `d`, the bytes
// `data`, and the `reason` of noise; or it is a remark, and has a `label` and a `text`.
export class Reader {
  constructor(machine, index, facts) {
    Object.assign(this, { machine, index, facts });
  }

  // Return the frames and the noise that each chunk made certain, as [bytes, offset, reason]; an absent chunk is a silence.
  cut(direction, chunks) {
    return this.machine.ask("frames", this.index, DIRECTIONS[direction][0], ...chunks);
  }

  // Return the message of an entry: its command, its fields, its parts; or why its bytes are none.
  read({ d, data, reason }) {
    if (reason) return { reason };
    for (const direction of DIRECTIONS[d]) {
      const [name, found] = this.machine.ask("decode", this.index, direction, data, undefined);
      if (!Array.isArray(found)) {
        reason = name;
        continue;
      }
      const fields = {};
      for (let at = 0; at < found.length; at += 2) fields[found[at]] = found[at + 1];
      const parts = this.machine.ask("explain", this.index, direction, data, name);
      return { name, direction, fields, parts, command: this.facts.commands[name] };
    }
    return { reason };
  }

  // Return an entry as the list shows it.
  describe(entry, message = entry.data && this.read(entry)) {
    const { n, t, d, data = new Uint8Array() } = entry;
    const shown = { n, t, d, h: hex(data.subarray(0, SHOWN_BYTES)) };
    if (data.length > SHOWN_BYTES) shown.size = data.length;
    if (!data.length) return { ...shown, k: "remark", l: entry.label, x: entry.text };
    const { name, reason, command } = message;
    if (!reason) return { ...shown, k: "frame", l: name, x: text(message).slice(0, SHOWN_TEXT), s: command.safety };
    return { ...shown, k: "noise", l: reason, x: `${REASONS[reason]}: ${data.length} bytes` };
  }

  explain(entry) {
    const { t: time, d: direction, data = new Uint8Array() } = entry;
    const found = { time, direction, hex: hex(data), text: entry.text ?? "" };
    if (!data.length) return found;
    const { name, reason, parts, command } = this.read(entry);
    if (reason) {
      const advice = "if it recurs, save the recording and diagnose it with cobotwire decode";
      return { ...found, noise: reason, reason: REASONS[reason], advice, facts: {} };
    }
    return {
      ...found,
      parts: parts.map(([at, size, part, raw, meaning]) => ({
        ...{ at, hex: hex(data.subarray(at, at + size)), name: part, raw: raw === undefined ? null : String(raw), meaning },
      })),
      command: { name, ...command, ...this.facts.sources[name] },
    };
  }
}

// Return a message on one line: a request like a call, a reply with an arrow before it.
function text({ name, direction, fields, parts }) {
  const shown = Object.keys(fields).map((field) => {
    const own = parts.filter(([, , part]) => part.split(/[ []/)[0] === field).map((part) => part[4]);
    if (own.length < 2) return `${field}=${own[0] ?? ""}`;
    // Name each unit once.
    const units = own.map((meaning) => /^-?[\d.e+-]+ (\D.*)$/.exec(meaning)?.[1] ?? "");
    const last = (at) => (units[at] && units[at] !== units[at + 1] ? ` ${units[at]}` : "");
    const numbers = own.map((meaning, at) => (units[at] ? meaning.slice(0, -units[at].length - 1) : meaning) + last(at));
    const between = (at) => (units[at] === units[at + 1] ? ", " : "; ");
    return `${field}=(${numbers.map((number, at) => number + (at + 1 < own.length ? between(at) : "")).join("")})`;
  });
  return `${direction === "request" ? "" : "-> "}${name}(${shown.join(", ")})`;
}

// Takes the messages of a line in their order; returns the samples that studio/samples.py describes.
export class Sampler {
  constructor({ places }) {
    Object.assign(this, { places, joints: [], target: [], end: [], sent: new Map() });
  }

  // Return the sample of an entry; none: it holds nothing to show.
  take({ t, data }, message) {
    if (!data) return undefined;
    if (message.reason) return { t, z: data.length };
    const { name, direction } = message;
    let found;
    if (direction === "request") {
      this.sent.set(name, t);
      found = this.requested(message);
    } else {
      found = this.replied(message);
      const since = t - (this.sent.get(name) ?? -Infinity);
      this.sent.delete(name);
      if (since >= 0 && since < LONGEST_REPLY_SECONDS) found.r = since * 1000;
    }
    return Object.keys(found).length ? { t, ...found } : undefined;
  }

  replied({ command, fields }) {
    const row = fields[command.rows.reply];
    if (command.role === "joints" && finite(row)) {
      this.joints = row;
      return { j: row, ...(near(row, this.target, REACHED_DEGREES) ? this.noTarget() : {}) };
    }
    if (command.role === "coordinates" && finite(row)) {
      return { c: row, ...(near(this.endOf(row), this.end, REACHED_MILLIMETRES) ? this.noTarget() : {}) };
    }
    return {};
  }

  requested({ command, fields }) {
    const row = fields[command.rows.request];
    if (command.role === "joint targets" && finite(row)) [this.target, this.end] = [row, []];
    else if (command.role === "joint target" && this.joints.length) {
      const [joint, target] = command.one.map((name) => fields[name]);
      if (!(joint >= 1 && joint <= this.joints.length)) return {};
      [this.target, this.end] = [(this.target.length ? this.target : this.joints).with(joint - 1, target), []];
    } else if (command.role === "coordinate targets" && finite(row)) {
      [this.target, this.end] = [[], this.endOf(row)];
    } else if (this.target.length || this.end.length) return command.ends ? this.noTarget() : {};
    else return {};
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
