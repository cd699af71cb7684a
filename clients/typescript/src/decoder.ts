/** The decoder: frames of a stream, the noise between them, and what each byte of a frame means. */
import { edition, machine, objectOf, type Machine, type Value } from "./machine.js";

/** Which frames a stream has: those to the arm, those from it, or both. */
export type Listening = "request" | "reply" | "both";

/** Why bytes are not a frame, in words. */
export const REASONS = {
  "no-header": "no frame starts here",
  "bad-address": "a header with an address that the edition lacks",
  "bad-length": "a header with a LEN that is not legal for its id",
  "unknown-id": "a header with an id that the edition lacks",
  "bad-check": "starts like a frame, but does not end like one",
  truncated: "starts like a frame; the bytes end before it does",
} as const;
export type Reason = keyof typeof REASONS;

/** A frame, or noise. */
export interface Found {
  /** Where it starts in the stream. */
  offset: number;
  data: Uint8Array;
  /** Why the bytes are not a frame; `undefined`: they are one. */
  noise: Reason | undefined;
}

/** Adjacent bytes of a frame. If bit fields share bytes, `size` is 0 for all of them but the last. */
export interface Part {
  at: number;
  size: number;
  name: string;
  /** The value with its unit or label. */
  meaning: string;
  /** The raw value of a number. */
  raw: number | bigint | undefined;
}

/** A decoded frame. */
export interface Message {
  command: string;
  kind: "request" | "reply" | "event";
  /** The values, in the units of the edition. */
  fields: Record<string, Value>;
  /** The parts of the frame, in order; together they cover every byte. */
  parts: Part[];
  /** Other messages that have the same bytes. */
  others: { command: string; kind: Message["kind"] }[];
}

/** Why the table does not allow a frame, and at which of its bytes. */
export interface Rejection {
  reason: Reason | "trailing" | "bad-value";
  offset: number;
  text: string;
}

type Row = [
  fields: Value[],
  parts: [number, number, string, string, Part["raw"]][],
  readings: [string, Message["kind"]][],
];

export class Decoder {
  private rest = new Uint8Array();
  private offset = 0;

  private constructor(
    private readonly machine: Machine,
    private readonly edition: number,
    private readonly listening: Listening,
  ) {}

  /** Return a decoder for a new stream. The module of an edition exports its `table`. */
  static async load(table: string, listening: Listening = "both"): Promise<Decoder> {
    const session = await machine();
    return new Decoder(session, edition(session, table)[0], listening);
  }

  /** Take bytes; return the frames and the noise that more bytes cannot change. Noise may be in pieces. */
  feed(data: Uint8Array): Found[] {
    const all = new Uint8Array(this.rest.length + data.length);
    all.set(this.rest);
    all.set(data, this.rest.length);
    return this.cut(all);
  }

  /** The bytes that may still become a frame. */
  get pending(): Uint8Array {
    return this.rest;
  }

  /** End the wait for more bytes: an incomplete frame becomes noise. */
  flush(): Found[] {
    return this.cut(this.rest, undefined);
  }

  /** Decode a frame; return its message, or why the table rejects it. */
  read(frame: Uint8Array): Message | Rejection {
    const row = this.machine.ask<Row | [Rejection["reason"], number, string]>(
      ...["decode", this.edition, this.listening, frame, undefined],
    );
    if (typeof row[0] === "string") return { reason: row[0], offset: row[1] as number, text: row[2] as string };
    const [fields, parts, readings] = row as Row;
    const [first, ...others] = readings.map(([command, kind]) => ({ command, kind }));
    return {
      ...first!,
      fields: objectOf(fields),
      parts: parts.map(([at, size, name, meaning, raw]) => ({ at, size, name, meaning, raw })),
      others,
    };
  }

  private cut(data: Uint8Array, ...silence: undefined[]): Found[] {
    const chunks = this.machine.ask<[Uint8Array, number, Reason | undefined][][]>(
      ...["frames", this.edition, this.listening, data, ...silence],
    );
    const found = chunks.flat().map(([data, offset, noise]) => ({ offset: this.offset + offset, data, noise }));
    const last = found.at(-1);
    const end = last ? last.offset + last.data.length - this.offset : 0;
    this.rest = data.slice(end);
    this.offset += end;
    return found;
  }
}
