// Find out which edition an arm speaks: walk through a tree of identification.json, with the
// steps of `cobotwire identify`. Only queries are sent, and bytes that end half a frame.

import { ProtocolError, ReplyTimeout } from "./cobotwire/dist/errors.js";
import { nameOf, openWebSerial, within } from "./cobotwire/dist/transport.js";

// A port that several clients use, one after the other.
class Port {
  static async open(port, baudrate) {
    const opened = new Port();
    opened.inner = await openWebSerial(port, nameOf(port), baudrate);
    opened.inner.start((data) => opened.take?.(data), (detail) => opened.ended?.(detail));
    return opened;
  }

  // Return a transport that leaves the port open.
  lend() {
    const start = (take, ended) => Object.assign(this, { take, ended });
    return { url: this.inner.url, write: (data) => this.inner.write(data), start, close: async () => {}, abort: () => {} };
  }
}

// Return the client class of the module of an edition.
export const clientOf = (module) => Object.values(module).find((each) => typeof each === "function");

// Return the edition of the arm, the open port with its rate, and the evidence in words. `chosen` is the choice of the
// user, or empty. Throw if the choice is wrong, or if several editions are possible and none of them was chosen.
export async function identify(port, chosen) {
  const evidence = [];
  for (const { baudrate, near, tree } of await (await fetch("identification.json")).json()) {
    const opened = await Port.open(port, baudrate);
    try {
      let node = tree;
      while (node.query) node = await ask(opened, node, near, evidence);
      // Without a legal reply, nothing shows that it is one of these editions.
      if (node.editions.length && opened.legal) return { port: opened, baudrate, ...decide(node, chosen, evidence.join(", ")) };
    } catch (error) {
      opened.inner.abort();
      throw error;
    }
    await opened.inner.close();
  }
  throw new Error(`no arm sent a legal reply: is it switched on, and is this its port? ${evidence.join(", ")}`);
}

// Send the query of a node; return the next node.
async function ask(port, { edition, query, given, fill, replied, illegal, silent }, near, evidence) {
  const module = await import(`./cobotwire/editions/${edition}.js`);
  // If the port takes no bytes, the query reports that.
  if (fill) await within(1, port.inner.write(Uint8Array.from(fill.match(/../g), (pair) => Number.parseInt(pair, 16))));
  const client = await clientOf(module).open(port.lend());
  try {
    const result = Object.values(await client.call(query, given)).at(-1);
    evidence.push(`${query} replied ${result}`);
    port.legal = true;
    return replied.find(([limit]) => limit === null || Math.abs(limit - result) <= near)?.[1] ?? silent;
  } catch (error) {
    if (!(error instanceof ReplyTimeout || error instanceof ProtocolError)) throw error;
    const none = error instanceof ReplyTimeout;
    evidence.push(`${query} got ${none ? "no" : "an illegal"} reply`);
    return none ? silent : (illegal ?? silent);
  } finally {
    await client.close();
  }
}

function decide({ editions, alike }, chosen, shown) {
  const names = editions.join(" or ");
  if (chosen && !editions.includes(chosen)) throw new Error(`the arm speaks ${names}, not ${chosen}: ${shown}. Choose its own edition.`);
  if (editions.length === 1) return { name: names, shown: `edition ${names}: ${shown}` };
  const open = `the replies fit several editions, ${editions.join(", ")}: ${shown}. ${alike}`;
  if (!chosen) throw new Error(`${open}. Choose your robot, and connect again.`);
  return { name: chosen, shown: `edition ${chosen}, as you chose; ${open}` };
}
