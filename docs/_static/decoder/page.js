"use strict";
// The page: decode the input whenever it changes, and keep it in the fragment of the address, so
// that a user can send it as a link.
(function () {
  const REASONS = {
    "no-header": "no frame starts here",
    "bad-address": "a header with an address that the edition lacks",
    "bad-length": "a header with a LEN that is not legal for its id",
    "unknown-id": "a header with an id that the edition lacks",
    "bad-check": "starts like a frame, but does not end like one",
    truncated: "starts like a frame; the bytes end before it does",
  };
  const EXAMPLES = {
    "get_angles": "FE FE 02 20 FA FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA",
    "noise between": "FF FF 01 04 02 38 02 BE FE FE 03 12 01 FA 00 00",
    "a false header": "FE FE 0E 20 FE FE 03 12 01 FA FE FE 03 53 87 FA 00",
  };
  const UNITS = { degree: "°", degree_celsius: " °C", millimetre: " mm", percent: " %", volt: " V",
    milliampere: " mA", hertz: " Hz", step_per_second: " steps/s", tick: " ticks" };

  function counted(number, noun) {
    return `${number} ${noun}${number === 1 ? "" : "s"}`;
  }

  function element(name, attributes, ...children) {
    const made = document.createElement(name);
    for (const [key, value] of Object.entries(attributes || {})) made.setAttribute(key, value);
    made.append(...children);
    return made;
  }

  function show(root) {
    const { text, edition, direction, output } = parts(root);
    output.replaceChildren();
    let bytes;
    try {
      bytes = cobotwire.parse(text.value);
    } catch (error) {
      output.append(element("p", { class: "problem", role: "alert" },
        `Not hex, after ${counted(error.offset, "byte")}: ${error.message}.`));
      return;
    }
    const directions = direction.value === "both" ? ["request", "reply"] : [direction.value];
    const law = new cobotwire.Law(cobotwire.tables[edition.value], directions);
    const events = law.cut(bytes);
    output.append(summary(bytes, events));
    for (const event of events) {
      const data = bytes.subarray(event.offset, event.offset + event.size);
      output.append("noise" in event ? noise(event, data) : frame(law, event, data));
    }
  }

  function summary(bytes, events) {
    const frames = events.filter((event) => !("noise" in event)).length;
    const lost = events.reduce((sum, event) => sum + ("noise" in event ? event.size : 0), 0);
    return element("p", { class: "summary" },
      `${counted(bytes.length, "byte")}: ${counted(frames, "frame")}, ${counted(lost, "byte")} of noise`);
  }

  function noise(event, data) {
    return element("section", { class: "event noise" },
      element("h3", {}, `noise at ${event.offset}: ${event.noise}`),
      element("p", {}, `${REASONS[event.noise]}.`),
      chips(data, () => "noise"));
  }

  function frame(law, event, data) {
    let readings;
    try {
      readings = law.read(data);
    } catch (error) {
      return element("section", { class: "event rejected" },
        element("h3", {}, `frame at ${event.offset}: rejected`),
        element("p", {}, `${error.message} (byte ${error.offset}).`),
        chips(data, (at) => (at === error.offset ? "wrong" : "data")));
    }
    const [reading, ...others] = readings;
    const kinds = roles(law, reading, data);
    const card = element("section", { class: "event frame" },
      element("h3", {}, `${reading.direction} at ${event.offset}: `,
        element("code", {}, reading.command.name)),
      element("p", {}, `${reading.command.title}.`),
      chips(data, (at) => kinds[at].kind),
      rows(kinds, data));
    if (others.length) {
      const names = others.map((other) => `${other.command.name} (${other.direction})`);
      card.append(element("p", { class: "other" }, `The same bytes can be ${names.join(" or ")}.`));
    }
    return card;
  }

  // Return, for each byte of a frame, the part of the frame that it belongs to.
  function roles(law, reading, data) {
    const end = data.length - law.checkSize;
    const found = Array.from(data, (byte, at) => {
      if (at < law.frame.header.length) return { kind: "header", name: "header", start: 0, meaning: "a frame starts here" };
      if (at < law.at) return { kind: "header", name: "address", start: at, meaning: `${byte}` };
      if (at === law.at) return { kind: "length", name: "LEN", start: at, meaning: `${byte} bytes follow` };
      if (at === law.at + 1) return { kind: "command", name: "CMD", start: at, meaning: reading.command.name };
      return { kind: "footer", name: law.frame.check === "footer" ? "footer" : "check", start: end, meaning: "the frame ends here" };
    });
    reading.fields.forEach(({ field, numbers }) => {
      numbers.forEach(({ number, offset, raw, value }) => {
        const name = number.name ? `${field.name}.${number.name}` : field.name;
        const role = { kind: "data", name, start: offset, meaning: format(field, number, raw, value) };
        for (let at = offset; at < offset + number.width; at += 1) found[at] = role;
      });
    });
    return found;
  }

  function format(field, number, raw, value) {
    if (field.kind === "flag") return raw ? "yes" : "no";
    const label = field.labels[field.choices.indexOf(raw)];
    if (field.kind === "enum" && label) return `${label} (${raw})`;
    const unit = UNITS[number.unit] || (number.unit && ` ${number.unit}`);
    const scaled = number.multiply === number.divide ? "" : `  (raw ${raw})`;
    return `${value}${unit}${scaled}`;
  }

  function chips(data, kindOf) {
    return element("p", { class: "bytes" }, ...Array.from(data, (byte, at) =>
      element("span", { class: `byte ${kindOf(at)}` }, cobotwire.hex([byte]))));
  }

  function rows(kinds, data) {
    const body = element("tbody");
    kinds.forEach((role, at) => {
      if (at && kinds[at - 1] === role) return;
      if (at && role.kind === "header" && kinds[at - 1].name === role.name) return;
      if (at && role.kind === "footer" && kinds[at - 1].name === role.name) return;
      let end = at + 1;
      while (end < data.length && kinds[end].name === role.name && kinds[end].start === role.start) end += 1;
      body.append(element("tr", {},
        element("td", {}, String(at)),
        element("td", {}, element("code", {}, cobotwire.hex(data.subarray(at, end)))),
        element("td", {}, role.name),
        element("td", {}, role.meaning)));
    });
    const head = element("tr", {}, ...["byte", "hex", "content", "meaning"].map((name) =>
      element("th", { scope: "col" }, name)));
    return element("div", { class: "scroll" }, element("table", {}, element("thead", {}, head), body));
  }

  function parts(root) {
    const find = (name) => root.querySelector(`[name=${name}]`);
    return { text: find("hex"), edition: find("edition"), direction: find("direction"),
      output: root.querySelector(".output") };
  }

  function build(root) {
    const editions = Object.keys(cobotwire.tables).sort();
    const option = (value, text) => element("option", { value }, text || value);
    root.append(
      element("label", { for: "decoder-hex" }, "Bytes in hex, as your log shows them"),
      element("textarea", { id: "decoder-hex", name: "hex", rows: "4", spellcheck: "false", autocapitalize: "off" }),
      element("div", { class: "choices" },
        element("label", {}, "Edition ", element("select", { name: "edition" },
          ...editions.map((name) => option(name)))),
        element("label", {}, "Direction ", element("select", { name: "direction" },
          option("both", "either"), option("request", "to the arm"), option("reply", "from the arm")))),
      element("p", { class: "examples" }, "Try: ", ...Object.entries(EXAMPLES).map(([name, hex]) => {
        const button = element("button", { type: "button" }, name);
        button.addEventListener("click", () => { parts(root).text.value = hex; changed(root); });
        return button;
      })),
      element("div", { class: "output", "aria-live": "polite" }));
  }

  function changed(root) {
    const { text, edition, direction } = parts(root);
    const state = new URLSearchParams({ edition: edition.value, direction: direction.value, hex: text.value.trim() });
    history.replaceState(null, "", `#${state}`);
    show(root);
  }

  function restore(root) {
    const state = new URLSearchParams(location.hash.slice(1));
    const { text, edition, direction } = parts(root);
    text.value = state.get("hex") || EXAMPLES["get_angles"];
    if (state.get("edition") in cobotwire.tables) edition.value = state.get("edition");
    if (["both", "request", "reply"].includes(state.get("direction"))) direction.value = state.get("direction");
    show(root);
  }

  document.addEventListener("DOMContentLoaded", () => {
    const root = document.getElementById("decoder");
    if (!root) return;
    build(root);
    restore(root);
    root.addEventListener("input", () => changed(root));
    window.addEventListener("hashchange", () => restore(root));
  });
})();
