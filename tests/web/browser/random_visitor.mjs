// random_visitor.mjs SITE [SECONDS [SEED]]: somebody who presses, drags, turns, resizes, reloads, loses the line and the graphics card in any
// order, in Debian's Chromium. What the page may never do: throw, complain on the console, stop drawing, say that it failed, or
// come to a place that is none. Prints the seed, so that the same visitor comes again; exit status 1 with what was wrong.
import fs from 'node:fs';
import path from 'node:path';
import {launch, serve} from './chromium.mjs';

const [site, seconds = '120', seedGiven] = process.argv.slice(2);
if (!site || !fs.existsSync(path.join(site, 'tour.json'))) {
  console.error('random_visitor.mjs: error: name a folder that flaneur web wrote');
  process.exit(2);
}
let seed = Number(seedGiven ?? 1 + Date.now() % 1000000);
console.log(`seed ${seed}`);
function random() {  // of Park and Miller (1988): the same visitor for a seed
  seed = seed * 48271 % 2147483647;
  return seed / 2147483647;
}
const below = (n) => Math.floor(random() * n);
const one = (all) => all[below(all.length)];
const pause = (ms) => new Promise((done) => setTimeout(done, ms));

const {url} = await serve(site);
const browser = await launch(120000);
const page = await browser.newPage();
const hand = await page.createCDPSession();
const done = [], wrong = [];
let lost_ms = -Infinity;
const kBrowsersOwn = /CONTEXT_LOST_WEBGL|context lost|ERR_INTERNET_DISCONNECTED|GPU stall|restoreContext/i;  // what was done to it
page.on('console', (m) => { if (/^(error|warn)/.test(m.type()) && !kBrowsersOwn.test(m.text())) wrong.push(`${m.type()}: ${m.text()}`); });
page.on('pageerror', (e) => wrong.push(`thrown: ${e.stack ?? e.message}`));
page.on('dialog', (d) => d.dismiss());

const kKeys = ['w', 'a', 's', 'd', 'ArrowUp', 'ArrowDown', 'ArrowLeft', 'ArrowRight', 'Escape', 'Tab', 'Enter', ' ', 'm', 'p', 'h', 'n', 'b', 'e', 'q', 't', 'c',
  'f', 'l', 'r', 'o', '1', '2', '9', '+', '-', 'Shift', 'Control', 'PageUp', 'Home', 'F1'];
const kSizes = [[320, 200], [360, 740], [740, 360], [800, 600], [1024, 768], [200, 900]];
const kHashes = ['', 'stop=1', 'stop=3&lang=de', 'stop=99', 'stop=-1', 'stop=abc', 'lang=zz', 'lang=fr', 'lang=', 'stop=2&stop=3', '%', 'x=y'];
const somewhere = () => { const {width, height} = page.viewport(); return [below(width), below(height)]; };

const kActs = {
  async key() {
    const key = one(kKeys);
    await page.keyboard.down(key);
    await pause(one([0, 0, 50, 700]));
    await page.keyboard.up(key);
    return key;
  },
  async keys() {  // two at once, let go in any order
    const [a, b] = [one(kKeys), one(kKeys)];
    for (const key of [a, b]) await page.keyboard.down(key);
    await pause(below(600));
    for (const key of random() < 0.5 ? [a, b] : [b, a]) await page.keyboard.up(key);
    return `${a} ${b}`;
  },
  async click() {
    const at = somewhere();
    await page.mouse.click(...at, {count: one([1, 1, 2]), button: one(['left', 'left', 'right', 'middle'])});
    return at.join(' ');
  },
  async drag() {
    await page.mouse.move(...somewhere());
    await page.mouse.down();
    for (let k = below(5); k >= 0; --k) await page.mouse.move(...somewhere(), {steps: 3});
    await page.mouse.up();
  },
  async wheel() { await page.mouse.wheel({deltaY: below(800) - 400}); },
  async press() {  // whatever can be pressed
    const things = await page.$$('button, input, select, summary, a[href^="#"], [role=button]');
    if (things.length === 0) return 'nothing';
    const told = await one(things).evaluate((e, share) => {
      if (!e.checkVisibility() || e.disabled) return '';
      if (e.tagName === 'SELECT') {
        e.selectedIndex = Math.floor(share * e.options.length);
        e.dispatchEvent(new Event('change', {bubbles: true}));
      } else if (e.type === 'range') {
        e.value = Number(e.min) + share * (Number(e.max) - Number(e.min));
        for (const event of ['input', 'change']) e.dispatchEvent(new Event(event, {bubbles: true}));
      } else {
        e.click();
      }
      return e.textContent.trim() || e.id || e.tagName;
    }, random());
    return told;
  },
  async tap() { const [x, y] = somewhere(); await page.touchscreen.tap(x, y); return `${x} ${y}`; },
  async fingers() {  // one to three of them, of which some leave the page or are taken away
    const points = Array.from({length: 1 + below(3)}, (_, id) => { const [x, y] = somewhere(); return {x, y, id}; });
    await hand.send('Input.dispatchTouchEvent', {type: 'touchStart', touchPoints: points});
    for (let k = below(4); k >= 0; --k) {
      for (const p of points) [p.x, p.y] = somewhere();
      await hand.send('Input.dispatchTouchEvent', {type: 'touchMove', touchPoints: points});
    }
    await hand.send('Input.dispatchTouchEvent', {type: one(['touchEnd', 'touchCancel']), touchPoints: []});
    return `${points.length}`;
  },
  async size() {
    const [width, height] = one(kSizes);
    await page.setViewport({width, height, deviceScaleFactor: one([1, 1, 2]), hasTouch: true});
    return `${width} x ${height}`;
  },
  async hash() { const hash = one(kHashes); await page.evaluate((h) => { location.hash = h; }, hash); return hash; },
  async ask() {  // as scripts of a page that embeds it may, rightly or not
    const name = one(['goToStop', 'setLanguage', 'takeTour', 'pause']), value = one([1, 2, 99, -3, 0.5, null, 'de', 'xx', '', true, {}, [], 1e300]);
    if (random() < 0.5) await page.evaluate((n, v) => document.getElementById('tour').flaneur?.[n](v), name, value);
    else await page.evaluate((n, v) => postMessage({flaneur: n, value: v}, '*'), name, value);
    return `${name} ${JSON.stringify(value)}`;
  },
  async lose() {  // the page gives up where that happens again and again
    if (performance.now() - lost_ms < 30000) return 'not so soon';
    lost_ms = performance.now();
    await page.evaluate(async (back_ms) => {
      const lost = document.getElementById('canvas')?.getContext('webgl2')?.getExtension('WEBGL_lose_context');
      lost?.loseContext();
      if (back_ms < 0) return;
      await new Promise((done) => setTimeout(done, back_ms));
      lost?.restoreContext();
    }, one([0, 300, 1500]));
  },
  async line() {
    await page.setOfflineMode(true);
    await pause(one([100, 1500]));
    await page.setOfflineMode(false);
  },
  async leave() {  // to another tab, and back
    const other = await browser.newPage();
    await other.bringToFront();
    await pause(one([200, 2500]));
    await page.bringToFront();
    await other.close();
  },
  async wait() { await pause(below(3000)); },
};
const kOften = ['key', 'key', 'key', 'keys', 'click', 'drag', 'press', 'press', 'press', 'tap', 'fingers', 'wheel'];
const kSeldom = ['size', 'hash', 'ask', 'wait', 'leave', 'lose', 'line'];

const look = () => page.evaluate(() => {
  const tour = document.getElementById('tour'), message = document.getElementById('message');
  return {shown: tour.dataset.state, message: message.hidden ? '' : message.textContent, state: tour.flaneur?.state() ?? null};
});

async function isPlaying(most_s) {
  for (const end = Date.now() + 1000 * most_s; Date.now() < end; await pause(300)) {
    const {state, shown} = await look();
    if (shown === 'failed') return false;
    if (state && state.pictures > 0) return true;
  }
  return false;
}

async function check() {
  const before = await look();
  if (!before.state) return (await isPlaying(60)) || wrong.push(`does not play: ${JSON.stringify(before)}`);
  for (const end = Date.now() + 30000; Date.now() < end; await pause(200)) {
    const {state, shown, message} = await look();
    if (shown === 'failed') return wrong.push(`failed: ${message}`);
    if (state && !state.place_m.every(Number.isFinite)) return wrong.push(`at ${state.place_m}`);
    if (state && state.pictures !== before.state.pictures) return true;
  }
  return wrong.push(`draws no more: ${JSON.stringify(await look())}`);
}

await page.setViewport({width: 640, height: 400, hasTouch: true});
await page.goto(url);
let loads = 1;
if (!await isPlaying(90)) wrong.push('the tour does not begin');
for (const end = Date.now() + 1000 * Number(seconds); Date.now() < end && wrong.length === 0;) {
  if (random() < 0.004) {  // in the middle of whatever is going on
    await page.goto('about:blank');
    await page.goto(url + one(['', '#stop=2', '#lang=it']));
    ++loads;
  }
  const name = random() < 0.85 ? one(kOften) : one(kSeldom);
  done.push(name);
  done[done.length - 1] = `${name} ${await kActs[name]() ?? ''}`.trim();
  if (done.length % 10 === 0) await check();
}
if (wrong.length === 0) await check();
console.log(`${done.length} acts, ${loads} loads, ${wrong.length} faults`);
if (wrong.length > 0) console.log(`${wrong.slice(0, 5).join('\n')}\nafter ${done.slice(-25).join(' | ')}`);
await browser.close();
process.exit(wrong.length > 0 ? 1 : 0);
