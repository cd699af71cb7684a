// What curves and arm show: joints, coordinates, targets, reply times and noise, as studio/samples.py says.

const LONGEST_REPLY_SECONDS = 5;
// An arm that is at most this far from its target has reached it.
const [REACHED_DEGREES, REACHED_MILLIMETRES] = [0.5, 1];

export class Sampler {
  constructor({ places, commands }) {
    Object.assign(this, { places, commands, joints: [], target: [], end: [], sent: new Map() });
  }

  // Return the sample of an entry; undefined: it holds nothing to show.
  take({ t, data, reason }, message) {
    if (reason) return { t, z: data.length };
    const command = this.commands[message?.command];
    if (!command) return undefined;
    const request = message.kind === "request";
    const row = message.fields[command.rows[request ? "request" : "reply"]];
    const found = request ? this.requested(command, message.fields, row) : finite(row) ? this.replied(command, row) : {};
    const since = t - (this.sent.get(message.command) ?? -Infinity);
    if (request) this.sent.set(message.command, t);
    else this.sent.delete(message.command);
    if (!request && since >= 0 && since < LONGEST_REPLY_SECONDS) found.r = since * 1000;
    return Object.keys(found).length ? { t, ...found } : undefined;
  }

  replied({ role }, row) {
    if (role !== "joints" && role !== "coordinates") return {};
    if (role === "joints") this.joints = row;
    const joints = [row, this.target, REACHED_DEGREES];
    const [at, to, distance] = role === "joints" ? joints : [this.endOf(row), this.end, REACHED_MILLIMETRES];
    const reached = to.length && to.every((part, axis) => Math.abs(at[axis] - part) < distance);
    return { [role[0]]: row, ...(reached ? this.noTarget() : {}) };
  }

  requested({ role, one, ends }, fields, row) {
    if (role === "joint targets" && finite(row)) [this.target, this.end] = [row, []];
    else if (role === "joint target" && this.joints.length) {
      const [joint, target] = one.map((name) => fields[name]);
      if (!(joint >= 1 && joint <= this.joints.length)) return {};
      [this.target, this.end] = [(this.target.length ? this.target : this.joints).with(joint - 1, target), []];
    } else if (role === "coordinate targets" && finite(row)) [this.target, this.end] = [[], this.endOf(row)];
    else return ends && (this.target.length || this.end.length) ? this.noTarget() : {};
    const shown = (numbers) => (numbers.length ? numbers : null);
    return { tj: shown(this.target), te: shown(this.end) };
  }

  endOf(row) {
    return [0, 1, 2].map((axis) => row[this.places.indexOf(axis)] ?? 0);
  }

  noTarget() {
    this.target = this.end = [];
    return { tj: null, te: null };
  }
}

const finite = (row) => Array.isArray(row) && row.length > 0 && row.every(Number.isFinite);
