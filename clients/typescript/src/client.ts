/// <reference lib="esnext.disposable" preserve="true" />
/** The client: what users call. Modules of editions add a method for each command. */
import { ProtocolError, ReplyTimeout, UsageError } from "./errors.js";
import { Line, WRITE_SECONDS, nanoseconds } from "./line.js";
import { edition, machine, objectOf, type Value } from "./machine.js";
import { nameOf, openWebSerial, reason, type Transport, type WebSerialPort } from "./transport.js";
import { inNode, node } from "./wasm.js";

/** Where an arm is: `/dev/ttyACM0` or `socket://host:port` (in Node), a browser's serial port, or a transport. */
export type Port = string | WebSerialPort | Transport;

/** The lowest and the highest value; `undefined`: no limit. */
export type Range = readonly [number, number] | undefined;

/** The options of a client; times are in seconds. */
export interface Options {
  /** How long the arm has to reply once a request is sent; default: the timeout of the edition. */
  timeout?: number;
  /** How long a call may take, waiting for its turn included; default: no limit. */
  deadline?: number;
  /** How often queries are sent within their timeout; other requests are sent once. */
  retry?: { attempts?: number; shortestAttempt?: number; grace?: number };
  /** The device that requests go to, by its name or number. */
  address?: string | number;
  /** The rate of a serial port; default: that of the edition. */
  baudrate?: number;
  /** The highest speed in percent, and ranges for x, y and z of the end of the arm in millimetres. */
  limits?: { speed?: number; workspace?: readonly [Range, Range, Range] };
  /** What happens to an arm in motion when `run()` fails, or the client is disposed of. */
  onError?: "stop" | "leave";
}

/** The result of a query, and the times (`performance.now()`) of its request and its reply. */
export interface Sample<T> {
  value: T;
  requestedAt: number;
  repliedAt: number;
}

/** What a method returns: one field, or an object whose keys are mapped to fields; `undefined`: nothing. */
type Result = string | Record<string, string> | undefined;
/** A command: its name, arguments and result, and which of them are in radians, and which are booleans. */
type Row = [command: string, names?: string[], result?: Result, radians?: string[], flags?: string[]];
interface Description {
  table: string;
  events: Record<string, Row>;
}
interface Settings {
  address?: number;
  ackWithin?: number;
  signal?: AbortSignal;
  /** The times of a stream's last sample. If this is set, only queries are sent, each once. */
  sampled?: { requestedAt: number; repliedAt: number };
}
type Class<T> = new (line: Line, description: Description) => T;

const descriptions = new WeakMap<object, Description>();
/** Add a method for each command to an edition's client, and set its table and events. */
export function describe(
  type: Class<Client>,
  table: string,
  methods: Record<string, Row>,
  events: Record<string, Row>,
): void {
  descriptions.set(type, { table, events });
  for (const [method, row] of Object.entries(methods)) {
    const [command, names = [], , radians = []] = row;
    const value = async function (this: Client, ...given: Value[]): Promise<unknown> {
      if (given.length > names.length) {
        throw new UsageError(`${method}() takes ${names.length} arguments, not ${given.length}`);
      }
      const named = names.flatMap((name, index) => {
        const each = given[index];
        return [name, radians.includes(name) ? mapped(each, (angle) => angle * (180 / Math.PI)) : each];
      });
      return shaped(await this.perform(command, named), row);
    };
    Object.defineProperty(type.prototype, method, { value, writable: true, configurable: true });
  }
}

/** Return a value with `change` applied to each number, also inside rows. */
function mapped(value: Value, change: (number: number) => Value): Value {
  if (typeof value === "number") return change(value);
  if (typeof value !== "object" || value instanceof Uint8Array) return value;
  return Array.from(value, (each) => mapped(each, change));
}

/** Return the result of a method, made from the fields of a reply. */
function shaped(fields: Record<string, Value>, [, , result, radians, flags]: Row): unknown {
  const take = (name: string): Value => {
    if (flags?.includes(name)) return mapped(fields[name], (number) => number !== 0);
    if (radians?.includes(name)) return mapped(fields[name], (angle) => angle * (Math.PI / 180));
    return fields[name];
  };
  if (result === undefined || typeof result === "string") return take(result ?? "");
  return Object.fromEntries(Object.entries(result).map(([name, field]) => [name, take(field)]));
}

export class Client {
  private settings: Settings = {};

  constructor(
    private readonly line: Line,
    private readonly description: Description,
  ) {}

  /** Open an arm. */
  static async open<T extends Client>(
    this: Class<T>,
    port: Port,
    options: Options = {},
  ): Promise<T> {
    const description = descriptions.get(this);
    if (!description) {
      throw new UsageError(`${this.name} has no edition; use the client of one: cobotwire/mycobot280`);
    }
    const session = await machine();
    const [index, usual] = edition(session, description.table);
    const { timeout, deadline, retry, address, baudrate = usual, limits, onError } = options;
    const given = [
      ...[timeout, deadline, retry?.attempts, retry?.shortestAttempt, retry?.grace],
      ...[address?.toString(), limits?.speed, limits?.workspace, onError],
    ];
    const url = typeof port === "string" ? port : "start" in port ? port.url : nameOf(port);
    // The session rejects bad options, so it is made before the port is opened.
    const id = session.ask<number>("open", index, url, ...given);
    let transport: Transport;
    try {
      transport = await opened(port, url, baudrate);
    } catch (error) {
      session.ask("lose", id, nanoseconds(), false, false, reason(error));
      throw error;
    }
    const line = new Line(session, id, transport, Math.min(WRITE_SECONDS, deadline ?? Infinity));
    return new this(line, description);
  }

  /** Open an arm, run a function with it, and close it. If the function fails, the arm is stopped. */
  static async run<T extends Client, R>(
    this: Class<T>,
    port: Port,
    body: (arm: T) => Promise<R>,
    options: Options = {},
  ): Promise<R> {
    const arm = await (this as Class<T> & typeof Client).open<T>(port, options);
    try {
      return await body(arm);
    } catch (error) {
      await arm.line.close(true);
      throw error;
    } finally {
      await arm.close();
    }
  }

  /** Send what was written, and close the port. The arm is not stopped; pending calls end with an error. */
  async close(): Promise<void> {
    await this.line.close();
  }

  /** Stop an arm that this client has set in motion, unless `close()` was called; then close. */
  async [Symbol.asyncDispose](): Promise<void> {
    await this.line.close(true);
  }

  /** Return a client for another address, by its name or number; both share the connection. */
  at(address: string | number): this {
    return this.with({ address: this.line.ask<number>("address", address.toString()) });
  }

  /** Return a client on the same connection that waits for acknowledgements of one-way requests. */
  acknowledged(seconds: number): this {
    return this.with({ ackWithin: seconds });
  }

  /** Return a client on the same connection: `signal` ends its calls, and unsent requests are never sent. */
  withSignal(signal: AbortSignal): this {
    return this.with({ signal });
  }

  /** Sample queries `rate` times a second: `arm.stream((arm) => arm.getAngles(), 20)`. */
  stream<T>(query: (arm: this) => Promise<T>, rate: number): Stream<T> {
    if (!(rate > 0 && rate <= 1000)) {
      throw new UsageError(`rate is ${rate}; allowed: a number above 0 and up to 1000`);
    }
    const sampled = { requestedAt: 0, repliedAt: 0 };
    const arm = this.with({ sampled });
    return new Stream(() => query(arm), sampled, 1000 / rate);
  }

  /** Receive the events with this name from now on, until none arrives within `timeout` seconds. */
  events(name: string, timeout = Infinity): EventStream<unknown> {
    const row = this.description.events[name];
    if (!row) throw new UsageError(`${this.constructor.name} has no event ${name}`);
    return new EventStream(this.line, row, timeout, this.settings.signal);
  }

  /** Send a request by the name of its command; return the fields of its reply. */
  call(command: string, fields: Record<string, Value> = {}): Promise<Record<string, Value>> {
    return this.perform(command, Object.entries(fields).flat());
  }

  /** Return the bytes of a request by the name of its command, checked as for `call`; nothing is sent. */
  prepare(command: string, fields: Record<string, Value> = {}): Uint8Array {
    const { address } = this.settings;
    return this.line.ask("prepare", command, Object.entries(fields).flat(), address, undefined);
  }

  /** @internal */
  async perform(command: string, named: Value[]): Promise<Record<string, Value>> {
    const { address, ackWithin, signal, sampled } = this.settings;
    const [fields, requestedAt, repliedAt] = await this.line.call(
      signal,
      ...[command, named, address, ackWithin, sampled !== undefined],
    );
    if (sampled) {
      sampled.requestedAt = (requestedAt as number) / 1e6;
      sampled.repliedAt = (repliedAt as number) / 1e6;
    }
    return objectOf(fields as readonly Value[]);
  }

  private with(settings: Settings): this {
    const other = Object.create(Object.getPrototypeOf(this)) as this;
    return Object.assign(other, this, { settings: { ...this.settings, ...settings } });
  }
}

async function opened(port: Port, url: string, baudrate: number): Promise<Transport> {
  if (typeof port !== "string") {
    return "start" in port ? port : openWebSerial(port, url, baudrate);
  }
  if (!inNode) {
    throw new UsageError(`${url} needs Node; in a browser pass await navigator.serial.requestPort()`);
  }
  return (await node()).open(url, baudrate);
}

/** The samples of a query; see `Client.stream`. */
export class Stream<T> implements AsyncIterable<Sample<T>> {
  /** The number of periods without a sample: no valid reply came, or the loop asked after the period. */
  missed = 0;

  constructor(
    private readonly query: () => Promise<T>,
    private readonly sampled: { requestedAt: number; repliedAt: number },
    private readonly period: number,
  ) {}

  async *[Symbol.asyncIterator](): AsyncGenerator<Sample<T>> {
    for (let at = performance.now(); ; at += this.period) {
      const late = Math.floor((performance.now() - at) / this.period);
      if (late > 0) {
        this.missed += late;
        at += late * this.period;
      }
      const left = at - performance.now();
      if (left > 0) await new Promise((done) => setTimeout(done, left));
      try {
        yield { value: await this.query(), ...this.sampled };
      } catch (error) {
        if (!(error instanceof ReplyTimeout || error instanceof ProtocolError)) throw error;
        this.missed += 1;
      }
    }
  }
}

/** Events of one name; see `Client.events`. */
export class EventStream<T> implements AsyncIterable<T> {
  private readonly queue: number;

  constructor(
    private readonly line: Line,
    private readonly row: Row,
    private readonly timeout: number,
    private readonly signal: AbortSignal | undefined,
  ) {
    this.queue = line.ask<number>("subscribe", row[0]);
  }

  /** The number of events that were dropped, oldest first, because too many were queued. */
  get lost(): number {
    return this.ask<number>("lost");
  }

  async *[Symbol.asyncIterator](): AsyncGenerator<T> {
    let until = performance.now() + this.timeout * 1000;
    for (;;) {
      const fields = this.ask<readonly Value[] | undefined>("event");
      if (fields) {
        yield shaped(objectOf(fields), this.row) as T;
        until = performance.now() + this.timeout * 1000;
      } else {
        const left = (until - performance.now()) / 1000;
        if (left <= 0 || !(await this.line.arrival(left, this.signal))) return;
      }
    }
  }

  private ask<A>(what: string): A {
    return this.line.ask<A>(what, this.queue);
  }
}
