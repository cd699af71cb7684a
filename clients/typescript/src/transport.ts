/** Transports: streams of bytes to a device. */
import { LinkError } from "./errors.js";

/** An open stream of bytes to a device. */
export interface Transport {
  /** The name in errors. A client recognises late replies to an earlier client of the same name. */
  readonly url: string;
  /** The largest read; a shorter one leaves no bytes unread. Omit it if a short read may leave some. */
  readonly chunk?: number;
  /** Begin to report received bytes, and the reason if the stream ends. */
  start(received: (data: Uint8Array) => void, ended: (detail: string) => void): void;
  /** Write bytes. Return `undefined` if the system has taken all of them, else a promise of that. */
  write(data: Uint8Array): Promise<void> | undefined;
  /** Send what was written, and close the stream. It takes a second at most. */
  close(): Promise<void>;
  /** Close the stream at once; nothing more is sent. */
  abort(): void;
  /** Run a function after all arrived bytes are reported. Omit it if they are by the next turn of the loop. */
  drained?(run: () => void): void;
}

/** The members of a browser's serial port (`navigator.serial`) that a client uses. */
export interface WebSerialPort {
  readonly readable: ReadableStream<Uint8Array> | null;
  readonly writable: WritableStream<Uint8Array> | null;
  open(options: { baudRate: number }): Promise<void>;
  close(): Promise<void>;
}

/** Return the text of what was thrown. */
export function reason(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}

/** Wait for a promise, but at most for `seconds`. */
export async function within(seconds: number, promise: Promise<unknown> | undefined): Promise<void> {
  let timer: ReturnType<typeof setTimeout> | undefined;
  const over = new Promise((done) => (timer = setTimeout(done, seconds * 1000)));
  try {
    await Promise.race([promise, over]);
  } finally {
    clearTimeout(timer);
  }
}

const names = new WeakMap<WebSerialPort, string>();
let ports = 0;

/** Return the name of a port of the browser. */
export function nameOf(port: WebSerialPort): string {
  const name = names.get(port) ?? `serial port ${++ports}`;
  names.set(port, name);
  return name;
}

/** Open a serial port that the browser lets the page use. */
export async function openWebSerial(
  port: WebSerialPort,
  url: string,
  baudRate: number,
): Promise<Transport> {
  try {
    await port.open({ baudRate });
  } catch (error) {
    throw new LinkError(`${url}: cannot be opened: ${reason(error)}`, 0);
  }
  return new WebSerial(url, port);
}

class WebSerial implements Transport {
  private reader: ReadableStreamDefaultReader<Uint8Array>;
  private readonly writer: WritableStreamDefaultWriter<Uint8Array>;
  private closed: Promise<void> | undefined;

  constructor(
    readonly url: string,
    private readonly port: WebSerialPort,
  ) {
    this.reader = port.readable!.getReader();
    this.writer = port.writable!.getWriter();
  }

  start(received: (data: Uint8Array) => void, ended: (detail: string) => void): void {
    const read = async (): Promise<void> => {
      for (let stream = this.port.readable; ; ) {
        const chunk = await this.reader.read().catch((error: unknown) => reason(error));
        if (typeof chunk !== "string") {
          if (chunk.done) return ended("the peer has closed the connection");
          received(chunk.value);
          continue;
        }
        // After a break, a parity error or an overrun, the port continues with a new stream.
        const next = this.closed ? stream : this.port.readable;
        if (!next || next === stream) return ended(`cannot be read: ${chunk}`);
        this.reader.releaseLock();
        this.reader = (stream = next).getReader();
      }
    };
    read().catch((error: unknown) => ended(`cannot be read: ${reason(error)}`));
  }

  async write(data: Uint8Array): Promise<void> {
    await this.writer.write(data);
  }

  async close(): Promise<void> {
    try {
      await within(1, this.writer.close());
    } finally {
      this.abort();
      await within(1, this.closed);
    }
  }

  abort(): void {
    const nothing = (): void => {};
    const ended = [this.reader.cancel(), this.writer.abort()].map((each) => each.catch(nothing));
    this.closed ??= Promise.all(ended)
      .then(() => {
        this.reader.releaseLock();
        this.writer.releaseLock();
        return this.port.close();
      })
      .catch(nothing);
  }
}
