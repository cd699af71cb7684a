/** The errors: a class for each party that can be at fault. Their texts are those of the Python client. */
import type { Value } from "./machine.js";

/** The base class of every error of cobotwire. */
export class CobotwireError extends Error {
  override get name(): string {
    return this.constructor.name;
  }
}

/** An error of the caller, detected before a byte was sent. */
export class UsageError extends CobotwireError {}

/** An error of the peer: bytes that the protocol does not allow. */
export class ProtocolError extends CobotwireError {
  /** The rejected bytes. */
  readonly data: Uint8Array;

  constructor(message: string, data: Uint8Array = new Uint8Array()) {
    super(message);
    this.data = data;
  }
}

/** The device replied that it does not carry out a request. */
export class RequestRefused extends ProtocolError {}

/** An error of the transport: it could not be opened, or it disappeared. */
export class LinkError extends CobotwireError {
  /** How many bytes of the request were written; `undefined`: that is not known. */
  readonly written: number | undefined;

  constructor(message: string, written?: number) {
    super(message);
    this.written = written;
  }
}

/** The reply, or the requested acknowledgement, did not arrive in time. */
export class ReplyTimeout extends CobotwireError {
  /** Seconds since the request was sent, or since the call began if its deadline passed. */
  readonly waited: number;
  /** How often the request was sent; 0: it was not sent, and never will be. */
  readonly attempts: number;
  /** What the call waited for when its deadline passed: `turn`, `hold`, `line` or `reply`. */
  readonly waitedFor: string;

  constructor(message: string, waited: number, attempts: number, waitedFor: string) {
    super(message);
    this.waited = waited;
    this.attempts = attempts;
    this.waitedFor = waitedFor;
  }
}

/** Return the error that the session reports: its class, its text, and the values of that class. */
export function failure([name, text, ...rest]: readonly Value[]): CobotwireError {
  const message = text as string;
  switch (name) {
    case "LinkError":
      return new LinkError(message, rest[0] as number | undefined);
    case "ReplyTimeout":
      return new ReplyTimeout(message, rest[0] as number, rest[1] as number, rest[2] as string);
    case "ProtocolError":
      return new ProtocolError(message, rest[0] as Uint8Array);
    case "RequestRefused":
      return new RequestRefused(message);
    default:
      return new UsageError(message);
  }
}
