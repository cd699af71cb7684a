"use strict";
// The page: decode the input whenever it changes, and keep it in the fragment of the address, so
// that a user can send it as a link.
(function () {
  const HERE = document.currentScript.src;
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
  const FIRST_EDITION = "mycobot280"; // that of today's arm
  const UNITS = { degree: "°", degree_celsius: " °C", millimetre: " mm", percent: " %", volt: " V",
    milliampere: " mA", hertz: " Hz", step_per_second: " steps/s", tick: " ticks" };

  // The number of events of a long input that are shown at first, and of bytes of each event; "more" shows as many
  // again.
  const EVENTS = 200;
  const BYTES = 1024;
  // A longer input is not kept in the address, which browsers limit.
  const LONGEST_LINK = 16384;

  // The worker: it parses and cuts, and sends the events in portions. It runs beside the page, which
  // answers meanwhile, however long the input is.
  function work() {
    let bytes, events;
    function send(job, first, count, limit) {
      const portion = events.slice(first, first + count).map((event) => (
        { ...event, data: bytes.slice(event.offset, event.offset + Math.min(event.size, limit)) }));
      const frames = events.reduce((sum, event) => sum + ("noise" in event ? 0 : 1), 0);
      const lost = events.reduce((sum, event) => sum + ("noise" in event ? event.size : 0), 0);
      postMessage({ job, first, portion, counts: { bytes: bytes.length, events: events.length, frames, lost } });
    }
    onmessage = ({ data: { job, text, table, directions, first, count, limit, from, size } }) => {
      if (from !== undefined) {
        postMessage({ job, data: bytes.slice(from, from + size) });
        return;
      }
      try {
        if (text !== undefined) {
          bytes = cobotwire.parse(text);
          events = new cobotwire.Law(table, directions).cut(bytes);
        }
      } catch (error) {
        postMessage({ job, problem: { offset: error.offset, message: error.message } });
        return;
      }
      send(job, first, count, limit);
    };
  }

  const SOURCE = URL.createObjectURL(
    new Blob([cobotwire.source, `(${work})();`], { type: "text/javascript" }));
  // The worker, the number of the newest job, and whether its answer is outstanding.
  let worker = null;
  let job = 0;
  let busy = false;

  // Have the worker do a job. One that is at work on an outdated input is ended.
  function ask(root, request, answered) {
    if (worker === null || (busy && request.text !== undefined)) {
      if (worker !== null) worker.terminate();
      worker = new Worker(SOURCE);
    }
    job += 1;
    busy = true;
    const output = parts(root).output;
    output.setAttribute("aria-busy", "true");
    worker.onmessage = ({ data }) => {
      if (data.job !== job) return;
      busy = false;
      answered(data);
      output.removeAttribute("aria-busy");
    };
    worker.postMessage({ job, limit: BYTES, ...request });
  }

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
    const directions = direction.value === "both" ? ["request", "reply"] : [direction.value];
    output.setAttribute("aria-busy", "true");
    const mine = (shows += 1);
    job += 1; // an answer about the input before comes too late
    load(edition.value, (table) => {
      if (mine === shows) decode(root, table, directions, text.value);
    });
  }

  // The number of the newest input.
  let shows = 0;

  // Give an edition's table to `use`; its script is loaded when it is first needed.
  function load(name, use) {
    if (name in cobotwire.tables) {
      use(cobotwire.tables[name]);
      return;
    }
    const script = element("script", { src: new URL(`editions/${name}.js`, HERE).href });
    script.addEventListener("load", () => use(cobotwire.tables[name]));
    document.head.append(script);
  }

  function decode(root, table, directions, text) {
    const { output } = parts(root);
    const law = new cobotwire.Law(table, directions);
    ask(root, { text, table, directions, first: 0, count: EVENTS }, (answer) => {
      if (answer.problem) {
        const { offset, message } = answer.problem;
        output.replaceChildren(element("p", { class: "problem", role: "alert" },
          `Not hex, after ${counted(offset, "byte")}: ${message}.`));
        return;
      }
      output.replaceChildren(summary(answer.counts));
      append(root, law, answer);
    });
  }

  // Show a portion of the events, and a button for the next one.
  function append(root, law, { first, portion, counts }) {
    const { output } = parts(root);
    output.append(...portion.map((event) => (
      "noise" in event ? noise(root, event, event.data) : frame(law, event, event.data))));
    const next = first + portion.length;
    if (next === counts.events) return;
    output.append(more(`${next} of ${counts.events} are shown: more`, (button) => {
      ask(root, { first: next, count: EVENTS }, (answer) => {
        button.remove();
        append(root, law, answer);
      });
    }));
  }

  function more(text, act) {
    const button = element("button", { type: "button", class: "more" }, text);
    button.addEventListener("click", () => act(button));
    return button;
  }

  function summary({ bytes, frames, lost }) {
    return element("p", { class: "summary" },
      `${counted(bytes, "byte")}: ${counted(frames, "frame")}, ${counted(lost, "byte")} of noise`);
  }

  function noise(root, event, data) {
    const shown = chips(data, () => "noise");
    const card = element("section", { class: "event noise" },
      element("h3", {}, `noise at ${event.offset}: ${event.noise}`),
      element("p", {}, `${REASONS[event.noise]}.`),
      shown);
    if (data.length < event.size) card.append(moreBytes(root, event, shown));
    return card;
  }

  function moreBytes(root, event, shown) {
    const label = () => `${shown.children.length} of ${counted(event.size, "byte")} are shown: more`;
    return more(label(), (button) => {
      const from = event.offset + shown.children.length;
      const size = Math.min(BYTES, event.size - shown.children.length);
      ask(root, { from, size }, ({ data }) => {
        shown.append(...chips(data, () => "noise").children);
        if (shown.children.length === event.size) button.remove();
        else button.textContent = label();
      });
    });
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
      element("h3", {}, `${reading.command.event ? "event" : reading.direction} at ${event.offset}: `,
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
    const { header, layout, parts, check, footer } = law.frame;
    const end = data.length - footer.length;
    const checked = { kind: "footer", name: "check", start: end, meaning: check && check.word };
    const found = Array.from(data, (byte, at) => (at < header.length ? HEADER : at < end ? checked : FOOTER));
    for (const part of layout) {
      // A reply without an id has data in its place.
      if (parts[part].at >= law.frame.data_at[reading.direction]) continue;
      const { at, width, order } = parts[part];
      const number = cobotwire.unsigned(data, at, width, order);
      fill(found, at, width, { start: at, ...PART_ROLES[part](number, data.length - at - width, reading) });
    }
    for (const field of reading.fields) for (const role of fieldRoles(field)) fill(found, role.start, role.width, role);
    return found;
  }

  const HEADER = { kind: "header", name: "header", start: 0, meaning: "a frame starts here" };
  const FOOTER = { kind: "footer", name: "footer", start: 0, meaning: "the frame ends here" };
  const PART_ROLES = {
    address: (number) => ({ kind: "header", name: "address", meaning: `${number}` }),
    length: (number, rest) => ({ kind: "length", name: "LEN", meaning: number === rest ? `${number} bytes follow` : `${number}` }),
    command: (number, rest, reading) => ({ kind: "command", name: "CMD", meaning: reading.command.name }),
  };

  function fill(found, start, width, role) {
    for (let at = start; at < start + width; at += 1) found[at] = role;
  }

  // Return a role for each number of a field; bytes have one for all, so has each text, and each word
  // of bits.
  function fieldRoles({ field, numbers, text }) {
    const unit = field.kind === "text" && field.repeat > 1 ? field.repeat : numbers.length;
    if (field.kind === "text" && numbers.length) {
      return text.map((each, index) => dataRole(
        text.length > 1 || field.repeat > 1 ? `${field.name}[${index}]` : field.name,
        numbers[index * unit].offset, unit, JSON.stringify(each)));
    }
    if (field.kind === "bytes" && numbers.length) {
      const noun = `${numbers.length} byte${numbers.length === 1 ? "" : "s"}`;
      return [dataRole(field.name, numbers[0].offset, numbers.length, noun)];
    }
    const each = field.cases[0].numbers.length;
    const found = [];
    numbers.forEach((read, place) => {
      const { number, offset } = read;
      const element = field.least === undefined ? field.name : `${field.name}[${Math.floor(place / each)}]`;
      const name = number.name ? `${element}.${number.name}` : element;
      const meaning = format(field, read);
      const last = found[found.length - 1];
      if (!number.bits) found.push(dataRole(name, offset, number.width, meaning));
      else if (last && last.start === offset) last.meaning += `, ${number.name}: ${meaning}`;
      else found.push(dataRole(element, offset, number.width, `${number.name}: ${meaning}`));
    });
    return found;
  }

  function dataRole(name, start, width, meaning) {
    return { kind: "data", name, start, width, meaning };
  }

  function format(field, { number, raw, value }) {
    // A part of a word has a kind of its own.
    const { kind, choices, labels } = number.bits ? number : field;
    if (kind === "flag") return raw ? "yes" : "no";
    const label = labels[choices.indexOf(raw)];
    if (kind === "enum" && label) return `${label} (${raw})`;
    const unit = UNITS[number.unit] || (number.unit && ` ${number.unit}`);
    const scaled = number.multiply === number.divide ? "" : `  (raw ${raw})`;
    return `${number.width === 4 && number.encoding === "float" ? shortest(value) : value}${unit}${scaled}`;
  }

  // Return the shortest decimal of a float of four bytes.
  function shortest(value) {
    for (let digits = 1; digits < 9; digits += 1) {
      const rounded = Number(value.toPrecision(digits));
      if (Math.fround(rounded) === value) return rounded;
    }
    return value;
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
    const editions = [...new Set([...cobotwire.editions, ...Object.keys(cobotwire.tables)])].sort();
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
    const state = new URLSearchParams({ edition: edition.value, direction: direction.value });
    if (text.value.length <= LONGEST_LINK) state.set("hex", text.value.trim());
    history.replaceState(null, "", `#${state}`);
    show(root);
  }

  function restore(root) {
    const state = new URLSearchParams(location.hash.slice(1));
    const { text, edition, direction } = parts(root);
    edition.value = FIRST_EDITION;
    text.value = state.get("hex") || EXAMPLES["get_angles"];
    if ([...edition.options].some(({ value }) => value === state.get("edition"))) edition.value = state.get("edition");
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
