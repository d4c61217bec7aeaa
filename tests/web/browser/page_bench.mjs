// page_bench.mjs SITE [STEP_CLOCK WEB_STEP_CLOCK.js]: figures of a site that `flaneur web` wrote, in Debian's Chromium without a graphics
// card. Bytes are those that came over the line. With the two programs of tests/bench/step_clock.cpp, native and as a page's code, also
// what a step of 10,000 people takes in each, run in turn.
import {execFileSync} from 'node:child_process';
import fs from 'node:fs';
import http from 'node:http';
import path from 'node:path';
import {launch, typeOf} from './chromium.mjs';

const [site, clock, pageClock] = process.argv.slice(2);
if (!site || !fs.existsSync(path.join(site, 'tour.json'))) {
  console.error('page_bench.mjs: error: name a folder that flaneur web wrote');
  process.exit(2);
}
const kSettles_ms = 2000;  // the browser, whose own pages take both cores while it starts; a visitor's is there already
const kBytesAMillisecond = 20e6 / 8 / 1000, kDelay_ms = 40, kPart_bytes = 8192;  // of the line, which all answers share

let sent = 0;
const server = http.createServer((request, response) => {
  const name = request.url.split('?')[0].replace(/\/$/, '/index.html').slice(1), file = path.join(site, name);
  if (!fs.existsSync(file)) return response.writeHead(404).end();
  const headers = {'Content-Type': typeOf(file)};
  const packed = fs.existsSync(file + '.gz');  // as most hosts do
  if (packed) headers['Content-Encoding'] = 'gzip';
  const body = fs.readFileSync(packed ? file + '.gz' : file);
  response.writeHead(200, {...headers, 'Content-Length': body.length});
  for (let at = 0; at < body.length; at += kPart_bytes) waiting.push([response, body.subarray(at, at + kPart_bytes), at + kPart_bytes >= body.length]);
  if (body.length === 0) response.end();
});
const waiting = [];
let free_ms = performance.now();
setInterval(() => {
  const now = performance.now();
  free_ms = Math.max(free_ms, now - 20);
  while (waiting.length > 0 && free_ms < now) {
    const [response, part, last] = waiting.shift();
    free_ms += part.length / kBytesAMillisecond;
    sent += part.length;
    setTimeout(() => last ? response.end(part) : response.write(part), kDelay_ms);
  }
}, 2);
await new Promise((ready) => server.listen(0, '127.0.0.1', ready));

const browser = await launch();

// A page whose clock is exact, which browsers grant to pages that let no other origin in.
async function clockPage() {
  const files = new Map([['/', Buffer.from('<!doctype html><script src="/clock.js"></script>')], ['/clock.js', fs.readFileSync(pageClock)],
                         ['/web_step_clock.wasm', fs.readFileSync(pageClock.replace(/\.js$/, '.wasm'))]]);
  const host = http.createServer((request, response) => {
    const body = files.get(request.url);
    response.writeHead(body ? 200 : 404, {'Content-Type': request.url === '/' ? 'text/html' : typeOf(request.url),
                                         'Cross-Origin-Opener-Policy': 'same-origin', 'Cross-Origin-Embedder-Policy': 'require-corp'}).end(body);
  });
  await new Promise((ready) => host.listen(0, '127.0.0.1', ready));
  const clockIn = await browser.newPage();
  await clockIn.goto(`http://127.0.0.1:${host.address().port}/`);
  return clockIn;
}

async function compareSteps() {
  const native_ms = [], page_ms = [], times = [], inPage = await clockPage();
  for (let k = 0; k < 9; ++k) {
    native_ms.push(Number(execFileSync(clock, ['10000'], {encoding: 'utf8'})));
    page_ms.push(Number(await inPage.evaluate(async () => {
      let printed = '';
      await globalThis.makeStepClock({arguments: ['10000'], print: (line) => { printed += line; }});
      return printed;
    })));
    times.push(page_ms.at(-1) / native_ms.at(-1));  // a machine is slower in some minutes than in others
  }
  const median = (all) => [...all].sort((a, b) => a - b)[all.length >> 1];
  console.log(`a step of 10,000 people, native and in a page   ${median(native_ms).toFixed(2)} ms, ${median(page_ms).toFixed(2)} ms, ` +
              `${median(times).toFixed(2)} times`);
}

const page = await browser.newPage();
await page.setViewport({width: 1280, height: 720});
const complaints = [];
page.on('console', (m) => { if (m.type() === 'error' || m.type() === 'warn') complaints.push(m.text()); });
page.on('pageerror', (e) => complaints.push(e.message));
const sentUntil = {};
await page.exposeFunction('told', (mark) => { sentUntil[mark] = sent; });
await page.evaluateOnNewDocument(() => {
  globalThis.tasks = [];
  globalThis.glErrors = 0;
  const get = HTMLCanvasElement.prototype.getContext;
  HTMLCanvasElement.prototype.getContext = function(...kind) {
    const gl = get.apply(this, kind);
    if (gl && kind[0] === 'webgl2') globalThis.gl = gl;
    return gl;
  };
  globalThis.marks = {};
  new PerformanceObserver((list) => {
    for (const task of list.getEntries()) globalThis.tasks.push([task.startTime, task.duration]);
  }).observe({type: 'longtask', buffered: true});
  for (const type of ['tour-loaded', 'complete'])
    addEventListener(type, () => { globalThis.marks[type] = performance.now(), globalThis.told(type); });
});
await new Promise((done) => setTimeout(done, kSettles_ms));
await page.goto(`http://127.0.0.1:${server.address().port}/`);
const came = async (mark) => {
  await page.waitForFunction((m) => globalThis.marks[m], {timeout: 280000}, mark);
  return page.evaluate((m) => globalThis.marks[m], mark);
};
const first_ms = await came('tour-loaded');
const whole_ms = await came('complete');
await page.waitForFunction(() => document.getElementById('tour').flaneur.state().complete, {timeout: 280000, polling: 200});
const ready_ms = await page.evaluate(() => performance.now());
await new Promise((done) => setTimeout(done, 5000));
const pictures = () => page.evaluate(() => document.getElementById('tour').flaneur.state().pictures);
const before = await pictures(), seconds = 5;
await new Promise((done) => setTimeout(done, 1000 * seconds));
const drawn = await pictures() - before;
const {longest, heap, wrong} = await page.evaluate(() => ({
  wrong: globalThis.gl.getError(),
  longest: Math.max(0, ...globalThis.tasks.filter(([at]) => at > globalThis.marks['tour-loaded']).map(([, ms]) => ms)),
  heap: document.getElementById('tour').flaneur.heapBytes()}));
const code = fs.readdirSync(site).filter((f) => f.endsWith('.js.br')).map((f) => path.join(site, f));
const list = JSON.parse(fs.readFileSync(path.join(site, 'tour.json')));
const codeBytes = [...code, path.join(site, list.player)].reduce((sum, f) => sum + fs.statSync(f).size, 0);
console.log(`code, compressed                                ${(codeBytes / 1e6).toFixed(2)} MB`);
console.log(`bytes until the first picture with people       ${(sentUntil['tour-loaded'] / 1e6).toFixed(2)} MB`);
console.log(`bytes of the whole tour                         ${(sent / 1e6).toFixed(2)} MB`);
console.log(`first picture from a cold start, 20 Mbit/s      ${(first_ms / 1000).toFixed(1)} s`);
console.log(`all that there is, on the same line             ${(whole_ms / 1000).toFixed(1)} s`);
console.log(`and all of it made ready                       ${(ready_ms / 1000).toFixed(1)} s`);
// Browsers tell of those of 50 ms and more alone.
console.log(`longest task after the first picture            ${longest > 0 ? `${longest.toFixed(0)} ms` : 'none of 50 ms'}`);
console.log(`heap of the player                              ${(heap / 1e6).toFixed(0)} MB`);
console.log(`complaints of the console and of OpenGL             ${complaints.length + (wrong ? 1 : 0)}  ${complaints[0] ?? ''}`.trimEnd());
console.log(`pictures a second at 1280 x 720                 ${(drawn / seconds).toFixed(1)}`);
await page.close();
if (clock && pageClock) await compareSteps();
await browser.close();
process.exit();
