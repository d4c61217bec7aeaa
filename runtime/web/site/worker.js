// Keeps the page itself for a visit without a network; the tour's pieces the page has put into the same store.
const kStore = 'flaneur ' + new URL('.', self.location).pathname;
const kPage = ['./', 'index.html', '@FILES@'];  // flaneur web fills in the rest

self.addEventListener('install', (e) => {
  e.waitUntil(caches.open(kStore).then((store) => store.addAll(kPage)).then(() => self.skipWaiting()));
});
self.addEventListener('activate', (e) => e.waitUntil(self.clients.claim()));

// The newest page that can be had; what is named by its content never changes.
self.addEventListener('fetch', (e) => {
  if (e.request.method !== 'GET' || new URL(e.request.url).origin !== self.location.origin) return;
  e.respondWith((async () => {
    const store = await caches.open(kStore);
    const kept = await store.match(e.request, {ignoreSearch: true});
    if (kept && e.request.url.includes('/pieces/')) return kept;
    try {
      const answer = await fetch(e.request);
      if (answer.ok && !e.request.url.includes('/pieces/')) await store.put(e.request, answer.clone());
      return answer;
    } catch (broken) {
      if (kept) return kept;
      throw broken;
    }
  })());
});
