/** A session and its transport, which clients share if one was made from the other (`at()`, ...). */
import { LinkError, failure } from "./errors.js";
import type { Machine, Value } from "./machine.js";
import { reason, within, type Transport } from "./transport.js";

/** The result of a step of the session: bytes to write, calls that ended, nanoseconds to the next step, a new call. */
type Step = [
  bytes: Uint8Array | undefined,
  ended: [call: number, good: boolean, answer: readonly Value[]][],
  idle: number | undefined,
  call: number | undefined,
];
interface Caller {
  done(answer: readonly Value[]): void;
  failed(error: unknown): void;
}

/** A transport that takes no bytes for this long is stuck. */
export const WRITE_SECONDS = 1;

/** After a read found no more bytes, the port counts as empty for this time: a byte at 115,200 baud takes longer. */
const EMPTY_MS = 0.05;

/** Return a time of the session, in nanoseconds. */
export const nanoseconds = (at = performance.now()): number => Math.round(at * 1e6);

/** Run a function after the event loop has delivered all bytes that have arrived by now. */
const afterTurn: (run: () => void) => void =
  typeof setImmediate === "function"
    ? // Node reads sockets between two turns of its loop.
      (run) => setImmediate(() => setImmediate(run))
    : (run) => {
        const { port1, port2 } = new MessageChannel();
        port1.onmessage = run;
        port2.postMessage(undefined);
      };

export class Line {
  private readonly callers = new Map<number, Caller>();
  private waiting: (() => void)[] = [];
  private timer: ReturnType<typeof setTimeout> | undefined;
  private wakesAt = Infinity;
  private reading = false;
  private emptyAt = -Infinity;
  /** Whether all bytes that had arrived were read before the last step. */
  private drained = false;
  private writing = false;
  private open = true;

  constructor(
    private readonly machine: Machine,
    private readonly id: number,
    private readonly transport: Transport,
    private readonly writeSeconds: number,
  ) {
    transport.start(
      (data) => {
        if (data.length < (transport.chunk ?? 0)) this.emptyAt = performance.now();
        this.advance("receive", data);
      },
      (detail) => this.lose(detail),
    );
  }

  /** Call a function of the session by its name. */
  ask<T = Value>(what: string, ...rest: Value[]): T {
    return this.machine.ask<T>(what, this.id, ...rest);
  }

  /** Send a request; return the fields of its reply, and when request and reply were exchanged. */
  call(signal: AbortSignal | undefined, ...request: Value[]): Promise<readonly Value[]> {
    return new Promise((done, failed) => {
      signal?.throwIfAborted();
      const step = this.step("call", ...request);
      const call = step[3]!;
      const giveUp = (): void => {
        this.callers.delete(call);
        failed(signal?.reason);
        this.advance("give up", call);
      };
      signal?.addEventListener("abort", giveUp);
      const ended = (): void => signal?.removeEventListener("abort", giveUp);
      this.callers.set(call, {
        done: (answer) => (ended(), done(answer)),
        failed: (error) => (ended(), failed(error)),
      });
      this.take(step);
    });
  }

  /** Wait for the next step, which may bring events, for at most `seconds`; return false if there was none. */
  arrival(seconds: number, signal: AbortSignal | undefined): Promise<boolean> {
    return new Promise((done, failed) => {
      signal?.throwIfAborted();
      const end = (settle: () => void) => (): void => {
        clearTimeout(timer);
        signal?.removeEventListener("abort", abort);
        settle();
      };
      const abort = end(() => failed(signal?.reason));
      const longest = Math.min(seconds * 1000, 2 ** 31 - 1);
      const timer = setTimeout(end(() => done(false)), longest);
      signal?.addEventListener("abort", abort);
      this.waiting.push(end(() => done(true)));
    });
  }

  /**
   * End every call, send what was written, and close the transport. Unsent requests are never sent.
   * `stops`: unless `onError` is "leave", also send a stop to each device that was set in motion.
   */
  async close(stops = false): Promise<void> {
    if (!this.open) return;
    const bytes = stops ? this.step<Uint8Array>("stops") : undefined;
    this.end("close");
    if (bytes?.length) await within(WRITE_SECONDS, this.transport.write(bytes)).catch(() => {});
    await this.transport.close();
  }

  private lose(detail: string): void {
    if (this.open) {
      this.end("lose", detail);
      this.transport.abort();
    }
  }

  private end(what: string, ...rest: Value[]): void {
    const step = this.step(what, ...rest);
    this.open = false;
    this.take(step);
    clearTimeout(this.timer);
  }

  private step<T = Step>(what: string, ...rest: Value[]): T {
    const at = performance.now();
    this.drained = at - this.emptyAt < EMPTY_MS;
    return this.ask<T>(what, nanoseconds(at), !this.writing, this.drained, ...rest);
  }

  private advance(what: string, ...rest: Value[]): void {
    if (this.open) this.take(this.step(what, ...rest));
  }

  private take([bytes, ended, idle]: Step): void {
    const written = bytes && this.write(bytes);
    for (const [call, good, answer] of ended) {
      const caller = this.callers.get(call);
      this.callers.delete(call);
      if (!good) caller?.failed(failure(answer));
      // The call of a one-way request ends when the transport has taken its bytes.
      else if (written && answer.length === 1) written.then(() => caller?.done(answer), caller?.failed);
      else caller?.done(answer);
    }
    for (const wake of this.waiting.splice(0)) wake();
    if (idle === 0 && !this.drained) this.turn();
    else this.schedule(idle);
  }

  /** Write bytes. Return `undefined` if the transport has taken them, else a promise of that. */
  private write(bytes: Uint8Array): Promise<void> | undefined {
    const pending = this.transport.write(bytes);
    if (!pending) return undefined;
    this.writing = true;
    let timer: ReturnType<typeof setTimeout> | undefined;
    const stuck = new Promise<never>((_, failed) => {
      const why = `the line took no bytes in ${this.writeSeconds.toFixed(3)} s`;
      timer = setTimeout(() => failed(new Error(why)), this.writeSeconds * 1000);
    });
    const written = Promise.race([pending, stuck]).then(
      () => {
        this.writing = false;
        this.advance("step");
      },
      (error: unknown) => {
        const detail = `cannot be written: ${reason(error)}`;
        this.lose(detail);
        throw new LinkError(`${this.transport.url}: ${detail}`);
      },
    );
    written.finally(() => clearTimeout(timer)).catch(() => {}); // the calls end with this error
    return written;
  }

  /** Make the next step after all arrived bytes are read; while a write is pending, its end makes it. */
  private turn(): void {
    if (!this.writing) this.read();
  }

  /** Make the next step after all arrived bytes are read. */
  private read(): void {
    if (this.reading) return;
    this.reading = true;
    const read = (): void => {
      this.reading = false;
      this.emptyAt = performance.now();
      this.advance("step");
    };
    if (this.transport.drained) this.transport.drained(() => afterTurn(read));
    else afterTurn(read);
  }

  private schedule(idle: number | undefined): void {
    const at = idle === undefined ? Infinity : performance.now() + idle / 1e6;
    // The running timer ends earlier; its step then sets the next timer.
    if (at >= this.wakesAt) return;
    clearTimeout(this.timer);
    this.wakesAt = at;
    this.timer = setTimeout(() => {
      this.wakesAt = Infinity;
      // A reply that arrived while the program was busy is read before its deadline is checked.
      this.read();
    }, at - performance.now());
  }
}
