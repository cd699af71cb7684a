// Answer the questions of `cobotwire conform codec` with the codec of the package: docs/codec-protocol.md.
import { createInterface } from "node:readline";
import { Decoder } from "../../clients/typescript/dist/decoder.js";
import { edition, machine, objectOf } from "../../clients/typescript/dist/machine.js";

const session = await machine();
const WAYS = ["request", "reply"];
const CAN = [...["encode", "decode", "stream"].flatMap((does) => WAYS.map((way) => `${does} ${way}`)), "stream both"];
const NUMBERS = { nan: NaN, inf: Infinity, "-inf": -Infinity };
let name, table, index;

const hex = (bytes) => Buffer.from(bytes).toString("hex").toUpperCase();
const bytesOf = (digits) => Uint8Array.from(Buffer.from(digits, "hex"));

// Return what a text may stand for besides itself: a number that is not finite, or bytes.
function meant(value) {
  if (Array.isArray(value)) return value.map(meant);
  return typeof value === "string" ? (NUMBERS[value] ?? bytesOf(value)) : value;
}

function plain(value) {
  if (value instanceof Uint8Array) return hex(value);
  if (Array.isArray(value)) return value.map(plain);
  if (typeof value !== "number" || Number.isFinite(value)) return value;
  return Object.keys(NUMBERS).find((word) => Object.is(NUMBERS[word], value));
}

const answers = {
  async hello(question) {
    name = question.edition;
    ({ table } = await import(`../../clients/typescript/editions/${name}.js`));
    [index] = edition(session, table);
    return { protocol: 1, edition: name, name: "cobotwire for Node", can: [...CAN, "noise", "reasons"] };
  },
  encode({ direction, command, fields }) {
    const values = Object.values(fields);
    const encoded = (row) => session.ask("encode", index, direction, command, undefined, Object.keys(fields), row);
    const bytes = encoded(values) ?? encoded(values.map(meant));
    return bytes ? { bytes: hex(bytes) } : { error: "bad-value" };
  },
  decode({ direction, command, bytes }) {
    const [found, offset, readings] = session.ask("decode", index, direction, bytesOf(bytes), command);
    if (typeof found === "string") return { error: found, offset };
    return { command: readings[0][0], fields: objectOf(found.map(plain)) };
  },
  async stream({ direction, chunks }) {
    const decoder = await Decoder.load(table, direction);
    const events = chunks.map((chunk) => (chunk === null ? decoder.flush() : decoder.feed(bytesOf(chunk))));
    const shown = ({ offset, data, noise }) =>
      noise ? { noise: hex(data), offset, reason: noise } : { frame: hex(data), offset };
    return { events: events.map((each) => each.map(shown)) };
  },
};

for await (const line of createInterface({ input: process.stdin })) {
  const question = JSON.parse(line);
  console.log(JSON.stringify({ id: question.id, ...(await answers[question.do](question)) }));
}
