// Write and read recordings: pcapng, as docs/captures.md describes it.

const [SECTION, INTERFACE, STATISTICS, PACKET] = [0x0a0d0d0a, 1, 5, 6];
const MAGIC = 0x1a2b3c4d;
const LINK_TYPE = 159;
const USER_LINK_TYPES = [147, 162];
const FLAGS = { received: 1, sent: 2, unknown: 0 };
const DIRECTIONS = { 1: "received", 2: "sent" };
const encoder = new TextEncoder();

// Return the bytes of a recording of entries. Their times count from `startNs` after 1970.
export function written(entries, { url, edition, baudrate, startNs }) {
  const name = [2, encoder.encode(url)];
  const speed = baudrate ? [[8, words(baudrate, 0)]] : [];
  const description = [3, encoder.encode(`edition ${edition}`)];
  const head = new Uint8Array([...words(MAGIC), 1, 0, 0, 0, ...new Uint8Array(8).fill(255)]);
  const blocks = [
    block(SECTION, head, [[4, encoder.encode("cobotwire")]]),
    block(INTERFACE, words(LINK_TYPE, 0), [name, description, ...speed, [9, Uint8Array.of(9)]]),
  ];
  const times = entries.map(({ t }) => startNs + BigInt(Math.round(t * 1e9)));
  entries.forEach(({ d, data, reason }, at) => {
    const comment = reason ? [[1, encoder.encode(`noise ${reason}`)]] : [];
    const fixed = words(0, ...time(times[at]), data.length, data.length);
    blocks.push(block(PACKET, joined([fixed, padded(data)]), [...comment, [2, words(FLAGS[d])]]));
  });
  const first = times.reduce((one, other) => (other < one ? other : one), times[0] ?? startNs);
  const last = times.reduce((one, other) => (other > one ? other : one), times[0] ?? startNs);
  const count = [4, words(entries.length, 0)];
  blocks.push(block(STATISTICS, words(0, ...time(last)), [[2, words(...time(first))], [3, words(...time(last))], count]));
  return joined(blocks);
}

const words = (...numbers) => new Uint8Array(Uint32Array.from(numbers).buffer);
const time = (ns) => [Number(ns >> 32n), Number(ns & 0xffffffffn)];
const padded = (bytes) => joined([bytes, new Uint8Array(-bytes.length & 3)]);

function joined(parts) {
  const all = new Uint8Array(parts.reduce((size, part) => size + part.length, 0));
  let at = 0;
  for (const part of parts) {
    all.set(part, at);
    at += part.length;
  }
  return all;
}

function block(kind, body, options) {
  const encoded = options.map(([code, value]) => joined([words(code | (value.length << 16)), padded(value)]));
  const all = joined([body, ...encoded, words(0)]);
  const size = words(all.length + 12);
  return joined([words(kind), size, all, size]);
}

// Return what a recording holds of its first interface: its edition, its packets with times in nanoseconds, how many
// interfaces there are, and where it is damaged or cut, if it is.
export function read(file) {
  const view = new DataView(file.buffer, file.byteOffset, file.byteLength);
  const found = { url: "", edition: "", baudrate: 0, interfaces: 0, packets: [], remark: "" };
  if (file.length < 12 || view.getUint32(0) !== SECTION) throw new Error("the file is not a pcapng recording");
  let [little, unit, offset, sections] = [true, 1000n, 0n, 0];
  for (let at = 0; at < file.length;) {
    const begins = at + 12 <= file.length && view.getUint32(at) === SECTION;
    if (begins) little = view.getUint32(at + 8, true) === MAGIC;
    const size = at + 12 <= file.length ? view.getUint32(at + 4, little) : 0;
    if (size < 12 || size % 4 || at + size > file.length || view.getUint32(at + size - 4, little) !== size) {
      found.remark = `the recording is cut or damaged at byte ${at}`;
      break;
    }
    const [kind, body] = [view.getUint32(at, little), new DataView(view.buffer, view.byteOffset + at + 8, size - 12)];
    at += size;
    const whole = (place) => body.getUint32(place, little);
    if (begins && (sections += 1) > 1) {
      found.remark = "only the first section is shown";
      break;
    }
    if (kind === INTERFACE && body.byteLength >= 8 && (found.interfaces += 1) === 1) {
      const link = body.getUint16(0, little);
      if (link < USER_LINK_TYPES[0] || link > USER_LINK_TYPES[1]) throw new Error(`link type ${link} is no serial port: docs/captures.md`);
      for (const [code, value] of options(body, 8, little)) {
        const text = () => new TextDecoder().decode(value);
        if (code === 2) found.url = text();
        if (code === 3) found.edition = /^edition (\w+)$/.exec(text())?.[1] ?? "";
        if (code === 8) found.baudrate = value.getUint32(little ? 0 : 4, little);
        if (code === 9) unit = resolution(value.getUint8(0));
        if (code === 14) offset = value.getBigInt64(0, little) * 1000000000n;
      }
    }
    if (kind !== PACKET || body.byteLength < 20 || whole(0) !== 0 || 20 + whole(12) > body.byteLength) continue;
    const ticks = (BigInt(whole(4)) << 32n) | BigInt(whole(8));
    const data = new Uint8Array(body.buffer, body.byteOffset + 20, whole(12));
    const flags = options(body, 20 + ((whole(12) + 3) & ~3), little).find(([code]) => code === 2);
    const direction = DIRECTIONS[flags ? flags[1].getUint32(0, little) & 3 : 0] ?? "unknown";
    found.packets.push({ ns: (unit < 0n ? (ticks * 1000000000n) / -unit : ticks * unit) + offset, direction, data });
  }
  return found;
}

// Return the nanoseconds of a tick, or minus the ticks of a second.
function resolution(exponent) {
  if (exponent < 10) return 10n ** BigInt(9 - exponent);
  return exponent & 128 ? -(2n ** BigInt(exponent & 127)) : -(10n ** BigInt(exponent));
}

function options(body, at, little) {
  const found = [];
  while (at + 4 <= body.byteLength) {
    const [code, size] = [body.getUint16(at, little), body.getUint16(at + 2, little)];
    if (code === 0 || at + 4 + size > body.byteLength) break;
    found.push([code, new DataView(body.buffer, body.byteOffset + at + 4, size)]);
    at += 4 + ((size + 3) & ~3);
  }
  return found;
}
