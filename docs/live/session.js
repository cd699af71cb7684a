// What a session with an arm and a recording have in common: the entries that the page shows, explains and saves.

import { Reader, Sampler } from "./entries.js";
import { written } from "./pcapng.js";

// Beyond this the oldest entries are dropped.
export const MOST_ENTRIES = 1_000_000;
const DROPPED_AT_ONCE = 10_000;

export class Session {
  // `publish` gets the news for the page; `port` is the name and the rate of the serial port.
  constructor(publish, facts, streams, port) {
    Object.assign(this, { publish, facts, port, entries: [], dropped: 0 });
    this.reader = new Reader(facts, streams);
    this.sampler = new Sampler(facts);
  }

  add(entries) {
    for (const entry of entries) {
      entry.n = this.dropped + this.entries.push(entry) - 1;
      this.show(entry);
    }
    if (this.entries.length < MOST_ENTRIES + DROPPED_AT_ONCE) return;
    this.entries.splice(0, DROPPED_AT_ONCE);
    this.dropped += DROPPED_AT_ONCE;
  }

  show(entry, listed = true) {
    const message = this.reader.read(entry);
    const sample = this.sampler.take(entry, message);
    this.publish({ entries: listed ? [this.reader.describe(entry, message)] : [], samples: sample ? [sample] : [] });
  }

  explain(number) {
    const entry = this.entries[number - this.dropped];
    if (!entry) throw new Error("this entry is no longer kept");
    return this.reader.explain(entry);
  }

  // Return a recording of the entries that a query selects, as studio/exported.py does.
  exported({ begin, end, direction, command }) {
    const [from, to] = [begin ? Number(begin) : -Infinity, end ? Number(end) : Infinity];
    if (Number.isNaN(from + to) && from !== -to) throw new Error("a time is a number of seconds");
    const chosen = this.entries.filter(
      (entry) =>
        entry.data && entry.t >= from && entry.t < to && (!direction || entry.d === direction) &&
        (!command || this.reader.read(entry)?.command === command),
    );
    return written(chosen, { ...this.port, edition: this.facts.robot.edition, startNs: this.startNs });
  }
}
