/** What only Node has: files, TCP, and serial ports through the package `serialport`. */
import { stat } from "node:fs";
import { readFile } from "node:fs/promises";
import { connect, type Socket } from "node:net";
import { LinkError, UsageError } from "./errors.js";
import { reason, within, type Transport } from "./transport.js";

const CONNECT_SECONDS = 5;
/** Node reads a socket into a new buffer of this size. */
const TCP_CHUNK = 1 << 16;
/** How often a job passes through the thread pool before the bytes of a serial port are delivered. */
const ROUNDS = 4;

/** Read a file of the package. */
export function read(url: URL): Promise<Uint8Array> {
  return readFile(url);
}

/** Connect to `socket://host:port`, or open a serial port. */
export async function open(url: string, baudRate: number): Promise<Transport> {
  const address = /^socket:\/\/\[?(.*?)\]?:(\d+)$/.exec(url);
  const opening = address ? openTcp(address[1]!, Number(address[2])) : openSerial(url, baudRate);
  let stream: Stream;
  try {
    stream = await opening;
  } catch (error) {
    if (error instanceof UsageError) throw error;
    throw new LinkError(`${url}: cannot be opened: ${reason(error)}`, 0);
  }
  // A serial port is read into the rest of a buffer, so a short read does not mean that it is empty.
  return new NodeTransport(url, stream, address ? TCP_CHUNK : 0);
}

/** What sockets and the ports of `serialport` have in common. */
interface Stream {
  on(event: "data", listener: (data: Uint8Array) => void): unknown;
  on(event: "error", listener: (error: Error) => void): unknown;
  on(event: "close", listener: () => void): unknown;
  write(data: Uint8Array, done: (error?: Error | null) => void): boolean;
  readonly writableLength: number;
  end(done?: () => void): unknown;
  destroy(): unknown;
}

function openTcp(host: string, port: number): Promise<Socket> {
  return new Promise((done, failed) => {
    const socket = connect({ host, port, noDelay: true, timeout: CONNECT_SECONDS * 1000 });
    socket.once("error", failed);
    socket.once("timeout", () => socket.destroy(new Error("the connection timed out")));
    socket.once("connect", () => {
      socket.setTimeout(0);
      socket.off("error", failed);
      done(socket);
    });
  });
}

async function openSerial(path: string, baudRate: number): Promise<Stream> {
  const name = "serialport";
  let found: { SerialPort: new (options: object, opened: (error: Error | null) => void) => Stream };
  try {
    found = await import(name);
  } catch {
    throw new UsageError(`${path} is a serial port, which needs: npm install serialport`);
  }
  return new Promise((done, failed) => {
    const port = new found.SerialPort({ path, baudRate }, (error) =>
      error ? failed(error) : done(port),
    );
  });
}

class NodeTransport implements Transport {
  private closed: Promise<void>;

  constructor(
    readonly url: string,
    private readonly stream: Stream,
    readonly chunk: number,
  ) {
    this.closed = new Promise((done) => stream.on("close", done));
  }

  start(received: (data: Uint8Array) => void, ended: (detail: string) => void): void {
    this.stream.on("data", received);
    this.stream.on("error", (error) => ended(`cannot be read: ${error.message}`));
    this.stream.on("close", () => ended("the peer has closed the connection"));
  }

  write(data: Uint8Array): Promise<void> | undefined {
    let settle: (error?: Error | null) => void = () => {};
    this.stream.write(data, (error) => settle(error));
    if (this.stream.writableLength === 0) return undefined;
    return new Promise((done, failed) => (settle = (error) => (error ? failed(error) : done())));
  }

  async close(): Promise<void> {
    // `destroy` discards unsent bytes, so the stream is ended first.
    await within(1, new Promise<void>((done) => this.stream.end(done)));
    this.abort();
    await within(1, this.closed);
  }

  abort(): void {
    this.stream.destroy();
  }

  drained(run: () => void): void {
    // Node's thread pool reads serial ports. It starts jobs in order, but they may end in another order.
    // After a few jobs, one after the other, the read that began before them has delivered its bytes.
    const round = (left: number): void => {
      if (left) setImmediate(() => stat(".", () => round(left - 1)));
      else run();
    };
    round(this.chunk ? 0 : ROUNDS);
  }
}
