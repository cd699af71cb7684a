// Explain a frame or noise byte by byte.

import { byId, clock, el } from "./dom.js";

export class Details {
  constructor(source) {
    this.source = source;
    this.place = byId("details");
    this.wanted = null;
  }

  async show(number) {
    this.wanted = number;
    try {
      const found = await this.source.explain(number);
      // A later request may have been answered first.
      if (this.wanted === number) this.place.replaceChildren(...explanation(found));
    } catch (error) {
      if (this.wanted === number) this.place.replaceChildren(el("p", {}, error.message));
    }
  }
}

// Return elements that explain an entry, or a request before it is sent.
export function explanation(found, heading = true) {
  const made = [];
  const { command } = found;
  if (heading) made.push(el("h3", {}, title(found)));
  if (found.parts) made.push(strip(found.parts), table(found.parts));
  else if (found.hex) made.push(el("p", { class: "hex" }, found.hex));
  if (found.text) made.push(el("p", {}, found.text));
  if (found.noise) made.push(...noise(found));
  if (command && heading) made.push(...description(command));
  return made;
}

function title(found) {
  const when = clock(found.time, 6);
  const what = found.command?.title ?? (found.noise ? `Noise: ${found.noise}` : "Remark");
  return found.hex ? `${what}, ${found.direction} at ${when}` : `${what} at ${when}`;
}

// The bytes side by side, each part in the colour of its row in the table.
function strip(parts) {
  const cells = parts
    .filter((part) => part.hex)
    .map((part, index) => el("span", { class: `byte tint-${index % 6}`, title: part.name }, part.hex));
  return el("p", { class: "strip", "aria-hidden": "true" }, ...cells);
}

function table(parts) {
  let index = -1;
  const rows = parts.map((part) => {
    if (part.hex) index += 1;
    return el(
      "tr",
      {},
      el("td", {}, String(part.at)),
      el("td", { class: "hex" }, el("span", { class: `byte tint-${index % 6}` }, part.hex || "same")),
      el("td", {}, part.name),
      el("td", { class: "number" }, part.raw ?? ""),
      el("td", {}, part.meaning),
    );
  });
  const names = ["at", "bytes", "part", "raw", "meaning"];
  const head = el("tr", {}, ...names.map((name) => el("th", { scope: "col" }, name)));
  return el("table", {}, el("thead", {}, head), el("tbody", {}, ...rows));
}

function noise(found) {
  const facts = Object.entries(found.facts).flatMap(([name, value]) => [
    el("dt", {}, name.replaceAll("_", " ")),
    el("dd", {}, value),
  ]);
  return [
    el("dl", {}, el("dt", {}, "reason"), el("dd", {}, found.reason), ...facts),
    el("p", { class: "hint" }, `What to do: ${found.advice}.`),
  ];
}

function description(command) {
  const made = [el("p", {}, `${command.doc} `, el("em", {}, `(${command.name}, ${command.safety})`))];
  for (const note of command.notes) made.push(el("p", { class: "hint" }, note));
  if (command.place) {
    const lines = (command.lines ?? []).map(([from, to]) => (from === to ? from : `${from}–${to}`));
    const document = lines.length ? `; document, lines ${lines.join(", ")}` : "";
    made.push(el("p", { class: "hint" }, `Specified in ${command.place}${document}.`));
  }
  for (const erratum of command.errata ?? []) {
    const text = `Erratum: the document says “${erratum.says}”, read as “${erratum.read}”: ${erratum.why}.`;
    made.push(el("p", { class: "erratum" }, text));
  }
  return made;
}
