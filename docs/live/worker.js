// Hold the session in a worker, so that the arm is stopped even if the page hangs. The page sends requests, and messages
// that need no reply; it gets batches of entries, samples and states.

import { identify } from "./identify.js";
import { Live } from "./live.js";
import { read } from "./pcapng.js";
import { Recorded } from "./recorded.js";

const BATCH_MS = 50;
const COMMON = { page: "page", simulated: false, motionPermitted: true, scenarios: [] };
let [session, news] = [null, null];

function publish({ entries = [], samples = [], states = {}, cleared = false }) {
  if (!news) setTimeout(() => (postMessage({ news }), (news = null)), BATCH_MS);
  news ??= { entries: [], samples: [], states: {} };
  if (cleared) Object.assign(news, { entries: [], samples: [], states: { ...news.states, cleared } });
  news.entries.push(...entries);
  news.samples.push(...samples);
  Object.assign(news.states, states);
}

async function load(name) {
  const response = await fetch(`editions/${name}.json`);
  if (!response.ok) throw new Error(`this page does not know the edition ${name}`);
  return [await response.json(), await import(`./cobotwire/editions/${name}.js`)];
}

function begin(opened, hello) {
  const { robot, controls } = opened.facts;
  if (!session) publish({ states: { hello: { ...COMMON, robot, controls, url: opened.port.url, ...hello } } });
  session = opened;
}

// Handle the requests and messages of the page. Those that have no method here call a method of the session.
const requests = {
  // Connect to the port at an index; `infos` describes all ports, so that a change of their list is noticed.
  async connect({ name, speed, at, infos }) {
    const ports = await navigator.serial.getPorts();
    if (JSON.stringify(ports.map((port) => port.getInfo())) !== infos) throw new Error("the ports changed meanwhile: connect again");
    const { port, shown, ...found } = await identify(ports[at], session?.facts.robot.edition ?? name);
    try {
      const live = session ?? (await Live.make(publish, ...(await load(found.name)), { speed, baudrate: found.baudrate }));
      await live.connect(port);
      begin(live, { mode: "live" });
    } catch (error) {
      port.inner.abort();
      throw error;
    }
    return shown;
  },

  async open({ file, name, usual }) {
    const capture = read(file);
    if (!capture.packets.some(({ data }) => data.length)) throw new Error("the recording holds no bytes");
    if (!capture.edition && !usual) throw new Error("the recording names no edition: choose the robot first");
    const opened = await Recorded.make(publish, ...(await load(capture.edition || usual)), capture);
    const { seconds, remarks } = opened;
    begin(opened, { mode: "recording", recording: { name, seconds, remarks } });
    opened.seek(0);
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
};

onmessage = async ({ data: { wish, id, request, values, ...rest } }) => {
  if (wish) return session && (wish in wishes ? wishes[wish](rest) : session[wish]());
  try {
    const result = await (request in requests ? requests[request](...values) : session[request](...values));
    postMessage({ id, result });
  } catch (error) {
    postMessage({ id, error: error.message });
  }
};
