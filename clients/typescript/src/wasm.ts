/** The bytes of the session in WebAssembly, and the module with what only Node has. */

const NODE = "./node.js";

/** Whether the program runs in Node. Its module has no constant name, so that no bundler follows it. */
export const inNode = typeof globalThis.process === "object" && !!process.versions?.node;

/** Return the module with what only Node has. */
export async function node(): Promise<typeof import("./node.js")> {
  return (await import(NODE)) as typeof import("./node.js");
}

/** Return the bytes of the session. */
export async function wasm(): Promise<BufferSource> {
  const url = new URL("./cobotwire.wasm", import.meta.url);
  if (inNode) return (await (await node()).read(url)) as BufferSource;
  return (await fetch(url)).arrayBuffer();
}
