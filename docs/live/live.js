// A session with an arm. The rules are those of the studio's server: arm_line.py, sending.py and holding.py.

import { LinkError, ProtocolError, ReplyTimeout } from "./cobotwire/dist/errors.js";
import { nameOf, openWebSerial } from "./cobotwire/dist/transport.js";
import { values } from "./arguments.js";
import { Stream } from "./entries.js";
import { Session } from "./session.js";

const POLLED = ["joints", "coordinates"];
const POLL_MS = 100;
// If a query had no reply this often although another one had, it is sent again only after a pause.
const UNANSWERED = 2;
const PAUSE_MS = 60_000;
const SILENCE_MS = 500;
// Noise may wait for more bytes.
const IDLE_MS = 300;
const now = () => performance.now();

export class Live extends Session {
  static async make(publish, facts, { module, baudrate, speed }) {
    const streams = await Promise.all(["sent", "received"].map((direction) => Stream.load(direction, module.table)));
    return new Live(publish, facts, streams, { module, baudrate, speed });
  }

  constructor(publish, facts, [sent, received], { module, baudrate, speed }) {
    super(publish, facts, [sent, received], { baudrate, url: "" });
    Object.assign(this, { sent, received, speed, client: module[facts.client] });
    Object.assign(this, { start: now(), startNs: BigInt(Date.now()) * 1000000n, mine: true, motion: false, stops: 0 });
    const { controls } = facts;
    if (controls.speeds) controls.speeds.high = Math.min(controls.speeds.high, speed);
    const find = (role) => Object.entries(facts.commands).find(([, command]) => command.role === role)?.[0];
    this.polled = POLLED.map(find).filter(Boolean).map((name) => ({ name, unanswered: 0, due: 0 }));
  }

  // Open the port, and check the edition with queries; return what they showed.
  async connect(port) {
    const { baudrate, facts } = this;
    const url = nameOf(port);
    const inner = await openWebSerial(port, url, baudrate);
    const transport = {
      ...{ url, close: () => inner.close(), abort: () => inner.abort() },
      start: (received, ended) =>
        inner.start(
          (data) => (this.heard(data), received(data)),
          (detail) => (ended(detail), this.lose(arm, `${url}: ${detail}`)),
        ),
      write: (data) => {
        this.add(this.sent.take(this.time, data));
        this.add(this.sent.silence());
        return inner.write(data);
      },
    };
    let arm;
    try {
      arm = await this.client.open(transport, { limits: { speed: this.speed } });
    } catch (error) {
      inner.abort();
      throw error;
    }
    try {
      await arm.call(this.polled[0].name);
    } catch (error) {
      await arm.close();
      const { edition } = facts.robot;
      throw new Error(`no legal reply, so this is hardly an arm of the edition ${edition}; \`cobotwire identify\` finds out which (${error.message})`);
    }
    this.port.url = url;
    this.arm = arm;
    const { own, robot } = facts;
    if (!own) return "the joints were read, as other editions allow, too; check that they fit the arm";
    const replied = await arm.call(own).then(() => true, () => false);
    return `${own}, which only ${robot.edition} has, ${replied ? "replied" : "got no reply: check that the joints fit the arm"}`;
  }

  // Show that the arm is connected, and poll it.
  begin() {
    this.publish({ states: { port: { url: this.port.url, problem: "" } } });
    this.control(true);
    this.poll(this.arm);
  }

  get time() {
    return (now() - this.start) / 1000;
  }

  heard(data) {
    this.add(this.received.take(this.time, data));
    clearTimeout(this.idle);
    this.idle = setTimeout(() => this.add(this.received.silence()), IDLE_MS);
  }

  async poll(arm) {
    while (this.arm === arm) {
      const due = now() + POLL_MS;
      for (const poll of this.polled) if (poll.due <= now()) await this.ask(arm, poll);
      await new Promise((go) => setTimeout(go, Math.max(0, due - now())));
    }
  }

  async ask(arm, poll) {
    try {
      await arm.call(poll.name);
      poll.unanswered = 0;
    } catch (error) {
      if (error instanceof LinkError) this.lose(arm, error.message);
      poll.unanswered += 1;
      const others = this.polled.some((each) => !each.unanswered);
      if (poll.unanswered >= UNANSWERED && others) poll.due = now() + PAUSE_MS;
    }
  }

  lose(arm, why) {
    if (!arm || this.arm !== arm) return;
    this.arm = undefined;
    this.held = this.motion = false;
    clearTimeout(this.silence);
    const refused = `${why.replace(/\.$/, "")}. Stop cannot reach the arm: use its switch.`;
    this.add([{ t: this.time, d: "unknown", label: "port", text: why }]);
    this.publish({ states: { port: { url: this.port.url, problem: "the port is gone" }, refused } });
    this.showControl();
  }

  // Stop the arm if it was set in motion, and close the port.
  async leave() {
    const { arm } = this;
    if (!arm) return;
    this.stops += 1;
    this.arm = undefined;
    this.held = false;
    const left = arm[Symbol.asyncDispose]();
    this.publish({ states: { port: { url: this.port.url, problem: "not connected" } } });
    await left;
  }

  control(take) {
    Object.assign(this, { mine: take, motion: false });
    this.showControl();
  }

  allowMotion(on) {
    if (!this.mine) throw new Error("this page only watches; take the control before you send");
    this.motion = on;
    this.showControl();
  }

  showControl() {
    this.publish({ states: { control: { page: this.mine ? "page" : "", motion: this.motion } } });
  }

  // Return the form of a command that may be sent now.
  check(name) {
    const form = this.form(name);
    if (!this.arm) throw new Error("no arm is connected");
    if (!this.mine) throw new Error("this page only watches; take the control before you send");
    if (form.safety !== "query" && !this.motion) throw new Error(`${name} is not a query (${form.safety}): allow motion in the page first`);
    return form;
  }

  form(name) {
    const form = this.facts.forms.find((each) => each.name === name);
    if (!form) throw new Error(`${name} is no command of this page`);
    return form;
  }

  preview(name, texts) {
    if (!this.arm) throw new Error("no arm is connected");
    const data = this.arm.prepare(name, values(this.form(name), texts));
    const [frame] = [...this.sent.decoder.feed(data), ...this.sent.decoder.flush()];
    return this.reader.explain({ t: 0, d: "sent", ...frame });
  }

  // Send a command with the texts of its arguments; return its result.
  async send(name, texts, force) {
    const form = this.check(name);
    const { arm, stops } = this;
    const given = values(form, texts);
    // A wrong value is reported before the arm is asked whether it obeys.
    arm.prepare(name, given);
    const checks = form.moves && !force;
    if (checks) await this.checkReady(name, arm);
    const query = form.safety === "query";
    if (!query && this.stops !== stops) throw new Error(`${name} was not sent, because the arm was stopped meanwhile`);
    this.check(name);
    let fields;
    try {
      fields = await arm.call(name, given);
    } finally {
      // The stop may have overtaken it.
      if (!query && this.stops !== stops) await this.sendStop();
    }
    if (checks) await this.checkAccepted(name, arm);
    const results = Object.values(fields);
    return results.length > 1 ? fields : (results[0] ?? null);
  }

  // Ask the arm whether it obeys. If only some queries get no reply, their states are not known.
  async checkReady(name, arm) {
    let problems = [];
    let replied = false;
    for (const query of this.facts.ready) {
      try {
        problems = [...problems, ...(await this.problem(query, arm))];
        replied = true;
      } catch (error) {
        if (!(error instanceof ReplyTimeout) || !replied) throw error;
      }
    }
    if (problems.length) throw new Error(`${name} was not sent: ${problems.join("; ")}`);
  }

  async checkAccepted(name, arm) {
    const query = this.facts.ready.find(({ role }) => role === "error");
    const problems = query ? await this.problem(query, arm).catch(nothingIfLate) : [];
    if (problems.length) throw new Error(`${name} was sent, but the arm may not obey: ${problems.join("; ")}`);
  }

  async problem({ command, field, texts, usual }, arm) {
    const state = Number((await arm.call(command))[field]);
    const text = texts[state] ?? usual.replace("{}", state);
    return text ? [text] : [];
  }

  // Stop the arm at once. Nothing but a query follows a stop that was sent in the meantime.
  async stop() {
    this.stops += 1;
    await this.sendStop();
  }

  async sendStop() {
    if (!this.arm) throw new Error("no arm is connected; stop it by its switch");
    await this.arm.call(this.facts.robot.stop);
  }

  // A motion that lasts only while the page holds a button.
  hold(command, given) {
    this.held = true;
    this.keep();
    this.send(command, given, false).catch((error) => this.publish({ states: { refused: error.message } }));
  }

  keep() {
    if (!this.held) return;
    clearTimeout(this.silence);
    this.silence = setTimeout(() => {
      this.release();
      this.publish({ states: { refused: "the arm was stopped: the page did not say that the button is held" } });
    }, SILENCE_MS);
  }

  release() {
    if (!this.held) return;
    this.held = false;
    clearTimeout(this.silence);
    this.stop().catch((error) => this.publish({ states: { refused: `stop was NOT sent: ${error.message}` } }));
  }
}

function nothingIfLate(error) {
  if (error instanceof ReplyTimeout || error instanceof ProtocolError) return [];
  throw error;
}
