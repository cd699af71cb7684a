// Run vectors on the codec of the package; print what differs, a line for each document. The arguments
// are files in turn: a table, and its vectors.
import { readFileSync } from "node:fs";
import { Decoder } from "../../../clients/typescript/dist/decoder.js";
import { edition, machine } from "../../../clients/typescript/dist/machine.js";

const session = await machine();

const bytesOf = (text) => Uint8Array.from(text.split(" ").filter(Boolean), (byte) => parseInt(byte, 16));
const objectOf = (flat) => Object.fromEntries(flat.flatMap((_, at) => (at % 2 ? [] : [[flat[at], flat[at + 1]]])));
const flat = (value) => (value instanceof Uint8Array || Array.isArray(value) ? [...value].flatMap(flat) : [value]);
const real = (value) => (typeof value === "string" ? Number(value) : value);
const same = (one, other) => one.length === other.length && one.every((each, at) => Object.is(each, other[at]));

// Give numbers the shape of a value.
function shaped(value, numbers) {
  if (value instanceof Uint8Array) return numbers.every((n) => n >= 0 && n < 256) ? Uint8Array.from(numbers) : numbers;
  if (!Array.isArray(value)) return numbers.length === 1 ? numbers[0] : numbers;
  if (!Array.isArray(value[0])) return numbers;
  const size = value[0].length;
  return numbers.flatMap((_, at) => (at % size ? [] : [numbers.slice(at, at + size)]));
}

async function run(table, { messages, rejected, malformed, streams }) {
  const [index] = edition(session, table);
  const vectors = messages.length + rejected.length + malformed.length + streams.length;
  const found = { vectors, fields: 0, refused: 0, differences: [] };
  const differs = (record, what) => found.differences.push(`${record.name ?? record.command}: ${what}`);
  const samples = new Map();
  for (const record of messages) {
    const { command, direction, fields } = record;
    const bytes = bytesOf(record.bytes);
    const [, , readings] = session.ask("decode", index, direction, bytes, undefined);
    if (readings[0][0] !== record.read_as) differs(record, `read as ${readings}`);
    const [named, parts] = session.ask("decode", index, direction, bytes, command);
    if (typeof named === "string") {
      differs(record, "rejected");
      continue;
    }
    if (record.parts && parts.join() !== record.parts.join()) differs(record, `explained as ${parts}, not ${record.parts}`);
    const values = objectOf(named);
    const sent = fields.map(({ name: field, value, text }) => {
      const expected = text === undefined ? value.map(real) : flat(text);
      const read = flat(values[field]);
      if (!same(read, expected)) differs(record, `${field} is read as ${read}`);
      const sample = text ?? shaped(values[field], value.map(real));
      samples.set([command, direction, field].join(), sample);
      return sample;
    });
    const names = fields.map((field) => field.name);
    const built = session.ask("encode", index, direction, command, record.variant, names, sent);
    // For another address, or bits that belong to no field, the codec builds other bytes.
    if (!record.parts && (!built || !same([...built], [...bytes]))) differs(record, `built ${built}`);
    found.fields += fields.length;
  }
  for (const { command, direction, fields, ...record } of rejected) {
    const given = fields.map((each) => each.text ?? shaped(samples.get([command, direction, each.name].join()), each.value.map(real)));
    const built = session.ask("encode", index, direction, command, record.variant, fields.map((each) => each.name), given);
    if (built) differs(record, `built ${built}`);
    found.refused += 1;
  }
  for (const record of malformed) {
    const [reason, offset] = session.ask("decode", index, record.direction, bytesOf(record.bytes), record.command);
    if (reason !== record.reason || offset !== record.offset) differs(record, `${reason} at ${offset}`);
    found.refused += 1;
  }
  for (const record of streams) {
    const data = bytesOf(record.bytes);
    const expected = record.events.map(({ offset, size, noise }) => [offset, size, noise].join());
    for (const size of [1, 2, 7, 1000]) {
      const decoder = await Decoder.load(table, record.direction);
      const made = [];
      for (let at = 0; at < data.length; at += size) made.push(...decoder.feed(data.slice(at, at + size)));
      const events = [];
      for (const { offset, data, noise } of [...made, ...decoder.flush()]) {
        const last = events.at(-1);
        if (noise && last && last[2] === noise && last[0] + last[1] === offset) last[1] += data.length;
        else events.push([offset, data.length, noise]);
      }
      if (events.map((each) => each.join()).join(" ") !== expected.join(" ")) differs(record, `in pieces of ${size}: ${events.join(" ")}`);
    }
  }
  return found;
}

const files = process.argv.slice(2).map((file) => readFileSync(file, "utf8"));
while (files.length) console.log(JSON.stringify(await run(files.shift(), JSON.parse(files.shift()))));
