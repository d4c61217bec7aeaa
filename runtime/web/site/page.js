// The page around the player: fetches the tour's pieces, asks for pictures, and says what is wrong in one sentence over
// the still picture. Nothing but this folder is asked for anything.
import {Bar} from './bar.js';
import {makeModule, Player} from './calls.js';
import {fetchPieces, forgetOthers, openStore, PieceFetcher, readSite} from './files.js';
import {Hands} from './hands.js';
import {Headset} from './headset.js';
import {HotspotMarks} from './hotspots.js';
import {Pages} from './pages.js';
import * as sentences from './sentences.js';
import {Sounds} from './sounds.js';
import {nextPicture, pause, Trouble} from './trouble.js';

const kMostPixels = 2;    // drawn a CSS pixel's side
const kTold_ms = 100;     // the page follows so often
const kLoad_ms = 16;      // between two tasks that make ready what has come
const kMeanwhile_ms = 20; // of pictures that take longer, hands are heard and people walk so often, a step at most each time
const kAway_ms = 1000;    // who comes back to a tab that was hidden longer goes on where they were
const kTriesOfContext = 4, kHolds_ms = 20000;  // in a row; a picture that stood so long was no vain try
const kSpeaks = 1;        // of the messages; flaneur-tour.js knows which it understands
const kSettings = 'flaneur settings ' + new URL('.', location).pathname;

const page = document.getElementById('tour'), caption = document.getElementById('caption');
const message = document.getElementById('message'), progress = document.getElementById('progress');
const poster = document.getElementById('poster'), begin = document.getElementById('begin');

const wishes = () => new URLSearchParams(location.hash.slice(1));
const language = () => wishes().get('lang') || navigator.language.slice(0, 2);
const say = (kind) => sentences.say(kind, shown?.language ?? language());
let shown = null;  // of the last picture
let seenSince = Infinity;

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

// A sentence over the still picture, and where it may help a button to try again.
function fail(trouble) {
  const kind = trouble instanceof Trouble ? trouble.kind : 'fault';
  if (kind === 'fault') console.error(trouble);
  document.getElementById('canvas')?.remove();
  poster.hidden = false;
  caption.hidden = document.getElementById('bar').hidden = true;
  page.dataset.state = 'failed';
  showMessage(say(kind) + (trouble.message ? ' (' + trouble.message + ')' : ''));
  tell('failed', {kind, detail: trouble.message});
  if (kind === 'webgl' || kind === 'browser' || kind === 'version') return;
  const once = new AbortController(), signal = once.signal;
  const again = () => {
    once.abort();
    run();
  };
  offerToBegin('again', again, signal);
  if (kind === 'cut') addEventListener('online', again, {signal});
}

function offerToBegin(word, press, signal) {
  begin.textContent = say(word);
  begin.hidden = false;
  begin.addEventListener('click', press, {once: true, signal});
}

// What the visitor likes, as of their last visit, else as the browser says.
function settings() {
  let kept = null;
  try {
    kept = localStorage.getItem(kSettings);
  } catch {}
  const likes = (what) => matchMedia(what).matches;
  return kept ?? `pointer = "point"\nreduced_motion = ${likes('(prefers-reduced-motion: reduce)')}\n` +
    `high_contrast = ${likes('(prefers-contrast: more)')}\n`;
}

function keepSettings(text) {
  try {
    if (text) localStorage.setItem(kSettings, text);
  } catch {}
}

function newCanvas() {
  const canvas = document.createElement('canvas');
  canvas.id = 'canvas';
  canvas.tabIndex = 0;
  canvas.setAttribute('role', 'application');
  canvas.setAttribute('aria-label', document.title);
  canvas.setAttribute('aria-describedby', 'caption');
  document.getElementById('canvas')?.remove();
  page.prepend(canvas);
  return canvas;
}

// What the page's own scripts and whoever embeds it may ask for.
function offer(player, described) {
  const commands = {
    goToStop: (stop) => player.do('page_go_to_stop', ['number'], [stop - 1]),
    setLanguage: (code) => player.do('page_language', ['string'], [code]),
    takeTour: (follows) => player.do('page_take_tour', ['number'], [follows ? 1 : 0]),
    pause: (pauses) => player.do('page_pause', ['number'], [pauses ? 1 : 0]),
  };
  page.flaneur = {...commands, description: described, state: () => player.read('page_state'),
                  hotspots: () => player.read('page_hotspots'), heapBytes: () => player.module.HEAPU8.length};
  return commands;
}

function takeWishes(commands) {
  const stop = Number(wishes().get('stop'));
  commands.setLanguage(language());
  if (Number.isInteger(stop) && stop > 0) commands.goToStop(stop);
}

// True: it says something else now.
function showCaption(state) {
  Object.assign(page.dataset, {textSize: state.text_size, contrast: state.high_contrast ? 'high' : 'usual',
                               motion: state.reduced_motion ? 'reduced' : 'usual'});
  caption.hidden = !state.caption;
  caption.lang = state.language;
  if (state.caption === caption.textContent) return false;  // which screen readers would say again
  caption.textContent = state.caption;
  return true;
}

// `inTask` calls what it is given, soon: together it would be a long task. Pages follow at once: hands may open another
// until then, which an older state would close.
function follow(state, parts, inTask) {
  parts.pages.show(state);
  for (const part of [parts.bar, parts.hands]) inTask(() => part.show(state));
  inTask(() => {
    parts.sounds.follow();
    keepSettings(parts.player.text('page_settings'));
  });
  inTask(() => {
    if (showCaption(state)) inTask(() => caption.classList.toggle('scrolls', caption.scrollHeight > caption.clientHeight));
  });
  inTask(() => tellOf(state));
}

function tellOf(state) {
  if (state.resting && (!shown?.resting || shown.stop !== state.stop)) tell('stop-reached', {stop: state.stop + 1});
  if (state.over && !shown?.over) tell('ended');
  shown = state;
}

function fit(canvas) {
  const scale = Math.min(devicePixelRatio, kMostPixels);
  const width = Math.round(canvas.clientWidth * scale), height = Math.round(canvas.clientHeight * scale);
  if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
}

function drawPictures(canvas, parts, visit) {
  const {player, hands, pages, marks} = parts;
  let last = 0, told = 0, stepped = 0, timer = 0;
  return new Promise((_, reject) => {
    parts.headset.onTrouble = reject;
    const attempt = (work) => {
      if (visit.signal.aborted) return;
      try {
        work();
      } catch (e) {
        reject(e);
        visit.abort();
      }
    };
    const goOnMeanwhile = () => attempt(() => {
      if (parts.headset.isWorn || document.hidden) return;
      const now = performance.now(), passed_ms = now - stepped < kAway_ms ? now - stepped : 0;
      stepped = now;
      timer = setTimeout(goOnMeanwhile, kMeanwhile_ms);
      hands.takeGamepad();
      player.call('page_meanwhile', ['number'], [passed_ms / 1000]);
    });
    const draw = (now) => attempt(() => {
      requestAnimationFrame(draw);
      // In software, which takes the cores from the page's own work.
      if (!parts.headset.isWorn && player.ask('page_is_busy')) return;
      clearTimeout(timer);
      const passed_ms = last && now - last < kAway_ms && !parts.headset.isWorn ? now - last : 0;
      last = now;
      if (parts.headset.isWorn) return;  // which asks for its own pictures
      fit(canvas);
      hands.takeGamepad();
      player.call('page_picture', ['number', 'number', 'number', 'number'],
                  [canvas.width, canvas.height, passed_ms / 1000, passed_ms]);
      if (player.ask('page_photo_taken')) pages.takePhoto(canvas, player.read('page_state').page?.line ?? '');
      if (shown) marks.follow(shown);
      if (now - told > kTold_ms) {
        told = now;
        const inTask = (work) => setTimeout(() => attempt(work));  // not in the time of a picture
        inTask(() => follow(player.read('page_state'), parts, inTask));
      }
      stepped = performance.now();
      timer = setTimeout(goOnMeanwhile, kMeanwhile_ms);
    });
    // Whatever draws, the page or a headset, and however slowly.
    const loadMore = () => attempt(() => {
      if (!player.isAllLoaded()) setTimeout(loadMore, kLoad_ms);
    });
    requestAnimationFrame(draw);
    setTimeout(loadMore);
  });
}

function listen(commands, visit) {
  const {signal} = visit;
  addEventListener('hashchange', () => takeWishes(commands), {signal});
  addEventListener('message', (e) => {
    const wish = e.data?.flaneur;
    if (e.source === parent && Object.hasOwn(commands, wish)) commands[wish](e.data.value);
  }, {signal});
}

// The player with as much of the tour as a first picture takes. While the line brings more, the player makes ready what it
// can: its shaders, and the tour as soon as its beginning is there.
async function load(store, site, canvas, fetcher) {
  const first = site.pieces.slice(0, site.first), opens = first.slice(0, site.opens), opening = new Set(opens), waiting = [];
  let player = null, came = 0;
  const goOn = () => {
    if (!player) return;
    for (const [piece, content] of waiting.splice(0)) {
      player.arrive(piece, content);
      if (opening.delete(piece) && opening.size === 0) player.call('page_open', ['string'], [settings()]);
    }
  };
  const begun = makeModule(store, site, canvas).then((module) => {
    const made = new Player(module);
    made.call('page_expect', ['number'], [site.bytes]);
    made.call('page_prepare', ['string'], ['#canvas']);
    player = made;
    goOn();
  });
  const take = (piece, content) => {
    waiting.push([piece, content]);
    progress.value = ++came / first.length;
    goOn();
  };
  // The others are unpacked beside the page, which is busy with the beginning.
  await Promise.all([begun, fetchPieces(store, opens, take, opens.length), fetcher.fetch(first.slice(site.opens), take)]);
  player.call('page_begin');
  while (!player.isLoaded()) await pause(0);
  return player;
}

function build(canvas, player, described, visit) {
  const {signal} = visit, known = new Map();
  const wordsIn = (code) => {
    if (!known.has(code)) known.set(code, player.read('page_words', ['string'], [code]));
    return known.get(code);
  };
  const pages = new Pages(page, player, wordsIn, signal);
  const parts = {player, pages, hands: new Hands(canvas, player, pages, signal), sounds: new Sounds(player, signal),
          bar: new Bar(page, described, player, wordsIn, signal), marks: new HotspotMarks(page, player, wordsIn, signal)};
  parts.headset = new Headset(page, player, (state) => follow(state, parts, (work) => work()), wordsIn, signal);
  offerHeadset(parts).catch(() => {});
  return parts;
}

async function offerHeadset({headset, bar, pages}) {
  if (!await Headset.isThere()) return;
  bar.addHeadset(say('headset'), () => {
    pages.close();
    headset.enter().catch((e) => e.name === 'AbortError' || showMessage(`${say('noHeadset')} (${e.message})`));
  });
}

async function visitTour(visit, wishesNow) {
  if (!globalThis.DecompressionStream || !globalThis.WebAssembly) throw new Trouble('browser');
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
  const fetcher = new PieceFetcher(store, visit.signal);
  const player = await load(store, site, canvas, fetcher);
  const described = player.read('page_description');
  const commands = offer(player, described);
  wishesNow(commands);
  listen(commands, visit);
  poster.hidden = true;
  showMessage('');
  page.dataset.state = 'visiting';
  seenSince = performance.now();
  const parts = build(canvas, player, described, visit);
  canvas.focus();
  const drawn = drawPictures(canvas, parts, visit);
  await Promise.race([lost, drawn, nextPicture().then(nextPicture)]);  // what is not in it does not hold it up
  tell('tour-loaded', described);
  keepPage();
  const all = fetcher.fetch(site.pieces.slice(site.first), (piece, content) => player.arrive(piece, content),
                            (cut) => cut !== message.hidden || showMessage(cut ? say('cutMeanwhile') : ''))
    .then(async () => {
      fetcher.end();
      await forgetOthers(store, site);
      tell('complete');
      page.dataset.complete = 'yes';
    });
  await Promise.race([lost, drawn, all.then(() => new Promise(() => {}))]);
}

// For a visit without a network; what it fetches for that does not hold up the first picture.
function keepPage() {
  if ('serviceWorker' in navigator) navigator.serviceWorker.register('worker.js').catch(() => {});
}

// Where the device takes the picture away, it is set up anew, at the same stop.
async function run() {
  tell('begun');
  begin.hidden = true;
  showMessage('');
  progress.hidden = false;
  let again = takeWishes;
  for (let tries = 1;; ++tries) {
    const visit = new AbortController();
    seenSince = Infinity;
    try {
      page.dataset.state = 'loading';
      await visitTour(visit, again);
    } catch (e) {
      visit.abort();
      if (!(e instanceof Trouble) || e.kind !== 'lost') return fail(e);
      if (performance.now() - seenSince > kHolds_ms) tries = 1;
      if (tries === kTriesOfContext) return fail(new Trouble('gone'));
      const before = shown;
      poster.hidden = false;
      showMessage(say('lost'));
      again = (commands) => {
        takeWishes(commands);
        if (before?.language) commands.setLanguage(before.language);
        if (before?.stop >= 0) commands.goToStop(before.stop + 1);
      };
      await pause(1000);
    }
  }
}

tell('ready', {speaks: kSpeaks});
if (parent !== window) offerToBegin('begin', run);
else run();
