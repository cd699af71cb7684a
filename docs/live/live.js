// A session with an arm. The rules are those of the studio's server: arm_line.py, sending.py and holding.py.

import { LinkError, ProtocolError, ReplyTimeout } from "./cobotwire/dist/errors.js";
import { clientOf } from "./identify.js";
import { Session, Stream } from "./session.js";

const POLL_MS = 100;
// If one query gets no reply and another one does, the first is sent again only after a pause.
const [UNANSWERED, PAUSE_MS] = [2, 60_000];
// After this many queries without a reply, a survey checks that the arm is there.
const MOST_SILENT = 3;
// The longest silence of a page that holds a button; how long noise waits for more bytes.
const [SILENCE_MS, IDLE_MS] = [500, 300];
const now = () => performance.now();

export class Live extends Session {
  static async make(publish, facts, module, { speed, baudrate }) {
    const streams = await Promise.all(["sent", "received"].map((direction) => Stream.load(direction, module)));
    const live = new Live(publish, facts, streams, { url: "", baudrate });
    const polled = ["joints", "coordinates"].map((role) => Object.values(facts.commands).find((command) => command.role === role)?.about.name);
    if (facts.controls.speeds) facts.controls.speeds.high = Math.min(facts.controls.speeds.high, speed);
    Object.assign(live, { client: clientOf(module), speed, start: now(), startNs: BigInt(Date.now()) * 1000000n, stops: 0 });
    return Object.assign(live, { polled: polled.filter(Boolean).map((name) => ({ name, unanswered: 0, due: 0 })) });
  }

  // Use an open port, and poll the arm.
  async connect(port) {
    const [{ inner }, [sent, received]] = [port, this.streams];
    const { url } = inner;
    let arm;
    const transport = {
      ...{ url, close: () => inner.close(), abort: () => inner.abort() },
      start: (take, ended) => {
        const heard = (data) => {
          this.note(() => received.take(this.time, data));
          clearTimeout(this.idle);
          this.idle = setTimeout(() => this.note(() => received.silence()), IDLE_MS);
          take(data);
        };
        port.lend().start(heard, (detail) => (ended(detail), this.lose(arm, `${url}: ${detail}`)));
      },
      write: (data) => {
        const written = inner.write(data);
        this.note(() => [...sent.take(this.time, data), ...sent.silence()]);
        return written;
      },
    };
    arm = await this.client.open(transport, { limits: { speed: this.speed } });
    Object.assign(this, { arm, port: { ...this.port, url } });
    this.publish({ states: { port: { url, problem: "" } } });
    this.control(true);
    this.poll(arm);
  }

  get time() {
    return (now() - this.start) / 1000;
  }

  async poll(arm) {
    while (this.arm === arm) {
      const due = now() + POLL_MS;
      for (const poll of this.polled) if (poll.due <= now() && !this.surveying) await this.ask(arm, poll);
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
    this.note(() => [{ t: this.time, d: "unknown", label: "port", text: why }]);
    this.end("the port is gone");
    this.refuse(`${why.replace(/\.$/, "")}. Stop cannot reach the arm: use its switch.`);
  }

  // Stop the arm if it was set in motion, and close the port.
  async leave() {
    const { arm } = this;
    this.stops += 1;
    this.endSurvey();
    this.end("not connected");
    await arm?.[Symbol.asyncDispose]();
  }

  end(problem) {
    clearTimeout(this.silence);
    this.arm = undefined;
    this.held = false;
    this.publish({ states: { port: { url: this.port.url, problem } } });
    this.control(this.mine);
  }

  refuse(refused) {
    this.publish({ states: { refused } });
  }

  control(mine, motion = false) {
    Object.assign(this, { mine, motion });
    this.publish({ states: { control: { mine, taken: false, motion } } });
  }

  allowMotion(on) {
    this.control(this.mine, on && this.mine && !this.surveying);
  }

  form(name) {
    const form = this.facts.forms.find((each) => each.name === name);
    if (!form || !this.arm) throw new Error(form ? "no arm is connected" : `${name} is no command of this page`);
    return form;
  }

  // Return the form of a command that may be sent now.
  permitted(name) {
    const form = this.form(name);
    if (!this.mine) throw new Error("this page only watches; take the control before you send");
    if (form.safety !== "query" && !this.motion) throw new Error(`${name} is not a query (${form.safety}): allow motion in the page first`);
    return form;
  }

  preview(name, texts) {
    const given = values(this.form(name), texts);
    return this.explained({ t: 0, d: "sent", data: this.arm.prepare(name, given) });
  }

  // Send a command with the texts of its arguments; return its result.
  async send(name, texts, force) {
    const form = this.permitted(name);
    if (this.surveying) throw new Error("end the survey before you send something else");
    const { arm, stops } = this;
    const given = values(form, texts);
    // A wrong value is reported before the state of the arm is queried.
    arm.prepare(name, given);
    const checks = form.moves && !force;
    if (checks) await this.check(arm, this.facts.ready, false, `${name} was not sent:`);
    const query = form.safety === "query";
    if (!query && this.stops !== stops) throw new Error(`${name} was not sent, because the arm was stopped meanwhile`);
    this.permitted(name);
    let results;
    try {
      results = Object.values(await arm.call(name, given));
    } finally {
      // The stop may have overtaken the request.
      if (!query && this.stops !== stops && this.arm) await this.sendStop();
    }
    const error = this.facts.ready.filter(({ role }) => role === "error");
    if (checks) await this.check(arm, error, true, `${name} was sent, but`);
    return results.length > 1 ? results : (results[0] ?? null);
  }

  // Query the states of the arm; throw if it would not obey. Once one query had a reply, ignore those without one.
  async check(arm, queries, replied, how) {
    const problems = [];
    for (const { command, field, texts, usual } of queries) {
      try {
        const state = Number((await arm.call(command))[field]);
        problems.push(texts[state] ?? usual.replace("{}", state));
        replied = true;
      } catch (error) {
        if (!(error instanceof ReplyTimeout) || !replied) throw error;
      }
    }
    if (problems.some(Boolean)) throw new Error(`${how} ${problems.filter(Boolean).join(". Also, ")}`);
  }

  // Stop the arm at once, and drop the motions that were requested before.
  async stop() {
    this.stops += 1;
    this.endSurvey();
    await this.sendStop();
  }

  async sendStop() {
    if (!this.arm) throw new Error("no arm is connected; stop it by its switch");
    await this.arm.call(this.facts.robot.stop);
  }

  // Send the queries of a survey; return in words what came, and the numbers of its entries.
  async survey() {
    const [{ arm, facts }, { questions, leftOut }] = [this, this.facts.survey];
    if (!arm) throw new Error("no arm is connected");
    // From now on nothing else is sent, and Stop ends the survey.
    const { signal } = (this.surveying = new AbortController());
    this.allowMotion(false);
    try {
      const asking = arm.withSignal(signal);
      const moving = Object.values(facts.commands).find((command) => command.role === "moving")?.about.name;
      if (moving && (await this.moves(asking, moving))) throw new Error("the arm is moving: wait until it rests, or stop it");
      return await this.sendQuestions(asking, signal, questions, leftOut);
    } finally {
      this.surveying = undefined;
    }
  }

  // Return whether the arm moves. One that lacks the query can be surveyed, too.
  async moves(asking, query) {
    try {
      return Object.values(await asking.call(query)).some(Boolean);
    } catch (error) {
      if (error instanceof ReplyTimeout || error instanceof ProtocolError) return false;
      throw this.surveying.signal.aborted ? new Error("you ended the survey") : error;
    }
  }

  async sendQuestions(asking, signal, questions, leftOut) {
    let [asked, replied, silent, why] = [0, 0, 0, ""];
    const first = this.count;
    let last = first;
    const ask = async (name, given) => {
      this.permitted(name);
      asked += 1;
      silent += 1;
      try {
        await asking.call(name, given);
      } catch (error) {
        if (error instanceof ReplyTimeout) return;
        if (!(error instanceof ProtocolError)) throw error;
      }
      [silent, replied, last] = [0, replied + 1, this.count];
    };
    const alive = questions.find(([name]) => name === this.polled[0].name);
    try {
      for (const question of [...questions, alive]) {
        await ask(...question);
        // An arm that is off must not look like one that lacks commands.
        if (silent === MOST_SILENT) await ask(...alive);
        if (silent > MOST_SILENT) throw new Error("the arm no longer replies");
        this.publish({ states: { survey: `The survey has sent ${asked} of ${questions.length + 1} queries. Stop ends it, too.` } });
      }
    } catch (error) {
      why = `The survey ended early: ${signal.aborted ? "you ended it" : error.message}. `;
    }
    const not = Object.entries(leftOut).map(([name, reason]) => `${name} (${reason})`);
    return { first, last, text: `${why}${asked} queries were sent, and ${replied} got a reply. Not sent: ${not.join(", ") || "nothing"}.` };
  }

  endSurvey() {
    this.surveying?.abort();
  }

  // Send a motion that lasts only while the page holds a button, and says so.
  hold(command, given) {
    this.held = true;
    this.keep();
    this.send(command, given, false).catch((error) => this.refuse(error.message));
  }

  keep() {
    if (!this.held) return;
    clearTimeout(this.silence);
    this.silence = setTimeout(() => {
      this.release();
      this.refuse("the arm was stopped: the page no longer reported that the button is held");
    }, SILENCE_MS);
  }

  release() {
    if (!this.held) return;
    this.held = false;
    clearTimeout(this.silence);
    this.stop().catch((error) => this.refuse(`stop was NOT sent: ${error.message}`));
  }
}

// Return the arguments that the texts of a form state; the codec checks their ranges.
function values(form, texts) {
  const given = Object.entries(texts).filter(([, text]) => text);
  return Object.fromEntries(given.map(([name, text]) => [name, value(form.arguments.find((each) => each.name === name), text)]));
}

function value({ name, kind, many, list, rows, elements }, text) {
  const wrong = (allowed) => new Error(`${name} is ${JSON.stringify(text)}; allowed: ${allowed}`);
  if (kind === "text") return list ? text.split(",").filter(Boolean) : text;
  if (kind === "flag") {
    if (text !== "on" && text !== "off") throw wrong("on or off");
    return text === "on";
  }
  if (kind === "bytes") {
    if (!/^(\s*[\da-f]{2})*\s*$/i.test(text)) throw wrong("pairs of hex digits");
    return Uint8Array.from(text.match(/[\da-f]{2}/gi) ?? [], (pair) => Number.parseInt(pair, 16));
  }
  const number = (word) => {
    const found = Number(word);
    if (!word.trim() || !Number.isFinite(found)) throw wrong("a number");
    return elements[0]?.unit === "radians" ? (found * 180) / Math.PI : found;
  };
  if (rows) return text.split(";").map((row) => row.split(",").map(number));
  return many || list ? text.split(",").map(number) : number(text);
}
