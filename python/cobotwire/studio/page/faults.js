// Choose a fault scenario of the simulated arm, and see what it does.

import { byId, clock, el } from "./dom.js";

const SHOWN = 12;
const NO_FAULTS = "The simulated arm replies as it should.";

export class Faults {
  constructor(source, scenarios, notify) {
    this.scenarios = scenarios;
    const options = scenarios.map(({ name }) => el("option", { value: name }, name));
    byId("scenario").replaceChildren(el("option", { value: "" }, "no faults"), ...options);
    byId("scenario").addEventListener("input", () => this.describe(byId("scenario").value));
    byId("begin").addEventListener("click", async () => {
      try {
        await source.scenario(byId("scenario").value);
        byId("injected").replaceChildren();
        this.shown = [];
      } catch (error) {
        notify(error.message);
      }
    });
    this.shown = [];
    this.running = null;
  }

  describe(name) {
    const about = this.scenarios.find((each) => each.name === name)?.about;
    const now = this.running === name ? "" : " Not applied yet.";
    byId("about").textContent = `${about ?? NO_FAULTS}${now}`;
  }

  // Show the scenario that runs. While it stays the same, the choice of the user is kept.
  run(name) {
    if (name === this.running) return;
    this.running = name;
    byId("faults").classList.toggle("running", name !== "");
    byId("scenario").value = name;
    this.describe(name);
  }

  add(entries) {
    const remarks = entries.filter((entry) => entry.k === "remark");
    if (!remarks.length) return;
    this.shown = [...remarks.reverse(), ...this.shown].slice(0, SHOWN);
    const items = this.shown.map((entry) =>
      el("li", {}, el("span", { class: "time" }, clock(entry.t, 2)), ` ${entry.l}: ${entry.x}`),
    );
    byId("injected").replaceChildren(...items);
  }
}
