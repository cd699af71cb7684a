// Draw joints, coordinates, reply times and noise over time, with uPlot.

import uPlot from "./vendor/uPlot.esm.js";
import { byId, clock, colour, el, onThemeChange } from "./dom.js";
import { Series } from "./series.js";

const MOST_POINTS = 1200;
const EVERY_MS = 120;
const HEIGHT = 128;

export class Curves {
  constructor(robot) {
    const joints = robot.joints.map((joint) => joint.name);
    const named = robot.coordinates.map((coordinate) => coordinate.name);
    const shapes = [
      ["j", `Joints${unit(robot.joints)}`, joints],
      ["r", "Reply time, milliseconds", ["reply"]],
      ["z", "Noise, bytes a second", ["noise"]],
    ];
    if (named.length) shapes.splice(1, 0, ["c", `Coordinates${unit(robot.coordinates)}`, named]);
    this.charts = shapes.map(([key, title, names]) => new Chart(key, title, names));
    byId("charts").replaceChildren(...this.charts.map((chart) => chart.figure));
    this.now = 0;
    this.dirty = true;
    this.noise = { second: -1, bytes: 0 };
    byId("window").addEventListener("change", () => (this.dirty = true));
    onThemeChange(() => this.rebuild());
    new ResizeObserver(() => this.rebuild()).observe(byId("charts"));
    setInterval(() => this.draw(), EVERY_MS);
  }

  clear() {
    for (const chart of this.charts) chart.series.clear();
    this.noise = { second: -1, bytes: 0 };
    this.now = 0;
    this.dirty = true;
  }

  add(sample) {
    this.now = Math.max(this.now, sample.t);
    for (const chart of this.charts) {
      const value = sample[chart.key];
      if (value === undefined || chart.key === "z") continue;
      chart.series.push(sample.t, Array.isArray(value) ? value : [value]);
    }
    this.addNoise(sample);
    this.dirty = true;
  }

  // Noise is summed up for each second, so that a quiet line shows zero.
  addNoise(sample) {
    const second = Math.floor(sample.t);
    const chart = this.charts.at(-1);
    if (second > this.noise.second) {
      const empty = Math.min(second - this.noise.second - 1, 2);
      if (this.noise.second >= 0) chart.series.push(this.noise.second, [this.noise.bytes]);
      if (empty > 0) chart.series.push(second - 1, [0]);
      this.noise = { second, bytes: 0 };
    }
    this.noise.bytes += sample.z ?? 0;
  }

  draw() {
    if (!this.dirty || document.hidden) return;
    this.dirty = false;
    const span = Number(byId("window").value);
    for (const chart of this.charts) chart.draw(this.now, span);
  }

  rebuild() {
    for (const chart of this.charts) chart.build();
    this.dirty = true;
  }
}

class Chart {
  constructor(key, title, names) {
    this.key = key;
    this.names = names;
    this.series = new Series(names.length);
    this.caption = el("figcaption", {}, title);
    this.place = el("div", { class: "plot" });
    this.figure = el("figure", {}, this.caption, this.place);
    this.span = [0, 60];
  }

  build() {
    const width = this.place.clientWidth;
    if (!width || (this.plot && this.plot.width === width && this.theme === colour("text"))) return;
    this.theme = colour("text");
    this.plot?.destroy();
    const axis = { stroke: colour("muted"), grid: { stroke: colour("grid"), width: 1 } };
    const ticks = { ticks: { stroke: colour("grid"), width: 1 }, font: "11px system-ui" };
    this.plot = new uPlot(
      {
        width,
        height: this.key === "j" ? HEIGHT + 40 : HEIGHT,
        scales: { x: { time: false, range: () => this.span } },
        cursor: { sync: { key: "studio" }, drag: { x: false, y: false } },
        legend: { live: true },
        axes: [
          { ...axis, ...ticks, size: 24, values: (plot, values) => values.map((at) => clock(at)) },
          { ...axis, ...ticks, size: 46 },
        ],
        series: [
          { label: "time", value: (plot, at) => (at === null ? "" : clock(at, 2)) },
          ...this.names.map((name, index) => ({
            label: name,
            stroke: colour(this.names.length > 1 ? `series-${index + 1}` : `series-${this.key}`),
            width: 1.5,
            points: { show: false },
            spanGaps: true,
          })),
        ],
      },
      [[], ...this.names.map(() => [])],
      this.place,
    );
  }

  draw(now, span) {
    this.build();
    if (!this.plot) return;
    const first = this.series.length ? this.series.times[0] : 0;
    const begin = span === Infinity ? first : Math.max(0, now - span);
    this.span = [begin, span === Infinity ? Math.max(now, begin + 1) : begin + span];
    this.plot.setData(this.series.since(begin, MOST_POINTS));
  }
}

function unit(numbers) {
  const units = [...new Set(numbers.map((number) => number.unit).filter(Boolean))];
  return units.length ? `, ${units.join(" and ")}` : "";
}
