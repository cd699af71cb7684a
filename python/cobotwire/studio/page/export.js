// Export what the filters of the line select.

import { byId, el } from "./dom.js";

export function wireExport(source) {
  byId("export").addEventListener("submit", (event) => {
    event.preventDefault();
    const query = new URLSearchParams(new FormData(byId("export")));
    query.set("command", byId("by-command").value);
    query.set("direction", byId("by-direction").value);
    keep(source.exported(query), (text) => (byId("export-status").textContent = text));
  });
}

// Save the body of a response as a file, and show the result or the error.
export async function keep(coming, say) {
  say("writing");
  try {
    const response = await coming;
    const named = /filename="([\w.-]+)"/.exec(response.headers.get("content-disposition"));
    const data = await response.blob();
    const address = URL.createObjectURL(data);
    el("a", { href: address, download: named?.[1] ?? "studio.bin" }).click();
    setTimeout(() => URL.revokeObjectURL(address), 10000);
    say(`${named?.[1]}, ${data.size} bytes`);
  } catch (error) {
    say(error.message);
  }
}
