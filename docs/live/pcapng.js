// Write recordings, and read those that cobotwire wrote: pcapng, as docs/captures.md describes it.

const [SECTION, INTERFACE, STATISTICS, PACKET] = [0x0a0d0d0a, 1, 5, 6];
const [MAGIC, LINK_TYPE, NANOSECONDS] = [0x1a2b3c4d, 159, 9];
const FLAGS = { unknown: 0, received: 1, sent: 2 };
const text = (value) => new TextEncoder().encode(value);

// Writing this many entries takes a few milliseconds; after each batch the worker handles urgent messages, such as Stop.
const AT_ONCE = 500;

function turn() {
  const { port1, port2 } = new MessageChannel();
  return new Promise((go) => {
    port1.onmessage = () => (port1.close(), go());
    port2.postMessage(null);
  });
}

// Return a recording of the chosen entries as a blob. Their times count from `startNs` after 1970.
export async function written(entries, chosen, { url, edition, baudrate, startNs }) {
  const names = [[2, text(url)], [3, text(`edition ${edition}`)], [8, words(baudrate, 0)], [9, Uint8Array.of(NANOSECONDS)]];
  const head = new Uint8Array([...words(MAGIC, 1), ...new Uint8Array(8).fill(255)]);
  const chunks = [];
  let blocks = [block(SECTION, head, [[4, text("cobotwire")]]), block(INTERFACE, words(LINK_TYPE, 0), names)];
  let [first, last, count] = [undefined, startNs, 0];
  for (const [index, entry] of entries.entries()) {
    if (index % AT_ONCE === AT_ONCE - 1) {
      chunks.push(joined(blocks));
      blocks = [];
      await turn();
    }
    if (!chosen(entry)) continue;
    count += 1;
    const { t, d, data, reason } = entry;
    const ns = startNs + BigInt(Math.round(t * 1e9));
    if (first === undefined || ns < first) first = ns;
    if (ns > last) last = ns;
    const comment = reason ? [[1, text(`noise ${reason}`)]] : [];
    const body = joined([words(0, ...time(ns), data.length, data.length), padded(data)]);
    blocks.push(block(PACKET, body, [...comment, [2, words(FLAGS[d])]]));
  }
  const counts = [[2, words(...time(first ?? last))], [3, words(...time(last))], [4, words(count, 0)]];
  return new Blob([...chunks, ...blocks, block(STATISTICS, words(0, ...time(last)), counts)]);
}

const words = (...numbers) => new Uint8Array(Uint32Array.from(numbers).buffer);
const time = (ns) => [Number(ns >> 32n), Number(ns & 0xffffffffn)];
const padded = (bytes) => joined([bytes, new Uint8Array(-bytes.length & 3)]);

function joined(parts) {
  const all = new Uint8Array(parts.reduce((size, part) => size + part.length, 0));
  let at = 0;
  for (const part of parts) all.set(part, (at += part.length) - part.length);
  return all;
}

function block(kind, body, options) {
  const encoded = options.map(([code, value]) => joined([words(code | (value.length << 16)), padded(value)]));
  const size = words(encoded.reduce((sum, option) => sum + option.length, body.length + 16));
  return joined([words(kind), size, body, ...encoded, words(0), size]);
}

// Return what a recording holds of its first interface: its packets with times in nanoseconds, how many interfaces there
// are, and a remark if it is cut or damaged.
export function read(file) {
  try {
    return parsed(file);
  } catch (error) {
    if (!(error instanceof RangeError)) throw error;
    throw new Error("the recording is damaged: an option is too short");
  }
}

function parsed(file) {
  const view = new DataView(file.buffer, file.byteOffset, file.byteLength);
  const whole = (at) => view.getUint32(at, true);
  const found = { url: "", edition: "", baudrate: 0, interfaces: 0, packets: [], remark: "" };
  if (file.length < 12 || whole(0) !== SECTION || whole(8) !== MAGIC) throw new Error("the file is not a recording of cobotwire");
  for (let at = 0, size = 0; at < file.length; at += size) {
    size = at + 12 <= file.length ? whole(at + 4) : 0;
    if (size < 12 || size % 4 || at + size > file.length || whole(at + size - 4) !== size || (at && whole(at) === SECTION)) {
      found.remark = `the recording is cut or damaged at byte ${at}`;
      return found;
    }
    const [body, end] = [at + 8, at + size - 4];
    if (whole(at) === INTERFACE && (found.interfaces += 1) === 1) {
      const names = new Map(options(view, body + 8, end));
      const name = (code) => new TextDecoder().decode(names.get(code));
      if (names.get(9)?.getUint8(0) !== NANOSECONDS || names.has(14)) throw new Error("the recording has no times in nanoseconds, as those of cobotwire have");
      Object.assign(found, { url: name(2), edition: /^edition (\w+)$/.exec(name(3))?.[1] ?? "", baudrate: names.get(8)?.getUint32(0, true) ?? 0 });
    } else if (whole(at) === PACKET && size >= 32 && whole(body) === 0 && body + 20 + whole(body + 12) <= end) {
      const [length, ns] = [whole(body + 12), (BigInt(whole(body + 4)) << 32n) | BigInt(whole(body + 8))];
      const flags = new Map(options(view, body + 20 + ((length + 3) & ~3), end)).get(2)?.getUint32(0, true) & 3;
      const direction = Object.keys(FLAGS)[flags] ?? "unknown";
      found.packets.push({ ns, direction, data: new Uint8Array(view.buffer, view.byteOffset + body + 20, length) });
    }
  }
  return found;
}

function options(view, at, end) {
  const found = [];
  while (at + 4 <= end && view.getUint16(at, true)) {
    const size = view.getUint16(at + 2, true);
    if (at + 4 + size > end) break;
    found.push([view.getUint16(at, true), new DataView(view.buffer, view.byteOffset + at + 4, size)]);
    at += 4 + ((size + 3) & ~3);
  }
  return found;
}
