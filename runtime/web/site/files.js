// The tour's files: fetched once, kept on the device, unpacked, and tried again where the line breaks.
import {pause, Trouble} from './trouble.js';

const kTries = 4, kFirstPause_ms = 500;  // of a file that does not come
const kStalls_ms = 20000;                // without a byte
const kAtOnce = 6;  // as many as browsers ask one host for

// What has been fetched once stays on the device; where the browser keeps nothing, each visit fetches anew.
export async function openStore() {
  try {
    return await caches.open('flaneur ' + new URL('.', location).pathname);
  } catch {
    return null;
  }
}

let heard_ms = 0;  // when a byte of any file came last

// Stops what waits while nothing comes at all: browsers let files wait for one another. Looked at twice, since after long
// work, or in a tab that was hidden, what has come meanwhile is told later than the clock.
function watchLine(stop) {
  let silent = 0;
  heard_ms = performance.now();
  const watch = setInterval(() => {
    silent = performance.now() - heard_ms > kStalls_ms ? silent + 1 : 0;
    if (silent > 1) stop.abort();
  }, kStalls_ms / 4);
  return () => clearInterval(watch);
}

// All of it, or nothing where the line has stalled or broken.
async function readWhole(file) {
  const stop = new AbortController(), unwatch = watchLine(stop);
  try {
    const answer = await fetch(file, {signal: stop.signal});
    if (answer.status === 404 || answer.status === 410) throw new Trouble('missing', file);
    if (!answer.ok) return null;
    const parts = [];
    let bytes = 0;
    for (const reader = answer.body.getReader();;) {
      const {done, value} = await reader.read();
      heard_ms = performance.now();
      if (done) break;
      parts.push(value);
      bytes += value.length;
    }
    const size = answer.headers.get('Content-Length');
    if (size && !answer.headers.get('Content-Encoding') && +size !== bytes) return null;
    return new Response(new Blob(parts), {headers: {'Content-Type': answer.headers.get('Content-Type') ?? ''}});
  } catch (e) {
    if (e instanceof Trouble) throw e;
    return null;
  } finally {
    unwatch();
  }
}

// Of files that never change under their name.
async function fetchFile(store, file) {
  const kept = await store?.match(file).catch(() => undefined);
  if (kept) return kept;
  for (let k = 0; k < kTries; ++k) {
    if (k > 0) await pause(kFirstPause_ms * 2 ** (k - 1));
    const whole = await readWhole(file);
    if (!whole) continue;
    await store?.put(file, whole.clone()).catch(() => {});
    return whole;
  }
  throw new Trouble('cut', file);
}

// Compressed in the file itself, so that it does not depend on the server. What is corrupt or cut fails its checksum.
export async function fetchPacked(store, file, bytes) {
  const answer = await fetchFile(store, file);
  try {
    const unpacked = answer.body.pipeThrough(new DecompressionStream('gzip'));
    const content = new Uint8Array(await new Response(unpacked).arrayBuffer());
    if (bytes !== undefined && content.length !== bytes) throw new Error();
    return content;
  } catch {
    await store?.delete(file).catch(() => {});
    throw new Trouble('corrupt', file);
  }
}

const sizeOf = (piece) => piece.parts.reduce((sum, [, bytes]) => sum + bytes, 0);

// A few at a time, in order of their need.
export async function fetchPieces(store, pieces, take, atOnce = kAtOnce) {
  let next = 0;
  await Promise.all(Array.from({length: atOnce}, async () => {
    while (next < pieces.length) {
      const piece = pieces[next++];
      await take(piece, await fetchPacked(store, piece.file, sizeOf(piece)));
    }
  }));
}

// The same while the visitor walks already: a line that breaks is waited for, and `tellCut` hears of it.
export async function fetchPiecesMeanwhile(store, pieces, take, tellCut) {
  const left = new Set(pieces);
  while (left.size > 0) {
    try {
      await fetchPieces(store, [...left], (piece, content) => {
        take(piece, content);
        left.delete(piece);
        tellCut(false);
      });
    } catch (e) {
      if (!(e instanceof Trouble) || e.kind !== 'cut') throw e;
      tellCut(true);
      await Promise.race([pause(5000), new Promise((done) => addEventListener('online', done, {once: true}))]);
    }
  }
}

// Fetches and unpacks beside the page, one list of pieces after the other; where there are no workers, in it.
export class PieceFetcher {
  constructor(store, signal) {
    Object.assign(this, {store, signal, job: null, worker: new Worker('fetch_worker.js', {type: 'module'})});
    signal.addEventListener('abort', () => this.end(), {once: true});
    this.worker.onerror = () => {
      this.worker = null;
      this.job?.doHere();
    };
    this.worker.onmessage = ({data}) => this.job?.hear(data);
  }
  end() {
    this.worker?.terminate();
  }
  // tellCut: as of fetchPiecesMeanwhile; without it a line that breaks is a trouble.
  fetch(pieces, take, tellCut = null) {
    const {store, signal} = this;
    return new Promise((resolve, reject) => {
      const takeHere = (piece, content) => signal.aborted || take(piece, content);
      const tellHere = tellCut && ((cut) => signal.aborted || tellCut(cut));
      const doHere = () => resolve(tellCut ? fetchPiecesMeanwhile(store, pieces, takeHere, tellHere) : fetchPieces(store, pieces, takeHere, pieces.length));
      const hear = ({piece, content, cut, trouble}) => {
        if (content) {
          try {
            take(piece, content);
          } catch (e) {
            this.end();
            reject(e);
          }
          if (tellCut) this.worker.postMessage(content, [content.buffer]);  // before the first picture they wait for the player
        } else if (cut !== undefined) {
          tellCut(cut);
        } else {
          trouble ? reject(new Trouble(trouble.kind, trouble.detail)) : resolve();
        }
      };
      this.job = {doHere, hear};
      if (this.worker) this.worker.postMessage({pieces, waits: tellCut !== null});
      else doHere();
    });
  }
}

// The list of pieces may change under its name: the newest that can be had.
export async function readSite(store) {
  const file = 'tour.json';
  let answer = null;
  try {
    answer = await fetch(file, {cache: 'no-cache', signal: AbortSignal.timeout(kStalls_ms)});
  } catch {
    answer = await store?.match(file).catch(() => undefined);
    if (!answer) throw new Trouble('cut', file);
  }
  if (answer.status >= 500) throw new Trouble('cut', file);
  if (!answer.ok) throw new Trouble('missing', file);
  let site, text;
  try {
    text = await answer.text();
    site = JSON.parse(text);
  } catch {
    throw new Trouble('corrupt', file);
  }
  if (site.version !== 1) throw new Trouble('version', file);
  await store?.put(file, new Response(text, {headers: {'Content-Type': 'application/json'}})).catch(() => {});
  return site;
}

export async function forgetOthers(store, site) {
  const used = new Set([site.player, 'tour.json', ...site.pieces.map((p) => p.file)].map((f) => new URL(f, location).href));
  for (const kept of (await store?.keys()) ?? []) {
    if (new URL(kept.url).pathname.includes('/pieces/') && !used.has(kept.url)) await store.delete(kept);
  }
}
