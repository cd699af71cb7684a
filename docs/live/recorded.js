// Play a recording, as studio/recorded.py does.

import { Sampler } from "./samples.js";
import { MOST_ENTRIES, Session, Stream } from "./session.js";

const [STEP_MS, GAP_NS] = [50, 500_000_000n];
// How many entries before the target of a jump the page also gets.
const [PAST_ENTRIES, PAST_SAMPLED] = [400, 4000];

export class Recorded extends Session {
  static async make(publish, facts, module, capture) {
    const streams = await Promise.all(["sent", "received", "unknown"].map((each) => Stream.load(each, module)));
    return new Recorded(publish, facts, streams, capture);
  }

  constructor(publish, facts, streams, { packets, remark, interfaces, url, baudrate }) {
    super(publish, facts, streams, { url, baudrate });
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
    const remarks = [remark, cut.length > MOST_ENTRIES && `only the first ${MOST_ENTRIES} entries are shown`];
    remarks.push(interfaces > 1 && `only the first of ${interfaces} interfaces is shown`);
    Object.assign(this, { remarks: remarks.filter(Boolean), seconds: this.entries.at(-1).t, position: 0, speed: 1, next: 0 });
  }

  seek(seconds) {
    this.position = Math.min(Math.max(seconds, 0), this.seconds);
    this.next = this.after(this.position);
    this.sampler = new Sampler(this.facts);
    this.publish({ cleared: true });
    const past = this.entries.slice(Math.max(0, this.next - PAST_SAMPLED), this.next);
    for (const entry of past) this.show(entry, entry.n >= this.next - PAST_ENTRIES);
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
    if (this.position >= this.seconds) this.seek(0);
    clearInterval(this.timer);
    let before = performance.now();
    this.timer = setInterval(() => {
      const passed = performance.now() - before;
      before += passed;
      this.advance((passed / 1000) * speed);
    }, STEP_MS);
    this.speed = speed;
    this.showPlayer();
  }

  pause() {
    clearInterval(this.timer);
    this.timer = undefined;
    this.showPlayer();
  }

  advance(seconds) {
    this.position = Math.min(this.position + seconds, this.seconds);
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
