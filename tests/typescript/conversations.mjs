// Conversations of the generated clients with an arm; the argument names one. Each prints what it saw.
import { ReplyTimeout } from "../../clients/typescript/dist/index.js";
import { MyCobot280 } from "../../clients/typescript/editions/mycobot280.js";
import { Pro630 } from "../../clients/typescript/editions/pro630.js";

const [name, url] = process.argv.slice(2);
const failed = (error) => [error.name, error.message];
const say = (value) => console.log(JSON.stringify(value, (_, each) => (each === undefined ? null : each)));

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
  },
  async late() {
    const first = await MyCobot280.open(url, { timeout: 0.1 });
    say(await first.getEncoder(1).catch((error) => error.name));
    await first.close();
    const second = await MyCobot280.open(url, { timeout: 2 });
    say(await second.getEncoder(2));
    await second.close();
  },
};
await conversations[name]();
