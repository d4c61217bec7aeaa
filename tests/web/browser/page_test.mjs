// page_test.mjs FLANEUR PACK PLAYER_FOLDER: the site of a tour as visitors meet it, in Debian's Chromium.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import fs from 'node:fs';
import http from 'node:http';
import os from 'node:os';
import path from 'node:path';
import puppeteer from 'puppeteer-core';

const [flaneur, pack, player] = process.argv.slice(2);
const kFlags = ['--headless=new', '--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
                '--autoplay-policy=no-user-gesture-required'];
const kTypes = {'.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.json': 'application/json', '.jpg': 'image/jpeg'};

// A plain static host; `change` may answer otherwise: {body}, {cut: bytes} or {status}.
function serve(folder, change = () => null) {
  const asked = [];
  const server = http.createServer((request, response) => {
    const name = decodeURI(request.url.split('?')[0]).replace(/\/$/, '/index.html').slice(1);
    asked.push(name);
    const file = path.join(folder, name), other = change(name);
    if (other?.status || !fs.existsSync(file)) return response.writeHead(other?.status ?? 404).end();
    const body = other?.body ?? fs.readFileSync(file);
    response.writeHead(200, {'Content-Type': kTypes[path.extname(file)] ?? 'application/octet-stream', 'Content-Length': body.length});
    if (other?.cut === undefined) return response.end(body);
    response.write(body.subarray(0, other.cut), () => response.destroy());
  });
  return new Promise((ready) => server.listen(0, '127.0.0.1', () => ready({
    server, asked, url: `http://127.0.0.1:${server.address().port}/`,
    close: () => new Promise((done) => { server.closeAllConnections(); server.close(done); })})));
}

const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'flaneur_page_'));
const site = path.join(folder, 'site');
const open = [];  // to be closed at the end
let failed = 0;

async function newPage(url, prepare = async () => {}) {
  const browser = await puppeteer.launch({executablePath: '/usr/bin/chromium', args: kFlags, protocolTimeout: 300000});
  open.push(browser);
  const page = await browser.newPage();
  await page.setViewport({width: 320, height: 200});
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

// Counts what OpenGL complains of after each picture.
const countErrors = (page) => page.evaluateOnNewDocument(() => {
  globalThis.glErrors = [];
  const get = HTMLCanvasElement.prototype.getContext;
  HTMLCanvasElement.prototype.getContext = function(...kind) {
    const gl = get.apply(this, kind);
    if (gl) {
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
  async 'keys walk and turn, a drag turns, a tap walks there, two fingers widen the view'() {
    const host = await serve(site);
    const page = await newPage(host.url, (p) => p.emulate({viewport: {width: 320, height: 480, hasTouch: true, isMobile: true}, userAgent: 'phone'}));
    await inState(page, 'visiting');
    let before = await stateOf(page);
    await page.keyboard.down('KeyW');
    let state = await until(page, 'walks', (s) => apart(s.place_m, before.place_m) > 1);
    await page.keyboard.up('KeyW');
    assert.equal(state.follows_tour, false);
    before = await stateOf(page);
    const touch = await page.touchscreen.touchStart(160, 240);
    for (let x = 160; x > 60; x -= 10) await touch.move(x, 240);
    await touch.end();
    await until(page, 'turns', (s) => Math.abs(s.yaw_rad - before.yaw_rad) > 0.05);
    await pause(1500);
    before = await stateOf(page);
    await page.touchscreen.tap(160, 380);
    await until(page, 'goes where was tapped', (s) => apart(s.place_m, before.place_m) > 0.4);
    before = await stateOf(page);
    const a = await page.touchscreen.touchStart(140, 240), b = await page.touchscreen.touchStart(180, 240);
    for (let k = 1; k < 9; ++k) await a.move(140 - 8 * k, 240), await b.move(180 + 8 * k, 240);
    await a.end(), await b.end();
    await until(page, 'a narrower view', (s) => s.fov_rad < before.fov_rad - 0.1);
    await end(page);
    await host.close();
  },
  async 'buttons pause, leave and take the tour, go to stops and change the language, by keyboard alone'() {
    const host = await serve(site);
    const page = await newPage(host.url + '#lang=de');
    await inState(page, 'visiting');
    const described = await page.evaluate(() => document.getElementById('tour').flaneur.description);
    const press = async (at) => {
      await page.focus(`#bar button:nth-of-type(${at})`);
      await page.keyboard.press('Enter');
    };
    const labels = await page.$$eval('#bar :is(button, select)', (all) => all.map((e) => e.getAttribute('aria-label')));
    assert.ok(labels.length > 3 && labels.every((l) => l), labels.join(', '));
    await press(2);
    await until(page, 'the tour waits', (s) => s.paused);
    await press(2);
    await until(page, 'the tour goes on', (s) => !s.paused);
    await press(1);
    await until(page, 'a way of one\'s own', (s) => !s.follows_tour);
    await press(1);
    await until(page, 'the tour again', (s) => s.follows_tour);
    const halts = described.stops.map((stop, k) => (stop.halt ? k : -1)).filter((k) => k >= 0);
    const last = halts[halts.length - 1];
    await page.select('#bar select', String(last));
    await until(page, 'the last stop', (s) => s.stop === last && s.follows_tour);
    await press(3);
    await until(page, 'the stop before', (s) => s.stop === halts[Math.max(halts.length - 2, 0)]);
    if (described.languages.length > 1) {
      const german = await page.$eval('#bar button', (e) => e.title);
      await page.select('#bar select:last-of-type', 'en');
      await page.waitForFunction((was) => document.querySelector('#bar button').title !== was, {timeout: 30000}, german);
    }
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
  async 'a lost context comes back at the same place'() {
    const host = await serve(site);
    const page = await newPage(host.url, countErrors);
    await inState(page, 'visiting');
    await page.evaluate(() => globalThis.gl.getExtension('WEBGL_lose_context').loseContext());
    await inState(page, 'loading');
    assert.match(await sentence(page), /moment/);
    await inState(page, 'visiting');
    await until(page, 'pictures', (s) => s.pictures > 1);
    assert.equal(await sentence(page), '');
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
    const victim = list.pieces[0].file, whole = fs.readFileSync(path.join(site, victim));
    const spoilt = Buffer.from(whole);
    spoilt[spoilt.length >> 1] ^= 0xFF;
    const cases = [[{body: spoilt}, /damaged/], [{cut: whole.length >> 1}, /line broke/], [{status: 404}, /not on this server/]];
    for (const [answer, expected] of cases) {
      const host = await serve(site, (name) => (name === victim ? answer : null));
      const page = await newPage(host.url);
      await inState(page, 'failed');
      assert.match(await sentence(page), expected);
      await end(page);
      await host.close();
    }
  },
  async 'a line that breaks once is tried again'() {
    const list = JSON.parse(fs.readFileSync(path.join(site, 'tour.json')));
    let broken = 0;
    const host = await serve(site, (name) => (name === list.pieces[0].file && broken++ === 0 ? {cut: 1000} : null));
    const page = await newPage(host.url);
    await inState(page, 'visiting');
    assert.ok(broken > 1);
    await end(page);
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
  async 'in a frame of another origin it waits for a click, tells of itself and is told'() {
    const host = await serve(site);
    const foreign = path.join(folder, 'foreign');
    fs.mkdirSync(foreign);
    fs.writeFileSync(path.join(foreign, 'index.html'), `<!doctype html><title>museum</title>
      <iframe src="${host.url.replace('127.0.0.1', 'localhost')}" width="300" height="180"></iframe>
      <script>heard = []; addEventListener('message', (e) => heard.push(e.data.flaneur));</script>`);
    const museum = await serve(foreign);
    const page = await newPage(museum.url);
    const frame = await (await page.waitForSelector('iframe')).contentFrame();
    const begin = await frame.waitForSelector('#begin', {visible: true});
    assert.equal(await frame.$eval('#tour', (e) => e.dataset.state), 'waiting');
    const stateInFrame = () => frame.$eval('#tour', (e) => e.dataset.state);
    for (const until = Date.now() + 120000; await stateInFrame() !== 'visiting'; await pause(1000)) {
      assert.ok(Date.now() < until, `${await stateInFrame()}: ${await frame.$eval('#message', (e) => e.textContent)}`);
      // A click may be lost while the museum's page does not know yet that the frame's button is under it.
      if (await stateInFrame() === 'waiting') await begin.click().catch(() => {});
    }
    await page.waitForFunction(() => globalThis.heard.includes('tour-loaded'), {timeout: 30000});
    await page.evaluate(() => document.querySelector('iframe').contentWindow.postMessage({flaneur: 'takeTour', value: false}, '*'));
    await frame.waitForFunction(() => !document.getElementById('tour').flaneur.state().follows_tour, {timeout: 30000});
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
