// Send commands: a form for each, the frame before it is sent, and the result.

import { byId, el } from "./dom.js";
import { explanation } from "./details.js";
import { refusal } from "./permission.js";

const PREVIEW_MS = 150;

export class Send {
  constructor(source, state) {
    this.source = source;
    this.state = state;
    this.commands = [];
    byId("find").addEventListener("input", () => this.list());
    byId("command").addEventListener("input", () => this.build());
    byId("form").addEventListener("submit", (event) => {
      event.preventDefault();
      this.send();
    });
    byId("form").addEventListener("input", () => this.later());
  }

  async load() {
    if (this.commands.length) return;
    this.commands = await this.source.commands();
    this.list();
  }

  list() {
    const words = byId("find").value.toLowerCase().split(/\s+/).filter(Boolean);
    const fits = (command) => {
      const text = `${command.name} ${command.title} ${command.family}`.toLowerCase();
      return words.every((word) => text.includes(word));
    };
    const found = this.commands.filter(fits);
    const before = byId("command").value;
    const groups = [...new Set(found.map((command) => command.family))].map((family) =>
      el(
        "optgroup",
        { label: family },
        ...found
          .filter((command) => command.family === family)
          .map((command) => el("option", { value: command.name }, command.name)),
      ),
    );
    byId("command").replaceChildren(...groups);
    const names = found.map((command) => command.name);
    const usual = found.find((command) => command.role === "joints")?.name ?? names[0] ?? "";
    byId("command").value = names.includes(before) ? before : usual;
    if (byId("command").value !== before) this.build();
  }

  get command() {
    return this.commands.find((command) => command.name === byId("command").value);
  }

  build() {
    const { command } = this;
    if (!command) return byId("form").replaceChildren(el("p", {}, "No command has these words."));
    this.inputs = command.arguments.map((argument) => new Input(argument));
    const fill = this.filler(command);
    this.preview = el("div", { class: "preview" });
    this.button = el("button", { type: "submit", class: "primary" }, "Send");
    this.why = el("p", { class: "hint" });
    this.result = el("p", { class: "result", role: "status" });
    this.force = el("input", { type: "checkbox" });
    const force = el("label", { class: "check" }, this.force, " send even if the arm would not obey");
    byId("form").replaceChildren(
      el("p", {}, `${command.doc} `, el("em", { class: "safety" }, command.safety)),
      ...command.notes.map((note) => el("p", { class: "hint" }, note)),
      ...this.inputs.map((input) => input.field),
      ...(fill ? [fill] : []),
      ...(command.moves ? [force] : []),
      this.preview,
      el("div", { class: "go" }, this.button, this.why),
      this.result,
    );
    for (const input of this.inputs) input.follow(this.inputs);
    this.permit();
    this.later();
  }

  // A button that writes where the arm is now into the form, so that a target starts from there.
  filler(command) {
    const key = { "joint targets": "joints", "coordinate targets": "coordinates" }[command.role];
    const input = this.inputs.find((each) => each.argument.many);
    if (!key || !input) return null;
    const fill = () => {
      if (!this.state[key]) return;
      input.fill(this.state[key]);
      this.later();
    };
    return el("button", { type: "button", click: fill }, "Fill in where the arm is");
  }

  // Show whether the command may be sent now, and if not, why.
  permit() {
    const { command } = this;
    if (!command || !this.button) return;
    const why = refusal(this.state, command.safety === "query");
    this.button.disabled = why !== "";
    this.why.textContent = why;
  }

  values() {
    return Object.fromEntries(this.inputs.map((input) => [input.argument.name, input.value]));
  }

  later() {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.showFrame(), PREVIEW_MS);
  }

  async showFrame() {
    const { command, preview } = this;
    if (!command) return;
    let shown;
    try {
      const found = await this.source.preview(command.name, this.values());
      shown = [el("h3", {}, "The frame"), ...explanation(found, false)];
    } catch (error) {
      shown = [el("p", { class: "problem" }, error.message)];
    }
    if (preview === this.preview) preview.replaceChildren(...shown);
  }

  async send() {
    const { command, result, button } = this;
    button.disabled = true;
    result.textContent = "sending";
    result.classList.remove("problem");
    try {
      const reply = await this.source.send(command.name, this.values(), this.force.checked);
      result.textContent = reply === null ? "sent" : format(reply);
    } catch (error) {
      result.textContent = error.message;
      result.classList.add("problem");
    }
    this.permit();
  }
}

function format(reply) {
  if (typeof reply !== "object") return String(reply);
  if (Array.isArray(reply)) return reply.map(format).join(", ");
  return Object.entries(reply).map(([name, value]) => `${name} ${format(value)}`).join("   ");
}

// One argument of a command: a box for each of its numbers, a list of choices, or a text.
class Input {
  constructor(argument) {
    this.argument = argument;
    this.place = el("div", { class: "boxes" });
    const optional = argument.optional ? " (optional)" : "";
    const doc = argument.doc ? el("span", { class: "hint" }, argument.doc) : "";
    this.field = el("fieldset", {}, el("legend", {}, `${argument.name}${optional} `, doc), this.place);
    this.fit(argument.elements ?? []);
  }

  // A selector decides the units and ranges of another argument.
  follow(inputs) {
    const selector = inputs.find((input) => input.argument.name === this.argument.selector);
    if (!selector) return;
    const refit = () => {
      const chosen = Number(selector.value);
      const found = this.argument.cases.find((each) => each.when.includes(chosen));
      if (found) this.fit(found.elements);
    };
    selector.field.addEventListener("input", refit);
    refit();
  }

  fit(elements) {
    const { choices, kind, list } = this.argument;
    const before = this.boxes?.map((box) => box.value);
    if (choices?.length && elements.length < 2) this.boxes = [this.choice(choices)];
    else if (elements.length && !list) this.boxes = elements.map((each) => this.number(each));
    else this.boxes = [this.text(kind)];
    if (before?.length === this.boxes.length) this.boxes.forEach((box, at) => (box.value = before[at]));
    this.place.replaceChildren(...this.boxes.map((box) => box.parentElement));
  }

  choice(choices) {
    const blank = this.argument.optional ? [el("option", { value: "" }, "default")] : [];
    const options = choices.map(({ value, label }) => el("option", { value }, label));
    return labelled(this.argument.name, el("select", {}, ...blank, ...options));
  }

  number({ name, unit, low, high, step }) {
    const type = { type: "number", step, placeholder: "" };
    const range = low === null ? {} : { min: low, max: high };
    const box = el("input", { ...type, ...range });
    const usual = low !== null && (low > 0 || high < 0) ? low : 0;
    box.value = this.argument.optional ? "" : String(usual);
    const shown = low === null ? unit : `${round(low)} … ${round(high)} ${unit}`;
    return labelled(name || this.argument.name, box, shown);
  }

  text(kind) {
    const hint = { bytes: "pairs of hex digits", text: "text" }[kind] ?? "1,2 or 1,2;3,4";
    return labelled(this.argument.name, el("input", { type: "text", placeholder: hint }));
  }

  fill(values) {
    this.boxes.forEach((box, at) => (box.value = values[at] ?? box.value));
  }

  get value() {
    return this.boxes.map((box) => box.value.trim()).join(",").replace(/^,+$/, "");
  }
}

function labelled(name, box, hint = "") {
  el("label", { class: "box" }, el("span", {}, name), box, el("span", { class: "hint" }, hint));
  return box;
}

const round = (value) => String(Math.round(value * 1000) / 1000);
