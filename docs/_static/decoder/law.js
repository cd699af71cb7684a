"use strict";
// Framing and reading by an edition's table (docs/framing.md). No page here: bytes in, records out.
(function () {
  const DIRECTIONS = ["request", "reply"];

  class Refusal extends Error {
    // Why bytes are no message, and at which of them that shows.
    constructor(reason, offset, text) {
      super(text);
      this.reason = reason;
      this.offset = offset;
    }
  }

  class Law {
    // `directions` are listened to; a frame reads as the first of them that allows its values.
    constructor(table, directions = DIRECTIONS) {
      this.table = table;
      this.directions = directions;
      this.frame = table.frame;
      // Where LEN stands; CMD is behind it, the data behind that.
      this.at = this.frame.header.length + (this.frame.addresses.length ? 1 : 0);
      this.checkSize =
        this.frame.check === "footer" ? this.frame.footer.length : this.frame.check === "sum" ? 1 : 2;
      this.forms = new Map();
      this.lengths = new Set();
      for (const direction of directions) this._index(direction);
    }

    _index(direction) {
      for (const command of this.table.commands) {
        command[direction].forEach((form, number) => {
          const length = 1 + formSize(form) + this.checkSize;
          if (!this.forms.has(command.id)) this.forms.set(command.id, []);
          this.forms.get(command.id).push({ command, direction, form, number, length });
          this.lengths.add(length);
        });
      }
    }

    // Frames and noise of a stream that ends. Each byte is judged on its own; adjacent noise of one
    // reason is one event.
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

    // Why `bytes` do not begin with a frame; null: they do. Truncated: more bytes could make it one.
    fault(bytes) {
      const { header, addresses } = this.frame;
      for (let index = 0; index < header.length; index += 1) {
        if (index >= bytes.length) return new Refusal("truncated", index, "the bytes end in the header");
        if (bytes[index] !== header[index])
          return new Refusal("no-header", index, `a frame starts with ${hex(header)}`);
      }
      if (addresses.length && bytes.length >= this.at && !addresses.includes(bytes[this.at - 1]))
        return new Refusal("bad-address", this.at - 1, `no address ${hex([bytes[this.at - 1]])}`);
      if (bytes.length <= this.at)
        return new Refusal("truncated", bytes.length, "the bytes end before LEN");
      const length = bytes[this.at];
      if (!this.lengths.has(length))
        return new Refusal("bad-length", this.at, `no message has LEN ${hex([length])}`);
      if (bytes.length === this.at + 1)
        return new Refusal("truncated", bytes.length, "the bytes end before CMD");
      return this._endFault(bytes, length, bytes[this.at + 1]);
    }

    _endFault(bytes, length, id) {
      const known = this.forms.get(id);
      if (!known)
        return new Refusal("unknown-id", this.at + 1, `the edition has no id ${hex([id])}`);
      if (!known.some((each) => each.length === length))
        return new Refusal("bad-length", this.at, `LEN ${hex([length])} is not ${known[0].command.name}'s`);
      const end = this.at + 1 + length;
      if (bytes.length < end)
        return new Refusal("truncated", bytes.length, `${end - bytes.length} more byte(s) are promised`);
      const check = end - this.checkSize;
      const right = this._check(bytes.subarray(0, check));
      const same = right.every((byte, index) => byte === bytes[check + index]);
      return same ? null : new Refusal("bad-check", check, `the frame should end with ${hex(right)}`);
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

    // What one whole frame says: every reading that allows its values, the one that counts first.
    // Throws the first Refusal if there is none.
    read(bytes) {
      const fault = this.fault(bytes);
      if (fault !== null) throw fault;
      const end = this.at + 1 + bytes[this.at];
      if (bytes.length > end) throw new Refusal("trailing", end, "LEN ends the frame before the last byte");
      const readings = [];
      let first = null;
      for (const each of this.forms.get(bytes[this.at + 1])) {
        if (each.length !== bytes[this.at]) continue;
        try {
          readings.push({ ...each, fields: this._fields(each, bytes) });
        } catch (error) {
          if (!(error instanceof Refusal)) throw error;
          first = first || error;
        }
      }
      if (!readings.length) throw first;
      return readings;
    }

    _fields({ command, form }, bytes) {
      let offset = this.at + 2;
      const starts = form.fields.map((field) => {
        const start = offset;
        offset += fieldSize(field);
        return start;
      });
      return form.fields.map((field, index) => {
        const numbers = caseOf(command, form, field, starts, bytes).numbers;
        let at = starts[index];
        return {
          field,
          numbers: numbers.map((number) => {
            const found = { number, offset: at, whole: wholeAt(number, bytes, at) };
            if (!allows(field, number, found.whole))
              throw new Refusal("bad-value", at, refused(command, field, number, found.whole));
            at += number.width;
            return { ...found, value: physical(number, found.whole) };
          }),
        };
      });
    }
  }

  function caseOf(command, form, field, starts, bytes) {
    if (field.selector < 0) return field.cases[0];
    const selector = form.fields[field.selector];
    const start = starts[field.selector];
    const picked = wholeAt(selector.cases[0].numbers[0], bytes, start);
    const found = field.cases.find((each) => each.when.includes(picked));
    if (!found)
      throw new Refusal("bad-value", start, refused(command, selector, selector.cases[0].numbers[0], picked));
    return found;
  }

  function wholeAt(number, bytes, offset) {
    let word = 0;
    for (let index = 0; index < number.width; index += 1) {
      const place = number.order === "big" ? index : number.width - 1 - index;
      word = word * 256 + bytes[offset + place];
    }
    return word > number.signed_at ? word - 256 ** number.width : word;
  }

  function allows(field, number, whole) {
    if (field.choices.length) return field.choices.includes(whole);
    return number.minimum <= whole && whole <= number.maximum;
  }

  function physical(number, whole) {
    return (whole * number.multiply) / number.divide;
  }

  function refused(command, field, number, whole) {
    const allowed = field.choices.length
      ? `one of ${field.choices.join(", ")}`
      : `${physical(number, number.minimum)}..${physical(number, number.maximum)}`;
    return `${command.name}: ${field.name} holds ${physical(number, whole)}, allowed: ${allowed}`;
  }

  function fieldSize(field) {
    return field.cases[0].numbers.reduce((sum, number) => sum + number.width, 0);
  }

  function formSize(form) {
    return form.fields.reduce((sum, field) => sum + fieldSize(field), 0);
  }

  function hex(bytes) {
    return Array.from(bytes, (byte) => byte.toString(16).toUpperCase().padStart(2, "0")).join(" ");
  }

  // Bytes out of what people paste: pairs of digits with anything between them, 0x or \x in front, or
  // Python's b'...' around. One digit alone is a byte only behind 0x; else half of one is missing.
  function parse(text) {
    const plain = text
      .replace(/\bb(?=['"])/gi, " ")
      .replace(/0x([0-9a-f])(?![0-9a-f])/gi, " 0$1 ")
      .replace(/\\x|0x/gi, " ")
      .replace(/[\s,;:|"'\[\](){}-]+/g, " ")
      .trim();
    const bytes = [];
    for (const word of plain ? plain.split(" ") : []) {
      if (!/^[0-9a-f]*$/i.test(word)) throw new Refusal("no-hex", bytes.length, `"${word}" is no hex`);
      if (word.length % 2)
        throw new Refusal("no-hex", bytes.length, `"${word}" has an odd number of digits`);
      for (let at = 0; at < word.length; at += 2) bytes.push(parseInt(word.slice(at, at + 2), 16));
    }
    return Uint8Array.from(bytes);
  }

  globalThis.cobotwire = Object.assign(globalThis.cobotwire || { tables: {} }, {
    Law, Refusal, hex, parse,
  });
})();
