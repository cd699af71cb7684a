// Keep the files of the page, so that it works without a network.

const [PREFIX, VERSION, FILES] = ["cobotwire-live-", "VERSION", ["FILES"]];

async function install() {
  await (await caches.open(PREFIX + VERSION)).addAll(FILES);
  await self.skipWaiting();
}

async function activate() {
  for (const name of await caches.keys()) if (name.startsWith(PREFIX) && name !== PREFIX + VERSION) await caches.delete(name);
  await self.clients.claim();
}

self.addEventListener("install", (event) => event.waitUntil(install()));
self.addEventListener("activate", (event) => event.waitUntil(activate()));
self.addEventListener("fetch", (event) => event.respondWith(caches.match(event.request).then((kept) => kept ?? fetch(event.request))));
