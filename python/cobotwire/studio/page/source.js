// Talk to the server: where entries and samples come from, and what requests go to.
//
// The other modules know the methods of this class, but no URLs, so that another source can replace it. The token is
// kept where only this origin, port included, can read it.

const KEY = "cobotwire-studio-token";
const AGAIN_MS = 1000;

function token() {
  const shown = new URLSearchParams(location.hash.slice(1)).get("token");
  if (shown) {
    sessionStorage.setItem(KEY, shown);
    // Neither the address bar nor the history may keep it.
    history.replaceState(null, "", location.pathname);
  }
  return sessionStorage.getItem(KEY) ?? "";
}

export class Source {
  // `onBatch` gets each batch of news; `onState` gets "open", "closed" or "refused".
  constructor(onBatch, onState) {
    this.token = token();
    this.page = "";
    // How many stops of the arm this page knows. The server refuses a motion with another number.
    this.stops = 0;
    this.unsent = new AbortController();
    this.onBatch = onBatch;
    this.onState = onState;
    this.everOpen = false;
    this.connect();
  }

  connect() {
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    const address = `${scheme}://${location.host}/api/feed`;
    this.socket = new WebSocket(address, ["cobotwire-studio", `token.${this.token}`]);
    this.socket.onopen = () => {
      this.everOpen = true;
      this.onState("open");
    };
    this.socket.onmessage = (message) => this.take(JSON.parse(message.data));
    this.socket.onclose = () => this.closed();
  }

  async closed() {
    this.page = "";
    let refused = false;
    try {
      refused = (await this.fetch("/api/table")).status === 401;
    } catch {
      // The server is gone; it may come back.
    }
    this.onState(refused ? "refused" : "closed");
    if (!refused) setTimeout(() => this.connect(), AGAIN_MS);
  }

  take(batch) {
    const { hello, stops } = batch.states;
    // An older state may arrive after a stop of this page, so only a new connection lowers the number.
    if (stops !== undefined) this.stops = hello ? stops : Math.max(stops, this.stops);
    this.onBatch(batch);
  }

  // Send a message over the open WebSocket: it overtakes requests over HTTP.
  wish(wish, values = {}) {
    if (wish === "stop") this.stopped();
    if (this.socket.readyState !== WebSocket.OPEN) return false;
    const { stops } = this;
    // The server counts the same messages.
    if (wish === "stop" || wish === "release") this.stops += 1;
    this.socket.send(JSON.stringify(wish === "hold" ? { wish, stops, ...values } : { wish, ...values }));
    return true;
  }

  // Drop the commands that still wait in the browser, or for a reply.
  stopped() {
    this.unsent.abort(new Error("The arm was stopped before this command was confirmed."));
    this.unsent = new AbortController();
  }

  fetch(path, options = {}) {
    const headers = { authorization: `Bearer ${this.token}`, "x-studio-page": this.page };
    return fetch(path, { ...options, headers, cache: "no-store" });
  }

  // Return the forms of all commands.
  async commands() {
    return (await this.get("/api/table")).commands;
  }

  // Return the explanation of an entry, or of a request that has not been sent.
  explain(number) {
    return this.get(`/api/entry/${number}`);
  }

  preview(command, values) {
    return this.post("/api/preview", { command, arguments: values });
  }

  // Send a command with the texts of its arguments, and return its result. `stops` is the number of stops that this
  // page knew when the user requested the command.
  async send(command, values, force = false, stops = this.stops) {
    const { signal } = this.unsent;
    return (await this.post("/api/send", { command, arguments: values, force, stops }, signal)).result;
  }

  // Take the control for this page, or release it.
  control(take) {
    return this.post("/api/control", { take });
  }

  // Turn the motion switch.
  allowMotion(on) {
    return this.post("/api/motion", { on });
  }

  // Begin a fault scenario.
  scenario(name) {
    return this.post("/api/scenario", { name });
  }

  stop() {
    return this.post("/api/stop");
  }

  // Return the response with the entries that a query selects, as a file.
  async exported(query) {
    const response = await this.fetch(`/api/export?${query}`);
    return response.ok ? response : this.answer(response);
  }

  async get(path) {
    return this.answer(await this.fetch(path));
  }

  async post(path, values = {}, signal = undefined) {
    return this.answer(await this.fetch(path, { method: "POST", body: JSON.stringify(values), signal }));
  }

  async answer(response) {
    const text = await response.text();
    let found;
    try {
      found = JSON.parse(text);
    } catch {
      throw new Error(text.trim() || `the server replied ${response.status}`);
    }
    if (!response.ok) throw new Error(found.error ?? `the server replied ${response.status}`);
    return found;
  }
}
