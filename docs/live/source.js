// Talk to the worker that holds the arm or a recording, and let the user choose which.

import { byId, el } from "./dom.js";
import { keep } from "./export.js";

const NO_SERIAL =
  "This browser cannot open a serial port, because it lacks WebSerial. Chrome and Edge on a computer have it. Recordings can be opened here, too.";
// How long a page that is left waits for its worker, which ends with the page.
const LEAVE_MS = 100;

export class Source {
  // `onBatch` gets each batch of news.
  constructor(onBatch) {
    Object.assign(this, { page: "", onBatch, asked: new Map(), count: 0, connected: false });
    this.worker = new Worker("worker.js", { type: "module" });
    this.worker.onmessage = ({ data }) => this.take(data);
    this.worker.onerror = () => this.say("This browser is too old for the page: its worker does not start.", true);
    byId("source").textContent = "an arm in the browser";
    byId("status").textContent = "not connected";
    byId("stop").disabled = byId("control").disabled = true;
    for (const option of document.querySelectorAll("#export [value=parquet], #export [value=csv]")) option.remove();
    document.querySelector("main").hidden = true;
    document.querySelector("main").before(this.panel());
    this.choices();
    for (const event of ["beforeunload", "pagehide"]) window.addEventListener(event, () => this.leave());
    document.addEventListener("dragover", (event) => event.preventDefault());
    document.addEventListener("drop", (event) => {
      event.preventDefault();
      this.open(event.dataTransfer.files[0]);
    });
    navigator.serviceWorker?.register("service.js").catch(() => {});
  }

  panel() {
    const button = (id, text, click) => (this[id] = el("button", { id, type: "button", click }, text));
    this.edition = el("select", { id: "edition" });
    this.speed = el("input", { id: "highest-speed", type: "number", min: 1, max: 100, value: 30 });
    this.file = el("input", { id: "capture", type: "file", accept: ".pcapng", change: () => this.open(this.file.files[0]) });
    this.said = el("p", { id: "said", role: "status" });
    const edition = el("label", {}, "Robot ", this.edition);
    const arm = [el("label", {}, "Highest speed ", this.speed, " %"), button("connect", "Connect", () => this.choose())];
    this.first = el("div", { class: "filters" }, edition, ...("serial" in navigator ? arm : []));
    this.opening = el("div", { class: "filters" }, el("label", {}, "Open a recording ", this.file), button("example", "Play the example", () => this.play()));
    const later = [
      button("again", "Connect", () => this.choose()),
      button("disconnect", "Disconnect", () => this.wish("leave")),
      button("save", "Save the recording", () => keep(this.exported(new URLSearchParams()), (text) => this.say(text))),
      button("anew", "Start anew", () => location.reload()),
    ];
    this.later = el("div", { class: "filters", hidden: true }, ...later);
    const where = "Everything stays in this browser: there is no server. Motion needs your permission, and this is no emergency stop: keep the switch of the arm within reach.";
    this.about = el("p", { class: "hint" }, "serial" in navigator ? where : NO_SERIAL);
    return el("section", { id: "connecting", class: "card", "aria-label": "Connect an arm or open a recording" }, this.first, this.opening, this.later, this.said, this.about);
  }

  async choices() {
    const titles = await (await fetch("editions.json")).json();
    const options = Object.entries(titles).map(([value, title]) => el("option", { value }, `${title} (${value})`));
    this.edition.replaceChildren(...options);
    this.edition.value = "mycobot280";
    document.documentElement.dataset.offered = "yes";
  }

  say(text, problem = false) {
    this.said.textContent = text;
    this.said.className = problem ? "problem" : "hint";
  }

  // Run something that the user wants, and say how it ended.
  async attempt(doing, text) {
    this.say(text);
    try {
      this.say((await doing()) ?? "");
    } catch (error) {
      if (error.name === "NotFoundError") return this.say("No port was chosen.");
      this.say(error.message, true);
    }
  }

  choose() {
    return this.attempt(async () => {
      const port = await navigator.serial.requestPort();
      const info = JSON.stringify(port.getInfo());
      // The worker finds the port by its information, so no other one may look like it.
      for (const other of await navigator.serial.getPorts()) {
        if (other !== port && JSON.stringify(other.getInfo()) === info) await other.forget();
      }
      const ports = await navigator.serial.getPorts();
      const infos = JSON.stringify(ports.map((each) => each.getInfo()));
      const [name, speed, at] = [this.edition.value, Number(this.speed.value), ports.indexOf(port)];
      return `Connected: ${await this.ask("connect", { name, speed, at, infos })}.`;
    }, "connecting");
  }

  open(file) {
    return file && this.attempt(async () => this.read(new Uint8Array(await file.arrayBuffer()), file.name), "reading");
  }

  play() {
    return this.attempt(async () => this.read(new Uint8Array(await (await fetch("example.pcapng")).arrayBuffer()), "example.pcapng"), "reading");
  }

  read(file, name) {
    if (!this.later.hidden) throw new Error("start anew before you open another recording");
    return this.ask("open", { file, name, usual: this.edition.value });
  }

  take({ news, id, result, error }) {
    if (!news) {
      const { done, failed } = this.asked.get(id);
      this.asked.delete(id);
      return error === undefined ? done(result) : failed(new Error(error));
    }
    const { hello, port } = news.states;
    if (hello) {
      this.first.hidden = this.opening.hidden = this.about.hidden = true;
      document.querySelector("main").hidden = this.later.hidden = false;
      this.again.hidden = this.disconnect.hidden = this.save.hidden = hello.mode === "recording";
    }
    if (port) {
      this.connected = port.problem === "";
      this.again.disabled = this.connected;
      this.disconnect.disabled = !this.connected;
      if (port.problem) this.say(port.problem, true);
    }
    this.onBatch(news);
  }

  ask(request, ...values) {
    const id = (this.count += 1);
    this.worker.postMessage({ id, request, values });
    return new Promise((done, failed) => this.asked.set(id, { done, failed }));
  }

  wish(wish, values = {}) {
    this.worker.postMessage({ wish, ...values });
    return true;
  }

  async exported(query) {
    const data = await this.ask("exported", Object.fromEntries(query));
    return new Response(data, { headers: { "content-disposition": 'attachment; filename="live.pcapng"' } });
  }

  // Let the worker stop the arm before it ends.
  leave() {
    if (!this.connected) return;
    this.wish("leave");
    this.connected = false;
    for (const until = performance.now() + LEAVE_MS; performance.now() < until;);
  }
}

// The worker has methods of these names.
for (const name of ["commands", "explain", "preview", "send", "control", "allowMotion", "stop"]) {
  Source.prototype[name] = function (...values) {
    return this.ask(name, ...values);
  };
}
