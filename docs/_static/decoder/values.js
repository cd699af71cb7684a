"use strict";
// Read the values of a message by its fields; law.js finds the message.
(function values() {
  const PARTS = { address: "the address", length: "LEN", command: "CMD" };
  const BIT_COUNTS = { 4: 32, 8: 64 };

  // Return how many elements a field can have, and how often one element repeats the numbers of the case.
  function elements({ least = 1, most = 1, repeat = 1 }) {
    return { least, most, repeat };
  }

  function fieldSize(field, count) {
    const size = field.cases[0].numbers.reduce((sum, number) => sum + (number.more ? 0 : number.width), 0);
    return size * elements(field).repeat * count;
  }

  // Return the fields of a message with their numbers; `start` is the offset of the data. Throws a
  // Rejection at the first value that the edition does not allow.
  function fieldsOf({ command, variant, counts }, start, bytes) {
    let offset = start;
    const starts = variant.fields.map((field, index) => {
      const at = offset;
      offset += fieldSize(field, counts[index]);
      return at;
    });
    return variant.fields.map((field, index) => {
      const numbers = caseOf(command, variant, field, starts, bytes).numbers;
      const total = numbers.length * elements(field).repeat * counts[index];
      const counted = field.counts === undefined ? null : counts[field.counts];
      let at = starts[index];
      const found = Array.from({ length: total }, (_, place) => {
        const number = numbers[place % numbers.length];
        const raw = rawAt(number, bytes, at);
        if (counted === null ? !allows(field, number, raw) : raw !== counted)
          throw new cobotwire.Rejection("bad-value", at, () => badValue(command, field, number, raw, counted));
        const read = { number, offset: at, raw, value: physical(number, raw, bytes, at) };
        at += number.more ? 0 : number.width;
        return read;
      });
      return { field, numbers: found, text: textOf(command, field, bytes.subarray(starts[index], at), starts[index]) };
    });
  }

  function caseOf(command, variant, field, starts, bytes) {
    if (field.selector < 0) return field.cases[0];
    const selector = variant.fields[field.selector];
    const [number] = selector.cases[0].numbers;
    const start = starts[field.selector];
    const picked = rawAt(number, bytes, start);
    const found = field.cases.find((each) => each.when.includes(picked));
    if (!found)
      throw new cobotwire.Rejection("bad-value", start, () => badValue(command, selector, number, picked, null));
    return found;
  }

  function unsigned(bytes, offset, width, order) {
    let found = 0;
    for (let index = 0; index < width; index += 1) {
      found = found * 256 + bytes[offset + (order === "big" ? index : width - 1 - index)];
    }
    return found;
  }

  // Return a raw value. For a float it is a BigInt: its bits as a signed integer. If the sign bit is
  // set, all other bits are inverted first.
  function rawAt(number, bytes, offset) {
    if (number.encoding === "float") {
      const bits = BIT_COUNTS[number.width];
      const data = viewOf(bytes, offset, number);
      const signed = bits === 32 ? BigInt(data.getInt32(0, number.order === "little"))
        : data.getBigInt64(0, number.order === "little");
      return signed < 0n ? BigInt.asIntN(bits, signed ^ ((1n << BigInt(bits - 1)) - 1n)) : signed;
    }
    const word = unsigned(bytes, offset, number.width, number.order);
    const top = 2 ** (number.bits || 8 * number.width);
    const found = number.bits ? Math.floor(word / 2 ** number.shift) % top : word;
    return found > number.signed_at ? found - top : found;
  }

  function viewOf(bytes, offset, number) {
    return new DataView(bytes.buffer, bytes.byteOffset + offset, number.width);
  }

  function allows(field, number, raw) {
    const choices = field.choices.length ? field.choices : number.choices || [];
    // eslint-disable-next-line eqeqeq -- a raw value may be a BigInt
    if (choices.length) return choices.some((choice) => choice == raw);
    if (typeof raw === "bigint") return BigInt(number.minimum) <= raw && raw <= BigInt(number.maximum);
    return number.minimum <= raw && raw <= number.maximum;
  }

  function physical(number, raw, bytes, offset) {
    if (number.encoding !== "float") return (raw * number.multiply) / number.divide;
    const data = viewOf(bytes, offset, number);
    return number.width === 4 ? data.getFloat32(0, number.order === "little") : data.getFloat64(0, number.order === "little");
  }

  function badValue(command, field, number, raw, counted) {
    const name = number.name ? `${field.name}.${number.name}` : field.name;
    const choices = counted !== null ? [counted] : field.choices.length ? field.choices : number.choices || [];
    if (number.encoding === "float") return `${command.name}: ${name} is not in the range of the edition`;
    const shown = (each) => (each * number.multiply) / number.divide;
    const allowed = choices.length
      ? `one of ${choices.join(", ")}`
      : `${shown(number.minimum)}..${shown(number.maximum)}`;
    return `${command.name}: ${name} is ${shown(raw)}; allowed: ${allowed}`;
  }

  // Return the texts that a field holds; undefined if it holds none.
  function textOf(command, field, data, start) {
    if (field.kind !== "text") return undefined;
    const { repeat } = elements(field);
    const unit = repeat > 1 ? repeat : data.length;
    return Array.from({ length: repeat > 1 ? data.length / unit : 1 }, (_, index) => {
      const part = data.subarray(index * unit, (index + 1) * unit);
      const bad = field.encoding === "utf-8" ? badTextAt(part) : part.length;
      if (bad < part.length)
        throw new cobotwire.Rejection("bad-value", start + index * unit + bad, () => `${command.name}: ${field.name} is not UTF-8`);
      let end = part.length;
      while (field.padding >= 0 && end > 0 && part[end - 1] === field.padding) end -= 1;
      return decoded(part.subarray(0, end), field.encoding);
    });
  }

  function decoded(data, encoding) {
    if (encoding === "utf-8") return new TextDecoder("utf-8", { ignoreBOM: true }).decode(data);
    return Array.from(data, (byte) => String.fromCharCode(byte)).join("");
  }

  // Return the index of the first byte that is not UTF-8; the number of bytes if all are.
  function badTextAt(data) {
    let at = 0;
    while (at < data.length) {
      const size = characterSize(data.subarray(at, at + 4));
      if (!size) return at;
      at += size;
    }
    return at;
  }

  function characterSize([first, second = 0, ...more]) {
    if (first < 0x80) return 1;
    const size = first < 0xc2 || first > 0xf4 ? 0 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
    // No overlong encodings, no surrogates, nothing above U+10FFFF.
    const [low, high] = { 0xe0: [0xa0, 0xbf], 0xed: [0x80, 0x9f], 0xf0: [0x90, 0xbf], 0xf4: [0x80, 0x8f] }[first] || [0x80, 0xbf];
    const rest = more.slice(0, Math.max(size - 2, 0));
    const legal = second >= low && second <= high && rest.length === size - 2 && rest.every((byte) => byte >> 6 === 2);
    return size && legal ? size : 0;
  }

  globalThis.cobotwire = {
    tables: {}, PARTS, elements, fieldSize, fieldsOf, unsigned, source: `"use strict";(${values})();`,
  };
})();
