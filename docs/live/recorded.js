// A recording, and the player of the page: what studio/recorded.py does.

import { Stream } from "./entries.js";
import { MOST_ENTRIES, Session } from "./session.js";

const STEP_MS = 50;
const GAP_NS = 500_000_000n;
// The entries before the target of a jump that the page also gets.
const PAST_ENTRIES = 400;
const PAST_SAMPLED = 4000;

export class Recorded extends Session {
  static async make(publish, facts, { module, capture, name }) {
    const streams = await Promise.all(["sent", "received", "unknown"].map((each) => Stream.load(each, module.table)));
    return new Recorded(publish, facts, streams, { capture, name });
  }

  constructor(publish, facts, streams, { capture, name }) {
    super(publish, facts, streams, { url: capture.url, baudrate: capture.baudrate });
    const { packets, remark, interfaces } = capture;
    this.startNs = packets.reduce((first, { ns }) => (ns < first ? ns : first), packets[0].ns);
    const [cut, before] = [[], {}];
    for (const { ns, direction, data } of packets) {
      const stream = streams.find((each) => each.direction === direction);
      if (ns - (before[direction] ?? ns) > GAP_NS) cut.push(...stream.silence());
      before[direction] = ns;
      cut.push(...stream.take(Number(ns - this.startNs) / 1e9, data));
    }
    for (const stream of streams) cut.push(...stream.silence());
    this.entries = cut.sort((one, other) => one.t - other.t).slice(0, MOST_ENTRIES);
    this.entries.forEach((entry, n) => (entry.n = n));
    this.seconds = this.entries.at(-1).t;
    this.remarks = remark ? [remark] : [];
    if (cut.length > MOST_ENTRIES) this.remarks.push(`only the first ${MOST_ENTRIES} entries are shown`);
    if (interfaces > 1) this.remarks.push(`only the first of ${interfaces} interfaces is shown`);
    this.recording = { name, seconds: this.seconds, remarks: this.remarks };
    Object.assign(this, { position: 0, speed: 1, next: 0 });
  }

  seek(seconds) {
    this.position = Math.min(Math.max(seconds, 0), this.seconds);
    this.next = this.after(this.position);
    this.sampler = new this.sampler.constructor(this.facts);
    this.publish({ cleared: true });
    const first = this.next - PAST_ENTRIES;
    const past = this.entries.slice(Math.max(0, this.next - PAST_SAMPLED), this.next);
    for (const entry of past) this.show(entry, entry.n >= first);
    this.showPlayer();
  }

  // Return the number of the first entry after a time.
  after(seconds) {
    let [low, high] = [0, this.entries.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.entries[middle].t <= seconds + 1e-9) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  play(speed) {
    if (!(speed >= 0.05 && speed <= 1000)) throw new Error(`speed is ${speed}; allowed: 0.05..1000`);
    if (this.position >= this.seconds) this.seek(0);
    this.speed = speed;
    this.pause();
    let before = performance.now();
    this.timer = setInterval(() => {
      const passed = (performance.now() - before) / 1000;
      before += passed * 1000;
      this.advance(passed);
    }, STEP_MS);
    this.showPlayer();
  }

  pause() {
    clearInterval(this.timer);
    this.timer = undefined;
    this.showPlayer();
  }

  advance(seconds) {
    this.position = Math.min(this.position + seconds * this.speed, this.seconds);
    const until = this.after(this.position);
    for (const entry of this.entries.slice(this.next, until)) this.show(entry);
    this.next = until;
    if (this.position >= this.seconds) this.pause();
    else this.showPlayer();
  }

  showPlayer() {
    const { position, speed, timer } = this;
    this.publish({ states: { player: { position, speed, playing: timer !== undefined } } });
  }
}
