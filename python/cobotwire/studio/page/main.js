// Put the parts of the page together, and pass on what the server sends.

import { ArmView } from "./arm.js";
import { Curves } from "./curves.js";
import { Details } from "./details.js";
import { Dials } from "./dials.js";
import { byId } from "./dom.js";
import { wireExport } from "./export.js";
import { Faults } from "./faults.js";
import { Line } from "./line.js";
import { Player } from "./player.js";
import { Send } from "./send.js";
import { Server } from "./server.js";

// What the parts need to know of each other.
const state = { mine: false, motion: false, motionPermitted: false, lost: false };
let parts = null;
let stops = 0;

const server = new Server(take, connected);
const details = new Details(server);
const line = new Line((number) => details.show(number));
const send = new Send(server, state);
wireExport(server);
wireControls();

function take({ entries, samples, states }) {
  if (states.hello) begin(states.hello);
  if (states.cleared) clear();
  if (states.lost) line.lost = states.lost;
  if (states.port) showPort(states.port);
  if (states.control) showControl(states.control);
  if (states.scenario !== undefined) parts?.faults?.run(states.scenario);
  if (states.player) parts?.player?.show(states.player);
  if (states.stopped) showStopped(states.stopped);
  if (states.refused) notify(states.refused);
  if (!parts) return;
  for (const sample of samples) show(sample);
  if (samples.length) summarize();
  if (entries.length) {
    line.add(entries);
    parts.faults?.add(entries);
  }
}

function begin(hello) {
  server.page = hello.page;
  state.motionPermitted = hello.motionPermitted;
  state.robot = hello.robot;
  const recorded = hello.mode === "recording";
  document.body.classList.toggle("recorded", recorded);
  byId("player").hidden = !recorded;
  byId("faults").hidden = !hello.simulated;
  const what = hello.simulated ? "a simulated arm" : hello.recording?.name || hello.url;
  byId("source").textContent = `${what} · edition ${hello.robot.edition}`;
  byId("source").title = hello.url;
  byId("stop").disabled = hello.robot.stop === "";
  byId("stop").title = hello.robot.stop ? "" : "This edition has no stop.";
  byId("no-geometry").hidden = !hello.robot.noGeometry;
  byId("no-geometry").textContent = `Drawn as dials: ${hello.robot.noGeometry}.`;
  byId("scene").hidden = Boolean(hello.robot.noGeometry);
  byId("views").hidden = Boolean(hello.robot.noGeometry);
  byId("dials").classList.toggle("large", Boolean(hello.robot.noGeometry));
  // After a new connection the server sends the past again.
  if (parts) clear();
  else parts = make(hello, recorded);
  if (recorded) setStatus("recording", "good");
  else send.load().catch((error) => notify(error.message));
  document.documentElement.dataset.ready = "yes";
}

function make(hello, recorded) {
  return {
    arm: new ArmView(hello.robot),
    dials: new Dials(hello.robot),
    curves: new Curves(hello.robot),
    faults: hello.simulated ? new Faults(server, hello.scenarios, notify) : null,
    player: recorded ? new Player(server, hello.recording) : null,
  };
}

function clear() {
  line.clear();
  parts?.arm.clear();
  parts?.curves.clear();
}

function show(sample) {
  const { arm, dials, curves } = parts;
  if (sample.j) {
    state.joints = sample.j;
    dials.show(sample.j);
  }
  if (sample.c) state.coordinates = sample.c;
  if (sample.tj !== undefined) dials.target(sample.tj);
  arm.add(sample, dials.near.length > 0);
  curves.add(sample);
}

// Say in words what the drawing shows.
function summarize() {
  const { robot, joints, coordinates } = state;
  const list = (numbers, facts) =>
    numbers.map((value, at) => `${facts[at]?.name} ${value.toFixed(1)}`).join(", ");
  if (coordinates) byId("coordinates").textContent = list(coordinates, robot.coordinates);
  const near = parts.dials.near;
  const warning = near.length ? ` Near a limit: ${near.join(", ")}.` : "";
  if (joints) parts.arm.describe(`The arm. Joints: ${list(joints, robot.joints)}.${warning}`);
}

function showPort({ problem }) {
  state.lost = problem !== "";
  setStatus(problem || "connected", problem ? "bad" : "good");
  send.permit();
}

function showControl({ page, motion }) {
  state.mine = page === server.page && page !== "";
  state.motion = state.mine && motion;
  const other = page !== "" && !state.mine;
  byId("control").textContent = state.mine ? "Release control" : other ? "Another page controls" : "Take control";
  byId("control").disabled = other;
  byId("motion").checked = state.motion;
  byId("motion").disabled = !state.mine || !state.motionPermitted;
  byId("motion-label").title = state.motionPermitted ? "" : "Start the server with --allow-motion.";
  byId("begin").disabled = !state.mine;
  send.permit();
}

function wireControls() {
  const attempt = (path, values) => server.post(path, values()).catch((error) => notify(error.message));
  byId("control").addEventListener("click", () => attempt("/api/control", () => ({ take: !state.mine })));
  byId("motion").addEventListener("change", () => attempt("/api/motion", () => ({ on: byId("motion").checked })));
  byId("stop").addEventListener("click", stop);
  // Escape stops, wherever the focus is.
  document.addEventListener("keydown", (event) => event.key === "Escape" && stop());
}

function stop() {
  if (byId("stop").disabled || document.body.classList.contains("recorded")) return;
  stops += 1;
  byId("stop").classList.add("sent");
  const sent = server.wish("stop", { number: stops });
  if (!sent) server.post("/api/stop").then(() => showStopped({}), (error) => notify(`Stop was NOT sent: ${error.message}`));
}

function showStopped({ error }) {
  byId("stop").classList.remove("sent");
  if (error) notify(`Stop was NOT sent: ${error}`);
  else setStatus("stop was sent", "good");
}

function connected(now) {
  if (now === "open") return notify("");
  setStatus("not connected", "bad");
  state.mine = false;
  state.lost = true;
  send.permit();
  notify(
    now === "refused"
      ? "The token is missing or wrong. Open the address that cobotwire printed."
      : "The server is gone. This page connects again when it is back.",
  );
}

function setStatus(text, kind) {
  byId("status").textContent = text;
  byId("status").className = `status ${kind}`;
}

function notify(text) {
  byId("notice").textContent = text;
  byId("notice").hidden = text === "";
}
