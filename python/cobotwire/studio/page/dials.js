// Show each joint as a dial: its limits, where it is, where it goes.

import { byId, el, svg } from "./dom.js";

// A joint that is nearer to its limit is marked.
export const NEAR_DEGREES = 5;
const SIZE = 64;

export class Dials {
  constructor(robot) {
    this.dials = robot.joints.map((joint, index) => new Dial(joint, robot.limits[index]));
    byId("dials").replaceChildren(...this.dials.map((dial) => dial.item));
  }

  show(angles, targets) {
    this.dials.forEach((dial, index) => {
      dial.show(angles?.[index]);
      dial.target(targets?.[index]);
    });
  }
}

class Dial {
  constructor(joint, limit) {
    this.limit = limit;
    const middle = SIZE / 2;
    this.needle = svg("line", { x1: middle, y1: middle, x2: middle, y2: 10, class: "needle" });
    this.goal = svg("line", { x1: middle, y1: 13, x2: middle, y2: 3, class: "goal" });
    this.goal.setAttribute("visibility", "hidden");
    const [low, high] = limit ?? [-180, 180];
    const drawing = svg(
      "svg",
      { viewBox: `0 0 ${SIZE} ${SIZE}`, "aria-hidden": "true" },
      svg("circle", { cx: middle, cy: middle, r: 25, class: "rim" }),
      svg("path", { d: arc(low, high), class: "range" }),
      this.goal,
      this.needle,
      svg("circle", { cx: middle, cy: middle, r: 3.5, class: "hub" }),
    );
    this.value = el("span", { class: "value" }, "–");
    this.warning = el("span", { class: "warning" });
    const range = limit ? `${format(low)} … ${format(high)}°` : "no limit stated";
    this.item = el(
      "li",
      {},
      drawing,
      el("span", { class: "name" }, joint.name),
      this.value,
      el("span", { class: "range" }, range),
      this.warning,
    );
  }

  show(angle) {
    if (!Number.isFinite(angle)) return;
    turn(this.needle, angle);
    this.value.textContent = `${angle.toFixed(2)}°`;
    const near = this.limit && Math.min(angle - this.limit[0], this.limit[1] - angle);
    const isNear = this.limit !== undefined && near < NEAR_DEGREES;
    this.item.classList.toggle("near", isNear);
    this.warning.textContent = isNear ? (near < 0 ? "beyond its limit" : "near its limit") : "";
  }

  target(angle) {
    const shown = Number.isFinite(angle);
    this.goal.setAttribute("visibility", shown ? "visible" : "hidden");
    if (shown) turn(this.goal, angle);
  }
}

const turn = (line, angle) => line.setAttribute("transform", `rotate(${angle} ${SIZE / 2} ${SIZE / 2})`);

const format = (angle) => String(Math.round(angle * 10) / 10);

function arc(low, high) {
  const at = (angle) => {
    const radians = ((angle - 90) * Math.PI) / 180;
    return `${SIZE / 2 + 25 * Math.cos(radians)} ${SIZE / 2 + 25 * Math.sin(radians)}`;
  };
  const end = Math.min(high, low + 359.9);
  return `M ${at(low)} A 25 25 0 ${end - low > 180 ? 1 : 0} 1 ${at(end)}`;
}
