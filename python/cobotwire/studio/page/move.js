// Move the arm: a slider and jog buttons for each joint and coordinate, and the other controls.

import { byId, el } from "./dom.js";
import { points } from "./kinematics.js";
import { refusal } from "./permission.js";

const KEEP_MS = 100;
// While a slider is dragged the arm follows with at most five motions a second.
const FOLLOW_MS = 200;
// A joint is marked if it is nearer than this to its limit.
const NEAR_DEGREES = 5;

export class Move {
  constructor(source, state, controls, arm) {
    Object.assign(this, { source, state, controls, arm });
    const { robot } = state;
    this.hold = new Hold(source);
    this.follower = new Follower((error) => this.say(error.message, true));
    this.joints = robot.joints.map((joint, at) => this.axis("joint", "jogJoint", joint, at, robot.limits[at]));
    byId("joints").replaceChildren(...this.joints.map((axis) => axis.item));
    const moved = robot.links.length > 0 && controls.coordinate ? robot.coordinates : [];
    this.coordinates = moved.map((each, at) => this.axis("coordinate", "jogCoordinate", each, at));
    byId("axes").replaceChildren(...this.coordinates.map((axis) => axis.item));
    byId("axes-tab").hidden = moved.length === 0;
    this.wireOthers();
    this.permit();
  }

  get axes() {
    return [...this.joints, ...this.coordinates];
  }

  // Return the names of the joints that are near a limit.
  get near() {
    return this.joints.filter((axis) => axis.isNear).map((axis) => axis.name);
  }

  axis(target, jog, { name, unit }, at, limit) {
    const [control, jogging] = [this.controls[target], this.controls[jog]];
    const range = control?.elements[at] ?? control?.elements[0];
    const [low, high] = limit ?? (range ? [range.low, range.high] : [-180, 180]);
    const place = (used) => (used.arguments.at ? { [used.arguments.at]: String(used.places[at]) } : {});
    const request = (value) => {
      const { joints, targetJoints } = this.state;
      // A command without an argument for the joint takes the targets of all joints.
      const to = control.arguments.at ? value : (targetJoints ?? joints).with(at, value).join(",");
      const values = { ...place(control), [control.arguments.to]: String(to), ...this.speed(control) };
      const { stops } = this.source;
      return () => this.source.send(control.command, values, false, stops);
    };
    return new Axis(name, range?.unit || unit, low, high, {
      limited: target === "joint" && Boolean(limit),
      drag: (value) => {
        this.showGhost(target, at, value);
        if (byId("follow").checked) this.follower.want(request(value));
      },
      drop: control && ((value) => this.send(request(value))),
      jog:
        jogging && this.state.robot.stop
          ? (forward, by) => {
              const direction = forward ? this.controls.forward : this.controls.backward;
              const values = { ...place(jogging), [jogging.arguments.direction]: String(direction) };
              this.say("");
              this.hold.start(by, jogging.command, { ...values, ...this.speed(jogging) });
            }
          : null,
      release: (by) => this.hold.end(by),
      step: (by) => this.focus(target === "joint" ? this.joints : this.coordinates, at + by),
    });
  }

  focus(axes, at) {
    axes.at(at % axes.length).slider.focus();
  }

  speed(control) {
    return control.arguments.speed ? { [control.arguments.speed]: byId("speed-of-motion").value } : {};
  }

  // Show where the arm would be with one joint or coordinate at a value.
  showGhost(target, at, value) {
    const { robot, targetJoints, joints, coordinates } = this.state;
    const from = target === "joint" ? (targetJoints ?? joints) : coordinates;
    if (!from || !robot.links.length) return;
    const goal = from.with(at, value);
    if (target === "joint") this.arm.preview(points(robot.links, goal));
    else this.arm.preview(null, goal.slice(0, 3));
  }

  async send(request) {
    this.follower.want(null);
    this.say("sending");
    try {
      await request();
      this.say("sent");
    } catch (error) {
      this.say(error.message, true);
    }
    this.arm.preview(null);
  }

  say(text, problem = false) {
    byId("move-status").textContent = text;
    byId("move-status").classList.toggle("problem", problem);
  }

  wireOthers() {
    const { controls } = this;
    byId("speed-of-motion").addEventListener("input", () => this.showSpeed());
    if (controls.speeds) byId("speed-of-motion").max = controls.speeds.high;
    this.showSpeed();
    const simple = (id, control, values) => {
      byId(id).hidden = !control;
      if (control) byId(id).addEventListener("click", () => this.send(() => this.source.send(control.command, values(control))));
    };
    simple("home", controls.home && controls.joints, (used) => ({ [used.arguments.to]: controls.home.join(","), ...this.speed(used) }));
    simple("power", controls.power, () => ({}));
    const opening = (value) => (used) => ({ [used.arguments.to]: String(value()), ...this.speed(used) });
    const range = controls.gripper?.elements[0];
    simple("open", controls.gripper, opening(() => range.high));
    simple("close", controls.gripper, opening(() => range.low));
    byId("gripper-label").hidden = byId("gripper-of").hidden = !controls.gripper;
    byId("gripper").addEventListener("change", () => {
      const chosen = opening(() => byId("gripper").value)(controls.gripper);
      this.send(() => this.source.send(controls.gripper.command, chosen));
    });
    byId("light-label").hidden = !controls.light;
    byId("light").addEventListener("change", () => {
      const part = (at) => String(Number.parseInt(byId("light").value.slice(at, at + 2), 16));
      const values = { red: part(1), green: part(3), blue: part(5) };
      this.send(() => this.source.send(controls.light.command, values));
    });
    for (const event of ["blur", "pagehide"]) window.addEventListener(event, () => this.hold.end());
    document.addEventListener("visibilitychange", () => this.hold.end());
  }

  showSpeed() {
    byId("speed-shown").textContent = `${byId("speed-of-motion").value} %`;
  }

  // Enable what may be sent now, and say in words why the rest may not.
  permit() {
    const why = refusal(this.state);
    byId("move-why").textContent = why;
    byId("move-why").hidden = why === "";
    byId("controls-of-arm").disabled = why !== "";
    if (why) this.cancel();
  }

  // Forget what is dragged or held, since the arm was stopped.
  cancel() {
    this.hold.end();
    this.follower.want(null);
    for (const axis of this.axes) axis.cancel();
    this.arm.preview(null);
  }

  show({ joints, coordinates, targetJoints }) {
    this.joints.forEach((axis, at) => axis.show(joints?.[at], targetJoints?.[at]));
    this.coordinates.forEach((axis, at) => axis.show(coordinates?.[at]));
  }
}

// Keeps a motion going while a button or a key is held.
class Hold {
  constructor(source) {
    this.source = source;
    this.timer = this.by = null;
  }

  // `by` is the element that is held.
  start(by, command, values) {
    this.end();
    if (!this.source.wish("hold", { command, arguments: values })) return;
    this.by = by;
    this.timer = setInterval(() => this.source.wish("keep"), KEEP_MS);
  }

  // End the motion that an element holds, or any.
  end(by = this.by) {
    if (this.timer === null || by !== this.by) return;
    clearInterval(this.timer);
    this.timer = null;
    this.source.wish("release");
  }
}

// Sends the newest of the requests that are wanted: one at a time, and not too many a second.
class Follower {
  constructor(onError) {
    this.onError = onError;
    this.next = null;
    this.busy = false;
  }

  async want(request) {
    this.next = request;
    if (this.busy) return;
    this.busy = true;
    while (this.next) {
      const send = this.next;
      this.next = null;
      const pause = new Promise((go) => setTimeout(go, FOLLOW_MS));
      await Promise.all([send().catch(this.onError), pause]);
    }
    this.busy = false;
  }
}

// A joint or a coordinate: where it is, where it goes, and the controls that move it.
class Axis {
  constructor(name, unit, low, high, actions) {
    Object.assign(this, { name, low, high, actions });
    this.dragged = this.cancelled = this.isNear = false;
    const sign = { degrees: "°", millimetres: "mm" }[unit] ?? unit;
    this.mark = el("span", { class: "mark" });
    const range = { type: "range", min: low, max: high, step: 0.1, value: Math.max(low, Math.min(0, high)) };
    this.slider = el("input", {
      ...range,
      "aria-label": `Target of ${name}, ${unit || "no unit"}`,
      pointerdown: () => (this.cancelled = false),
      input: () => this.drag(),
      change: () => this.drop(Number(this.slider.value)),
    });
    this.box = el("input", { type: "number", step: "any", "aria-label": `${name}, ${unit || "no unit"}` });
    this.box.addEventListener("keydown", (event) => {
      if (event.key === "Enter" && actions.drop) actions.drop(this.box.value);
    });
    this.item = el(
      "li",
      { class: "axis", title: `${name}: ${round(low)} … ${round(high)} ${sign}` },
      el("span", { class: "name" }, name),
      this.jogButton("−", false),
      el("span", { class: "track" }, this.mark, this.slider),
      this.jogButton("+", true),
      this.box,
      el("span", { class: "unit" }, sign),
    );
    this.slider.disabled = this.box.disabled = !actions.drop;
    this.item.addEventListener("keydown", (event) => this.key(event));
    for (const ends of ["keyup", "focusout"]) this.item.addEventListener(ends, () => actions.release(this.item));
  }

  jogButton(label, forward) {
    const { jog, release } = this.actions;
    const button = el("button", { type: "button", class: "jog", disabled: !jog, "aria-label": `Jog ${this.name} ${label}, while held` }, label);
    button.addEventListener("pointerdown", (event) => {
      if (event.button) return;
      button.setPointerCapture(event.pointerId);
      jog(forward, button);
    });
    for (const ends of ["pointerup", "pointercancel", "lostpointercapture"]) button.addEventListener(ends, () => release(button));
    // A long press on a phone would open a menu.
    button.addEventListener("contextmenu", (event) => event.preventDefault());
    return button;
  }

  // Arrows left and right jog while they are held; up and down choose another one.
  key(event) {
    const { jog, step } = this.actions;
    const onButton = event.target.classList.contains("jog");
    const forward = onButton && event.key === "Enter" ? event.target.textContent === "+" : event.key === "ArrowRight";
    if (event.key === "ArrowUp" || event.key === "ArrowDown") step(event.key === "ArrowUp" ? -1 : 1);
    else if (event.key === "ArrowLeft" || event.key === "ArrowRight" || (onButton && event.key === "Enter")) {
      if (event.target === this.box) return;
      if (!event.repeat && jog) jog(forward, this.item);
    } else if (event.target !== this.slider || (event.key !== "Home" && event.key !== "End")) return;
    // Home and End would send the joint to its limit.
    event.preventDefault();
  }

  drag() {
    if (this.cancelled) return;
    this.dragged = true;
    this.box.value = this.slider.value;
    this.actions.drag(Number(this.slider.value));
  }

  drop(value) {
    if (!this.cancelled) this.actions.drop(value);
    this.dragged = this.cancelled = false;
  }

  cancel() {
    this.cancelled = this.dragged;
  }

  show(value, target) {
    if (!Number.isFinite(value)) return;
    const part = (at) => `${(100 * (Math.min(Math.max(at, this.low), this.high) - this.low)) / (this.high - this.low)}%`;
    this.mark.style.left = part(value);
    const left = Math.min(value - this.low, this.high - value);
    this.isNear = this.actions.limited && left < NEAR_DEGREES;
    this.item.classList.toggle("near", this.isNear);
    this.item.classList.toggle("beyond", this.isNear && left < 0);
    if (this.dragged) return;
    this.slider.value = Number.isFinite(target) ? target : value;
    if (document.activeElement !== this.box) this.box.value = value.toFixed(2);
  }
}

const round = (value) => String(Math.round(value * 10) / 10);
