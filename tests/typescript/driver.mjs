// A client that a test controls: it reads calls from standard input and prints their results, one
// JSON object per line. It also prints each write, with start and end by the monotonic clock.
//
// `tests/probe_client.py` is the other end.
import { readFileSync } from "node:fs";
import { createInterface } from "node:readline";
import { Client, describe } from "../../clients/typescript/dist/index.js";
import { open } from "../../clients/typescript/dist/node.js";

const [, table, url, given] = process.argv.slice(2);
class Arm extends Client {}
describe(Arm, readFileSync(table, "utf8"), {}, {});

const say = (line) => process.stdout.write(`${JSON.stringify(line)}\n`);
const now = () => Number(process.hrtime.bigint()) / 1e9;

// A transport whose writes are reported.
function observed(transport) {
  const write = async (bytes) => {
    const handed = now();
    const data = Buffer.from(bytes).toString("hex");
    try {
      await transport.write(bytes);
      say({ handed, taken: now(), data, size: bytes.length });
    } catch (error) {
      say({ handed, taken: now(), data, size: 0 });
      throw error;
    }
  };
  return {
    url: transport.url,
    start: (...listeners) => transport.start(...listeners),
    write,
    close: () => transport.close(),
    abort: () => transport.abort(),
  };
}

async function opened() {
  const { timeout, deadline, attempts, shortest_attempt: shortestAttempt, grace } = JSON.parse(given);
  const options = { timeout, deadline, retry: { attempts, shortestAttempt, grace } };
  return Arm.open(observed(await open(url, 115200)), options);
}

let arm;
const signals = new Map();

async function call({ id, call: command, fields, ack_within: ackWithin }) {
  const controller = new AbortController();
  signals.set(id, controller);
  const began = now();
  let client = arm.withSignal(controller.signal);
  if (ackWithin != null) client = client.acknowledged(ackWithin);
  try {
    const result = await client.call(command, fields);
    say({ id, result, began, ended: now() });
  } catch (error) {
    const name = controller.signal.aborted ? "Cancelled" : error.name;
    say({ id, error: name, text: error.message, began, ended: now() });
  } finally {
    signals.delete(id);
  }
}

async function obey(line) {
  if ("give_up" in line) return signals.get(line.give_up)?.abort();
  if ("call" in line) return call(line);
  try {
    if ("open" in line) arm = await opened();
    else await arm.close();
    say({ id: line.id });
  } catch (error) {
    say({ id: line.id, error: error.name, text: error.message });
  }
}

for await (const line of createInterface({ input: process.stdin })) void obey(JSON.parse(line));
await arm?.close();
