// Compare a call over TCP with a bare round trip of the same bytes; one run alternates between both.
import { once } from "node:events";
import { connect } from "node:net";
import { Worker, isMainThread, parentPort } from "node:worker_threads";
import { createServer } from "node:net";
import { MyCobot280 } from "cobotwire/mycobot280";

const REQUEST = Buffer.from("fefe0220fa", "hex");
const REPLY = Buffer.from("fefe0e20008c003dffe6ff3f00afff51fa", "hex");
const [CALLS, ROUNDS] = [300, 20];

async function timed(call) {
  const start = performance.now();
  for (let n = 0; n < CALLS; n += 1) await call();
  return ((performance.now() - start) * 1000) / CALLS;
}

if (isMainThread) {
  const server = new Worker(new URL(import.meta.url));
  const [port] = await once(server, "message");
  const bare = connect({ port, host: "127.0.0.1", noDelay: true });
  await once(bare, "connect");
  const arm = await MyCobot280.open(`socket://127.0.0.1:${port}`);
  const [floors, calls] = [[], []];
  for (let round = 0; round < ROUNDS; round += 1) {
    let received;
    bare.on("data", () => received());
    floors.push(await timed(() => new Promise((done) => ((received = done), bare.write(REQUEST)))));
    bare.removeAllListeners("data");
    calls.push(await timed(() => arm.getAngles()));
  }
  const middle = (times) => times.sort((a, b) => a - b)[ROUNDS / 2];
  const [floor, call] = [middle(floors), middle(calls)];
  console.log(`bare ${floor.toFixed(1)} µs, call ${call.toFixed(1)} µs, ratio ${(call / floor).toFixed(2)}`);
  await arm.close();
  bare.destroy();
  await server.terminate();
} else {
  const server = createServer({ noDelay: true }, (socket) => socket.on("data", () => socket.write(REPLY)));
  server.listen(0, "127.0.0.1", () => parentPort.postMessage(server.address().port));
}
