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
      this.checkSize = this.frame.check_size;
      this.check = this.frame.check && checkOf(this.frame.check);
      this.lengths = new Set();
      // For each direction, the messages by id and by LEN; those without an id are under "".
      this.ids = new Map(directions.map((direction) => [direction, new Map()]));
      for (const direction of directions) this._index(direction);
      const longest = Math.max(0, ...this.lengths);
      this.longest = Math.max(this.frame.overhead + longest, this.frame.head_size);
    }

    _index(direction) {
      for (const command of this.table.commands) {
        command[direction].forEach((variant, number) => {
          const key = this._key(direction, command.id);
          const ids = this.ids.get(direction);
          if (!ids.has(key)) ids.set(key, new Map());
          for (const { counts, size } of this._sizes(variant)) {
            const length = this.frame.data_at[direction] + size + this.checkSize - this.frame.overhead;
            if (!ids.get(key).has(length)) ids.get(key).set(length, []);
            ids.get(key).get(length).push({ command, direction, variant, number, counts });
            this.lengths.add(length);
          }
        });
      }
    }

    _key(direction, id) {
      return direction === "request" || this.frame.replies_have_id ? id : "";
    }

    // Return the numbers of elements that the lists of a variant can have, and the size of each.
    _sizes(variant) {
      let found = [{ counts: [], size: 0 }];
      for (const field of variant.fields) {
        const { least, most } = cobotwire.elements(field);
        found = found.flatMap(({ counts, size }) => Array.from({ length: most - least + 1 }, (_, more) => (
          { counts: [...counts, least + more], size: size + cobotwire.fieldSize(field, least + more) })));
      }
      return found.length === 1 ? found : found.filter(({ size }) => size <= this.frame.maximum_data);
    }

    // Return frames and noise of a complete stream. Each byte is validated on its own; adjacent noise with
    // the same reason is one event.
    cut(bytes) {
      const events = [];
      let offset = 0;
      while (offset < bytes.length) {
        const rest = bytes.subarray(offset, offset + this.longest);
        const fault = this.fault(rest);
        const last = events[events.length - 1];
        if (fault === null) {
          const size = this.frame.overhead + this._length(rest);
          events.push({ offset, size, frame: this._id(rest) });
          offset += size;
        } else {
          if (last && last.noise === fault.reason) last.size += 1;
          else events.push({ offset, size: 1, noise: fault.reason });
          offset += 1;
        }
      }
      return events;
    }

    _number(bytes, part) {
      const { at, width, order } = this.frame.parts[part];
      return cobotwire.unsigned(bytes, at, width, order);
    }

    _length(bytes) {
      return this._number(bytes, "length");
    }

    _id(bytes) {
      return this._number(bytes, "command");
    }

    // Return why `bytes` do not begin with a frame, or null if they do. The reason is "truncated" if
    // more bytes could complete one.
    fault(bytes) {
      const { header, layout, parts } = this.frame;
      for (let index = 0; index < header.length; index += 1) {
        if (index >= bytes.length) return new Rejection("truncated", index, () => "the bytes end in the header");
        if (bytes[index] !== header[index])
          return new Rejection("no-header", index, () => `a frame starts with ${hex(header)}`);
      }
      for (const part of layout) {
        const { at, width } = parts[part];
        if (bytes.length < at + width)
          return new Rejection("truncated", bytes.length, () => `the bytes end before ${cobotwire.PARTS[part]}`);
        const fault = this._partFault(part, at, bytes);
        if (fault !== null) return fault;
      }
      return this._pairFault(bytes) || this._endFault(bytes);
    }

    _partFault(part, at, bytes) {
      const { addresses, layout } = this.frame;
      if (part === "address" && !addresses.includes(bytes[at]))
        return new Rejection("bad-address", at, () => `the edition has no address ${hex([bytes[at]])}`);
      if (part === "length" && !this.lengths.has(this._length(bytes)))
        return new Rejection("bad-length", at, () => `no message has LEN ${this._length(bytes)}`);
      // After LEN, the two are validated together.
      if (part === "command" && layout.indexOf("length") > layout.indexOf("command") && !this._known(this._id(bytes)))
        return this._unknown(bytes);
      return null;
    }

    _known(id) {
      return this.directions.some((direction) => this.ids.get(direction).has(this._key(direction, id)));
    }

    _unknown(bytes) {
      const { at, width } = this.frame.parts.command;
      return new Rejection("unknown-id", at, () => `the edition has no id ${hex(bytes.subarray(at, at + width))}`);
    }

    // Return the messages with the id and the LEN of a frame.
    _messages(bytes) {
      const [id, length] = [this._id(bytes), this._length(bytes)];
      return this.directions.flatMap((direction) => {
        const lengths = this.ids.get(direction).get(this._key(direction, id));
        return (lengths && lengths.get(length)) || [];
      });
    }

    _pairFault(bytes) {
      if (this._messages(bytes).length) return null;
      if (!this._known(this._id(bytes))) return this._unknown(bytes);
      const at = this.frame.parts.length.at;
      return new Rejection("bad-length", at, () => `LEN ${this._length(bytes)} is not legal for this id`);
    }

    _endFault(bytes) {
      const end = this.frame.overhead + this._length(bytes);
      if (bytes.length < end)
        return new Rejection("truncated", bytes.length, () => `bytes missing at the end: ${end - bytes.length}`);
      const check = end - this.checkSize;
      const right = [...(this.check ? this.check(bytes.subarray(0, check)) : []), ...this.frame.footer];
      const same = right.every((byte, index) => byte === bytes[check + index]);
      return same ? null : new Rejection("bad-check", check, () => `the frame should end with ${hex(right)}`);
    }

    // Return every reading of a complete frame that allows its values, the preferred one first.
    // Throws the first Rejection if there is none.
    read(bytes) {
      const fault = this.fault(bytes);
      if (fault !== null) throw fault;
      const end = this.frame.overhead + this._length(bytes);
      if (bytes.length > end) throw new Rejection("trailing", end, () => "LEN ends the frame before the last byte");
      const readings = [];
      let first = null;
      for (const each of this._messages(bytes)) {
        try {
          const start = this.frame.data_at[each.direction];
          readings.push({ ...each, fields: cobotwire.fieldsOf(each, start, bytes) });
        } catch (error) {
          if (!(error instanceof Rejection)) throw error;
          first = first || error;
        }
      }
      if (!readings.length) throw first;
      return readings;
    }
  }

  // Return the function that computes a check from the bytes before it, by the parameters of a CRC
  // (the Rocksoft model) or by its name.
  function checkOf({ word, from, width, order, crc }) {
    const number = crc ? crcOf(crc) : (bytes) => sumOf(word, bytes);
    return (bytes) => {
      let rest = BigInt.asUintN(8 * width, number(bytes.subarray(from)));
      const made = Array.from({ length: width }, () => {
        const byte = Number(rest & 0xffn);
        rest >>= 8n;
        return byte;
      });
      return order === "little" ? made : made.reverse();
    };
  }

  function sumOf(word, bytes) {
    if (word === "xor") return BigInt(bytes.reduce((result, byte) => result ^ byte, 0));
    if (word.startsWith("fletcher")) {
      const modulus = word === "fletcher" ? 256 : 255;
      let [first, second] = [0, 0];
      for (const byte of bytes) {
        first = (first + byte) % modulus;
        second = (second + first) % modulus;
      }
      return BigInt(second * 256 + first);
    }
    const total = BigInt(bytes.reduce((sum, byte) => sum + byte, 0));
    return { sum: total, "inverted-sum": -1n - total, "negated-sum": -total }[word];
  }

  // The register has at least eight bits, so that a whole byte can be added. If the bits of each byte
  // come from the lowest on, the whole register is mirrored.
  function crcOf({ width, refin, refout, ...parameters }) {
    const [poly, init, xorout] = ["poly", "init", "xorout"].map((name) => BigInt(parameters[name]));
    const bits = Math.max(width, 8);
    const placed = (value) => (refin ? mirrored(value, width) : value << BigInt(bits - width));
    const [polynomial, shift, top] = [placed(poly), BigInt(bits - 8), 1n << BigInt(bits - 1)];
    const step = (crc) => (refin
      ? (crc >> 1n) ^ (crc & 1n ? polynomial : 0n)
      : BigInt.asUintN(bits, crc << 1n) ^ (crc & top ? polynomial : 0n));
    const steps = Array.from({ length: 256 }, (_, byte) => {
      let crc = refin ? BigInt(byte) : BigInt(byte) << shift;
      for (let bit = 0; bit < 8; bit += 1) crc = step(crc);
      return crc;
    });
    return (bytes) => {
      let crc = placed(init);
      for (const byte of bytes) {
        crc = refin
          ? (crc >> 8n) ^ steps[Number(crc & 0xffn) ^ byte]
          : BigInt.asUintN(bits, crc << 8n) ^ steps[Number(crc >> shift) ^ byte];
      }
      if (!refin) crc >>= BigInt(bits - width);
      return (refin === refout ? crc : mirrored(crc, width)) ^ xorout;
    };
  }

  function mirrored(value, width) {
    return BigInt(`0b${value.toString(2).padStart(width, "0").split("").reverse().join("")}`);
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

  Object.assign(cobotwire, {
    // `source` is this code, with values.js before it, for a worker: a page that is opened as a file may not load
    // another file into a worker.
    Law, Rejection, hex, parse, source: `${cobotwire.source}"use strict";(${law})();`,
  });
})();
