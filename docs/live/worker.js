// Hold the session in a worker, so that the arm is stopped even if the page hangs. The page sends wishes, which need no
// answer, and requests; it gets batches of news.

import { edition, machine } from "./cobotwire/dist/machine.js";
import { Live } from "./live.js";
import { read } from "./pcapng.js";
import { Recorded } from "./recorded.js";

const BATCH_MS = 50;
let session = null;
let news = null;

function publish({ entries = [], samples = [], states = {}, cleared = false }) {
  if (!news) setTimeout(send, BATCH_MS);
  news ??= { entries: [], samples: [], states: {} };
  if (cleared) news = { entries: [], samples: [], states: { ...news.states, cleared: true } };
  news.entries.push(...entries);
  news.samples.push(...samples);
  Object.assign(news.states, states);
}

function send() {
  postMessage({ news });
  news = null;
}

async function load(name) {
  const response = await fetch(`editions/${name}.json`);
  if (!response.ok) throw new Error(`this page does not know the edition ${name}`);
  const module = await import(`./cobotwire/editions/${name}.js`);
  return [await response.json(), module];
}

function hello(facts, rest) {
  const common = { page: "page", simulated: false, motionPermitted: true, scenarios: [] };
  publish({ states: { hello: { ...common, robot: facts.robot, controls: facts.controls, ...rest } } });
}

// What the page requests; the session has the other methods.
const requests = {
  // Connect to the port that the user chose: the only one with this information, at this place among all.
  async connect({ name, speed, at, infos }) {
    const ports = await navigator.serial.getPorts();
    if (JSON.stringify(ports.map((port) => port.getInfo())) !== infos) throw new Error("the ports changed meanwhile: connect again");
    let live = session;
    if (!live) {
      const [facts, module] = await load(name);
      live = await Live.make(publish, facts, { module, speed, baudrate: edition(await machine(), module.table)[1] });
    }
    const shown = await live.connect(ports[at]);
    if (!session) hello(live.facts, { mode: "live", url: live.port.url });
    session = live;
    session.begin();
    return shown;
  },

  async open({ file, name, usual }) {
    const capture = read(file);
    if (!capture.packets.length) throw new Error("the recording holds no packet");
    const [facts, module] = await load(capture.edition || usual);
    session = await Recorded.make(publish, facts, { module, capture, name });
    hello(facts, { mode: "recording", url: capture.url, recording: session.recording });
    session.seek(0);
  },

  commands: () => session.facts.forms,
};

const wishes = {
  async stop({ number }) {
    const error = await session.stop().then(() => "", (failed) => failed.message);
    publish({ states: { stopped: { number, error } } });
  },
  hold: ({ command, arguments: given }) => session.hold(command, given),
  seek: ({ value }) => session.seek(value),
  play: ({ value }) => session.play(value),
  keep: () => session.keep(),
  release: () => session.release(),
  pause: () => session.pause(),
  leave: () => session.leave?.(),
};

onmessage = async ({ data }) => {
  if (data.wish) {
    if (session) wishes[data.wish](data);
    return;
  }
  const { id, request, values } = data;
  try {
    const result = await (request in requests ? requests[request](...values) : session[request](...values));
    postMessage({ id, result });
  } catch (error) {
    postMessage({ id, error: error.message });
  }
};
