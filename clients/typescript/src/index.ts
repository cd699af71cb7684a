/** The package: clients of editions are in modules of their own, such as `cobotwire/mycobot280`. */
export { Client, EventStream, Stream, describe } from "./client.js";
export type { Options, Port, Sample } from "./client.js";
export * from "./decoder.js";
export * from "./errors.js";
export type { Value } from "./machine.js";
export type { Transport, WebSerialPort } from "./transport.js";
