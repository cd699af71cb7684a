/** What only Node has: files, TCP, and serial ports by the package `serialport`. */
import { stat } from "node:fs";
import { readFile } from "node:fs/promises";
import { connect, type Socket } from "node:net";
import { LinkError, UsageError } from "./errors.js";
import { reason, within, type Transport } from "./transport.js";

const CONNECT_SECONDS = 5;
/** Node reads a socket into a new buffer of this size. */
const TCP_CHUNK = 1 << 16;
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
  // A serial port is read into what is left of a buffer.
  return new NodeTransport(url, stream, address ? TCP_CHUNK : 0);
}

/** What sockets and the ports of `serialport` have. */
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
    // The peer must get the last request, so the stream is ended before it is destroyed.
    await within(1, new Promise<void>((done) => this.stream.end(done)));
    this.abort();
    await within(1, this.closed);
  }

  abort(): void {
    this.stream.destroy();
  }

  drained(run: () => void): void {
    // The pool of threads reads a serial port. It begins what it is asked in order, and may end it in
    // another one: so after a few rounds through the pool, what was in the port has come.
    const round = (left: number): void => {
      if (left) setImmediate(() => stat(".", () => round(left - 1)));
      else run();
    };
    round(this.chunk ? 0 : ROUNDS);
  }
}
