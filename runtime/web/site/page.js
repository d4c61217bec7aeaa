// The page around the player: fetches the tour's pieces, hands over what hands do, asks for pictures, and says what is
// wrong in one sentence over the still picture. Nothing but this folder is asked for anything.
import {Bar} from './bar.js';
import {sentences} from './sentences.js';

const kClick_px = 8, kClick_ms = 500;   // a press that moves or lasts longer turns the view
const kMostPixels = 2;                  // drawn a CSS pixel's side
const kTries = 4, kFirstPause_ms = 500; // of a piece that does not come
const kKeys = {
  Space: 'space', Escape: 'escape', Enter: 'enter', Tab: 'tab', Backspace: 'backspace', ArrowRight: 'right',
  ArrowLeft: 'left', ArrowDown: 'down', ArrowUp: 'up', PageUp: 'page_up', PageDown: 'page_down', Home: 'home',
  End: 'end', ShiftLeft: 'left_shift', ShiftRight: 'right_shift', Comma: 'comma', Period: 'period', Minus: 'minus',
  Equal: 'equal', NumpadAdd: 'keypad_add', NumpadSubtract: 'keypad_subtract', NumpadEnter: 'keypad_enter'};

const page = document.getElementById('tour'), caption = document.getElementById('caption');
const message = document.getElementById('message'), progress = document.getElementById('progress');
const poster = document.getElementById('poster'), begin = document.getElementById('begin');

class Trouble extends Error {
  constructor(kind, detail = '') {
    super(detail);
    this.kind = kind;
  }
}

const wishes = () => new URLSearchParams(location.hash.slice(1));
const language = () => wishes().get('lang') || navigator.language.slice(0, 2);
const say = (kind) => (sentences[language()] ?? sentences.en)[kind] ?? sentences.en[kind];

// To whoever embeds the page, and to its own scripts.
function tell(event, detail = {}) {
  page.dispatchEvent(new CustomEvent(event, {detail, bubbles: true}));
  if (parent !== window) parent.postMessage({flaneur: event, ...detail}, '*');
}

function showMessage(text) {
  message.textContent = text;
  message.hidden = !text;
  progress.hidden = true;
}

function fail(trouble) {
  const known = trouble instanceof Trouble;
  poster.hidden = false;
  caption.hidden = document.getElementById('bar').hidden = true;
  page.dataset.state = 'failed';
  showMessage(say(known ? trouble.kind : 'fault') + (trouble.message ? ' (' + trouble.message + ')' : ''));
  tell('failed', {kind: known ? trouble.kind : 'fault', detail: trouble.message});
}

// What has been fetched once stays on the device; where the browser keeps nothing, each visit fetches anew.
async function openStore() {
  try {
    return await caches.open('flaneur ' + new URL('.', location).pathname);
  } catch {
    return null;
  }
}

const nextPicture = () => new Promise((done) => requestAnimationFrame(done));
const pause = (ms) => new Promise((done) => setTimeout(done, ms));

// Of files that never change under their name. Tries again where the line breaks; the store has what came before.
async function fetchFile(store, file) {
  const kept = await store?.match(file).catch(() => undefined);
  if (kept) return kept;
  for (let k = 0;; ++k) {
    try {
      const answer = await fetch(file);
      if (answer.ok) {
        const whole = await answer.arrayBuffer();
        const size = answer.headers.get('Content-Length');
        if (!size || answer.headers.get('Content-Encoding') || +size === whole.byteLength) {
          const copy = new Response(whole, {headers: {'Content-Type': answer.headers.get('Content-Type') ?? ''}});
          await store?.put(file, copy.clone()).catch(() => {});
          return copy;
        }
      } else if (answer.status === 404 || answer.status === 410) {
        throw new Trouble('missing', file);
      }
    } catch (e) {
      if (e instanceof Trouble) throw e;
    }
    if (k + 1 === kTries) throw new Trouble('cut', file);
    await pause(kFirstPause_ms * 2 ** k);
  }
}

// Compressed in the file itself, so that it does not depend on the server. What is corrupt or cut fails its checksum.
async function fetchPacked(store, file, bytes) {
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

class Player {
  constructor(module) {
    this.module = module;
  }
  // Throws what the player says is wrong.
  call(name, types = [], values = []) {
    const wrong = this.module.ccall(name, 'string', types, values);
    if (wrong) throw new Trouble(wrong.includes('WebGL') ? 'webgl' : wrong.includes('memory') ? 'memory' : 'fault', wrong);
  }
  do(name, types = [], values = []) {
    this.module.ccall(name, null, types, values);
  }
  read(name) {
    return JSON.parse(this.module.ccall(name, 'string', [], []));
  }
  arrive(piece, content) {
    const place = this.module._malloc(content.length);
    if (!place) throw new Trouble('memory');
    this.module.HEAPU8.set(content, place);
    let at = place;
    try {
      for (const [offset, bytes] of piece.parts) {
        this.call('page_arrive', ['number', 'number', 'number'], [offset, at, bytes]);
        at += bytes;
      }
    } finally {
      this.module._free(place);
    }
  }
  isLoaded() {
    const place = this.module._malloc(1);
    try {
      this.call('page_load', ['number'], [place]);
      return this.module.HEAPU8[place] !== 0;
    } finally {
      this.module._free(place);
    }
  }
}

async function makeModule(store, site, canvas) {
  const binary = await fetchPacked(store, site.player);
  const {default: make} = await import('./' + site.script);
  try {
    return await make({canvas, wasmBinary: binary, printErr: (line) => console.error(line)});
  } catch (e) {
    throw new Trouble(e instanceof RangeError ? 'memory' : 'fault', e.message);
  }
}

// A few at a time, in order of their need.
async function fetchPieces(store, pieces, take) {
  const kAtOnce = 4;
  let next = 0;
  await Promise.all(Array.from({length: kAtOnce}, async () => {
    while (next < pieces.length) {
      const piece = pieces[next++];
      await take(piece, await fetchPacked(store, piece.file, sizeOf(piece)));
    }
  }));
}

function newCanvas() {
  const canvas = document.createElement('canvas');
  canvas.id = 'canvas';
  canvas.tabIndex = 0;
  canvas.setAttribute('aria-describedby', 'caption');
  document.getElementById('canvas')?.remove();
  page.prepend(canvas);
  return canvas;
}

function takeKeys(player, visit) {
  const on = (event, type, take) => event.addEventListener(type, take, {signal: visit.signal});
  on(window, 'keydown', (e) => {
    if (e.ctrlKey || e.metaKey || e.altKey || e.target.closest?.('button, select, input, a, dialog')) return;
    const key = nameOfKey(e.code);
    if (!key || key === 'tab' || key === 'escape') return;
    player.do('page_key', ['string', 'number'], [key, 1]);
    e.preventDefault();
  });
  on(window, 'keyup', (e) => {
    const key = nameOfKey(e.code);
    if (key) player.do('page_key', ['string', 'number'], [key, 0]);
  });
  on(window, 'blur', () => player.do('page_release_keys'));
}

function nameOfKey(code) {
  const plain = /^(?:Key|Digit)(.)$/.exec(code) ?? /^(F\d+)$/.exec(code);
  return plain ? plain[1].toLowerCase() : kKeys[code];
}

// Dragging turns the view, a tap or click walks there, two fingers or the wheel widen the view.
function takePointers(canvas, player, visit) {
  const on = (type, take, options = {}) => canvas.addEventListener(type, take, {signal: visit.signal, ...options});
  const down = new Map();  // by pointer: where it was
  let began = null;
  const apart = () => {
    const [a, b] = [...down.values()];
    return Math.hypot(a.x - b.x, a.y - b.y);
  };
  on('pointerdown', (e) => {
    if (e.button !== 0) return;
    canvas.setPointerCapture(e.pointerId);
    down.set(e.pointerId, {x: e.clientX, y: e.clientY});
    began = down.size === 1 ? {x: e.clientX, y: e.clientY, time: e.timeStamp} : null;
    canvas.focus();
  });
  on('pointermove', (e) => {
    const was = down.get(e.pointerId);
    if (!was) return;
    const before = down.size === 2 ? apart() : 0;
    down.set(e.pointerId, {x: e.clientX, y: e.clientY});
    if (began && Math.hypot(e.clientX - began.x, e.clientY - began.y) > kClick_px) began = null;
    if (down.size === 2 && before > 0 && apart() > 0) player.do('page_widen', ['number'], [before / apart()]);
    if (down.size === 1 && !began)
      player.do('page_turn', ['number', 'number'], [was.x - e.clientX, was.y - e.clientY]);
  });
  const up = (e) => {
    if (e.type === 'pointerup' && began && down.size === 1 && e.timeStamp - began.time < kClick_ms) {
      const box = canvas.getBoundingClientRect();
      player.do('page_click', ['number', 'number'],
                [(e.clientX - box.left) / box.width, (e.clientY - box.top) / box.height]);
    }
    down.delete(e.pointerId);
    began = null;
  };
  on('pointerup', up);
  on('pointercancel', up);
  on('wheel', (e) => {
    player.do('page_widen', ['number'], [Math.exp(Math.sign(e.deltaY) * 0.05)]);
    e.preventDefault();
  }, {passive: false});
}

function takeGamepad(player, held) {
  const pad = navigator.getGamepads?.().find((p) => p?.mapping === 'standard');
  if (!pad) return;
  const names = ['a', 'b', 'x', 'y', 'left_bumper', 'right_bumper', null, null, 'back', 'start', 'left_thumb',
                 'right_thumb', 'up', 'down', 'left', 'right'];
  pad.buttons.forEach((button, k) => {
    if (!names[k] || button.pressed === (held[k] ?? false)) return;
    held[k] = button.pressed;
    player.do('page_key', ['string', 'number'], ['pad_' + names[k], held[k] ? 1 : 0]);
  });
  const [lx, ly, rx, ry] = pad.axes;
  player.do('page_sticks', ['number', 'number', 'number', 'number'], [lx, -ly, rx, -ry]);
}

// What the page's own scripts and whoever embeds it may ask for.
function offer(player, described) {
  const commands = {
    goToStop: (stop) => player.do('page_go_to_stop', ['number'], [stop - 1]),
    setLanguage: (code) => player.do('page_language', ['string'], [code]),
    takeTour: (follows) => player.do('page_take_tour', ['number'], [follows ? 1 : 0]),
    pause: (pauses) => player.do('page_pause', ['number'], [pauses ? 1 : 0]),
  };
  commands.stops = () => player.read('page_description').stops;
  page.flaneur = {...commands, description: described, state: () => player.read('page_state'),
                  heapBytes: () => player.module.HEAPU8.length};
  return commands;
}

function takeWishes(commands) {
  const stop = Number(wishes().get('stop'));
  commands.setLanguage(language());
  if (Number.isInteger(stop) && stop > 0) commands.goToStop(stop);
}

// Spoken stops, from the visitor's first touch on: before it browsers play nothing.
class Speaker {
  constructor(player, visit) {
    this.player = player;
    this.spoken = -1;
    this.source = null;
    this.context = new AudioContext();
    const wake = () => this.context.resume().catch(() => {});
    for (const type of ['pointerdown', 'keydown', 'touchend']) addEventListener(type, wake, {signal: visit.signal});
    visit.signal.addEventListener('abort', () => this.context.close());
  }
  async say(sound, paused) {
    if (this.context.state === 'closed') return;
    if (this.source) this.source.playbackRate.value = paused ? 0 : 1;
    if (sound === this.spoken) return;
    this.source?.stop();
    this.source = null;
    const bytes = sound < 0 ? 0 : this.player.module.ccall('page_sound_bytes', 'number', ['number'], [sound]);
    if (sound >= 0 && !bytes) return;  // on its way
    this.spoken = sound;
    if (sound < 0) return;
    const at = this.player.module.ccall('page_sound', 'number', ['number'], [sound]);
    const file = this.player.module.HEAPU8.slice(at, at + bytes).buffer;
    const buffer = await this.context.decodeAudioData(file).catch(() => null);
    if (!buffer || this.spoken !== sound || this.context.state === 'closed') return;
    this.source = new AudioBufferSourceNode(this.context, {buffer});
    this.source.connect(this.context.destination);
    this.source.start();
  }
}

let shown = null;  // of the last picture

function follow(state, speaker, bar) {
  bar.show(state);
  speaker.say(state.sound, state.paused);
  if (state.caption !== caption.textContent) caption.textContent = state.caption;
  caption.hidden = !state.caption;
  caption.lang = state.language;
  if (state.resting && (!shown?.resting || shown.stop !== state.stop)) tell('stop-reached', {stop: state.stop + 1});
  if (state.over && !shown?.over) tell('ended');
  shown = state;
}

function drawPictures(canvas, player, visit, bar) {
  const speaker = new Speaker(player, visit);
  const held = {};
  let last = 0, told = 0;
  return new Promise((_, reject) => {
    const draw = (now) => {
      if (visit.signal.aborted) return;
      try {
        const passed_ms = last ? now - last : 0;
        last = now;
        const scale = Math.min(devicePixelRatio, kMostPixels);
        const width = Math.round(canvas.clientWidth * scale), height = Math.round(canvas.clientHeight * scale);
        if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
        takeGamepad(player, held);
        // Who comes back to a tab that was hidden goes on where they were.
        const seen_ms = passed_ms < 1000 ? passed_ms : 0;
        player.call('page_picture', ['number', 'number', 'number', 'number'], [width, height, seen_ms / 1000, seen_ms]);
        if (now - told > 100) {
          told = now;
          follow(player.read('page_state'), speaker, bar);
        }
        requestAnimationFrame(draw);
      } catch (e) {
        reject(e);
      }
    };
    requestAnimationFrame(draw);
  });
}

async function visitTour(visit, wishesNow) {
  const store = await openStore();
  const site = await readSite(store);
  const canvas = newCanvas();
  const lost = new Promise((_, reject) => {
    canvas.addEventListener('webglcontextlost', (e) => {
      e.preventDefault();
      reject(new Trouble('lost'));
    }, {signal: visit.signal});
  });
  lost.catch(() => {});
  const first = site.pieces.slice(0, site.first), later = site.pieces.slice(site.first);
  const modulePromise = makeModule(store, site, canvas);
  modulePromise.catch(() => {});
  let arrived = 0;
  const contents = [];
  await fetchPieces(store, first, async (piece, content) => {
    contents.push([piece, content]);
    progress.value = ++arrived / first.length;
  });
  const player = new Player(await modulePromise);
  player.call('page_expect', ['number'], [site.bytes]);
  for (const [piece, content] of contents) player.arrive(piece, content);
  contents.length = 0;
  player.call('page_open');
  player.call('page_begin', ['string'], ['#canvas']);
  while (!player.isLoaded()) await pause(0);
  const described = player.read('page_description');
  const commands = offer(player, described);
  wishesNow(commands);
  addEventListener('hashchange', () => takeWishes(commands), {signal: visit.signal});
  addEventListener('message', (e) => {
    const wish = e.data?.flaneur;
    if (e.source === parent && Object.hasOwn(commands, wish)) commands[wish](e.data.value);
  }, {signal: visit.signal});
  takeKeys(player, visit);
  takePointers(canvas, player, visit);
  poster.hidden = true;
  showMessage('');
  canvas.focus();
  page.dataset.state = 'visiting';
  const words = (code) => JSON.parse(player.module.ccall('page_words', 'string', ['string'], [code]));
  const bar = new Bar(page, described, commands, words, language(), visit.signal);
  const drawn = drawPictures(canvas, player, visit, bar);
  await Promise.race([drawn, nextPicture().then(nextPicture)]);  // what is not in it does not hold it up
  tell('tour-loaded', described);
  const all = fetchPieces(store, later, async (piece, content) => {
    if (!visit.signal.aborted) player.arrive(piece, content);
  }).then(() => forgetOthers(store, site));
  await Promise.race([lost, drawn, all.then(() => new Promise(() => {}))]);
}

// The list of pieces may change under its name: the newest that can be had.
async function readSite(store) {
  const file = 'tour.json';
  let answer = null;
  try {
    answer = await fetch(file, {cache: 'no-cache'});
  } catch {
    answer = await store?.match(file).catch(() => undefined);
    if (!answer) throw new Trouble('cut', file);
  }
  if (!answer.ok) throw new Trouble('missing', file);
  const text = await answer.text();
  let site;
  try {
    site = JSON.parse(text);
  } catch {
    throw new Trouble('corrupt', file);
  }
  if (site.version !== 1) throw new Trouble('version', file);
  await store?.put(file, new Response(text, {headers: {'Content-Type': 'application/json'}})).catch(() => {});
  return site;
}

async function forgetOthers(store, site) {
  const used = new Set([site.player, 'tour.json', ...site.pieces.map((p) => p.file)].map((f) => new URL(f, location).href));
  for (const kept of (await store?.keys()) ?? []) {
    if (new URL(kept.url).pathname.includes('/pieces/') && !used.has(kept.url)) await store.delete(kept);
  }
  tell('complete');
  page.dataset.complete = 'yes';
}

// Where the device takes the picture away, it is set up anew, at the same stop.
async function run() {
  begin.hidden = true;
  progress.hidden = false;
  let again = takeWishes;
  for (let tries = 0;; ++tries) {
    const visit = new AbortController();
    try {
      page.dataset.state = 'loading';
      await visitTour(visit, again);
    } catch (e) {
      visit.abort();
      if (!(e instanceof Trouble) || e.kind !== 'lost' || tries === 3) return fail(e);
      const {stop, language} = shown ?? {};
      poster.hidden = false;
      showMessage(say('lost'));
      again = (commands) => {
        takeWishes(commands);
        if (language) commands.setLanguage(language);
        if (stop >= 0) commands.goToStop(stop + 1);
      };
      await pause(1000);
    }
  }
}

if ('serviceWorker' in navigator) navigator.serviceWorker.register('worker.js').catch(() => {});
begin.textContent = say('begin');
if (parent !== window) {
  begin.hidden = false;
  begin.addEventListener('click', run, {once: true});
} else {
  run();
}
