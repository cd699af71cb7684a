// Keep the files of the page, so that it works without a network.

const [PREFIX, VERSION, FILES] = ["cobotwire-live-", "VERSION", ["FILES"]];

// Fetch each file from the server: the browser may have cached an earlier version. The new version waits until no page
// uses the old one, so that no page gets files of both.
async function install() {
  await (await caches.open(PREFIX + VERSION)).addAll(FILES.map((file) => new Request(file, { cache: "reload" })));
}

async function answer(request) {
  return (await (await caches.open(PREFIX + VERSION)).match(request)) ?? fetch(request);
}

async function activate() {
  for (const name of await caches.keys()) if (name.startsWith(PREFIX) && name !== PREFIX + VERSION) await caches.delete(name);
  await self.clients.claim();
}

self.addEventListener("install", (event) => event.waitUntil(install()));
self.addEventListener("activate", (event) => event.waitUntil(activate()));
self.addEventListener("fetch", (event) => event.respondWith(answer(event.request)));
