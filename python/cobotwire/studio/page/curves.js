// Draw joints, coordinates, reply times and noise over time, with uPlot, which index.html loads: the global `uPlot`.

import { byId, clock, colour, el, onThemeChange } from "./dom.js";
import { Series } from "./series.js";

const MOST_POINTS = 1200;
const EVERY_MS = 120;
// The least height of a curve, in pixels; the height of the legend is measured.
const LEAST_HEIGHT = 40;
const SIGNS = { degrees: "°", millimetres: "mm" };

export class Curves {
  // `seconds` is the length of a recording; undefined while an arm is watched.
  constructor(robot, seconds) {
    this.seconds = seconds;
    const joints = robot.joints.map((joint) => joint.name);
    const shapes = [
      ["j", "Joints", joints, robot.joints.map((joint) => joint.unit)],
      ["r", "Reply time", ["reply"], ["ms"]],
      ["z", "Noise", ["noise"], ["bytes a second"]],
    ];
    const { coordinates } = robot;
    const named = coordinates.map((coordinate) => coordinate.name);
    if (named.length) shapes.splice(1, 0, ["c", "Coordinates", named, coordinates.map((each) => each.unit)]);
    this.charts = shapes.map((shape) => new Chart(...shape));
    byId("charts").replaceChildren(...this.charts.map((chart) => chart.figure));
    this.now = 0;
    this.dirty = true;
    this.noise = { second: -1, bytes: 0 };
    if (seconds !== undefined) byId("window").value = "Infinity";
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
      if (this.noise.second >= 0) chart.series.append(this.noise.second, [this.noise.bytes]);
      if (empty > 0) chart.series.append(second - 1, [0]);
      this.noise = { second, bytes: 0 };
    }
    this.noise.bytes += sample.z ?? 0;
  }

  draw() {
    if (!this.dirty || document.hidden) return;
    this.dirty = false;
    const span = Number(byId("window").value);
    // The window "all" is as wide as the whole recording, however much of it was played.
    for (const chart of this.charts) chart.draw(this.now, span, this.seconds ?? this.now);
  }

  rebuild() {
    for (const chart of this.charts) chart.build();
    this.dirty = true;
  }
}

class Chart {
  constructor(key, title, names, units) {
    this.key = key;
    this.names = names;
    this.units = units.map((unit) => SIGNS[unit] ?? unit);
    this.series = new Series(names.length);
    const scales = [...new Set(this.units)].filter(Boolean);
    this.caption = el("figcaption", {}, [title, scales.join(" (left) and ") + (scales[1] ? " (right)" : "")].filter(Boolean).join(", "));
    this.place = el("div", { class: "plot" });
    this.figure = el("figure", { class: `chart-${key}` }, this.caption, this.place);
    this.span = [0, 60];
  }

  build() {
    const { clientWidth: width, clientHeight: height } = this.place;
    const made = [width, colour("text")].join();
    if (height < LEAST_HEIGHT || made === this.made) return;
    this.made = made;
    this.plot?.destroy();
    const axis = { stroke: colour("muted"), grid: { stroke: colour("grid"), width: 1 } };
    const ticks = { ticks: { stroke: colour("grid"), width: 1 }, font: "11px system-ui" };
    // Each unit has a scale and an axis of its own: the first left, the second right.
    const scales = [...new Set(this.units)];
    const axes = scales.map((scale, at) => ({ ...axis, ...ticks, scale, size: 42, side: at ? 1 : 3, grid: { ...axis.grid, show: !at } }));
    this.plot = new globalThis.uPlot(
      {
        width,
        height,
        scales: { x: { time: false, range: () => this.span } },
        cursor: { sync: { key: "studio" }, drag: { x: false, y: false } },
        legend: { live: true },
        axes: [
          { ...axis, ...ticks, size: 27, values: (plot, values) => values.map((at) => clock(at)) },
          ...axes,
        ],
        series: [
          { label: "time", value: (plot, at) => (at === null ? "" : clock(at, 2)) },
          ...this.names.map((name, index) => ({
            label: name,
            scale: this.units[index],
            value: (plot, value) => (value === null ? "–" : String(Number(value.toFixed(2)))),
            stroke: colour(this.names.length > 1 ? `series-${index + 1}` : `series-${this.key}`),
            width: 1.5,
            points: { show: false },
            spanGaps: false,
          })),
        ],
      },
      [[], ...this.names.map(() => [])],
      this.place,
    );
    this.legend = this.plot.root.querySelector(".u-legend");
  }

  draw(now, span, end) {
    // An arm of unknown geometry may report no coordinates.
    this.figure.hidden = this.key === "c" && !this.series.length;
    this.build();
    if (!this.plot) return;
    const first = this.series.length ? this.series.times[0] : 0;
    const begin = span === Infinity ? first : Math.max(0, now - span);
    this.span = [begin, span === Infinity ? Math.max(end, begin + 1) : begin + span];
    const data = this.series.since(begin, MOST_POINTS);
    this.plot.setData(data);
    // The legend has a second row if the values need it.
    const height = Math.max(LEAST_HEIGHT, this.place.clientHeight - this.legend.offsetHeight);
    if (height !== this.plot.height) this.plot.setSize({ width: this.plot.width, height });
    // The legend shows the newest values unless the pointer is over a curve.
    if (this.plot.cursor.left < 0 && data[0].length) this.plot.setLegend({ idx: data[0].length - 1 });
  }
}
