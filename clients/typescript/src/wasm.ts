/** Loads the WebAssembly file of the session, and the module with what only Node has. */

// No string literal in `import()`, so that bundlers for browsers do not include the module.
const NODE = "./node.js";

/** Whether the program runs in Node. */
export const inNode = typeof globalThis.process === "object" && !!process.versions?.node;

/** Return the module with what only Node has. */
export async function node(): Promise<typeof import("./node.js")> {
  return (await import(NODE)) as typeof import("./node.js");
}

/** Return the WebAssembly file of the session. */
export async function wasm(): Promise<BufferSource> {
  const url = new URL("./cobotwire.wasm", import.meta.url);
  if (inNode) return (await (await node()).read(url)) as BufferSource;
  return (await fetch(url)).arrayBuffer();
}
