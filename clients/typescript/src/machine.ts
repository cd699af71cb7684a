/** The session in WebAssembly. A call passes its name and arguments as one serialized row of values. */
import { failure } from "./errors.js";
import { wasm } from "./wasm.js";

/** An argument or result of the session; `undefined`: absent. */
export type Value = undefined | number | bigint | boolean | string | Uint8Array | readonly Value[];

interface Exports {
  memory: WebAssembly.Memory;
  /** Return the address at which a serialized call of that size can be written. */
  room(size: number): number;
  /** Run the serialized call of that size; return the address of its result. */
  answer(size: number): number;
}

const encoder = new TextEncoder();
const decoder = new TextDecoder();
const WORD = 2 ** 32;
/** The longest text that is cached: names of functions, commands and arguments recur. */
const SHORT = 32;
const MOST_SHORT = 2000;

export class Machine {
  private heap = new Uint8Array();
  private view = new DataView(this.heap.buffer);
  private at = 0;
  private end = 0;
  private room = 1 << 12;
  private readonly short = new Map<string, Uint8Array>();

  private constructor(private readonly wasm: Exports) {}

  static async load(): Promise<Machine> {
    const module = await WebAssembly.compile(await wasm());
    const instance = await WebAssembly.instantiate(module);
    return new Machine(instance.exports as unknown as Exports);
  }

  /** Call a function of the session; return its result, or throw its error. */
  ask<T = Value>(...message: Value[]): T {
    let start = this.begin();
    while (!this.fits(message)) {
      this.room *= 2;
      start = this.begin();
    }
    this.at = this.wasm.answer(this.at - start);
    this.refresh();
    const [good, answer] = this.read() as Value[];
    if (!good) throw failure(answer as readonly Value[]);
    return answer as T;
  }

  private begin(): number {
    this.at = this.wasm.room(this.room);
    this.end = this.at + this.room;
    this.refresh();
    return this.at;
  }

  /** Renew the view of the memory if the memory has grown. */
  private refresh(): void {
    const { buffer } = this.wasm.memory;
    if (this.heap.buffer !== buffer) {
      this.heap = new Uint8Array(buffer);
      this.view = new DataView(buffer);
    }
  }

  /** Append a value; return false if there is no room. */
  private fits(value: Value): boolean {
    if (this.at + 9 > this.end) return false;
    if (value === undefined || value === null) {
      this.heap[this.at++] = 0;
    } else if (typeof value === "number" && Number.isSafeInteger(value) && !Object.is(value, -0)) {
      this.heap[this.at] = 1;
      this.view.setUint32(this.at + 1, value % WORD, true);
      this.view.setInt32(this.at + 5, Math.floor(value / WORD), true);
      this.at += 9;
    } else if (typeof value === "bigint") {
      this.heap[this.at] = 1;
      this.view.setBigInt64(this.at + 1, value, true);
      this.at += 9;
    } else if (typeof value === "number") {
      this.heap[this.at] = 2;
      this.view.setFloat64(this.at + 1, value, true);
      this.at += 9;
    } else if (typeof value === "boolean") {
      this.heap[this.at] = 3;
      this.heap[this.at + 1] = Number(value);
      this.at += 2;
    } else if (typeof value === "string") {
      return this.fitsBytes(4, this.encoded(value));
    } else if (value instanceof Uint8Array) {
      return this.fitsBytes(5, value);
    } else {
      // A Float64Array or another iterable is sent as a row, too.
      const row = Array.isArray(value) ? value : Array.from(value as Iterable<Value>);
      this.size(6, row.length);
      return row.every((each) => this.fits(each));
    }
    return true;
  }

  private size(tag: number, size: number): void {
    this.heap[this.at] = tag;
    this.view.setUint32(this.at + 1, size, true);
    this.at += 5;
  }

  private fitsBytes(tag: number, bytes: Uint8Array): boolean {
    this.size(tag, bytes.length);
    if (this.at + bytes.length > this.end) return false;
    this.heap.set(bytes, this.at);
    this.at += bytes.length;
    return true;
  }

  private encoded(text: string): Uint8Array {
    if (text.length > SHORT) return encoder.encode(text);
    const found = this.short.get(text) ?? encoder.encode(text);
    if (this.short.size < MOST_SHORT) this.short.set(text, found);
    return found;
  }

  /** Return the next value of a result. */
  private read(): Value {
    const at = this.at + 1;
    switch (this.heap[at - 1]) {
      case 1: {
        this.at = at + 8;
        const whole = this.view.getInt32(at + 4, true) * WORD + this.view.getUint32(at, true);
        return Number.isSafeInteger(whole) ? whole : this.view.getBigInt64(at, true);
      }
      case 2:
        this.at = at + 8;
        return this.view.getFloat64(at, true);
      case 3:
        this.at = at + 1;
        return this.heap[at] === 1;
      case 4:
        return this.text(at + 4, this.view.getUint32(at, true));
      case 5:
        this.at = at + 4 + this.view.getUint32(at, true);
        return this.heap.slice(at + 4, this.at);
      case 6: {
        this.at = at + 4;
        const row: Value[] = [];
        for (let left = this.view.getUint32(at, true); left > 0; left -= 1) row.push(this.read());
        return row;
      }
      default:
        this.at = at;
        return undefined;
    }
  }

  private text(start: number, size: number): string {
    this.at = start + size;
    let text = "";
    // For a few characters, this loop is faster than TextDecoder.
    for (let at = start; size <= SHORT && at < this.at; at += 1) {
      if (this.heap[at]! > 127) break;
      text += String.fromCharCode(this.heap[at]!);
    }
    return text.length === size ? text : decoder.decode(this.heap.subarray(start, this.at));
  }
}

const editions = new Map<string, [index: number, baudrate: number]>();
let loading: Promise<Machine> | undefined;

/** Return the session in WebAssembly, which is loaded once. */
export function machine(): Promise<Machine> {
  return (loading ??= Machine.load());
}

/** Return the index of an edition and its baud rate; the table is read once. */
export function edition(machine: Machine, table: string): [index: number, baudrate: number] {
  const found = editions.get(table) ?? machine.ask<[number, number]>("edition", table);
  editions.set(table, found);
  return found;
}

/** Return an object from a row in which names and values alternate. */
export function objectOf(fields: readonly Value[]): Record<string, Value> {
  const found: Record<string, Value> = {};
  for (let at = 0; at < fields.length; at += 2) found[fields[at] as string] = fields[at + 1];
  return found;
}
