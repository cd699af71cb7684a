"use strict";
// The page: decode the input whenever it changes, and keep it in the fragment of the address, so
// that a user can send it as a link.
(function () {
  const HERE = document.currentScript.src;
  const EXAMPLES = {
    "get_angles": "FE FE 02 20 FA FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA",
    "noise between": "FF FF 01 04 02 38 02 BE FE FE 03 12 01 FA 00 00",
    "a false header": "FE FE 0E 20 FE FE 03 12 01 FA FE FE 03 53 87 FA 00",
  };
  const FIRST_EDITION = "mycobot280"; // the edition of the current 280
  // The colours of the parts of a frame; a part without one is data.
  const KINDS = { header: "header", address: "header", LEN: "length", CMD: "command", check: "footer", footer: "footer" };

  // At first, at most this many events and this many bytes of each event are shown. Each click on "more" shows as
  // many again.
  const EVENTS = 200;
  const BYTES = 1024;
  // A longer input is not kept in the address, which browsers limit.
  const LONGEST_LINK = 16384;

  // The worker: it parses the input, cuts it into frames, decodes them, and sends the events in portions. It runs in a thread of
  // its own, so the page stays responsive however long the input is. The source of `Decoder` is put before this
  // function.
  function work() {
    let bytes, events, decoder;

    // Parse pasted text: pairs of hex digits with separators, 0x or \x before them, or Python's b'...'
    // around them. A single digit is a byte only after 0x; elsewhere half of a byte is missing.
    function parse(text) {
      const plain = text
        .replace(/\bb(?=['"])/gi, " ")
        .replace(/0x([0-9a-f])(?![0-9a-f])/gi, " 0$1 ")
        .replace(/\\x|0x/gi, " ")
        .replace(/[\s,;:|"'\[\](){}-]+/g, " ")
        .trim();
      const found = [];
      for (const word of plain ? plain.split(" ") : []) {
        const shown = word.length > 60 ? `${word.slice(0, 57)}...` : word;
        const wrong = !/^[0-9a-f]*$/i.test(word) ? "is not hex" : word.length % 2 ? "has an odd number of digits" : "";
        if (wrong) throw new Error(`Not hex, after ${found.length} byte${found.length === 1 ? "" : "s"}: "${shown}" ${wrong}`);
        for (let at = 0; at < word.length; at += 2) found.push(parseInt(word.slice(at, at + 2), 16));
      }
      return Uint8Array.from(found);
    }

    // Return an event as the page shows it, with the first bytes of long noise.
    function shown({ offset, data, noise }, limit) {
      if (noise) return { offset, noise, why: REASONS[noise], size: data.length, data: data.slice(0, limit) };
      return { offset, data, message: decoder.read(data) };
    }

    async function answer({ text, table, direction, first, count, limit, from, size }) {
      if (from !== undefined) return { data: bytes.slice(from, from + size) };
      if (text !== undefined) {
        bytes = parse(text);
        decoder = await Decoder.load(table, direction);
        events = [...decoder.feed(bytes), ...decoder.flush()];
      }
      const portion = events.slice(first, first + count).map((event) => shown(event, limit));
      const frames = events.reduce((sum, event) => sum + (event.noise ? 0 : 1), 0);
      const lost = events.reduce((sum, event) => sum + (event.noise ? event.data.length : 0), 0);
      return { first, portion, counts: { bytes: bytes.length, events: events.length, frames, lost } };
    }

    onmessage = async ({ data: { job, ...request } }) => {
      try {
        postMessage({ job, ...(await answer(request)) });
      } catch ({ message }) {
        postMessage({ job, problem: message });
      }
    };
  }

  // A page that is opened as a file may not load another file into a worker.
  const SOURCE = URL.createObjectURL(
    new Blob([cobotwire.module, `(${work})();`], { type: "text/javascript" }));
  // The worker, the number of the newest job, and whether its answer is outstanding.
  let worker = null;
  let job = 0;
  let busy = false;

  // Give the worker a job. A worker that is still busy with an outdated input is terminated.
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
    output.setAttribute("aria-busy", "true");
    const mine = (shows += 1);
    job += 1; // answers about earlier input are outdated
    load(edition.value, (table) => {
      if (mine === shows) decode(root, { table, direction: direction.value, text: text.value });
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

  function decode(root, request) {
    const { output } = parts(root);
    ask(root, { ...request, first: 0, count: EVENTS }, (answer) => {
      if (answer.problem) {
        output.replaceChildren(element("p", { class: "problem", role: "alert" }, `${answer.problem}.`));
        return;
      }
      output.replaceChildren(summary(answer.counts));
      append(root, answer);
    });
  }

  // Show a portion of the events, and a button for the next one.
  function append(root, { first, portion, counts }) {
    const { output } = parts(root);
    output.append(...portion.map((event) => (event.noise ? noise(root, event) : frame(event))));
    const next = first + portion.length;
    if (next === counts.events) return;
    output.append(more(`${next} of ${counts.events} are shown: more`, (button) => {
      ask(root, { first: next, count: EVENTS }, (answer) => {
        button.remove();
        append(root, answer);
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

  function noise(root, event) {
    const shown = chips(event.data, () => "noise");
    const card = element("section", { class: "event noise" },
      element("h3", {}, `noise at ${event.offset}: ${event.noise}`),
      element("p", {}, `${event.why}.`),
      shown);
    if (event.data.length < event.size) card.append(moreBytes(root, event, shown));
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

  function frame({ offset, data, message }) {
    if (message.text) {
      return element("section", { class: "event rejected" },
        element("h3", {}, `frame at ${offset}: rejected`),
        element("p", {}, `${message.text}.`),
        chips(data, (at) => (at === message.offset ? "wrong" : "data")));
    }
    const kindOf = (at) => KINDS[message.parts.find((part) => at < part.at + part.size).name] || "data";
    const card = element("section", { class: "event frame" },
      element("h3", {}, `${message.kind} at ${offset}: `, element("code", {}, message.command)),
      chips(data, kindOf),
      table(message.parts, data));
    if (message.others.length) {
      const names = message.others.map((other) => `${other.command} (${other.kind})`);
      card.append(element("p", { class: "other" }, `The same bytes can be ${names.join(" or ")}.`));
    }
    return card;
  }

  function hex(bytes) {
    return Array.from(bytes, (byte) => byte.toString(16).toUpperCase().padStart(2, "0")).join(" ");
  }

  function chips(data, kindOf) {
    return element("p", { class: "bytes" }, ...Array.from(data, (byte, at) =>
      element("span", { class: `byte ${kindOf(at)}` }, hex([byte]))));
  }

  function table(parts, data) {
    const cells = parts.map(({ at, size, name, raw = "", meaning }) => (
      [at, element("code", {}, hex(data.subarray(at, at + size))), name, raw, meaning]));
    const body = cells.map((row) => element("tr", {}, ...row.map((cell) => element("td", {}, cell))));
    const head = element("tr", {}, ...["byte", "hex", "content", "raw", "meaning"].map((name) =>
      element("th", { scope: "col" }, name)));
    return element("div", { class: "scroll" }, element("table", {}, element("thead", {}, head), element("tbody", {}, ...body)));
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
    if (!cobotwire.module) {
      root.append("This copy of the site was built without Node, so it cannot decode. Use the command cobotwire decode.");
      return;
    }
    build(root);
    restore(root);
    root.addEventListener("input", () => changed(root));
    window.addEventListener("hashchange", () => restore(root));
  });
})();
