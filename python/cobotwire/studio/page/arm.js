// Draw the arm in 3D on a canvas: links, joints, the target and the path of the end.
//
// Ten tubes need no scene graph and no WebGL, which remote desktops and small computers often lack.

import { byId, colour, oncePerFrame, onThemeChange } from "./dom.js";
import { points } from "./kinematics.js";

const PATH_POINTS = 600;
const VIEWS = {
  free: [-0.75, 0.42],
  front: [0, 0.02],
  side: [-Math.PI / 2, 0.02],
  top: [-Math.PI / 2, 1.55],
};
const STEP = 0.12;

export class ArmView {
  constructor(robot) {
    this.canvas = byId("arm-canvas");
    this.links = robot.links;
    this.reach = robot.reach || 500;
    [this.yaw, this.pitch] = VIEWS.free;
    this.zoom = 1;
    this.near = false;
    this.redraw = oncePerFrame(() => this.draw());
    this.clear();
    this.listen();
    onThemeChange(this.redraw);
    new ResizeObserver(this.redraw).observe(this.canvas);
  }

  clear() {
    this.points = this.targetPoints = this.targetEnd = this.ghost = this.ghostEnd = null;
    this.path = [];
    this.redraw();
  }

  moved(joints) {
    if (!this.links.length) return;
    this.points = points(this.links, joints);
    this.extend(this.points.at(-1));
  }

  // Show the target of the joints, or of the end; null: there is none.
  show(targetJoints, targetEnd, near) {
    this.targetPoints = targetJoints && this.links.length ? points(this.links, targetJoints) : null;
    this.targetEnd = targetEnd;
    this.near = near;
    this.redraw();
  }

  // Show where the arm would be, or its end, while a slider is dragged.
  preview(ghost, end = null) {
    [this.ghost, this.ghostEnd] = [ghost, end];
    this.redraw();
  }

  extend(end) {
    const last = this.path.at(-1);
    if (last && Math.hypot(...end.map((part, axis) => part - last[axis])) < 1) return;
    this.path.push(end);
    if (this.path.length > PATH_POINTS) this.path.shift();
  }

  describe(text) {
    this.canvas.setAttribute("aria-label", text);
  }

  listen() {
    for (const button of byId("views").children) {
      button.addEventListener("click", () => this.turn(...VIEWS[button.dataset.view]));
    }
    const pointers = new Map();
    this.canvas.addEventListener("pointerdown", (event) => {
      this.canvas.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, [event.clientX, event.clientY]);
    });
    const drop = (event) => pointers.delete(event.pointerId);
    this.canvas.addEventListener("pointerup", drop);
    this.canvas.addEventListener("pointercancel", drop);
    this.canvas.addEventListener("pointermove", (event) => {
      const before = pointers.get(event.pointerId);
      if (!before || pointers.size > 1) return;
      pointers.set(event.pointerId, [event.clientX, event.clientY]);
      const [dx, dy] = [event.clientX - before[0], event.clientY - before[1]];
      this.turn(this.yaw - dx / 120, this.pitch + dy / 120);
    });
    this.canvas.addEventListener(
      "wheel",
      (event) => {
        event.preventDefault();
        this.scale(Math.exp(-event.deltaY / 600));
      },
      { passive: false },
    );
    const keys = {
      ArrowLeft: () => this.turn(this.yaw - STEP, this.pitch),
      ArrowRight: () => this.turn(this.yaw + STEP, this.pitch),
      ArrowUp: () => this.turn(this.yaw, this.pitch + STEP),
      ArrowDown: () => this.turn(this.yaw, this.pitch - STEP),
      "+": () => this.scale(1.1),
      "-": () => this.scale(1 / 1.1),
    };
    this.canvas.addEventListener("keydown", (event) => {
      if (!(event.key in keys)) return;
      event.preventDefault();
      keys[event.key]();
    });
  }

  turn(yaw, pitch) {
    this.yaw = yaw;
    this.pitch = Math.min(1.55, Math.max(-0.3, pitch));
    this.redraw();
  }

  scale(factor) {
    this.zoom = Math.min(4, Math.max(0.4, this.zoom * factor));
    this.redraw();
  }

  // Return x and y on the canvas, the distance, and the scale there.
  project([x, y, z]) {
    const height = z - this.reach * 0.4;
    const [cy, sy] = [Math.cos(this.yaw), Math.sin(this.yaw)];
    const [cp, sp] = [Math.cos(this.pitch), Math.sin(this.pitch)];
    // The camera looks along +y of the turned frame.
    const right = x * cy + y * sy;
    const deep = -x * sy + y * cy;
    const depth = deep * cp - height * sp;
    const up = height * cp + deep * sp;
    const far = this.reach * 3.4;
    const scale = ((this.size * this.zoom) / this.reach) * 0.94 * (far / (far + depth));
    return [this.width / 2 + right * scale, this.height / 2 - up * scale, depth, scale];
  }

  draw() {
    const { canvas } = this;
    const ratio = window.devicePixelRatio || 1;
    [this.width, this.height] = [canvas.clientWidth, canvas.clientHeight];
    if (!this.width) return;
    canvas.width = Math.round(this.width * ratio);
    canvas.height = Math.round(this.height * ratio);
    this.size = Math.min(this.width, this.height * 1.15);
    const pen = (this.pen = canvas.getContext("2d"));
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.lineCap = pen.lineJoin = "round";
    this.drawGround();
    this.drawPath();
    const [ghost, end] = [this.ghost ?? this.targetPoints, this.ghostEnd ?? this.targetEnd];
    if (ghost) this.drawGhost(ghost);
    if (end) this.drawCross(end);
    if (this.points) this.drawArm(this.points);
  }

  line(points, style, width) {
    const { pen } = this;
    pen.beginPath();
    points.forEach((point, index) => {
      const [x, y] = this.project(point);
      if (index) pen.lineTo(x, y);
      else pen.moveTo(x, y);
    });
    pen.strokeStyle = style;
    pen.lineWidth = width;
    pen.stroke();
  }

  drawGround() {
    const cell = this.reach > 1200 ? 200 : 100;
    const edge = Math.ceil((this.reach * 0.8) / cell) * cell;
    for (let at = -edge; at <= edge; at += cell) {
      const style = colour(at === 0 ? "grid-strong" : "grid");
      this.line([[at, -edge, 0], [at, edge, 0]], style, 1);
      this.line([[-edge, at, 0], [edge, at, 0]], style, 1);
    }
    this.line([[0, 0, 0], [cell, 0, 0]], colour("axis-x"), 2.5);
    this.line([[0, 0, 0], [0, cell, 0]], colour("axis-y"), 2.5);
    this.line([[0, 0, 0], [0, 0, cell]], colour("axis-z"), 2.5);
  }

  drawPath() {
    if (this.path.length < 2) return;
    this.pen.globalAlpha = 0.9;
    this.line(this.path, colour("path"), 1.75);
    this.pen.globalAlpha = 1;
  }

  drawGhost(points) {
    this.pen.globalAlpha = 0.25;
    this.line(points, colour("target"), this.thickness(points[0]) * 0.8);
    this.pen.globalAlpha = 1;
    this.pen.setLineDash([5, 5]);
    this.line(points, colour("target"), 2.5);
    this.pen.setLineDash([]);
    this.drawCross(points.at(-1));
  }

  drawCross([x, y, z]) {
    const arm = this.reach * 0.03;
    const style = colour("target");
    this.line([[x - arm, y, z], [x + arm, y, z]], style, 2.5);
    this.line([[x, y - arm, z], [x, y + arm, z]], style, 2.5);
    this.line([[x, y, z - arm], [x, y, z + arm]], style, 2.5);
  }

  drawArm(points) {
    // The shadow on the ground shows where the arm is.
    this.pen.globalAlpha = 0.1;
    this.line(points.map(([x, y]) => [x, y, 0]), colour("text"), this.thickness(points[0]) * 0.6);
    this.pen.globalAlpha = 1;
    const parts = [];
    points.forEach((point, index) => {
      const [, , depth] = this.project(point);
      parts.push({ depth: depth - this.reach * 0.01, draw: () => this.drawJoint(point, index, points) });
      if (index === 0) return;
      const before = points[index - 1];
      const middle = point.map((part, axis) => (part + before[axis]) / 2);
      parts.push({ depth: this.project(middle)[2], draw: () => this.drawLink(before, point) });
    });
    parts.sort((one, other) => other.depth - one.depth);
    for (const part of parts) part.draw();
  }

  thickness(point) {
    return Math.max(4, this.project(point)[3] * this.reach * 0.052);
  }

  drawLink(from, to) {
    const width = this.thickness(to);
    this.line([from, to], colour("link-edge"), width + 2);
    this.line([from, to], colour("link"), width);
    this.line([from, to], colour("link-shine"), width * 0.35);
  }

  drawJoint(point, index, points) {
    const { pen } = this;
    const [x, y] = this.project(point);
    const last = index === points.length - 1;
    const radius = this.thickness(point) * (index === 0 ? 0.95 : last ? 0.5 : 0.66);
    pen.beginPath();
    pen.arc(x, y, radius, 0, 2 * Math.PI);
    pen.fillStyle = colour(last ? "end" : this.near ? "near" : "joint");
    pen.fill();
    pen.strokeStyle = colour("link-edge");
    pen.lineWidth = 1.5;
    pen.stroke();
  }
}
