// Talk to the worker that holds the arm or a recording, and let the user choose which.

import { byId, el } from "./dom.js";
import { keep } from "./export.js";

const SERIAL = "serial" in navigator;
const ABOUT = SERIAL
  ? "Everything stays in this browser: there is no server. Motion needs your permission, and this is no emergency stop: keep the switch of the arm within reach."
  : "This browser cannot open a serial port, because it lacks WebSerial. Chrome and Edge on a computer have it. Recordings can be opened here, too.";
const SURVEY =
  "The file will hold these bytes with their times, and the name of the edition: no serial number, and no name of this computer, " +
  "its user or its port. “cobotwire survey --from FILE --real-arm -o survey.zip” evaluates it. Settings and motions are surveyed only by the command line.";
// How long a page that is being closed waits for its worker to stop the arm.
const LEAVE_MS = 100;
const infoOf = (port) => JSON.stringify(port.getInfo());

export class Source {
  // `onBatch` gets each batch of news.
  constructor(onBatch) {
    Object.assign(this, { page: "", onBatch, asked: new Map(), count: 0, connected: false });
    this.worker = new Worker("worker.js", { type: "module" });
    this.worker.onmessage = ({ data }) => this.take(data);
    this.worker.onerror = () => this.say("The worker of this page has failed; the browser may be too old. Load the page again.", true);
    byId("source").textContent = "an arm in the browser";
    byId("status").textContent = "not connected";
    byId("stop").disabled = byId("control").disabled = true;
    for (const option of document.querySelectorAll("#export [value=parquet], #export [value=csv]")) option.remove();
    document.querySelector("main").hidden = true;
    this.build();
    for (const event of ["beforeunload", "pagehide"]) window.addEventListener(event, () => this.leave());
    document.addEventListener("dragover", (event) => event.preventDefault());
    document.addEventListener("drop", (event) => {
      event.preventDefault();
      this.open(event.dataTransfer.files[0]);
    });
    navigator.serviceWorker?.register("service.js").catch(() => {});
  }

  async build() {
    const button = (id, text, click) => (this[id] = el("button", { id, type: "button", click }, text));
    const row = (...parts) => el("div", { class: "filters" }, ...parts);
    this.edition = el("select", { id: "edition" });
    const saved = (text) => this.say(text);
    this.speed = el("input", { id: "highest-speed", type: "number", min: 1, max: 100, value: 30 });
    const file = el("input", { id: "capture", type: "file", accept: ".pcapng", change: () => this.open(file.files[0]) });
    const arm = [el("label", {}, "Highest speed ", this.speed, " %"), button("connect", "Connect", () => this.choose())];
    this.first = [
      row(el("label", {}, "Robot ", this.edition), ...(SERIAL ? arm : [])),
      row(el("label", {}, "Open a recording ", file), button("example", "Play the example", () => this.play())),
      el("p", { class: "hint" }, ABOUT),
    ];
    this.later = row(
      button("again", "Connect", () => this.choose()),
      button("disconnect", "Disconnect", () => this.wish("leave")),
      button("save", "Save the recording", () => keep(this.exported(new URLSearchParams()), saved)),
      button("run", "Run the survey", () => this.survey()),
      button("keep", "Save the survey", () => keep(this.exported(this.range, `survey-${this.robot.edition}`), saved)),
      button("anew", "Start anew", () => location.reload()),
    );
    this.later.hidden = this.keep.hidden = true;
    this.said = el("p", { id: "said", role: "status" });
    this.surveyed = el("p", { id: "surveyed", class: "hint", role: "status" });
    const label = { "aria-label": "Connect an arm, or open a recording" };
    document.querySelector("main").before(el("section", { id: "connecting", class: "card", ...label }, ...this.first, this.later, this.said, this.surveyed));
    const titles = await (await fetch("editions.json")).json();
    const options = Object.entries(titles).map(([value, title]) => el("option", { value }, `${title} (${value})`));
    this.edition.replaceChildren(el("option", { value: "" }, "find out by queries"), ...options);
    document.documentElement.dataset.offered = "yes";
  }

  say(text, problem = false) {
    this.said.textContent = text;
    this.said.className = problem ? "problem" : "hint";
  }

  // Do something that the user wants, and say how it ended.
  async attempt(what, doing) {
    if (this.busy) return;
    this.busy = true;
    this.say(what);
    try {
      this.say((await doing()) ?? "");
    } catch (error) {
      this.say(error.name === "NotFoundError" ? "No port was chosen." : error.message, true);
    }
    this.busy = false;
  }

  // Begin the survey, or end it.
  async survey() {
    if (this.surveying) return this.wish("endSurvey");
    this.surveying = true;
    this.run.textContent = "End the survey";
    try {
      const { text, ...range } = await this.ask("survey");
      this.range = new URLSearchParams(range);
      this.keep.hidden = false;
      this.surveyed.textContent = `${text} ${SURVEY}`;
    } catch (error) {
      this.surveyed.textContent = error.message;
    }
    this.surveying = false;
    this.run.textContent = "Run the survey";
  }

  // Become the only page of this site that uses an arm; return whether it is.
  alone() {
    return this.release !== undefined || new Promise((done, failed) => {
      const kept = (lock) => (done(lock !== null), lock && new Promise((release) => (this.release = release)));
      navigator.locks.request("arm", { ifAvailable: true }, kept).catch(failed);
    });
  }

  letGo() {
    this.release?.();
    this.release = undefined;
  }

  choose() {
    return this.attempt("finding out which robot it is, with queries", async () => {
      if (self !== top) throw new Error("open this page on its own: inside another page it connects no arm");
      // forget() below takes a port away from every page of this site, so no other page may use an arm.
      if (!(await this.alone())) throw new Error("another page of this site uses an arm: disconnect it there first");
      try {
        const port = await navigator.serial.requestPort();
        // The worker finds the port by its information, so the page keeps no other port that looks like it.
        for (const other of await navigator.serial.getPorts()) if (other !== port && infoOf(other) === infoOf(port)) await other.forget();
        const ports = await navigator.serial.getPorts();
        const infos = JSON.stringify(ports.map((each) => each.getInfo()));
        const asked = { name: this.edition.value, speed: Number(this.speed.value), at: ports.indexOf(port), infos };
        return `Connected: ${await this.ask("connect", asked)}.`;
      } catch (error) {
        this.letGo();
        throw error;
      }
    });
  }

  play() {
    return this.attempt("reading", async () => this.read(await fetch("example.pcapng"), "example.pcapng"));
  }

  open(file) {
    return file && this.attempt("reading", () => this.read(file, file.name));
  }

  async read(found, name) {
    if (!this.later.hidden) throw new Error("start anew before you open another recording");
    return this.ask("open", { file: new Uint8Array(await found.arrayBuffer()), name, usual: this.edition.value });
  }

  take({ news, id, result, error }) {
    if (!news) {
      const [done, failed] = this.asked.get(id);
      this.asked.delete(id);
      return error === undefined ? done(result) : failed(new Error(error));
    }
    const { hello, port, survey } = news.states;
    if (survey && this.surveying) this.surveyed.textContent = survey;
    if (hello) {
      for (const part of this.first) part.hidden = true;
      document.querySelector("main").hidden = this.later.hidden = false;
      for (const each of [this.again, this.disconnect, this.save, this.run]) each.hidden = hello.mode === "recording";
      this.robot = hello.robot;
    }
    if (port) {
      this.connected = this.again.disabled = port.problem === "";
      this.disconnect.disabled = this.run.disabled = !this.connected;
      if (port.problem) {
        this.letGo();
        this.say(port.problem, true);
      }
    }
    this.onBatch(news);
  }

  ask(request, ...values) {
    const id = (this.count += 1);
    this.worker.postMessage({ id, request, values });
    return new Promise((...settle) => this.asked.set(id, settle));
  }

  wish(wish, values = {}) {
    this.worker.postMessage({ wish, ...values });
    return true;
  }

  async exported(query, name = "live") {
    const data = await this.ask("exported", Object.fromEntries(query));
    return new Response(data, { headers: { "content-disposition": `attachment; filename="${name}.pcapng"` } });
  }

  // Let the worker stop the arm before it ends.
  leave() {
    if (!this.connected) return;
    this.wish("leave");
    this.connected = false;
    for (const until = performance.now() + LEAVE_MS; performance.now() < until;);
  }
}

// Each of these methods calls the method of the worker with the same name.
for (const name of ["commands", "explain", "preview", "send", "control", "allowMotion", "stop"]) {
  Source.prototype[name] = function (...values) {
    return this.ask(name, ...values);
  };
}
