// Conversations of the generated clients with an arm; the argument names one. Each prints what it saw.
import { ReplyTimeout } from "../../clients/typescript/dist/index.js";
import { MyCobot280 } from "../../clients/typescript/editions/mycobot280.js";
import { Pro630 } from "../../clients/typescript/editions/pro630.js";

const [name, url] = process.argv.slice(2);
const failed = (error) => [error.name, error.message];
const say = (value) => console.log(JSON.stringify(value, (_, each) => (each === undefined ? null : each)));

const wait = (milliseconds) => new Promise((done) => setTimeout(done, milliseconds));

/** A transport whose writes take 2 ms, as in a browser; it logs them. */
function slow(log) {
  let last = Promise.resolve();
  const write = (data) => (last = last.then(() => wait(2)).then(() => void log.push(Buffer.from(data).toString("hex"))));
  return { url: "memory", start() {}, write, close: () => last, abort() {} };
}

/** A port as in a browser: it continues after a framing error, and takes time to close. */
class SerialPort {
  async open() {
    if (this.opened) throw new Error("The port is already open.");
    this.opened = true;
    this.read();
    const write = () => this.controller.enqueue(Uint8Array.from([0xfe, 0xfe, 3, 0x12, 1, 0xfa]));
    this.writable = new WritableStream({ write });
  }
  read() {
    this.readable = new ReadableStream({ start: (controller) => (this.controller = controller) });
  }
  fail() {
    this.controller.error(new Error("A framing error has been detected."));
    this.read();
  }
  async close() {
    await wait(2);
    this.opened = false;
  }
}

const conversations = {
  async results() {
    const arm = await MyCobot280.open(url);
    await arm.powerOn();
    const both = await arm.getAnglesCoords();
    say([await arm.isPowerOn(), await arm.getAngles(), Object.keys(both), both.coords.length, await arm.call("get_encoder", { joint: 1 })]);
    await arm.close();
  },
  async mistakes() {
    const arm = await MyCobot280.open(url, { limits: { speed: 50 } });
    const calls = [
      () => arm.sendAngles([0, 200, 0, 0, 0, 0], 30),
      () => arm.sendAngles([0, 0, 0, 0, 0], 30),
      () => arm.sendAngles([0, 0, 0, 0, 0, 0]),
      () => arm.sendAngles([0, 0, 0, 0, 0, 0], 60),
      () => arm.setColor(1, 2.5, 3),
      () => arm.getAngles(1),
      () => MyCobot280.open(url, { timeout: -1 }),
      () => MyCobot280.open("socket://127.0.0.1:1"),
      () => MyCobot280.open("/dev/nowhere"),
      () => arm.stream((arm) => arm.sendAngle(1, 0, 30), 10)[Symbol.asyncIterator]().next(),
    ];
    const found = [];
    for (const call of calls) found.push(await call().then(String, failed));
    say(found);
    await arm.close();
  },
  async silence() {
    const arm = await MyCobot280.open(url, { timeout: 0.2, retry: { attempts: 2 } });
    const error = await arm.getAngles().catch((error) => error);
    say([failed(error), error instanceof ReplyTimeout, error.attempts, error.waited >= 0.2]);
    const [waiting, closed] = [arm.getEncoder(1).catch(failed), arm.close()];
    await closed;
    say([await waiting, await arm.getAngles().catch(failed), await arm.close()]);
  },
  async aborted() {
    const arm = await MyCobot280.open(url, { timeout: 5 });
    const signal = AbortSignal.timeout(50);
    say((await arm.withSignal(signal).getAngles().catch((error) => error)) === signal.reason);
    say((await arm.withSignal(signal).getAngles().catch((error) => error)) === signal.reason);
    await arm.close();
    const events = (await Pro630.open(slow([]))).withSignal(signal).events("motionEnded");
    say((await events[Symbol.asyncIterator]().next().catch((error) => error)) === signal.reason);
  },
  async queued() {
    const log = [];
    const run = MyCobot280.run(slow(log), async (arm) => {
      for (const angle of [10, 90]) arm.sendAngles([0, 0, 0, 0, 0, angle], 10).catch((error) => log.push(error.message));
      throw new Error("mine");
    });
    await run.catch(failed);
    await wait(20);
    say(log);
  },
  async options() {
    const [log, text] = [[], "20"];
    const given = [
      { limits: { speed: text } },
      { limits: { workspace: [[0, 100]] } },
      { limits: { workspace: { x: [0, 100] } } },
      { limits: { workspace: [[0, text], undefined, undefined] } },
      { timeout: text },
      { deadline: 0 },
      { retry: { attempts: 2.7 } },
      { retry: { grace: 1e8 } },
      { onError: "leaves" },
    ];
    const found = [];
    for (const options of given) found.push(await MyCobot280.open(slow(log), options).then(String, failed));
    const arm = await MyCobot280.open(slow(log));
    found.push(await arm.acknowledged(1e8).setColor(1, 2, 3).then(String, failed), log);
    say(found);
  },
  async browser() {
    const port = new SerialPort();
    const arm = await MyCobot280.open(port);
    const found = [await arm.isPowerOn()];
    port.fail();
    await wait(5);
    found.push(await arm.isPowerOn());
    await arm.close();
    const again = await MyCobot280.open(port);
    port.controller.close();
    say([...found, await again.isPowerOn().catch(failed)]);
  },
  async blocked() {
    const arm = await MyCobot280.open(url, { timeout: 0.3, retry: { attempts: 1 } });
    const call = arm.getEncoder(2);
    await wait(5);
    for (const until = performance.now() + 400; performance.now() < until; );
    say(await call.catch(failed));
    await arm.close();
  },
  async shared() {
    const arm = await MyCobot280.open(url);
    const joints = [1, 2, 3, 4, 5, 6, 1, 2, 3, 4, 5, 6];
    say(await Promise.all(joints.map((joint) => arm.getEncoder(joint))));
    await arm.close();
  },
  async stream() {
    const arm = await MyCobot280.open(url);
    const samples = [];
    const stream = arm.stream((arm) => arm.getAngles(), 100);
    for await (const sample of stream) if (samples.push(sample) === 10) break;
    say([samples.length, samples.every((each) => each.repliedAt >= each.requestedAt && each.value.length === 6)]);
    await arm.close();
  },
  async events() {
    const arm = await Pro630.open(url);
    await arm.powerOn();
    const events = arm.events("motionEnded", 10);
    await arm.sendAngles([0, 0, 0, 0, 0, 10], 100);
    for await (const event of events) {
      say([event, events.lost]);
      break;
    }
    await arm.close();
  },
  async last() {
    const arm = await MyCobot280.open(url);
    await arm.setColor(1, 2, 3);
    await arm.close();
  },
  async stopped() {
    const move = async (arm) => {
      await arm.sendAngles([0, 0, 0, 0, 0, 10], 1);
      throw new Error("mine");
    };
    say([await MyCobot280.run(url, move).catch(failed), await MyCobot280.run(url, move, { onError: "leave" }).catch(failed)]);
  },
  async lost() {
    const arm = await MyCobot280.open(url);
    const call = arm.getAngles().catch(failed);
    say([await call, await arm.getAngles().catch(failed)]);
    const next = await MyCobot280.open(url, { timeout: 0.1 });
    await next.getAngles().catch(failed);
    await next.close();
  },
  async late() {
    const first = await MyCobot280.open(url, { timeout: 0.1 });
    say(await first.getEncoder(1).catch((error) => error.name));
    await first.close();
    await MyCobot280.open(url, { timeout: -1 }).catch(failed);
    const second = await MyCobot280.open(url, { timeout: 2 });
    say(await second.getEncoder(2));
    await second.close();
  },
};
await conversations[name]();
