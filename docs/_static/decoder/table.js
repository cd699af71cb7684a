"use strict";
// Turn an edition.json (docs/targets.md) into the table that law.js reads: types resolved, offsets
// computed, defaults filled in.
(function () {
  const KINDS = ["flag", "enum", "bytes", "text"];
  const BYTE = { name: "", width: 1, order: "big", signed_at: 255, multiply: 1, divide: 1, minimum: 0, unit: "" };
  // Width and byte order of LEN and CMD.
  const USUAL = { width: 1, order: "big" };
  // The raw values of infinity.
  const INFINITE = { 4: 0x7f800000n, 8: 0x7ff0000000000000n };

  // Add the table of an edition to those that the page knows.
  function add(document) {
    const types = new Types(document);
    const commands = document.commands.map(({ id, name, title, event, request, reply }) => ({
      id, name, title, event,
      request: (request || (event ? [] : [[]])).map((fields) => types.variant(fields)),
      reply: (reply || []).map((fields) => types.variant(fields)),
    }));
    cobotwire.tables[document.edition.name] = { frame: frameOf(document.frame), commands };
  }

  function frameOf(record) {
    const [header, footer] = [record.header, record.footer || ""].map(cobotwire.parse).map((bytes) => [...bytes]);
    const addresses = addressesOf(record);
    const numbers = { length: record.length || USUAL, command: record.command || USUAL };
    const checked = record.check !== "footer";
    const sizes = {
      header: header.length, address: addresses.length ? 1 : 0, length: numbers.length.width,
      command: numbers.command.width, data: 0, check: checked ? record.check_width : 0, footer: footer.length,
    };
    const order = record.layout || ["address", "length", "command"];
    const at = {};
    let end = 0;
    for (const part of ["header", ...order, "data"]) {
      at[part] = end;
      end += sizes[part];
    }
    const layout = order.filter((part) => sizes[part]);
    const counted = record.counted || ["command", "data", "check", "footer"];
    const check_size = sizes.check + sizes.footer;
    return {
      header, footer, addresses, layout, check_size,
      parts: Object.fromEntries(layout.map((part) => [part,
        { at: at[part], width: sizes[part], order: (numbers[part] || USUAL).order }])),
      data_at: { request: at.data, reply: record.replies_without_id ? at.command : at.data },
      replies_have_id: !record.replies_without_id,
      // The bytes that LEN does not count.
      overhead: at.data + check_size - counted.reduce((sum, part) => sum + sizes[part], 0),
      head_size: Math.max(...Object.keys(numbers).map((part) => at[part] + sizes[part])),
      maximum_data: record.maximum_data,
      check: checked ? { word: record.check, from: at[record.check_from], width: record.check_width,
        order: record.check_order, crc: record.crc } : null,
    };
  }

  function addressesOf({ addresses = [], address_range: { first, last } = { first: 0, last: -1 } }) {
    const found = new Set(addresses.map(({ value }) => value));
    for (let value = first; value <= last; value += 1) found.add(value);
    return [...found];
  }

  class Types {
    constructor({ wires, types }) {
      [this.wires, this.types] = [wires, types].map((records) => new Map(records.map((each) => [each.name, each])));
    }

    // Return the record of a type, which is given by its name or as a record.
    type(given) {
      return typeof given === "string" ? this.types.get(given) : given;
    }

    variant(fields) {
      const names = fields.map(({ name }) => name);
      return { fields: fields.map((field) => this.field(field, names)) };
    }

    field({ name, type: only, cases = [{ when: [], type: only }], selector, counts, const: constant }, names) {
      const type = this.type(cases[0].type);
      const element = type.kind === "list" ? this.type(type.of) : type;
      const fixed = constant !== undefined;
      // Each case of a selected quantity has its own choices, in its number.
      const open = selector && element.kind === "quantity";
      return {
        name,
        kind: KINDS.includes(element.kind) ? element.kind : "number",
        cases: cases.map(({ when, type: each }) => ({ when, numbers: this.numbers(each) })),
        choices: fixed ? [constant] : open ? [] : choicesOf(element),
        labels: fixed ? [] : (element.members || []).map((member) => member.name),
        selector: names.indexOf(selector),
        counts: counts && names.indexOf(counts),
        least: type.least,
        most: type.most,
        repeat: type !== element && element.kind === "text" ? element.least : undefined,
        encoding: element.encoding,
        padding: element.padding,
      };
    }

    // Return the numbers of a type in the order of the wire, or those of one element.
    numbers(given) {
      const type = this.type(given);
      if (type.kind === "value") return type.items.map((item) => this.number(item.name, this.type(item.type)));
      if (type.kind === "bits") return type.numbers;
      if (type.kind === "list") return this.numbers(type.of);
      if (type.kind === "bytes" || type.kind === "text")
        return [{ ...BYTE, maximum: type.encoding === "ascii" ? 127 : 255 }];
      return [this.number("", type)];
    }

    number(name, type) {
      const { width, order, signed_at, encoding } = typeof type.wire === "string" ? this.wires.get(type.wire) : type.wire;
      const [multiply, divide = 1] = String(type.scale || 1).split("/").map(Number);
      const [minimum, maximum] = rangeOf(type, { width, signed_at, encoding });
      return { name, width, order, signed_at, encoding, multiply, divide, minimum, maximum,
        unit: type.unit || "", choices: type.choices };
    }
  }

  function choicesOf({ kind, members, choices = [] }) {
    if (kind === "flag") return [0, 1];
    return members ? members.map(({ value }) => value) : choices;
  }

  function rangeOf(type, { width, signed_at, encoding }) {
    const choices = choicesOf(type);
    if (choices.length) return [Math.min(...choices), Math.max(...choices)];
    if (type.minimum !== undefined) return [type.minimum, type.maximum];
    if (encoding === "float") return [-INFINITE[width], INFINITE[width] - 1n];
    const top = 256 ** width;
    return [signed_at < top - 1 ? signed_at + 1 - top : 0, signed_at];
  }

  cobotwire.add = add;
})();
