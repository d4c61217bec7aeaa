// page_test.mjs FLANEUR PACK PLAYER_FOLDER: the site of a tour as visitors meet it, in Debian's Chromium.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import {createRequire} from 'node:module';
import {launch, serve} from './chromium.mjs';

const [flaneur, pack, player] = process.argv.slice(2);
const axeCore = fs.readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');

const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'flaneur_page_'));
const site = path.join(folder, 'site');
const open = [];  // to be closed at the end
let failed = 0;

async function newPage(url, prepare = async () => {}) {
  const browser = await launch(300000, '--autoplay-policy=no-user-gesture-required');
  open.push(browser);
  const page = await browser.newPage();
  await page.setViewport({width: 320, height: 200});
  page.setDefaultNavigationTimeout(180000);
  page.said = [];
  page.on('console', (m) => page.said.push(`${m.type()}: ${m.text()}`));
  page.on('pageerror', (e) => page.said.push(`error: ${e.message}`));
  await prepare(page);
  await page.goto(url);
  return page;
}

const end = (page) => page.browser().close();
const inState = (page, state) => page.waitForFunction(
  (s) => document.getElementById('tour').dataset.state === s, {timeout: 120000}, state);
const complete = (page) => page.waitForFunction(
  () => document.getElementById('tour').flaneur?.state().complete && document.getElementById('tour').dataset.complete, {timeout: 180000});
const stateOf = (page) => page.evaluate(() => document.getElementById('tour').flaneur.state());
const sentence = (page) => page.$eval('#message', (e) => (e.hidden ? '' : e.textContent));
const pause = (ms) => new Promise((done) => setTimeout(done, ms));
const apart = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]);

// Until it holds, but not for ever.
async function until(page, what, holds, timeout_s = 60) {
  let state = null;
  for (const end = Date.now() + 1000 * timeout_s; Date.now() < end; await pause(200)) {
    state = await stateOf(page);
    if (holds(state)) return state;
  }
  assert.fail(`${what}: not within ${timeout_s} s: ${JSON.stringify(state)}`);
}

// A finger's short touch; the page's time to take its beginning is no part of it.
async function tap(page, x, y) {
  const hand = await page.createCDPSession();
  await Promise.all([
    hand.send('Input.dispatchTouchEvent', {type: 'touchStart', touchPoints: [{x, y}]}),
    hand.send('Input.dispatchTouchEvent', {type: 'touchEnd', touchPoints: []}),
  ]);
  await hand.detach();
}

// What axe-core calls serious or critical.
async function withoutSeriousFindings(page, where) {
  await page.evaluate(axeCore);
  const found = await page.evaluate(() => globalThis.axe.run(document, {resultTypes: ['violations']}));
  const serious = found.violations.filter((v) => v.impact === 'serious' || v.impact === 'critical');
  assert.deepEqual(serious.map((v) => `${v.id}: ${v.nodes.map((n) => n.html).join(' ').slice(0, 300)}`), [], where);
}

// A headset and its two controllers, as WebXR sees them.
const kHeadset = fs.readFileSync(createRequire(import.meta.url).resolve('iwer/build/iwer.min.js'), 'utf8') + `
  globalThis.device = new IWER.XRDevice(IWER.metaQuest3);
  device.installRuntime({forceInstall: true});
  device.stereoEnabled = true;
  device.position.set(0, 1.6, 0);`;

// Both halves of what the headset shows, in grey.
const eyePictures = (page) => page.evaluate(() => new Promise((done) => {
  const take = () => {
    const canvas = document.querySelector('canvas#canvas') ?? [...document.querySelectorAll('canvas')].find((c) => c.getContext('webgl2'));
    const copy = Object.assign(document.createElement('canvas'), {width: canvas.width, height: canvas.height}), ink = copy.getContext('2d', {willReadFrequently: true});
    ink.drawImage(canvas, 0, 0);
    const half = canvas.width >> 1;
    const grey = (left) => {
      const {data} = ink.getImageData(left, 0, half, canvas.height);
      return Array.from({length: data.length / 4}, (_, k) => (data[4 * k] + data[4 * k + 1] + data[4 * k + 2]) / 3);
    };
    done({width: half, height: canvas.height, left: grey(0), right: grey(half)});
  };
  requestAnimationFrame(() => requestAnimationFrame(take));
}));
// Their mean difference where the right one is moved so many pixels to the right.
function difference({width, height, left, right}, shift) {
  let sum = 0, count = 0;
  for (let y = 0; y < height; ++y) {
    for (let x = 24; x < width - 24; ++x, ++count) sum += Math.abs(left[y * width + x] - right[y * width + x - shift]);
  }
  return sum / count;
}

// Counts what OpenGL complains of after each picture.
const countErrors = (page) => page.evaluateOnNewDocument(() => {
  globalThis.glErrors = [];
  const get = HTMLCanvasElement.prototype.getContext;
  HTMLCanvasElement.prototype.getContext = function(...kind) {
    const gl = get.apply(this, kind);
    if (gl?.getError) {
      globalThis.gl = gl;
      const look = () => {
        for (let e = gl.getError(); e && e !== gl.CONTEXT_LOST_WEBGL; e = gl.getError()) globalThis.glErrors.push(e);
        requestAnimationFrame(look);
      };
      requestAnimationFrame(look);
    }
    return gl;
  };
});

// The lines that `flaneur web` prints for other pages: a frame, and a script with the element.
function snippets(address) {
  const printed = execFileSync(flaneur, ['web', pack, '-o', path.join(folder, 'again'), '--player', player, '--address', address], {encoding: 'utf8'});
  const lines = printed.split('\n').filter((line) => line.startsWith('<'));
  assert.equal(lines.length, 3, printed);
  return lines;
}

const tests = {
  async 'the first picture has people, and neither the console nor OpenGL complains'() {
    const host = await serve(site);
    const page = await newPage(host.url, countErrors);
    await inState(page, 'visiting');
    const state = await until(page, 'people', (s) => s.pictures > 0 && s.people_drawn > 0);
    assert.equal(await sentence(page), '');
    const list = JSON.parse(fs.readFileSync(path.join(site, 'tour.json')));
    assert.ok(list.first < list.pieces.length, 'all pieces are needed for the first picture');
    await complete(page);
    await until(page, 'more pictures', (s) => s.pictures > state.pictures + 3);
    assert.deepEqual(await page.evaluate(() => globalThis.glErrors), []);
    assert.deepEqual(page.said, []);
    assert.ok(host.asked.every((name) => fs.existsSync(path.join(site, name)) || name === 'favicon.ico'), host.asked.join(' '));
    await end(page);
    await host.close();
  },
  async 'before the first picture nothing is asked for that it does not need, and all scripts at once'() {
    const host = await serve(site);
    const page = await newPage(host.url), {asked} = host;  // also what the page's workers ask for
    await inState(page, 'visiting');
    await until(page, 'a picture', (s) => s.pictures > 0);
    const list = JSON.parse(fs.readFileSync(path.join(site, 'tour.json')));
    const until_first = asked.slice(0, asked.indexOf(list.pieces[list.first - 1].file) + 1);
    assert.ok(until_first.length > list.first, asked.join(' '));
    assert.ok(!until_first.includes('worker.js'), asked.join(' '));
    const scripts = asked.filter((name) => name.endsWith('.js') && !name.startsWith('player-') && !name.endsWith('worker.js'));
    assert.ok(scripts.every((name) => asked.indexOf(name) < asked.indexOf('tour.json')), asked.join(' '));
    assert.ok(asked.indexOf(list.script) < asked.indexOf(list.pieces[list.opens].file), asked.join(' '));
    assert.ok(0 < list.opens && list.opens < list.first, JSON.stringify([list.opens, list.first]));
    await end(page);
    await host.close();
  },
  async 'keys walk and turn, a drag turns, a tap walks there, two fingers widen the view, a gamepad turns'() {
    const host = await serve(site);
    const page = await newPage(host.url, (p) => p.emulate({viewport: {width: 320, height: 480, hasTouch: true, isMobile: true}, userAgent: 'phone'}));
    await inState(page, 'visiting');
    let before = await stateOf(page);
    await page.keyboard.down('KeyW');
    await until(page, 'walks by keys', (s) => !s.follows_tour && apart(s.place_m, before.place_m) > 1);
    await page.keyboard.up('KeyW');
    before = await stateOf(page);
    const touch = await page.touchscreen.touchStart(160, 240);
    for (let x = 160; x > 60; x -= 10) await touch.move(x, 240);
    await touch.end();
    // The picture goes with the finger: to the left, so that the eye turns to the right.
    await until(page, 'turns', (s) => Math.sin(s.yaw_rad - before.yaw_rad) < -0.05);
    await pause(1500);
    before = await stateOf(page);
    assert.equal(await page.evaluate(() => {
      const caption = document.getElementById('caption');
      caption.hidden = false;
      caption.textContent ||= 'words over the town';
      const box = caption.getBoundingClientRect();
      return document.elementFromPoint(box.x + box.width / 2, box.y + box.height / 2).id;
    }), 'canvas', 'a caption is in the way of hands');
    await tap(page, 160, 380);
    await until(page, 'goes where was tapped', (s) => apart(s.place_m, before.place_m) > 0.4);
    before = await stateOf(page);
    const a = await page.touchscreen.touchStart(140, 240), b = await page.touchscreen.touchStart(180, 240);
    for (let k = 1; k < 9; ++k) await a.move(140 - 8 * k, 240), await b.move(180 + 8 * k, 240);
    await a.end(), await b.end();
    await until(page, 'a narrower view', (s) => s.fov_rad < before.fov_rad - 0.1);
    before = await stateOf(page);
    await page.evaluate(() => {  // as a browser tells of a gamepad: when its first button is pressed
      const pad = {mapping: 'standard', buttons: Array.from({length: 17}, () => ({pressed: false})), axes: [0, 0, 1, 0]};
      navigator.getGamepads = () => [null, pad];
      dispatchEvent(new Event('gamepadconnected'));
    });
    await until(page, 'a stick turns', (s) => Math.sin(s.yaw_rad - before.yaw_rad) < -0.05);
    await end(page);
    await host.close();
  },
  async 'the keyboard alone reaches buttons and pages, which screen readers find, and settings are kept'() {
    const host = await serve(site);
    const page = await newPage(host.url + '#lang=de');
    await inState(page, 'visiting');
    await until(page, 'pictures', (s) => s.pictures > 1);
    const described = await page.evaluate(() => document.getElementById('tour').flaneur.description);
    await withoutSeriousFindings(page, 'the town');
    const focused = () => page.evaluate(() => document.activeElement.getAttribute('aria-label') ?? document.activeElement.textContent);
    const reached = [];
    for (let k = 0; k < 12; ++k) {
      await page.keyboard.press('Tab');
      if (await page.evaluate(() => document.activeElement.closest('#bar') !== null)) reached.push(await focused());
    }
    const labels = await page.$$eval('#bar button', (all) => all.map((e) => e.getAttribute('aria-label')));
    assert.ok(labels.length > 6 && labels.every((l) => l), labels.join(', '));
    assert.deepEqual([...new Set(reached)].sort(), [...labels].sort(), 'Tab does not reach all');
    const press = async (at) => {
      await page.focus(`#bar button:nth-of-type(${at})`);
      await page.keyboard.press('Enter');
    };
    await press(2);
    await until(page, 'the tour waits', (s) => s.paused);
    await press(2);
    await until(page, 'the tour goes on', (s) => !s.paused);
    await press(1);
    await until(page, 'a way of one\'s own', (s) => !s.follows_tour);
    await press(1);
    await until(page, 'the tour again', (s) => s.follows_tour);

    const row = async (name, index) => {  // of the page that is open, by arrows and Enter
      await until(page, `page ${name}`, (s) => s.page?.name === name);
      await page.waitForFunction((n) => document.querySelector('#pages').className === 'of-' + n, {timeout: 30000}, name);
      for (let k = 0; k < 60; ++k) {
        const at = await page.evaluate(() => [...document.querySelectorAll('#pages button')].indexOf(document.activeElement));
        const wanted = index < 0 ? await page.$$eval('#pages button', (all) => all.length) + index : index;
        if (at === wanted) break;
        await page.keyboard.press('ArrowDown');
      }
      await page.keyboard.press('Enter');
    };
    const rowOf = async (id) => (await stateOf(page)).page.rows.findIndex((r) => r.id === id);
    await page.focus('#canvas');
    await page.keyboard.press('Escape');
    await until(page, 'the pages', (s) => s.page?.name === 'main');
    await page.waitForSelector('#pages[open]');
    await withoutSeriousFindings(page, 'the first page');
    await row('main', await rowOf('settings'));
    await until(page, 'settings', (s) => s.page?.name === 'settings');
    await withoutSeriousFindings(page, 'settings');
    await row('settings', 0);
    await until(page, 'larger text', (s) => s.text_size === 'large');
    await page.waitForFunction(() => document.getElementById('tour').dataset.textSize === 'large');
    await row('settings', 1);
    await until(page, 'high contrast', (s) => s.high_contrast);
    await withoutSeriousFindings(page, 'high contrast');
    await page.keyboard.press('Escape');
    await until(page, 'the first page again', (s) => s.page?.name === 'main');
    const halts = described.stops.map((stop, k) => (stop.halt ? k : -1)).filter((k) => k >= 0);
    await row('main', await rowOf('stops'));
    await row('stops', halts.length - 1);
    await until(page, 'the last stop', (s) => s.stop === halts.at(-1) && s.follows_tour && !s.page);
    await page.focus('#canvas');
    const german = labels[0];
    await page.keyboard.press('Escape');
    await until(page, 'the pages', (s) => s.page?.name === 'main');
    await row('main', await rowOf('language'));
    await until(page, 'languages', (s) => s.page?.name === 'languages');
    await row('languages', await rowOf('en'));
    await until(page, 'English', (s) => s.language === 'en');
    await page.waitForFunction((was) => document.querySelector('#bar button').title !== was, {timeout: 30000}, german);
    await page.reload();
    await inState(page, 'visiting');
    const state = await until(page, 'pictures', (s) => s.pictures > 1);
    assert.equal(state.text_size, 'large', 'the settings are not kept');
    assert.deepEqual(page.said, []);
    await end(page);
    await host.close();
  },
  async 'the page that is open stays open, however late a slow browser\'s tasks are'() {
    const host = await serve(site);
    const page = await newPage(host.url + '#lang=en', (p) => p.evaluateOnNewDocument(() => {
      const inTime = globalThis.setTimeout;
      globalThis.late_ms = 0;
      globalThis.setTimeout = (work, ms = 0, ...rest) => inTime(work, ms || globalThis.late_ms, ...rest);
    }));
    await inState(page, 'visiting');
    const shown = await page.evaluate(async () => {
      const pages = document.getElementById('pages'), names = [], {flaneur} = document.getElementById('tour');
      new MutationObserver(() => pages.className !== names.at(-1) && names.push(pages.className)).observe(pages, {attributeFilter: ['class']});
      const come = async (name) => {
        while (flaneur.state().page?.name !== name || pages.className !== 'of-' + name) await new Promise(requestAnimationFrame);
      };
      document.querySelector('#bar button:nth-last-of-type(2)').click();  // the menu; full screen is the last
      await come('main');
      globalThis.late_ms = 300;
      await new Promise((done) => setTimeout(done, 1000));
      for (let k = 0; k < 5; ++k) {
        await come('main');
        const {rows} = flaneur.state().page;
        pages.querySelectorAll('button')[rows.findIndex((row) => row.id === 'settings')].click();
        await come('settings');
        await new Promise((done) => setTimeout(done, 1000));
        pages.querySelector('.back').click();
      }
      return names;
    });
    assert.deepEqual(shown.map((name) => name.slice(3)), ['main', ...Array(5).fill(['settings', 'main']).flat()]);
    await end(page);
    await host.close();
  },
  async 'text on a canvas keeps within its lines in any script'() {
    const host = await serve(site);
    const page = await newPage(host.url);
    const widest = await page.evaluate(async () => {
      const {directionOf, wrap} = await import('./lines.js');
      const ink = document.createElement('canvas').getContext('2d');
      ink.font = '20px sans-serif';
      const texts = ['Who built the old market? The merchants of salt, cloth and honey.', '这座古老的市场建于一六四二年，由盐商、布商和蜂蜜商人共同出资修建。',
        'Donaudampfschifffahrtsgesellschaftskapitänswitwe', 'بُني سوق المدينة القديم في عام 1642 (الأرشيف).', 'ตลาดเก่าแห่งนี้สร้างขึ้นโดยพ่อค้าเกลือ', ''];
      return texts.map((text) => {
        const lines = wrap(ink, text, 150), letters = (t) => t.replace(/\s/g, '');
        return {text, lines, direction: directionOf(text), all: letters(lines.join('')) === letters(text), most: Math.max(...lines.map((l) => ink.measureText(l).width))};
      });
    });
    for (const {text, lines, all, most} of widest) assert.ok(all && most <= 150 && lines.length >= (text ? 2 : 1), JSON.stringify([text, lines, most]));
    assert.deepEqual(widest.map((w) => w.direction), ['ltr', 'ltr', 'ltr', 'rtl', 'ltr', 'ltr']);
    await end(page);
    await host.close();
  },
  async 'map, photo and what is to be seen are elements of the page, and the town is heard'() {
    const host = await serve(site);
    const page = await newPage(host.url + '#lang=en', (p) => p.evaluateOnNewDocument(() => {
      globalThis.heard = [];
      const start = AudioBufferSourceNode.prototype.start;
      AudioBufferSourceNode.prototype.start = function(...when) {
        globalThis.heard.push({loop: this.loop, seconds: this.buffer.duration, peak: Math.max(...this.buffer.getChannelData(0).slice(0, 50000))});
        return start.apply(this, when);
      };
    }));
    await inState(page, 'visiting');
    await complete(page);
    await page.setViewport({width: 320, height: 400});  // high enough to see towers
    await page.click('#canvas', {offset: {x: 5, y: 200}, button: 'middle'});
    await page.click('#bar button:nth-last-of-type(4)');
    await page.waitForSelector('#pages.of-map canvas', {timeout: 30000});
    const names = await page.$$eval('#pages li button', (all) => all.map((e) => e.textContent));
    const described = await page.evaluate(() => document.getElementById('tour').flaneur.description);
    assert.deepEqual(names, described.stops.filter((s) => s.halt).map((s) => s.name).filter((n) => n));
    const colors = await page.$eval('#pages .map canvas', (canvas) => {
      const pixels = new Uint32Array(canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data.buffer);
      return new Set(pixels).size;
    });
    assert.ok(colors > 20, `the map has ${colors} colours`);
    await page.click('#pages li:last-of-type button');
    await until(page, 'the way there', (s) => !s.page && s.follows_tour);
    await page.click('#bar button:nth-last-of-type(3)');
    await page.waitForSelector('#pages.of-photo img', {timeout: 30000});
    await page.waitForFunction(() => document.querySelector('#pages img').naturalWidth > 0);
    const photo = await page.$eval('#pages img', (img) => [img.naturalWidth, img.naturalHeight]);
    assert.ok(photo[0] === 320 && photo[1] >= 400, String(photo));
    assert.match(await page.$eval('#pages a', (a) => a.download), /\.jpg$/);
    await page.keyboard.press('Escape');
    await until(page, 'the town', (s) => !s.page);
    let title = null;
    for (let stop = 1; stop <= described.stops.length && title === null; ++stop) {
      await page.evaluate((k) => document.getElementById('tour').flaneur.goToStop(k), stop);
      for (let end = Date.now() + 6000; Date.now() < end && title === null; await pause(100)) {
        title = await page.evaluate(() => {
          const mark = document.querySelector('#marks button');
          if (!mark) return null;
          document.getElementById('tour').flaneur.pause(true);
          mark.click();
          return mark.title;
        });
      }
    }
    assert.ok(title !== null, 'nothing tells anything at any stop');
    await page.waitForFunction((t) => document.querySelector('#told h2')?.textContent === t && !document.querySelector('#told').hidden, {timeout: 30000}, title);
    assert.ok((await page.$eval('#told p', (p) => p.textContent)).length > 20);
    const heard = await page.evaluate(() => globalThis.heard);
    assert.ok(heard.some((sound) => sound.loop), 'no murmur goes round');
    assert.ok(heard.some((sound) => !sound.loop && sound.seconds > 1), 'nobody speaks');
    assert.ok(heard.every((sound) => sound.peak > 0.001), JSON.stringify(heard));
    assert.deepEqual(page.said, []);
    await end(page);
    await host.close();
  },
  async 'the address says at which stop and in which language it begins'() {
    const host = await serve(site);
    const page = await newPage(host.url + '#stop=1&lang=de');
    await inState(page, 'visiting');
    const described = await page.evaluate(() => document.getElementById('tour').flaneur.description);
    const language = described.languages.includes('de') ? 'de' : described.languages[0];
    if (described.languages.length > 0) assert.equal((await stateOf(page)).language, language);
    await end(page);
    await host.close();
  },
  async 'graphics cards that read these blocks, those or none draw it without a complaint'() {
    const host = await serve(site);
    for (const missing of ['astc|etc', 'bptc|rgtc|s3tc|astc', 'compressed|compression']) {
      const page = await newPage(host.url, async (p) => {
        await countErrors(p);
        await p.evaluateOnNewDocument((names) => {
          const {getParameter, getExtension, getSupportedExtensions} = WebGL2RenderingContext.prototype, hidden = new RegExp(names, 'i');
          Object.assign(WebGL2RenderingContext.prototype, {
            getParameter(name) { return name === 0x9246 ? 'A card' : getParameter.call(this, name); },  // UNMASKED_RENDERER_WEBGL
            getExtension(name) { return hidden.test(name) ? null : getExtension.call(this, name); },
            getSupportedExtensions() { return getSupportedExtensions.call(this).filter((name) => !hidden.test(name)); }});
        }, missing);
      });
      await inState(page, 'visiting');
      await until(page, 'people', (s) => s.pictures > 20 && s.people_drawn > 0, 120);  // so a card's way to draw takes long here
      assert.deepEqual(await page.evaluate(() => globalThis.glErrors), [], missing);
      assert.deepEqual(page.said, [], missing);
      await end(page);
    }
    await host.close();
  },
  async 'a lost context comes back at the same place, however often in a day'() {
    const host = await serve(site);
    const page = await newPage(host.url, countErrors);
    const lose = () => page.evaluate(() => globalThis.gl.getExtension('WEBGL_lose_context').loseContext());
    for (let time = 0; time < 5; ++time) {
      await inState(page, 'visiting');
      await page.evaluate(() => {  // a minute later
        const now = performance.now.bind(performance);
        performance.now = () => now() + 60000;
      });
      await lose();
      await inState(page, 'loading');
      assert.match(await sentence(page), /moment/);
    }
    await inState(page, 'visiting');
    await until(page, 'pictures', (s) => s.pictures > 1);
    assert.equal(await sentence(page), '');
    await end(page);
    await host.close();
  },
  async 'a context that is lost as soon as it is there is not tried for ever'() {
    const host = await serve(site);
    const page = await newPage(host.url, (p) => p.evaluateOnNewDocument(() => {
      addEventListener('tour-loaded', () => document.getElementById('canvas').getContext('webgl2').getExtension('WEBGL_lose_context').loseContext());
    }));
    await inState(page, 'failed');
    assert.match(await sentence(page), /again and again/);
    assert.equal(await page.$eval('#begin', (e) => e.hidden), false);
    await end(page);
    await host.close();
  },
  async 'without WebGL 2 there is a sentence and the poster'() {
    const host = await serve(site);
    const page = await newPage(host.url, (p) => p.evaluateOnNewDocument(() => {
      HTMLCanvasElement.prototype.getContext = () => null;
    }));
    await inState(page, 'failed');
    assert.match(await sentence(page), /WebGL 2/);
    assert.equal(await page.$eval('#poster', (e) => e.hidden), false);
    await end(page);
    await host.close();
  },
  async 'a piece that is corrupt, cut or missing is one clear sentence'() {
    const list = JSON.parse(fs.readFileSync(path.join(site, 'tour.json')));
    const first = list.pieces[0].file, beside = list.pieces[list.opens].file, last = list.pieces.at(-1).file, whole = fs.readFileSync(path.join(site, first));
    const spoilt = Buffer.from(whole);
    spoilt[spoilt.length >> 1] ^= 0xFF;
    const cases = [[first, {body: spoilt}, /damaged/], [first, {cut: whole.length >> 1}, /line broke/],
                   [first, {status: 404}, /not on this server/],
                   [beside, {body: spoilt}, /damaged/], [beside, {cut: 1000}, /line broke/], [last, {body: spoilt}, /damaged/], [last, {status: 404}, /not on this server/]];
    for (const [victim, answer, expected] of cases) {
      const host = await serve(site, (name) => (name === victim ? answer : null));
      const page = await newPage(host.url);
      await inState(page, 'failed');
      assert.match(await sentence(page), expected);
      await end(page);
      await host.close();
    }
  },
  async 'where the browser starts no worker the page fetches the tour itself'() {
    const host = await serve(site);
    const page = await newPage(host.url, (p) => p.evaluateOnNewDocument(() => {
      globalThis.Worker = class {
        postMessage() { setTimeout(() => this.onerror()); }
        terminate() {}
      };
    }));
    await complete(page);
    assert.deepEqual(page.said, []);
    await end(page);
    await host.close();
  },
  async 'a line that breaks is waited for: before the first picture with a sentence, and after it beside the town'() {
    const list = JSON.parse(fs.readFileSync(path.join(site, 'tour.json')));
    let broken = list.pieces[0].file;
    const host = await serve(site, (name) => (broken && (name === broken || (broken === 'all' && name.startsWith('pieces/'))) ? {cut: 1000} : null));
    const page = await newPage(host.url);
    await inState(page, 'failed');
    assert.match(await sentence(page), /line broke/);
    assert.equal(await page.$eval('#poster', (e) => e.hidden), false);
    assert.equal(await page.$eval('#progress', (e) => e.hidden), true, 'something goes round for ever');
    const cameOnce = host.asked.filter((name) => name === list.pieces[1].file).length;
    broken = '';
    await page.evaluate(() => { addEventListener('tour-loaded', () => { globalThis.cutNow = true; }); });
    await page.evaluate(() => dispatchEvent(new Event('online')));
    await page.waitForFunction(() => globalThis.cutNow, {timeout: 120000, polling: 20});
    broken = 'all';
    await page.waitForFunction(() => !document.getElementById('message').hidden || document.getElementById('tour').dataset.complete, {timeout: 60000});
    if (!await page.evaluate(() => document.getElementById('tour').dataset.complete)) {
      assert.match(await sentence(page), /as soon as/);
      const before = (await stateOf(page)).pictures;
      await until(page, 'the visit goes on', (s) => s.pictures > before + 3);
    }
    broken = '';
    await page.evaluate(() => dispatchEvent(new Event('online')));
    await complete(page);
    assert.equal(await sentence(page), '');
    assert.equal(host.asked.filter((name) => name === list.pieces[1].file).length, cameOnce, 'what had come is fetched again');
    await end(page);
    await host.close();
  },
  async 'a tab that was hidden for an hour goes on where it was, and a phone may be turned'() {
    const host = await serve(site);
    const page = await newPage(host.url, (p) => p.evaluateOnNewDocument(() => {
      globalThis.away_ms = 0;
      const request = globalThis.requestAnimationFrame;
      globalThis.requestAnimationFrame = (draw) => request((now) => draw(now + globalThis.away_ms));
    }));
    await page.setViewport({width: 320, height: 200, hasTouch: true, isMobile: true});
    await inState(page, 'visiting');
    const before = await until(page, 'pictures', (s) => s.pictures > 2);
    await page.evaluate(() => { globalThis.away_ms = 3600e3; });
    const after = await until(page, 'pictures', (s) => s.pictures > before.pictures + 2);
    assert.ok(apart(after.place_m, before.place_m) < 20, 'the tour went on while nobody looked');
    await page.setViewport({width: 200, height: 320, hasTouch: true, isMobile: true});
    const turned = await until(page, 'pictures', (s) => s.pictures > after.pictures + 2);
    assert.ok(turned.people_drawn > 0);
    assert.deepEqual(await page.$eval('#canvas', (c) => [c.width, c.height]), [200, 320]);
    await page.setViewport({width: 360, height: 640, hasTouch: true, isMobile: true});
    const buttons = await page.$$eval('#bar button', (all) => all.filter((b) => b.offsetParent).map((b) => b.getBoundingClientRect().toJSON()));
    assert.ok(buttons.length > 6 && buttons.every((b) => b.top === buttons[0].top && b.width >= 40), JSON.stringify(buttons));
    await page.keyboard.press('Escape');
    await page.waitForSelector('dialog button:focus-visible');
    const rows = await page.$$('dialog button');
    await rows[2].hover();
    assert.equal(await page.$$eval('dialog button', (all) => all.filter((b) => getComputedStyle(b).outlineStyle !== 'none').length), 1,
                 'what the mouse lies on looks as what Enter presses');
    await end(page);
    await host.close();
  },
  async 'where memory is refused there is a sentence'() {
    const host = await serve(site);
    const refusals = [() => { WebAssembly.instantiate = () => Promise.reject(new RangeError('could not allocate memory')); },
                      () => { WebAssembly.Memory.prototype.grow = () => { throw new RangeError('no memory'); }; }];
    for (const refuse of refusals) {
      const page = await newPage(host.url, (p) => p.evaluateOnNewDocument(refuse));
      await inState(page, 'failed');
      assert.match(await sentence(page), /not enough memory/);
      assert.equal(await page.$eval('#poster', (e) => e.hidden), false);
      await end(page);
    }
    await host.close();
  },
  async 'a list of another version is refused'() {
    const list = JSON.parse(fs.readFileSync(path.join(site, 'tour.json')));
    const host = await serve(site, (name) => (name === 'tour.json' ? {body: Buffer.from(JSON.stringify({...list, version: 2}))} : null));
    const page = await newPage(host.url);
    await inState(page, 'failed');
    assert.match(await sentence(page), /another version/);
    await end(page);
    await host.close();
  },
  async 'who has visited it comes again without a network'() {
    const host = await serve(site);
    const page = await newPage(host.url);
    await inState(page, 'visiting');
    await complete(page);
    await page.evaluate(() => navigator.serviceWorker.ready.then(() => {}));
    await page.waitForFunction(() => navigator.serviceWorker.controller, {timeout: 30000});
    await page.reload();  // through the worker, which keeps the player's script
    await inState(page, 'visiting');
    await complete(page);
    await host.close();
    await page.reload();
    await inState(page, 'visiting');
    await until(page, 'people', (s) => s.people_drawn > 0);
    await complete(page);
    await end(page);
  },
  async 'with a headset both eyes see the town, the head turns the view, and controllers walk, turn, leap and press'() {
    const host = await serve(site);
    const page = await newPage(host.url + '#lang=en', async (p) => {
      await countErrors(p);
      await p.evaluateOnNewDocument(kHeadset);
    });
    await page.setViewport({width: 480, height: 240});
    await inState(page, 'visiting');
    await until(page, 'pictures', (s) => s.pictures > 1);
    await page.waitForSelector('#bar button[aria-label="Enter VR"]', {timeout: 30000});
    await page.evaluate(() => document.querySelector('#bar button[aria-label="Enter VR"]').click());
    await page.waitForFunction(() => document.getElementById('tour').dataset.headset === 'worn', {timeout: 30000});
    const before = await stateOf(page);
    let state = await until(page, 'pictures in the headset', (s) => s.pictures > before.pictures + 3 && Math.abs(s.eye_height_m - 1.6) < 0.01);
    assert.ok(state.people_drawn > 0);
    const eyes = await eyePictures(page);
    const mean = (all) => all.reduce((sum, v) => sum + v, 0) / all.length;
    const same = difference(eyes, 0), shifts = Array.from({length: 25}, (_, k) => k - 12), moved = shifts.map((k) => difference(eyes, k));
    const best = shifts[moved.indexOf(Math.min(...moved))];
    assert.ok(mean(eyes.left) > 20 && Math.abs(mean(eyes.left) - mean(eyes.right)) < 12, `${mean(eyes.left)} and ${mean(eyes.right)}`);
    assert.ok(same > 0.5, `the eyes see the same: they differ by ${same}`);
    assert.ok(best >= 0 && best <= 8, `what the right eye sees is ${best} pixels to the left`);

    const yaw = state.yaw_rad;
    await page.evaluate(() => device.quaternion.set(0, Math.sin(0.35), 0, Math.cos(0.35)));
    await until(page, 'the head turned the view to the left', (s) => Math.abs(Math.sin(s.yaw_rad - yaw) - Math.sin(0.7)) < 0.1);
    await page.evaluate(() => device.quaternion.set(0, 0, 0, 1));
    state = await until(page, 'and back', (s) => Math.abs(Math.sin(s.yaw_rad - yaw)) < 0.05);
    const stick = (hand, x, y) => page.evaluate((h, sx, sy) => device.controllers[h].updateAxes('thumbstick', sx, sy), hand, x, y);
    await stick('left', 0, -1);
    const walked = await until(page, 'walks', (s) => apart(s.place_m, state.place_m) > 0.5);
    await stick('left', 0, 0);
    const way = Math.atan2(walked.place_m[1] - state.place_m[1], walked.place_m[0] - state.place_m[0]);
    assert.ok(Math.cos(way - yaw) > 0.7, 'it walks to where the head looks');
    await stick('right', 1, 0);
    await until(page, 'a turn of 30 degrees to the right', (s) => Math.abs(Math.sin(yaw - s.yaw_rad) - 0.5) < 0.05);
    await stick('right', 0, 0);
    await pause(300);
    const stood = await stateOf(page);
    await page.evaluate(() => {
      device.controllers.right.position.set(0.2, 1.2, -0.3);
      device.controllers.right.quaternion.set(-Math.sin(0.25), 0, 0, Math.cos(0.25));  // down
    });
    await stick('right', 0, -1);
    await pause(600);
    await stick('right', 0, 0);
    await until(page, 'a leap', (s) => apart(s.place_m, stood.place_m) > 0.5);
    const press = async (hand, button) => {
      await page.evaluate((h, b) => device.controllers[h].updateButtonValue(b, 1), hand, button);
      await pause(400);
      await page.evaluate((h, b) => device.controllers[h].updateButtonValue(b, 0), hand, button);
    };
    await page.evaluate(() => device.controllers.right.quaternion.set(0, 0, 0, 1));
    await press('left', 'x-button');
    await until(page, 'the pages', (s) => s.page?.name === 'main');
    await pause(500);
    await page.evaluate(() => {  // to the first row: below the panel's head
      device.controllers.right.position.set(0, 1.6, 0);
      device.controllers.right.quaternion.set(Math.sin(0.08), 0, 0, Math.cos(0.08));
    });
    await pause(300);
    await press('right', 'trigger');
    await until(page, 'something pressed', (s) => s.page?.name !== 'main');
    await until(page, 'the rest of the town, with the headset on', (s) => s.complete, 180);
    assert.deepEqual(await page.evaluate(() => globalThis.glErrors), []);
    assert.deepEqual(page.said.filter((line) => !/iwer/i.test(line)), []);
    await page.evaluate(() => document.querySelector('#bar button[aria-label="Enter VR"]').click());
    await page.waitForFunction(() => !document.getElementById('tour').dataset.headset, {timeout: 30000});
    const after = await stateOf(page);
    await until(page, 'pictures in the page', (s) => s.pictures > after.pictures + 2 && s.eye_height_m > 1.6);
    await end(page);
    await host.close();
  },
  async 'the npm package has its files, and types for all that the element does; a server may load it'() {
    const npm = path.join(player, '..', 'package');
    const [packed] = JSON.parse(execFileSync('npm', ['pack', '--dry-run', '--json'], {cwd: npm, encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore']}));
    assert.deepEqual(packed.files.map((f) => f.path).sort(),
                     ['LICENSE', 'README.md', 'flaneur-tour.js', 'index.d.ts', 'index.js', 'package.json']);
    assert.equal((await import(path.join(npm, 'index.js'))).FlaneurTour, undefined);  // there is no page here
    const script = fs.readFileSync(path.join(npm, 'flaneur-tour.js'), 'utf8'), types = fs.readFileSync(path.join(npm, 'index.d.ts'), 'utf8');
    const offered = [...script.matchAll(/^    (?:get |set )?(\w+)\([^)]*\) \{ /gm)].map(([, name]) => name);
    assert.ok(offered.length > 8, String(offered));
    for (const name of offered) assert.match(types, new RegExp(`\\b${name}\\b`), `${name} has no type`);
    const version = fs.readdirSync(site).find((name) => /^flaneur-tour-.*\.js$/.test(name)).slice('flaneur-tour-'.length, -3);
    assert.equal(packed.version, version);
  },
  async 'on pages of another origin elements and frames wait for a click, tell of themselves and are told'() {
    const host = await serve(site);
    const foreign = path.join(folder, 'foreign'), address = host.url.replace('127.0.0.1', 'localhost');
    fs.mkdirSync(foreign);
    const [frame, ...element] = snippets(address);
    fs.writeFileSync(path.join(foreign, 'index.html'), `<!doctype html><html lang="en"><title>museum</title><main>
      <script>heard = []; for (const type of ['begun', 'tour-loaded', 'stop-reached', 'failed'])
        addEventListener(type, (e) => heard.push([type, e.target.id]));
        addEventListener('message', (e) => e.source === document.querySelector('iframe')?.contentWindow && heard.push([e.data.flaneur, 'frame']));</script>
      ${element.join('\n').replace('<flaneur-tour', '<flaneur-tour id="a" stop="3" style="width: 300px; height: 180px"')}
      <flaneur-tour id="b" src="${address}" style="width: 300px; height: 180px"></flaneur-tour>
      <flaneur-tour id="c" src="nowhere/" style="width: 300px; height: 100px"></flaneur-tour>
      ${frame.replace('width: 100%', 'width: 300px')}</main>`);
    const museum = await serve(foreign);
    const page = await newPage(museum.url);
    await page.setViewport({width: 320, height: 900});
    // The frame with the tour in it: the empty one before it goes away as soon as the tour's first bytes are there.
    const cameTo = async (selector) => {
      const inner = await (await page.waitForSelector(selector)).contentFrame();
      const begin = await inner.waitForSelector('#begin', {visible: true}).catch((e) => assert.ok(inner.detached, e));
      return begin ? [inner, begin] : cameTo(selector);
    };
    const enter = async (selector) => {
      const [inner, begin] = await cameTo(selector);
      assert.equal(await inner.$eval('#tour', (e) => e.dataset.state), 'waiting');
      const state = () => inner.$eval('#tour', (e) => e.dataset.state);
      for (const until = Date.now() + 120000; await state() !== 'visiting'; await pause(1000)) {
        assert.ok(Date.now() < until, `${await state()}: ${await inner.$eval('#message', (e) => e.textContent)}`);
        // A click may be lost while the museum's page does not know yet that the frame's button is under it.
        if (await state() === 'waiting') await begin.click().catch(() => {});
      }
      return inner;
    };
    const hears = (type, who) => page.waitForFunction((t, w) => globalThis.heard.some(([type, id]) => type === t && id === w), {timeout: 30000}, type, who);
    const inner = await enter('#a >>> iframe');
    await hears('tour-loaded', 'a');
    const about = await page.$eval('#a', (e) => [e.state, e.description.title, e.description.stops.length]);
    assert.ok(about[0] === 'visiting' && about[1] && about[2] > 1, String(about));
    const innerState = (what) => inner.evaluate((w) => document.getElementById('tour').flaneur.state()[w], what);
    assert.equal(await innerState('stop'), 2);
    const other = await page.$eval('#a', (e) => {  // one where one rests
      const k = e.description.stops.findLastIndex((stop) => stop.halt);
      e.goToStop(k + 1);
      e.setLanguage('de');
      e.takeTour(false);
      return k;
    });
    await inner.waitForFunction((k) => {
      const {stop, language, follows_tour} = document.getElementById('tour').flaneur.state();
      return stop === k && language === 'de' && !follows_tour;
    }, {timeout: 30000}, other);
    await page.$eval('#a', (e) => e.takeTour());
    await hears('failed', 'c');
    assert.match(await page.$eval('#c', (e) => e.shadowRoot.textContent), /no tour at this address/);
    await enter('#b >>> iframe');
    await inner.waitForFunction(() => document.getElementById('tour').flaneur.state().paused, {timeout: 30000});
    assert.equal(await page.$eval('#b', (e) => e.state), 'visiting');
    await page.$$eval('flaneur-tour', (all) => all.forEach((e) => e.remove()));
    await enter('iframe');
    await hears('tour-loaded', 'frame');
    await page.evaluate(() => document.querySelector('iframe').contentWindow.postMessage({flaneur: 'takeTour', value: false}, '*'));
    await withoutSeriousFindings(page, 'the museum\'s page');
    await end(page);
    await museum.close();
    await host.close();
  },
};

try {
  execFileSync(flaneur, ['web', pack, '-o', site, '--player', player], {stdio: 'inherit'});
  const wanted = process.argv[5];
  for (const [name, test] of Object.entries(tests)) {
    if (wanted && !name.includes(wanted)) continue;
    const began = Date.now();
    try {
      await test();
      console.log(`ok      ${name} (${Math.round((Date.now() - began) / 1000)} s)`);
    } catch (e) {
      ++failed;
      console.log(`FAILED  ${name}: ${e.stack}`);
    }
    for (const browser of open.splice(0)) await browser.close().catch(() => {});
  }
} finally {
  fs.rmSync(folder, {recursive: true, force: true});
}
process.exit(failed ? 1 : 0);
