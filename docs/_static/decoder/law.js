"use strict";
// Cut frames and decode them by an edition's table (docs/framing.md), without access to the page.
(function law() {
  const DIRECTIONS = ["request", "reply"];

  class Rejection {
    // The reason why bytes are not a legal message; `offset` is that of the first wrong byte. Not an
    // Error, and its text is made when it is read: in noise, each byte has a rejection.
    constructor(reason, offset, text) {
      this.reason = reason;
      this.offset = offset;
      this.text = text;
    }

    get message() {
      return this.text();
    }
  }

  class Law {
    // Listen to `directions`; a frame is decoded in the first of them that allows its values.
    constructor(table, directions = DIRECTIONS) {
      this.table = table;
      this.directions = directions;
      this.frame = table.frame;
      // The position of LEN; CMD and DATA follow it.
      this.at = this.frame.header.length + (this.frame.addresses.length ? 1 : 0);
      this.checkSize =
        this.frame.check === "footer" ? this.frame.footer.length : this.frame.check === "sum" ? 1 : 2;
      this.variants = new Map();
      this.lengths = new Set();
      for (const direction of directions) this._index(direction);
    }

    _index(direction) {
      for (const command of this.table.commands) {
        command[direction].forEach((variant, number) => {
          const length = 1 + variantSize(variant) + this.checkSize;
          if (!this.variants.has(command.id)) this.variants.set(command.id, []);
          this.variants.get(command.id).push({ command, direction, variant, number, length });
          this.lengths.add(length);
        });
      }
    }

    // Return frames and noise of a complete stream. Each byte is judged on its own; adjacent noise with
    // the same reason is one event.
    cut(bytes) {
      const events = [];
      let offset = 0;
      while (offset < bytes.length) {
        const rest = bytes.subarray(offset, offset + this.at + 257);
        const fault = this.fault(rest);
        const last = events[events.length - 1];
        if (fault === null) {
          const size = this.at + 1 + rest[this.at];
          events.push({ offset, size, frame: rest[this.at + 1] });
          offset += size;
        } else {
          if (last && last.noise === fault.reason) last.size += 1;
          else events.push({ offset, size: 1, noise: fault.reason });
          offset += 1;
        }
      }
      return events;
    }

    // Return why `bytes` do not begin with a frame, or null if they do. The reason is "truncated" if
    // more bytes could complete one.
    fault(bytes) {
      const { header, addresses } = this.frame;
      for (let index = 0; index < header.length; index += 1) {
        if (index >= bytes.length) return new Rejection("truncated", index, () => "the bytes end in the header");
        if (bytes[index] !== header[index])
          return new Rejection("no-header", index, () => `a frame starts with ${hex(header)}`);
      }
      if (addresses.length && bytes.length >= this.at && !addresses.includes(bytes[this.at - 1]))
        return new Rejection("bad-address", this.at - 1, () => `the edition has no address ${hex([bytes[this.at - 1]])}`);
      if (bytes.length <= this.at)
        return new Rejection("truncated", bytes.length, () => "the bytes end before LEN");
      const length = bytes[this.at];
      if (!this.lengths.has(length))
        return new Rejection("bad-length", this.at, () => `no message has LEN ${hex([length])}`);
      if (bytes.length === this.at + 1)
        return new Rejection("truncated", bytes.length, () => "the bytes end before CMD");
      return this._endFault(bytes, length, bytes[this.at + 1]);
    }

    _endFault(bytes, length, id) {
      const known = this.variants.get(id);
      if (!known)
        return new Rejection("unknown-id", this.at + 1, () => `the edition has no id ${hex([id])}`);
      if (!known.some((each) => each.length === length))
        return new Rejection("bad-length", this.at, () => `LEN ${hex([length])} is not legal for ${known[0].command.name}`);
      const end = this.at + 1 + length;
      if (bytes.length < end)
        return new Rejection("truncated", bytes.length, () => `bytes missing at the end: ${end - bytes.length}`);
      const check = end - this.checkSize;
      const right = this._check(bytes.subarray(0, check));
      const same = right.every((byte, index) => byte === bytes[check + index]);
      return same ? null : new Rejection("bad-check", check, () => `the frame should end with ${hex(right)}`);
    }

    _check(body) {
      if (this.frame.check === "footer") return this.frame.footer;
      if (this.frame.check === "sum") {
        return [body.subarray(this.at + 1).reduce((sum, byte) => (sum + byte) & 0xff, 0)];
      }
      let crc = 0xffff;
      for (const byte of body) {
        crc ^= byte;
        for (let bit = 0; bit < 8; bit += 1) crc = crc & 1 ? (crc >> 1) ^ 0xa001 : crc >> 1;
      }
      return [crc >> 8, crc & 0xff];
    }

    // Return every reading of a complete frame that allows its values, the preferred one first.
    // Throws the first Rejection if there is none.
    read(bytes) {
      const fault = this.fault(bytes);
      if (fault !== null) throw fault;
      const end = this.at + 1 + bytes[this.at];
      if (bytes.length > end) throw new Rejection("trailing", end, () => "LEN ends the frame before the last byte");
      const readings = [];
      let first = null;
      for (const each of this.variants.get(bytes[this.at + 1])) {
        if (each.length !== bytes[this.at]) continue;
        try {
          readings.push({ ...each, fields: this._fields(each, bytes) });
        } catch (error) {
          if (!(error instanceof Rejection)) throw error;
          first = first || error;
        }
      }
      if (!readings.length) throw first;
      return readings;
    }

    _fields({ command, variant }, bytes) {
      let offset = this.at + 2;
      const starts = variant.fields.map((field) => {
        const start = offset;
        offset += fieldSize(field);
        return start;
      });
      return variant.fields.map((field, index) => {
        const numbers = caseOf(command, variant, field, starts, bytes).numbers;
        let at = starts[index];
        return {
          field,
          numbers: numbers.map((number) => {
            const found = { number, offset: at, raw: rawAt(number, bytes, at) };
            if (!allows(field, number, found.raw))
              throw new Rejection("bad-value", at, () => badValue(command, field, number, found.raw));
            at += number.width;
            return { ...found, value: physical(number, found.raw) };
          }),
        };
      });
    }
  }

  function caseOf(command, variant, field, starts, bytes) {
    if (field.selector < 0) return field.cases[0];
    const selector = variant.fields[field.selector];
    const start = starts[field.selector];
    const picked = rawAt(selector.cases[0].numbers[0], bytes, start);
    const found = field.cases.find((each) => each.when.includes(picked));
    if (!found)
      throw new Rejection("bad-value", start, () => badValue(command, selector, selector.cases[0].numbers[0], picked));
    return found;
  }

  function rawAt(number, bytes, offset) {
    let unsigned = 0;
    for (let index = 0; index < number.width; index += 1) {
      const place = number.order === "big" ? index : number.width - 1 - index;
      unsigned = unsigned * 256 + bytes[offset + place];
    }
    return unsigned > number.signed_at ? unsigned - 256 ** number.width : unsigned;
  }

  function allows(field, number, raw) {
    if (field.choices.length) return field.choices.includes(raw);
    return number.minimum <= raw && raw <= number.maximum;
  }

  function physical(number, raw) {
    return (raw * number.multiply) / number.divide;
  }

  function badValue(command, field, number, raw) {
    const allowed = field.choices.length
      ? `one of ${field.choices.join(", ")}`
      : `${physical(number, number.minimum)}..${physical(number, number.maximum)}`;
    return `${command.name}: ${field.name} is ${physical(number, raw)}; allowed: ${allowed}`;
  }

  function fieldSize(field) {
    return field.cases[0].numbers.reduce((sum, number) => sum + number.width, 0);
  }

  function variantSize(variant) {
    return variant.fields.reduce((sum, field) => sum + fieldSize(field), 0);
  }

  function hex(bytes) {
    return Array.from(bytes, (byte) => byte.toString(16).toUpperCase().padStart(2, "0")).join(" ");
  }

  // Parse pasted text: pairs of hex digits with separators, 0x or \x before them, or Python's b'...'
  // around them. A single digit is a byte only after 0x; elsewhere half of a byte is missing.
  function parse(text) {
    const plain = text
      .replace(/\bb(?=['"])/gi, " ")
      .replace(/0x([0-9a-f])(?![0-9a-f])/gi, " 0$1 ")
      .replace(/\\x|0x/gi, " ")
      .replace(/[\s,;:|"'\[\](){}-]+/g, " ")
      .trim();
    const bytes = [];
    for (const word of plain ? plain.split(" ") : []) {
      const shown = word.length > 60 ? `${word.slice(0, 57)}...` : word;
      if (!/^[0-9a-f]*$/i.test(word)) throw new Rejection("not-hex", bytes.length, () => `"${shown}" is not hex`);
      if (word.length % 2)
        throw new Rejection("not-hex", bytes.length, () => `"${shown}" has an odd number of digits`);
      for (let at = 0; at < word.length; at += 2) bytes.push(parseInt(word.slice(at, at + 2), 16));
    }
    return Uint8Array.from(bytes);
  }

  globalThis.cobotwire = Object.assign(globalThis.cobotwire || { tables: {} }, {
    // `source` is this code, for a worker: a page that is a file may not load another file into one.
    Law, Rejection, hex, parse, source: `"use strict";(${law})();`,
  });
})();
