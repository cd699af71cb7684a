/** The session in WebAssembly: one call takes a message of values and returns one. */
import { failure } from "./errors.js";

/** What a message consists of; an absent value is `undefined`. */
export type Value = undefined | number | bigint | boolean | string | Uint8Array | readonly Value[];

interface Exports {
  memory: WebAssembly.Memory;
  /** Return where a message of that size is to be written. */
  room(size: number): number;
  /** Answer the message, and return the size of the answer, which is where `room(0)` says. */
  answer(): number;
}

const encoder = new TextEncoder();
const decoder = new TextDecoder();
const NODE = "./node.js";

/** Whether the program runs in Node. Its module has no constant name, so that no bundler follows it. */
export const inNode = typeof globalThis.process === "object" && !!process.versions?.node;

/** Return the module with what only Node has. */
export async function node(): Promise<typeof import("./node.js")> {
  return (await import(NODE)) as typeof import("./node.js");
}

export class Machine {
  private scratch = new DataView(new ArrayBuffer(1 << 16));
  private at = 0;

  private constructor(private readonly wasm: Exports) {}

  static async load(): Promise<Machine> {
    const url = new URL("./cobotwire.wasm", import.meta.url);
    const bytes = inNode ? (await node()).read(url) : (await fetch(url)).arrayBuffer();
    const module = await WebAssembly.compile((await bytes) as BufferSource);
    const instance = await WebAssembly.instantiate(module);
    return new Machine(instance.exports as unknown as Exports);
  }

  /** Send a message and return the answer, or throw its error. */
  ask<T = Value>(...message: Value[]): T {
    this.at = 0;
    this.write(message);
    const start = this.wasm.room(this.at);
    new Uint8Array(this.wasm.memory.buffer, start, this.at).set(
      new Uint8Array(this.scratch.buffer, 0, this.at),
    );
    const size = this.wasm.answer();
    const view = new DataView(this.wasm.memory.buffer, this.wasm.room(size), size);
    const [good, answer] = new Reader(view).next() as [boolean, Value];
    if (!good) throw failure(answer as readonly Value[]);
    return answer as T;
  }

  private put(tag: number, size: number): number {
    const at = this.at + 1;
    this.at = at + size;
    if (this.at > this.scratch.byteLength) {
      const larger = new Uint8Array(2 * this.at);
      larger.set(new Uint8Array(this.scratch.buffer));
      this.scratch = new DataView(larger.buffer);
    }
    this.scratch.setUint8(at - 1, tag);
    return at;
  }

  private bytes(tag: number, bytes: Uint8Array): void {
    const at = this.put(tag, 4 + bytes.length);
    this.scratch.setUint32(at, bytes.length, true);
    new Uint8Array(this.scratch.buffer).set(bytes, at + 4);
  }

  private write(value: Value): void {
    if (value === undefined || value === null) {
      this.put(0, 0);
    } else if (typeof value === "bigint" || (Number.isSafeInteger(value) && !Object.is(value, -0))) {
      const at = this.put(1, 8);
      this.scratch.setBigInt64(at, BigInt(value as number), true);
    } else if (typeof value === "number") {
      const at = this.put(2, 8);
      this.scratch.setFloat64(at, value, true);
    } else if (typeof value === "boolean") {
      const at = this.put(3, 1);
      this.scratch.setUint8(at, Number(value));
    } else if (typeof value === "string") {
      this.bytes(4, encoder.encode(value));
    } else if (value instanceof Uint8Array) {
      this.bytes(5, value);
    } else {
      // Other rows than arrays, such as a Float64Array, are rows too.
      const row = Array.from(value);
      const at = this.put(6, 4);
      this.scratch.setUint32(at, row.length, true);
      row.forEach((each) => this.write(each));
    }
  }
}

class Reader {
  private at = 0;

  constructor(private readonly view: DataView) {}

  private skip(size: number): number {
    this.at += size;
    return this.at - size;
  }

  private bytes(): Uint8Array {
    const size = this.view.getUint32(this.skip(4), true);
    return new Uint8Array(this.view.buffer, this.view.byteOffset + this.skip(size), size);
  }

  next(): Value {
    switch (this.view.getUint8(this.skip(1))) {
      case 1: {
        const whole = this.view.getBigInt64(this.skip(8), true);
        return Number.isSafeInteger(Number(whole)) ? Number(whole) : whole;
      }
      case 2:
        return this.view.getFloat64(this.skip(8), true);
      case 3:
        return this.view.getUint8(this.skip(1)) === 1;
      case 4:
        return decoder.decode(this.bytes());
      case 5:
        return this.bytes().slice();
      case 6: {
        const size = this.view.getUint32(this.skip(4), true);
        return Array.from({ length: size }, () => this.next());
      }
      default:
        return undefined;
    }
  }
}
