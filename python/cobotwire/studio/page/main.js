// Put the parts of the page together, and pass on what the source sends.

import { ArmView } from "./arm.js";
import { Curves } from "./curves.js";
import { Details } from "./details.js";
import { byId } from "./dom.js";
import { wireExport } from "./export.js";
import { Faults } from "./faults.js";
import { Line } from "./line.js";
import { Move } from "./move.js";
import { Player } from "./player.js";
import { Send } from "./send.js";
import { Source } from "./source.js";
import { wireTabs } from "./tabs.js";

// A sample that is older than this is marked as old.
const OLD_SECONDS = 2;
const STATUS_MS = 4000;
const USES_SPACE = "a, button, input, select, textarea, [role=listbox]";

// What several parts of the page use.
const state = { mine: false, taken: false, motion: false, motionPermitted: false, lost: false, problem: "" };
let parts = null;
let stops = 0;
// When the newest joints were received, and their time on the line.
let sampled = { at: 0, time: 0 };

const source = new Source(take, connected);
const details = new Details(source);
const line = new Line((number) => details.show(number));
const send = new Send(source, state);
wireExport(source);
wireControls();

function take({ entries, samples, states }) {
  if (states.hello) begin(states.hello);
  if (states.cleared) clear();
  if (states.lost) line.lost = states.lost;
  if (states.port) showPort(states.port);
  if (states.control) showControl(states.control);
  if (states.scenario !== undefined) parts?.faults?.run(states.scenario);
  if (states.player) showPlayer(states.player);
  if (states.stopped) showStopped(states.stopped);
  if (states.refused) parts?.move ? parts.move.say(states.refused, true) : notify(states.refused);
  if (!parts) return;
  for (const sample of samples) note(sample);
  if (samples.length) show();
  if (entries.length) {
    line.add(entries);
    parts.faults?.add(entries);
  }
}

function begin(hello) {
  source.page = hello.page;
  Object.assign(state, { motionPermitted: hello.motionPermitted, robot: hello.robot });
  state.simulated = hello.simulated;
  const recorded = hello.mode === "recording";
  document.body.classList.toggle("recorded", recorded);
  byId("player").hidden = !recorded;
  byId("send-tab").hidden = recorded;
  byId("move-title").textContent = recorded ? "Position" : "Move";
  byId("faults-tab").hidden = !hello.simulated;
  const what = hello.simulated ? "a simulated arm" : hello.recording?.name || hello.url;
  byId("source").textContent = `${what} · edition ${hello.robot.edition}`;
  byId("source").title = hello.url;
  byId("stop").disabled = hello.robot.stop === "";
  byId("stop").title = hello.robot.stop ? "" : "This edition has no stop.";
  const drawn = hello.robot.links.length > 0;
  // If the arm is not drawn, the curves use the space of the drawing.
  document.body.classList.toggle("undrawn", !drawn);
  byId("no-geometry").hidden = drawn;
  byId("no-geometry").textContent = `The arm is not drawn: ${hello.robot.noGeometry.replace(/\.$/, "")}.`;
  byId("geometry-remark").hidden = !hello.robot.geometryRemark;
  byId("geometry-remark").textContent = hello.robot.geometryRemark;
  // When the page connects again, the server sends the earlier entries again.
  if (parts) clear();
  else parts = make(hello, recorded);
  if (recorded) setStatus("recording", "good");
  else send.load().catch((error) => notify(error.message));
  document.documentElement.dataset.ready = "yes";
}

function make(hello, recorded) {
  const arm = new ArmView(hello.robot);
  return {
    arm,
    move: new Move(source, state, hello.controls, arm),
    curves: new Curves(hello.robot, hello.recording?.seconds),
    faults: hello.simulated ? new Faults(source, hello.scenarios, notify) : null,
    player: recorded ? new Player(source, hello.recording) : null,
  };
}

function clear() {
  line.clear();
  parts?.arm.clear();
  parts?.curves.clear();
  state.targetJoints = state.targetEnd = null;
}

function note(sample) {
  if (sample.j) {
    state.joints = sample.j;
    sampled = { at: performance.now(), time: sample.t };
    parts.arm.moved(sample.j);
  }
  if (sample.c) state.coordinates = sample.c;
  if (sample.tj !== undefined) state.targetJoints = sample.tj;
  if (sample.te !== undefined) state.targetEnd = sample.te;
  parts.curves.add(sample);
}

function show() {
  const { robot, joints, coordinates, targetJoints, targetEnd } = state;
  parts.move.show(state);
  const { near } = parts.move;
  parts.arm.show(targetJoints, targetEnd, near.length > 0);
  showAge();
  // Say in words what the drawing shows.
  const list = (numbers, facts) =>
    numbers.map((value, at) => `${facts[at]?.name} ${value.toFixed(1)}`).join(", ");
  if (coordinates) byId("coordinates").textContent = list(coordinates, robot.coordinates);
  const warning = near.length ? ` Near a limit: ${near.join(", ")}.` : "";
  byId("near").textContent = warning.trim();
  if (joints) parts.arm.describe(`The arm. Joints: ${list(joints, robot.joints)}.${warning}`);
}

function showPlayer(player) {
  state.position = player.position;
  parts?.player?.show(player);
}

// Mark joints that are old: the arm may be elsewhere.
function showAge() {
  const recorded = document.body.classList.contains("recorded");
  const age = recorded ? (state.position ?? 0) - sampled.time : (performance.now() - sampled.at) / 1000;
  const old = Boolean(state.joints) && age > OLD_SECONDS;
  document.body.classList.toggle("old", old);
  byId("age").textContent = old ? `The joints are ${Math.floor(age)} s old.` : "";
}

function showPort({ problem }) {
  Object.assign(state, { lost: problem !== "", problem });
  showLine();
  permit();
}

function showLine() {
  setStatus(state.problem || "connected", state.problem ? "bad" : "good");
}

function showControl({ mine, taken, motion }) {
  const wasFree = !state.mine && !mine && !taken;
  Object.assign(state, { mine, taken, motion });
  byId("control").textContent = state.mine ? "Release control" : state.taken ? "Another page controls" : "Take control";
  byId("control").disabled = state.taken;
  byId("motion").checked = state.motion;
  byId("motion").disabled = !state.mine || !state.motionPermitted;
  byId("begin").disabled = !state.mine;
  permit();
  // The first page that opens may move a simulated arm at once.
  if (wasFree && state.simulated && !state.offered) {
    state.offered = true;
    source.control(true).then(() => source.allowMotion(true)).catch(() => (state.offered = false));
  }
}

function permit() {
  send.permit();
  parts?.move.permit();
}

function wireControls() {
  const attempt = (request) => request.catch((error) => notify(error.message));
  wireTabs(byId("tabs"));
  wireTabs(byId("move-tabs"));
  byId("control").addEventListener("click", async () => {
    const taking = !state.mine;
    await attempt(source.control(taking));
    if (taking && state.simulated) await attempt(source.allowMotion(true));
  });
  byId("motion").addEventListener("change", () => attempt(source.allowMotion(byId("motion").checked)));
  byId("stop").addEventListener("click", stop);
  byId("taller").addEventListener("click", () => {
    const taller = document.body.classList.toggle("taller");
    byId("taller").textContent = taller ? "Lower" : "Taller";
  });
  // Capture the event, so that no focused element can prevent a stop.
  document.addEventListener("keydown", stopKey, true);
  setInterval(showAge, 500);
}

// Escape stops, wherever the focus is. So does the space bar, except where it has another function; in the controls of
// the arm it always stops.
function stopKey(event) {
  const where = (selector) => event.target.closest?.(selector);
  const space = event.key === " " && (where("#move") || !where(USES_SPACE));
  if (event.key !== "Escape" && !space) return;
  if (space) event.preventDefault();
  stop();
}

function stop() {
  if (byId("stop").disabled || document.body.classList.contains("recorded")) return;
  stops += 1;
  byId("stop").classList.add("sent");
  const sent = source.wish("stop", { number: stops });
  parts?.move.cancel();
  if (!sent) source.stop().then(() => showStopped({}), (error) => notify(`Stop was NOT sent: ${error.message}`));
}

function showStopped({ error }) {
  byId("stop").classList.remove("sent");
  if (error) notify(`Stop was NOT sent: ${error}`);
  else {
    setStatus("stop was sent", "good");
    clearTimeout(state.timer);
    state.timer = setTimeout(showLine, STATUS_MS);
  }
}

function connected(now) {
  if (now === "open") return notify("");
  setStatus("not connected", "bad");
  Object.assign(state, { mine: false, lost: true, problem: "not connected" });
  permit();
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
